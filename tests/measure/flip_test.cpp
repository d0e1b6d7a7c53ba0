#include "core/measure/flip_map.h"
#include "tests/measure/metric_pictures.h"

// Values with nine digits are those of a program in double precision with whole two-dimensional kernels,
// written from the paper and the authors' Python program (flip_api.py, version 1.2) independently of ours.
// Float makes 1e-6 of a colour, of which roots of small differences make 1e-4.

namespace lightvane {
namespace {

double flipOf(const Rgb& a, const Rgb& b) {
  return valueOf("flip", ImageRgb(30, 25, a), ImageRgb(30, 25, b));
}

// Even pictures have no features: FLIP is the colour's error alone. By hand for black and white: HyAB is 100,
// to the power 0.7 25.1189; green and blue are 41.2760 apart; beyond 0.4 of that the error is 0.95 + 0.05
// (25.1189 - 16.5104) / (41.2760 - 16.5104).
TEST(Flip, OfEvenPicturesIsTheColoursError) {
  EXPECT_NEAR(flipOf(Rgb(0.0f), Rgb(1.0f)), 0.967379763, 1e-5);
  EXPECT_NEAR(flipOf(Rgb(0.0f, 1.0f, 0.0f), Rgb(0.0f, 0.0f, 1.0f)), 1.0, 1e-5);
  EXPECT_NEAR(flipOf(Rgb(1.0f, 0.0f, 0.0f), Rgb(0.0f, 1.0f, 0.0f)), 0.986662275, 1e-5);
  EXPECT_NEAR(flipOf(Rgb(0.5f), Rgb(0.25f)), 0.451849633, 1e-4);
}

TEST(Flip, IsSymmetric) {
  const ImageRgb a = patternPicture(false), b = patternPicture(true);
  EXPECT_EQ(flipMap(a, b), flipMap(b, a));
}

TEST(Flip, OfTurnedPicturesIsTurned) {
  const ImageRgb a = patternPicture(false), b = patternPicture(true);
  const auto transposed = [](const ImageRgb& image) {
    ImageRgb result(image.height(), image.width());
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) result.at(y, x) = image.at(x, y);
    }
    return result;
  };
  const ImageFloat map = flipMap(a, b), turned = flipMap(transposed(a), transposed(b));
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) ASSERT_NEAR(map.at(x, y), turned.at(y, x), 2e-4) << x << ", " << y;
  }
}

TEST(Flip, IsThatOfAnotherProgram) {
  const ImageFloat map = flipMap(patternPicture(false), patternPicture(true));
  EXPECT_NEAR(map.at(0, 0), 0.005023509, 1e-4);
  EXPECT_NEAR(map.at(12, 9), 0.426784913, 1e-4);
  EXPECT_NEAR(map.at(23, 17), 0.482866161, 1e-4);
  EXPECT_NEAR(map.at(5, 16), 0.350982811, 1e-4);
  EXPECT_NEAR(largestOf(map), 0.944045329, 1e-4);
  EXPECT_NEAR(valueOf("flip", patternPicture(false), patternPicture(true)), 0.234920865, 1e-5);
}

// Colours 2^-3 to 1.5 2^7 times those of the pattern: 6.26 stops, which are seven exposures.
TEST(HdrFlip, IsThatOfAnotherProgram) {
  ImageRgb a = patternPicture(false), b = patternPicture(true);
  for (int y = 0; y < 18; ++y) {
    for (int x = 0; x < 24; ++x) {
      const float factor =
          std::exp2(static_cast<float>((x * 5 + y * 3) % 11 - 3)) * (1.0f + static_cast<float>(x % 5) / 8.0f);
      a.at(x, y) *= factor;
      b.at(x, y) *= factor;
    }
  }
  const MetricResult result = measure("hdrflip", {.picture = a, .reference = b});
  EXPECT_NEAR(result.value, 0.230308237, 1e-5);
  EXPECT_NEAR(result.map.at(0, 0), 0.006402103, 1e-4);
  EXPECT_NEAR(result.map.at(12, 9), 0.355709512, 1e-4);
  EXPECT_NEAR(result.map.at(23, 17), 0.567595670, 1e-4);
}

// FLIP looks at what a screen shows, HDR-FLIP at what any exposure would.
TEST(HdrFlip, SeesWhatIsBeyondWhite) {
  const ImageRgb bright(20, 20, Rgb(5.0f)), brighter(20, 20, Rgb(10.0f));
  EXPECT_EQ(valueOf("flip", brighter, bright), 0.0);
  EXPECT_GT(valueOf("hdrflip", brighter, bright), 0.1);
}

// More than half black: the median of what is not.
TEST(HdrFlip, OfAMostlyBlackReferenceEnds) {
  ImageRgb reference(20, 20, Rgb(0.0f));
  for (int x = 0; x < 20; ++x) reference.at(x, 3) = Rgb(x < 10 ? 1.0f : 2.0f);
  const double value = valueOf("hdrflip", scaledPicture(reference, 2.0f), reference);
  EXPECT_GT(value, 0.0);
  EXPECT_LT(value, 1.0);
}

}  // namespace
}  // namespace lightvane
