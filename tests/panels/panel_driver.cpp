#include "tests/panels/panel_driver.h"

#include <cmath>

#include <gtest/gtest.h>

#include "app/panels/apply_action.h"
#include "app/panels/fonts.h"
#include "core/measure/sweep_run.h"

namespace lightvane {
namespace {

constexpr float kFrameSeconds = 1.0f / 60.0f;

#if IMGUI_VERSION_NUM < 18700
// Keys of panels alone: what InputText reads. 1.86 looks them up in a map of the program's own codes.
constexpr ImGuiKey kKeys[] = {ImGuiKey_Tab,       ImGuiKey_LeftArrow, ImGuiKey_RightArrow, ImGuiKey_UpArrow,
                              ImGuiKey_DownArrow, ImGuiKey_Enter,     ImGuiKey_Escape,     ImGuiKey_Backspace,
                              ImGuiKey_Delete,    ImGuiKey_Home,      ImGuiKey_End};
#endif

}  // namespace

PanelDriver::PanelDriver() : PanelDriver(Screen{}) {}

PanelDriver::PanelDriver(const Screen& screen) : context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {screen.width, screen.height};
  io.DeltaTime = kFrameSeconds;
#if IMGUI_VERSION_NUM < 18700
  for (const ImGuiKey key : kKeys) io.KeyMap[key] = static_cast<int>(key) + 1;
#endif
  loadFonts(*io.Fonts, screen.scale);
#if IMGUI_VERSION_NUM >= 19200
  io.BackendFlags |= ImGuiBackendFlags_RendererHasTextures;
#else
  unsigned char* pixels = nullptr;
  int width = 0;
  int height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
#endif
  workspace.display.theme = screen.theme;
  input.monitorScale = screen.scale;
  input.keys = &keys_;
  applyTheme(screen.theme, screen.scale);
  Widgets::setRecording(true);
  putMouse({-1000.0f, -1000.0f});
}

PanelDriver::~PanelDriver() {
  Widgets::setRecording(false);
  ImGui::DestroyContext(context_);
}

void PanelDriver::frames(int count) {
  for (int i = 0; i < count; ++i) {
    input.timeSeconds += static_cast<double>(kFrameSeconds);
    ImGui::NewFrame();
    output = PanelOutput{};
    layout = drawPanels(workspace, input, state, output);
    remember(output);
    gestures += output.gesture;
    ImGui::Render();
  }
}

WidgetPlace PanelDriver::require(std::string_view name) {
  for (int attempt = 0; attempt < 200; ++attempt) {
    const std::optional<WidgetPlace> place = Widgets::find(name);
    if (place && place->isVisible()) return *place;
    if (!place) break;
    // Scrolled out of sight: the wheel over what is seen of its window.
    putMouse({0.5f * (place->clipMin.x + place->clipMax.x), 0.5f * (place->clipMin.y + place->clipMax.y)});
    frames();
    const float notch = place->centre().y < place->clipMin.y ? 1.0f : -1.0f;
#if IMGUI_VERSION_NUM >= 18700
    ImGui::GetIO().AddMouseWheelEvent(0.0f, notch);
#else
    ImGui::GetIO().MouseWheel = notch;
#endif
    frames();
  }
  ADD_FAILURE() << "no widget '" << name << "' can be seen among:\n" << widgetsAsText();
  return {};
}

void PanelDriver::moveTo(std::string_view name) {
  putMouse(require(name).centre());
  frames(2);  // ImGui finds what is hovered by the frame before
}

void PanelDriver::click(std::string_view name) {
  moveTo(name);
  putButton(true);
  frames();
  release();
}

void PanelDriver::release() {
  putButton(false);
  // So that the next click is not the second of a double click.
  frames(static_cast<int>(ImGui::GetIO().MouseDoubleClickTime / kFrameSeconds) + 2);
}

void PanelDriver::doubleClick(std::string_view name) {
  moveTo(name);
  for (int i = 0; i < 2; ++i) {
    putButton(true);
    frames();
    putButton(false);
    frames();
  }
  frames(2);
}

void PanelDriver::drag(std::string_view name, float dx) {
  const ImVec2 from = require(name).centre();
  moveTo(name);
  putButton(true);
  frames();
  constexpr int kSteps = 8;
  for (int i = 1; i <= kSteps; ++i) {
    putMouse({from.x + dx * static_cast<float>(i) / kSteps, from.y});
    frames();
  }
  release();
}

void PanelDriver::hover(std::string_view name) {
  moveTo(name);
  frames(40);
}

void PanelDriver::type(std::string_view text) {
  for (const char c : text) {
    ImGui::GetIO().AddInputCharacter(static_cast<unsigned char>(c));
    frames();
  }
}

void PanelDriver::press(ImGuiKey key) {
  putKey(key, true);
  frames();
  putKey(key, false);
  frames(2);
}

void PanelDriver::action(ActionId id) {
  PanelOutput told;
  applyAction(id, workspace, input, state, told);
  remember(told);
  frames(3);  // a text field takes the keyboard in the frame after it appears
}

void PanelDriver::remember(const PanelOutput& told) {
  asked.actions.insert(asked.actions.end(), told.actions.begin(), told.actions.end());
  asked.dismissedNotices.insert(asked.dismissedNotices.end(), told.dismissedNotices.begin(),
                                told.dismissedNotices.end());
  if (told.open) asked.open = told.open;
  if (told.exported) asked.exported = told.exported;
  if (told.clipboard) asked.clipboard = told.clipboard;
  if (told.goToCamera) asked.goToCamera = told.goToCamera;
  asked.refreshIndirect |= told.refreshIndirect;
  if (told.measureTrade) asked.measureTrade = told.measureTrade;
  if (told.showTradePoint) asked.showTradePoint = told.showTradePoint;
  asked.useTradeReference |= told.useTradeReference;
  asked.stopTrade |= told.stopTrade;
  asked.clearTrade |= told.clearTrade;
}

