#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

// Rousselle, Knaus & Zwicker, "Adaptive Sampling and Reconstruction using Greedy Error Minimization", 2011,
// section 6. Their 1e-2 is in the unit of their pictures; ours is in parts of the reference's squared mean,
// so that the same pictures in another unit have the same error.
//
// The reference's noise n is in the numerator and in the denominator: with f(b) = (a - b)^2 / (b^2 +
// epsilon), E f(b + n) = f(b) + f''(b) var(n) / 2 + O(n^4), and the second term is subtracted. The numerator
// alone would leave four times the noise times the relative error.

namespace lightvane {
namespace {

constexpr double kEpsilon = 1e-2;  // of the squared mean

/// f''(b) / 2 for u = a - b and g = 1 / (b^2 + epsilon).
double halfCurvature(double u, double b, double g) {
  return g * (1.0 + 4.0 * u * b * g + square(u) * g * (4.0 * square(b) * g - 1.0));
}

MetricResult computeRelMse(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  if (counted.count == 0) return result;
  const int width = input.reference.width(), height = input.reference.height();
  const double epsilon = kEpsilon * square(counted.referenceMean);
  MeanOfPixels errors(width, height);
  double ofNoise = 0.0;
  counted.forEach([&](int x, int y, std::size_t i) {
    const glm::dvec3 variance = noiseVariance(input, i);
    double error = 0.0, noise = 0.0;
    for (int c = 0; c < 3; ++c) {
      const auto b = static_cast<double>(input.reference[i][c]);
      const double u = static_cast<double>(input.picture[i][c]) - b;
      const double scale = square(b) + epsilon;
      if (scale > 0.0) {
        error += square(u) / scale / 3.0;
        noise += variance[c] * halfCurvature(u, b, 1.0 / scale) / 3.0;
        ofNoise += variance[c] / scale / 3.0;
      } else if (u != 0.0) {
        error += 1.0 / 3.0;  // a black picture of a black scene is right, and any other wrong by all
      }
    }
    errors.add(x, y, error - noise);
    result.map[i] = static_cast<float>(error);
  });
  const MeanEstimate estimate = errors.estimate();
  result.value = std::max(estimate.mean, 0.0);
  result.standardError = ifFinite(estimate.standardError);
  if (knowsNoise(input)) result.ofReference = ofNoise / static_cast<double>(counted.count);
  return result;
}

}  // namespace

MetricInfo relMseMetric() {
  return {.name = "relmse",
          .label = "relMSE",
          .unit = MetricUnit::None,
          .subtractsNoise = true,
          .description =
              "Relative mean squared error: (picture - reference)^2 / (reference^2 + epsilon), of "
              "each colour, with epsilon = 0.01 of the reference's squared mean.",
          .map = "relative squared error",
          .compute = computeRelMse};
}

}  // namespace lightvane
