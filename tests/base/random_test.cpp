#include "core/base/random.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace lightvane {
namespace {

// The chi-square statistic of `counts` against equal expectation, as a number of standard deviations from its
// mean.
template <std::size_t N>
double chiSquareSigmas(const std::array<int, N>& counts, int total) {
  const double expected = static_cast<double>(total) / N;
  double chiSquare = 0.0;
  for (const int count : counts) chiSquare += (count - expected) * (count - expected) / expected;
  const double freedom = N - 1;
  return (chiSquare - freedom) / std::sqrt(2.0 * freedom);
}

TEST(Random, IsUniformAlongSamplesDimensionsAndKeys) {
  constexpr int kCount = 1 << 18;
  std::array<int, 256> bySample{}, byDimension{}, byKey{};
  for (std::uint32_t i = 0; i < kCount; ++i) {
    ++bySample[static_cast<std::size_t>(uniform(randomKey(7), i, 3) * 256)];
    ++byDimension[static_cast<std::size_t>(uniform(randomKey(7), 5, i) * 256)];
    ++byKey[static_cast<std::size_t>(uniform(randomKey(7).with(i), 0, 0) * 256)];
  }
  // Six sigma: one false alarm in 1e9 for a good generator.
  EXPECT_LT(std::abs(chiSquareSigmas(bySample, kCount)), 6.0);
  EXPECT_LT(std::abs(chiSquareSigmas(byDimension, kCount)), 6.0);
  EXPECT_LT(std::abs(chiSquareSigmas(byKey, kCount)), 6.0);
}

TEST(Random, PairsOfNeighbouringAddressesAreIndependent) {
  constexpr int kCount = 1 << 18;
  std::array<int, 256> bySample{}, byDimension{}, byKey{};
  const auto cell = [](float a, float b) {
    return static_cast<std::size_t>(a * 16) * 16 + static_cast<std::size_t>(b * 16);
  };
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const RandomKey key = randomKey(11).with(i);
    ++bySample[cell(uniform(key, 0, 0), uniform(key, 1, 0))];
    ++byDimension[cell(uniform(key, 0, 0), uniform(key, 0, 1))];
    ++byKey[cell(uniform(key, 0, 0), uniform(randomKey(11).with(i + 1), 0, 0))];
  }
  EXPECT_LT(std::abs(chiSquareSigmas(bySample, kCount)), 6.0);
  EXPECT_LT(std::abs(chiSquareSigmas(byDimension, kCount)), 6.0);
  EXPECT_LT(std::abs(chiSquareSigmas(byKey, kCount)), 6.0);
}

TEST(Random, NeverReachesOne) {
  EXPECT_EQ(unitFloat(0), 0.0f);
  EXPECT_LT(unitFloat(0xffffffffU), 1.0f);
}

TEST(Random, IsAddressedNotSequential) {
  const RandomKey key = randomKey(1).with(2u);
  const float later = uniform(key, 9, 4);
  uniform(key, 0, 0);
  EXPECT_EQ(uniform(randomKey(1).with(2u), 9, 4), later);
  EXPECT_NE(uniform(randomKey(2).with(2u), 9, 4), later);
}

}  // namespace
}  // namespace lightvane
