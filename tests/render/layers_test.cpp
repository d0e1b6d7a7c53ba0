// Every path from a light to the camera belongs to one layer, and the layers of a file add up to its picture.

#include <filesystem>

#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "tests/pictures/pictures.h"
#include "tests/support/temporary_folder.h"

namespace lightvane::render_test {
namespace {

class Layers : public testing::TestWithParam<const char*> {};

TEST_P(Layers, OfAFileAddUpToItsPictureToTheBit) {
  const Stage stage(shippedScene("cornell-mirror.toml", 40, 40));
  const Picture p = picture(stage, parametersWith({{"method.name", GetParam()},
                                                   {"path.samples", "8"},
                                                   {"naive.samples", "16"},
                                                   {"light.samples", "4"}}));
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "layers.exr";
  const Expected<void> written = writeImage(path, p.film.toLayers(*stage.scene));
  ASSERT_TRUE(written) << written.error().message();
  const Expected<LayeredImage> image = readImage(path);
  ASSERT_TRUE(image) << image.error().message();
  const ImageRgb whole = image->rgb();
  const ImageRgb emission = image->rgb("emission");
  const ImageRgb direct = image->rgb("direct");
  const ImageRgb indirect = image->rgb("indirect");
  const ImageRgb specular = image->rgb("specular");
  for (const ImageRgb* layer : {&whole, &emission, &direct, &specular}) EXPECT_GT(mean(*layer), 0.0);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(whole[i][c], ((emission[i][c] + direct[i][c]) + indirect[i][c]) + specular[i][c])
          << "pixel " << i << ", colour " << c;
    }
  }
}

// What the film itself calls its beauty is the file's picture, but for the unit of radiance.
TEST_P(Layers, AreWhatTheFilmAddsUp) {
  const Stage stage(shippedScene("cornell-mirror.toml", 16, 16));
  const Film film = picture(stage, parametersWith({{"method.name", GetParam()}, {"path.samples", "4"}})).film;
  const ImageRgb whole = film.toLayers(*stage.scene).rgb();
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_EQ(whole[i], film.beauty(i) * stage.scene->normalisation.radianceScale()) << "pixel " << i;
  }
}

// A light seen straight is emission and nothing else; a wall is never emission; what a mirror shows is
// specular, whatever it is.
TEST_P(Layers, HoldWhatBelongsToThem) {
  const Stage stage(shippedScene("cornell-mirror.toml", 64, 64));
  const Film film =
      picture(stage,
              parametersWith({{"method.name", GetParam()}, {"path.samples", "4"}, {"naive.samples", "16"}}))
          .film;
  int lights = 0, walls = 0, mirrors = 0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    if (!(film.depth()[i] < kInfinity)) continue;
    const bool isLight = isBlack(film.albedo()[i]);
    const bool isMirror = film.albedo()[i] == Rgb(1.0f);
    if (isLight) {
      ++lights;
      EXPECT_FALSE(isBlack(film.emission[i]));
      EXPECT_TRUE(isBlack(film.direct[i]) && isBlack(film.indirect[i]) && isBlack(film.specular[i]));
    } else if (isMirror) {
      ++mirrors;
      EXPECT_TRUE(isBlack(film.emission[i]) && isBlack(film.direct[i]) && isBlack(film.indirect[i]));
    } else {
      ++walls;
      EXPECT_TRUE(isBlack(film.emission[i]) && isBlack(film.specular[i]));
    }
  }
  EXPECT_GT(lights, 0);
  EXPECT_GT(mirrors, 100);
  EXPECT_GT(walls, 1000);
}

INSTANTIATE_TEST_SUITE_P(Methods, Layers, testing::Values("vectors", "path", "naive", "direct"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

}  // namespace
}  // namespace lightvane::render_test
