#include "core/measure/counted_pixels.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/check.h"
#include "core/base/color.h"
#include "core/base/math.h"
#include "core/base/random.h"

namespace lightvane {
namespace {

constexpr int kLocalReach = 2;  // of the pixels around: 5 x 5

/// A number of the standard normal distribution (Box & Muller 1958).
double normalNumber(RandomKey key, std::uint32_t sample, std::uint32_t dimension) {
  const double radius =
      std::sqrt(-2.0 * std::log(1.0 - static_cast<double>(uniform(key, sample, dimension))));
  return radius * std::cos(2.0 * kPiD * static_cast<double>(uniform(key, sample, dimension + 1)));
}

}  // namespace

double meanOf(const Rgb& colour) { return meanOf(glm::dvec3(colour)); }
double meanOf(const glm::dvec3& colour) { return (colour.r + colour.g + colour.b) / 3.0; }

double squaredDifference(const Rgb& a, const Rgb& b) {
  const glm::dvec3 difference = glm::dvec3(a) - glm::dvec3(b);
  return glm::dot(difference, difference) / 3.0;
}

CountedPixels::CountedPixels(const MetricInput& input) {
  const ImageRgb& reference = input.reference;
  LV_CHECK(!reference.empty(), "a reference of {}x{} pixels", reference.width(), reference.height());
  const auto checkSize = [&](const auto& image, const char* name) {
    LV_CHECK(image.width() == reference.width() && image.height() == reference.height(),
             "{} of {}x{} pixels for a reference of {}x{}", name, image.width(), image.height(),
             reference.width(), reference.height());
  };
  checkSize(input.picture, "a picture");
  const bool masked = input.mask != nullptr && !input.mask->empty();
  if (masked) checkSize(*input.mask, "a mask");
  if (knowsNoise(input)) checkSize(*input.variance, "a variance");

  counts = Image<std::uint8_t>(reference.width(), reference.height());
  double sum = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (masked && !((*input.mask)[i] > 0.0f)) continue;
    if (!isFinite(input.picture[i]) || !isFinite(reference[i])) {
      ++notFinite;
      continue;
    }
    counts[i] = 1;
    ++count;
    sum += meanOf(reference[i]);
  }
  if (count > 0) referenceMean = sum / static_cast<double>(count);
}

MetricResult CountedPixels::result() const {
  MetricResult result;
  result.map = ImageFloat(counts.width(), counts.height());
  result.counted = count;
  result.notFinite = notFinite;
  return result;
}

Image<double> localMeans(const ImageRgb& reference, const CountedPixels& counted) {
  const int width = reference.width(), height = reference.height();
  Image<double> means(width, height);
  const auto last = static_cast<std::size_t>(width - 1);
  std::vector<double> sums(static_cast<std::size_t>(width));
  std::vector<double> counts(static_cast<std::size_t>(width));
  for (int y = 0; y < height; ++y) {
    std::ranges::fill(sums, 0.0);
    std::ranges::fill(counts, 0.0);
    for (int ny = std::max(y - kLocalReach, 0); ny <= std::min(y + kLocalReach, height - 1); ++ny) {
      for (int x = 0; x < width; ++x) {
        if (!counted(x, ny)) continue;
        sums[static_cast<std::size_t>(x)] += meanOf(reference.at(x, ny));
        counts[static_cast<std::size_t>(x)] += 1.0;
      }
    }
    for (int x = 0; x < width; ++x) {
      const auto begin = static_cast<std::size_t>(std::max(x - kLocalReach, 0));
      const auto end = std::min(static_cast<std::size_t>(x + kLocalReach), last);
      double sum = 0.0, count = 0.0;
      for (std::size_t nx = begin; nx <= end; ++nx) {
        sum += sums[nx];
        count += counts[nx];
      }
      means.at(x, y) = count > 0.0 ? sum / count : 0.0;
    }
  }
  return means;
}

bool knowsNoise(const MetricInput& input) { return input.variance != nullptr && !input.variance->empty(); }

glm::dvec3 noiseVariance(const MetricInput& input, std::size_t i) {
  if (!knowsNoise(input)) return glm::dvec3(0.0);
  glm::dvec3 variance((*input.variance)[i]);
  for (int c = 0; c < 3; ++c) {
    if (!(variance[c] > 0.0) || !std::isfinite(variance[c])) variance[c] = 0.0;
  }
  return variance;
}

std::optional<double> ofNoiseAlone(const MetricInput& input, MetricResult (*compute)(const MetricInput&)) {
  if (!knowsNoise(input)) return std::nullopt;
  constexpr RandomKey kKey = randomKey(0x6e6f697365);
  ImageRgb noisy = input.reference;
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const glm::dvec3 variance = noiseVariance(input, i);
    for (int c = 0; c < 3; ++c) {
      const double number =
          normalNumber(kKey, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(2 * c));
      noisy[i][c] = static_cast<float>(static_cast<double>(noisy[i][c]) + std::sqrt(variance[c]) * number);
    }
  }
  return compute({.picture = input.reference,
                  .reference = noisy,
                  .mask = input.mask,
                  .exposureStops = input.exposureStops})
      .value;
}

}  // namespace lightvane
