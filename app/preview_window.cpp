#include "app/preview_window.h"

#include <chrono>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include <imgui.h>

#include "app/panels/fonts.h"
#include "app/panels/theme.h"
#include "app/panels/widgets.h"
#include "app/previewer.h"
#include "app/window.h"
#include "core/base/file.h"

namespace lightvane {
namespace {

constexpr int kFirstWidth = 1440;
constexpr int kFirstHeight = 900;
// While something moves by itself: as often as most screens show it.
constexpr double kFrameSeconds = 1.0 / 60.0;
// Otherwise it sleeps until something happens; this often it looks at the memory and the clock while it
// renders, and while it does not.
constexpr double kWorkSeconds = 1.0;
constexpr double kIdleSeconds = 10.0;

/// ImGui's context, for as long as the window lives.
class ImGuiContextOwner {
 public:
  ImGuiContextOwner() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    // What is remembered is ours to write.
    ImGui::GetIO().IniFilename = nullptr;
  }
  ~ImGuiContextOwner() { ImGui::DestroyContext(); }
  ImGuiContextOwner(const ImGuiContextOwner&) = delete;
  ImGuiContextOwner& operator=(const ImGuiContextOwner&) = delete;
};

/// Theme and fonts as they were set last.
struct Looks {
  Theme theme = Theme::Dark;
  float scale = 0.0f;
};

/// The keys that move the camera while they are held.
class FlightKeys {
 public:
  /// Right, up, forward.
  Vec3 held(const Window& window) {
    return {axis(window, 'D', 'A'), axis(window, 'E', 'Q'), axis(window, 'W', 'S')};
  }

 private:
  float axis(const Window& window, char plus, char minus) {
    return static_cast<float>(flies(window, plus)) - static_cast<float>(flies(window, minus));
  }
  /// Not what was pressed for a shortcut or as text, until it is let go: of Ctrl and E, Ctrl often goes
  /// first.
  bool flies(const Window& window, char letter) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool isHeld = window.isHeld(keyOf(letter));
    bool& isTaken = taken_[letter];
    isTaken = isHeld && (isTaken || io.KeyCtrl || io.KeyAlt || io.WantTextInput);
    return isHeld && !isTaken;
  }
  std::map<char, bool> taken_;
};

/// The window, what draws in it, and what it shows.
class PreviewWindow {
 public:
  static Expected<std::unique_ptr<PreviewWindow>> open();

  void load(const std::filesystem::path& scene) { previewer_.open(scene); }
  Expected<void> run();

 private:
  PreviewWindow(std::unique_ptr<Window> window, Gl gl)
      : window_(std::move(window)),
        gl_(std::make_unique<Gl>(gl)),
        previewer_(UserFolders::ofEnvironment(), Window::wakeUp) {}

