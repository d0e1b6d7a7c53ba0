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
  counted.forEach([&](int x, int y, std::size_t i) {
    const double squared = squaredDifference(input.picture[i], input.reference[i]);
    const double noise = meanOf(noiseVariance(input, i));
    squares.add(x, y, squared - noise);
    ofNoise += noise;
    result.map[i] = static_cast<float>(std::sqrt(squared));
  });
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
