#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/gl/picture_layer.h"
#include "tests/gl/golden.h"
#include "tests/gl/memory_gl.h"
#include "tests/gl/test_pictures.h"

namespace lightvane {
namespace {

constexpr Color8 kBackground = {30, 30, 33, 255};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class Pictures : public GlTest {
 protected:
  PictureTexture uploaded(const ViewImage& image) {
    PictureTexture texture(gl());
    texture.upload(image, table_);
    return texture;
  }

  /// The picture alone on a background.
  Image<Color8> drawn(const ViewImage& image, const PictureStyle& style, int width, int height,
                      const Placement& placement) {
    const Framebuffer target(gl(), width, height);
    target.clear(kBackground);
    PictureTexture picture = uploaded(image);
    layer_.draw(target, picture, style, placement);
    return target.read();
  }
  Image<Color8> drawnFit(const ViewImage& image, const PictureStyle& style, int width = 208,
                         int height = 144) {
    return drawn(image, style, width, height,
                 Placement::fit(8, 8, width - 16, height - 16, image.width, image.height));
  }

  const std::array<Color8, 256> table_ = testTable();
  const PictureLayer layer_ = PictureLayer::create(gl(), {}).value();
};

PictureStyle toneMapped(ToneMap map, float stops) {
  PictureStyle style;
  style.toneMap = map;
  style.exposureStops = stops;
  return style;
}

PictureStyle scaled(float low, float high, bool logarithmic) {
  PictureStyle style;
  style.scale = {ColorMap::Viridis, low, high, logarithmic};
  return style;
}

TEST_F(Pictures, RadianceIsClipped) {
  expectGolden(gl(), drawnFit(radianceRamp(96, 64), toneMapped(ToneMap::Clip, 0.0f)), "picture_radiance");
}
TEST_F(Pictures, RadianceThroughReinhard) {
  expectGolden(gl(), drawnFit(radianceRamp(96, 64), toneMapped(ToneMap::Reinhard, 1.0f)), "picture_reinhard");
}
TEST_F(Pictures, RadianceThroughFilm) {
  expectGolden(gl(), drawnFit(radianceRamp(96, 64), toneMapped(ToneMap::Filmic, 1.0f)), "picture_filmic");
}
TEST_F(Pictures, ColorAsItIs) { expectGolden(gl(), drawnFit(colorSquares(96, 64), {}), "picture_color"); }
TEST_F(Pictures, ScalarOnAScale) {
  expectGolden(gl(), drawnFit(scalarHill(96, 64), scaled(0.0f, 1.0f, false)), "picture_scalar");
}
TEST_F(Pictures, ScalarOnALogarithmicScale) {
  expectGolden(gl(), drawnFit(scalarHill(96, 64), scaled(1e-3f, 1.0f, true)), "picture_scalar_log");
}
TEST_F(Pictures, Categories) {
  expectGolden(gl(), drawnFit(categoryBlocks(96, 64), {}), "picture_categories");
}

ViewImage withInvalidPixels(int width, int height) {
  ViewImage image = radianceRamp(width, height);
  const auto at = [&](int x, int y) { return static_cast<std::size_t>((y * width + x) * 3); };
  image.values[at(3, 2)] = kNan;
  image.values[at(6, 1) + 1] = kInfinity;
  image.values[at(6, 4) + 2] = -0.01f;
  return image;
}

TEST_F(Pictures, MagnifiedPixelsAreSquaresOnAGridAndInvalidOnesAreCrossedOut) {
  expectGolden(gl(), drawnFit(withInvalidPixels(12, 8), toneMapped(ToneMap::Clip, 2.0f)), "picture_zoomed");
}
TEST_F(Pictures, MagnifiedSmoothly) {
  PictureStyle style = toneMapped(ToneMap::Clip, 2.0f);
  style.smooth = true;
  expectGolden(gl(), drawnFit(radianceRamp(12, 8), style), "picture_smooth");
}

TEST_F(Pictures, MinifiedOnesDoNotAlias) {
  // Rings ever closer together (a zone plate): what is finer than the screen's pixels must fade to grey,
  // without rings of its own.
  ViewImage plate = makeView(ViewKind::Color, 600, 600);
  for (int y = 0; y < 600; ++y) {
    for (int x = 0; x < 600; ++x) {
      const float value = 0.5f + 0.5f * std::cos(static_cast<float>(x * x + y * y) * kPi / 1200.0f);
      std::fill_n(&plate.values[static_cast<std::size_t>((y * 600 + x) * 3)], 3, value);
    }
  }
  expectGolden(gl(), drawnFit(plate, {}, 166, 166), "picture_minified");
}

TEST_F(Pictures, OneInvalidPixelAmongManyIsSeen) {
  ViewImage image = makeView(ViewKind::Radiance, 160, 160);
  image.values[static_cast<std::size_t>((80 * 160 + 80) * 3)] = kNan;
  const Image<Color8> small = drawn(image, {}, 10, 10, Placement::fit(0, 0, 10, 10, 160, 160));
  EXPECT_EQ(small.at(5, 5), (Color8{255, 0, 255, 255}));
  EXPECT_EQ(small.at(4, 5), (Color8{0, 0, 0, 255}));
}

TEST_F(Pictures, UnderAWipe) {
  const Framebuffer target(gl(), 208, 144);
  target.clear(kBackground);
  PictureTexture left = uploaded(radianceRamp(96, 64)), right = uploaded(scalarHill(96, 64));
  layer_.drawWipe(target, left, toneMapped(ToneMap::Filmic, 1.0f), right, scaled(0.0f, 1.0f, false),
                  Placement::fit(8, 8, 192, 128, 96, 64), 0.4f, 2);
  expectGolden(gl(), target.read(), "picture_wipe");
}

TEST_F(Pictures, SideBySide) {
  const Framebuffer target(gl(), 208, 144);
  target.clear(kBackground);
  const Placement first{8, 8, 96, 128, Vec2(-20.0f, 10.0f), 1.5f};
  Placement second = first;
  second.left += first.width;
  PictureTexture left = uploaded(radianceRamp(96, 64)), right = uploaded(categoryBlocks(96, 64));
  layer_.draw(target, left, toneMapped(ToneMap::Filmic, 1.0f), first);
  layer_.draw(target, right, {}, second);
  expectGolden(gl(), target.read(), "picture_side_by_side");
}

// Every pixel of each kind, at zoom 1: displayColor() says what the shader does.
TEST_F(Pictures, TheCpuSaysTheSame) {
  ViewImage scalar = scalarHill(96, 64);
  scalar.values[0] = kInfinity;
  scalar.values[1] = -kInfinity;
  scalar.values[2] = -1.0f;
  ViewImage categories = categoryBlocks(96, 64);
  categories.values[0] = 7.0f;
  categories.values[1] = -1.0f;
  ViewImage bright = radianceRamp(96, 64);
  for (float& value : bright.values) value *= 1e30f;
  const std::vector<std::pair<const char*, std::pair<ViewImage, PictureStyle>>> cases = {
      {"none", {radianceRamp(96, 64), toneMapped(ToneMap::Clip, 0.5f)}},
      {"reinhard", {radianceRamp(96, 64), toneMapped(ToneMap::Reinhard, 0.0f)}},
      {"filmic", {radianceRamp(96, 64), toneMapped(ToneMap::Filmic, 1.0f)}},
      {"bright none", {bright, toneMapped(ToneMap::Clip, 40.0f)}},
      {"bright reinhard", {bright, toneMapped(ToneMap::Reinhard, 40.0f)}},
      {"bright filmic", {bright, toneMapped(ToneMap::Filmic, 40.0f)}},
      {"invalid", {withInvalidPixels(96, 64), toneMapped(ToneMap::Clip, 0.0f)}},
      {"color", {colorSquares(96, 64), {}}},
      {"scalar", {scalar, scaled(0.1f, 0.8f, false)}},
      {"scalar, logarithmic", {scalar, scaled(1e-3f, 0.5f, true)}},
      {"scalar without a range", {scalar, scaled(0.5f, 0.5f, false)}},
      {"categories", {categories, {}}}};
  for (const auto& [name, input] : cases) {
    const auto& [image, style] = input;
    const Image<Color8> shown = drawn(image, style, 96, 64, Placement::fit(0, 0, 96, 64, 96, 64));
    int largest = 0, atX = 0, atY = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 96; ++x) {
        const Color8 a = shown.at(x, y), b = displayColor(image, x, y, style, table_);
        const int difference = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
        if (difference > largest) largest = difference, atX = x, atY = y;
      }
    }
    EXPECT_LE(largest, 1) << name << ", pixel " << atX << ", " << atY;
  }
}

