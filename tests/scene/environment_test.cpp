#include "core/scene/environment.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/scene/lights.h"
#include "core/scene/scene.h"

namespace lightvane {
namespace {

/// A picture of a radiance that is a function of the direction, sampled at the pixels' middles.
template <class Radiance>
ImageRgb pictureOf(int width, int height, const Radiance& radiance) {
  ImageRgb picture(width, height);
  for (int y = 0; y < height; ++y) {
    const double theta = kPiD * (y + 0.5) / height;
    for (int x = 0; x < width; ++x) {
      const double longitude = 2.0 * kPiD * ((x + 0.5) / width - 0.5);
      picture.at(x, y) = radiance(Vec3d(std::sin(theta) * std::sin(longitude), std::cos(theta),
                                        -std::sin(theta) * std::cos(longitude)));
    }
  }
  return picture;
}

// L = 2 + b.d, whose irradiance on a surface of normal n is 2 pi + (2 pi / 3) b.n as long as nothing is
// hidden.
const Vec3d kSlope(0.8, 1.1, -0.4);
Rgb slanted(const Vec3d& direction) {
  const double value = 2.0 + glm::dot(kSlope, direction);
  return Rgb(glm::dvec3(value, 0.5 * value, 0.0));
}

/// A sky with a sun: what is sampled badly without a table.
Rgb sunny(const Vec3d& direction) {
  return Rgb(glm::dot(direction, glm::normalize(Vec3d(0.5, 0.6, -0.3))) > 0.97 ? 300.0f : 0.5f);
}

EnvironmentLight lightOf(ImageRgb picture, double rotateDegrees = 0.0, const Vec3d& up = {0, 1, 0}) {
  EnvironmentLight light;
  light.map = std::make_shared<EnvironmentMap>(std::move(picture));
  light.frame = environmentFrame(up, rotateDegrees);
  return light;
}

Vec3 direction(RandomKey key, std::uint32_t i) {
  const float y = 1.0f - 2.0f * uniform(key, i, 0);
  const float s = std::sqrt(std::max(0.0f, 1.0f - y * y));
  const float phi = kTwoPi * uniform(key, i, 1);
  return glm::normalize(Vec3(s * std::cos(phi), y, s * std::sin(phi)));
}

/// The sky of a scene that has it and a ball.
EnvironmentLight compiledSky(const ImageRgb& picture) {
  SceneDescription description;
  description.cameras.emplace_back().position = {0.0, 0.0, 4.0};
  description.materials.emplace_back();
  description.shapes.emplace_back().geometry = SphereDescription{};
  EnvironmentLightDescription sky;
  sky.pixels = std::make_shared<const ImageRgb>(picture);
  description.lights.push_back({"sky", sky});
  const auto scene = Scene::compile(description);
  EXPECT_TRUE(scene) << scene.error().message();
  return std::get<EnvironmentLight>((*scene)->lights.at(0));
}

// Squares of what is in the picture would be infinite, or nothing.
TEST(EnvironmentMap, IsTheSameWhateverThePowerOfItsRadiance) {
  const ImageRgb picture = pictureOf(32, 16, sunny);
  const EnvironmentLight expected = compiledSky(picture);
  const Vec3 normal = glm::normalize(Vec3(0.2f, 0.9f, -0.1f));
  for (const float scale : {0x1p-110f, 0x1p-70f, 0x1p10f, 0x1p63f, 0x1p80f, 0x1p118f}) {
    ImageRgb scaled = picture;
    for (Rgb& pixel : scaled) pixel *= scale;
    const EnvironmentLight sky = compiledSky(scaled);
    EXPECT_EQ(sky.total(), expected.total()) << scale;
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Vec2 u = uniform2(randomKey(3), i, 0);
      const Vec3 d = expected.sample(u, normal);
      EXPECT_EQ(sky.sample(u, normal), d) << scale;
      EXPECT_EQ(sky.pdf(d, normal), expected.pdf(d, normal)) << scale;
      EXPECT_EQ(sky.radianceFrom(d), expected.radianceFrom(d)) << scale;
    }
  }
}

TEST(EnvironmentMap, ShowsThePictureWhereItsDirectionsAre) {
  const EnvironmentMap map(pictureOf(256, 128, slanted));
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec3 d = direction(randomKey(1), i);
    const Rgb expected = slanted(Vec3d(d));
    // Bilinear in angles between pixels 1.4 degrees apart: (0.0245)^2 / 8 of the slope; at the poles, half a
    // pixel.
    const float tolerance = std::abs(d.y) > 0.99f ? 0.02f : 4e-4f;
    EXPECT_NEAR(map.radiance(d).r, expected.r, tolerance) << d.x << " " << d.y << " " << d.z;
    EXPECT_NEAR(map.radiance(d).g, expected.g, tolerance);
    EXPECT_EQ(map.radiance(d).b, 0.0f);
  }
}

