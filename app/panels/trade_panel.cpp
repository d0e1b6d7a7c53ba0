#include "app/panels/trade_panel.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/apply_action.h"
#include "app/panels/controls.h"
#include "app/panels/path_completion.h"
#include "app/panels/path_field.h"
#include "app/panels/trade_plot.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"
#include "core/measure/sweep_html.h"
#include "core/measure/sweep_run.h"

namespace lightvane {
namespace {

constexpr std::array kReductions = {1, 2, 4, 8};
constexpr std::array<const char*, 2> kReferences = {"path traced here", "a file"};
constexpr std::array<const char*, 2> kLimits = {"error", "CPU time"};

constexpr const char* kCpuTimeHelp =
    "CPU time is that of the measurement's one thread alone, which the window and its picture do not share: "
    "the time of a rendering with --threads 1. What the machine does otherwise still slows it a little, "
    "which "
    "is why points take turns, seed by seed.";

struct TradePanel {
  Workspace& workspace;
  const PanelInput& input;
  TradePanelState& own;
  PanelState& state;
  PanelOutput& output;
  ControlStyle style;
};

std::string countOf(std::size_t count, const char* one, const char* many) {
  return fmt::format("{} {}", countText(count), count == 1 ? one : many);
}

/// What belongs together and stands side by side: so many buttons share a line.
ControlStyle shareOfLine(const ControlStyle& style, int buttons) {
  ControlStyle share = style;
  const float spacing = ImGui::GetStyle().ItemSpacing.x;
  const auto count = static_cast<float>(buttons);
  share.width = (ImGui::GetContentRegionAvail().x - (count - 1.0f) * spacing) / count;
  return share;
}

// ---- what is to be measured

void drawVaried(const TradePanel& panel) {
  heading(panel.style.palette, "Vary");
  for (std::size_t i = 0; i < panel.own.varied.size(); ++i) {
    const std::string name = fmt::format("trade.varied.{}", i);
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
    if (ImGui::InputTextWithHint(("##" + name).c_str(), "key=a,b,c or key=low:high:n", &panel.own.varied[i]))
      panel.own.error.clear();
    Widgets::recordItem(name, panel.own.varied[i]);
    tooltip(panel.style, name, "",
            "A parameter and its values, as for lightvane sweep: all combinations are measured.\n"
            "ilv.n_min=2,4,8: these values.\n"
            "ilv.radius_scale=0.2:0.8:4: four from 0.2 to 0.8, at equal ratios.");
  }
}

void drawPictureSize(const TradePanel& panel) {
  if (panel.own.fromFile) return;
  const CameraDescription& camera = panel.workspace.setup.camera;
  std::array<std::string, kReductions.size()> texts;
  std::array<const char*, kReductions.size()> names{};
  std::size_t current = 0;
  for (std::size_t i = 0; i < kReductions.size(); ++i) {
    const int by = kReductions[i];
    texts[i] = fmt::format("{} x {}{}", (camera.width + by - 1) / by, (camera.height + by - 1) / by,
                           by == 1 ? ": all of it" : fmt::format(": 1/{}", by));
    names[i] = texts[i].c_str();
    if (by == panel.own.reduction) current = i;
  }
  const auto chosen = choiceLine(panel.style, {.name = "trade.size", .label = "Pictures of"}, names, current);
  tooltip(panel.style, "trade.size", "",
          "Small pictures are fast. Errors of theirs say which parameters are better, and not by how much "
          "in the whole picture.");
  if (chosen) panel.own.reduction = kReductions[*chosen];
}

void drawReference(const TradePanel& panel) {
  TradePanelState& own = panel.own;
  const auto chosen = choiceLine(panel.style, {.name = "trade.reference", .label = "Reference"}, kReferences,
                                 own.fromFile ? 1 : 0);
  tooltip(panel.style, "trade.reference", "", "What errors are measured against.");
  if (chosen) own.fromFile = *chosen == 1;
  if (own.fromFile) {
    const std::string before = own.path;
    pathField("trade.path", own.path, {}, panel.input.completePath);
    if (own.path != before) own.error.clear();
    tooltip(panel.style, "trade.path", "",
            "An .exr of lightvane reference, of this view and these lights. Pictures are measured at its "
            "size: the window's, or that divided by a whole number.");
    return;
  }
  plainNumberLine(panel.style, "trade.noise", "Noise at most", own.noise,
                  {.min = 1e-4,
                   .max = 1.0,
                   .scale = ValueScale::about(1e-4, 1.0, static_cast<double>(kTradeNoise),
                                              static_cast<double>(own.noise), false),
                   .reset = static_cast<double>(kTradeNoise),
                   .unit = "%",
                   .shownTimes = 100.0,
                   .help = "Paths are traced until the error of a perfect picture against them is no larger. "
                           "Half of it takes four times as long. They are kept for the next measurement. "
                           "Errors that are means of squares leave the noise out, others have it in them."});
}

void drawSetup(const TradePanel& panel) {
  TradePanelState& own = panel.own;
  drawVaried(panel);
  ImGui::Dummy({0.0f, 0.1f * ImGui::GetFontSize()});
  if (plainNumberLine(panel.style, "trade.seeds", "Seeds", own.seeds,
                      {.min = 1.0,
                       .max = kMostTradeSeeds,
                       .scale = ValueScale::linear(1.0, 10.0),
                       .reset = 3.0,
                       .help = "Each point is measured so many times. What these differ by says how sure "
                               "its error is; of one nothing does."}))
    own.seeds = std::round(own.seeds);
  drawPictureSize(panel);
  drawReference(panel);
  toggleLine(panel.style, {.name = "trade.waits", .label = "Wait for the picture"}, own.waits);
  tooltip(panel.style, "trade.waits", "",
          fmt::format("Measures only while the window's own picture rests.\n{}", kCpuTimeHelp));
}

void drawButtons(const TradePanel& panel) {
  TradePanelState& own = panel.own;
  const TradeStatus& trade = panel.input.trade;
  const ControlStyle third = shareOfLine(panel.style, 3);
  const bool startClicked =
      buttonLine(third, {.name = "trade.start", .label = "Start", .dimmed = trade.isRunning});
  tooltip(third, "trade.start", "",
          trade.isRunning ? "It is under way." : "Measures this view as it is now. Points from before go.");
  if (startClicked && !trade.isRunning) {
    auto plan = tradePlan(own, panel.workspace.setup.parameters);
    own.error = plan ? std::string() : plan.error().message();
    own.setupOpen = !plan.has_value();
    if (plan) {
      own.selected.reset();
      panel.output.measureTrade = *std::move(plan);
    }
  }
  ImGui::SameLine();
  if (buttonLine(third, {.name = "trade.stop", .label = "Stop", .dimmed = !trade.isRunning}))
    panel.output.stopTrade = trade.isRunning;
  tooltip(third, "trade.stop", "", "Ends the measurement. What was measured stays.");
  ImGui::SameLine();
  const bool isEmpty = trade.sweep == nullptr && !trade.isRunning && trade.error.empty();
  if (buttonLine(third, {.name = "trade.clear", .label = "Clear", .dimmed = isEmpty})) {
    panel.output.clearTrade = !isEmpty;
    own.selected.reset();
    own.setupOpen = true;
  }
  tooltip(third, "trade.clear", "", "Forgets all points.");
}

void drawTradeProgress(const TradePanel& panel) {
  const TradeStatus& trade = panel.input.trade;
  const Palette& palette = panel.style.palette;
  if (!panel.own.error.empty()) {
    markedText(palette.error, panel.own.error);
    Widgets::recordItem("trade.error", panel.own.error);
  }
  if (!trade.error.empty()) {
    markedText(palette.error, trade.error);
    Widgets::recordItem("trade.problem", trade.error);
  }
  if (trade.stage.empty()) return;
  if (trade.isRunning) {
    const ImVec2 size{ImGui::GetContentRegionAvail().x, std::round(0.3f * ImGui::GetFontSize())};
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float rounding = 0.5f * size.y;
    list.AddRectFilled(at, {at.x + size.x, at.y + size.y}, palette.frame, rounding);
    const auto part = static_cast<float>(std::clamp(trade.fraction, 0.0, 1.0));
    if (part > 0.0f) {
      list.AddRectFilled(at, {at.x + std::max(part * size.x, size.y), at.y + size.y},
                         trade.isWaiting ? palette.dim : palette.accent, rounding);
    }
  }
  std::string text = trade.stage;
  // On one line, or what is below would jump from point to point.
  if (trade.isRunning) text = fitted(text, ImGui::GetContentRegionAvail().x);
  if (trade.isRunning && trade.isWaiting) {
    text += "\nWaits until the picture rests.";
  } else if (trade.isRunning && trade.secondsLeft) {
    text += fmt::format("\nAbout {} left.", durationText(*trade.secondsLeft));
  }
  noteText(palette, text);
  Widgets::recordItem("trade.stage", text);
  if (trade.isRunning) tooltip(panel.style, "trade.stage", "", trade.stage);
  if (!trade.isRunning || !trade.isTracing) return;
  if (buttonLine(panel.style, {.name = "trade.use_reference", .label = "Measure against it as it is"}))
    panel.output.useTradeReference = true;
  tooltip(
      panel.style, "trade.use_reference", "",
      "Traces no further. The noise is told beside the points, and the next measurement traces anew where "
      "it is to be smaller.");
}

// ---- what was measured

void listMetrics(TradePanelState& own, const std::shared_ptr<const Sweep>& sweep) {
  if (own.listed == sweep) return;
  own.listed = sweep;
  own.metrics = reportMetrics(*sweep, "");
  std::erase_if(own.metrics, [](const ReportMetric& metric) {
    return metric.info == nullptr || metric.info->better != BetterValue::Lower;
  });
}

const ReportMetric* chosenMetric(const TradePanelState& own) {
  const auto found = std::ranges::find(own.metrics, own.metric, &ReportMetric::key);
  if (found != own.metrics.end()) return &*found;
  return own.metrics.empty() ? nullptr : &own.metrics.front();
}

void drawMetricChoice(const TradePanel& panel, const ReportMetric& metric) {
  std::vector<std::string> texts;
  std::vector<const char*> names;
  for (const ReportMetric& each : panel.own.metrics)
    texts.push_back(each.layer == "beauty" ? each.label() : fmt::format("{}, {}", each.label(), each.layer));
  for (const std::string& text : texts) names.push_back(text.c_str());
  const auto current = static_cast<std::size_t>(&metric - panel.own.metrics.data());
  const auto chosen = choiceLine(panel.style, {.name = "trade.metric", .label = "Error"}, names, current);
  tooltip(panel.style, "trade.metric", "", metric.info->description);
  if (chosen) panel.own.metric = panel.own.metrics[*chosen].key;
}

/// The limit on errors, in the unit that is read.
float& mostErrorOf(TradePanelState& own, const Sweep& sweep, const ReportMetric& metric) {
  const auto found = own.mostError.find(metric.key);
  if (found != own.mostError.end()) return found->second;
  float usual = 1.0f;  // per cent
  const std::vector<std::size_t> front = paretoFront(sweep, metric.key);
  if (metric.unit().empty() && !front.empty()) {
    // Of other metrics nobody has a number in mind: one that some points keep within.
    const Spread middle = metricSpread(sweep.points[front[front.size() / 2]], metric.key).value_or(Spread{});
    if (middle.mean > 0.0 && std::isfinite(middle.mean))
      usual = static_cast<float>(std::stod(fmt::format("{:.2g}", 1.05 * middle.mean)));
  }
  return own.mostError[metric.key] = usual;
}

/// What keeps within the limit as it stands.
std::optional<SweepPick> pickWithinLimit(TradePanelState& own, const Sweep& sweep,
                                         const ReportMetric& metric) {
  if (own.limitsTime) return bestWithin(sweep, metric.key, static_cast<double>(own.mostSeconds));
  const double factor = metric.unit() == "%" ? 100.0 : 1.0;
  return fastestWithin(sweep, metric.key, static_cast<double>(mostErrorOf(own, sweep, metric)) / factor);
}

void select(const TradePanel& panel, std::size_t point) {
  panel.own.selected = point;
  panel.output.showTradePoint = point;
}

/// Of the front's end that a limit would let pass first.
std::string leastText(const Sweep& sweep, const ReportMetric& metric, bool ofTime) {
  const std::vector<std::size_t> front = paretoFront(sweep, metric.key);
  if (front.empty()) return "not known";
  const SweepPoint& point = sweep.points[ofTime ? front.front() : front.back()];
  return ofTime
             ? tradeTimeText(cpuSpread(point), point.runs.size())
             : tradeErrorText(metric, metricSpread(point, metric.key).value_or(Spread{}), point.runs.size());
}

void drawLimitChoice(const TradePanel& panel, const Sweep& sweep, const ReportMetric& metric,
                     const std::optional<SweepPick>& pick) {
  TradePanelState& own = panel.own;
  heading(panel.style.palette, "Choose by a limit");
  const bool limitsTime = own.limitsTime;
  float& most = limitsTime ? own.mostSeconds : mostErrorOf(own, sweep, metric);
  const auto limit = static_cast<double>(most);
  const std::string unit = limitsTime ? "s" : metric.unit();
  const auto chosen =
      choiceLine(panel.style, {.name = "trade.limits", .label = "Limit the"}, kLimits, limitsTime ? 1 : 0);
  if (chosen) own.limitsTime = *chosen == 1;
  constexpr double kLeast = 1e-6, kMost = 1e6;
  plainNumberLine(
      panel.style, "trade.most", "At most", most,
      {.min = kLeast,
       .max = kMost,
       .scale = ValueScale::about(kLeast, kMost, limitsTime ? 2.0 : 1.0, limit, false),
       .reset = limit,
       .unit = unit.c_str(),
       .help = "The point of the front whose mean keeps within it: the fastest one within a limit of error, "
               "the most exact one within a limit of time. A diamond marks it."});
  const std::string limitText = fmt::format("{}{}{}", shortNumber(limit), unit.empty() ? "" : " ", unit);
  if (!pick) {
    const std::string text =
        fmt::format("No point that was measured has {} of at most {}. The least is {}.",
                    limitsTime ? "a CPU time" : "an error", limitText, leastText(sweep, metric, limitsTime));
    markedText(panel.style.palette.warning, text);
    Widgets::recordItem("trade.pick", text);
    return;
  }
  const std::string text = tradePickText(*pick, metric, limitsTime, limitText, sweep.referenceNoise);
  wrappedText(sweep.points[pick->point].name());
  noteText(panel.style.palette, text);
  Widgets::recordItem("trade.pick", text);
  const bool isSelected = own.selected == pick->point;
  if (buttonLine(panel.style, {.name = "trade.select", .label = "Select it", .dimmed = isSelected}) &&
      !isSelected)
    select(panel, pick->point);
}

/// Settings a line each: a plot's tooltip and a point's facts are narrow.
std::string settingLines(const SweepPoint& point) {
  std::vector<std::string> lines;
  for (const auto& [key, value] : point.settings) lines.push_back(fmt::format("{} = {}", key, value));
  return lines.empty() ? point.method : fmt::format("{}", fmt::join(lines, "\n"));
}

void drawPlotTooltip(const TradePanel& panel, const Sweep& sweep, const ReportMetric& metric,
                     const std::optional<std::size_t>& hovered) {
  if (!hovered) return tooltip(panel.style, "trade.plot", "", kCpuTimeHelp);
  const SweepPoint& point = sweep.points[*hovered];
  const Spread error = metricSpread(point, metric.key).value_or(Spread{});
  showTooltip(panel.style.palette, settingLines(point),
              fmt::format("{}: {}\nCPU time: {}\n{}", metric.label(),
                          tradeErrorText(metric, error, point.runs.size()),
                          tradeTimeText(cpuSpread(point), point.runs.size()),
                          countOf(point.runs.size(), "seed", "seeds")));
}

void drawPlot(const TradePanel& panel, const Sweep& sweep, const ReportMetric& metric,
              const std::optional<SweepPick>& pick) {
  const float em = ImGui::GetFontSize();
  const float width = ImGui::GetContentRegionAvail().x;
  // All of it is to be seen at once, with what says what it is.
  const float tallest = std::max(0.7f * ImGui::GetWindowHeight(), 14.0f * em);
  const float height = std::clamp(0.85f * width, 14.0f * em, std::min(26.0f * em, tallest));
  const bool clicked = ImGui::InvisibleButton("trade.plot", {width, height});
  Widgets::recordItem("trade.plot");
  const bool isHovered = ImGui::IsItemHovered();
  const ScreenRect place{ImGui::GetItemRectMin(), ImGui::GetItemRectMax()};
  const TradePlotLayout layout = layoutTradePlot(sweep, metric, place);
  for (const TradePlotPoint& point : layout.points) {
    Widgets::record(fmt::format("trade.point.{}", point.point), {point.at.x - 1.0f, point.at.y - 1.0f},
                    {point.at.x + 1.0f, point.at.y + 1.0f}, sweep.points[point.point].name());
  }
  TradePlotMarks marks;
  if (isHovered) marks.hovered = tradePointAt(layout, ImGui::GetIO().MousePos, 0.8f * em);
  if (clicked && marks.hovered) select(panel, *marks.hovered);
  marks.selected = panel.own.selected;
  if (pick) marks.picked = pick->point;
  marks.isStale = !panel.input.trade.stale.empty();
  if (panel.own.limitsTime) {
    marks.mostSeconds = static_cast<double>(panel.own.mostSeconds);
  } else if (const auto most = panel.own.mostError.find(metric.key); most != panel.own.mostError.end()) {
    marks.mostError = static_cast<double>(most->second);
  }
  drawTradePlot(panel.style.palette, layout, metric, marks);
  if (isHovered) drawPlotTooltip(panel, sweep, metric, marks.hovered);
}

void drawSelected(const TradePanel& panel, const Sweep& sweep, const ReportMetric& metric) {
  TradePanelState& own = panel.own;
  const TradeStatus& trade = panel.input.trade;
  if (!own.selected || *own.selected >= sweep.points.size())
    return noteText(panel.style.palette, "Click a point to see its picture and to take its parameters.");
  const SweepPoint& point = sweep.points[*own.selected];
  heading(panel.style.palette, "The point that was clicked");
  for (const auto& [key, value] : point.settings) factLine(panel.style.palette, key, value);
  const Spread error = metricSpread(point, metric.key).value_or(Spread{});
  factLine(panel.style.palette, metric.label(), tradeErrorText(metric, error, point.runs.size()));
  factLine(panel.style.palette, "CPU time", tradeTimeText(cpuSpread(point), point.runs.size()));
  factLine(panel.style.palette, "Vectors",
           fmt::format("{} ILVs, {} DLVs", countText(point.runs.front().ilvRecords),
                       countText(point.runs.front().dlvRecords)));

  Comparison& comparison = panel.workspace.display.comparison;
  const bool isShown =
      comparison.with == CompareWith::Point && comparison.flipped && trade.shown == own.selected;
  if (buttonLine(panel.style, {.name = "trade.show",
                               .label = isShown ? "Back to the window's picture" : "Show its picture",
                               .value = panel.input.keys->textOf(ActionId::CompareFlip),
                               .selected = isShown})) {
    if (isShown) {
      comparison.flipped = false;
    } else {
      panel.output.showTradePoint = own.selected;
    }
  }
  tooltip(panel.style, "trade.show", "",
          "Its picture of the first seed, in the place of the window's. Wipe, side by side and flip compare "
          "with it, too.");
  const Parameters& taken = trade.parameters[*own.selected];
  const bool isTaken = taken == panel.workspace.setup.parameters;
  if (buttonLine(panel.style, {.name = "trade.take", .label = "Take its parameters", .dimmed = isTaken}) &&
      !isTaken) {
    panel.workspace.setup.parameters = taken;
    // Who takes them wants to see what becomes of them.
    comparison.flipped = false;
  }
  tooltip(panel.style, "trade.take", "",
          isTaken ? "The picture has these parameters."
                  : "Renders the window's picture with the parameters that were measured, all of them. Undo "
                    "takes it back.");
}

void drawMeasured(const TradePanel& panel) {
  const TradeStatus& trade = panel.input.trade;
  if (!trade.sweep || trade.sweep->points.empty()) return;
  const Sweep& sweep = *trade.sweep;
  listMetrics(panel.own, trade.sweep);
  const ReportMetric* metric = chosenMetric(panel.own);
  if (metric == nullptr) return;
  ImGui::Separator();
  if (!trade.stale.empty()) {
    markedText(panel.style.palette.warning, trade.stale);
    Widgets::recordItem("trade.stale", trade.stale);
  }
  const auto pick = pickWithinLimit(panel.own, sweep, *metric);
  drawMetricChoice(panel, *metric);
  drawPlot(panel, sweep, *metric, pick);
  noteText(panel.style.palette, fmt::format("Against {}.", trade.reference));
  drawSelected(panel, sweep, *metric);
  drawLimitChoice(panel, sweep, *metric, pick);
}

}  // namespace

Expected<TradePlan> tradePlan(const TradePanelState& typed, const Parameters& parameters) {
  TradePlan plan;
  for (const std::string& text : typed.varied) {
    if (text.find_first_not_of(' ') == std::string::npos) continue;
    auto varied = parseVaried(text, "Vary");
    if (!varied) return tl::unexpected(varied.error());
    plan.varied.push_back(*std::move(varied));
  }
  std::size_t points = 1;
  for (const VariedParameter& varied : plan.varied) points *= varied.values.size();
  if (points > kMostTradePoints) {
    return makeError(
        "Vary", fmt::format("{} points are more than {}", countText(points), countText(kMostTradePoints)),
        "lightvane sweep takes any number");
  }
  // All that can be wrong is found before the work begins.
  if (auto all = withEachSettings(parameters, sweepGrid(plan.varied)); !all)
    return tl::unexpected(all.error());
  plan.seeds = static_cast<int>(std::lround(typed.seeds));
  plan.reduction = typed.reduction;
  plan.referenceNoise = static_cast<double>(typed.noise);
  if (typed.fromFile) {
    plan.reference = withoutTilde(typed.path);
    if (plan.reference.empty()) return makeError("Reference", "which file is it", "type its path");
  }
  return plan;
}

std::string tradeErrorText(const ReportMetric& metric, const Spread& error, std::size_t runs) {
  const std::string number = spreadText(metric.shown(error), runs > 1);
  return metric.unit().empty() ? number : number + " " + metric.unit();
}

std::string tradeTimeText(const Spread& cpu, std::size_t runs) { return spreadText(cpu, runs > 1) + " s"; }

std::string tradePickText(const SweepPick& pick, const ReportMetric& metric, bool limitsTime,
                          const std::string& limit, const std::optional<double>& referenceNoise) {
  const auto runs = static_cast<std::size_t>(pick.runs);
  std::string text = fmt::format("{} {}\nCPU time {}", metric.label(),
                                 tradeErrorText(metric, pick.error, runs), tradeTimeText(pick.cpu, runs));
  const std::optional<double>& half = limitsTime ? pick.cpuHalfWidth : pick.errorHalfWidth;
  if (!half) {
    text += "\nOf one seed, nobody knows how sure that is.";
  } else {
    const std::string unit = limitsTime ? "s" : metric.unit();
    // In the units that are read, as all spreads.
    const Spread interval{limitsTime ? pick.cpu.mean : pick.error.mean, *half, 0.0, 0.0};
    const Spread read = limitsTime ? interval : metric.shown(interval);
    text += fmt::format("\n{} of {} seeds {} within {}.\nThe mean is {}{}{} with a certainty of 95 %: {}",
                        pick.within, pick.runs, pick.within == 1 ? "is" : "are", limit,
                        spreadText(read, true), unit.empty() ? "" : " ", unit,
                        pick.isSure ? "within." : "it may be beyond. More seeds tell.");
  }
  // Seeds differ in the picture alone: what the reference has of chance, they have in common.
  if (!limitsTime && metric.unit() == "%" && referenceNoise && *referenceNoise > pick.error.mean) {
    text += fmt::format(
        "\nAll seeds share the reference, whose noise of {} % may shift them alike: less of it "
        "tells.",
        shortNumber(std::round(1000.0 * *referenceNoise) / 10.0));
  }
  return text;
}

void drawTradePanel(Workspace& workspace, const PanelInput& input, PanelState& state, PanelOutput& output) {
  const TradePanel panel{workspace, input,  state.trade,
                         state,     output, ControlStyle{paletteOf(workspace.display.theme), state.controls}};
  if (!input.scene) return noteText(panel.style.palette, "No scene is open.");
  if (!input.trade.sweep && !input.trade.isRunning) {
    noteText(panel.style.palette,
             "Renders this view with other parameters, and shows what error and time each choice comes to.");
  }
  std::size_t points = 1;
  for (const std::string& text : panel.own.varied) {
    if (const auto varied = parseVaried(text, "")) points *= varied->values.size();
  }
  if (buttonLine(panel.style,
                 {.name = "trade.setup",
                  .label = "What is measured",
                  .value = fmt::format("{}, {}", countOf(points, "point", "points"),
                                       countOf(static_cast<std::size_t>(panel.own.seeds), "seed", "seeds")),
                  .indent = 0.7f * foldMarkWidth()}))
    panel.own.setupOpen = !panel.own.setupOpen;
  drawFoldMark(panel.style.palette, panel.own.setupOpen);
  if (panel.own.setupOpen) drawSetup(panel);
  drawButtons(panel);
  drawTradeProgress(panel);
  drawMeasured(panel);
}

}  // namespace lightvane
