#include <gtest/gtest.h>

#include "tests/scene/lights_support.h"

namespace lightvane {
namespace {

using namespace lights_test;

TEST(DiracLights, PointFallsOffWithTheSquareOfTheDistance) {
  const Light light = PointLight{{1, 2, 3}, {8, 4, 2}};
  LightSample sample;
  ASSERT_TRUE(sampleLight(light, {1, 2, 1}, {0.5f, 0.5f}, sample));
  EXPECT_EQ(sample.direction, Vec3(0, 0, 1));
  EXPECT_EQ(sample.distance, 2.0f);
  EXPECT_EQ(sample.weight, Rgb(2, 1, 0.5f));
  EXPECT_EQ(sample.pdf, 0.0f);
  EXPECT_TRUE(isDirac(light));
  EXPECT_EQ(distinctSamples(light), 1);
  EXPECT_NEAR(irradianceBound(light, {1, 2, 1}), 2.0f, 1e-4f);
  EXPECT_FALSE(sampleLight(light, {1, 2, 3}, {0.5f, 0.5f}, sample))
      << "there is no direction at the light itself";
}

TEST(DiracLights, SpotFallsOffBetweenItsCones) {
  const float cosInner = std::cos(20.0f * kPi / 180.0f);
  const float cosOuter = std::cos(40.0f * kPi / 180.0f);
  const Light light = SpotLight{{0, 1, 0}, {0, -1, 0}, Rgb(1.0f), cosInner, cosOuter};
  const auto intensityAt = [&](double degrees) {
    const double angle = degrees * kPiD / 180.0;
    const Vec3 point(Vec3d(0, 1, 0) + Vec3d(std::sin(angle), -std::cos(angle), 0.0));
    LightSample sample;
    const bool lit = sampleLight(light, point, {0.5f, 0.5f}, sample);
    EXPECT_EQ(irradianceBound(light, point) > 0.0f, lit) << degrees << " degrees";
    return lit ? sample.weight.r : 0.0f;
  };
  const float tolerance = 2e-6f;  // points at distance 1, rounded to float
  EXPECT_NEAR(intensityAt(0.0), 1.0f, tolerance);
  EXPECT_NEAR(intensityAt(19.9), 1.0f, tolerance);
  EXPECT_EQ(intensityAt(40.1), 0.0f);
  EXPECT_EQ(intensityAt(90.0), 0.0f);
  EXPECT_EQ(intensityAt(180.0), 0.0f);
  const double middle = std::acos(0.5 * (double(cosInner) + double(cosOuter))) * 180.0 / kPiD;
  EXPECT_NEAR(intensityAt(middle), 0.5f, 2e-5f) << "smoothstep of the cosine";
  const double quarter = std::acos(0.75 * double(cosOuter) + 0.25 * double(cosInner)) * 180.0 / kPiD;
  EXPECT_NEAR(intensityAt(quarter), 0.15625f, 2e-5f) << "smoothstep of the cosine: 3 / 16 - 2 / 64";
  float previous = 1.0f;
  for (double degrees = 20.5; degrees < 40.0; degrees += 0.5) {
    const float now = intensityAt(degrees);
    EXPECT_LT(now, previous + tolerance) << degrees << " degrees";
    previous = now;
  }
}

TEST(DiracLights, PowerOfASpotIsItsIntegral) {
  const SpotLight spot{{0, 0, 0}, {0, 0, 1}, Rgb(2.0f), 0.9f, 0.5f};
  constexpr int kSteps = 2000;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = -1.0 + 2.0 * (i + 0.5) / kSteps;
    LightSample sample;
    const Vec3 point(Vec3d(std::sqrt(1.0 - c * c), 0.0, c));
    if (sampleLight(spot, point, {0.5f, 0.5f}, sample)) sum += sample.weight.r;
  }
  // The midpoint rule's error on a smoothstep is of second order: 1e-5 here.
  EXPECT_NEAR(lightPower(spot, 1.0f), 2.0 * kPiD * sum * 2.0 / kSteps, 1e-4);
  EXPECT_NEAR(lightPower(PointLight{{0, 0, 0}, Rgb(1.0f)}, 1.0f), 4.0f * kPi, 1e-5f);
  EXPECT_NEAR(lightPower(ceilingLight(0, 2, 0, 1, 1), 1.0f), 2.0f * kPi, 1e-5f) << "one side";
  EXPECT_NEAR(lightPower(discLight({0, 0, 0}, {0, 0, 1}, 1, true), 1.0f), 2.0f * kPi * kPi, 1e-4f)
      << "both sides";
  EXPECT_NEAR(lightPower(sphereLight({0, 0, 0}, 0.5f), 1.0f), kPi * kPi, 1e-5f) << "a sphere's whole surface";
  EXPECT_NEAR(lightPower(DirectionalLight{{0, 1, 0}, Rgb(3.0f), 1.0}, 2.0f), 12.0f * kPi, 1e-4f);
}

TEST(DiracLights, VolumicSphereSharesItsIntensity) {
  VolumicSphereLight volume;
  constexpr int kPoints = 32;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    volume.points.push_back(Vec3(0, 10, 0) +
                            0.1f * Vec3(uniform2(randomKey(5), i, 0), uniform(randomKey(5), i, 2)));
  }
  volume.intensity = Rgb(3.0f / kPoints);
  const Light light = volume;
  EXPECT_TRUE(isDirac(light));
  EXPECT_EQ(distinctSamples(light), kPoints);
  EXPECT_NEAR(lightPower(light, 1.0f), 12.0f * kPi, 1e-3f);

