#include "core/measure/picture_error.h"

#include <limits>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lightvane {
namespace {

ImageRgb evenly(const Rgb& colour) { return {32, 24, colour}; }

TEST(PictureErrorOf, EqualPicturesIsZero) {
  const PictureError error = pictureError(evenly(Rgb(0.3f)), evenly(Rgb(0.3f)), {});
  EXPECT_EQ(error.relative, 0.0);
  EXPECT_EQ(error.standardError, 0.0);
}

TEST(PictureErrorOf, OnePartIsThatPart) {
  EXPECT_NEAR(pictureError(evenly(Rgb(1.02f)), evenly(Rgb(1.0f)), {}).relative, 0.02, 1e-5);
  EXPECT_NEAR(pictureError(evenly(Rgb(0.98f)), evenly(Rgb(1.0f)), {}).relative, 0.02, 1e-5);
}

TEST(PictureErrorOf, TheSameInAnotherUnitIsTheSame) {
  const PictureError one = pictureError(evenly(Rgb(1.1f, 0.9f, 1.0f)), evenly(Rgb(1.0f)), {});
  const PictureError other = pictureError(evenly(Rgb(110.0f, 90.0f, 100.0f)), evenly(Rgb(100.0f)), {});
  EXPECT_NEAR(one.relative, other.relative, 1e-6);
  EXPECT_NEAR(one.relative, std::sqrt(2.0 / 3.0) * 0.1, 1e-5);
}

TEST(PictureErrorOf, HalfThePixelsIsTheRootOfHalf) {
  ImageRgb picture = evenly(Rgb(1.0f));
  for (std::size_t i = 0; i < picture.size(); i += 2) picture[i] = Rgb(1.1f);
  const PictureError error = pictureError(picture, evenly(Rgb(1.0f)), {});
  EXPECT_NEAR(error.relative, 0.1 * std::sqrt(0.5), 1e-5);
  // Of 0 and 0.01, n of them, the mean is known to 0.005 / sqrt(n), and its root to that over twice the root.
  EXPECT_NEAR(error.standardError, 0.005 / std::sqrt(32.0 * 24.0) / (2.0 * error.relative), 1e-5);
}

// In the dark a difference is relative to 1 % of the mean, not to nothing.
TEST(PictureErrorOf, DarkPixelsIsFinite) {
  ImageRgb reference(64, 8, Rgb(1.0f));
  for (int y = 0; y < 8; ++y) {
    for (int x = 32; x < 64; ++x) reference.at(x, y) = Rgb(0.0f);
  }
  ImageRgb picture = reference;
  picture.at(60, 4) = Rgb(0.005f);  // the mean of all is 0.5
  EXPECT_NEAR(pictureError(picture, reference, {}).relative, std::sqrt(1.0 / 512.0), 1e-5);
  picture.at(60, 4) = Rgb(0.001f);
  EXPECT_NEAR(pictureError(picture, reference, {}).relative, 0.2 * std::sqrt(1.0 / 512.0), 1e-5);
}

TEST(PictureErrorOf, BlackOfBlackIsZero) {
  EXPECT_EQ(pictureError(evenly(Rgb(0.0f)), evenly(Rgb(0.0f)), {}).relative, 0.0);
}

TEST(PictureErrorOf, WhatIsNotFiniteIsLeftOut) {
  ImageRgb picture = evenly(Rgb(1.02f));
  picture[5].g = std::numeric_limits<float>::quiet_NaN();
  ImageRgb reference = evenly(Rgb(1.0f));
  reference[700].r = std::numeric_limits<float>::infinity();
  EXPECT_NEAR(pictureError(picture, reference, {}).relative, 0.02, 1e-5);
  EXPECT_EQ(pictureError(evenly(Rgb(std::numeric_limits<float>::quiet_NaN())), reference, {}).relative, 0.0);
}

// A picture that is wrong by 3 % is so by 3 % against a reference with 10 % of noise, within what is said of
// how sure that is.
TEST(PictureErrorOf, TheReferencesNoiseIsTakenOff) {
  constexpr float kNoise = 0.1f;
  ImageRgb reference(400, 300, Rgb(1.0f));
  const RandomKey key = randomKey(3);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float even =
          2.0f * uniform(key, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(c)) - 1.0f;
      reference[i][c] += kNoise * std::sqrt(3.0f) * even;
    }
  }
  const ImageRgb variance(400, 300, Rgb(kNoise * kNoise));
  const PictureError error = pictureError(ImageRgb(400, 300, Rgb(1.03f)), reference, variance);
  EXPECT_NEAR(error.relative, 0.03, 4.0 * error.standardError);
  EXPECT_LT(error.standardError, 0.001);
  EXPECT_NEAR(pictureError(ImageRgb(400, 300, Rgb(1.03f)), reference, {}).relative, 0.1044, 0.002);
  const PictureError none = pictureError(ImageRgb(400, 300, Rgb(1.0f)), reference, variance);
  // Its square is known to 1.5e-5: four times that.
  EXPECT_LT(none.relative, 0.0078);
}

}  // namespace
}  // namespace lightvane
