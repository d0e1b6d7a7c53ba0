#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/lights_support.h"

namespace lightvane {
namespace {

using namespace lights_test;

const Vec3 kUp(0, 1, 0);

// Closed forms. "Howell" is J. R. Howell, A Catalog of Radiation Heat Transfer Configuration Factors; a
// factor F from an element to a source of radiance L means an irradiance of pi L F.

TEST(AreaLightIrradiance, SphereAboveTheHorizon) {
  for (const float radius : {1e-4f, 0.1f, 0.5f, 0.7f}) {
    for (const double tilt : {0.0, 0.4, 0.7}) {
      const double distance = 1.25;
      const Light light = sphereLight(Vec3(Vec3d(std::sin(tilt), std::cos(tilt), 0.0) * distance), radius);
      if (std::asin(double(radius) / distance) + tilt > 0.5 * kPiD) continue;  // cut by the horizon
      const Estimate estimate = irradiance(light, Vec3(0.0f), kUp);
      const double expected = kPiD * square(double(radius) / distance) * std::cos(tilt);
      EXPECT_NEAR(estimate.mean, expected, tolerance(estimate)) << "radius " << radius << ", tilt " << tilt;
    }
  }
}

TEST(AreaLightIrradiance, InsideATwoSidedSphereIsThatOfAFullHemisphere) {
  for (const Vec3& point : {Vec3(0.0f), Vec3(0.3f, -0.5f, 0.6f), Vec3(0, 0.999f, 0)}) {
    const Estimate estimate = irradiance(sphereLight(Vec3(0.0f), 1.0f, true), point, kUp);
    EXPECT_NEAR(estimate.mean, kPiD, tolerance(estimate)) << "at height " << point.y;
    LightSample sample;
    EXPECT_FALSE(sampleLight(sphereLight(Vec3(0.0f), 1.0f), point, {0.5f, 0.5f}, sample))
        << "the inside is dark";
  }
}

TEST(AreaLightIrradiance, DiscFacing) {
  for (const float height : {0.01f, 0.3f, 1.0f, 50.0f}) {
    const Light light = discLight({0, height, 0}, {0, -1, 0}, 0.75f);
    const Estimate estimate = irradiance(light, Vec3(0.0f), kUp);
    const double rSquared = square(0.75);
    const double expected = kPiD * rSquared / (rSquared + square(double(height)));
    EXPECT_NEAR(estimate.mean, expected, tolerance(estimate)) << "height " << height;
  }
}

// Howell B-12: an element parallel to a disc, off its axis by l.
TEST(AreaLightIrradiance, DiscParallelOffItsAxis) {
  for (const double l : {0.2, 0.7, 1.0, 3.0}) {
    const double h = 0.25, r = 0.75;
    const Light light = discLight(Vec3(Vec3d(l, h, 0.0)), {0, -1, 0}, static_cast<float>(r));
    const Estimate estimate = irradiance(light, Vec3(0.0f), kUp, 256);
    const double H = h / l, R = r / l, Z = 1.0 + H * H + R * R;
    const double expected = kPiD * 0.5 * (1.0 - (1.0 + H * H - R * R) / std::sqrt(Z * Z - 4.0 * R * R));
    EXPECT_NEAR(estimate.mean, expected, tolerance(estimate)) << "off by " << l;
  }
}

// Howell B-3 (parallel) and B-4 (perpendicular): a rectangle a x b with a corner on the element's normal at
// distance c.
TEST(AreaLightIrradiance, RectangleAboveItsCorner) {
  for (const double c : {0.05, 0.5, 2.0, 20.0}) {
    const double a = 1.5, b = 0.75;
    const Light light =
        ceilingLight(0.0f, static_cast<float>(a), 0.0f, static_cast<float>(b), static_cast<float>(c));
    ASSERT_TRUE(std::get<AreaLight>(light).rectangle);
    const double X = a / c, Y = b / c;
    const double parallel = 0.5 * (X / std::sqrt(1 + X * X) * std::atan(Y / std::sqrt(1 + X * X)) +
                                   Y / std::sqrt(1 + Y * Y) * std::atan(X / std::sqrt(1 + Y * Y)));
    const Estimate facing = irradiance(light, Vec3(0.0f), kUp);
    EXPECT_NEAR(facing.mean, parallel, tolerance(facing)) << "parallel at " << c;

    // An element that looks along x, with the rectangle's side b before it: all of the rectangle is above its
    // horizon.
    const double perpendicular =
        0.5 * (std::atan(b / c) - 1.0 / std::sqrt(1 + X * X) * std::atan(Y / std::sqrt(1 + X * X)));
    const Estimate aside = irradiance(light, Vec3(0.0f), {1, 0, 0});
    EXPECT_NEAR(aside.mean, perpendicular, tolerance(aside)) << "perpendicular at " << c;
  }
}

TEST(AreaLightIrradiance, PolygonsAgreeWithLambert) {
  const std::vector<std::vector<Vec3>> outlines = {
      {{0.2f, 1, 0.1f}, {1.2f, 1.5f, 0.1f}, {0.3f, 1.2f, 0.9f}},                 // a triangle
      {{-1, 2, -1}, {1, 2, -1}, {1.5f, 2, 1}, {-1.5f, 2, 1}},                    // a trapezium
      {{-1, 2, -1}, {0, 2, -1.5f}, {1, 2, -1}, {1.25f, 2, 0.5f}, {0, 2, 1.5f}},  // a pentagon
      {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}},                              // a square
  };
  for (const std::vector<Vec3>& outline : outlines) {
    for (const Vec3& point : {Vec3(0.1f, 0, 0.2f), Vec3(-1, -1, 2), Vec3(0, -5, 0)}) {
      const Vec3 normal = glm::normalize(Vec3(0.1f, 1, -0.1f));
      for (const bool reversed : {false, true}) {
        const std::vector<Vec3> corners =
            reversed ? std::vector<Vec3>(outline.rbegin(), outline.rend()) : outline;
        const Estimate estimate = irradiance(polygonLight(corners, true), point, normal);
        EXPECT_NEAR(estimate.mean, lambertIrradiance(outline, point, normal), tolerance(estimate))
            << outline.size() << " corners, point at height " << point.y;
        // The same light as separate triangles, without the outline.
        AreaLight loose = polygonLight(corners, true);
        loose.polygon.clear();
        loose.finish();
        const Estimate pieces = irradiance(loose, point, normal);
        EXPECT_NEAR(pieces.mean, lambertIrradiance(outline, point, normal), tolerance(pieces))
            << outline.size() << " corners as pieces, point at height " << point.y;
      }
    }
  }
}

TEST(AreaLightIrradiance, ManyTrianglesAreChosenByArea) {
  // A grid of 2 x 32 triangles that makes the unit square at height 1: more than are chosen by solid angle.
  std::vector<EmitterTriangle> triangles;
  for (int i = 0; i < 32; ++i) {
    const float x0 = static_cast<float>(i * i) / 1024.0f;  // of many areas
    const float x1 = static_cast<float>((i + 1) * (i + 1)) / 1024.0f;
    triangles.push_back(emitterTriangle({x0, 1, 0}, {x1, 1, 0}, {x1, 1, 1}));
    triangles.push_back(emitterTriangle({x0, 1, 0}, {x1, 1, 1}, {x0, 1, 1}));
  }
  const Light grid = triangleLight(triangles);
  EXPECT_NEAR(std::get<AreaLight>(grid).totalArea, 1.0, 1e-6);
  const std::vector<Vec3> outline = {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};
  const Light square = polygonLight(outline);
  for (const Vec3& point : {Vec3(0.0f), Vec3(0.5f, 0.95f, 0.5f), Vec3(3, 0, 0)}) {
    const Estimate estimate = irradiance(grid, point, kUp, 256);
    EXPECT_NEAR(estimate.mean, lambertIrradiance(outline, point, kUp), tolerance(estimate))
        << "height " << point.y;
    EXPECT_NEAR(LightSampler(grid, point).solidAngle(), LightSampler(square, point).solidAngle(), 1e-5f);
  }
}

TEST(AreaLightIrradiance, PiecesOfAllKindsAdd) {
  AreaLight light = triangleLight({emitterTriangle({-2, 2, 0}, {-1, 2, 0}, {-1, 2, 1})});
  light.spheres.push_back({{0, 3, 0}, 0.5f});
  light.discs.push_back({{2, 2, 0}, {0, -1, 0}, 0.5f});
  light.finish();
  const std::vector<Vec3> triangle = {{-2, 2, 0}, {-1, 2, 0}, {-1, 2, 1}};
  const Estimate disc = irradiance(discLight({2, 2, 0}, {0, -1, 0}, 0.5f), Vec3(0.0f), kUp, 256);
  const double expected = lambertIrradiance(triangle, Vec3(0.0f), kUp) + kPiD / 36.0 + disc.mean;
  const Estimate estimate = irradiance(light, Vec3(0.0f), kUp, 256);
  EXPECT_NEAR(estimate.mean, expected, tolerance(estimate) + tolerance(disc));

  // Twenty spheres: by area.
  AreaLight many;
  many.radiance = Rgb(1.0f);
  double sum = 0.0;
  for (int i = 0; i < 20; ++i) {
    const EmitterSphere sphere{{static_cast<float>(i) - 10.0f, 4, 0}, 0.02f * static_cast<float>(i + 1)};
    many.spheres.push_back(sphere);
    const double distance = glm::length(Vec3d(sphere.center));
    sum += kPiD * square(double(sphere.radius) / distance) * 4.0 / distance;
  }
  many.finish();
  const Estimate byArea = irradiance(many, Vec3(0.0f), kUp, 256);
  EXPECT_NEAR(byArea.mean, sum, tolerance(byArea));
}

TEST(AreaLightSides, OnlyTheFrontEmitsUnlessTwoSided) {
  const Vec3 below(0.3f, 0, 0.3f);
  const Vec3 above(0.3f, 2, 0.3f);
  const auto reaches = [](const AreaLight& light, const Vec3& point) {
    LightSample sample;
    const bool reached = sampleLight(light, point, {0.4f, 0.6f}, sample);
    EXPECT_EQ(reached, lightPdf(light, point, {0, point.y < 1 ? 1.0f : -1.0f, 0}, 0, 1, 1) > 0.0f);
    const Light variant = light;
    EXPECT_EQ(reached, LightSampler(variant, point).solidAngle() > 0.0f);
    EXPECT_EQ(reached, irradianceBound(light, point) > 0.0f);
    return reached;
  };
  const auto check = [&](AreaLight light, const char* what) {
    EXPECT_TRUE(reaches(light, below)) << what;
    EXPECT_FALSE(reaches(light, above)) << what;
    light.twoSided = true;
    EXPECT_TRUE(reaches(light, below)) << what;
    EXPECT_TRUE(reaches(light, above)) << what;
  };
  check(ceilingLight(0, 1, 0, 1, 1), "rectangle");
  check(regularCeilingLight(5, 1, 1), "pentagon");
  check(triangleLight({emitterTriangle({0, 1, 0}, {1, 1, 0}, {0, 1, 1})}), "triangle");
  check(discLight({0, 1, 0}, {0, -1, 0}, 1), "disc");
}

struct NamedLight {
  std::string name;
  Light light;
  const AreaLight& area() const { return std::get<AreaLight>(light); }
};
// About the height 1, seen from below; none contains the points the tests use.
std::vector<NamedLight> lightsOfAllKinds() {
  std::vector<NamedLight> lights = {
      {"rectangle", ceilingLight(-0.5f, 0.5f, -0.25f, 0.25f, 1)},
      {"pentagon", regularCeilingLight(5, 0.5f, 1)},
      {"polygon of 40 corners", regularCeilingLight(40, 0.5f, 1)},
      {"triangle", triangleLight({emitterTriangle({0, 1, 0}, {0.5f, 1, 0}, {0, 1.25f, 0.5f})}, true)},
      {"sphere", sphereLight({0, 1, 0}, 0.25f)},
      {"disc", discLight({0, 1, 0}, {0.3f, -1, 0}, 0.5f)},
      {"icosahedron", triangleLight(icosahedron({0, 1, 0}, 0.3f))},
  };
  AreaLight mixed = triangleLight({emitterTriangle({-1, 1, 0}, {-0.5f, 1, 0}, {-1, 1, 0.5f})});
  mixed.spheres.push_back({{0, 1, 0}, 0.2f});
  mixed.discs.push_back({{1, 1, 0}, {0, -1, 0}, 0.3f});
  mixed.finish();
  lights.push_back({"triangle, sphere and disc", mixed});
  return lights;
}
const Vec3 kLitPoints[] = {
    {0, 0, 0}, {0.5f, 0.25f, -0.75f}, {0.1f, 0.7f, 0.1f}, {2, 0.9f, 0}, {-0.3f, -30, 0.2f}};

TEST(AreaLightPdf, MeanOfItsReciprocalIsTheSolidAngle) {
  for (const NamedLight& named : lightsOfAllKinds()) {
    const auto& [name, light] = named;
    const AreaLight& area = named.area();
    for (const Vec3& point : kLitPoints) {
      const LightSampler sampler(light, point);
      const Estimate mean = integrate(96, 3, [&](const Vec2& u) {
        LightSample sample;
        return sampler.sample(u, sample) ? 1.0 / sample.pdf : 0.0;
      });
      // 1e-5 of what is expected: float pdf; 1e-3 more: the disc's quadrature in grazing view.
      EXPECT_NEAR(mean.mean, sampler.solidAngle(),
                  tolerance(mean) + (area.discs.empty() ? 1e-5 : 1e-3) * mean.mean)
          << name << " from height " << point.y;
    }
  }
}

// Which piece the sample is on: that whose surface passes nearest to it.
std::uint32_t pieceAt(const AreaLight& light, const Vec3d& position) {
  std::uint32_t best = 0;
  double least = kInfinity;
  const auto offer = [&](std::size_t piece, double distance) {
    if (distance < least) {
      least = distance;
      best = static_cast<std::uint32_t>(piece);
    }
  };
  std::size_t piece = 0;
  for (const EmitterTriangle& t : light.triangles) {
    const Vec3d n = glm::cross(Vec3d(t.b) - Vec3d(t.a), Vec3d(t.c) - Vec3d(t.a));
    const Vec3d p = position - Vec3d(t.a);
    const double v = glm::dot(glm::cross(p, Vec3d(t.c) - Vec3d(t.a)), n) / glm::dot(n, n);
    const double w = glm::dot(glm::cross(Vec3d(t.b) - Vec3d(t.a), p), n) / glm::dot(n, n);
    const double outside = std::max({0.0, -v, -w, v + w - 1.0});
    offer(piece++, outside + std::abs(glm::dot(p, n)) / glm::length(n));
  }
  for (const EmitterSphere& s : light.spheres) {
    offer(piece++, std::abs(glm::length(position - Vec3d(s.center)) - double(s.radius)));
  }
  for (const EmitterDisc& d : light.discs) {
    const Vec3d p = position - Vec3d(d.center);
    offer(piece++, std::abs(glm::dot(p, Vec3d(d.normal))) + std::max(0.0, glm::length(p) - double(d.radius)));
  }
  EXPECT_LT(least, 1e-5) << "the sample is on no piece";
  return best;
}

TEST(AreaLightPdf, IsBitForBitThatOfTheSample) {
  for (const NamedLight& named : lightsOfAllKinds()) {
    const auto& [name, light] = named;
    const AreaLight& area = named.area();
    for (const Vec3& point : kLitPoints) {
      const LightSampler sampler(light, point);
      int mismatches = 0;
      int samples = 0;
      integrate(24, 4, [&](const Vec2& u) {
        LightSample sample;
        if (!sampler.sample(u, sample)) return 0.0;
        ++samples;
        const Vec3d position = Vec3d(point) + Vec3d(sample.direction) * double(sample.distance);
        const std::uint32_t piece = pieceAt(area, position);
        if (lightPdf(light, point, sample.direction, piece, sample.distance, 1.0f) != sample.pdf)
          ++mismatches;
        EXPECT_EQ(sample.weight.r, area.radiance.r / sample.pdf);
        return 0.0;
      });
      EXPECT_GT(samples, 0) << name;
      // Where pieces meet, rounding may attribute a sample to the neighbour.
      EXPECT_LE(mismatches, area.pieceCount() > 1 ? 2 : 0) << name << " from height " << point.y;
    }
  }
}

// The rectangle's are worked on side by side, all others one by one.
TEST(LightSampleBatch, GivesTheBytesOfOneByOne) {
  std::vector<NamedLight> lights = lightsOfAllKinds();
  for (const auto& [name, light] : lights) {
    for (const Vec3& point : kLitPoints) {
      const LightSampler sampler(light, point);
      for (const int count : {1, 7, LightSampleBatch::kCount}) {
        LightSampleBatch batch;
        const RandomKey key = randomKey(7).with(static_cast<std::uint32_t>(count));
        for (std::uint32_t i = 0; i < LightSampleBatch::kCount; ++i) {
          batch.places.u[i] = uniform(key, i, 0);
          batch.places.v[i] = uniform(key, i, 1);
        }
        sampler.sample(count, batch);
        for (int i = 0; i < LightSampleBatch::kCount; ++i) {
          LightSample one;
          const bool reached = i < count && sampler.sample({batch.places.u[i], batch.places.v[i]}, one);
          ASSERT_EQ(batch.reached[i], reached) << name << ", sample " << i << " of " << count;
          if (!reached) continue;
          const SphericalSampleBatch& p = batch.places;
          const Vec3 direction(p.directionX[i], p.directionY[i], p.directionZ[i]);
          ASSERT_EQ(direction, one.direction) << name << ", sample " << i << " of " << count;
          ASSERT_EQ(p.distance[i], one.distance) << name << ", sample " << i << " of " << count;
          ASSERT_EQ(batch.weight[i], one.weight) << name << ", sample " << i << " of " << count;
        }
      }
    }
  }
}

// Each from a point of its own: before and behind the light, in its plane, very near and very far.
TEST(LightSampleBatch, FromEachPointGivesTheBytesOfOneByOne) {
  std::vector<NamedLight> lights = lightsOfAllKinds();
  lights.push_back({"point", PointLight{{0.1f, 0.7f, 0.2f}, Rgb(3.0f)}});
  for (const auto& [name, light] : lights) {
    for (std::uint32_t round = 0; round < 40; ++round) {
      const RandomKey key = randomKey(8).with(round);
      SphericalPointBatch points;
      LightSampleBatch batch;
      std::array<Vec3, LightSampleBatch::kCount> normals;
      for (std::uint32_t i = 0; i < LightSampleBatch::kCount; ++i) {
        const float scale = std::exp2(40.0f * uniform(key, i, 2) * uniform(key, i, 3) - 8.0f);
        const auto coordinate = [&](std::uint32_t axis) {
          return scale * (uniform(key, i, 4 + axis) - 0.5f);
        };
        points.x[i] = coordinate(0);
        points.y[i] = i % 4 == 3 ? 1.0f : coordinate(1);
        points.z[i] = coordinate(2);
        normals[i] = Vec3(0, 1, 0);
        batch.places.u[i] = uniform(key, i, 0);
        batch.places.v[i] = uniform(key, i, 1);
      }
      const int count = round % 2 == 0 ? LightSampleBatch::kCount : 5;
      const LightSampleBatch asked = batch;
      sampleFromEach(light, count, points, normals, batch);
      for (int i = 0; i < LightSampleBatch::kCount; ++i) {
        const Vec3 point(points.x[i], points.y[i], points.z[i]);
        LightSample one;
        const LightSampler sampler(light, point, normals[static_cast<std::size_t>(i)]);
        const bool reached = i < count && sampler.sample({asked.places.u[i], asked.places.v[i]}, one);
        ASSERT_EQ(batch.reached[i], reached)
            << name << ", from " << point.x << " " << point.y << " " << point.z;
        if (!reached) continue;
        const LightSample same = batch.at(i);
        ASSERT_EQ(same.direction, one.direction) << name;
        ASSERT_EQ(same.distance, one.distance) << name;
        ASSERT_EQ(same.weight, one.weight) << name;
        ASSERT_EQ(same.pdf, one.pdf) << name;
      }
    }
  }
}

TEST(AreaLightStrata, SixteenStrataBeatSixteenSamples) {
  // The standard deviation of a 16-sample estimate of E, with u stratified 4 x 4 and with u independent. For
  // a smooth integrand the ratio is about 1 / 4; pieces chosen by area, and the kink where u.x goes from one
  // piece to the next, cost some of it.
  constexpr int kTrials = 400;
  for (const NamedLight& named : lightsOfAllKinds()) {
    const auto& [name, light] = named;
    const AreaLight& area = named.area();
    const Vec3 point(0.1f, 0.4f, -0.1f);
    const LightSampler sampler(light, point);
    const Vec3 normal = glm::normalize(Vec3(0.5f, 1, 0.25f));
    const auto spread = [&](bool stratified) {
      double sum = 0.0, sumOfSquares = 0.0;
      for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
        double estimate = 0.0;
        for (std::uint32_t i = 0; i < 16; ++i) {
          Vec2 u = uniform2(randomKey(12).with(trial), i, 0);
          if (stratified) u = (Vec2(i % 4, i / 4) + u) * 0.25f;
          LightSample sample;
          if (!sampler.sample(glm::min(u, Vec2(1.0f - 0x1p-24f)), sample)) continue;
          estimate +=
              double(sample.weight.x) * std::max(0.0, double(glm::dot(sample.direction, normal))) / 16.0;
        }
        sum += estimate;
        sumOfSquares += estimate * estimate;
      }
      return std::sqrt(std::max(0.0, sumOfSquares / kTrials - square(sum / kTrials)));
    };
    const bool smooth = area.pieceCount() == 1 || (!area.polygon.empty() && area.polygon.size() <= 18);
    const double ratio = spread(true) / spread(false);
    RecordProperty("ratio_" + name, std::to_string(ratio));
    EXPECT_LT(ratio, smooth ? 0.35 : 0.75) << name;
  }
}

