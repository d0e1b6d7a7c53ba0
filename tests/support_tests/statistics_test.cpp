#include "tests/support/statistics.h"

#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/base/random.h"

namespace lightvane {
namespace {

// Blocks of 64 uniform numbers with mean 1 and standard deviation 1, plus a bias.
std::vector<double> noisyBlocks(std::uint32_t stream, std::size_t count, double bias) {
  std::vector<double> blocks(count, 1.0 + bias);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint32_t sample = 0; sample < 64; ++sample) {
      const double u = uniform(randomKey(1).with(stream), static_cast<std::uint32_t>(i), sample);
      blocks[i] += (u - 0.5) * std::sqrt(12.0) / 64.0;
    }
  }
  return blocks;
}

TEST(Distributions, MatchClosedForms) {
  for (const double x : {1e-6, 0.3, 1.0, 2.9, 17.0, 400.0}) {
    EXPECT_NEAR(upperIncompleteGamma(1.0, x) / std::exp(-x), 1.0, 1e-12) << "x = " << x;
    EXPECT_NEAR(upperIncompleteGamma(0.5, x) / std::erfc(std::sqrt(x)), 1.0, 1e-12) << "x = " << x;
    EXPECT_NEAR(upperIncompleteGamma(3.0, x) / (std::exp(-x) * (1.0 + x + 0.5 * x * x)), 1.0, 1e-12)
        << "x = " << x;
  }
  EXPECT_EQ(upperIncompleteGamma(2.5, 0.0), 1.0);
  for (const double x : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(incompleteBeta(2.0, 3.0, x), x * x * (6.0 - 8.0 * x + 3.0 * x * x), 1e-14) << "x = " << x;
    EXPECT_NEAR(incompleteBeta(0.5, 0.5, x), 2.0 / kPiD * std::asin(std::sqrt(x)), 1e-14) << "x = " << x;
  }
}

// Abramowitz & Stegun, "Handbook of Mathematical Functions", tables 26.8 (chi-square) and 26.10 (Student),
// with the further digits of the NIST/SEMATECH e-Handbook, section 1.3.6.7.
TEST(Distributions, MatchTables) {
  struct ChiSquare {
    double freedom, value, p;
  };
  for (const auto& [freedom, value, p] : {ChiSquare{1, 3.84146, 0.05},
                                          {1, 10.8276, 0.001},
                                          {5, 11.0705, 0.05},
                                          {10, 18.3070, 0.05},
                                          {10, 3.94030, 0.95},
                                          {30, 50.8922, 0.01},
                                          {100, 124.342, 0.05},
                                          {100, 149.449, 0.001}}) {
    EXPECT_NEAR(upperIncompleteGamma(freedom / 2, value / 2) / p, 1.0, 2e-4)
        << freedom << " degrees, " << value;
  }
  struct Student {
    double freedom, probability, value;
  };
  for (const auto& [freedom, probability, value] : {Student{1, 0.975, 12.706},
                                                    {2, 0.95, 2.920},
                                                    {5, 0.975, 2.571},
                                                    {7, 0.9995, 5.408},
                                                    {10, 0.995, 3.169},
                                                    {30, 0.975, 2.042},
                                                    {120, 0.995, 2.617},
                                                    {10, 0.025, -2.228}}) {
    EXPECT_NEAR(studentQuantile(probability, freedom), value, 6e-4) << freedom << " degrees, " << probability;
  }
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normalQuantile(0.9995), 3.290526731491926, 1e-12);
  EXPECT_NEAR(normalQuantile(0.5), 0.0, 1e-12);
}

