#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/display_values.h"
#include "core/measure/flip_map.h"
#include "core/measure/mean_estimate.h"

// HDR-FLIP: Andersson, Nilsson, Shirley & Akenine-Moller, "Visualizing Errors in Rendered High Dynamic Range
// Images", 2021; where its authors' programs differ, the C++ one.

namespace lightvane {
namespace {

/// The pictures as FLIP's filters may see them: where pixels do not count both show the same, so that nothing
/// there is an error of the pixels around. That is the reference, or black where it is not finite.
struct ComparablePictures {
  ImageRgb picture, reference;

  ComparablePictures(const MetricInput& input, const CountedPixels& counted)
      : picture(input.picture), reference(input.reference) {
    for (std::size_t i = 0; i < reference.size(); ++i) {
      if (counted[i]) continue;
      if (!isFinite(reference[i])) reference[i] = Rgb(0.0f);
      picture[i] = reference[i];
    }
  }
};

MetricResult meanOfMap(ImageFloat&& map, const CountedPixels& counted) {
  MetricResult result = counted.result();
  MeanOfPixels errors(map.width(), map.height());
  counted.forEach([&](int x, int y, std::size_t i) {
    errors.add(x, y, static_cast<double>(map[i]));
    result.map[i] = map[i];
  });
  const MeanEstimate estimate = errors.estimate();
  result.value = estimate.mean;
  result.standardError = ifFinite(estimate.standardError);
  return result;
}

MetricResult computeFlip(const MetricInput& input) {
  const CountedPixels counted(input);
  if (counted.count == 0) return counted.result();
  ComparablePictures pictures(input, counted);
  for (ImageRgb* image : {&pictures.picture, &pictures.reference}) {
    for (Rgb& pixel : *image) pixel = clippedLight(pixel, input.exposureStops);
  }
  MetricResult result = meanOfMap(flipMap(pictures.picture, pictures.reference), counted);
  result.ofReference = ofNoiseAlone(input, computeFlip);
  return result;
}

/// The ACES curve as Narkowicz 2016 fits it, without his factor of 0.6: (k0 x^2 + k1 x) / (k3 x^2 + k4 x +
/// k5).
constexpr double kK0 = 0.6 * 0.6 * 2.51, kK1 = 0.6 * 0.03;
constexpr double kK3 = 0.6 * 0.6 * 2.43, kK4 = 0.6 * 0.59, kK5 = 0.14;

float acesCurve(float linear, double scale) {
  // Negative light is none; 1e6 is white for long, and its square still a float's.
  const auto x = static_cast<float>(std::clamp(static_cast<double>(linear) * scale, 0.0, 1e6));
  const auto k0 = static_cast<float>(kK0), k1 = static_cast<float>(kK1);
  const auto k3 = static_cast<float>(kK3), k4 = static_cast<float>(kK4), k5 = static_cast<float>(kK5);
  return std::min((k0 * x + k1) * x / ((k3 * x + k4) * x + k5), 1.0f);
}

/// What the curve makes 0.85 of.
double whiteOfCurve() {
  constexpr double kWhite = 0.85;
  constexpr double a = kK0 - kWhite * kK3, b = kK1 - kWhite * kK4, c = -kWhite * kK5;
  return -0.5 * b / a + std::sqrt(square(0.5 * b / a) - c / a);
}

/// In stops: from where the brightest pixel is all but white to where the median is, in steps of at most one.
/// Of a reference with a black median the median of what is not black is taken, where the authors' program
/// has no end; of a black one, no exposure.
std::vector<double> exposuresOf(const ImageRgb& reference, const CountedPixels& counted) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const glm::dvec3 c(reference[i]);
    if (counted[i]) luminances.push_back(0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b);
  }
  const auto medianOf = [](std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
  };
  const double largest = std::ranges::max(luminances);
  if (!(largest > 0.0)) return {0.0};
  double median = medianOf(luminances);
  if (!(median > 0.0)) {
    std::erase_if(luminances, [](double value) { return !(value > 0.0); });
    median = medianOf(luminances);
  }
  const double start = std::log2(whiteOfCurve() / largest), stop = std::log2(whiteOfCurve() / median);
  const int count = static_cast<int>(std::max(2.0, std::ceil(stop - start)));
  std::vector<double> exposures;
  for (int i = 0; i < count; ++i) exposures.push_back(start + i * (stop - start) / (count - 1));
  return exposures;
}

MetricResult computeHdrFlip(const MetricInput& input) {
  const CountedPixels counted(input);
  if (counted.count == 0) return counted.result();
  const ComparablePictures pictures(input, counted);
  ImageFloat worst(input.reference.width(), input.reference.height());
  ImageRgb picture = pictures.picture, reference = pictures.reference;
  for (const double exposure : exposuresOf(pictures.reference, counted)) {
    const double scale = std::exp2(exposure);
    const auto expose = [&](const ImageRgb& from, ImageRgb& to) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        for (int c = 0; c < 3; ++c) to[i][c] = acesCurve(from[i][c], scale);
      }
    };
    expose(pictures.picture, picture);
    expose(pictures.reference, reference);
    const ImageFloat map = flipMap(picture, reference);
    for (std::size_t i = 0; i < map.size(); ++i) worst[i] = std::max(worst[i], map[i]);
  }
  MetricResult result = meanOfMap(std::move(worst), counted);
  result.ofReference = ofNoiseAlone(input, computeHdrFlip);
  return result;
}

}  // namespace

MetricInfo flipMetric() {
  return {.name = "flip",
          .label = "FLIP",
          .unit = MetricUnit::None,
          .description =
              "Mean LDR-FLIP (Andersson et al. 2020) of the pictures as a screen shows them, at 67 "
              "pixels per degree: the difference that is seen when the pictures alternate. 0 to 1.",
          .map = "LDR-FLIP",
          .compute = computeFlip};
}

MetricInfo hdrFlipMetric() {
  return {.name = "hdrflip",
          .label = "HDR-FLIP",
          .unit = MetricUnit::None,
          .description =
              "Mean HDR-FLIP (Andersson et al. 2021): of each pixel the largest LDR-FLIP over "
              "exposures that show the reference's brightest to its median luminance, tone mapped by "
              "ACES. 0 to 1.",
          .map = "the largest LDR-FLIP of all exposures",
          .compute = computeHdrFlip};
}

}  // namespace lightvane
