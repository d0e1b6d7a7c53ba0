#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/trace/scene_builder.h"

// What ClearSpace says is held against rays: where it says that two points see each other, they do.

namespace lightvane {
namespace {

using namespace trace_test;

constexpr float kSpaceMargin = 0x1p-19f;  // half the offset of a surface whose coordinates reach 1

Vec3 inBall(RandomKey key, std::uint32_t i, const Vec3& centre, float radius) {
  const Vec3d cube = 2.0 * randomPoint(key, i, 0) - 1.0;
  return centre + radius * Vec3(cube);
}

struct Verdicts {
  int pairs = 0;  ///< that see each other
  int told = 0;   ///< of which the space holds both
  int wrong = 0;  ///< that it holds, and that do not see each other
};

/// Of random pairs of points around the space's centre, on either side of every surface.
Verdicts judge(const TracedScene& traced, const ClearSpace& space, float reach, RandomKey key, int pairs) {
  Verdicts verdicts;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(pairs); ++i) {
    const Vec3 a = inBall(key, 2 * i, space.centre(), reach);
    const Vec3 b = inBall(key, 2 * i + 1, space.centre(), reach);
    const float length = glm::length(b - a);
    const bool sees = !traced.tracer->occluded(Ray{a, (b - a) / length, 0.0f, length});
    const bool holds = space.holds(a) && space.holds(b);
    verdicts.pairs += sees ? 1 : 0;
    verdicts.told += sees && holds ? 1 : 0;
    verdicts.wrong += !sees && holds ? 1 : 0;
  }
  return verdicts;
}

TEST(ClearSpace, NeverHoldsWhatARayFindsHidden) {
  for (const int count : {1, 4, 16, 64, 1024}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f));
    const RandomKey shapes = randomKey(301).with(static_cast<std::uint32_t>(count));
    const double size = 1.0 / std::cbrt(count);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
      const Vec3d place = randomPoint(shapes, i, 0);
      const Vec3d one = randomPoint(shapes, i, 3) - 0.5, other = randomPoint(shapes, i, 6) - 0.5;
      if (i % 4 == 1) {
        builder.sphere(place, 0.3 * size * randomPoint(shapes, i, 9).x, white);
      } else if (i % 4 == 2) {
        builder.disc(place, one, 0.5 * size, white);
      } else {
        builder.polygon({place, place + size * one, place + size * other}, white);
      }
    }
    const TracedScene traced = builder.compile();
    int told = 0, held = 0;
    for (std::uint32_t c = 0; c < 200; ++c) {
      const RandomKey key = randomKey(302).with(c);
      const Vec3 centre(traced.point(randomPoint(key, 0, 0)));
      const float radius = 0.3f * uniform(key, 0, 3);
      const ClearSpace space = traced.tracer->clearSpace(centre, radius, kSpaceMargin);
      EXPECT_LE(space.radius(), radius);
      const Verdicts verdicts = judge(traced, space, 1.2f * radius, key.with(1u), 200);
      EXPECT_EQ(verdicts.wrong, 0) << count << " shapes, centre " << c;
      told += verdicts.told;
      held += space.radius() > 0.0f ? 1 : 0;
    }
    EXPECT_GT(held, 190) << count << " shapes";
    EXPECT_GT(told, 500) << count << " shapes";
  }
}

// A floor of many triangles, under walls: one plane each, and nothing else in the way.
TEST(ClearSpace, OfARoomIsTheRoom) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  constexpr int kTiles = 20;
  for (int i = 0; i < kTiles; ++i) {
    for (int j = 0; j < kTiles; ++j) {
      const double x = double(i) / kTiles, z = double(j) / kTiles;
      builder.rectangle({x, 0, z}, {0, 0, 1.0 / kTiles}, {1.0 / kTiles, 0, 0}, white);
    }
  }
  builder.rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, white);
  builder.rectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, white);
  builder.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, white);
  builder.rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, white);
  builder.rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, white);
  const TracedScene traced = builder.compile();
  // As a vector's rays begin: twice the offset above the floor.
  const Vec3 centre = traced.point({0.31, 0, 0.22}) + Vec3(0, 4.0f * kSpaceMargin, 0);
  const float radius = 2.0f / static_cast<float>(traced.unitLength());
  const ClearSpace space = traced.tracer->clearSpace(centre, radius, kSpaceMargin);
  EXPECT_EQ(space.radius(), radius);
  EXPECT_EQ(space.planes().size(), 6u);
  const RandomKey key = randomKey(303);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Vec3d inside = 0.001 + 0.998 * randomPoint(key, i, 0);
    EXPECT_TRUE(space.holds(traced.point(inside)));
    EXPECT_TRUE(space.holds(traced.point({inside.x, 0, inside.z}) + Vec3(0, 4.0f * kSpaceMargin, 0)));
    EXPECT_FALSE(space.holds(traced.point({inside.x, -0.001, inside.z})));
  }
}

