#include "app/panels/overlay_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

// Long enough to see what happens where, short enough to be played again.
constexpr double kPlaySeconds = 10.0;

constexpr ValueScale kSizes = ValueScale::linear(0.25, 4.0);

/// One kind of overlay and what can be set of it.
struct KindLine {
  OverlayKind kind;
  ActionId action;
  bool hasSize;  ///< others are drawn at true size
};
constexpr std::array kIlvKinds{KindLine{OverlayKind::Ilv, ActionId::OverlayIlv, true},
                               KindLine{OverlayKind::IlvZones, ActionId::OverlayIlvZones, false},
                               KindLine{OverlayKind::IlvGradients, ActionId::OverlayIlvGradients, true}};
constexpr std::array kDlvKinds{KindLine{OverlayKind::Dlv, ActionId::OverlayDlv, true},
                               KindLine{OverlayKind::DlvRadius, ActionId::OverlayDlvRadius, false},
                               KindLine{OverlayKind::DlvDirections, ActionId::OverlayDlvDirections, true}};
constexpr KindLine kMirrorImages{OverlayKind::MirrorImages, ActionId::OverlayMirrorImages, true};

struct OverlayPanel {
  Workspace& workspace;
  const PanelInput& input;
  PanelState& state;
  PanelOutput& output;
  ControlStyle style;

  OverlaySettings& overlays() const { return workspace.display.overlays; }
};

/// A switch that is an action; its key stands in the tooltip, as the switch is where a line's value would be.
void drawSwitch(const OverlayPanel& panel, ActionId id, bool dimmed) {
  const ActionInfo& info = actionInfo(id);
  const ActionStatus status = actionStatus(id, panel.workspace, panel.input, panel.state);
  bool on = status.checked.value_or(false);
  if (toggleLine(panel.style, {.name = info.name, .label = info.label, .dimmed = dimmed}, on)) {
    applyAction(id, panel.workspace, panel.input, panel.state, panel.output);
  }
  const std::string key = panel.input.keys->textOf(id);
  tooltip(panel.style, info.name, key.empty() ? info.help : fmt::format("{} ({})", info.help, key),
          ChangeCost::Display);
}

void drawKind(const OverlayPanel& panel, const KindLine& line) {
  OverlaySwitch& layer = panel.overlays().layer(line.kind);
  const bool dimmed = !panel.overlays().shown;
  drawSwitch(panel, line.action, dimmed);
  if (!layer.shown) return;
  const OverlaySwitch usual = OverlaySettings{}.layer(line.kind);
  const std::string name = actionInfo(line.action).name;
  const float indent = 0.9f * ImGui::GetFontSize();
  ImGui::Indent(indent);
  if (line.hasSize) {
    plainNumberLine(panel.style, name + ".size", "Size", layer.size,
                    {.min = 0.1,
                     .max = 20.0,
                     .scale = kSizes,
                     .reset = static_cast<double>(usual.size),
                     .help = "How large they are drawn, beside their usual size.",
                     .cost = ChangeCost::Display},
                    dimmed);
  }
  plainNumberLine(panel.style, name + ".opacity", "Opacity", layer.opacity,
                  {.reset = static_cast<double>(usual.opacity),
                   .unit = "%",
                   .shownTimes = 100.0,
                   .help = "How much of the picture they cover.",
                   .cost = ChangeCost::Display},
                  dimmed);
  ImGui::Unindent(indent);
}

void drawIlvColoring(const OverlayPanel& panel) {
  VectorColoring& coloring = panel.overlays().coloring;
  std::array<const char*, kVectorColoringNames.size()> names{};
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kVectorColoringNames[i].name;
  const auto chosen = choiceLine(panel.style, {.name = "overlay.coloring", .label = "Colour by"}, names,
                                 static_cast<std::size_t>(coloring));
  tooltip(panel.style, "overlay.coloring", "What the colour of an ILV says; the legend has the scale.",
          ChangeCost::Display);
  if (chosen) coloring = kVectorColoringNames[*chosen].value;
}

void drawMost(const OverlayPanel& panel) {
  constexpr int kMost = 10'000'000;
  const double usual = OverlaySettings{}.mostRecords;
  auto most = static_cast<float>(panel.overlays().mostRecords);
  const auto current = static_cast<double>(most);
  if (plainNumberLine(
          panel.style, "overlay.most", "At most", most,
          {.min = 1.0,
           .max = kMost,
           .scale = ValueScale::about(1.0, kMost, usual, current, true),
           .reset = usual,
           .help = "Vectors of each kind in a picture of 640 x 640 points on the screen: fewer in a "
                   "smaller one, more where it is magnified. Of more, every n-th is shown, and the "
                   "legend says so.",
           .cost = ChangeCost::Display})) {
    panel.overlays().mostRecords = static_cast<int>(std::lround(most));
  }
}

