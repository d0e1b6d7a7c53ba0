#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/scene/load_scene.h"
#include "core/scene/scene.h"
#include "tests/scene/lights_support.h"

namespace lightvane {
namespace {

using namespace lights_test;

// What every sample must be, whatever the light and the point: finite, not negative, a unit direction, on the
// light.
void expectSound(const Light& light, const Vec3& point, const std::string& what) {
  const float bound = irradianceBound(light, point);
  EXPECT_TRUE(std::isfinite(bound) && bound >= 0.0f) << what << ": bound " << bound;
  const LightSampler sampler(light, point);
  const float solidAngle = sampler.solidAngle();
  EXPECT_TRUE(std::isfinite(solidAngle) && solidAngle >= 0.0f) << what << ": solid angle " << solidAngle;
  const float edge = 1.0f - 0x1p-24f;
  for (const float x : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.7f, edge}) {
    for (const float y : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.7f, edge}) {
      LightSample s;
      if (!sampler.sample({x, y}, s)) continue;
      EXPECT_GT(bound, 0.0f) << what << ": reached, but the bound is 0";
      EXPECT_TRUE(isValidSample(s.weight)) << what << ": weight " << s.weight.r << " at u " << x << ", " << y;
      EXPECT_NEAR(glm::length(s.direction), 1.0f, 1e-6f) << what << " at u " << x << ", " << y;
      EXPECT_TRUE(s.distance >= 0.0f && !std::isnan(s.distance)) << what << ": distance " << s.distance;
      EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f) << what << ": pdf " << s.pdf;
      const float again = sampler.pdf(s.direction, 0);
      EXPECT_TRUE(std::isfinite(again) && again >= 0.0f) << what << ": pdf() " << again;
      if (const auto* area = std::get_if<AreaLight>(&light)) {
        const double reach = glm::length(Vec3d(area->boundCenter) - Vec3d(point)) + double(area->boundRadius);
        EXPECT_LE(s.distance, reach * 1.0001) << what << " at u " << x << ", " << y;
        EXPECT_GT(s.pdf, 0.0f) << what;
      }
    }
  }
}

std::vector<std::pair<std::string, Light>> areaLights(bool twoSided) {
  std::vector<std::pair<std::string, Light>> lights = {
      {"rectangle", ceilingLight(-1, 1, -1, 1, 0)},
      {"pentagon", regularCeilingLight(5, 1, 0)},
      {"polygon of 40 corners", regularCeilingLight(40, 1, 0)},
      {"triangle", triangleLight({emitterTriangle({-1, 0, -1}, {1, 0, -1}, {0, 0, 1})})},
      {"sphere", sphereLight(Vec3(0.0f), 1.0f)},
      {"disc", discLight(Vec3(0.0f), {0, -1, 0}, 1.0f)},
      {"icosahedron", triangleLight(icosahedron(Vec3(0.0f), 1.0f))},
  };
  for (auto& [name, light] : lights) std::get<AreaLight>(light).twoSided = twoSided;
  return lights;
}

TEST(LightExtremes, PointsOnAndNearTheLight) {
  for (const bool twoSided : {false, true}) {
    for (const auto& [name, light] : areaLights(twoSided)) {
      for (const float height :
           {0.0f, -1e-30f, 1e-30f, -1e-12f, 1e-12f, -1e-7f, 1e-7f, -1e-3f, 1e-3f, -1.0f, 1.0f}) {
        for (const Vec3& at : {Vec3(0, 0, 0), Vec3(0.3f, 0, 0.2f), Vec3(1, 0, 0), Vec3(-1, 0, -1),
                               Vec3(0.5f, 0, 1), Vec3(1, 0, 0.5f), Vec3(2, 0, 0), Vec3(1000, 0, 3)}) {
          expectSound(light, at + Vec3(0, height, 0),
                      name + " from (" + std::to_string(at.x) + ", " + std::to_string(at.z) + ") at height " +
                          std::to_string(height));
        }
      }
    }
  }
}

