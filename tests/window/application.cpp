#include "tests/window/application.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/file.h"
#include "tests/window/file_drop.h"

namespace lightvane {
namespace fs = std::filesystem;
namespace {

// What takes a fraction of a second on an idle machine.
constexpr auto kTooLong = std::chrono::seconds(60);
constexpr auto kPoll = std::chrono::milliseconds(10);
// A frame that an event asked for comes at once; where none comes, nothing was to be drawn.
constexpr auto kLongestFrame = std::chrono::milliseconds(500);
// Whose cost is worth a mean, and how many times longer than asked they are waited for.
constexpr int kFewestFrames = 20;
constexpr int kMostPatience = 10;
// ImGui answers an event in the frame after it.
constexpr int kFramesOfAnEvent = 2;

std::string widgetText(const std::vector<SeenWidget>& widgets) {
  std::string text;
  for (const SeenWidget& widget : widgets)
    text += fmt::format("  {}{}{}\n", widget.name, widget.text.empty() ? "" : ": ", widget.text);
  return text;
}

}  // namespace

Application::Application(const VirtualDesktop& desktop) : desktop_(desktop), private_(path("private")) {
  fs::create_directory(private_);
}

Application::~Application() {
  if (testing::Test::HasFailure()) {
    folder_.keep();
    fmt::print(stderr,
               "The window had these widgets:\n{}It said on stderr:\n{}\n"
               "By hand: Xvfb :99 -noreset -screen 0 {}x{}x24 & cd {}; DISPLAY=:99 HOME={} {} {}\n",
               widgetText(widgets()), errors(), VirtualDesktop::kWidth, VirtualDesktop::kHeight,
               folder().string(), private_.string(), LIGHTVANE_PROGRAM, fmt::join(words_, " "));
  }
  process_.reset();
}

void Application::start(const std::vector<std::string>& words) {
  words_ = words;
  std::vector<std::string> all = {LIGHTVANE_PROGRAM};
  all.insert(all.end(), words.begin(), words.end());
  process_ = std::make_unique<ChildProcess>(
      ChildProcess::Start{.words = all,
                          .environment = {{"DISPLAY", desktop_.display()},
                                          {"WAYLAND_DISPLAY", ""},
                                          {"HOME", private_},
                                          {"XDG_CONFIG_HOME", private_ / "config"},
                                          {"XDG_STATE_HOME", private_ / "state"},
                                          {"LIGHTVANE_WIDGETS_FILE", private_ / "widgets"}},
                          .folder = folder(),
                          .out = private_ / "out",
                          .err = private_ / "err"});
  waitForWidget("status.state");
  waitUntil("the window is on the screen", [&] {
    const auto found = desktop_.tryXdotool({"search", "--onlyvisible", "--name", "Lightvane"});
    if (!found || found->empty()) return false;
    window_ = found->substr(0, found->find('\n'));
    return true;
  });
}

// ---- what the window shows

std::vector<SeenWidget> Application::widgets() const {
  std::vector<SeenWidget> seen;
  const auto text = readFile(private_ / "widgets");
  if (!text) return seen;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    SeenWidget widget;
    words >> widget.name >> widget.x0 >> widget.y0 >> widget.x1 >> widget.y1;
    std::getline(words >> std::ws, widget.text);
    seen.push_back(std::move(widget));
  }
  return seen;
}

std::optional<SeenWidget> Application::find(const std::string& name) const {
  for (SeenWidget& widget : widgets()) {
    if (widget.name == name) return std::move(widget);
  }
  return std::nullopt;
}

std::string Application::textOf(const std::string& name) const {
  const auto widget = find(name);
  return widget ? widget->text : "";
}

void Application::waitUntil(const std::string& what, const std::function<bool()>& isSo) const {
  const auto end = std::chrono::steady_clock::now() + kTooLong;
  while (!isSo()) {
    if (!process_->isRunning()) {
      throw std::runtime_error(fmt::format("the program ended with exit code {} before {}: {}",
                                           *process_->waitForExit({}), what, errors()));
    }
    if (std::chrono::steady_clock::now() > end)
      throw std::runtime_error(fmt::format("after {} s not yet: {}", kTooLong.count(), what));
    std::this_thread::sleep_for(kPoll);
  }
}

SeenWidget Application::waitForWidget(const std::string& name) const {
  std::optional<SeenWidget> widget;
  waitUntil(fmt::format("widget {} can be seen", name), [&] { return (widget = find(name)).has_value(); });
  return *widget;
}

std::string Application::waitForText(const std::string& name,
                                     const std::function<bool(const std::string&)>& isWanted) const {
  std::string text;
  waitUntil(fmt::format("widget {} has the text that is wanted", name), [&] {
    const auto widget = find(name);
    text = widget ? widget->text : "";
    return widget && isWanted(text);
  });
  return text;
}

