#include "app/panels/view_panel.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/widgets.h"
#include "core/inspect/error_sources.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

// What dragging reaches; more can be typed.
constexpr double kDraggedStops = 8.0;

/// What every part of the panel draws with.
struct ViewPanel {
  Workspace& workspace;
  const PanelInput& input;
  PanelState& state;
  PanelOutput& output;
  ControlStyle style;
};

/// A line that carries an action out, with its key on the right.
void drawActionLine(const ViewPanel& panel, ActionId id, bool selected = false) {
  const ActionInfo& info = actionInfo(id);
  const ActionStatus status = actionStatus(id, panel.workspace, panel.input, panel.state);
  const bool clicked = buttonLine(panel.style, {.name = info.name,
                                                .label = info.label,
                                                .value = panel.input.keys->textOf(id),
                                                .dimmed = !status.isEnabled(),
                                                .selected = selected});
  if (status.isEnabled() && viewOfAction(id)) {
    tooltip(panel.style, info.name, info.help, ChangeCost::Display);
  } else {
    tooltip(panel.style, info.name, "", status.isEnabled() ? info.help : status.whyNot);
  }
  if (clicked) applyAction(id, panel.workspace, panel.input, panel.state, panel.output);
}

void drawViews(const ViewPanel& panel) {
  for (const PictureViewInfo& view : pictureViews()) {
    drawActionLine(panel, actionOfView(view.view), panel.workspace.display.view == view.view);
  }
}

/// Of views of radiance alone: others are dimmed, so that nobody wonders why nothing happens.
void drawExposure(const ViewPanel& panel) {
  Brightness& brightness = panel.workspace.setup.brightness;
  const bool idle = panel.input.shown && panel.input.shown->kind != ViewKind::Radiance;
  heading(panel.style.palette, "Brightness");
  plainNumberLine(panel.style, "exposure", "Exposure", brightness.exposureStops,
                  {.min = -static_cast<double>(kMaxExposureStops),
                   .max = static_cast<double>(kMaxExposureStops),
                   .scale = ValueScale::linear(-kDraggedStops, kDraggedStops),
                   .unit = "stops",
                   .help = "How bright the picture is shown: a stop is a factor of two.",
                   .cost = ChangeCost::Display},
                  idle);
  std::array<const char*, kToneMapNames.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kToneMapNames[i].name;
  const auto chosen =
      choiceLine(panel.style, {.name = "tone_mapping", .label = "Tone mapping", .dimmed = idle}, names,
                 static_cast<std::size_t>(brightness.toneMapping));
  tooltip(panel.style, "tone_mapping", "How radiance that a screen cannot show becomes what it can.",
          ChangeCost::Display);
  if (chosen) brightness.toneMapping = kToneMapNames[*chosen].value;
}

/// A colour map as a strip in the item added last.
void drawRamp(ColorMap map) {
  constexpr int kParts = 32;
  const std::span<const Color8, 256> table = colorTable(map);
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const float width = (max.x - min.x) / kParts;
  for (int i = 0; i < kParts; ++i) {
    const ImU32 left = toImU32(table[static_cast<std::size_t>(255 * i / kParts)]);
    const ImU32 right = toImU32(table[static_cast<std::size_t>(255 * (i + 1) / kParts)]);
    const float x = min.x + static_cast<float>(i) * width;
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor({x, min.y}, {x + width, max.y}, left, right, right,
                                                        left);
  }
}

void drawScale(const ViewPanel& panel, const ShownView& shown) {
  ScaleOverride& scale = panel.workspace.display.scale;
  heading(panel.style.palette, shown.unit.empty() ? "Colours" : fmt::format("Colours ({})", shown.unit));
  constexpr std::array kNames{"the view's own", "grey", "viridis", "cividis", "diverging"};
  std::size_t current = 0;
  if (const std::optional<ColorMap> map = scale.map) current = static_cast<std::size_t>(*map) + 1;
  const auto chosen =
      choiceLine(panel.style, {.name = "color_map", .label = "Colour map", .changed = scale.map.has_value()},
                 kNames, current);
  tooltip(panel.style, "color_map", "", "All read the same for people with any kind of colour vision.");
  if (chosen) scale.map = *chosen == 0 ? std::nullopt : std::optional(static_cast<ColorMap>(*chosen - 1));
  ImGui::Dummy({ImGui::GetContentRegionAvail().x, 0.5f * ImGui::GetFontSize()});
  drawRamp(shown.scale.map);

  const bool wasFixed = scale.fixedRange;
  toggleLine(panel.style, {.name = "fixed_range", .label = "Fixed range"}, scale.fixedRange);
  tooltip(panel.style, "fixed_range", "",
          "Keeps the range as it is set here; otherwise it follows the picture.");
  if (scale.fixedRange && !wasFixed) {
    scale.low = shown.scale.low;
    scale.high = shown.scale.high;
  }
  if (!scale.fixedRange) return;
  // The ends never meet: a thousandth of what the picture spans stays between them.
  const auto low = static_cast<double>(scale.low);
  const auto high = static_cast<double>(scale.high);
  const double span = high - low;
  constexpr double kFar = 1e30;
  const auto reach = ValueScale::linear(low - span, high + span);
  plainNumberLine(panel.style, "range.high", "High end", scale.high,
                  {.min = low + 1e-3 * span, .max = kFar, .scale = reach, .reset = high});
  plainNumberLine(panel.style, "range.low", "Low end", scale.low,
                  {.min = -kFar, .max = high - 1e-3 * span, .scale = reach, .reset = low});
}

