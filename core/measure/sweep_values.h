#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/measure/metric.h"
#include "core/measure/sweep.h"
#include "core/measure/sweep_plot.h"

namespace lightvane {

/// A metric of a layer as a report shows it. All plots have the better values at the bottom.
struct ReportMetric {
  std::string key;                   ///< "beauty.relative"
  std::string layer;                 ///< "beauty"
  const MetricInfo* info = nullptr;  ///< null where there is none of that name

  std::string label() const;          ///< "Relative RMSE"
  std::string unit() const;           ///< "%", "dB"; empty where there is none
  std::string labelWithUnit() const;  ///< "Relative RMSE, %"
  /// The same, and of the distance from the best value where that is plotted: "|Bias|, %"
  std::string axisTitle() const;
  PlotScale scale() const;
  bool isUpwards() const { return scale() == PlotScale::Log; }  ///< values grow upwards in plots
  /// In the unit that is read.
  Spread shown(const Spread& spread) const;
  /// On the axis.
  double plotted(double value) const;
  /// Positive numbers, less is better, as errors: what ratios and logarithms can be taken of.
  double loss(double value) const;
};

/// Those that every point has, layer by layer, beauty first; `first` before all where any point has it.
std::vector<ReportMetric> reportMetrics(const Sweep& sweep, const std::string& first);

/// A point in a plot: means, and what the runs reach from and to.
struct PlottedPoint {
  std::size_t point = 0;
  Spread cpu;
  Spread metric;                                          ///< as it is
  double error = 0.0, leastError = 0.0, mostError = 0.0;  ///< as plotted
  double loss = 0.0;
};

/// Those points that have the metric.
std::vector<PlottedPoint> plottedPoints(const Sweep& sweep, const ReportMetric& metric);

/// paretoFront of the losses: also of metrics where more is better.
std::vector<std::size_t> reportFront(const Sweep& sweep, const std::vector<PlottedPoint>& points);

bool isRival(const SweepPoint& point);

/// How much longer the rivals take for an error: of the method that comes nearest to the reference, its own
/// front, interpolated in the logarithms of error and time.
class RivalTimes {
 public:
  RivalTimes(const Sweep& sweep, const std::vector<PlottedPoint>& points);

  const std::string& method() const { return method_; }  ///< empty where there is no rival
  /// CPU seconds; nothing outside of what it was measured at.
  std::optional<double> secondsFor(double loss) const;

 private:
  struct Sample {
    double seconds, loss;
  };
  std::string method_;
  std::vector<Sample> front_;  ///< slower and more exact from one to the next
};

/// Points that differ in one parameter alone, by its values.
struct KnobLine {
  std::string method;
  std::vector<std::optional<std::size_t>> points;  ///< of a PlottedPoint, one a category
};
struct KnobMean {
  std::string method;
  std::vector<std::optional<double>> error, seconds;  ///< one a category; error as plotted
  std::size_t combinations = 0;                       ///< of the other parameters
  bool isOfAll = false;  ///< of all points with the value, which differ in others too: no line is complete
};
struct KnobEffect {
  std::vector<std::string> categories;  ///< values; "default" first where a point leaves it as it was
  std::vector<KnobLine> lines;
  std::vector<KnobMean> means;  ///< one a method that has it
};
KnobEffect knobEffect(const Sweep& sweep, const VariedParameter& knob, const ReportMetric& metric,
                      const std::vector<PlottedPoint>& points);

}  // namespace lightvane