TEST(LightExtremes, CornersAndSurfacePointsOfEveryPiece) {
  for (const bool twoSided : {false, true}) {
    for (const auto& [name, light] : areaLights(twoSided)) {
      for (const EmitterTriangle& t : std::get<AreaLight>(light).triangles) {
        for (const Vec3& p : {t.a, t.b, t.c, 0.5f * (t.a + t.b), (t.a + t.b + t.c) / 3.0f})
          expectSound(light, p, name);
      }
    }
    for (std::uint32_t i = 0; i < 50; ++i) {
      const Vec2 u = uniform2(randomKey(4), i, 0);
      const float z = 2.0f * u.x - 1.0f;
      const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
      const Vec3 onSphere(r * std::cos(kTwoPi * u.y), r * std::sin(kTwoPi * u.y), z);
      AreaLight light = sphereLight(Vec3(0.0f), 1.0f);
      light.twoSided = twoSided;
      expectSound(light, onSphere, "on the sphere");
    }
  }
}

TEST(LightExtremes, FarAndTiny) {
  for (const float size : {1e-10f, 1e-6f, 1e-3f}) {
    for (const float distance : {1.0f, 1e3f, 1e6f}) {
      const Vec3 point(0.3f * distance, -distance, 0.1f * distance);
      const double cosine = 1.0 / std::sqrt(1.0 + 0.1);
      const double patch =
          square(double(size) / distance) * cosine * cosine * cosine;  // of a unit area at the origin
      const auto check = [&](const Light& light, double area, const char* name) {
        expectSound(light, point, name);
        // The light begins at the origin, so that the next term is of order size / distance; results are
        // float.
        const double margin = 2e-6 + 3.0 * double(size) / double(distance);
        EXPECT_NEAR(LightSampler(light, point).solidAngle() / (area * patch), 1.0, margin)
            << name << " of " << size;
        LightSample sample;
        ASSERT_TRUE(sampleLight(light, point, {0.3f, 0.6f}, sample)) << name << " of " << size;
        EXPECT_NEAR(sample.weight.r / (area * patch), 1.0, margin) << name << " of " << size;
      };
      check(ceilingLight(0, size, 0, size, 0), 1.0, "rectangle");
      check(polygonLight({{0, 0, 0}, {size, 0, 0}, {1.5f * size, 0, size}, {0.5f * size, 0, size}}), 1.0,
            "parallelogram");
      check(triangleLight({emitterTriangle({0, 0, 0}, {size, 0, 0}, {0, 0, size})}), 0.5, "triangle");
      check(discLight(Vec3(0.0f), {0, -1, 0}, size), kPiD, "disc");
      // Seen under no cosine of its own.
      check(sphereLight(Vec3(0.0f), size), kPiD / cosine, "sphere");
    }
  }
}

TEST(LightExtremes, DegeneratePieces) {
  const Vec3 point(0.2f, -1, 0.3f);
  const EmitterTriangle good = emitterTriangle({0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  const EmitterTriangle line = emitterTriangle({0, 0, 0}, {1, 0, 0}, {2, 0, 0});
  const EmitterTriangle dot = emitterTriangle({1, 0, 1}, {1, 0, 1}, {1, 0, 1});
  const EmitterTriangle sliver = emitterTriangle({0, 0, 0}, {1, 0, 0}, {0.5f, 0, 1e-7f});

  LightSample sample;
  EXPECT_FALSE(sampleLight(triangleLight({line}), point, {0.5f, 0.5f}, sample));
  EXPECT_FALSE(sampleLight(triangleLight({dot}), point, {0.5f, 0.5f}, sample));
  EXPECT_FALSE(sampleLight(triangleLight({}), point, {0.5f, 0.5f}, sample)) << "no piece at all";
  EXPECT_FALSE(sampleLight(sphereLight(Vec3(0.0f), 0.0f), point, {0.5f, 0.5f}, sample));
  EXPECT_FALSE(sampleLight(discLight(Vec3(0.0f), {0, -1, 0}, 0.0f), point, {0.5f, 0.5f}, sample));
  EXPECT_FALSE(sampleLight(VolumicSphereLight{{}, Rgb(1.0f)}, point, {0.5f, 0.5f}, sample));
  for (const EmitterTriangle& t : {line, dot, sliver})
    expectSound(triangleLight({t}), point, "degenerate triangle");

  // Beside a good piece they must neither be chosen nor change its light.
  const float alone = irradianceBound(triangleLight({good}), point);
  EXPECT_GT(alone, 0.0f);
  const Estimate expected = irradiance(triangleLight({good}), point, {0, 1, 0}, 32);
  for (const std::size_t copies : {1U, 20U}) {  // chosen by solid angle; by area
    std::vector<EmitterTriangle> triangles(copies, line);
    triangles.push_back(good);
    triangles.insert(triangles.end(), copies, dot);
    const Estimate mean = irradiance(triangleLight(triangles), point, {0, 1, 0}, 32);
    EXPECT_NEAR(mean.mean, expected.mean, tolerance(mean))
        << copies << " degenerate triangles on either side";
  }
}

TEST(LightExtremes, PolygonWithRepeatedAndCollinearCorners) {
  const Vec3 point(0.2f, -1, 0.3f);
  const std::vector<Vec3> square = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}};
  const std::vector<Vec3> wordy = {{0, 0, 0}, {0.5f, 0, 0}, {1, 0, 0}, {1, 0, 0},
                                   {1, 0, 1}, {0.5f, 0, 1}, {0, 0, 1}, {0, 0, 0}};
  const Estimate estimate = irradiance(polygonLight(wordy), point, {0, 1, 0});
  EXPECT_NEAR(estimate.mean, lambertIrradiance(square, point, {0, 1, 0}), tolerance(estimate));
  expectSound(polygonLight(wordy), point, "polygon with repeated corners");
}

