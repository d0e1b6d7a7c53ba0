#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/display_values.h"
#include "core/measure/mean_estimate.h"

namespace lightvane {
namespace {

/// Of a mean squared difference, with a peak of 1.
double decibels(double meanSquare) {
  return meanSquare > 0.0 ? -10.0 * std::log10(meanSquare) : std::numeric_limits<double>::infinity();
}

MetricResult computePsnr(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  MeanOfPixels squares(input.reference.width(), input.reference.height());
  counted.forEach([&](int x, int y, std::size_t i) {
    const double squared = squaredDifference(displayValue(input.picture[i], input.exposureStops),
                                             displayValue(input.reference[i], input.exposureStops));
    squares.add(x, y, squared);
    result.map[i] = static_cast<float>(std::sqrt(squared));
  });
  const MeanEstimate estimate = squares.estimate();
  result.value = decibels(estimate.mean);
  if (estimate.mean > 0.0)
    result.standardError = ifFinite(10.0 / std::numbers::ln10 * estimate.standardError / estimate.mean);
  result.ofReference = ofNoiseAlone(input, computePsnr);
  return result;
}

}  // namespace

MetricInfo psnrMetric() {
  return {.name = "psnr",
          .label = "PSNR",
          .unit = MetricUnit::Decibel,
          .better = BetterValue::Higher,
          .description =
              "Peak signal-to-noise ratio: -10 log10 of the mean squared difference of display values, "
              "whose peak is 1. Infinite for equal pictures.",
          .map = "root mean squared difference of the display values",
          .compute = computePsnr};
}

}  // namespace lightvane
