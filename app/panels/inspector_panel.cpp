#include "app/panels/inspector_panel.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/hemisphere_view.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"
#include "core/inspect/record_names.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

struct InspectorPanel {
  Workspace& workspace;
  const PanelInput& input;
  PanelState& state;
  PanelOutput& output;
  ControlStyle style;
  /// Where the selected vector's facts stand below its line among the pixel's: until they were drawn there.
  mutable bool recordIsListed = false;
};

std::string radianceText(const Rgb& value) { return fmt::format("{} {}", rgbText(value), kRadianceUnit); }

/// A button that is an action, with its key.
void drawAction(const InspectorPanel& panel, ActionId id, const std::string& label) {
  const ActionInfo& info = actionInfo(id);
  const ActionStatus status = actionStatus(id, panel.workspace, panel.input, panel.state);
  const bool clicked = buttonLine(panel.style, {.name = info.name,
                                                .label = label,
                                                .value = panel.input.keys->textOf(id),
                                                .dimmed = !status.isEnabled()});
  tooltip(panel.style, info.name, "", status.isEnabled() ? info.help : status.whyNot);
  if (clicked) applyAction(id, panel.workspace, panel.input, panel.state, panel.output);
}

/// A line that unfolds what follows it. Whether it is unfolded is kept under its name.
bool drawFold(const InspectorPanel& panel, const std::string& name, const std::string& label,
              const std::string& value) {
  std::set<std::string>& unfolded = panel.state.inspector.unfolded;
  const bool open = unfolded.contains(name);
  const bool clicked = buttonLine(
      panel.style, {.name = name, .label = label, .value = value, .indent = 0.7f * foldMarkWidth()});
  drawFoldMark(panel.style.palette, open);
  if (clicked) {
    open ? static_cast<void>(unfolded.erase(name)) : static_cast<void>(unfolded.insert(name));
  }
  return open;
}

/// All that is known of the selected vector.
void drawRecord(const InspectorPanel& panel) {
  const Palette& palette = panel.style.palette;
  const std::size_t more = panel.workspace.selection.records.size() - 1;
  if (panel.input.record == nullptr) return noteText(palette, "...");
  const RecordReport& report = *panel.input.record;
  heading(palette, more == 0 ? report.title : fmt::format("{} and {} more", report.title, countText(more)));
  if (panel.input.selectionIsPinned) noteText(palette, "Pinned: it stays whatever becomes of the others.");
  for (const ActionId id : {ActionId::RecordsPin, ActionId::RecordsRecompute, ActionId::RecordsDelete})
    drawAction(panel, id, actionInfo(id).label);
  if (report.recomputation != Recomputation::Same && !report.note.empty()) {
    markedText(palette.warning, report.note);
  } else if (!report.note.empty()) {
    noteText(palette, report.note);
  }
  if (!report.hemisphere.cells.empty()) {
    bool& distances = panel.state.inspector.distances;
    toggleLine(panel.style, {.name = "inspector.distances", .label = "Distances instead of light"},
               distances);
    drawHemisphere(panel.style, report.hemisphere,
                   distances ? HemisphereLook::Distance : HemisphereLook::Radiance,
                   *panel.input.compiledScene);
  }
  for (const ReportRow& row : report.rows) factLine(palette, row.label, row.text);
}

std::string weightText(const CandidateReport& candidate) {
  return fmt::format("weight {}", numberText(static_cast<double>(candidate.weight)));
}

/// What the vector's gradient predicts for the point.
std::string changeText(const CandidateReport& candidate) {
  // Plus 0: not "-0 %".
  return fmt::format("change {:.0f} %",
                     std::round(100.0 * static_cast<double>(candidate.relativeChange)) + 0.0);
}

/// What a candidate's second line says: how much it counted, or why not at all.
std::string candidateNote(const CandidateReport& candidate) {
  if (!candidate.rule.empty()) return candidate.verdict;
  std::string note = weightText(candidate);
  if (candidate.record.isIndirect()) note += ", " + changeText(candidate);
  if (candidate.hidden) note += ", hidden: it leaks";
  return candidate.own ? note + ", computed here" : note;
}

std::string candidateTooltip(const CandidateReport& candidate) {
  std::string text = fmt::format("{}\n{}", candidate.verdict, weightText(candidate));
  if (candidate.record.isIndirect())
    text += fmt::format("\n{} of its light, by its gradient", changeText(candidate));
  if (candidate.hidden) text += "\nSomething stands between it and the point: its light leaks.";
  return text;
}

