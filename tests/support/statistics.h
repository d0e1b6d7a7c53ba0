#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

namespace lightvane {

// ---- distributions: what the tests below need, to 1e-12 or better (relative, above 1e-300) ----

/// Q(a, x), the upper regularised incomplete gamma function; a > 0, x >= 0.
/// Series and Lentz's continued fraction: Press et al., "Numerical Recipes", 3rd ed., section 6.2.
double upperIncompleteGamma(double a, double x);
/// I_x(a, b), the regularised incomplete beta function; a, b > 0, x in [0, 1]. Ibid., section 6.4.
double incompleteBeta(double a, double b, double x);
/// P(T <= t) of Student's distribution.
double studentCdf(double t, double freedom);
/// t with P(T <= t) = probability, which is inside (0, 1).
double studentQuantile(double probability, double freedom);
/// z with P(Z <= z) = probability for the standard normal distribution.
double normalQuantile(double probability);

// ---- means ----

/// A mean and how far off it may be.
struct MeanInterval {
  double mean = 0.0;
  double standardError = 0.0;
  double lower = 0.0, upper = 0.0;  ///< where the true mean is, with the confidence that was asked for
};

/// Student's two-sided interval of the mean of independent, equally distributed blocks (at least 2). Blocks
/// should be means of many samples each, so that they are close to normal.
MeanInterval meanInterval(std::span<const double> blocks, double confidence);

// ---- bias ----

/// Whether something is unbiased, within a tolerance, at a stated confidence.
///
/// This is an equivalence test (two one-sided tests; Schuirmann 1987): it passes only if the confidence
/// interval of the bias lies wholly within the tolerance. So neither noise nor too few samples can make it
/// pass: a bias beyond the tolerance passes with a probability of (1 - confidence) / 2 at most.
struct BiasTest {
  enum class Verdict {
    kWithin,     ///< the interval is inside the tolerance: passes
    kBeyond,     ///< the interval is outside the tolerance: biased
    kUndecided,  ///< it straddles the tolerance: take more samples, or allow more
  };

  struct Result {
    Verdict verdict;
    MeanInterval bias;        ///< in the unit of the estimates
    std::string explanation;  ///< all the numbers in one line, for the failure message

    bool passes() const { return verdict == Verdict::kWithin; }
  };

  double tolerance;           ///< largest bias allowed, as a fraction of the (mean) reference
  double confidence = 0.999;  ///< two-sided, of the interval

  /// Independent blocks that estimate one number, against a reference with a standard error of its own.
  Result againstValue(std::span<const double> blocks, double reference,
                      double referenceStandardError = 0.0) const;

  /// Estimates with independent errors, each against its own reference (pixel against pixel).
  /// `standardErrors` are those of the differences. Tests the mean bias; a positive one here can make up for
  /// a negative one there.
  Result againstPixels(std::span<const double> estimates, std::span<const double> references,
                       std::span<const double> standardErrors) const;

 private:
  Result decide(double bias, double standardError, double quantile, double reference) const;
};

// ---- goodness of fit ----

struct ChiSquareResult {
  double statistic;
  double freedom;
  double pValue;  ///< probability of a statistic at least that large if the expectation is right
  std::string explanation;
};

/// Pearson's test of counts against expected counts (not probabilities), with the same total. Neighbouring
/// cells are merged until each expects 5 at least (Cochran 1954).
ChiSquareResult chiSquareTest(std::span<const double> observed, std::span<const double> expected);

// ---- derivatives ----

struct DerivativeEstimate {
  MeanInterval value;       ///< from steps h, its interval that of the sampling noise
  double truncation = 0.0;  ///< estimate of the O(h²) error that the step causes, from the step 2h
};

/// Central difference of a noisy function, with common random numbers: estimate(x, block) must use the same
/// random numbers for every x and other ones for every block, so that most of the noise cancels in each
/// block's difference.
DerivativeEstimate centralDifference(const std::function<double(double x, std::size_t block)>& estimate,
                                     double at, double step, std::size_t blocks, double confidence);

}  // namespace lightvane
