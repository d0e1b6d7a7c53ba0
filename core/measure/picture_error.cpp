#include "core/measure/picture_error.h"

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"
#include "core/measure/metric.h"

namespace lightvane {
namespace {

MetricResult computeRelative(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const int width = input.reference.width(), height = input.reference.height();
  const Image<double> local = localMeans(input.reference, counted);
  const double dark = kDarkPart * counted.referenceMean;
  MeanOfPixels errors(width, height);
  double ofNoise = 0.0;
  counted.forEach([&](int x, int y, std::size_t i) {
    const double squared = squaredDifference(input.picture[i], input.reference[i]);
    const double noise = meanOf(noiseVariance(input, i));
    const double scale = square(local[i]) + square(dark);
    // A black picture of a black scene is right, and any other wrong by all.
    errors.add(x, y, scale > 0.0 ? (squared - noise) / scale : squared > 0.0 ? 1.0 : 0.0);
    result.map[i] = static_cast<float>(scale > 0.0 ? std::sqrt(squared / scale) : squared > 0.0 ? 1.0 : 0.0);
    if (scale > 0.0) ofNoise += noise / scale;
  });
  const MeanEstimate estimate = errors.estimate();
  result.value = estimate.root();
  result.standardError = ifFinite(estimate.rootError());
  if (knowsNoise(input)) result.ofReference = std::sqrt(ofNoise / static_cast<double>(counted.count));
  return result;
}

}  // namespace

PictureError pictureError(const ImageRgb& picture, const ImageRgb& reference, const ImageRgb& variance) {
  const MetricResult result =
      computeRelative({.picture = picture, .reference = reference, .variance = &variance});
  if (result.counted == 0) return {};
  return {result.value, result.standardError.value_or(0.0)};
}

MetricInfo relativeMetric() {
  return {.name = "relative",
          .label = "Relative RMSE",
          .unit = MetricUnit::Fraction,
          .subtractsNoise = true,
          .description =
              "The root of the mean squared relative difference over pixels and colours. It is "
              "relative to the mean of the reference in the 5x5 pixels around, and to 1 % of the "
              "mean of all where that is dark.",
          .map = "relative difference",
          .compute = computeRelative};
}

double pictureNoise(const ImageRgb& picture, const ImageRgb& variance) {
  return relativeMetric().compute({picture, picture, &variance}).ofReference.value_or(0.0);
}

}  // namespace lightvane
