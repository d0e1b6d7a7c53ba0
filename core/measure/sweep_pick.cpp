#include "core/measure/sweep_pick.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lightvane {
namespace {

// The 0.975 quantile of Student's t with 1, 2, ... degrees of freedom; beyond, that of the normal
// distribution is too small by 4 % at most.
constexpr std::array kStudent = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                 2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                 2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
constexpr double kNormal = 1.960;

SweepPick pickOf(const Sweep& sweep, std::size_t index, std::string_view metric) {
  const SweepPoint& point = sweep.points[index];
  SweepPick pick;
  pick.point = index;
  pick.error = metricSpread(point, metric).value_or(Spread{});
  pick.cpu = cpuSpread(point);
  pick.runs = static_cast<int>(point.runs.size());
  pick.errorHalfWidth = meanHalfWidth(pick.error, pick.runs);
  pick.cpuHalfWidth = meanHalfWidth(pick.cpu, pick.runs);
  return pick;
}

bool keepsWithin(const Spread& spread, const std::optional<double>& halfWidth, double most) {
  return halfWidth && spread.mean + *halfWidth <= most;
}

}  // namespace

std::optional<double> meanHalfWidth(const Spread& spread, int runs) {
  if (runs < 2 || !std::isfinite(spread.mean)) return std::nullopt;
  const auto place = static_cast<std::size_t>(runs - 2);
  const double quantile = place < kStudent.size() ? kStudent[place] : kNormal;
  return quantile * spread.standardDeviation / std::sqrt(static_cast<double>(runs));
}

std::optional<SweepPick> fastestWithin(const Sweep& sweep, std::string_view metric, double mostError) {
  // From fast to slow, and so from a large error to a small one.
  for (const std::size_t index : paretoFront(sweep, metric)) {
    SweepPick pick = pickOf(sweep, index, metric);
    if (!(pick.error.mean <= mostError)) continue;
    const std::vector<SweepRun>& runs = sweep.points[index].runs;
    pick.within = static_cast<int>(std::ranges::count_if(
        runs, [&](const SweepRun& run) { return run.metrics.at(std::string(metric)) <= mostError; }));
    pick.isSure = keepsWithin(pick.error, pick.errorHalfWidth, mostError);
    return pick;
  }
  return std::nullopt;
}

std::optional<SweepPick> bestWithin(const Sweep& sweep, std::string_view metric, double mostCpuSeconds) {
  std::optional<SweepPick> best;
  for (const std::size_t index : paretoFront(sweep, metric)) {
    SweepPick pick = pickOf(sweep, index, metric);
    if (!(pick.cpu.mean <= mostCpuSeconds)) break;
    best = pick;
  }
  if (!best) return best;
  const std::vector<SweepRun>& runs = sweep.points[best->point].runs;
  best->within = static_cast<int>(
      std::ranges::count_if(runs, [&](const SweepRun& run) { return run.cpuSeconds <= mostCpuSeconds; }));
  best->isSure = keepsWithin(best->cpu, best->cpuHalfWidth, mostCpuSeconds);
  return best;
}

}  // namespace lightvane