TEST_F(Pictures, AllThatIsDimmerThanBlackIsBlackAndAllBrighterThanWhiteIsWhite) {
  ViewImage image = makeView(ViewKind::Radiance, 2, 1);
  std::fill_n(&image.values[3], 3, 1e6f);
  for (const ToneMap map : {ToneMap::Clip, ToneMap::Reinhard, ToneMap::Filmic}) {
    EXPECT_EQ(displayColor(image, 0, 0, toneMapped(map, 0.0f), table_), (Color8{0, 0, 0, 255}));
    EXPECT_EQ(displayColor(image, 1, 0, toneMapped(map, 0.0f), table_), (Color8{255, 255, 255, 255}));
  }
}

TEST_F(Pictures, OnlyChangedBandsAreUploaded) {
  ViewImage image = radianceRamp(32, 200);
  image.values[7] = kNan;
  PictureTexture texture(gl());
  EXPECT_EQ(texture.upload(image, table_), 200);
  EXPECT_EQ(texture.upload(image, table_), 0);
  image.values[70 * 32 * 3] += 1.0f;
  EXPECT_EQ(texture.upload(image, table_), 64);
  image.values.back() += 1.0f;
  EXPECT_EQ(texture.upload(image, table_), 200 - 3 * 64);
  EXPECT_EQ(texture.upload(scalarHill(32, 200), table_), 200);

  // What was uploaded in parts is what was uploaded at once.
  EXPECT_EQ(texture.upload(image, table_), 200);
  image.values[150 * 32 * 3] = 0.25f;
  texture.upload(image, table_);
  const Framebuffer target(gl(), 32, 200);
  layer_.draw(target, texture, {}, Placement::fit(0, 0, 32, 200, 32, 200));
  EXPECT_EQ(target.read(), drawn(image, {}, 32, 200, Placement::fit(0, 0, 32, 200, 32, 200)));
}

