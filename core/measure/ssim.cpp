#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/display_values.h"
#include "core/measure/mean_estimate.h"
#include "core/measure/separable_filter.h"

// Wang, Bovik, Sheikh & Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
// Similarity", 2004: equation 13, with the window and constants of section III-C. As in the authors' program,
// the mean is over pixels whose whole window lies within the picture. That cannot be where the picture is
// smaller than the window, and pixels that do not count are never looked at: there the window's weights are
// those of what is left, and sum to 1 again.

namespace lightvane {
namespace {

constexpr int kWindowReach = 5;  // 11 x 11
constexpr int kWindowSize = 2 * kWindowReach + 1;
constexpr double kWindowDeviation = 1.5;
constexpr double kC1 = 0.01 * 0.01;  // (K1 L)^2, with values up to L = 1
constexpr double kC2 = 0.03 * 0.03;  // (K2 L)^2

std::vector<double> windowWeights() {
  std::vector<double> weights(kWindowSize);
  double sum = 0.0;
  for (int k = 0; k < kWindowSize; ++k) {
    const double weight = std::exp(-0.5 * square((k - kWindowReach) / kWindowDeviation));
    weights[static_cast<std::size_t>(k)] = weight;
    sum += weight;
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// Rec. 709 luma; 0 where a pixel does not count.
ImageFloat lumaOf(const ImageRgb& image, const CountedPixels& counted, double exposureStops) {
  ImageFloat luma(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) {
    if (counted[i]) luma[i] = luminance(displayValue(image[i], exposureStops));
  }
  return luma;
}

/// What a window sums of values a and b and their weights.
enum Sum { SumOfWeights, SumOfA, SumOfB, SumOfAA, SumOfBB, SumOfAB, SumCount };
using SumRows = std::array<std::vector<double>, SumCount>;

/// The sums of the windows' columns about row y.
void sumColumns(const ImageFloat& a, const ImageFloat& b, const CountedPixels& counted, int y,
                const std::vector<double>& weights, SumRows& sums) {
  for (std::vector<double>& row : sums) std::ranges::fill(row, 0.0);
  for (int ny = std::max(y - kWindowReach, 0); ny <= std::min(y + kWindowReach, a.height() - 1); ++ny) {
    const auto place =
        static_cast<std::size_t>(ny) + static_cast<std::size_t>(kWindowReach) - static_cast<std::size_t>(y);
    const double weight = weights[place];
    const float* aRow = a.data() + a.index(0, ny);
    const float* bRow = b.data() + b.index(0, ny);
    const std::uint8_t* countRow = counted.counts.data() + counted.counts.index(0, ny);
    for (std::size_t x = 0; x < static_cast<std::size_t>(a.width()); ++x) {
      const auto va = static_cast<double>(aRow[x]);
      const auto vb = static_cast<double>(bRow[x]);
      sums[SumOfWeights][x] += weight * static_cast<double>(countRow[x]);
      sums[SumOfA][x] += weight * va;
      sums[SumOfB][x] += weight * vb;
      sums[SumOfAA][x] += weight * va * va;
      sums[SumOfBB][x] += weight * vb * vb;
      sums[SumOfAB][x] += weight * va * vb;
    }
  }
}

/// The index of one window, by its sums.
double ssimOf(const SumRows& windows, std::size_t column) {
  const double weight = windows[SumOfWeights][column];
  const double meanA = windows[SumOfA][column] / weight;
  const double meanB = windows[SumOfB][column] / weight;
  // Rounding may leave less than 0, by far less than C2.
  const double varianceA = windows[SumOfAA][column] / weight - square(meanA);
  const double varianceB = windows[SumOfBB][column] / weight - square(meanB);
  const double covariance = windows[SumOfAB][column] / weight - meanA * meanB;
  return (2.0 * meanA * meanB + kC1) * (2.0 * covariance + kC2) /
         ((square(meanA) + square(meanB) + kC1) * (varianceA + varianceB + kC2));
}

/// The mean over the windows that lie wholly in the picture; where none of those counts, over all. Sets
/// `map`.
MeanEstimate meanSsim(const ImageFloat& a, const ImageFloat& b, const CountedPixels& counted,
                      ImageFloat& map) {
  const int width = a.width(), height = a.height();
  const std::vector<double> weights = windowWeights();
  const int marginX = width >= kWindowSize ? kWindowReach : 0;
  const int marginY = height >= kWindowSize ? kWindowReach : 0;
  SumRows columns, windows;
  for (SumRows* rows : {&columns, &windows}) {
    for (std::vector<double>& row : *rows) row.resize(static_cast<std::size_t>(width));
  }
  std::vector<double> padded;
  MeanOfPixels whole(width, height), all(width, height);
  for (int y = 0; y < height; ++y) {
    sumColumns(a, b, counted, y, weights, columns);
    for (std::size_t s = 0; s < SumCount; ++s)
      filterRow<double>(columns[s], weights, FilterBorder::Nothing, windows[s], padded);
    for (int x = 0; x < width; ++x) {
      if (!counted(x, y)) continue;
      const double ssim = ssimOf(windows, static_cast<std::size_t>(x));
      map.at(x, y) = static_cast<float>(std::max(1.0 - ssim, 0.0));
      all.add(x, y, ssim);
      if (x >= marginX && x < width - marginX && y >= marginY && y < height - marginY) whole.add(x, y, ssim);
    }
  }
  // All that counts may lie at the picture's border.
  return (whole.count() > 0 ? whole : all).estimate();
}

MetricResult computeSsim(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const ImageFloat a = lumaOf(input.picture, counted, input.exposureStops);
  const ImageFloat b = lumaOf(input.reference, counted, input.exposureStops);
  const MeanEstimate estimate = meanSsim(a, b, counted, result.map);
  result.value = estimate.mean;
  result.standardError = ifFinite(estimate.standardError);
  result.ofReference = ofNoiseAlone(input, computeSsim);
  return result;
}

}  // namespace

MetricInfo ssimMetric() {
  return {.name = "ssim",
          .label = "SSIM",
          .unit = MetricUnit::None,
          .better = BetterValue::Higher,
          .description =
              "Mean structural similarity (Wang et al. 2004) of the Rec. 709 luma of display values: "
              "Gaussian windows of 11x11 pixels with a deviation of 1.5, K1 = 0.01, K2 = 0.03. 1 for "
              "equal pictures.",
          .map = "1 - SSIM",
          .compute = computeSsim};
}

}  // namespace lightvane
