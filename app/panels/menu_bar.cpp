#include "app/panels/menu_bar.h"

#include <fmt/format.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

/// "Undo ilv.n_min 4 -> 8": what would be undone is worth more than the bare word.
std::string labelOf(const ActionInfo& info, const PanelInput& input) {
  const std::string& subject = info.id == ActionId::Undo   ? input.undoLabel
                               : info.id == ActionId::Redo ? input.redoLabel
                                                           : std::string();
  return subject.empty() ? info.label : fmt::format("{} {}", info.label, subject);
}

void drawItem(const ActionInfo& info, Workspace& workspace, const PanelInput& input, PanelState& state,
              PanelOutput& output) {
  const ActionStatus status = actionStatus(info.id, workspace, input, state);
  const std::string keys = input.keys->textOf(info.id);
  const std::string label = fmt::format("{}##{}", labelOf(info, input), info.name);
  if (ImGui::MenuItem(label.c_str(), keys.c_str(), status.checked.value_or(false), status.isEnabled())) {
    applyAction(info.id, workspace, input, state, output);
  }
  const std::string name = fmt::format("menu.{}", info.name);
  Widgets::recordItem(name);
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  tooltip(style, name, "", status.isEnabled() ? info.help : status.whyNot);
}

/// The recent files as a menu of the menu of files.
void drawRecentFiles(const PanelInput& input, PanelOutput& output) {
  const bool open = ImGui::BeginMenu("Open recent", !input.recentFiles.empty());
  Widgets::recordItem("menu.recent");
  if (!open) return;
  for (std::size_t i = 0; i < input.recentFiles.size(); ++i) {
    const std::string label = fmt::format("{}##{}", input.recentFiles[i].string(), i);
    if (ImGui::MenuItem(label.c_str())) output.open = OpenFileRequest{input.recentFiles[i]};
    Widgets::recordItem(fmt::format("menu.recent.{}", i));
  }
  ImGui::EndMenu();
}

/// The scene's cameras as a menu of theirs.
void drawCameras(const PanelInput& input, PanelOutput& output) {
  const bool open = ImGui::BeginMenu("Go to", input.scene && !input.scene->cameras.empty());
  Widgets::recordItem("menu.cameras");
  if (!open) return;
  for (std::size_t i = 0; i < input.scene->cameras.size(); ++i) {
    const std::string& name = input.scene->cameras[i];
    const std::string label = name.empty() ? fmt::format("Camera {}", i + 1) : name;
    if (ImGui::MenuItem(fmt::format("{}##{}", label, i).c_str())) output.goToCamera = i;
    Widgets::recordItem(fmt::format("menu.cameras.{}", i));
  }
  ImGui::EndMenu();
}

}  // namespace

void drawMenuBar(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  if (!ImGui::BeginMainMenuBar()) return;
  for (std::size_t g = 0; g < kActionGroupNames.size(); ++g) {
    const bool open = ImGui::BeginMenu(kActionGroupNames[g]);
    Widgets::recordItem(fmt::format("menu.{}", kActionGroupNames[g]));
    if (!open) continue;
    for (const ActionInfo& info : actionTable()) {
      if (static_cast<std::size_t>(info.group) != g) continue;
      if (info.startsSection) ImGui::Separator();
      drawItem(info, workspace, input, state, output);
      if (info.id == ActionId::Open) drawRecentFiles(input, output);
      if (info.id == ActionId::CameraPrevious) drawCameras(input, output);
    }
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

}  // namespace lightvane