/// Two lines on a vector: which one, where, its share as a bar; its weight, or what refused it.
void drawCandidate(const InspectorPanel& panel, const std::string& name, const CandidateReport& candidate,
                   const Rgb& whole) {
  const Palette& palette = panel.style.palette;
  const float em = ImGui::GetFontSize();
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const ImVec2 size{ImGui::GetContentRegionAvail().x, 2.0f * em + 2.5f * padding.y};
  const bool clicked = ImGui::InvisibleButton(name.c_str(), size);
  Widgets::recordItem(name);
  Selection& selection = panel.workspace.selection;
  if (clicked) selection.records = {candidate.record};
  const bool isPointedAt = ImGui::IsItemHovered();
  if (isPointedAt) selection.hoveredRecord = candidate.record;

  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const bool isSelected = std::find(selection.records.begin(), selection.records.end(), candidate.record) !=
                          selection.records.end();
  const bool isHovered = selection.hoveredRecord == candidate.record;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  list.AddRectFilled(min, max, isHovered ? palette.frameHovered : palette.frame, rounding);
  const float whole_ = luminance(whole);
  const float part = whole_ > 0.0f ? std::clamp(luminance(candidate.share) / whole_, 0.0f, 1.0f) : 0.0f;
  if (part > 0.0f) list.AddRectFilled(min, {min.x + part * size.x, max.y}, palette.fill, rounding);
  if (isSelected) list.AddRect(min, max, palette.accent, rounding);
  if (isHovered && !isPointedAt) {
    // Its marker is under the mouse: the row is to be found.
    list.AddRect(min, max, palette.text, rounding, 0, std::max(1.0f, 0.12f * em));
    if (panel.state.inspector.shown != candidate.record) ImGui::SetScrollHereY(0.5f);
    panel.state.inspector.shown = candidate.record;
  }

  const float room = size.x - 2.0f * padding.x;
  const std::string share = candidate.used                  ? shareText(candidate.share, whole)
                            : candidate.rule == "not asked" ? "not asked"
                                                            : "refused";
  const float shareWidth = ImGui::CalcTextSize(share.c_str()).x;
  const Scene& scene = *panel.input.compiledScene;
  const std::string which =
      fmt::format("{}, {}, {}",
                  candidate.record.isIndirect() ? recordName(scene, candidate.record)
                                                : fmt::format("DLV {}", candidate.record.number),
                  lengthText(scene, static_cast<double>(candidate.distance)),
                  angleText(static_cast<double>(candidate.angle)));
  const ImU32 strong = candidate.used ? palette.text : palette.dim;
  list.AddText({min.x + padding.x, min.y + padding.y}, strong,
               fitted(which, room - shareWidth - 0.5f * em).c_str());
  list.AddText({max.x - padding.x - shareWidth, min.y + padding.y}, strong, share.c_str());
  list.AddText({min.x + padding.x, min.y + 1.5f * padding.y + em}, palette.dim,
               fitted(candidateNote(candidate), room).c_str());
  tooltip(panel.style, name, recordName(scene, candidate.record), candidateTooltip(candidate));
  if (!panel.recordIsListed || clicked || !isSelected || selection.records.front() != candidate.record)
    return;
  panel.recordIsListed = false;
  ImGui::Indent(em);
  drawRecord(panel);
  ImGui::Unindent(em);
}

std::string answerName(std::size_t point, const char* kind, std::size_t index) {
  return fmt::format("inspector.point.{}.{}.{}", point, kind, index);
}

/// The candidates' numbers, in the order in which they are listed.
std::vector<std::size_t> shownCandidates(const AnswerReport& answer, bool byShare) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < answer.candidates.size(); ++i) {
    if (!byShare || answer.candidates[i].used) shown.push_back(i);
  }
  if (byShare) {
    std::stable_sort(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) {
      return luminance(answer.candidates[a].share) > luminance(answer.candidates[b].share);
    });
  }
  return shown;
}

