#pragma once

#include <string>
#include <vector>

#include "core/measure/sweep_values.h"

namespace lightvane {

// The parts of a report that show one metric, as HTML.

/// Points of a sweep by one metric, worked out once for all that shows them.
struct MetricView {
  MetricView(const Sweep& sweep, ReportMetric shownMetric);

  ReportMetric metric;
  std::vector<PlottedPoint> points;
  std::vector<std::size_t> front;  ///< of sweep.points, from fast to slow
};

/// "ilv.n_min=2 ilv.radius_scale=0.4", and before it the method where that is a rival; not escaped.
std::string pointTitle(const SweepPoint& point);
/// The class that gives a point's colour: "k-vectors", "k-path", "k-other".
std::string methodClass(const std::string& method);
/// Methods in the order in which legends have them.
std::vector<std::string> sweepMethods(const Sweep& sweep);
/// The markers' shapes, which every plot of the page refers to.
std::string markerShapes();
/// A marker between words.
std::string inlineMarker(const std::string& method);

/// Error against CPU time: a link of class "point" for each.
std::string frontPlot(const Sweep& sweep, const MetricView& view);
std::string frontTable(const Sweep& sweep, const MetricView& view);
/// What each varied parameter does alone.
std::string knobPlots(const Sweep& sweep, const MetricView& view);

}  // namespace lightvane
