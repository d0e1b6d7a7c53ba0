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

// Two pixels beside each other do not make a tile, four blocks do.
TEST(WorstTile, OfAThinLeakIsSeen) {
  const ImageRgb reference(64, 64, Rgb(1.0f));
  ImageRgb picture = reference;
  for (int x = 0; x < 64; ++x) picture.at(x, 33) = Rgb(2.0f);
  // In each block 4 of 16 pixels: 12 of 240 pairs; in a tile 3 of 15 blocks.
  EXPECT_NEAR(worstTile(picture, reference).value,
              std::sqrt(12.0 / 240.0 * 3.0 / 15.0) / (1.0 + 4.0 / 64.0 * 0.0), 0.002);
}

// Noise of both pictures, 20 % a pixel, without any variance given. A block's squared error then scatters by
// 2 * 0.04^2 / 240 a colour, the mean of 15 blocks and 3 colours by its root over sqrt(45): 0.0005. The
// largest of 1000 tiles lies within five of these: 0.05, of 0.28 that the noise is. A splotch of 10 % is
// found among it.
TEST(WorstTile, IsNotNoise) {
  ImageRgb reference(256, 256, Rgb(1.0f)), picture(256, 256, Rgb(1.0f));
  addNoise(reference, 0.2f, 1);
  addNoise(picture, 0.2f, 2);
  EXPECT_NEAR(valueOf("relative", picture, reference), 0.2 * std::sqrt(2.0), 0.02);
  EXPECT_LT(worstTile(picture, reference).value, 0.09);
  for (int y = 96; y < 112; ++y) {
    for (int x = 40; x < 56; ++x) picture.at(x, y) += Rgb(0.15f);
  }
  const MetricResult result = worstTile(picture, reference);
  EXPECT_NEAR(result.value, 0.15, 0.04);
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
