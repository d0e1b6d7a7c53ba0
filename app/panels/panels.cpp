#include "app/panels/panels.h"

#include <algorithm>
#include <array>

#include "app/panels/command_palette.h"
#include "app/panels/controls.h"
#include "app/panels/export_dialog.h"
#include "app/panels/help_window.h"
#include "app/panels/inspector_panel.h"
#include "app/panels/legend.h"
#include "app/panels/lights_panel.h"
#include "app/panels/menu_bar.h"
#include "app/panels/notices.h"
#include "app/panels/open_dialog.h"
#include "app/panels/overlay_panel.h"
#include "app/panels/parameters_panel.h"
#include "app/panels/status_bar.h"
#include "app/panels/trade_panel.h"
#include "app/panels/view_panel.h"
#include "app/panels/widgets.h"

namespace lightvane {
namespace {

/// A tab: what its button says, and what it draws.
struct TabInfo {
  PanelTab tab;
  ActionId action;
  void (*draw)(Workspace&, const PanelInput&, PanelState&, PanelOutput&);
};
constexpr std::array kTabs{TabInfo{PanelTab::Parameters, ActionId::TabParameters, drawParametersPanel},
                           TabInfo{PanelTab::View, ActionId::TabView, drawViewPanel},
                           TabInfo{PanelTab::Overlays, ActionId::TabOverlays, drawOverlayPanel},
                           TabInfo{PanelTab::Lights, ActionId::TabLights, drawLightsPanel},
                           TabInfo{PanelTab::Inspector, ActionId::TabInspector, drawInspectorPanel},
                           TabInfo{PanelTab::Trade, ActionId::TabTrade, drawTradePanel}};

enum class Bar { Left, Right, Only };

bool isOfBar(PanelTab tab, Bar bar) { return bar == Bar::Only || isLeftTab(tab) == (bar == Bar::Left); }

PanelTab& tabOf(PanelState& state, Bar bar) {
  return bar == Bar::Left ? state.leftTab : bar == Bar::Right ? state.rightTab : state.onlyTab;
}

constexpr ImGuiWindowFlags kBarFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings |
                                       ImGuiWindowFlags_NoBringToFrontOnFocus;

/// One button for each tab of a bar, that share the line.
void drawTabs(const ControlStyle& style, PanelState& state, const KeyMap& keys, Bar bar) {
  std::array<const TabInfo*, kTabs.size()> tabs{};
  std::size_t count = 0;
  for (const TabInfo& tab : kTabs) {
    if (isOfBar(tab.tab, bar)) tabs[count++] = &tab;
  }
  const float width = ImGui::GetContentRegionAvail().x / static_cast<float>(count);
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const float height = 1.15f * ImGui::GetFrameHeight();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (std::size_t i = 0; i < count; ++i) {
    const ActionInfo& info = actionInfo(tabs[i]->action);
    const ImVec2 min{start.x + static_cast<float>(i) * width, start.y};
    ImGui::SetCursorScreenPos(min);
    if (ImGui::InvisibleButton(info.name, {width, height})) {
      tabOf(state, bar) = tabs[i]->tab;
      state.onlyTab = tabs[i]->tab;
    }
    Widgets::recordItem(info.name);
    const bool front = tabOf(state, bar) == tabs[i]->tab;
    const bool hovered = ImGui::IsItemHovered();
    const std::string label = fitted(info.label, width - 0.4f * ImGui::GetFontSize());
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    list.AddText({min.x + 0.5f * (width - size.x), min.y + 0.5f * (height - size.y)},
                 front || hovered ? style.palette.text : style.palette.dim, label.c_str());
    if (front) {
      list.AddRectFilled({min.x, min.y + height - 0.14f * ImGui::GetFontSize()},
                         {min.x + width, min.y + height}, style.palette.accent);
    }
    tooltip(style, info.name, "", std::string(info.help) + " " + keys.textOf(info.id));
  }
  list.AddLine({start.x, start.y + height}, {start.x + width * static_cast<float>(count), start.y + height},
               style.palette.border);
  ImGui::SetCursorScreenPos({start.x, start.y + height + ImGui::GetStyle().ItemSpacing.y});
}

/// The edge of a bar, by which it is dragged wider. `outwards`: 1 where a drag to the right widens it.
void drawSplitter(const ControlStyle& style, const char* name, const ScreenRect& bar, float outwards,
                  float scale, float& width) {
  const float grip = 0.45f * ImGui::GetFontSize();
  const float x = outwards > 0.0f ? bar.max.x - grip : bar.min.x;
  ImGui::SetCursorScreenPos({x, bar.min.y});
  ImGui::InvisibleButton(name, {grip, std::max(1.0f, bar.height())});
  Widgets::recordItem(name);
  const bool held = ImGui::IsItemActive();
  if (held) {
    // From the width that is seen: it may have been less than what was asked for.
    width = std::clamp(bar.width() / scale + outwards * ImGui::GetIO().MouseDelta.x / scale, kLeastBarWidth,
                       kLargestBarWidth);
  }
  if (held || ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  const float line = outwards > 0.0f ? bar.max.x - 1.0f : bar.min.x;
  ImGui::GetWindowDrawList()->AddLine({line, bar.min.y}, {line, bar.max.y},
                                      held ? style.palette.accent : style.palette.border);
}

void drawSideBar(const ScreenRect& place, Bar bar, Workspace& workspace, const PanelInput& input,
                 PanelState& state, PanelOutput& output) {
  const ControlStyle style{paletteOf(workspace.display.theme), state.controls};
  const float scale = totalScale(workspace.display, input.monitorScale);
  const bool left = bar == Bar::Left;
  ImGui::SetNextWindowPos(place.min);
  ImGui::SetNextWindowSize({place.width(), place.height()});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::Begin(left ? "##left" : "##right", nullptr, kBarFlags | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  drawSplitter(style, left ? "splitter.left" : "splitter.right", place, left ? 1.0f : -1.0f, scale,
               left ? workspace.display.leftWidth : workspace.display.rightWidth);

  const float grip = 0.45f * ImGui::GetFontSize();
  ImGui::SetCursorScreenPos({place.min.x + grip, place.min.y});
  ImGui::BeginChild("##tabs", {place.width() - 2.0f * grip, place.height()}, false,
                    ImGuiWindowFlags_NoScrollbar);
  drawTabs(style, state, *input.keys, bar);
  // The bar of the scroll keeps its place, so that nothing moves sideways when a group is unfolded.
  ImGui::BeginChild("##panel", {0.0f, 0.0f}, false, ImGuiWindowFlags_AlwaysVerticalScrollbar);
  for (const TabInfo& tab : kTabs) {
    if (tab.tab == tabOf(state, bar)) tab.draw(workspace, input, state, output);
  }
  ImGui::EndChild();
  ImGui::EndChild();
  ImGui::End();
}

void drawStatus(const ScreenRect& place, Workspace& workspace, const PanelInput& input, PanelState& state,
                PanelOutput& output) {
  ImGui::SetNextWindowPos(place.min);
  ImGui::SetNextWindowSize({place.width(), place.height()});
  const float padding = 0.5f * (place.height() - ImGui::GetFontSize());
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ImGui::GetStyle().WindowPadding.x, padding});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  ImGui::Begin("##status", nullptr, kBarFlags | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar(2);
  drawStatusBar(workspace, input, state, output);
  ImGui::End();
}

PanelLayout currentLayout(const Workspace& workspace, const PanelInput& input) {
  const Display& display = workspace.display;
  return layoutPanels({.screen = ImGui::GetIO().DisplaySize,
                       .scale = totalScale(display, input.monitorScale),
                       .menuHeight = ImGui::GetFrameHeight(),
                       .statusHeight = 1.1f * ImGui::GetFrameHeight(),
                       .sideBars = display.sideBars,
                       .leftWidth = display.leftWidth,
                       .rightWidth = display.rightWidth});
}

}  // namespace

PanelLayout drawPanels(Workspace& workspace, const PanelInput& input, PanelState& state,
                       PanelOutput& output) {
  Widgets::beginFrame();
  const double passed = std::clamp(input.timeSeconds - state.lastFrame, 0.0, 0.25);
  state.lastFrame = input.timeSeconds;
  if (advanceGrowth(workspace.display.overlays.growth, momentsOf(input.passLengths), passed))
    output.animates = true;

  // Found anew by what the mouse is over: a row of the inspector here, a marker on the picture in the loop.
  if (ImGui::GetIO().WantCaptureMouse) workspace.selection.hoveredRecord = RecordRef{};
  const PanelLayout layout = currentLayout(workspace, input);
  Widgets::recordOnScreen("picture", layout.picture.min, layout.picture.max);
  drawMenuBar(workspace, input, state, output);
  if (layout.left) drawSideBar(*layout.left, Bar::Left, workspace, input, state, output);
  if (layout.right) {
    drawSideBar(*layout.right, layout.left ? Bar::Right : Bar::Only, workspace, input, state, output);
  }
  drawStatus(layout.status, workspace, input, state, output);
  drawLegend(workspace, input, layout.picture.min, layout.picture.max);
  drawNotices(workspace, input, state, output, layout.picture.min, layout.picture.max);
  drawHelpWindow(workspace, input, state, output);
  drawOpenDialog(workspace, input, state, output);
  drawExportDialog(workspace, input, state, output);
  drawCommandPalette(workspace, input, state, output);
  drawCursorTooltip(workspace, input);
  output.gesture = ImGui::IsAnyItemActive() && ImGui::IsMouseDown(0);
  // The cursor of a text field blinks without an event.
  if (awaitsTooltip(state.controls) || ImGui::GetIO().WantTextInput) output.animates = true;
  return layout;
}

}  // namespace lightvane
