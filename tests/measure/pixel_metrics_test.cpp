// Metrics that are means over pixels, on pictures whose value is known by closed form.

#include <numbers>

#include "tests/measure/metric_pictures.h"

namespace lightvane {
namespace {

ImageRgb constant(const Rgb& colour) { return {32, 24, colour}; }

TEST(Bias, IsSignedAndInPartsOfTheMean) {
  EXPECT_NEAR(valueOf("bias", constant(Rgb(1.03f)), constant(Rgb(1.0f))), 0.03, 1e-6);
  EXPECT_NEAR(valueOf("bias", constant(Rgb(0.3f, 0.2f, 0.1f)), constant(Rgb(0.4f))), -0.5, 1e-6);
}

TEST(Bias, OfErrorsThatCancelIsZero) {
  ImageRgb picture = constant(Rgb(1.0f));
  for (std::size_t i = 0; i < picture.size(); ++i) picture[i] = Rgb(i % 2 == 0 ? 1.25f : 0.75f);
  const MetricResult result = measure("bias", {.picture = picture, .reference = constant(Rgb(1.0f))});
  EXPECT_EQ(result.value, 0.0);
  EXPECT_EQ(result.map[0], 0.25f);
  // Pixels of +-0.25, 768 of them.
  EXPECT_NEAR(*result.standardError, 0.25 / std::sqrt(768.0), 1e-9);
}

// What is a constant factor has no scatter of its own.
TEST(Bias, OfAFactorIsSure) {
  const ImageRgb reference = randomPicture(64, 48, 1);
  const MetricResult result =
      measure("bias", {.picture = scaledPicture(reference, 1.5f), .reference = reference});
  EXPECT_NEAR(result.value, 0.5, 1e-6);
  EXPECT_LT(*result.standardError, 1e-8);
}

TEST(Mrae, IsRelativeToTheSurroundings) {
  EXPECT_NEAR(valueOf("mrae", constant(Rgb(1.02f)), constant(Rgb(1.0f))), 0.02, 1e-6);
  EXPECT_NEAR(valueOf("mrae", constant(Rgb(0.9f, 1.2f, 1.0f)), constant(Rgb(1.0f))), 0.1, 1e-6);
}

// In the dark half a difference is relative to 1 % of the mean of all, 0.5.
TEST(Mrae, OfDarkPixelsIsRelativeToAPartOfTheMean) {
  ImageRgb reference(64, 8, Rgb(1.0f));
  for (int y = 0; y < 8; ++y) {
    for (int x = 32; x < 64; ++x) reference.at(x, y) = Rgb(0.0f);
  }
  ImageRgb picture = reference;
  picture.at(60, 4) = Rgb(0.0025f);
  EXPECT_NEAR(valueOf("mrae", picture, reference), 0.5 / 512.0, 1e-9);
}

// The surroundings are those that count: a masked light does not make the wall beside it bright.
TEST(Mrae, OfPixelsBesideAMaskedLightIsRelativeToTheRest) {
  ImageRgb reference = constant(Rgb(1.0f));
  ImageFloat mask(32, 24, 1.0f);
  reference.at(10, 10) = Rgb(1000.0f);
  mask.at(10, 10) = 0.0f;
  const ImageRgb picture = constant(Rgb(1.5f));
  EXPECT_NEAR(measure("mrae", {.picture = picture, .reference = reference, .mask = &mask}).value, 0.5, 1e-6);
  EXPECT_NEAR(measure("relative", {.picture = picture, .reference = reference, .mask = &mask}).value, 0.5,
              1e-4);
}

TEST(Rmse, IsInThePicturesUnit) {
  const MetricResult result =
      measure("rmse", {.picture = constant(Rgb(3.0f, 7.0f, 5.0f)), .reference = constant(Rgb(5.0f))});
  EXPECT_NEAR(result.value, std::sqrt(8.0 / 3.0), 1e-6);
  EXPECT_NEAR(static_cast<double>(result.map[7]), std::sqrt(8.0 / 3.0), 1e-6);
  EXPECT_NEAR(valueOf("rmse", constant(Rgb(3e10f)), constant(Rgb(5e10f))), 2e10, 1e4);
}

// Of noise of 0.1 in the reference 0.03 is found again, to four standard errors of 120 000 pixels; without
// its variance both are in the value.
TEST(Rmse, IsWithoutTheReferencesNoise) {
  ImageRgb reference(400, 300, Rgb(1.0f));
  addNoise(reference, 0.1f, 5);
  const ImageRgb picture(400, 300, Rgb(1.03f));
  const ImageRgb variance(400, 300, Rgb(0.01f));
  const MetricResult result =
      measure("rmse", {.picture = picture, .reference = reference, .variance = &variance});
  EXPECT_NEAR(result.value, 0.03, 4.0 * *result.standardError);
  EXPECT_LT(*result.standardError, 0.001);
  EXPECT_NEAR(*result.ofReference, 0.1, 1e-6);
  EXPECT_NEAR(valueOf("rmse", picture, reference), std::hypot(0.1, 0.03), 0.001);
}

// Of 200 pictures with noise of known deviation the values scatter as their standard errors say: to 20 %,
// four times what the deviation of 200 numbers is known to (1 / sqrt(2 * 200)).
TEST(StandardError, IsHowMuchValuesScatter) {
  const ImageRgb reference(64, 64, Rgb(1.0f));
  for (const std::string name : {"bias", "mrae", "rmse", "relmse", "relative", "psnr"}) {
    double sum = 0.0, sumOfSquares = 0.0, stated = 0.0;
    constexpr int kPictures = 200;
    for (int k = 0; k < kPictures; ++k) {
      ImageRgb picture(64, 64, Rgb(0.8f));
      addNoise(picture, 0.1f, 100 + static_cast<std::uint64_t>(k));
      // Darker than the reference, so that display values are not clipped.
      const MetricResult result = measure(name, {.picture = picture, .reference = reference});
      sum += result.value;
      sumOfSquares += result.value * result.value;
      stated += *result.standardError / kPictures;
    }
    const double mean = sum / kPictures;
    const double deviation = std::sqrt(sumOfSquares / kPictures - mean * mean);
    // The larger of two estimates is larger than each by a few percent.
    EXPECT_NEAR(stated, deviation, 0.25 * deviation) << name;
  }
}

// Errors that 8x8 pixels share are 64 times fewer.
TEST(StandardError, KnowsThatNeighboursAreAlike) {
  const ImageRgb reference(256, 256, Rgb(1.0f));
  ImageRgb picture = reference;
  const RandomKey key = randomKey(9);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const auto patch = static_cast<std::uint32_t>((y / 8) * 32 + x / 8);
      picture.at(x, y) *= 0.9f + 0.2f * uniform(key, patch, 0);
    }
  }
  const double perPatch = 0.2 / std::sqrt(12.0) / 32.0;
  EXPECT_NEAR(*measure("bias", {.picture = picture, .reference = reference}).standardError, perPatch,
              0.15 * perPatch);
}

