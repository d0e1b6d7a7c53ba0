#include "tests/measure/metric_pictures.h"

namespace lightvane {
namespace {

MetricResult worstTile(const ImageRgb& picture, const ImageRgb& reference) {
  return measure("worst-tile", {.picture = picture, .reference = reference});
}

// The floor of the dark is added: 1 % of the mean, squared.
TEST(WorstTile, OfAnEvenErrorIsThatError) {
  const MetricResult result = worstTile(ImageRgb(70, 50, Rgb(1.1f)), ImageRgb(70, 50, Rgb(1.0f)));
  EXPECT_NEAR(result.value, 0.1, 1e-5);
  EXPECT_NEAR(*result.standardError, 0.0, 1e-6);
}

// A splotch of one tile in 256 tiles' worth of pixels: all of it in the worst tile, little in the mean.
TEST(WorstTile, FindsASplotch) {
  const ImageRgb reference(256, 256, Rgb(1.0f));
  ImageRgb picture = reference;
  for (int y = 96; y < 112; ++y) {
    for (int x = 40; x < 56; ++x) picture.at(x, y) = Rgb(0.8f);
  }
  const MetricResult result = worstTile(picture, reference);
  EXPECT_NEAR(result.value, 0.2, 1e-4);
  ASSERT_TRUE(result.area);
  EXPECT_EQ(result.area->x, 40);
  EXPECT_EQ(result.area->y, 96);
  EXPECT_EQ(result.area->width, 16);
  EXPECT_EQ(result.area->height, 16);
  EXPECT_NEAR(result.map.at(47, 103), 0.2, 1e-4);
  EXPECT_EQ(result.map.at(200, 103), 0.0f);
  EXPECT_NEAR(valueOf("relative", picture, reference), 0.2 / 16.0, 1e-4);
}

TEST(WorstTile, FindsASplotchInTheLastCorner) {
  const ImageRgb reference(61, 43, Rgb(1.0f));
  ImageRgb picture = reference;
  for (int y = 28; y < 43; ++y) {
    for (int x = 48; x < 61; ++x) picture.at(x, y) = Rgb(1.5f);
  }
  const MetricResult result = worstTile(picture, reference);
  EXPECT_NEAR(result.value, 0.5, 1e-4);
  ASSERT_TRUE(result.area);
  EXPECT_EQ(result.area->x + result.area->width, 61);
  EXPECT_EQ(result.area->y + result.area->height, 43);
}

// The mean of all is 0.5.
TEST(WorstTile, InTheDarkIsRelativeToAPartOfTheMean) {
  ImageRgb reference(64, 32, Rgb(1.0f));
  ImageRgb picture = reference;
  for (int y = 0; y < 32; ++y) {
    for (int x = 32; x < 64; ++x) {
      reference.at(x, y) = Rgb(0.0f);
      picture.at(x, y) = Rgb(0.001f);
    }
  }
  EXPECT_NEAR(worstTile(picture, reference).value, 0.2, 1e-5);
}

// However wrong it is, and among noise.
TEST(WorstTile, IsNotASinglePixel) {
  const ImageRgb reference(64, 64, Rgb(1.0f));
  ImageRgb picture = reference;
  picture.at(30, 30) = Rgb(1e6f);
  EXPECT_EQ(worstTile(picture, reference).value, 0.0);
  picture = reference;
  addNoise(picture, 0.1f, 1);
  const double before = worstTile(picture, reference).value;
  picture.at(30, 30) = Rgb(1e6f);
  EXPECT_NEAR(worstTile(picture, reference).value, before, 0.01);
}

// Of each block that the line crosses 4 of 16 pixels are wrong, which are 12 of 240 pairs; of the tile's
// blocks 3, without the worst, of 15.
TEST(WorstTile, OfAThinLeakIsSeen) {
  const ImageRgb reference(64, 64, Rgb(1.0f));
  ImageRgb picture = reference;
  for (int x = 0; x < 64; ++x) picture.at(x, 33) = Rgb(2.0f);
  EXPECT_NEAR(worstTile(picture, reference).value, std::sqrt(12.0 / 240.0 * 3.0 / 15.0), 1e-4);
}

// Noise of both pictures, 20 % a pixel, without any variance given: differences of variance 0.08. A block's
// squared error then scatters by sqrt(2 / 240) 0.08 = 0.0073 a colour, the mean of 15 blocks and 3 colours by
// 0.0011. The largest of 1000 tiles lies within five of these: a root of 0.074. A splotch of 15 % stands out
// from it, within four standard errors.
TEST(WorstTile, IsNotNoise) {
  ImageRgb reference(256, 256, Rgb(1.0f)), picture(256, 256, Rgb(1.0f));
  addNoise(reference, 0.2f, 1);
  addNoise(picture, 0.2f, 2);
  EXPECT_NEAR(valueOf("relative", picture, reference), 0.2 * std::sqrt(2.0), 0.02);
  EXPECT_LT(worstTile(picture, reference).value, 0.074);
  for (int y = 96; y < 112; ++y) {
    for (int x = 40; x < 56; ++x) picture.at(x, y) += Rgb(0.15f);
  }
  const MetricResult result = worstTile(picture, reference);
  EXPECT_NEAR(result.value, 0.15, 4.0 * *result.standardError);
  EXPECT_LT(*result.standardError, 0.015);
  ASSERT_TRUE(result.area);
  EXPECT_NEAR(result.area->x, 40, 8);
  EXPECT_NEAR(result.area->y, 96, 8);
}

TEST(WorstTile, StatesWhatTheNoiseOfTheReferenceMakes) {
  const ImageRgb truth(256, 256, Rgb(1.0f));
  ImageRgb reference = truth;
  addNoise(reference, 0.2f, 1);
  const ImageRgb variance(256, 256, Rgb(0.04f));
  const MetricResult result =
      measure("worst-tile", {.picture = truth, .reference = reference, .variance = &variance});
  ASSERT_TRUE(result.ofReference);
  EXPECT_NEAR(result.value, *result.ofReference, 0.02);
}

// A tile of which less than a quarter counts is none.
TEST(WorstTile, NeedsPixelsThatCount) {
  const ImageRgb reference(16, 16, Rgb(1.0f)), picture(16, 16, Rgb(1.1f));
  ImageFloat mask(16, 16, 0.0f);
  for (int x = 0; x < 16; ++x) mask.at(x, 5) = 1.0f;
  EXPECT_TRUE(
      std::isnan(measure("worst-tile", {.picture = picture, .reference = reference, .mask = &mask}).value));
  for (int y = 4; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) mask.at(x, y) = 1.0f;
  }
  EXPECT_NEAR(measure("worst-tile", {.picture = picture, .reference = reference, .mask = &mask}).value, 0.1,
              1e-4);
}

}  // namespace
}  // namespace lightvane