void Application::waitUntilComplete() const {
  waitForText("status.state", [](const std::string& text) { return text.starts_with("Complete"); });
}

// ---- mouse and keyboard

std::int64_t Application::frameStamp() const {
  // Each frame is a new file.
  struct stat info {};
  if (stat((private_ / "widgets").c_str(), &info) != 0) return 0;
  return info.st_mtim.tv_sec * 1'000'000'000LL + info.st_mtim.tv_nsec;
}

void Application::waitForFrames(int count) const {
  for (int i = 0; i < count; ++i) {
    const std::int64_t before = frameStamp();
    const auto end = std::chrono::steady_clock::now() + kLongestFrame;
    while (frameStamp() == before && process_->isRunning() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

Application::FrameCost Application::measureFrames(std::chrono::milliseconds duration) const {
  const double before = process_->firstThreadSeconds();
  const auto end = std::chrono::steady_clock::now() + duration;
  // On a machine that others load, few frames come in that time, and their mean says little.
  const auto latest = end + kMostPatience * duration;
  FrameCost cost;
  const auto isMeasured = [&] {
    const auto now = std::chrono::steady_clock::now();
    return now >= latest || (now >= end && cost.frames >= kFewestFrames);
  };
  for (std::int64_t last = frameStamp(); !isMeasured();) {
    const std::int64_t now = frameStamp();
    cost.frames += now != last;
    last = now;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  cost.milliseconds = 1e3 * (process_->firstThreadSeconds() - before) / std::max(1, cost.frames);
  return cost;
}

void Application::moveTo(Spot spot) const {
  desktop_.xdotool({"mousemove", "--window", window_, std::to_string(spot.x), std::to_string(spot.y)});
  waitForFrames(kFramesOfAnEvent);
}

void Application::click(Spot spot) const { drag(spot, spot); }

void Application::drag(Spot from, Spot to) const {
  constexpr int kSteps = 4;
  moveTo(from);
  desktop_.xdotool({"mousedown", "1"});
  waitForFrames(kFramesOfAnEvent);
  const bool moves = from.x != to.x || from.y != to.y;
  for (int step = 1; moves && step <= kSteps; ++step)
    moveTo({from.x + (to.x - from.x) * step / kSteps, from.y + (to.y - from.y) * step / kSteps});
  desktop_.xdotool({"mouseup", "1"});
  waitForFrames(kFramesOfAnEvent);
}

void Application::press(const std::string& chord) const {
  desktop_.xdotool({"keydown", chord});
  waitForFrames(kFramesOfAnEvent);
  desktop_.xdotool({"keyup", chord});
  waitForFrames(kFramesOfAnEvent);
}

void Application::fillIn(const std::string& widget, const std::string& text) const {
  waitForWidget(widget);
  press("ctrl+a");
  desktop_.xdotool({"type", "--delay", "15", text});
  waitForText(widget, [&](const std::string& typed) { return typed == text; });
}

void Application::resize(int width, int height) const {
  desktop_.xdotool({"windowsize", window_, std::to_string(width), std::to_string(height)});
}

void Application::drop(const fs::path& file) const {
  dropFile(desktop_.display(), window_, file, VirtualDesktop::kWidth / 2, VirtualDesktop::kHeight / 2);
}

std::string Application::title() const {
  std::string title = desktop_.xdotool({"getwindowname", window_});
  if (title.ends_with('\n')) title.pop_back();
  return title;
}

// ---- the end

std::string Application::errors() const { return readFile(private_ / "err").value_or(""); }

std::chrono::duration<double> Application::quit() {
  const auto begun = std::chrono::steady_clock::now();
  desktop_.xdotool({"keydown", "ctrl+q"});
  const auto exitCode = process_->waitForExit(kTooLong);
  const auto took = std::chrono::steady_clock::now() - begun;
  desktop_.xdotool({"keyup", "ctrl+q"});
  EXPECT_TRUE(exitCode) << "Ctrl+Q did not end the program";
  EXPECT_EQ(exitCode.value_or(0), 0);
  EXPECT_EQ(errors(), "");
  return took;
}

void Application::exportTo(const std::string& name,
                           const std::function<bool(const std::string&)>& isWanted) const {
  const fs::path file = path(name);
  press("ctrl+e");
  fillIn("export.path", file.string());
  waitForText("export.command", isWanted);
  press("Return");
  waitUntil("there is " + file.string(), [&] { return fs::exists(file); });
  waitUntil("the dialog is closed", [&] { return !find("window.export"); });
}

}  // namespace lightvane