/// What one light, or the vectors of one key, gave a point.
void drawAnswer(const InspectorPanel& panel, const std::string& name, const AnswerReport& answer,
                const Rgb& whole) {
  const std::string share = shareText(answer.radiance, whole);
  const bool open = drawFold(panel, name, answer.name, share);
  tooltip(panel.style, name, answer.name,
          fmt::format("{}\n{}", answerOriginName(answer.origin), radianceText(answer.radiance)));
  if (!open) return;
  factLine(panel.style.palette, "origin", answerOriginName(answer.origin));
  factLine(panel.style.palette, "radiance", radianceText(answer.radiance));
  if (!answer.note.empty()) noteText(panel.style.palette, answer.note);
  const bool byShare = panel.state.inspector.byShare;
  for (const std::size_t i : shownCandidates(answer, byShare)) {
    drawCandidate(panel, fmt::format("{}.{}", name, i), answer.candidates[i], answer.explained);
  }
  if (answer.omitted > 0 && !byShare) {
    noteText(panel.style.palette,
             fmt::format("{} more, farther away, were refused", countText(answer.omitted)));
  }
}

void drawPoint(const InspectorPanel& panel, std::size_t index, const PointReport& point) {
  const Palette& palette = panel.style.palette;
  const Scene& scene = *panel.input.compiledScene;
  const std::string name = fmt::format("inspector.point.{}", index);
  heading(palette, fmt::format("Point {}: {}", index + 1, point.shape));
  noteText(palette, point.reached);
  const Rgb whole = point.direct + point.indirectSum;
  for (std::size_t i = 0; i < point.lights.size(); ++i) {
    drawAnswer(panel, answerName(index, "light", i), point.lights[i], whole);
  }
  if (!isBlack(point.mirrored)) factLine(palette, "lights in mirrors", shareText(point.mirrored, whole));
  for (std::size_t i = 0; i < point.indirect.size(); ++i) {
    drawAnswer(panel, answerName(index, "indirect", i), point.indirect[i], whole);
  }
  if (drawFold(panel, name + ".place", "Place", point.material)) {
    factLine(palette, "position", pointText(scene, point.position));
    factLine(palette, "normal", rgbText(point.normal));
    factLine(palette, "throughput", rgbText(point.throughput));
    factLine(palette, "clearance", lengthText(scene, static_cast<double>(point.clearance)));
  }
}

void drawLayers(const InspectorPanel& panel, const PixelReport& report) {
  const Palette& palette = panel.style.palette;
  factLine(palette, "shown", radianceText(report.shown));
  const Rgb whole = report.total();
  const auto layer = [&](const char* label, const Rgb& value) {
    if (!isBlack(value)) factLine(palette, label, shareText(value, whole));
  };
  layer("emission", report.emission);
  layer("direct", report.direct);
  layer("indirect", report.indirect);
  layer("specular", report.specular);
}

/// A part of a difference in percent of the whole, with its sign.
std::string signedPercent(const Vec3d& part, const Vec3d& whole) {
  const auto bright = [](const Vec3d& v) { return static_cast<double>(luminance(Rgb(v))); };
  return bright(whole) > 0.0 ? fmt::format("{:+.1f} %", 100.0 * bright(part) / bright(whole)) : "none";
}

bool isNothing(const FullValue& value) { return value.full == Vec3d(0.0) && value.shown == Vec3d(0.0); }

void drawDifference(const Palette& palette, const char* label, const FullValue& value) {
  heading(palette, label);
  factLine(palette, "shown", radianceText(Rgb(value.shown)));
  factLine(palette, "in full", radianceText(Rgb(value.full)));
  factLine(palette, "difference", signedPercent(value.shown - value.full, value.full));
}

void drawFullValue(const Palette& palette, const char* label, const FullValue& value) {
  if (isNothing(value)) return;
  drawDifference(palette, label, value);
  factLine(palette, "by interpolation", signedPercent(value.parts.interpolation, value.full));
  factLine(palette, "by the vectors' noise", signedPercent(value.parts.noise, value.full));
  const auto partLine = [&](const char* name, const Vec3d& part) {
    if (part != Vec3d(0.0)) factLine(palette, name, signedPercent(part, value.full));
  };
  partLine("by one direction", value.parts.singleDirection);
  partLine("by leaks", value.parts.leaks);
  partLine("by missing bounces", value.parts.missingBounces);
}