TEST(ClearSpace, ShrinksWherePlanesRunOut) {
  // Inside a faceted ball each facet is a plane of its own.
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  const auto at = [](int i, int j) {
    const double theta = kPiD * i / 16.0, phi = 2.0 * kPiD * j / 32.0;
    return Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  };
  for (int i = 1; i < 15; ++i) {
    for (int j = 0; j < 32; ++j) {
      builder.polygon({at(i, j), at(i, j + 1), at(i + 1, j)}, white);
      builder.polygon({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)}, white);
    }
  }
  const TracedScene traced = builder.compile();
  const Vec3 centre = traced.point({0.2, 0.1, 0.0});
  const float unit = 1.0f / static_cast<float>(traced.unitLength());
  const ClearSpace space = traced.tracer->clearSpace(centre, 3.0f * unit, kSpaceMargin);
  EXPECT_LE(space.planes().size(), static_cast<std::size_t>(ClearSpace::kMostPlanes));
  // No farther than the facets, and never less than what is nearest.
  EXPECT_LT(space.radius(), 1.3f * unit);
  EXPECT_GT(space.radius(), 0.74f * unit);
  const Verdicts verdicts = judge(traced, space, unit, randomKey(304), 4000);
  EXPECT_EQ(verdicts.wrong, 0);
  EXPECT_GT(verdicts.told, 200);
}

TEST(ClearSpace, EndsAtASphereThatLiesAroundTheCentre) {
  SceneBuilder builder;
  builder.sphere({0, 0, 0}, 1.0, builder.diffuse(Rgb(0.5f)));
  const TracedScene traced = builder.compile();
  const float unit = 1.0f / static_cast<float>(traced.unitLength());
  const ClearSpace inside = traced.tracer->clearSpace(traced.point({0.5, 0, 0}), 3.0f * unit, kSpaceMargin);
  EXPECT_NEAR(inside.radius(), 0.5f * unit, 1e-5f);
  // Before it there is its tangent plane.
  const ClearSpace before = traced.tracer->clearSpace(traced.point({1.5, 0, 0}), 3.0f * unit, kSpaceMargin);
  EXPECT_EQ(before.radius(), 3.0f * unit);
  EXPECT_TRUE(before.holds(traced.point({1.01, 2, 0})));
  EXPECT_FALSE(before.holds(traced.point({0.99, 2, 0})));
}

// A cluster that lies in its own surface, and one to which a surface comes nearer than numbers tell apart.
TEST(ClearSpace, OfACentreInASurfaceHoldsNothing) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  builder.rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, white);
  builder.rectangle({0.5, -0.5, 0}, {0, 0, 1}, {0, 1, 0}, white);
  const TracedScene traced = builder.compile();
  const Vec3 centre = traced.point({0.5, 0, 0.5});
  const ClearSpace space = traced.tracer->clearSpace(centre, 0.3f, kSpaceMargin);
  EXPECT_FALSE(space.holds(centre));
  EXPECT_EQ(judge(traced, space, 0.3f, randomKey(305), 4000).wrong, 0);
}

TEST(ClearSpace, OfWhatIsNoNumberIsEmpty) {
  ClearSpace space(Vec3(0.0f), 1.0f, kSpaceMargin);
  space.keepOut(Vec3(1, 0, 0), Vec3(std::nanf(""), 0, 0), Vec3(0, 1, 0));
  EXPECT_EQ(space.radius(), 0.0f);
  // A triangle without a face still stands where it stands.
  ClearSpace before(Vec3(0.0f), 1.0f, kSpaceMargin);
  before.keepOut(Vec3(0.5f, 0, 0), Vec3(0.5f, 0, 0), Vec3(0.5f, 0, 0));
  EXPECT_TRUE(before.holds(Vec3(0.4f, 0.2f, 0)));
  EXPECT_FALSE(before.holds(Vec3(0.6f, 0.2f, 0)));
}

}  // namespace
}  // namespace lightvane
