#include <cmath>

#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

namespace lightvane {
namespace {

MetricResult computeBias(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const int width = input.reference.width(), height = input.reference.height();
  const auto differenceOf = [&](std::size_t i) {
    return meanOf(input.picture[i]) - meanOf(input.reference[i]);
  };
  MeanOfPixels differences(width, height);
  double deviations = 0.0;  // summed squares
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!counted(x, y)) continue;
      const std::size_t i = input.reference.index(x, y);
      differences.add(x, y, differenceOf(i));
      // A pixel's colours come from the same paths: as if their errors were one.
      const glm::dvec3 deviation = glm::sqrt(noiseVariance(input, i));
      deviations +=
          (deviation.r + deviation.g + deviation.b) * (deviation.r + deviation.g + deviation.b) / 9.0;
    }
  }
  const double mean = differences.estimate().mean;
  // A black picture of a black scene is right; of any other nothing can be told in parts of nothing.
  const double scale = counted.referenceMean != 0.0 ? 1.0 / std::abs(counted.referenceMean)
                       : mean == 0.0                ? 0.0
                                                    : std::numeric_limits<double>::infinity();
  result.value = mean == 0.0 ? 0.0 : mean * scale;
  // Of a ratio of two means: its own part of the reference goes from each difference.
  MeanOfPixels residuals(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!counted(x, y)) continue;
      const std::size_t i = input.reference.index(x, y);
      if (std::isfinite(scale)) {
        residuals.add(x, y, differenceOf(i) * scale - result.value * meanOf(input.reference[i]) * scale);
        result.map[i] = static_cast<float>(std::abs(differenceOf(i)) * scale);
      }
    }
  }
  result.standardError = ifFinite(residuals.estimate().standardError);
  if (knowsNoise(input))
    result.ofReference = ifFinite(std::sqrt(deviations) / static_cast<double>(counted.count) * scale);
  return result;
}

}  // namespace

MetricInfo biasMetric() {
  return {.name = "bias",
          .label = "Bias",
          .unit = MetricUnit::Fraction,
          .better = BetterValue::NearZero,
          .description =
              "The mean of picture - reference over the mean of the reference: by how much the "
              "picture is too bright. The reference's noise has no part in it but its own mean's.",
          .map = "absolute difference over the mean of the reference",
          .compute = computeBias};
}

}  // namespace lightvane
