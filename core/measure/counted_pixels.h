#pragma once

#include <cstdint>

#include "core/image/image.h"
#include "core/measure/metric.h"

namespace lightvane {

/// Of the colour's three components.
double meanOf(const Rgb& colour);
double meanOf(const glm::dvec3& colour);
/// The mean of the three components' squared differences.
double squaredDifference(const Rgb& a, const Rgb& b);

/// Which pixels of a comparison count: those that the mask lets, and which are finite in both pictures.
struct CountedPixels {
  /// Checks the sizes; broken invariants where they differ.
  explicit CountedPixels(const MetricInput& input);

  bool operator()(int x, int y) const { return counts.at(x, y) != 0; }
  bool operator[](std::size_t i) const { return counts[i] != 0; }
  /// Calls visit(x, y, i) for each of them, row by row; `i` is its place in the picture.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (int y = 0; y < counts.height(); ++y) {
      for (int x = 0; x < counts.width(); ++x) {
        if ((*this)(x, y)) visit(x, y, counts.index(x, y));
      }
    }
  }

  Image<std::uint8_t> counts;
  std::size_t count = 0;
  std::size_t notFinite = 0;
  double referenceMean = 0.0;  ///< of the reference's counted pixels and colours; 0 of none

  /// A result with no value yet: an empty map and the counts.
  MetricResult result() const;
};

/// What is dark is held against this part of the mean of all, by metrics of relative errors.
inline constexpr double kDarkPart = 0.01;

/// The mean of the reference's counted pixels and colours in the 5 x 5 pixels around each.
Image<double> localMeans(const ImageRgb& reference, const CountedPixels& counted);

bool knowsNoise(const MetricInput& input);
/// The variance of each colour of the reference's pixel i: 0 where it is not known or no positive number.
glm::dvec3 noiseVariance(const MetricInput& input, std::size_t i);

/// `compute` of a picture without error: the reference itself, against a reference with noise of the given
/// variance once more (normally distributed, of fixed seed). None where the variance is not known.
std::optional<double> ofNoiseAlone(const MetricInput& input, MetricResult (*compute)(const MetricInput&));

}  // namespace lightvane