TEST(MeanInterval, IsStudents) {
  // Mean 3, standard deviation sqrt(2.5), t(0.975, 4) = 2.776445.
  const MeanInterval interval = meanInterval(std::array{1.0, 2.0, 3.0, 4.0, 5.0}, 0.95);
  EXPECT_DOUBLE_EQ(interval.mean, 3.0);
  EXPECT_NEAR(interval.standardError, std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(interval.upper, 3.0 + 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(interval.lower, 3.0 - 2.776445 * std::sqrt(0.5), 1e-6);
  EXPECT_THROW(meanInterval(std::array{1.0}, 0.95), InvariantViolation);
}

TEST(MeanInterval, HoldsTheTruthAsOftenAsItSays) {
  int inside = 0;
  constexpr int kTrials = 2000;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    const MeanInterval interval = meanInterval(noisyBlocks(trial, 8, 0.0), 0.9);
    inside += interval.lower <= 1.0 && interval.upper >= 1.0;
  }
  // Binomial, standard deviation sqrt(2000 0.9 0.1) = 13.4; four of them.
  EXPECT_NEAR(inside, 0.9 * kTrials, 54.0);
}

TEST(BiasTest, AcceptsNoneAndDetectsOnePercent) {
  // 4000 blocks: a standard error of 1/sqrt(64 4000) = 0.2 %, an interval of ±0.65 % at 99.9 %.
  const BiasTest test{0.01};
  const BiasTest::Result none = test.againstValue(noisyBlocks(1, 4000, 0.0), 1.0);
  EXPECT_TRUE(none.passes()) << none.explanation;
  const BiasTest::Result injected = test.againstValue(noisyBlocks(1, 4000, 0.01), 1.0);
  EXPECT_FALSE(injected.passes()) << injected.explanation;
  EXPECT_EQ(test.againstValue(noisyBlocks(1, 4000, 0.02), 1.0).verdict, BiasTest::Verdict::kBeyond);
  EXPECT_EQ(test.againstValue(noisyBlocks(1, 4000, -0.02), 1.0).verdict, BiasTest::Verdict::kBeyond);
  // A smaller tolerance with enough samples: 1 % is then shown to be there.
  const BiasTest::Result shown = BiasTest{0.003, 0.99}.againstValue(noisyBlocks(1, 4000, 0.01), 1.0);
  EXPECT_EQ(shown.verdict, BiasTest::Verdict::kBeyond) << shown.explanation;
}

TEST(BiasTest, DoesNotPassForLackOfSamples) {
  const BiasTest::Result few = BiasTest{0.01}.againstValue(noisyBlocks(1, 40, 0.0), 1.0);
  EXPECT_EQ(few.verdict, BiasTest::Verdict::kUndecided) << few.explanation;
  const BiasTest::Result vague = BiasTest{0.01}.againstValue(noisyBlocks(1, 4000, 0.0), 1.0, 0.01);
  EXPECT_EQ(vague.verdict, BiasTest::Verdict::kUndecided) << vague.explanation;
  const BiasTest::Result broken = BiasTest{0.01}.againstValue(std::array{1.0, std::nan(""), 1.0}, 1.0);
  EXPECT_FALSE(broken.passes()) << broken.explanation;
}

TEST(BiasTest, PassesAWrongPictureAsRarelyAsItSays) {
  // A bias exactly at the tolerance passes in (1 - confidence) / 2 = 5 % of the trials.
  int passed = 0;
  constexpr int kTrials = 2000;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    passed += BiasTest{0.2, 0.9}.againstValue(noisyBlocks(trial, 20, 0.2), 1.0).passes();
  }
  // Binomial, standard deviation sqrt(2000 0.05 0.95) = 9.7; four of them.
  EXPECT_NEAR(passed, 0.05 * kTrials, 39.0);
}

TEST(BiasTest, ComparesPixels) {
  std::vector<double> estimates, references, standardErrors;
  for (std::uint32_t pixel = 0; pixel < 4096; ++pixel) {
    const double reference = 1.0 + pixel / 4096.0;
    const double noise = (uniform(randomKey(3), pixel, 0) - 0.5) * std::sqrt(12.0) * 0.1;
    references.push_back(reference);
    estimates.push_back(reference + noise);
    standardErrors.push_back(0.1);
  }
  // The mean of 1.5 is known to 0.1/64 = 0.1 %, its interval is ±0.34 %.
  const BiasTest::Result none = BiasTest{0.006}.againstPixels(estimates, references, standardErrors);
  EXPECT_TRUE(none.passes()) << none.explanation;
  for (double& estimate : estimates) estimate *= 1.01;
  const BiasTest::Result injected = BiasTest{0.006}.againstPixels(estimates, references, standardErrors);
  EXPECT_EQ(injected.verdict, BiasTest::Verdict::kBeyond) << injected.explanation;
}

