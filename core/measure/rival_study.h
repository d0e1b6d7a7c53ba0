#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/measure/study_table.h"

namespace lightvane {

// The study of rivals: how long methods without vectors take to come as near to the truth as vectors do
// (the paper's section 6).

/// One picture of the study.
struct RivalPoint {
  std::string method;      ///< as method.name
  SweepSettings settings;  ///< beside the method
  std::string label;       ///< "vectors, balanced", "naive, 32 samples"
};
/// Vectors by each preset, from fast to accurate; then `naive` and `path`, each with a few counts of samples,
/// four times as many each time; then `direct`.
std::vector<RivalPoint> rivalPoints();

/// What a picture of a Monte Carlo method took, and its mean squared error.
struct SampledError {
  double samples = 1.0, cpuSeconds = 0.0, meanSquare = 0.0;
};

enum class Reach {
  Measured,  ///< between two pictures that were rendered
  Beyond,    ///< beyond them, by the law that a Monte Carlo's squared error falls as 1 / samples
  AtLeast    ///< more than the most that was rendered, and no law says how much more
};

/// What it takes to come to an error.
struct SamplesNeeded {
  double samples = 0.0, cpuSeconds = 0.0;
  Reach reach = Reach::Measured;
};

/// What a method needs to come to this mean squared error, off pictures of it from few samples to many, at
/// least two: between the first two neighbours that have the error between them, straight in logarithms of
/// error and samples, and the CPU time straight in the samples. Nobody gets below one sample. AtLeast where
/// the last error did not fall by half of what the law says, in logarithms: part of it is then no noise of
/// these samples. Nothing where a measured time or error is not above 0 and finite, or the error wanted is no
/// number. Pure.
std::optional<SamplesNeeded> samplesNeeded(std::span<const SampledError> measured, double meanSquare);

/// How many times as long a rival takes: the geometric mean over seeds.
struct SpeedUp {
  double times = 1.0;
  /// The 95 % interval of that mean: Student's t of the logarithms. Nothing of one seed, or with AtLeast.
  std::optional<double> low, high;
  double samples = 0.0;  ///< that the rival needs, likewise
  Reach reach = Reach::Measured;
};

/// Of the method `rival` over the point of that label, to this metric: "indirect.relmse" or
/// "beauty.relative". Each seed's picture by vectors is held against the pictures by the rival with the same
/// seed. Nothing where that cannot be said of some seed. Pure.
std::optional<SpeedUp> speedUpOver(const StudiedScene& scene, const std::string& rival,
                                   const std::string& vectors, const std::string& metric);

/// Speed-ups at equal error, the paper's ratios beside ours, and what every picture took and how far off it
/// is. Pure.
std::vector<StudyTable> rivalTables(std::span<const StudiedScene> scenes);

}  // namespace lightvane