  // One sample for each stratum of u.x meets each point once: their mean is the exact sum over the points.
  const Vec3 point(0.5f, 0, 0.25f);
  double expected = 0.0;
  for (const Vec3& p : volume.points)
    expected += 3.0 / kPoints / glm::dot(Vec3d(p - point), Vec3d(p - point));
  double mean = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    LightSample sample;
    ASSERT_TRUE(sampleLight(light, point, {(static_cast<float>(i) + 0.9f) / kPoints, 0.3f}, sample));
    EXPECT_EQ(sample.pdf, 0.0f);
    mean += sample.weight.r / kPoints;
  }
  EXPECT_NEAR(mean, expected, 1e-6 * expected);
  EXPECT_NEAR(irradianceBound(light, point), expected, 1e-4 * expected);
  LightSample sample;
  EXPECT_TRUE(sampleLight(light, point, {1.0f - 0x1p-24f, 0.0f}, sample)) << "the last number below 1";
}

TEST(DirectionalLight, WithoutAngleIsADirac) {
  const Light light = DirectionalLight{{0, 1, 0}, {3, 2, 1}, 1.0};
  LightSample sample;
  ASSERT_TRUE(sampleLight(light, {5, 5, 5}, {0.1f, 0.9f}, sample));
  EXPECT_EQ(sample.direction, Vec3(0, 1, 0));
  EXPECT_EQ(sample.distance, kInfinity);
  EXPECT_EQ(sample.weight, Rgb(3, 2, 1));
  EXPECT_EQ(sample.pdf, 0.0f);
  EXPECT_TRUE(isDirac(light));
  EXPECT_EQ(lightPdfAtInfinity(light, {0, 1, 0}), 0.0f);
  EXPECT_EQ(radianceFromInfinity(light, {0, 1, 0}), Rgb(0.0f));
  EXPECT_EQ(LightSampler(light, {0, 0, 0}).solidAngle(), 0.0f);
}

TEST(DirectionalLight, ConeGivesItsIrradianceAndAgreesWithItsRadiance) {
  for (const double degrees : {0.01, 0.53, 10.0, 120.0}) {  // apparent diameters; the second is the sun's
    const double cosHalf = std::cos(0.5 * degrees * kPiD / 180.0);
    const Vec3 toLight = glm::normalize(Vec3(1, 2, -0.5f));
    const Light light = DirectionalLight{toLight, Rgb(3.0f), cosHalf};
    EXPECT_FALSE(isDirac(light));
    EXPECT_EQ(distinctSamples(light), 0);
    const Estimate facing = irradiance(light, {1, 2, 3}, toLight);
    EXPECT_NEAR(facing.mean, 3.0, tolerance(facing)) << degrees << " degrees";
    EXPECT_GE(irradianceBound(light, {1, 2, 3}), facing.mean * (1.0 - 1e-6));

    // Around the rim, where rounding could put directions outside, and inside.
    for (int i = 0; i <= 64; ++i) {
      const float t = std::min(static_cast<float>(i) / 64.0f, 1.0f - 0x1p-24f);
      for (const Vec2& u : {Vec2(0.0f, t), Vec2(1.0f - 0x1p-24f, t), Vec2(t, 0.0f), Vec2(t, 0.7f)}) {
        LightSample sample;
        ASSERT_TRUE(sampleLight(light, {0, 0, 0}, u, sample));
        ASSERT_EQ(lightPdfAtInfinity(light, sample.direction), sample.pdf) << degrees << " degrees";
        const float radiance = radianceFromInfinity(light, sample.direction).r;
        ASSERT_NEAR(radiance / sample.pdf, sample.weight.r, 1e-6f * sample.weight.r) << degrees << " degrees";
      }
    }
    // Just outside, by a thousandth of the angle and the rounding of float directions.
    const double outside = 0.5 * degrees * kPiD / 180.0 * 1.001 + 5e-4;
    const Frame frame = Frame::aboutNormal(toLight);
    const Vec3 beside = frame.toWorld(Vec3(Vec3d(std::sin(outside), 0.0, std::cos(outside))));
    EXPECT_EQ(lightPdfAtInfinity(light, beside), 0.0f) << degrees << " degrees";
    EXPECT_EQ(radianceFromInfinity(light, beside), Rgb(0.0f)) << degrees << " degrees";
  }
}

}  // namespace
}  // namespace lightvane
