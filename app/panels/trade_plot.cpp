#include "app/panels/trade_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lightvane {
namespace {

constexpr const char* kTimeTitle = "CPU time, s";
constexpr double kTickGap = 1.4;  // of the font's height, between two labels

float fontSize() { return ImGui::GetFontSize(); }
float textWidth(const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; }
float hairline() { return std::max(1.0f, std::round(fontSize() / 15.0f)); }

float widestLabel(const std::vector<AxisTick>& ticks) {
  float widest = 0.0f;
  for (const AxisTick& tick : ticks) widest = std::max(widest, textWidth(tick.label));
  return widest;
}

/// A dashed line along an axis.
void drawLimit(ImDrawList& list, const ImVec2& from, const ImVec2& to, ImU32 color) {
  const float dash = 0.35f * fontSize();
  const float length = std::hypot(to.x - from.x, to.y - from.y);
  const ImVec2 along{(to.x - from.x) / length, (to.y - from.y) / length};
  for (float at = 0.0f; at < length; at += 2.0f * dash) {
    const float end = std::min(at + dash, length);
    list.AddLine({from.x + at * along.x, from.y + at * along.y},
                 {from.x + end * along.x, from.y + end * along.y}, color, 1.5f * hairline());
  }
}

void drawAxes(ImDrawList& list, const Palette& palette, const TradePlotLayout& layout,
              const ReportMetric& metric) {
  const ScreenRect& area = layout.area;
  const float em = fontSize();
  const ImU32 grid = withAlpha(palette.border, 0.6f);
  float lastEnd = -1e9f;
  for (const AxisTick& tick : layout.timeTicks) {
    const auto x = std::round(static_cast<float>(tick.at));
    list.AddLine({x, area.min.y}, {x, area.max.y}, tick.label.empty() ? withAlpha(grid, 0.3f) : grid,
                 hairline());
    if (tick.label.empty()) continue;
    // Numbers keep within the plot, and off each other.
    const float width = textWidth(tick.label);
    const float left = std::min(x - 0.5f * width, area.max.x - width);
    if (left < lastEnd + 0.5f * em) continue;
    list.AddText({left, area.max.y + 0.25f * em}, palette.dim, tick.label.c_str());
    lastEnd = left + width;
  }
  for (const AxisTick& tick : layout.errorTicks) {
    const auto y = std::round(static_cast<float>(tick.at));
    list.AddLine({area.min.x, y}, {area.max.x, y}, tick.label.empty() ? withAlpha(grid, 0.3f) : grid,
                 hairline());
    if (tick.label.empty()) continue;
    list.AddText({area.min.x - 0.35f * em - textWidth(tick.label), y - 0.5f * em}, palette.dim,
                 tick.label.c_str());
  }
  // No number where nothing lies, and where everything does: marks of their own at the ends.
  const auto drawApart = [&](const std::optional<double>& at, const char* text, bool isTime) {
    if (!at) return;
    const auto place = static_cast<float>(*at);
    const float width = textWidth(text);
    list.AddText(isTime ? ImVec2{place - 0.5f * width, area.max.y + 0.25f * em}
                        : ImVec2{area.min.x - 0.35f * em - width, place - 0.5f * em},
                 palette.dim, text);
  };
  drawApart(layout.error.nothing, "0", false);
  drawApart(layout.error.infinity, "\u221e", false);
  drawApart(layout.time.nothing, "0", true);
  list.AddRect(area.min, area.max, palette.border, 0.0f, 0, hairline());
  const std::string title = metric.axisTitle();
  list.AddText({area.min.x, area.min.y - 1.3f * em}, palette.text, title.c_str());
  list.AddText({area.max.x - textWidth(kTimeTitle), area.max.y + 1.45f * em}, palette.text, kTimeTitle);
}

/// Points of the front are filled and others are not: nobody needs to see colours to tell them apart.
void drawPoint(ImDrawList& list, const Palette& palette, const TradePlotPoint& point,
               const TradePlotMarks& marks) {
  const float em = fontSize();
  const float radius = 0.27f * em;
  const ImU32 color = marks.isStale ? palette.dim : point.isOnFront ? palette.accent : palette.dim;
  const ImU32 bars = withAlpha(color, 0.55f);
  list.AddLine({point.bars.min.x, point.at.y}, {point.bars.max.x, point.at.y}, bars, hairline());
  list.AddLine({point.at.x, point.bars.min.y}, {point.at.x, point.bars.max.y}, bars, hairline());
  if (point.isOnFront) {
    list.AddCircleFilled(point.at, radius, color, 24);
  } else {
    list.AddCircleFilled(point.at, radius, palette.panel, 24);
    list.AddCircle(point.at, radius, color, 24, 1.5f * hairline());
  }
  const bool isSelected = marks.selected == point.point;
  if (isSelected || marks.hovered == point.point)
    list.AddCircle(point.at, 1.75f * radius, isSelected ? palette.text : palette.dim, 32, 1.5f * hairline());
  if (marks.picked == point.point) {
    const float r = 2.4f * radius;
    const ImVec2 corners[] = {{point.at.x, point.at.y - r},
                              {point.at.x + r, point.at.y},
                              {point.at.x, point.at.y + r},
                              {point.at.x - r, point.at.y}};
    list.AddPolyline(corners, 4, palette.warning, ImDrawFlags_Closed, 1.5f * hairline());
  }
}

}  // namespace