TEST(LightExtremes, DiracLightsAtAndNearThePoint) {
  const Vec3 point(0.25f, 0.5f, 0.75f);
  for (const Vec3& offset : {Vec3(0.0f), Vec3(0, 3e-8f, 0), Vec3(1e6f, 0, 0)}) {
    expectSound(PointLight{point + offset, Rgb(1.0f)}, point, "point light");
    expectSound(SpotLight{point + offset, {0, -1, 0}, Rgb(1.0f), 0.9f, 0.9f}, point, "spot with equal cones");
    expectSound(VolumicSphereLight{{point + offset, point}, Rgb(1.0f)}, point, "volumic sphere");
  }
  // Distances whose square a float cannot hold.
  for (const float distance : {1e-40f, 1e-30f, 1e-20f}) {
    expectSound(PointLight{{distance, 0, 0}, Rgb(1.0f)}, Vec3(0.0f), "point light at the smallest distances");
  }
  for (const double cosHalf : {1.0, 1.0 - 0x1p-53, 1.0 - 1e-9, 0.5, 0.0, -0.5, -1.0}) {
    expectSound(DirectionalLight{{0, 1, 0}, Rgb(1.0f), cosHalf}, point, "directional light");
    expectSound(DirectionalLight{{0, 0, -1}, Rgb(1.0f), cosHalf}, point,
                "directional light along the frame's pole");
  }
}

TEST(LightExtremes, PolygonWithOtherPiecesIsRefused) {
  AreaLight light = ceilingLight(0, 1, 0, 1, 1);
  light.spheres.push_back({Vec3(0.0f), 1.0f});
  EXPECT_THROW(light.finish(), std::logic_error);
}

// What a scene's radiances are multiplied by when they are shown: a float, too.
TEST(LightsExtremes, TheScaleOfRadiancesIsFiniteWhateverShines) {
  for (const char* radiance : {"3.4e38", "1e38", "1e-30", "1e-44"}) {
    const auto description = parseSceneToml(
        fmt::format("version = 1\n[camera]\n[material.a]\n[[shape]]\ntype = \"sphere\"\nmaterial = "
                    "\"a\"\n[[light]]\ntype = \"environment\"\nradiance = [{0}, {0}, {0}]\n",
                    radiance),
        "scene.toml");
    ASSERT_TRUE(description) << description.error().message();
    const auto scene = Scene::compile(*description);
    ASSERT_TRUE(scene) << scene.error().message();
    const float scale = (*scene)->normalisation.radianceScale();
    EXPECT_TRUE(std::isnormal(scale)) << radiance << " " << scale;
  }
}

}  // namespace
}  // namespace lightvane
