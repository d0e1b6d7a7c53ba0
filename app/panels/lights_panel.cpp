#include "app/panels/lights_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/controls.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

constexpr double kMostStops = 20.0;
constexpr double kDraggedStops = 5.0;

// What any change of a light costs.
constexpr const char* kFollows =
    "Direct light follows at once from what is known; indirect light when it is refreshed, from new vectors.";

/// A small square switch with a letter.
void drawLetter(const ControlStyle& style, const std::string& name, const char* letter, const char* help,
                bool& on) {
  const float side = ImGui::GetFrameHeight();
  if (on) {
    ImGui::PushStyleColor(ImGuiCol_Button, style.palette.accent);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, style.palette.accent);
    ImGui::PushStyleColor(ImGuiCol_Text, style.palette.onAccent);
  }
  const bool clicked = ImGui::Button(fmt::format("{}##{}", letter, name).c_str(), {side, side});
  if (on) ImGui::PopStyleColor(3);
  Widgets::recordItem(name);
  tooltip(style, name, "", fmt::format("{}\n{}", help, kFollows));
  if (clicked) on = !on;
}

/// The tint as a swatch that opens a picker. Screens and pickers are in sRGB, tints are linear.
void drawTint(const ControlStyle& style, const std::string& name, Rgb& tint) {
  float srgb[3] = {encodeSrgb(tint.r), encodeSrgb(tint.g), encodeSrgb(tint.b)};
  if (ImGui::ColorEdit3(("##" + name).c_str(), srgb,
                        ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoTooltip)) {
    tint = Rgb(decodeSrgb(srgb[0]), decodeSrgb(srgb[1]), decodeSrgb(srgb[2]));
  }
  Widgets::recordItem(name);
  tooltip(style, name, "", fmt::format("Tint: the light's colour is multiplied by it.\n{}", kFollows));
}

void drawLight(const ControlStyle& style, std::size_t index, const SceneLight& light, LightSetting& setting) {
  const std::string name = fmt::format("light.{}", index);
  const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
  drawLetter(style, name + ".solo", "S", "Solo: only lights with it are shown.", setting.soloed);
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  drawLetter(style, name + ".mute", "M", "Mute: the light is left out.", setting.muted);
  ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
  drawTint(style, name + ".tint", setting.tint);
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  const float room = ImGui::GetContentRegionAvail().x - resetButtonWidth();
  ImGui::TextUnformatted(fitted(light.name, room).c_str());
  tooltip(style, name, light.name,
          light.hasVectors ? "Its direct light is interpolated from DLVs."
                           : "Its direct light is computed exactly.");
  ImGui::SameLine(right - resetButtonWidth() + ImGui::GetStyle().ItemSpacing.x);
  if (resetButton(style, name, !(setting == LightSetting{}), "Sets the light to what the scene says")) {
    setting = LightSetting{};
  }
  const std::string help = fmt::format("A stop is a factor of two.\n{}", kFollows);
  plainNumberLine(style, name + ".stops", "Intensity", setting.stops,
                  {.min = -kMostStops,
                   .max = kMostStops,
                   .scale = ValueScale::linear(-kDraggedStops, kDraggedStops),
                   .unit = "stops",
                   .help = help.c_str()});
}

}  // namespace

void drawLightsPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  if (!input.scene) return noteText(style.palette, "No scene is open.");
  std::vector<LightSetting>& settings = workspace.setup.lights;
  settings.resize(input.scene->lights.size());
  if (settings.empty()) return noteText(style.palette, "This scene has no lights.");

  if (input.indirectIsStale) {
    markedText(
        style.palette.warning,
        fmt::format(
            "Direct light is of these settings. All {} ILVs are stale: indirect light is of the old ones.",
            countText(input.status.ilvRecords)));
    output.stale.indirect = ImGui::IsItemHovered();
    if (buttonLine(style, {.name = "lights.refresh", .label = "Refresh indirect light", .value = ""})) {
      output.refreshIndirect = true;
    }
    output.stale.indirect |= ImGui::IsItemHovered();
    tooltip(style, "lights.refresh", "", costSentence(ChangeCost::Vectors));
  } else {
    noteText(style.palette, "Direct light follows at once; indirect light when it is refreshed.");
  }
  const bool anyChanged = std::any_of(settings.begin(), settings.end(), [](const LightSetting& setting) {
    return !(setting == LightSetting{});
  });
  if (buttonLine(style, {.name = "lights.reset", .label = "Reset all lights", .dimmed = !anyChanged})) {
    std::fill(settings.begin(), settings.end(), LightSetting{});
  }
  ImGui::Separator();

  // Scenes may have thousands of lights: only those in sight are drawn.
  const float height = 2.0f * ImGui::GetFrameHeightWithSpacing();
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(settings.size()), height);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
      const auto index = static_cast<std::size_t>(i);
      drawLight(style, index, input.scene->lights[index], settings[index]);
    }
  }
}

}  // namespace lightvane
