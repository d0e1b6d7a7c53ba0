#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace lightvane {

/// Seconds of CPU that the calling thread has taken.
double threadCpuSeconds();
/// Seconds of CPU that all threads of the process have taken.
double processCpuSeconds();
double wallSeconds();

/// What one thing measured in each round of a run.
struct Samples {
  std::vector<double> values;

  double best() const;  ///< the least
  double median() const;
  double worst() const;
};

/// Measures the things in turn, `rounds` times: what else the machine does meets all of them alike, so that
/// their ratios hold where the seconds do not.
std::vector<Samples> inTurn(int rounds, std::span<const std::function<double()>> things);

/// Round by round, a over b.
Samples ratio(const Samples& a, const Samples& b);

/// "2.13 (2.10 to 2.31)": the median, and the least and the largest of the rounds.
std::string withSpread(const Samples& samples, int decimals);

}  // namespace lightvane
