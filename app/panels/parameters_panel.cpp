#include "app/panels/parameters_panel.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/controls.h"
#include "app/panels/parameter_info.h"
#include "app/panels/parameter_rows.h"
#include "app/panels/widgets.h"
#include "core/base/tasks.h"

namespace lightvane {
namespace {

/// What a group's header says: how many fields it has that the filter leaves, and how many were changed.
struct GroupCounts {
  int shown = 0;
  int changed = 0;
};

GroupCounts countGroup(std::string_view group, std::string_view filter,
                       const std::vector<FieldDescription>& now, const std::vector<FieldDescription>& start) {
  GroupCounts counts;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (groupOf(now[i].field.key) != group) continue;
    counts.shown += matchesFilter(now[i].field, filter);
    counts.changed += now[i].value != start[i].value;
  }
  return counts;
}

/// A group's header; true when it was clicked.
bool drawGroupHeader(const ControlStyle& style, const ParameterGroup& group, bool open, bool idle,
                     int changed) {
  const float height = ImGui::GetFrameHeight();
  const float width = ImGui::GetContentRegionAvail().x - resetButtonWidth();
  const std::string name = "group." + group.prefix;
  const bool clicked = ImGui::InvisibleButton(name.c_str(), {width, height});
  Widgets::recordItem(name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const float em = ImGui::GetFontSize();
  if (ImGui::IsItemHovered()) {
    list.AddRectFilled(min, max, style.palette.frame, ImGui::GetStyle().FrameRounding);
  }
  drawFoldMark(style.palette, open);
  const std::string count = changed == 0 ? "" : fmt::format("{} changed", changed);
  const float countWidth = ImGui::CalcTextSize(count.c_str()).x;
  const float y = min.y + ImGui::GetStyle().FramePadding.y;
  const float left = min.x + foldMarkWidth();
  const std::string title = fitted(group.title, max.x - left - countWidth - 0.5f * em);
  list.AddText({left, y}, idle ? style.palette.dim : style.palette.text, title.c_str());
  list.AddText({max.x - countWidth, y}, style.palette.accent, count.c_str());
  return clicked;
}

/// Sets every field of a group to the scene's value.
void resetGroup(Parameters& parameters, const Parameters& start, std::string_view group) {
  for (const FieldDescription& row : describeParameters(start)) {
    if (groupOf(row.field.key) != group) continue;
    // What a parameter's own text says is always taken.
    static_cast<void>(setParameter(parameters, row.field.key, row.value, ""));
  }
}

/// Some buttons that share a line, of which one may be marked. The one that was clicked.
std::optional<std::size_t> drawSegments(const ControlStyle& style, std::span<const ActionId> actions,
                                        const std::function<bool(std::size_t)>& isMarked,
                                        const std::function<std::string(std::size_t)>& costOf) {
  std::optional<std::size_t> clicked;
  const float gap = 0.25f * ImGui::GetFontSize();
  const auto count = static_cast<float>(actions.size());
  const float width = std::floor((ImGui::GetContentRegionAvail().x - (count - 1.0f) * gap) / count);
  for (std::size_t i = 0; i < actions.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, gap);
    const ActionInfo& info = actionInfo(actions[i]);
    const std::string_view label(info.label);
    const std::string word(label.substr(label.find(' ') + 1));  // "Preset: draft"
    const bool marked = isMarked(i);
    if (marked) {
      ImGui::PushStyleColor(ImGuiCol_Button, style.palette.fill);
      ImGui::PushStyleColor(ImGuiCol_ButtonHovered, style.palette.fill);
    }
    const float room = width - 2.0f * ImGui::GetStyle().FramePadding.x;
    if (ImGui::Button((fitted(word, room) + "##" + info.name).c_str(), {width, 0.0f})) clicked = i;
    if (marked) ImGui::PopStyleColor(2);
    Widgets::recordItem(info.name);
    if (!wantsTooltip(style.state, info.name)) continue;
    const std::string cost = costOf(i);
    showTooltip(style.palette, info.label, cost.empty() ? info.help : fmt::format("{}\n{}", info.help, cost));
  }
  return clicked;
}

void drawPresetsAndRules(const ControlStyle& style, Parameters& parameters, const PanelInput& input,
                         PanelOutput& output) {
  const auto costOf = [&](const Parameters& candidate) {
    if (!input.estimateChange || candidate == parameters) return std::string();
    const std::optional<ChangeEstimate> estimate = input.estimateChange(candidate);
    output.stale = staleKinds(estimate);
    return estimateText(estimate);
  };
  heading(style.palette, "Preset");
  constexpr std::array kPresets{ActionId::PresetDraft, ActionId::PresetBalanced, ActionId::PresetFine};
  const auto withPreset = [&](std::size_t i) {
    Parameters candidate = parameters;
    applyPreset(candidate, kPresetNames[i].value);
    return candidate;
  };
  const auto preset = drawSegments(
      style, kPresets, [&](std::size_t i) { return withPreset(i) == parameters; },
      [&](std::size_t i) { return costOf(withPreset(i)); });
  if (preset) applyPreset(parameters, kPresetNames[*preset].value);

  heading(style.palette, "Rules");
  constexpr std::array kRules{ActionId::RulesPrinted, ActionId::RulesPaper, ActionId::RulesRefined};
  const auto rules = drawSegments(
      style, kRules, [&](std::size_t i) { return kRulesNames[i].value == parameters.vectors.rules; },
      [&](std::size_t i) {
        Parameters candidate = parameters;
        applyRules(candidate.vectors, kRulesNames[i].value);
        return costOf(candidate);
      });
  if (rules) applyRules(parameters.vectors, kRulesNames[*rules].value);
}

void drawFilter(std::string& filter) {
  ImGui::SetNextItemWidth(-std::numeric_limits<float>::min());
  ImGui::InputTextWithHint("##filter", "Filter", &filter);
  Widgets::recordItem("parameters.filter");
}

/// What the rendering runs on; no part of what the picture is.
void drawMachine(const ControlStyle& style, Setup& setup, ParametersPanelState& state) {
  constexpr double kMostMegabytes = 1e6;
  heading(style.palette, "Rendering");
  const auto focusHere = [&](std::string_view key, const std::string& value) {
    if (state.focus != key) return;
    state.focus.reset();
    ImGui::SetScrollHereY(0.5f);
    style.state.type(std::string(key), value);
  };
  toggleLine(style, {.name = "render.lock_cache", .label = "Lock cache"}, setup.cacheLocked);
  tooltip(style, "render.lock_cache", actionInfo(ActionId::LockCache).help,
          setup.cacheLocked ? ChangeCost::Vectors : ChangeCost::Answer);
  auto threads = static_cast<float>(setup.threads);
  const PlainNumber number{
      .max = kMostThreads,
      .scale = ValueScale::about(0.0, kMostThreads, 0.0, static_cast<double>(threads), true),
      .help = "Threads that render. The picture is the same for any number of them.",
      .cost = ChangeCost::Answer,
      .zeroText = "one for each core"};
  focusHere("render.threads", std::to_string(setup.threads));
  if (plainNumberLine(style, "render.threads", "Threads", threads, number))
    setup.threads = static_cast<int>(std::lround(threads));
  auto megabytes = static_cast<float>(setup.memoryLimitMegabytes);
  const PlainNumber limit{
      .max = kMostMegabytes,
      .scale = ValueScale::about(0.0, kMostMegabytes, 4096.0, static_cast<double>(megabytes), true),
      .unit = "MB",
      .help =
          "What points, vectors and picture may take. A picture that would take more is refused; vectors "
          "beyond it are not computed any more.",
      .cost = ChangeCost::Answer,
      .zeroText = "none"};
  focusHere("render.memory", std::to_string(setup.memoryLimitMegabytes));
  if (plainNumberLine(style, "render.memory", "Memory limit", megabytes, limit))
    setup.memoryLimitMegabytes = static_cast<int>(std::lround(megabytes));
}

}  // namespace

