#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/trace/ray.h"

namespace lightvane {

// Many renderings of one view, each with other parameters, held against a reference: what speed costs.

/// A parameter that is varied, and the values that it takes in turn; both as text, as --set has them.
struct VariedParameter {
  std::string key;
  std::vector<std::string> values;  ///< at least one
};

/// "key=a,b,c": these values; "key=low:high:n": n numbers from low to high, both of them too, at equal ratios
/// where both are above 0 and at equal distances otherwise. Numbers have four digits; they are whole where
/// both ends are and the higher is 10 or more, and fewer where that makes some of them the same.
Expected<VariedParameter> parseVaried(const std::string& text, const std::string& where);

/// Settings of one point, in the order of the parameters that are varied. None: as it would be without a
/// sweep.
using SweepSettings = std::vector<std::pair<std::string, std::string>>;

/// Every combination of the values.
std::vector<SweepSettings> sweepGrid(const std::vector<VariedParameter>& varied);
/// One parameter at a time, all others as they would be without a sweep; that point first.
std::vector<SweepSettings> sweepAround(const std::vector<VariedParameter>& varied);
/// `count` points, each value one of its parameter's, drawn by the seed; none twice, so that there may be
/// fewer.
std::vector<SweepSettings> sweepRandom(const std::vector<VariedParameter>& varied, int count,
                                       std::uint64_t seed);

/// One rendering.
struct SweepRun {
  std::uint64_t seed = 0;
  double cpuSeconds = 0.0;   ///< of all threads, from the compiled scene to the finished picture
  double wallSeconds = 0.0;  ///< likewise
  RayCounts rays;
  std::uint64_t ilvRecords = 0, dlvRecords = 0;
  std::uint64_t fullIndirect = 0, fullDirect = 0;  ///< computed in full
  std::uint64_t memoryBytes = 0;                   ///< of picture and vectors, as counted
  /// Value of each metric by "layer.metric": "beauty.relative".
  std::map<std::string, double> metrics;
};

/// One choice of method and parameters.
struct SweepPoint {
  std::string method;  ///< "vectors", "path", "naive", "direct"
  SweepSettings settings;
  std::string command;         ///< renders the first run's picture
  std::vector<SweepRun> runs;  ///< one a seed, at least one
  /// Files of the first run's picture and of where its error is, relative to the report.
  std::string picture, errorMap;
  std::string label;  ///< of points that differ by more settings than a name can tell; empty of others

  /// The label; "ilv.n_min=2 ilv.radius_scale=0.4" without one, and the method's name without settings.
  std::string name() const;
};

/// A number over the runs of a point.
struct Spread {
  double mean = 0.0;
  double standardDeviation = 0.0;  ///< among runs; 0 of one
  double least = 0.0, most = 0.0;
};

/// Of a metric; nothing where a run does not have it, or where it is no number. Infinite where a run's is.
std::optional<Spread> metricSpread(const SweepPoint& point, std::string_view metric);
Spread cpuSpread(const SweepPoint& point);

/// A sweep as far as it is done.
struct Sweep {
  std::string scene, sceneHash;  ///< as given; SceneDescription's hash
  int width = 0, height = 0;
  std::string machine;  ///< "Intel(R) Xeon(R) ..., 2 cores"
  int threads = 1;
  std::string version;    ///< of Lightvane
  std::string reference;  ///< the file's name
  /// Of the picture, and of its layers "direct" and "indirect" where it is known.
  std::optional<double> referenceNoise;
  std::map<std::string, double> layerNoise;
  std::vector<VariedParameter> varied;
  std::vector<SweepPoint> points;
};

/// The points that no other beats in both: less CPU time and less of the metric, by their means; from fast to
/// slow. Indices into sweep.points.
std::vector<std::size_t> paretoFront(const Sweep& sweep, std::string_view metric);

}  // namespace lightvane
