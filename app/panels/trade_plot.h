#pragma once

#include <optional>
#include <vector>

#include "app/panels/controls.h"
#include "app/panels/layout.h"
#include "core/measure/sweep_plot.h"
#include "core/measure/sweep_values.h"

namespace lightvane {

// Error against CPU time, both logarithmic: better is to the lower left.

/// A point of a sweep on the screen. The bars reach from the least to the most of its runs.
struct TradePlotPoint {
  std::size_t point = 0;  ///< of Sweep::points
  ImVec2 at;
  ScreenRect bars;
  bool isOnFront = false;
};

/// Where everything of a plot is.
struct TradePlotLayout {
  ScreenRect area;  ///< between the axes
  PlotAxis time, error;
  std::vector<AxisTick> timeTicks, errorTicks;
  std::vector<TradePlotPoint> points;
  std::vector<ImVec2> front;  ///< from fast to slow
};

/// Fits axes with their numbers and titles into `place`. Pure but for the widths of ImGui's current font.
TradePlotLayout layoutTradePlot(const Sweep& sweep, const ReportMetric& metric, const ScreenRect& place);

/// The nearest point no farther than `reach` pixels.
std::optional<std::size_t> tradePointAt(const TradePlotLayout& layout, const ImVec2& mouse, float reach);

/// What of a plot is marked.
struct TradePlotMarks {
  std::optional<std::size_t> hovered, selected, picked;  ///< points
  std::optional<double> mostError, mostSeconds;          ///< a limit, in the axes' units
  bool isStale = false;                                  ///< the points are of something else
};
void drawTradePlot(const Palette& palette, const TradePlotLayout& layout, const ReportMetric& metric,
                   const TradePlotMarks& marks);

}  // namespace lightvane