void drawParametersPanel(Workspace& workspace, const PanelInput& input, PanelState& state,
                         PanelOutput& output) {
  Parameters& parameters = workspace.setup.parameters;
  const Palette& palette = paletteOf(workspace.display.theme);
  const ControlStyle style{palette, state.controls};
  const SceneSummary* scene = input.scene ? &*input.scene : nullptr;
  const Parameters start = scene != nullptr ? scene->start : Parameters{};
  ParametersPanelState& own = state.parameters;

  drawPresetsAndRules(style, parameters, input, output);
  ImGui::Dummy({0.0f, 0.2f * ImGui::GetFontSize()});
  drawFilter(own.filter);
  for (const std::string& contradiction : contradictions(parameters))
    markedText(palette.warning, contradiction);

  if (own.focus) {
    own.filter.clear();
    own.openGroups.insert(std::string(groupOf(*own.focus)));
  }
  const std::vector<FieldDescription> startRows = describeParameters(start);
  for (const ParameterGroup& group : parameterGroups()) {
    const GroupCounts counts =
        countGroup(group.prefix, own.filter, describeParameters(parameters), startRows);
    if (counts.shown == 0) continue;
    const bool open = !own.filter.empty() || own.openGroups.contains(group.prefix);
    const std::string idle = whyGroupIsIdle(group.prefix, parameters, scene);
    if (drawGroupHeader(style, group, open, !idle.empty(), counts.changed)) {
      open ? static_cast<void>(own.openGroups.erase(group.prefix))
           : static_cast<void>(own.openGroups.insert(group.prefix));
    }
    ImGui::SameLine();
    if (resetButton(style, "group." + group.prefix, counts.changed > 0,
                    "Sets all of the group to the scene's")) {
      resetGroup(parameters, start, group.prefix);
    }
    if (!open) continue;
    if (!idle.empty()) noteText(palette, idle);
    drawParameterRows(group.prefix, workspace, input, state, output);
  }
  if (own.filter.empty()) drawMachine(style, workspace.setup, own);
}

}  // namespace lightvane
