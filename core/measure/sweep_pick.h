#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "core/measure/sweep.h"

namespace lightvane {

// Which point of a sweep to take, where an error or a time may not be exceeded.

/// The half width of the interval about the mean of `runs` values with this deviation among them that holds
/// the true mean with a certainty of 95 % (Student's t). Nothing of fewer than two.
std::optional<double> meanHalfWidth(const Spread& spread, int runs);

/// A point of the front whose mean keeps within a limit, and how sure that is.
struct SweepPick {
  std::size_t point = 0;  ///< of Sweep::points
  Spread error, cpu;      ///< over its runs
  int runs = 0;
  int within = 0;                                      ///< runs that keep within by themselves
  std::optional<double> errorHalfWidth, cpuHalfWidth;  ///< meanHalfWidth
  /// The whole interval about the mean keeps within the limit. Never of one run.
  bool isSure = false;
};

/// The fastest point of paretoFront whose mean of the metric is no larger than that; nothing where none is.
std::optional<SweepPick> fastestWithin(const Sweep& sweep, std::string_view metric, double mostError);
/// The point of paretoFront with the least error whose mean CPU time is no longer than that.
std::optional<SweepPick> bestWithin(const Sweep& sweep, std::string_view metric, double mostCpuSeconds);

}  // namespace lightvane
