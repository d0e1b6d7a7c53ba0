#include "app/panels/help_window.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/controls.h"
#include "app/panels/floating_window.h"
#include "app/panels/fuzzy.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

/// What is done without an action: with the mouse, or with keys that are held.
struct Manner {
  const char* how;
  const char* what;
};
constexpr std::array kManners{
    Manner{"Click", "Asks about the pixel or the vector under the mouse."},
    Manner{"Shift+click, Ctrl+click", "Adds a vector to those that are selected, or takes it away."},
    Manner{"Left drag", "Turns the camera about the point that was pressed."},
    Manner{"Shift+left drag", "Moves the camera sideways."},
    Manner{"Ctrl+left drag, Ctrl+wheel", "Moves the camera nearer or away."},
    Manner{"Ctrl+Shift+left drag", "Selects the vectors in a rectangle; with Alt adds them."},
    Manner{"Right drag", "Looks around."},
    Manner{"Middle drag, Alt+left drag", "Moves the picture in the window."},
    Manner{"Wheel", "Zooms into the picture, down to single pixels."},
    Manner{"W A S D Q E, held", "Flies: forward, left, back, right, down, up."},
    Manner{"Drag on a control", "Changes its value; with Alt, ten times as fine."},
    Manner{"Double click, Ctrl+click on a control", "Lets its value be typed."},
    Manner{"Drop a file on the window", "Opens it."}};

void drawRow(const Palette& palette, const char* what, const std::string& keys, const std::string& help) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  wrappedText(what);
  ImGui::TableNextColumn();
  ImGui::PushStyleColor(ImGuiCol_Text, palette.accent);
  wrappedText(keys);
  ImGui::PopStyleColor();
  ImGui::TableNextColumn();
  noteText(palette, help);
}

bool fits(const std::string& filter, std::string_view text) { return fuzzyScore(filter, text).has_value(); }

/// A heading that spans the table; drawn before the first row that it is for.
void drawGroup(const Palette& palette, const char* title) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  heading(palette, title);
}

void drawActions(const Palette& palette, const PanelInput& input, const std::string& filter) {
  for (std::size_t g = 0; g < kActionGroupNames.size(); ++g) {
    bool titled = false;
    for (const ActionInfo& info : actionTable()) {
      const std::string keys = input.keys->allTextOf(info.id);
      if (static_cast<std::size_t>(info.group) != g || !fits(filter, fmt::format("{} {}", info.label, keys)))
        continue;
      if (!titled) drawGroup(palette, kActionGroupNames[g]);
      titled = true;
      // By this name keys.conf gives it other keys.
      drawRow(palette, info.label, keys, fmt::format("{} [{}]", info.help, info.name));
    }
  }
}

void drawManners(const Palette& palette, const std::string& filter) {
  bool titled = false;
  for (const Manner& manner : kManners) {
    if (!fits(filter, fmt::format("{} {}", manner.how, manner.what))) continue;
    if (!titled) drawGroup(palette, "Mouse and held keys");
    titled = true;
    drawRow(palette, manner.how, "", manner.what);
  }
}

}  // namespace

void drawHelpWindow(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput&) {
  HelpState& own = state.help;
  if (!own.open) return;
  const Palette& palette = paletteOf(workspace.display.theme);
  FloatingWindow window("Help", "help", {46.0f, 34.0f}, palette, own.open, own.takeFocus);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (own.takeFocus) ImGui::SetKeyboardFocusHere();
  own.takeFocus = false;
  ImGui::InputTextWithHint("##filter", "Filter", &own.filter);
  Widgets::recordItem("help.filter");
  if (ImGui::BeginTable("##keys", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp,
                        {0.0f, ImGui::GetContentRegionAvail().y})) {
    ImGui::TableSetupColumn("action", 0, 3.0f);
    ImGui::TableSetupColumn("keys", 0, 2.5f);
    ImGui::TableSetupColumn("help", 0, 6.0f);
    drawActions(palette, input, own.filter);
    drawManners(palette, own.filter);
    ImGui::EndTable();
  }
}

}  // namespace lightvane