TEST(RelMse, IsRelativeToTheSquare) {
  // The mean is 2: epsilon is 0.04.
  EXPECT_NEAR(valueOf("relmse", constant(Rgb(2.5f)), constant(Rgb(2.0f))), 0.25 / 4.04, 1e-9);
  // Of each colour by itself: 0, 1 and 5 have the mean 2.
  EXPECT_NEAR(valueOf("relmse", constant(Rgb(0.1f, 1.0f, 5.0f)), constant(Rgb(0.0f, 1.0f, 5.0f))),
              0.01 / 0.04 / 3.0, 1e-7);
}

// To four standard errors of 120 000 pixels and the noise's fourth order: with moments of s^2 and 9/5 s^4 it
// leaves (9/5 / 24 - 1/4) f''''(1) s^4 = -14.3 s^4 of f(b) = (1.05 - b)^2 / b^2.
TEST(RelMse, IsWithoutTheReferencesNoise) {
  for (const float noise : {0.03f, 0.06f}) {
    ImageRgb reference(400, 300, Rgb(1.0f));
    addNoise(reference, noise, 6);
    const ImageRgb picture(400, 300, Rgb(1.05f));
    const ImageRgb variance(400, 300, Rgb(noise * noise));
    const MetricResult result =
        measure("relmse", {.picture = picture, .reference = reference, .variance = &variance});
    const double fourthOrder = 16.0 * std::pow(static_cast<double>(noise), 4.0);
    EXPECT_NEAR(result.value, 0.0025 / 1.01, 4.0 * *result.standardError + fourthOrder) << noise;
    EXPECT_LT(*result.standardError, 3e-5);
    EXPECT_GT(valueOf("relmse", picture, reference), result.value + 0.9 * noise * noise);
  }
}

TEST(Psnr, OfAKnownDifference) {
  // Display values of 0.5 and 0.6: by sRGB's inverse.
  const Rgb half(decodeSrgb(0.5f)), more(decodeSrgb(0.6f));
  EXPECT_NEAR(valueOf("psnr", constant(more), constant(half)), 20.0, 1e-4);
  EXPECT_NEAR(valueOf("psnr", constant(Rgb(1.0f)), constant(Rgb(0.0f))), 0.0, 1e-6);
  // Half the pixels: 3 dB.
  ImageRgb picture = constant(half);
  for (std::size_t i = 0; i < picture.size(); i += 2) picture[i] = more;
  const MetricResult result = measure("psnr", {.picture = picture, .reference = constant(half)});
  EXPECT_NEAR(result.value, 20.0 + 10.0 * std::log10(2.0), 1e-4);
  // Mean square 0.005 +- 0.005 / sqrt(768).
  EXPECT_NEAR(*result.standardError, 10.0 / std::numbers::ln10 / std::sqrt(768.0), 1e-4);
}

TEST(Psnr, SeesNothingBeyondWhite) {
  EXPECT_EQ(valueOf("psnr", constant(Rgb(7.0f)), constant(Rgb(1.0f))),
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(valueOf("psnr", constant(Rgb(-7.0f)), constant(Rgb(0.0f))),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace lightvane
