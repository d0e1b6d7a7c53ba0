#include "core/measure/target_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "core/measure/metric.h"

namespace lightvane {
namespace {

constexpr std::uint32_t kTargetStream = 0x74617267U;
constexpr double kLeastPixels = 32.0;

/// By what the chances of being drawn are multiplied so that about `wanted` are: none is above 1.
double scaleOfChances(const std::vector<double>& chances, double wanted) {
  double scale = 0.0;
  double sure = 0.0, rest = 0.0;
  for (const double chance : chances) rest += chance;
  // Each round finds chances that are sure, which leaves more to the others.
  for (int round = 0; round < 8 && rest > 0.0 && sure < wanted; ++round) {
    scale = (wanted - sure) / rest;
    sure = rest = 0.0;
    for (const double chance : chances)
      (scale * chance >= 1.0 ? sure : rest) += scale * chance >= 1.0 ? 1.0 : chance;
  }
  return scale;
}

/// The metric `relative` of a picture that is off by the roots of these variances from what it should be.
MetricResult relativeOf(const RenderFrame& frame, const ImageRgb& variance,
                        const ImageFloat* counted = nullptr) {
  const ImageRgb picture = frame.film->beauty();
  ImageRgb off = picture;
  for (std::size_t i = 0; i < off.size(); ++i) off[i] += glm::sqrt(variance[i]);
  return findMetric("relative")->compute({.picture = off, .reference = picture, .mask = counted});
}

}  // namespace

double samplingErrorOf(const RenderFrame& frame, const SamplingNoise& noise) {
  if (noise.counted.empty()) return std::numeric_limits<double>::quiet_NaN();
  return relativeOf(frame, noise.variance, &noise.counted).value;
}

TargetError targetErrorOf(const RenderFrame& frame, const ErrorEstimate& estimate, double target,
                          std::uint32_t round) {
  TargetError result;
  result.error = std::numeric_limits<double>::quiet_NaN();
  if (estimate.variance.empty()) return result;
  const MetricResult relative = relativeOf(frame, estimate.variance);
  result.error = relative.value;
  if (!(result.error > target)) return result;
  std::vector<double> chances(estimate.variance.size(), 0.0);
  for (std::size_t i = 0; i < chances.size(); ++i) {
    const double error = static_cast<double>(relative.map[i]) / target;
    chances[i] = std::max(0.0, error * error - 1.0);
  }
  const double wanted = std::max(kLeastPixels, 0.5 * static_cast<double>(frame.statistics.ilvRecords));
  const double scale = scaleOfChances(chances, wanted);
  const RandomKey key = randomKey(frame.parameters.picture.seed).with(kTargetStream).with(round);
  for (std::uint32_t i = 0; i < chances.size(); ++i) {
    if (static_cast<double>(uniform(key, i, 0)) < scale * chances[i]) result.pixels.push_back(i);
  }
  return result;
}

}  // namespace lightvane
