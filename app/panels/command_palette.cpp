#include "app/panels/command_palette.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/fuzzy.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

constexpr std::size_t kShownEntries = 12;

std::vector<PaletteEntry> allEntries() {
  std::vector<PaletteEntry> entries;
  for (const ActionInfo& info : actionTable()) {
    // The palette opening itself would be a joke.
    if (info.id == ActionId::Palette || info.id == ActionId::Close) continue;
    entries.push_back({info.id, fmt::format("{}: {}", kActionGroupNames[static_cast<std::size_t>(info.group)],
                                            info.label)});
  }
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    entries.push_back({std::string(row.field.key), fmt::format("{}  {}", row.field.key, row.field.label)});
  }
  // Of the rendering, no part of what the picture is: lines of the same panel.
  entries.push_back({"render.threads", "render.threads  Threads"});
  entries.push_back({"render.memory", "render.memory  Memory limit"});
  return entries;
}

void choose(const PaletteEntry& entry, Workspace& workspace, const PanelInput& input, PanelState& state,
            PanelOutput& output) {
  state.palette.open = false;
  if (const auto* action = std::get_if<ActionId>(&entry.target)) {
    applyAction(*action, workspace, input, state, output);
    return;
  }
  applyAction(ActionId::TabParameters, workspace, input, state, output);
  state.parameters.focus = std::get<std::string>(entry.target);
}

/// Up and Down move through the list while the text field keeps the keyboard.
int moveThroughList(ImGuiInputTextCallbackData* data) {
  int& chosen = *static_cast<int*>(data->UserData);
  chosen += data->EventKey == ImGuiKey_UpArrow ? -1 : 1;
  return 0;
}

std::string rightTextOf(const PaletteEntry& entry, const PanelInput& input, const Parameters& parameters) {
  if (const auto* action = std::get_if<ActionId>(&entry.target)) return input.keys->textOf(*action);
  for (const FieldDescription& row : describeParameters(parameters)) {
    if (std::get<std::string>(entry.target) == row.field.key) return row.value;
  }
  return {};
}

}  // namespace

std::vector<PaletteEntry> findPaletteEntries(std::string_view typed) {
  std::vector<std::pair<int, PaletteEntry>> found;
  for (PaletteEntry& entry : allEntries()) {
    if (const std::optional<int> score = fuzzyScore(typed, entry.text))
      found.emplace_back(*score, std::move(entry));
  }
  if (!typed.empty()) {
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
  }
  std::vector<PaletteEntry> entries;
  entries.reserve(found.size());
  for (auto& [score, entry] : found) entries.push_back(std::move(entry));
  return entries;
}

void drawCommandPalette(Workspace& workspace, const PanelInput& input, PanelState& state,
                        PanelOutput& output) {
  PaletteState& own = state.palette;
  if (!own.open) return;
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  const float width = std::min(38.0f * em, screen.x - 2.0f * em);
  ImGui::SetNextWindowPos({0.5f * (screen.x - width), std::min(4.0f * em, 0.1f * screen.y)});
  ImGui::SetNextWindowSize({width, 0.0f});
  if (own.takeFocus) ImGui::SetNextWindowFocus();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, style.palette.popup);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1.0f);
  ImGui::Begin("##palette", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (own.takeFocus) ImGui::SetKeyboardFocusHere();
  own.takeFocus = false;
  const std::string before = own.text;
  const bool entered =
      ImGui::InputTextWithHint("##text", "Type an action or a parameter", &own.text,
                               ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackHistory,
                               moveThroughList, &own.chosen);
  Widgets::recordItem("palette.text");
  if (own.text != before) own.chosen = 0;

  const std::vector<PaletteEntry> entries = findPaletteEntries(own.text);
  const auto count = static_cast<int>(std::min(entries.size(), kShownEntries));
  own.chosen = std::clamp(own.chosen, 0, std::max(0, count - 1));
  std::optional<int> chosen;
  for (int i = 0; i < count; ++i) {
    const PaletteEntry& entry = entries[static_cast<std::size_t>(i)];
    const auto* action = std::get_if<ActionId>(&entry.target);
    const bool enabled = action == nullptr || actionStatus(*action, workspace, input, state).isEnabled();
    if (buttonLine(style, {.name = fmt::format("palette.{}", i),
                           .label = entry.text,
                           .value = rightTextOf(entry, input, workspace.setup.parameters),
                           .dimmed = !enabled,
                           .selected = i == own.chosen})) {
      chosen = i;
    }
  }
  if (count == 0) noteText(style.palette, "Nothing is called like that.");
  if (entered && count > 0) chosen = own.chosen;
  // A click elsewhere puts it away, as with a menu.
  if (!ImGui::IsWindowFocused() && !ImGui::IsWindowAppearing() && ImGui::IsMouseClicked(0)) own.open = false;
  ImGui::End();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  if (chosen) choose(entries[static_cast<std::size_t>(*chosen)], workspace, input, state, output);
}

}  // namespace lightvane
