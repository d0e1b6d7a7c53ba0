#include "tests/bench/measure.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include <fmt/format.h>

namespace lightvane {
namespace {

double secondsOf(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double threadCpuSeconds() { return secondsOf(CLOCK_THREAD_CPUTIME_ID); }
double processCpuSeconds() { return secondsOf(CLOCK_PROCESS_CPUTIME_ID); }
double wallSeconds() { return secondsOf(CLOCK_MONOTONIC); }

double Samples::best() const { return *std::min_element(values.begin(), values.end()); }
double Samples::worst() const { return *std::max_element(values.begin(), values.end()); }
double Samples::median() const {
  std::vector<double> sorted = values;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : 0.5 * (sorted[half - 1] + sorted[half]);
}

std::vector<Samples> inTurn(int rounds, std::span<const std::function<double()>> things) {
  std::vector<Samples> samples(things.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < things.size(); ++i) samples[i].values.push_back(things[i]());
  }
  return samples;
}

Samples ratio(const Samples& a, const Samples& b) {
  Samples quotients;
  for (std::size_t i = 0; i < a.values.size(); ++i) quotients.values.push_back(a.values[i] / b.values[i]);
  return quotients;
}

std::string withSpread(const Samples& samples, int decimals) {
  return fmt::format("{:.{}f} ({:.{}f} to {:.{}f})", samples.median(), decimals, samples.best(), decimals,
                     samples.worst(), decimals);
}

}  // namespace lightvane