TEST(AreaLightScale, PowersOfTwoChangeNoBit) {
  for (const int k : {-20, -10, 10, 20}) {
    const float scale = std::ldexp(1.0f, k);
    for (const NamedLight& named : lightsOfAllKinds()) {
      const auto& [name, light] = named;
      const AreaLight& area = named.area();
      AreaLight scaledArea = area;
      for (EmitterTriangle& t : scaledArea.triangles) {
        t = {t.a * scale, t.b * scale, t.c * scale, t.normal, t.area * scale * scale};
      }
      for (EmitterSphere& s : scaledArea.spheres) s = {s.center * scale, s.radius * scale};
      for (EmitterDisc& d : scaledArea.discs) d = {d.center * scale, d.normal, d.radius * scale};
      for (Vec3& v : scaledArea.polygon) v *= scale;
      scaledArea.finish();
      const Light scaled = scaledArea;
      for (const Vec3& point : kLitPoints) {
        const LightSampler sampler(light, point);
        const LightSampler scaledSampler(scaled, point * scale);
        EXPECT_EQ(sampler.solidAngle(), scaledSampler.solidAngle());
        EXPECT_EQ(irradianceBound(light, point), irradianceBound(scaled, point * scale));
        integrate(8, 10, [&](const Vec2& u) {
          LightSample a, b;
          const bool reached = sampler.sample(u, a);
          EXPECT_EQ(reached, scaledSampler.sample(u, b)) << name << " times 2^" << k;
          if (!reached) return 0.0;
          EXPECT_EQ(a.direction, b.direction) << name << " times 2^" << k;
          EXPECT_EQ(a.weight, b.weight) << name << " times 2^" << k;
          EXPECT_EQ(a.pdf, b.pdf) << name << " times 2^" << k;
          EXPECT_EQ(a.distance * scale, b.distance) << name << " times 2^" << k;
          return 0.0;
        });
      }
    }
  }
}