void drawFullComputation(const InspectorPanel& panel) {
  const PanelInput& input = panel.input;
  drawAction(panel, ActionId::ComputeHere, actionInfo(ActionId::ComputeHere).label);
  if (!input.fullProgress.empty()) noteText(panel.style.palette, input.fullProgress);
  if (input.full == nullptr) return;
  const FullComputation& full = *input.full;
  if (!full.note.empty()) noteText(panel.style.palette, full.note);
  if (!full.finished) return;
  drawFullValue(panel.style.palette, "Direct", full.values.direct);
  if (!isNothing(full.values.mirrored)) {
    drawDifference(panel.style.palette, "Lights in mirrors", full.values.mirrored);
    noteText(panel.style.palette, "Sampled at the pixel: all of it is noise of light.samples.");
  }
  drawFullValue(panel.style.palette, "Indirect", full.values.indirect);
  const int kinds = (isNothing(full.values.direct) ? 0 : 1) + (isNothing(full.values.mirrored) ? 0 : 1) +
                    (isNothing(full.values.indirect) ? 0 : 1);
  if (kinds > 1) {
    drawFullValue(panel.style.palette, "Together", full.total);
  }
  noteText(panel.style.palette, fmt::format("{} samples; standard error of the full value {}",
                                            countText(static_cast<std::size_t>(full.samples)),
                                            shareText(Rgb(full.standardError), Rgb(full.total.full))));
}

void drawPixel(const InspectorPanel& panel) {
  const Palette& palette = panel.style.palette;
  if (!panel.workspace.selection.pixel)
    return noteText(palette, "Click a pixel of the picture, or a vector.");
  const PixelRef pixel = *panel.workspace.selection.pixel;
  heading(palette, fmt::format("Pixel {}, {}", pixel.x, pixel.y));
  if (panel.input.pixel == nullptr) return noteText(palette, "...");
  const PixelReport& report = *panel.input.pixel;
  if (!report.note.empty()) noteText(palette, report.note);
  drawLayers(panel, report);
  drawFullComputation(panel);
  if (!report.points.empty()) {
    toggleLine(panel.style, {.name = "inspector.by_share", .label = "Used vectors only, largest share first"},
               panel.state.inspector.byShare);
    tooltip(panel.style, "inspector.by_share", "",
            "Lists what gave the pixel its light, the most of it first; otherwise every candidate, the "
            "nearest first.");
  }
  for (std::size_t i = 0; i < report.points.size(); ++i) drawPoint(panel, i, report.points[i]);
}

/// Whether the selected vector is one of the candidates that are unfolded.
bool isListed(const InspectorPanel& panel) {
  const Selection& selection = panel.workspace.selection;
  if (panel.input.pixel == nullptr || !selection.pixel || selection.records.empty()) return false;
  const std::set<std::string>& unfolded = panel.state.inspector.unfolded;
  const auto lists = [&](const std::string& name, const AnswerReport& answer) {
    return unfolded.contains(name) && std::any_of(answer.candidates.begin(), answer.candidates.end(),
                                                  [&](const CandidateReport& candidate) {
                                                    return candidate.record == selection.records.front();
                                                  });
  };
  for (std::size_t p = 0; p < panel.input.pixel->points.size(); ++p) {
    const PointReport& point = panel.input.pixel->points[p];
    for (std::size_t i = 0; i < point.lights.size(); ++i) {
      if (lists(answerName(p, "light", i), point.lights[i])) return true;
    }
    for (std::size_t i = 0; i < point.indirect.size(); ++i) {
      if (lists(answerName(p, "indirect", i), point.indirect[i])) return true;
    }
  }
  return false;
}

}  // namespace

std::string shareText(const Rgb& part, const Rgb& whole) {
  const float all = luminance(whole);
  return all > 0.0f ? fmt::format("{:.1f} %", 100.0 * static_cast<double>(luminance(part) / all))
                    : std::string();
}

void drawInspectorPanel(Workspace& workspace, const PanelInput& input, PanelState& state,
                        PanelOutput& output) {
  const InspectorPanel panel{workspace, input, state, output,
                             ControlStyle{paletteOf(workspace.display.theme), state.controls}};
  if (input.compiledScene == nullptr) return noteText(panel.style.palette, "No scene is open.");
  panel.recordIsListed = isListed(panel);
  if (!workspace.selection.records.empty() && !panel.recordIsListed) {
    drawRecord(panel);
    ImGui::Separator();
  }
  drawPixel(panel);
}

}  // namespace lightvane
