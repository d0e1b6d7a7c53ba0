#include "tests/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/base/check.h"

namespace lightvane {
namespace {

constexpr double kPrecision = 1e-16;
constexpr double kTiny = 1e-300;  // keeps Lentz's method from dividing by zero
constexpr int kMaxTerms = 100000;

// Inverts an increasing function by bisection, which is slow and cannot go wrong.
template <class Cdf>
double invert(const Cdf& cdf, double probability) {
  LV_CHECK(probability > 0.0 && probability < 1.0, "quantile of {}", probability);
  double lower = -1.0, upper = 1.0;
  while (cdf(lower) > probability) lower *= 2.0;
  while (cdf(upper) < probability) upper *= 2.0;
  for (int i = 0; i < 200 && upper - lower > kPrecision * std::abs(upper); ++i) {
    const double middle = 0.5 * (lower + upper);
    (cdf(middle) < probability ? lower : upper) = middle;
  }
  return 0.5 * (lower + upper);
}

double betaFraction(double a, double b, double x) {
  double c = 1.0;
  double d = 1.0 - (a + b) * x / (a + 1.0);
  d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
  double fraction = d;
  for (int m = 1; m < kMaxTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    double step = 1.0;
    for (const double term : {even, odd}) {
      d = 1.0 + term * d;
      d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1.0 + term / c;
      if (std::abs(c) < kTiny) c = kTiny;
      step = c * d;
      fraction *= step;
    }
    if (std::abs(step - 1.0) < 1e-15) break;
  }
  return fraction;
}

}  // namespace

double upperIncompleteGamma(double a, double x) {
  LV_CHECK(a > 0.0 && x >= 0.0, "upperIncompleteGamma({}, {})", a, x);
  if (x == 0.0) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < kMaxTerms && term > kPrecision * sum; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return 1.0 - scale * sum;
  }
  double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, fraction = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double factor = -n * (n - a);
    b += 2.0;
    d = factor * d + b;
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + factor / c;
    if (std::abs(c) < kTiny) c = kTiny;
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return scale * fraction;
}

double incompleteBeta(double a, double b, double x) {
  LV_CHECK(a > 0.0 && b > 0.0 && x >= 0.0 && x <= 1.0, "incompleteBeta({}, {}, {})", a, b, x);
  if (x == 0.0 || x == 1.0) return x;
  const double scale =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  // The fraction converges fast below the mean of the distribution; above, use the symmetry.
  if (x < (a + 1.0) / (a + b + 2.0)) return scale * betaFraction(a, b, x) / a;
  return 1.0 - scale * betaFraction(b, a, 1.0 - x) / b;
}

double studentCdf(double t, double freedom) {
  const double tail = 0.5 * incompleteBeta(0.5 * freedom, 0.5, freedom / (freedom + t * t));
  return t > 0.0 ? 1.0 - tail : tail;
}

double studentQuantile(double probability, double freedom) {
  return invert([freedom](double t) { return studentCdf(t, freedom); }, probability);
}

double normalQuantile(double probability) {
  return invert([](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }, probability);
}

MeanInterval meanInterval(std::span<const double> blocks, double confidence) {
  LV_CHECK(blocks.size() >= 2, "an interval from {} blocks", blocks.size());
  const double count = static_cast<double>(blocks.size());
  double mean = 0.0;
  for (const double block : blocks) mean += block / count;
  double squares = 0.0;
  for (const double block : blocks) squares += (block - mean) * (block - mean);
  const double standardError = std::sqrt(squares / (count - 1.0) / count);
  const double halfWidth = studentQuantile(0.5 * (1.0 + confidence), count - 1.0) * standardError;
  return {mean, standardError, mean - halfWidth, mean + halfWidth};
}

BiasTest::Result BiasTest::againstValue(std::span<const double> blocks, double reference,
                                        double referenceStandardError) const {
  const MeanInterval estimate = meanInterval(blocks, confidence);
  // Student's quantile with the blocks' freedom for the sum of both errors: too wide rather than too narrow.
  const double quantile = studentQuantile(0.5 * (1.0 + confidence), static_cast<double>(blocks.size()) - 1.0);
  return decide(estimate.mean - reference, std::hypot(estimate.standardError, referenceStandardError),
                quantile, reference);
}