TEST(AreaLightRectangle, IsRecognisedThroughRoundingOnly) {
  const auto isRectangle = [](const std::vector<Vec3>& corners) { return polygonLight(corners).rectangle; };
  const Frame frame = Frame::aboutNormal(glm::normalize(Vec3(1, -2, 0.3f)));
  const auto at = [&](float x, float y) { return Vec3(0.5f) + frame.toWorld({x, y, 0}); };
  EXPECT_TRUE(isRectangle({at(0, 0), at(0.02f, 0), at(0.02f, 0.01f), at(0, 0.01f)}))
      << "turned, rounded to float";
  EXPECT_FALSE(isRectangle({at(0, 0), at(1, 0), at(1.01f, 1), at(0.01f, 1)})) << "a parallelogram";
  EXPECT_FALSE(isRectangle({at(0, 0), at(1, 0), at(0.9f, 1), at(0.1f, 1)})) << "a trapezium";
  EXPECT_FALSE(isRectangle({at(0, 0), at(1, 0), at(1.2f, 1.2f), at(0, 1)})) << "one right angle";
  EXPECT_FALSE(isRectangle({at(0, 0), at(1, 0), at(1, 1)})) << "a triangle";
  EXPECT_FALSE(isRectangle({at(0, 0), at(0, 0), at(1, 1), at(1, 1)})) << "without area";
}

