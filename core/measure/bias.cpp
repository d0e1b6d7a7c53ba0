#include <cmath>

#include "core/base/math.h"
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
  counted.forEach([&](int x, int y, std::size_t i) {
    differences.add(x, y, differenceOf(i));
    // A pixel's colours come from the same paths: as if their errors were one.
    deviations += square(meanOf(glm::sqrt(noiseVariance(input, i))));
  });
  const double mean = differences.estimate().mean;
  // A black picture of a black scene is right; of any other nothing can be told in parts of nothing.
  const double scale = counted.referenceMean != 0.0 ? 1.0 / std::abs(counted.referenceMean)
                       : mean == 0.0                ? 0.0
                                                    : std::numeric_limits<double>::infinity();
  result.value = mean == 0.0 ? 0.0 : mean * scale;
  // Of a ratio of two means: its own part of the reference goes from each difference.
  MeanOfPixels residuals(width, height);
  counted.forEach([&](int x, int y, std::size_t i) {
    if (std::isfinite(scale)) {
      residuals.add(x, y, differenceOf(i) * scale - result.value * meanOf(input.reference[i]) * scale);
      result.map[i] = static_cast<float>(std::abs(differenceOf(i)) * scale);
    }
  });
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