TEST(BiasTest, ExplainsItself) {
  const BiasTest::Result result = BiasTest{0.01, 0.95}.againstValue(std::array{2.1, 2.1, 2.1}, 2.0);
  EXPECT_EQ(result.explanation,
            "biased: bias +5.0000 % of reference 2, 95 % interval [+5.0000 %, +5.0000 %], "
            "standard error 0.0000 %, allowed 1.0000 %");
}

TEST(ChiSquareTest, IsPearsons) {
  // A die thrown 60 times: (25 + 4 + 4 + 0 + 9 + 4) / 10 = 4.6 with 5 degrees of freedom.
  const ChiSquareResult die = chiSquareTest(std::array{5.0, 8.0, 12.0, 10.0, 13.0, 12.0},
                                            std::array{10.0, 10.0, 10.0, 10.0, 10.0, 10.0});
  EXPECT_NEAR(die.statistic, 4.6, 1e-12);
  EXPECT_EQ(die.freedom, 5.0);
  EXPECT_NEAR(die.pValue, 0.46659, 1e-4) << die.explanation;
}

TEST(ChiSquareTest, MergesCellsThatExpectLittle) {
  const ChiSquareResult result =
      chiSquareTest(std::array{3.0, 2.0, 20.0, 10.0, 1.0}, std::array{2.0, 3.0, 19.0, 11.0, 1.0});
  EXPECT_EQ(result.freedom, 2.0) << result.explanation;
  EXPECT_NEAR(result.statistic, 0.0 + 1.0 / 19.0 + 1.0 / 12.0, 1e-12) << result.explanation;
}

TEST(ChiSquareTest, RefusesTotalsThatDiffer) {
  EXPECT_THROW(chiSquareTest(std::array{10.0, 20.0}, std::array{15.0, 25.0}), InvariantViolation);
}

TEST(ChiSquareTest, TellsAnUnevenDistribution) {
  std::vector<double> even(32, 0.0), uneven(32, 0.0);
  const std::vector<double> expected(32, 2048.0);
  for (std::uint32_t i = 0; i < 65536; ++i) {
    const double u = uniform(randomKey(5), i, 0);
    even[static_cast<std::size_t>(u * 32.0)] += 1.0;
    uneven[static_cast<std::size_t>(std::pow(u, 1.05) * 32.0)] += 1.0;
  }
  EXPECT_GT(chiSquareTest(even, expected).pValue, 1e-3) << chiSquareTest(even, expected).explanation;
  EXPECT_LT(chiSquareTest(uneven, expected).pValue, 1e-6) << chiSquareTest(uneven, expected).explanation;
}

// exp(x u) averaged over u in [0, 1): its mean is (e^x - 1) / x.
double noisyExponential(double x, std::size_t block) {
  double sum = 0.0;
  for (std::uint32_t sample = 0; sample < 64; ++sample) {
    sum += std::exp(x * uniform(randomKey(9).with(static_cast<std::uint32_t>(block)), sample, 0)) / 64.0;
  }
  return sum;
}

TEST(CentralDifference, UsesCommonRandomNumbers) {
  // d/dx (e^x - 1) / x = (e^x (x - 1) + 1) / x², which is 1 at x = 1.
  const DerivativeEstimate slope = centralDifference(noisyExponential, 1.0, 1e-3, 64, 0.999);
  EXPECT_LE(slope.value.lower, 1.0);
  EXPECT_GE(slope.value.upper, 1.0);
  // The standard deviation of u e^u is 0.80: 0.0125 over 4096 samples. With other numbers at each end it
  // would be sqrt(2) 0.49 / 64 / 2e-3 = 5.4.
  EXPECT_LT(slope.value.standardError, 0.02);
}

TEST(CentralDifference, EstimatesItsTruncation) {
  const auto cubic = [](double x, std::size_t) { return x * x * x; };
  const DerivativeEstimate slope = centralDifference(cubic, 2.0, 0.1, 2, 0.99);
  EXPECT_NEAR(slope.value.mean, 12.01, 1e-12);
  EXPECT_NEAR(slope.truncation, 0.01, 1e-12);
}

}  // namespace
}  // namespace lightvane
