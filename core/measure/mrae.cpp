#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

namespace lightvane {
namespace {

MetricResult computeMrae(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const int width = input.reference.width(), height = input.reference.height();
  const Image<double> local = localMeans(input.reference, counted);
  const double dark = kDarkPart * counted.referenceMean;
  MeanOfPixels errors(width, height);
  double ofNoise = 0.0;
  counted.forEach([&](int x, int y, std::size_t i) {
    const glm::dvec3 difference = glm::abs(glm::dvec3(input.picture[i]) - glm::dvec3(input.reference[i]));
    const double absolute = meanOf(difference);
    const double scale = std::max(local[i], dark);
    // A black picture of a black scene is right, and any other wrong by all.
    const double error = scale > 0.0 ? absolute / scale : absolute > 0.0 ? 1.0 : 0.0;
    errors.add(x, y, error);
    result.map[i] = static_cast<float>(error);
    const glm::dvec3 deviation = glm::sqrt(noiseVariance(input, i));
    // The mean absolute value of the normal distribution.
    if (scale > 0.0) ofNoise += std::sqrt(2.0 / kPiD) * meanOf(deviation) / scale;
  });
  const MeanEstimate estimate = errors.estimate();
  result.value = estimate.mean;
  result.standardError = ifFinite(estimate.standardError);
  if (knowsNoise(input)) result.ofReference = ofNoise / static_cast<double>(counted.count);
  return result;
}

}  // namespace

MetricInfo mraeMetric() {
  return {.name = "mrae",
          .label = "MRAE",
          .unit = MetricUnit::Fraction,
          .description =
              "Mean relative absolute error: |picture - reference| over the mean of the reference in "
              "the 5x5 pixels around, or over 1 % of the mean of all where that is darker.",
          .map = "relative absolute error",
          .compute = computeMrae};
}

}  // namespace lightvane
