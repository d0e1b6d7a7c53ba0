#include <algorithm>
#include <cmath>

#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

namespace lightvane {
namespace {

MetricResult computeRmse(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const int width = input.reference.width(), height = input.reference.height();
  MeanOfPixels squares(width, height);
  double ofNoise = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!counted(x, y)) continue;
      const std::size_t i = input.reference.index(x, y);
      const glm::dvec3 difference = glm::dvec3(input.picture[i]) - glm::dvec3(input.reference[i]);
      const double squared = glm::dot(difference, difference) / 3.0;
      const glm::dvec3 variance = noiseVariance(input, i);
      const double noise = (variance.r + variance.g + variance.b) / 3.0;
      squares.add(x, y, squared - noise);
      ofNoise += noise;
      result.map[i] = static_cast<float>(std::sqrt(squared));
    }
  }
  const MeanEstimate estimate = squares.estimate();
  result.value = estimate.root();
  result.standardError = ifFinite(estimate.rootError());
  if (knowsNoise(input)) result.ofReference = std::sqrt(ofNoise / static_cast<double>(counted.count));
  return result;
}

}  // namespace

MetricInfo rmseMetric() {
  return {.name = "rmse",
          .label = "RMSE",
          .unit = MetricUnit::Radiance,
          .subtractsNoise = true,
          .description =
              "The root of the mean squared difference over pixels and colours, in the pictures' unit.",
          .map = "root mean squared difference of the colours",
          .compute = computeRmse};
}

}  // namespace lightvane