TEST(EnvironmentMap, HasNoSeamBehind) {
  const EnvironmentMap map(pictureOf(64, 32, slanted));
  const Vec3 left = map.radiance(glm::normalize(Vec3(-1e-4f, 0.2f, 1.0f)));
  const Vec3 right = map.radiance(glm::normalize(Vec3(1e-4f, 0.2f, 1.0f)));
  EXPECT_NEAR(left.r, right.r, 1e-3f);
}

TEST(EnvironmentMap, DensityAddsUpToOneAndIsThatOfItsSamples) {
  const EnvironmentMap map(pictureOf(64, 32, sunny));
  // Octants: the density's integral over each against the share of the samples that fall there.
  double integral[8] = {}, share[8] = {};
  const auto octant = [](const Vec3& d) { return (d.x > 0 ? 1 : 0) + (d.y > 0 ? 2 : 0) + (d.z > 0 ? 4 : 0); };
  // A midpoint rule: the density is bilinear in squares of two steps each way.
  constexpr int kRows = 32 * 16, kColumns = 64 * 16;
  for (int row = 0; row < kRows; ++row) {
    const double above = std::cos(kPiD * row / kRows), below = std::cos(kPiD * (row + 1) / kRows);
    const double y = 0.5 * (above + below);
    const double s = std::sqrt(1.0 - y * y);
    for (int column = 0; column < kColumns; ++column) {
      const double longitude = 2.0 * kPiD * ((column + 0.5) / kColumns - 0.5);
      const Vec3 d(Vec3d(s * std::sin(longitude), y, -s * std::cos(longitude)));
      integral[octant(d)] += static_cast<double>(map.pdf(d)) * 2.0 * kPiD / kColumns * (above - below);
    }
  }
  constexpr int kSamples = 256;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Vec3 d =
          map.sample({(static_cast<float>(i) + 0.5f) / kSamples, (static_cast<float>(j) + 0.5f) / kSamples});
      EXPECT_NEAR(glm::length(d), 1.0f, 1e-6f);
      share[octant(d)] += 1.0 / (kSamples * kSamples);
      ASSERT_GT(map.pdf(d), 0.0f);
    }
  }
  double sum = 0.0;
  for (int o = 0; o < 8; ++o) {
    sum += integral[o];
    // Strata of 1 / 256 either way, of which one may be cut.
    EXPECT_NEAR(share[o], integral[o], 4e-3) << "octant " << o;
  }
  EXPECT_NEAR(sum, 1.0, 1e-4);
}

TEST(EnvironmentMap, IsSampledByBrightness) {
  const EnvironmentMap map(pictureOf(64, 32, sunny));
  // radiance / pdf is the total for every sample where sampling is ideal: what is left is that a row of cells
  // near the pole is wider below than above.
  const double total = static_cast<double>(map.total().r);
  constexpr int kSamples = 128;
  double mean = 0.0, square = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    for (int j = 0; j < kSamples; ++j) {
      const Vec3 d =
          map.sample({(static_cast<float>(i) + 0.5f) / kSamples, (static_cast<float>(j) + 0.5f) / kSamples});
      const double value = static_cast<double>(map.radiance(d).r) / static_cast<double>(map.pdf(d)) / total;
      mean += value / (kSamples * kSamples);
      square += value * value / (kSamples * kSamples);
    }
  }
  EXPECT_NEAR(mean, 1.0, 0.002);
  EXPECT_LT(std::sqrt(square - mean * mean), 0.05) << "by uniform directions it would be 5";
  EXPECT_LE(map.total().r, map.totalBound().r);
}

TEST(EnvironmentMap, BlackPictureHasNoDensity) {
  const EnvironmentMap map{ImageRgb(4, 2)};
  EXPECT_EQ(map.pdf({0, 1, 0}), 0.0f);
  EXPECT_NEAR(glm::length(map.sample({0.3f, 0.7f})), 1.0f, 1e-6f);
  const Light light = lightOf(ImageRgb(4, 2));
  for (const float u : {0.1f, 0.9f}) {
    LightSample sample;
    if (!LightSampler(light, Vec3(0.0f), Vec3(0, 1, 0)).sample({u, 0.5f}, sample)) continue;
    EXPECT_EQ(sample.weight, Rgb(0.0f));
  }
}