/// The time slider.
void drawGrowth(const OverlayPanel& panel) {
  GrowthTime& growth = panel.overlays().growth;
  const std::uint64_t moments = momentsOf(panel.input.passLengths);
  heading(panel.style.palette, "Growth");
  drawSwitch(panel, ActionId::GrowthPlay, moments == 0);
  // On the slider's right end, everything is shown, and what comes later too.
  const double fraction = growth.all || moments == 0 ? 1.0
                                                     : static_cast<double>(std::min(growth.moment, moments)) /
                                                           static_cast<double>(moments);
  const std::string value =
      growth.all ? "all" : fmt::format("{} of {}", countText(growth.moment), countText(moments));
  const NumberChange change = numberLine(
      panel.style, {.name = "growth.moment", .label = "Moment", .value = value, .dimmed = moments == 0},
      {.value = fraction, .typing = std::to_string(growth.all ? moments : growth.moment)});
  if (change.dragged) {
    growth.playing = false;
    growth.all = *change.dragged >= 1.0;
    growth.moment = static_cast<std::uint64_t>(std::llround(*change.dragged * static_cast<double>(moments)));
  }
  if (change.typed) {
    std::uint64_t typed = 0;
    if (const std::string expected = parameter_text::parse(*change.typed, typed); !expected.empty()) {
      refuseTyped(panel.state.controls, fmt::format("takes {}, not '{}'", expected, *change.typed));
    } else {
      growth = GrowthTime{.all = typed >= moments, .moment = typed};
      acceptTyped(panel.state.controls);
    }
  }
  tooltip(panel.style, "growth.moment",
          "Shows the vectors that there were at this moment: pass by pass, one of each kind at a time.",
          ChangeCost::Display);
  if (!growth.all) noteText(panel.style.palette, momentText(panel.input.passLengths, growth.moment));
}

bool anyLightHasVectors(const PanelInput& input) {
  return input.scene && std::any_of(input.scene->lights.begin(), input.scene->lights.end(),
                                    [](const SceneLight& light) { return light.hasVectors; });
}

}  // namespace

void drawOverlayPanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  const OverlayPanel panel{workspace, input, state, output,
                           ControlStyle{paletteOf(workspace.display.theme), state.controls}};
  drawSwitch(panel, ActionId::OverlayAll, false);
  heading(panel.style.palette, "Indirect light vectors");
  for (const KindLine& line : kIlvKinds) drawKind(panel, line);
  drawIlvColoring(panel);
  heading(panel.style.palette, "Direct light vectors");
  if (input.scene && !anyLightHasVectors(input)) {
    noteText(panel.style.palette, "No light of this scene has them (dlv.mode).");
  }
  for (const KindLine& line : kDlvKinds) drawKind(panel, line);
  if (input.scene && input.scene->needs.specular) {
    heading(panel.style.palette, "Mirrors");
    drawKind(panel, kMirrorImages);
  }
  heading(panel.style.palette, "How many");
  drawMost(panel);
  drawGrowth(panel);
  if (input.overlay != nullptr) {
    // The legend over the picture leaves them out where it would hide too much of that.
    for (const OverlayLegendEntry& entry : input.overlay->legend)
      markedText(toImU32(entry.color), entry.text);
    for (const std::string& count : input.overlay->counts) noteText(panel.style.palette, count);
    for (const std::string& scale : input.overlay->scales) noteText(panel.style.palette, scale);
    for (const std::string& note : input.overlay->notes) noteText(panel.style.palette, note);
  }
}

bool advanceGrowth(GrowthTime& growth, std::uint64_t moments, double secondsPassed) {
  if (!growth.playing) return false;
  const double perSecond = static_cast<double>(moments) / kPlaySeconds;
  // At least one, so that few vectors do not take for ever.
  const double step = std::max(1.0, std::round(perSecond * secondsPassed));
  growth.moment += static_cast<std::uint64_t>(step);
  if (growth.moment < moments) return true;
  growth = GrowthTime{};
  return false;
}

}  // namespace lightvane