/// A source's part of the error: a line that shows its map.
void drawSource(const ViewPanel& panel, std::optional<ErrorSource> source, const char* name,
                const char* label, const SourceError* error, const std::string& help) {
  std::optional<ErrorSource>& shown = panel.workspace.display.source;
  const std::string value =
      error == nullptr ? "" : fmt::format("{} %", numberText(100.0 * error->relative, 2));
  if (buttonLine(panel.style, {.name = name, .label = label, .value = value, .selected = shown == source}))
    shown = source;
  std::string more = help;
  if (error != nullptr) {
    more += fmt::format(" {} ± {} % (root of the mean squared relative difference); on average {:+.2f} %.",
                        numberText(100.0 * error->relative, 3), numberText(100.0 * error->standardError, 1),
                        100.0 * error->bias);
  }
  tooltip(panel.style, name, "", more);
}

void drawErrorSources(const ViewPanel& panel) {
  const ErrorSources* known = panel.input.errorSources.get();
  heading(panel.style.palette, "Where the error comes from");
  drawSource(panel, {}, "source.largest", "Which is largest",
             known == nullptr ? nullptr : &known->picture.total,
             "Shows for each pixel the source of most of its error. The number is that of all together.");
  for (const ErrorSourceInfo& info : errorSourceInfos()) {
    const SourceError* error =
        known == nullptr ? nullptr : &known->picture.ofSource[static_cast<std::size_t>(info.source)];
    drawSource(panel, info.source, choiceName(kErrorSourceNames, info.source), info.label, error,
               fmt::format("{} Smaller with {}.", info.help, info.remedy));
  }
  if (!panel.input.errorSourcesNote.empty()) noteText(panel.style.palette, panel.input.errorSourcesNote);
}

void drawComparison(const ViewPanel& panel) {
  Comparison& comparison = panel.workspace.display.comparison;
  heading(panel.style.palette, "Compare");
  drawActionLine(panel, ActionId::CompareKeep);
  std::array<const char*, kCompareWithNames.size()> rivals{};
  for (std::size_t i = 0; i < rivals.size(); ++i) rivals[i] = kCompareWithNames[i].name;
  const auto with = choiceLine(panel.style, {.name = "compare.with", .label = "With"}, rivals,
                               static_cast<std::size_t>(comparison.with));
  if (with) comparison.with = kCompareWithNames[*with].value;
  const Rival& rival = panel.input.rival(comparison.with);
  if (!rival.text.empty()) noteText(panel.style.palette, rival.text);
  if (!panel.input.errorNote.empty()) noteText(panel.style.palette, panel.input.errorNote);
  drawActionLine(panel, ActionId::ReferenceTrace, panel.input.tracesReference);

  drawActionLine(panel, ActionId::CompareFlip, comparison.flipped);
  for (const ActionId id :
       {ActionId::CompareSideBySide, ActionId::CompareWipe, ActionId::CompareDifference}) {
    const ActionStatus status = actionStatus(id, panel.workspace, panel.input, panel.state);
    drawActionLine(panel, id, status.checked.value_or(false));
  }
  if (comparison.mode == CompareMode::Wipe && rival.available) {
    plainNumberLine(panel.style, "compare.wipe_position", "Wipe at", comparison.wipe,
                    {.reset = 0.5, .unit = "%", .shownTimes = 100.0});
  }
  drawActionLine(panel, ActionId::CompareSwap);
}

}  // namespace

void drawViewPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  const ViewPanel panel{workspace, input, state, output,
                        ControlStyle{paletteOf(workspace.display.theme), state.controls}};
  drawViews(panel);
  if (workspace.display.view == PictureView::ErrorSources) drawErrorSources(panel);
  drawExposure(panel);
  if (input.shown && input.shown->kind == ViewKind::Scalar) drawScale(panel, *input.shown);
  heading(panel.style.palette, "Picture");
  toggleLine(panel.style, {.name = "smooth", .label = "Smooth when magnified"}, workspace.display.smooth);
  tooltip(panel.style, "smooth", "Blends magnified pixels; otherwise each is a square of one colour.",
          ChangeCost::Display);
  toggleLine(panel.style, {.name = "view.legend", .label = "Legend"}, workspace.display.legend);
  tooltip(panel.style, "view.legend", actionInfo(ActionId::Legend).help, ChangeCost::Display);
  drawComparison(panel);
}

}  // namespace lightvane
