// Adaptive antialiasing: all samples of a pixel only where neighbours differ.

#include <gtest/gtest.h>

#include "core/render/film_contrast.h"
#include "core/render/render_frame.h"
#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

TEST(PixelsThatDiffer, AreThoseOnBothSidesOfAnEdge) {
  TaskPool pool(2);
  Film film(6, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) film.direct.at(x, y) = Rgb(x < 3 ? 1.0f : 0.8f);
  }
  for (const double contrast : {0.19, 0.21}) {
    const Image<std::uint8_t> found = pixelsThatDiffer(film, contrast, pool);
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 6; ++x)
        EXPECT_EQ(found.at(x, y) != 0, contrast < 0.2 && (x == 2 || x == 3))
            << x << " " << y << " " << contrast;
    }
  }
}

TEST(PixelsThatDiffer, AreTheEightAroundAPixelOfAnotherColourInAnyLayer) {
  TaskPool pool(1);
  for (ImageRgb Film::*layer : {&Film::emission, &Film::direct, &Film::indirect, &Film::specular}) {
    Film film(5, 5);
    for (std::size_t i = 0; i < film.direct.size(); ++i) film.direct[i] = Rgb(0.5f, 0.1f, 0.0f);
    (film.*layer).at(1, 2) += Rgb(0.0f, 0.2f, 0.0f);  // 0.4 of the largest channel, three times the green
    const Image<std::uint8_t> found = pixelsThatDiffer(film, 0.3, pool);
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 5; ++x) EXPECT_EQ(found.at(x, y) != 0, x <= 2 && y >= 1 && y <= 3) << x << " " << y;
    }
  }
}

TEST(PixelsThatDiffer, AreNoneInTheDark) {
  TaskPool pool(1);
  const Image<std::uint8_t> found = pixelsThatDiffer(Film(3, 3), 0.01, pool);
  for (const std::uint8_t pixel : found) EXPECT_EQ(pixel, 0);
}

class Adaptive : public testing::Test {
 protected:
  Picture render(int samples, double contrast, std::string_view method = "vectors") const {
    return picture(stage_, parametersWith({{"preset", "balanced"},
                                           {"method.name", std::string(method)},
                                           {"film.samples", std::to_string(samples)},
                                           {"film.contrast", std::to_string(contrast)}}));
  }

  const int size_ = budget(160, 40);
  Stage stage_{shippedScene("cornell-mirror.toml", size_, size_)};
};

TEST_F(Adaptive, WithoutAnEdgeIsThePictureOfOneSample) {
  const Picture none = render(8, 1.0);
  EXPECT_EQ(difference(render(1, 0.0).film, none.film), "");
  EXPECT_EQ(none.statistics.refinedPixels, 0u);
}

TEST_F(Adaptive, WhereEveryPixelDiffersIsThePictureOfAllSamples) {
  if (!isFast()) GTEST_SKIP() << "its bounds need the whole size";
  const Picture every = render(8, 1e-6);
  const Picture all = render(8, 0.0);
  // The background's pixels have no neighbour that differs.
  EXPECT_GT(static_cast<int>(every.statistics.refinedPixels), size_ * size_ * 8 / 10);
  for (std::size_t i = 0; i < all.film.direct.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(every.film.albedo()[i][c], all.film.albedo()[i][c], 1e-5f) << i;
  }
  // Vectors lie elsewhere: some are computed for the first samples, and some for the others.
  EXPECT_NEAR(mean(beauty(every.film)), mean(beauty(all.film)), 0.01 * mean(beauty(all.film)));
  const double jagged = relativeMeanSquaredError(beauty(render(1, 0.0).film), beauty(all.film));
  EXPECT_LT(relativeMeanSquaredError(beauty(every.film), beauty(all.film)), 0.2 * jagged);
}

TEST_F(Adaptive, SmoothsEdgesForAPartOfTheSamples) {
  if (!isFast()) GTEST_SKIP() << "its bounds need the whole size";
  const ImageRgb all = beauty(render(16, 0.0).film);
  const Picture adaptive = render(16, 0.1);
  EXPECT_LT(static_cast<int>(adaptive.statistics.refinedPixels), size_ * size_ * 4 / 10);
  const double jagged = relativeMeanSquaredError(beauty(render(1, 0.0).film), all);
  EXPECT_LT(relativeMeanSquaredError(beauty(adaptive.film), all), 0.2 * jagged);
}

TEST_F(Adaptive, UsesTheVectorsThatThereAre) {
  if (!isFast()) GTEST_SKIP() << "its bounds need the whole size";
  const std::uint64_t one = render(1, 0.0).statistics.ilvRecords;
  const std::uint64_t all = render(16, 0.0).statistics.ilvRecords;
  const std::uint64_t adaptive = render(16, 0.1).statistics.ilvRecords;
  EXPECT_GE(adaptive, one);
  EXPECT_LT(adaptive - one, (all - one) / 3) << one << " of one sample, " << all << " of all";
}

// Frames outlive the renderer, and with it the points that were refined.
TEST(AdaptiveTextures, BelongToTheFrame) {
  const Stage stage(shippedScene("textures.toml", 192, 192));
  RenderFrame frame;
  {
    const RenderContext context =
        stage.context(parametersWith({{"preset", "draft"}, {"film.samples", "2"}, {"film.contrast", "0.9"}}));
    const std::unique_ptr<Renderer> renderer = makeRenderer(context);
    finish(*renderer);
    frame = makeFrame(context, *renderer);
  }
  int kept = 0, refined = 0;
  for (const VisibleTile& tile : frame.points->tiles) {
    bool isRefined = false;
    for (const VisiblePoint& point : tile.points) isRefined |= point.sample > 0;
    for (const VisiblePoint& point : tile.points) {
      if (point.ofTextures == nullptr) continue;
      ++(isRefined ? refined : kept);
      ASSERT_TRUE(tile.tints);
      ASSERT_TRUE(std::any_of(tile.tints->begin(), tile.tints->end(),
                              [&](const Tint& tint) { return &tint == point.ofTextures; }));
      ASSERT_TRUE(isFinite(point.tint().diffuse));
    }
  }
  EXPECT_GT(kept, 0);
  EXPECT_GT(refined, 0);
}

TEST_F(Adaptive, IsOfVectorsAlone) {
  EXPECT_EQ(difference(render(4, 0.1, "direct").film, render(4, 0.0, "direct").film), "");
}

}  // namespace
}  // namespace lightvane::render_test