TEST_F(Pictures, AViewWithoutValuesShowsNothing) {
  PictureTexture texture = uploaded(radianceRamp(32, 20));
  EXPECT_EQ(texture.upload({}, table_), 0);
  EXPECT_TRUE(texture.empty());
  const Framebuffer target(gl(), 32, 20);
  target.clear(kBackground);
  layer_.draw(target, texture, {}, Placement::fit(0, 0, 32, 20, 32, 20));
  EXPECT_EQ(target.read(), Image<Color8>(32, 20, kBackground));
  EXPECT_EQ(texture.upload(radianceRamp(32, 20), table_), 20);
}

TEST_F(Pictures, StylesActWithoutAnUpload) {
  const ViewImage image = scalarHill(96, 64), other = scalarHill(96, 65);
  const Placement placement = Placement::fit(0, 0, 96, 64, 96, 64);
  PictureTexture texture = uploaded(image);
  const Framebuffer target(gl(), 96, 64);
  const auto drawnAgain = [&](const PictureStyle& style) {
    target.clear(kBackground);
    layer_.draw(target, texture, style, placement);
    return target.read();
  };
  for (const PictureStyle& style :
       {scaled(0.0f, 1.0f, false), scaled(1e-3f, 1.0f, true), scaled(0.0f, 0.5f, false)}) {
    EXPECT_EQ(drawnAgain(style), drawn(image, style, 96, 64, placement));
  }
  // A new colour map, and new values of another size.
  std::array<Color8, 256> reversed = table_;
  std::ranges::reverse(reversed);
  EXPECT_EQ(texture.upload(image, reversed), 0);
  const PictureStyle style = scaled(0.0f, 1.0f, false);
  EXPECT_EQ(drawnAgain(style).at(48, 32), displayColor(image, 48, 32, style, reversed));
  EXPECT_EQ(texture.upload(other, table_), 65);
  EXPECT_EQ(drawnAgain(style), drawn(other, style, 96, 64, placement));
}

TEST_F(Pictures, TheSecondDrawingIsTheFirst) {
  const PictureStyle style = toneMapped(ToneMap::Filmic, 1.0f);
  EXPECT_EQ(drawnFit(radianceRamp(97, 61), style), drawnFit(radianceRamp(97, 61), style));
}

TEST(PlacementTest, PlacesAreFoundThereAndBack) {
  const Placement placement = Placement::fit(10, 20, 400, 300, 200, 200);
  EXPECT_EQ(placement.zoom, 1.5f);
  EXPECT_EQ(placement.toFramebuffer(Vec2(0.0f)), Vec2(60.0f, 20.0f));
  EXPECT_EQ(placement.toPicture(Vec2(60.0f, 20.0f)), Vec2(0.0f));
  EXPECT_EQ(placement.toPicture(Vec2(360.0f, 320.0f)), Vec2(200.0f));
}

TEST(PlacementTest, ZoomingKeepsThePointUnderTheMouse) {
  const Placement placement{10, 20, 400, 300, Vec2(-13.0f, 7.0f), 2.0f};
  const Vec2 mouse(120.0f, 90.0f);
  const Placement zoomed = placement.zoomedAbout(mouse, 4.0f);
  EXPECT_EQ(zoomed.zoom, 8.0f);
  EXPECT_EQ(zoomed.toPicture(mouse), placement.toPicture(mouse));
}

}  // namespace
}  // namespace lightvane
