#include "core/base/trigonometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"

// Against the library's functions in long double, whose own error is 2^-11 of a double's last digit.

namespace lightvane {
namespace {

constexpr double kLastDigit = 0x1p-52;

TEST(Trigonometry, AngleOfAVectorIsItsAngle) {
  const RandomKey key = randomKey(311);
  double worst = 0.0;
  for (std::uint32_t i = 0; i < 1'000'000; ++i) {
    // Of all directions, near the axes and diagonals, too, and of all lengths.
    const double size = std::ldexp(1.0, static_cast<int>(40.0f * uniform(key, i, 0)) - 20);
    const double ratio = std::pow(10.0, -8.0 * double(uniform(key, i, 1))) *
                         (1.0 + 1e-9 * double(uniform(key, i, 2)) * (i % 3 == 0 ? 1.0 : 1e6));
    const bool isSwapped = (i & 1U) != 0;
    const double x = ((i & 2U) != 0 ? -1.0 : 1.0) * size * (isSwapped ? ratio : 1.0);
    const double y = ((i & 4U) != 0 ? -1.0 : 1.0) * size * (isSwapped ? 1.0 : ratio);
    const auto exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    const auto error =
        static_cast<double>(std::abs((static_cast<long double>(angleOf(y, x)) - exact) / exact));
    worst = std::max(worst, error);
  }
  EXPECT_LT(worst, 2.0 * kLastDigit);
}

TEST(Trigonometry, AngleOfAVectorAlongAnAxis) {
  EXPECT_EQ(angleOf(0.0, 0.0), 0.0);
  EXPECT_EQ(angleOf(0.0, 2.0), 0.0);
  EXPECT_EQ(angleOf(3.0, 0.0), kPiD / 2.0);
  EXPECT_EQ(angleOf(-3.0, 0.0), -kPiD / 2.0);
  EXPECT_EQ(angleOf(0.0, -2.0), kPiD);
  EXPECT_EQ(angleOf(-0.0, -2.0), -kPiD);
  EXPECT_EQ(angleOf(2.0, 2.0), kPiD / 4.0);
}

TEST(Trigonometry, SineAndCosine) {
  const RandomKey key = randomKey(312);
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const double angle = kPiD * (double(uniform(key, i, 0)) - 0.5);
    double sine = 0.0, cosine = 0.0;
    sinCosUpToRightAngle(angle, sine, cosine);
    EXPECT_NEAR(sine, std::sin(angle), kLastDigit);
    EXPECT_NEAR(cosine, std::cos(angle), kLastDigit);
  }
}

}  // namespace
}  // namespace lightvane