TEST(IrradianceBound, IsABoundAndNotTooFar) {
  for (const NamedLight& named : lightsOfAllKinds()) {
    const auto& [name, light] = named;
    for (const Vec3& point : kLitPoints) {
      const LightSampler sampler(light, point);
      Vec3d mean(0.0);
      integrate(32, 11, [&](const Vec2& u) {
        LightSample sample;
        if (sampler.sample(u, sample)) mean += Vec3d(sample.direction) * double(sample.weight.x);
        return 0.0;
      });
      // The orientation that gets the most when all of the light is above its horizon.
      const Estimate most = irradiance(light, point, Vec3(glm::normalize(mean)), 64);
      const float bound = irradianceBound(light, point);
      EXPECT_GE(bound, most.mean - tolerance(most)) << name << " from height " << point.y;
      if (point.y < -10.0f) {
        // Far away only the shape is lost: closed surfaces count their back, the three pieces their span.
        EXPECT_LT(bound, 5.0 * most.mean) << name;
      }
    }
  }
}

// A light that is never chosen where it reaches would be missing; one chosen where it does not, wasted.
TEST(LightImportance, IsPositiveWhereLightArrivesAndZeroBelowTheHorizon) {
  int reached = 0, below = 0;
  for (const NamedLight& named : lightsOfAllKinds()) {
    const auto& [name, light] = named;
    for (const Vec3& point : kLitPoints) {
      const LightSampler sampler(light, point);
      for (std::uint32_t n = 0; n < 64; ++n) {
        const Vec2 u = uniform2(randomKey(8), n, 0);
        const float z = 2.0f * u.x - 1.0f;
        const float r = std::sqrt(1.0f - z * z);
        const Vec3 normal(r * std::cos(kTwoPi * u.y), r * std::sin(kTwoPi * u.y), z);
        bool arrives = false;
        float highest = -1.0f;
        integrate(8, 11, [&](const Vec2& place) {
          LightSample sample;
          if (sampler.sample(place, sample)) {
            highest = std::max(highest, glm::dot(sample.direction, normal));
            arrives = arrives || (glm::dot(sample.direction, normal) > 0.0f && sample.weight.x > 0.0f);
          }
          return 0.0;
        });
        const float importance = lightImportance(light, point, normal);
        if (arrives) {
          EXPECT_GT(importance, 0.0f) << name << " from height " << point.y;
          EXPECT_LE(importance, irradianceBound(light, point));
        }
        // Boxes about lights, and angles about boxes, count a little more than there is.
        if (importance == 0.0f) {
          EXPECT_LE(highest, 0.0f) << name;
        }
        reached += arrives;
        below += importance == 0.0f;
      }
    }
  }
  EXPECT_GT(reached, 1000);
  EXPECT_GT(below, 300);
}

}  // namespace
}  // namespace lightvane