void PanelDriver::putMouse(const ImVec2& at) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().AddMousePosEvent(at.x, at.y);
#else
  ImGui::GetIO().MousePos = at;
#endif
}

void PanelDriver::putButton(bool down) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().AddMouseButtonEvent(0, down);
#else
  ImGui::GetIO().MouseDown[0] = down;
#endif
}

void PanelDriver::putKey(ImGuiKey key, bool down) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui::GetIO().AddKeyEvent(key, down);
#else
  ImGui::GetIO().KeysDown[ImGui::GetIO().KeyMap[key]] = down;
#endif
}

SceneSummary richScene() {
  SceneSummary scene;
  scene.path = "assets/scenes/cornell-mirror.toml";
  scene.unit = "cm";
  scene.metresPerUnit = 0.01;
  scene.diagonalMetres = 4.0;
  scene.lights = {{"ceiling", true},
                  {"a lamp with a name that is far too long for any side bar that ever was", false},
                  {"light 3", false}};
  scene.cameras = {"front", "left"};
  scene.needs.specular = true;
  scene.needs.lobes = true;
  return scene;
}

OverlayBatch someOverlay() {
  OverlayBatch overlay;
  overlay.legend = {{"ceiling", Color8{230, 159, 0, 255}, MarkerShape::Disc},
                    {"occluded", Color8{230, 159, 0, 255}, MarkerShape::Ring},
                    {"seen in a mirror", Color8{86, 180, 233, 255}, MarkerShape::Diamond},
                    {"occluded, in a mirror", Color8{86, 180, 233, 255}, MarkerShape::HollowDiamond}};
  overlay.counts = {"every 3rd of 12,000 ILVs shown"};
  overlay.notes = {"arrows: 10 % change over their length"};
  return overlay;
}

TradeStatus someTrade() {
  Sweep sweep;
  sweep.varied = {{"ilv.n_min", {"1", "2", "3", "8"}}};
  TradeStatus trade;
  for (const auto& [value, seconds, error] :
       {std::tuple{"1", 0.5, 0.04}, {"2", 1.0, 0.02}, {"3", 2.0, 0.008}, {"8", 3.0, 0.009}}) {
    SweepPoint point{"vectors", {{"ilv.n_min", value}}, {}, {}, {}, {}, {}};
    for (const double scatter : {0.97, 1.03}) {
      SweepRun run;
      run.cpuSeconds = seconds * scatter;
      run.ilvRecords = 1234;
      for (const char* layer : {"beauty", "indirect"}) {
        run.metrics[std::string(layer) + ".relative"] = error * scatter;
        run.metrics[std::string(layer) + ".relmse"] = 1e-5 * error * scatter;
        run.metrics[std::string(layer) + ".ssim"] = 0.99;
      }
      point.runs.push_back(run);
    }
    trade.parameters.push_back(withSettings(Parameters{}, point.settings).value());
    sweep.points.push_back(std::move(point));
  }
  trade.sweep = std::make_shared<const Sweep>(std::move(sweep));
  trade.reference = "the path traced reference: 256 paths a pixel, noise 0.98 %";
  trade.stage = "8 of 8 runs measured.";
  return trade;
}

PanelInput richInput(const OverlayBatch& overlay) {
  PanelInput input;
  input.status = {.pass = 4,
                  .stage = "stride 8",
                  .fraction = 0.63,
                  .secondsLeft = 12.0,
                  .ilvRecords = 1234,
                  .dlvRecords = 5012,
                  .hitRate = 0.97,
                  .raysPerSecond = 2.1e6,
                  .memoryBytes = 312ULL << 20U,
                  .faultySamples = 3,
                  .faultHint = "--pixel 17,203 --seed 4",
                  .loading = "Loading cornell-mirror.toml"};
  input.scene = richScene();
  input.shown = ShownView{.view = PictureView::NearestRecord,
                          .kind = ViewKind::Scalar,
                          .title = "Nearest record",
                          .unit = "cm",
                          .scale = {.map = ColorMap::Viridis, .low = 0.0f, .high = 42.0f},
                          .categories = {}};
  input.overlay = &overlay;
  input.notices = {
      {1, Severity::Note, "written: picture.png", 1.0},
      {2, Severity::Warning, "scene.toml:3: light 'lamp' has no intensity", 2.0},
      {3, Severity::Error, "cannot read 'a/very/long/path/to/some/file/which/is/not/there.toml'", 0.5}};
  input.recentFiles = {"assets/scenes/cornell-mirror.toml",
                       "/home/somebody/with/a/very/long/path/scene.toml"};
  input.exportFormats = {{".png", "PNG: as it is shown, 8 bits", true}, {".exr", "EXR: all layers", false}};
  input.exportCommand = [](const std::filesystem::path&) {
    return ExportCommand{
        "lightvane render assets/scenes/cornell-mirror.toml -o picture.exr --set ilv.n_min=8 --set "
        "dlv.r_max=1.5%",
        ""};
  };
  input.passLengths = {5000, 1000, 246};
  input.kept = {true, "ilv.n_min 4, pass 7"};
  input.reference = {true, "path traced, 32 of 64 samples"};
  input.trade = someTrade();
  input.trade.isRunning = true;
  input.trade.stale = "These points are of another camera.";
  input.undoLabel = "ilv.n_min 4 -> 8";
  input.redoLabel = "Orbit";
  return input;
}

}  // namespace lightvane
