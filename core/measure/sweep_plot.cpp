#include "core/measure/sweep_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/measure/sweep_html.h"

namespace lightvane {
namespace {

constexpr double kStripPixels = 32.0;
constexpr double kStripPlace = 11.0;  // a marker there is inside of the plot, and apart from the others
constexpr double kLabelSize = 12.0;   // pixels, as .label of the page's style

/// The next of 1, 2, 5, 10, ... that is no less.
double roundStep(double least) {
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1.0 - 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

struct TickValue {
  double value;
  bool isNamed;
};

/// Multiples of a step, some five of them between two values.
std::vector<TickValue> evenTicks(double low, double high) {
  const double step = roundStep((high - low) / 6.0);
  std::vector<TickValue> ticks;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double i = first; i <= last; i += 1.0) ticks.push_back({i * step, true});
  return ticks;
}

/// Whole decades where there are enough, else 1, 2, 5; with marks between them.
std::vector<TickValue> logTicks(double low, double high) {
  const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::ceil(high));
  const auto inside = [&](double value) {
    return std::log10(value) >= low - 1e-9 && std::log10(value) <= high + 1e-9;
  };
  const double decades = high - low;
  const int every = static_cast<int>(std::ceil(decades / 8.0));
  std::vector<TickValue> ticks;
  int named = 0;
  for (int decade = first; decade <= last; ++decade) {
    for (int digit = 1; digit <= (every > 1 ? 1 : 9); ++digit) {
      const double value = digit * std::pow(10.0, decade);
      if (!inside(value)) continue;
      const bool isRound = digit == 1 || (decades < 3.0 && (digit == 2 || digit == 5));
      const bool isNamed = isRound && (every == 1 || decade % every == 0);
      named += isNamed ? 1 : 0;
      ticks.push_back({value, isNamed});
    }
  }
  return named >= 3 ? ticks : evenTicks(std::pow(10.0, low), std::pow(10.0, high));
}

}  // namespace

double PlotAxis::at(double value) const {
  const bool isLog = scale == PlotScale::Log;
  if (value == std::numeric_limits<double>::infinity()) return infinity.value_or(to);
  if (value == -std::numeric_limits<double>::infinity() || (isLog && value <= 0.0))
    return nothing.value_or(from);
  const double coordinate = isLog ? std::log10(value) : value;
  const double part = (coordinate - low) / (high - low);
  return from + std::clamp(part, 0.0, 1.0) * (to - from);
}

PlotAxis plotAxis(std::span<const double> values, std::span<const double> bars, PlotScale scale, double from,
                  double to) {
  PlotAxis axis;
  axis.scale = scale;
  axis.from = from;
  axis.to = to;
  const bool isLog = scale == PlotScale::Log;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto include = [&](double value) {
    if (!std::isfinite(value) || (isLog && value <= 0.0)) return;
    low = std::min(low, isLog ? std::log10(value) : value);
    high = std::max(high, isLog ? std::log10(value) : value);
  };
  std::ranges::for_each(values, include);
  std::ranges::for_each(bars, include);

  const double direction = to > from ? 1.0 : -1.0;
  for (const double value : values) {
    const bool isNothing = value == -std::numeric_limits<double>::infinity() || (isLog && value <= 0.0);
    if (isNothing && !axis.nothing) {
      axis.nothing = from + direction * kStripPlace;
      axis.from += direction * kStripPixels;
    }
    axis.isSignedNothing |= value < 0.0 && isNothing;
    if (value == std::numeric_limits<double>::infinity() && !axis.infinity) {
      axis.infinity = to - direction * kStripPlace;
      axis.to -= direction * kStripPixels;
    }
  }

  if (low > high) {
    low = 0.0;
    high = 1.0;
  }
  // Less than a factor of two, or than a tenth, would show rounding as if it were a difference.
  const double leastSpan = isLog ? std::log10(2.0) : std::max(0.1 * std::abs(low + high) / 2.0, 1e-3);
  const double middle = (low + high) / 2.0;
  const double half = std::max(high - low, leastSpan) / 2.0 * 1.12;
  axis.low = middle - half;
  axis.high = middle + half;
  return axis;
}

std::vector<AxisTick> axisTicks(const PlotAxis& axis, double distance) {
  const bool isLog = axis.scale == PlotScale::Log;
  std::vector<AxisTick> ticks;
  double last = std::numeric_limits<double>::infinity();
  for (const TickValue& tick : isLog ? logTicks(axis.low, axis.high) : evenTicks(axis.low, axis.high)) {
    const double at = axis.at(tick.value);
    std::string label = tick.isNamed ? axisNumberText(tick.value) : std::string();
    if (std::abs(at - last) < distance) label.clear();
    if (!label.empty()) last = at;
    ticks.push_back({at, std::move(label)});
  }
  return ticks;
}

double labelWidth(std::string_view text) {
  return 0.62 * kLabelSize * static_cast<double>(characterCount(text));
}

std::optional<PlacedLabel> LabelPlaces::place(double x, double y, std::string_view text) {
  const double width = labelWidth(text);
  constexpr double kGap = 9.0;
  // Lower left first: nothing is better than a point of the front, so that nothing is there.
  const std::array<PlacedLabel, 6> candidates{{{x - kGap, y + 14.0, TextAnchor::End},
                                               {x - kGap, y + 4.0, TextAnchor::End},
                                               {x, y + 20.0, TextAnchor::Middle},
                                               {x + kGap, y - 6.0, TextAnchor::Start},
                                               {x + kGap, y + 4.0, TextAnchor::Start},
                                               {x, y - 11.0, TextAnchor::Middle}}};
  for (const PlacedLabel& label : candidates) {
    const double before = label.anchor == TextAnchor::End      ? width
                          : label.anchor == TextAnchor::Middle ? width / 2.0
                                                               : 0.0;
    const PlotBox box{label.x - before, label.y - 0.8 * kLabelSize, label.x - before + width,
                      label.y + 0.25 * kLabelSize};
    const bool isInside = box.left >= area_.left && box.right <= area_.right && box.top >= area_.top &&
                          box.bottom <= area_.bottom;
    if (!isInside || std::ranges::any_of(taken_, [&](const PlotBox& other) { return box.overlaps(other); }))
      continue;
    taken_.push_back(box);
    return label;
  }
  return std::nullopt;
}

}  // namespace lightvane