BiasTest::Result BiasTest::againstPixels(std::span<const double> estimates,
                                         std::span<const double> references,
                                         std::span<const double> standardErrors) const {
  LV_CHECK(!estimates.empty() && estimates.size() == references.size() &&
               estimates.size() == standardErrors.size(),
           "{} estimates, {} references, {} standard errors", estimates.size(), references.size(),
           standardErrors.size());
  const double count = static_cast<double>(estimates.size());
  double bias = 0.0, reference = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    bias += (estimates[i] - references[i]) / count;
    reference += references[i] / count;
    variance += standardErrors[i] * standardErrors[i] / (count * count);
  }
  return decide(bias, std::sqrt(variance), normalQuantile(0.5 * (1.0 + confidence)), reference);
}

BiasTest::Result BiasTest::decide(double bias, double standardError, double quantile,
                                  double reference) const {
  const double allowed = tolerance * std::abs(reference);
  const MeanInterval interval{bias, standardError, bias - quantile * standardError,
                              bias + quantile * standardError};
  // Written so that a NaN anywhere ends as undecided, which does not pass.
  Verdict verdict = Verdict::kUndecided;
  if (interval.lower >= -allowed && interval.upper <= allowed) verdict = Verdict::kWithin;
  if (interval.lower > allowed || interval.upper < -allowed) verdict = Verdict::kBeyond;
  const char* const words = verdict == Verdict::kWithin   ? "within tolerance"
                            : verdict == Verdict::kBeyond ? "biased"
                                                          : "undecided: more samples needed";
  const double percent = 100.0 / std::abs(reference);
  return {verdict, interval,
          fmt::format("{}: bias {:+.4f} % of reference {:.6g}, {} % interval [{:+.4f} %, {:+.4f} %], "
                      "standard error {:.4f} %, allowed {:.4f} %",
                      words, bias * percent, reference, 100.0 * confidence, interval.lower * percent,
                      interval.upper * percent, standardError * percent, 100.0 * tolerance)};
}

ChiSquareResult chiSquareTest(std::span<const double> observed, std::span<const double> expected) {
  LV_CHECK(!observed.empty() && observed.size() == expected.size(), "{} counts, {} expected", observed.size(),
           expected.size());
  constexpr double kLeastExpected = 5.0;
  struct Cell {
    double observed = 0.0, expected = 0.0;
  };
  std::vector<Cell> cells;
  Cell open;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    open.observed += observed[i];
    open.expected += expected[i];
    if (open.expected < kLeastExpected) continue;
    cells.push_back(open);
    open = {};
  }
  LV_CHECK(cells.size() >= 2, "{} counts merge to {} cells: nothing to test", observed.size(), cells.size());
  cells.back().observed += open.observed;
  cells.back().expected += open.expected;
  double statistic = 0.0, totalObserved = 0.0, totalExpected = 0.0;
  for (const Cell& cell : cells) {
    statistic += (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
    totalObserved += cell.observed;
    totalExpected += cell.expected;
  }
  LV_CHECK(std::abs(totalObserved - totalExpected) <= 1e-6 * totalExpected, "{} observed in all, {} expected",
           totalObserved, totalExpected);
  const double freedom = static_cast<double>(cells.size()) - 1.0;
  const double pValue = upperIncompleteGamma(0.5 * freedom, 0.5 * statistic);
  return {statistic, freedom, pValue,
          fmt::format("chi-square {:.4g} with {} degrees of freedom, p = {:.3g}, {} counts in {} cells",
                      statistic, freedom, pValue, observed.size(), cells.size())};
}

DerivativeEstimate centralDifference(const std::function<double(double x, std::size_t block)>& estimate,
                                     double at, double step, std::size_t blocks, double confidence) {
  LV_CHECK(step > 0.0, "step {}", step);
  std::vector<double> slopes(blocks);
  double truncation = 0.0;
  for (std::size_t block = 0; block < blocks; ++block) {
    slopes[block] = (estimate(at + step, block) - estimate(at - step, block)) / (2.0 * step);
    const double wide = (estimate(at + 2.0 * step, block) - estimate(at - 2.0 * step, block)) / (4.0 * step);
    // The error is c h² to leading order: the steps h and 2h differ by 3 c h².
    truncation += (wide - slopes[block]) / 3.0 / static_cast<double>(blocks);
  }
  return {meanInterval(slopes, confidence), std::abs(truncation)};
}

}  // namespace lightvane