TradePlotLayout layoutTradePlot(const Sweep& sweep, const ReportMetric& metric, const ScreenRect& place) {
  const float em = fontSize();
  TradePlotLayout layout;
  const std::vector<PlottedPoint> plotted = plottedPoints(sweep, metric);
  std::vector<double> times, timeBars, errors, errorBars;
  for (const PlottedPoint& point : plotted) {
    times.push_back(point.cpu.mean);
    errors.push_back(point.error);
    timeBars.insert(timeBars.end(), {point.cpu.least, point.cpu.most});
    errorBars.insert(errorBars.end(), {point.leastError, point.mostError});
  }
  // Above the plot is the error's title; below are the numbers and the title of the time.
  layout.area = {{place.min.x, place.min.y + 1.5f * em}, {place.max.x, place.max.y - 2.6f * em}};
  layout.error = plotAxis(errors, errorBars, metric.scale(), static_cast<double>(layout.area.max.y),
                          static_cast<double>(layout.area.min.y));
  layout.errorTicks = axisTicks(layout.error, kTickGap * static_cast<double>(em));
  layout.area.min.x += widestLabel(layout.errorTicks) + 0.5f * em;
  layout.time = plotAxis(times, timeBars, PlotScale::Log, static_cast<double>(layout.area.min.x),
                         static_cast<double>(layout.area.max.x));
  layout.timeTicks = axisTicks(layout.time, kTickGap * static_cast<double>(em));

  const auto x = [&](double seconds) { return static_cast<float>(layout.time.at(seconds)); };
  const auto y = [&](double error) { return static_cast<float>(layout.error.at(error)); };
  for (const PlottedPoint& point : plotted) {
    layout.points.push_back(
        {point.point,
         {x(point.cpu.mean), y(point.error)},
         {{x(point.cpu.least), y(point.mostError)}, {x(point.cpu.most), y(point.leastError)}},
         false});
  }
  for (const std::size_t index : reportFront(sweep, plotted)) {
    const auto found = std::ranges::find(layout.points, index, &TradePlotPoint::point);
    if (found == layout.points.end()) continue;
    found->isOnFront = true;
    layout.front.push_back(found->at);
  }
  return layout;
}

std::optional<std::size_t> tradePointAt(const TradePlotLayout& layout, const ImVec2& mouse, float reach) {
  std::optional<std::size_t> nearest;
  float least = reach;
  for (const TradePlotPoint& point : layout.points) {
    const float distance = std::hypot(point.at.x - mouse.x, point.at.y - mouse.y);
    if (!(distance <= least)) continue;
    least = distance;
    nearest = point.point;
  }
  return nearest;
}

void drawTradePlot(const Palette& palette, const TradePlotLayout& layout, const ReportMetric& metric,
                   const TradePlotMarks& marks) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ScreenRect& area = layout.area;
  drawAxes(list, palette, layout, metric);
  list.PushClipRect(area.min, area.max, true);
  // Beyond the ends of an axis a line would be at the wrong number.
  const auto isWithin = [](const PlotAxis& axis, double value) {
    const double place = axis.scale == PlotScale::Log ? std::log10(value) : value;
    return place > axis.low && place < axis.high;
  };
  if (marks.mostError && isWithin(layout.error, *marks.mostError)) {
    const auto y = static_cast<float>(layout.error.at(*marks.mostError));
    drawLimit(list, {area.min.x, y}, {area.max.x, y}, palette.warning);
  }
  if (marks.mostSeconds && isWithin(layout.time, *marks.mostSeconds)) {
    const auto x = static_cast<float>(layout.time.at(*marks.mostSeconds));
    drawLimit(list, {x, area.min.y}, {x, area.max.y}, palette.warning);
  }
  const ImU32 line = withAlpha(marks.isStale ? palette.dim : palette.accent, 0.7f);
  if (layout.front.size() > 1)
    list.AddPolyline(layout.front.data(), static_cast<int>(layout.front.size()), line, 0, 1.5f * hairline());
  // The front on top.
  for (const bool isOnFront : {false, true}) {
    for (const TradePlotPoint& point : layout.points) {
      if (point.isOnFront == isOnFront) drawPoint(list, palette, point, marks);
    }
  }
  list.PopClipRect();
}

}  // namespace lightvane