  void updateLooks();
  Expected<void> frame();
  /// Until an event, a changed file that is watched, or the time is over; false where that was an event.
  bool sleep(double seconds);
  double now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  ImGuiContextOwner imgui_;
  std::unique_ptr<Window> window_;
  std::unique_ptr<Gl> gl_;
  std::unique_ptr<Canvas> canvas_;
  Looks looks_;
  FlightKeys flightKeys_;
  Previewer previewer_;
  PreviewerOutput last_;
  std::string title_;
  std::string drawingError_;
  const char* widgetsFile_ = std::getenv("LIGHTVANE_WIDGETS_FILE");
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Expected<std::unique_ptr<PreviewWindow>> PreviewWindow::open() {
  auto window = Window::open("Lightvane", kFirstWidth, kFirstHeight);
  if (!window) return tl::unexpected(window.error());
  const auto gl = Gl::load(Window::glFunction);
  if (!gl) return tl::unexpected(gl.error());
  std::unique_ptr<PreviewWindow> preview(new PreviewWindow(*std::move(window), *gl));
  auto canvas = Canvas::create(*preview->gl_, ShaderSources{});
  if (!canvas) return tl::unexpected(canvas.error());
  preview->canvas_ = std::make_unique<Canvas>(*std::move(canvas));
  preview->window_->attachImGui();
  // Tests drive the real window by the places of its widgets.
  if (preview->widgetsFile_ != nullptr) Widgets::setRecording(true);
  return preview;
}

void PreviewWindow::updateLooks() {
  const Display& display = previewer_.workspace().display;
  const float scale = totalScale(display, window_->contentScale());
  if (scale == looks_.scale && display.theme == looks_.theme) return;
  if (scale != looks_.scale) {
    const std::string notice = loadFonts(*ImGui::GetIO().Fonts, scale);
    if (!notice.empty()) previewer_.notify(Severity::Warning, notice);
    canvas_->uploadFonts();
  }
  applyTheme(display.theme, scale);
  looks_ = {display.theme, scale};
}

Expected<void> PreviewWindow::frame() {
  updateLooks();
  WindowInput happened = window_->takeInput();
  window_->beginImGuiFrame();
  ImGui::NewFrame();
  PreviewerInput input;
  input.timeSeconds = now();
  input.monitorScale = window_->contentScale();
  input.keys = std::move(happened.keys);
  input.held = std::move(happened.held);
  input.dropped = std::move(happened.dropped);
  input.wantsClose = happened.wantsClose;
  input.flight = flightKeys_.held(*window_);
  last_ = previewer_.update(input);
  ImGui::Render();

  CanvasContent content = previewer_.content();
  content.controls = ImGui::GetDrawData();
  const auto [width, height] = window_->framebufferSize();
  if (const auto drawn = canvas_->draw(content, width, height);
      !drawn && drawn.error().message() != drawingError_) {
    drawingError_ = drawn.error().message();
    previewer_.notify(Severity::Error, drawingError_);
  }
  canvas_->framebuffer().copyToWindow();
  window_->show();
  if (const Capture* capture = previewer_.wantedCapture()) {
    const auto drawn = canvas_->draw(capture->content, capture->width, capture->height);
    if (!drawn) previewer_.notify(Severity::Error, drawn.error().message());
    previewer_.finishCapture(canvas_->framebuffer().read());
  }
  if (last_.clipboard) window_->setClipboard(*last_.clipboard);
  if (last_.title != title_) window_->setTitle(title_ = last_.title);
  window_->setFullScreen(last_.fullScreen);
  if (widgetsFile_ != nullptr) return writeFileAtomically(widgetsFile_, widgetsAsText());
  return {};
}

Expected<void> PreviewWindow::run() {
  // ImGui answers an event in the frame after it: what was under the mouse is known only then.
  constexpr int kFramesAfterAnEvent = 2;
  int settling = kFramesAfterAnEvent;
  while (!last_.quits) {
    const double begun = now();
    if (auto drawn = frame(); !drawn) return drawn;
    const bool moves = last_.animates || settling > 0;
    settling = std::max(0, settling - 1);
    const double rest = moves ? kFrameSeconds - (now() - begun) : last_.works ? kWorkSeconds : kIdleSeconds;
    if (!sleep(std::max(0.0, rest))) settling = kFramesAfterAnEvent;
  }
  return {};
}

bool PreviewWindow::sleep(double seconds) {
  // A file is watched without drawing a frame each time.
  const double once = last_.watches ? std::min(seconds, kWorkSeconds) : seconds;
  for (double left = seconds;; left -= once) {
    const double before = now();
    window_->wait(std::min(left, once));
    if (now() - before < std::min(left, once)) return false;
    if (left <= once || (last_.watches && previewer_.hasFileChanged())) return true;
  }
}

}  // namespace

Expected<ExitCode> runPreviewWindow(const std::filesystem::path& scene) {
  auto preview = PreviewWindow::open();
  if (!preview) return tl::unexpected(preview.error());
  (*preview)->load(scene);
  if (const auto done = (*preview)->run(); !done) return tl::unexpected(done.error());
  return ExitCode::Success;
}

}  // namespace lightvane