// With half of the samples by the cosine, half by the map: the closed form, from a few hundred.
TEST(EnvironmentLight, GivesASurfaceItsIrradiance) {
  const EnvironmentLight sky = lightOf(pictureOf(128, 64, slanted), 30.0, {0.2, 1.0, -0.5});
  const Light light = sky;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Vec3 normal = direction(randomKey(7), i);
    const LightSampler sampler(light, Vec3(0.0f), normal);
    constexpr int kSide = 24;
    Vec3d sum(0.0);
    for (int s = 0; s < kSide * kSide; ++s) {
      const Vec2 u((static_cast<float>(s % kSide) + 0.5f) / kSide,
                   (static_cast<float>(s / kSide) + 0.5f) / kSide);
      LightSample sample;
      if (!sampler.sample(u, sample)) continue;
      EXPECT_EQ(sample.distance, kInfinity);
      EXPECT_EQ(sample.pdf, lightPdfAtInfinity(light, sample.direction, normal));
      const float cosine = glm::dot(sample.direction, normal);
      if (cosine > 0.0f) sum += Vec3d(sample.weight * cosine) / static_cast<double>(kSide * kSide);
    }
    const double expected =
        2.0 * kPiD + 2.0 * kPiD / 3.0 * glm::dot(kSlope, Vec3d(sky.frame.toLocal(normal)));
    EXPECT_NEAR(sum.x, expected, 0.02 * expected);
    EXPECT_NEAR(sum.y, 0.5 * expected, 0.01 * expected);
    EXPECT_GE(static_cast<double>(irradianceBound(light, Vec3(0.0f))), expected);
  }
}

TEST(EnvironmentLight, OfOneColourIsSampledByTheCosineAlone) {
  EnvironmentLight sky;
  sky.radiance = Rgb(0.5f, 1.0f, 2.0f);
  const Light light = sky;
  const Vec3 normal = glm::normalize(Vec3(1, 2, -2));
  const LightSampler sampler(light, Vec3(0.0f), normal);
  for (std::uint32_t i = 0; i < 100; ++i) {
    LightSample sample;
    ASSERT_TRUE(sampler.sample(uniform2(randomKey(3), i, 0), sample));
    const float cosine = glm::dot(sample.direction, normal);
    ASSERT_GT(cosine, 0.0f);
    // Every sample by itself is the irradiance.
    EXPECT_NEAR(sample.weight.g * cosine, kPi, 1e-4f);
    EXPECT_NEAR(sample.weight.b * cosine, 2.0f * kPi, 2e-4f);
  }
  EXPECT_NEAR(sampler.solidAngle(), kTwoPi, 1e-5f);
  EXPECT_NEAR(LightSampler(light, Vec3(0.0f)).solidAngle(), 2.0f * kTwoPi, 1e-5f);
  EXPECT_NEAR(irradianceBound(light, Vec3(0.0f)), 2.0f * kPi, 1e-3f);
  EXPECT_FALSE(isDirac(light));
  EXPECT_EQ(distinctSamples(light), 0);
}

TEST(EnvironmentLight, TurnsCounterClockwiseSeenFromAbove) {
  const Vec3 ahead(0, 0, -1);
  EXPECT_NEAR(glm::distance(environmentFrame({0, 2, 0}, 0.0).toWorld(ahead), ahead), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(environmentFrame({0, 2, 0}, 90.0).toWorld(ahead), Vec3(-1, 0, 0)), 0.0f, 1e-6f);
  // What is up stands where the light says; what is ahead goes the shortest way.
  const Frame zUp = environmentFrame({0, 0, 1}, 0.0);
  EXPECT_NEAR(glm::distance(zUp.toWorld({0, 1, 0}), Vec3(0, 0, 1)), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::distance(zUp.toWorld(ahead), Vec3(0, 1, 0)), 0.0f, 1e-6f);
  for (const Vec3d& up : {Vec3d(0, -1, 0), Vec3d(1e-9, -1, 0), Vec3d(1, 0, 0), Vec3d(0.3, -0.9, 0.1)}) {
    const Frame frame = environmentFrame(up, 37.0);
    EXPECT_NEAR(glm::distance(frame.y, Vec3(glm::normalize(up))), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::dot(frame.x, frame.y), 0.0f, 1e-6f);
    EXPECT_NEAR(glm::distance(glm::cross(frame.x, frame.y), frame.z), 0.0f, 1e-6f);
  }
}

}  // namespace
}  // namespace lightvane
