#include "core/scene/texture.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lightvane {
namespace {

/// Six pixels of different colours, 3 wide.
std::shared_ptr<const ImageRgb> sixPixels() {
  auto pixels = std::make_shared<ImageRgb>(3, 2);
  for (std::size_t i = 0; i < 6; ++i) (*pixels)[i] = Rgb(0.1f * static_cast<float>(i + 1), 0.5f, 0.0f);
  return pixels;
}

Rgb imageColor(TextureWrap wrap, TextureFilter filter, const Vec2& uv) {
  return Texture({"", ImageTextureDescription{"", sixPixels(), wrap, filter}}).at(Vec3d(0.0), uv);
}

void expectRed(float expected, const Rgb& color) { EXPECT_NEAR(color.r, expected, 1e-6f); }

TEST(ImageTexture, HasItsFirstRowOnTop) {
  const auto red = [](float u, float v) {
    return imageColor(TextureWrap::Repeat, TextureFilter::Nearest, {u, v}).r;
  };
  EXPECT_FLOAT_EQ(red(0.1f, 0.9f), 0.1f);
  EXPECT_FLOAT_EQ(red(0.5f, 0.9f), 0.2f);
  EXPECT_FLOAT_EQ(red(0.9f, 0.6f), 0.3f);
  EXPECT_FLOAT_EQ(red(0.1f, 0.4f), 0.4f);
  EXPECT_FLOAT_EQ(red(0.9f, 0.1f), 0.6f);
}

TEST(ImageTexture, RepeatsOrKeepsItsEdge) {
  const auto red = [](TextureWrap wrap, float u, float v) {
    return imageColor(wrap, TextureFilter::Nearest, {u, v}).r;
  };
  for (const float turns : {-1000.0f, -3.0f, -1.0f, 1.0f, 2.0f, 500.0f}) {
    EXPECT_FLOAT_EQ(red(TextureWrap::Repeat, 0.5f + turns, 0.75f - turns), 0.2f);
  }
  EXPECT_FLOAT_EQ(red(TextureWrap::Clamp, -7.0f, 3.0f), 0.1f);
  EXPECT_FLOAT_EQ(red(TextureWrap::Clamp, 7.0f, -3.0f), 0.6f);
  EXPECT_FLOAT_EQ(red(TextureWrap::Clamp, 1e30f, -1e30f), 0.6f);
}

// Straight between the middles of pixels, across the border too where it repeats.
TEST(ImageTexture, IsStraightBetweenPixels) {
  const auto at = [](TextureWrap wrap, float u, float v) {
    return imageColor(wrap, TextureFilter::Linear, {u, v});
  };
  expectRed(0.1f, at(TextureWrap::Repeat, 0.5f / 3.0f, 0.75f));
  expectRed(0.15f, at(TextureWrap::Repeat, 1.0f / 3.0f, 0.75f));
  expectRed(0.25f * (0.1f + 0.2f + 0.4f + 0.5f), at(TextureWrap::Repeat, 1.0f / 3.0f, 0.5f));
  expectRed(0.5f * (0.1f + 0.3f), at(TextureWrap::Repeat, 0.0f, 0.75f));
  expectRed(0.1f, at(TextureWrap::Clamp, 0.0f, 0.75f));
  expectRed(0.5f * (0.1f + 0.4f), at(TextureWrap::Repeat, 0.5f / 3.0f, 1.0f));
}

TEST(CheckerTexture, AlternatesOverTextureCoordinates) {
  const Texture checker({"", CheckerDescription{Rgb(0.9f), Rgb(0.1f)}});
  EXPECT_TRUE(checker.usesUv());
  for (int y = -3; y < 4; ++y) {
    for (int x = -3; x < 4; ++x) {
      const Vec2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      EXPECT_EQ(checker.at(Vec3d(0.0), middle), Rgb((x + y) % 2 == 0 ? 0.9f : 0.1f)) << x << ", " << y;
    }
  }
}

Vec3d place(std::uint32_t i) {
  const RandomKey key = randomKey(7);
  return 4.0 * Vec3d(uniform(key, i, 0), uniform(key, i, 1), uniform(key, i, 2)) - 2.0;
}

/// Of the way from one colour to the other, by the red component.
double shareOf(const Texture& texture, const Vec3d& at, double from, double to) {
  return (static_cast<double>(texture.at(at, Vec2(0.0f)).r) - from) / (to - from);
}

TEST(SolidTextures, StayBetweenTheirColours) {
  const Texture textures[] = {Texture({"", WoodDescription{Rgb(0.6f), Rgb(0.2f)}}),
                              Texture({"", MarbleDescription{Rgb(0.6f), Rgb(0.2f)}})};
  for (const Texture& texture : textures) {
    EXPECT_FALSE(texture.usesUv());
    double least = 1.0;
    double most = 0.0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const double share = shareOf(texture, place(i), 0.6, 0.2);
      ASSERT_GE(share, -1e-6);
      ASSERT_LE(share, 1.0 + 1e-6);
      least = std::min(least, share);
      most = std::max(most, share);
    }
    EXPECT_LT(least, 0.01);
    EXPECT_GT(most, 0.99);
  }
}

// Without distortion and grain, wood is circles about its axis, and marble planes across it.
TEST(SolidTextures, AreRingsAndPlanesWithoutTurbulence) {
  WoodDescription wood{Rgb(0.6f), Rgb(0.2f), Vec3d(0.0, 0.0, 3.0)};
  wood.distortion = wood.grain = 0.0;
  MarbleDescription marble{Rgb(0.6f), Rgb(0.2f), Vec3d(0.0, 2.0, 0.0)};
  marble.distortion = 0.0;
  marble.sharpness = 1.0;
  const Texture rings({"", wood});
  const Texture planes({"", marble});
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Vec3d p = place(i);
    const double radius = std::hypot(p.x, p.y);
    const double next = (radius + wood.ring) / radius;
    // Where late wood ends, a ring is a step.
    const double ring = radius / wood.ring - std::floor(radius / wood.ring);
    if (ring < 1e-3 || ring > 0.999) continue;
    EXPECT_NEAR(shareOf(rings, p, 0.6, 0.2), shareOf(rings, {radius, 0.0, -p.z}, 0.6, 0.2), 1e-4);
    EXPECT_NEAR(shareOf(rings, p, 0.6, 0.2), shareOf(rings, {next * p.x, next * p.y, p.z}, 0.6, 0.2), 1e-4);
    const double phase = p.y / marble.spacing;
    EXPECT_NEAR(shareOf(planes, p, 0.6, 0.2), 0.5 + 0.5 * std::cos(2.0 * kPiD * phase), 1e-5);
  }
}

// Continuous: what lies a thousandth of a ring or vein away looks the same, but for the step between rings.
TEST(SolidTextures, HaveNoSteps) {
  MarbleDescription marble{Rgb(1.0f), Rgb(0.0f)};
  const Texture texture({"", marble});
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const Vec3d p = place(i);
    const double step = 1e-3 * marble.spacing;
    EXPECT_NEAR(shareOf(texture, p, 1.0, 0.0), shareOf(texture, p + step * Vec3d(0.6, -0.6, 0.5), 1.0, 0.0),
                0.05);
  }
}

}  // namespace
}  // namespace lightvane
