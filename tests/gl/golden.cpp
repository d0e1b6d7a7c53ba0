#include "tests/gl/golden.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string_view>

#include <gtest/gtest.h>

#include "core/image/image_file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// What drew the pictures: Debian 12's, on a processor with AVX2.
bool isPinned(const Gl& gl) {
  const auto text = [&gl](GLenum name) {
    return std::string_view(reinterpret_cast<const char*>(gl.GetString(name)));
  };
  return text(GL_VERSION).ends_with("Mesa 22.3.6") && text(GL_RENDERER) == "llvmpipe (LLVM 15.0.6, 256 bits)";
}

/// Bytes in PNG are sRGB, and core/image speaks of linear light: there and back they are the same.
void write(const fs::path& path, const Image<Color8>& image) {
  ImageRgb linear(image.width(), image.height());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto decode = [](std::uint8_t byte) { return decodeSrgb(static_cast<float>(byte) / 255.0f); };
    linear[i] = {decode(image[i].r), decode(image[i].g), decode(image[i].b)};
  }
  LayeredImage file{image.width(), image.height(), {}, {}, {}};
  file.setRgb("", linear);
  const Expected<void> written = writeImage(path, file);
  EXPECT_TRUE(written) << written.error().message();
}

Image<Color8> read(const LayeredImage& file) {
  const ImageRgb linear = file.rgb();
  Image<Color8> image(file.width, file.height);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto encode = [](float value) {
      return static_cast<std::uint8_t>(std::lround(255.0f * encodeSrgb(value)));
    };
    image[i] = {encode(linear[i].r), encode(linear[i].g), encode(linear[i].b), 255};
  }
  return image;
}

int largestDifference(const Color8& a, const Color8& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Pixels of another colour than the most common one, which is that of nothing where little is drawn.
std::size_t drawnPixels(const Image<Color8>& image) {
  std::map<std::array<std::uint8_t, 3>, std::size_t> counts;
  std::size_t most = 0;
  for (const Color8& pixel : image) most = std::max(most, ++counts[{pixel.r, pixel.g, pixel.b}]);
  return image.size() - most;
}

// Another rasteriser, or the last bit of a rendering, may round an edge's coverage or a power the other way:
// some pixels, by little.
constexpr int kRoundedBytes = 12;

std::size_t differingPixels(const Image<Color8>& a, const Image<Color8>& b, int byteTolerance) {
  std::size_t differing = 0;
  for (std::size_t i = 0; i < a.size(); ++i) differing += largestDifference(a[i], b[i]) > byteTolerance;
  return differing;
}

/// How many pixels may differ from `golden`: of a picture, 1 % of what is drawn. Of an overlay over the
/// picture `bare`, 2 % of what it adds: 1 % of a picture that fills the frame would be two thirds of what a
/// few selected vectors add, and any of them could be missing. Another rasteriser (GALLIUM_DRIVER=softpipe)
/// was measured to differ in 0.2 % at most.
std::size_t pixelTolerance(const Image<Color8>& golden, const Image<Color8>* bare) {
  if (bare == nullptr) return drawnPixels(golden) / 100;
  return differingPixels(golden, *bare, kRoundedBytes) / 50;
}

void expectEqual(const Gl& gl, const Image<Color8>& actual, const Image<Color8>* bare,
                 const std::string& name, GoldenOf content) {
  for (const Color8& pixel : actual) ASSERT_EQ(pixel.a, 255) << "a window's picture is opaque";
  const fs::path golden = fs::path(LIGHTVANE_SOURCE_DIR) / "tests/gl/golden" / (name + ".png");
  if (std::getenv("LIGHTVANE_WRITE_GOLDEN") != nullptr) return write(golden, actual);

  const Expected<LayeredImage> file = readImage(golden);
  ASSERT_TRUE(file) << file.error().message();
  const Image<Color8> expected = read(*file);
  ASSERT_EQ(actual.width(), expected.width());
  ASSERT_EQ(actual.height(), expected.height());
  ASSERT_TRUE(bare == nullptr || bare->size() == expected.size());

  const bool pinned = isPinned(gl) && content == GoldenOf::Values;
  const int byteTolerance = pinned ? 0 : kRoundedBytes;
  const std::size_t allowed = pinned ? 0 : pixelTolerance(expected, bare);
  const std::size_t differing = differingPixels(actual, expected, byteTolerance);
  if (differing <= allowed) return;
  Image<Color8> difference(actual.width(), actual.height());
  for (std::size_t i = 0; i < actual.size(); ++i) {
    const auto shown =
        static_cast<std::uint8_t>(std::min(16 * largestDifference(actual[i], expected[i]), 255));
    difference[i] = {shown, shown, shown, 255};
  }
  const fs::path folder = LIGHTVANE_BUILD_FOLDER;
  write(folder / (name + ".actual.png"), actual);
  write(folder / (name + ".difference.png"), difference);
  ADD_FAILURE() << differing << " of " << actual.size() << " pixels differ by more than " << byteTolerance
                << ", " << allowed << " may, from\n  " << golden.string()
                << "\nactual and 16 times the difference:\n  " << (folder / (name + ".actual.png")).string()
                << "\n  " << (folder / (name + ".difference.png")).string();
}

}  // namespace

void expectGolden(const Gl& gl, const Image<Color8>& actual, const std::string& name, GoldenOf content) {
  expectEqual(gl, actual, nullptr, name, content);
}

void expectGoldenOverlay(const Gl& gl, const Image<Color8>& actual, const Image<Color8>& bare,
                         const std::string& name, GoldenOf content) {
  expectEqual(gl, actual, &bare, name, content);
}

}  // namespace lightvane
