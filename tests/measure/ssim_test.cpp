#include "tests/measure/metric_pictures.h"

namespace lightvane {
namespace {

constexpr double kSsimC1 = 1e-4, kSsimC2 = 9e-4;

// Without variance only the comparison of means is left.
TEST(Ssim, OfConstantPicturesIsThatOfTheirMeans) {
  const ImageRgb a(30, 20, Rgb(decodeSrgb(0.5f))), b(30, 20, Rgb(decodeSrgb(0.75f)));
  EXPECT_NEAR(valueOf("ssim", a, b), (2.0 * 0.5 * 0.75 + kSsimC1) / (0.25 + 0.5625 + kSsimC1), 1e-6);
}

// A chessboard of 0.5 +- 0.25 against the inverted one: the means are equal but for what the window's weights
// leave, the covariance is the negative variance.
TEST(Ssim, OfInvertedPicturesIsNegative) {
  ImageRgb a(30, 30), b(30, 30);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 30; ++x) {
      a.at(x, y) = Rgb(decodeSrgb((x + y) % 2 == 0 ? 0.75f : 0.25f));
      b.at(x, y) = Rgb(decodeSrgb((x + y) % 2 == 0 ? 0.25f : 0.75f));
    }
  }
  const double variance = 0.0625;
  EXPECT_NEAR(valueOf("ssim", a, b), (kSsimC2 - 2.0 * variance) / (kSsimC2 + 2.0 * variance), 1e-4);
}

// 0.432136365: in double, with whole windows and variances about their means, by a program that was written
// from the paper; and by originalSsim of the npm package ssim.js 3.5.0, a port of the authors' ssim.m, for
// the same luma. Both agree to 1e-9; ours reads luma as floats.
TEST(Ssim, IsThatOfOtherPrograms) {
  EXPECT_NEAR(valueOf("ssim", patternPicture(false), patternPicture(true)), 0.432136365, 1e-6);
}

TEST(Ssim, IsTheMeanOverWholeWindows) {
  const ImageRgb reference = randomPicture(40, 40, 1);
  ImageRgb picture = reference;
  for (int y = 0; y < 40; ++y) picture.at(0, y) = Rgb(1.0f);
  const double one = valueOf("ssim", picture, reference);
  // Windows of pixels 5 and beyond reach pixel 0; those of the outermost five are not whole.
  ImageFloat mask(40, 40, 1.0f);
  for (int y = 0; y < 40; ++y) mask.at(5, y) = 0.0f;
  EXPECT_LT(one, 1.0);
  EXPECT_EQ(measure("ssim", {.picture = picture, .reference = reference, .mask = &mask}).value, 1.0);
}

// Windows of which one pixel is masked are what is left of them: constants stay constants.
TEST(Ssim, OfWindowsWithHolesIsThatOfTheRest) {
  ImageRgb a(30, 20, Rgb(decodeSrgb(0.5f))), b(30, 20, Rgb(decodeSrgb(0.75f)));
  ImageFloat mask(30, 20, 1.0f);
  a.at(15, 10) = Rgb(0.0f);
  mask.at(15, 10) = 0.0f;
  EXPECT_NEAR(measure("ssim", {.picture = a, .reference = b, .mask = &mask}).value,
              (2.0 * 0.5 * 0.75 + kSsimC1) / (0.25 + 0.5625 + kSsimC1), 1e-6);
}

}  // namespace
}  // namespace lightvane
