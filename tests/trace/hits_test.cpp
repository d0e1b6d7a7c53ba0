#include <cstring>
#include <optional>

#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// Hits against intersections worked out in double, shape by shape, without a hierarchy.

namespace lightvane {
namespace {

using namespace trace_test;

/// A ray from a random point of the unit cube to another one, in normalised units.
Ray randomRay(const TracedScene& traced, RandomKey key, std::uint32_t i) {
  const Vec3d from = randomPoint(key, i, 0) * 1.6 - 0.3;
  const Vec3d to = randomPoint(key, i, 3);
  return traced.ray(from, to - from);
}

struct DoubleHit {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t primitive = kNone;
  double u = 0.0, v = 0.0;
  bool doubtful = false;  ///< passes an edge by less than rounding, up to there
};

/// Moeller and Trumbore's, in double, over all triangles.
DoubleHit bruteForce(const TriangleMesh& mesh, const Ray& ray) {
  DoubleHit best;
  double nearestDoubtful = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3d a(mesh.positions[mesh.triangles[i].x]);
    const Vec3d e1 = Vec3d(mesh.positions[mesh.triangles[i].y]) - a;
    const Vec3d e2 = Vec3d(mesh.positions[mesh.triangles[i].z]) - a;
    const Vec3d p = glm::cross(Vec3d(ray.direction), e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) continue;
    const Vec3d s = Vec3d(ray.origin) - a;
    const double u = glm::dot(s, p) / determinant;
    const Vec3d q = glm::cross(s, e1);
    const double v = glm::dot(Vec3d(ray.direction), q) / determinant;
    const double t = glm::dot(e2, q) / determinant;
    if (!(t > 0.0)) continue;
    const double inside = std::min({u, v, 1.0 - u - v});
    // Distance from the nearest edge's line, as seen along the ray: coordinates of 1 carry errors of 1e-7.
    const double seen = std::abs(determinant);
    const double fromEdge = std::min({u * seen / glm::length(e2), v * seen / glm::length(e1),
                                      (1.0 - u - v) * seen / glm::length(e2 - e1)});
    if (std::abs(fromEdge) < 1e-6) nearestDoubtful = std::min(nearestDoubtful, t);
    if (inside < 0.0 || t >= best.t) continue;
    best = {t, i, u, v};
  }
  best.doubtful = nearestDoubtful < best.t * (1.0 + 1e-6);
  return best;
}

TracedScene randomTriangles(std::uint32_t count) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  const RandomKey key = randomKey(11);
  std::vector<Vec3d> positions;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    // Sizes over three decades.
    const double size = 0.5 * std::pow(10.0, -3.0 * uniform(key, i, 0));
    const Vec3d centre = randomPoint(key, i, 1);
    for (std::uint32_t k = 0; k < 3; ++k) {
      positions.push_back(centre + size * (randomPoint(key, i, 4 + 3 * k) - 0.5));
    }
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  builder.mesh(std::move(positions), std::move(triangles), white);
  return builder.compile();
}

/// Triangles, spheres and discs, of all sizes.
SceneBuilder mixedShapes() {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  const RandomKey key = randomKey(12);
  std::vector<Vec3d> positions;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < 100; ++i) {
    const double size = 0.4 * std::pow(10.0, -2.0 * uniform(key, i, 0));
    const Vec3d centre = randomPoint(key, i, 1);
    if (i % 3 == 0) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        positions.push_back(centre + 2.0 * size * (randomPoint(key, i, 4 + 3 * k) - 0.5));
      }
      const auto n = static_cast<std::uint32_t>(positions.size());
      triangles.emplace_back(n - 3, n - 2, n - 1);
    } else if (i % 3 == 1) {
      builder.sphere(centre, 0.5 * size, white);
    } else {
      builder.disc(centre, randomPoint(key, i, 4) - 0.5, 0.7 * size, white);
    }
  }
  builder.mesh(std::move(positions), std::move(triangles), white);
  return builder;
}

// A ray's length is a float: it may end in the very centre of a ball that is small enough.
TEST(Hits, OfBallsThatAreAPointHaveANormal) {
  for (const double radius : {1e-6, 1e-8, 1e-10, 1e-15, 1e-20, 1e-30, 1e-36}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f));
    builder.sphere(Vec3d(0.0), radius, white);
    builder.sphere(Vec3d(2.0, 0.0, 0.0), 1.0, white);
    builder.sphere(Vec3d(-2.0, 0.0, 0.0), 1.0, white);
    const TracedScene traced = builder.compile();
    for (std::uint32_t i = 0; i < 1000; ++i) {
      Vec3d from = 4.0 * randomPoint(randomKey(13), i, 0) - 2.0;
      from.x = 0.0;
      if (i < 100) from = Vec3d(0.0, 0.0, 0.03125 * (i + 1));
      const Ray ray = traced.ray(from, -from);
      const Hit hit = traced.tracer->intersect(ray);
      if (!hit.found()) continue;
      const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
      EXPECT_NEAR(glm::length(point.geometricNormal), 1.0f, 1e-6f) << radius;
      EXPECT_TRUE(isFinite(Vec3d(point.position))) << radius;
      EXPECT_TRUE(std::isfinite(point.curvature)) << radius;
    }
  }
}

TEST(TracerHits, TrianglesAgreeWithBruteForceInDouble) {
  const TracedScene traced = randomTriangles(300);
  const TriangleMesh& mesh = traced.scene->meshes.front();
  const RandomKey key = randomKey(1);
  constexpr std::uint32_t kRays = 20'000;
  int found = 0, doubtful = 0;
  double worstT = 0.0, worstPlace = 0.0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const Ray ray = randomRay(traced, key, i);
    const DoubleHit expected = bruteForce(mesh, ray);
    if (expected.doubtful) {
      ++doubtful;
      continue;
    }
    const Hit hit = traced.tracer->intersect(ray);
    ASSERT_EQ(hit.found(), expected.primitive != kNone) << "ray " << i;
    ASSERT_EQ(traced.tracer->occluded(ray), hit.found()) << "ray " << i;
    if (!hit.found()) continue;
    ++found;
    ASSERT_EQ(hit.geometry, 0u);
    // Two triangles that cross within rounding of each other may change places.
    if (hit.primitive != expected.primitive) {
      ASSERT_NEAR(hit.t, expected.t, 1e-6) << "ray " << i << " met another triangle";
      continue;
    }
    const glm::uvec3& corners = mesh.triangles[hit.primitive];
    const Vec3d e1 = Vec3d(mesh.positions[corners.y]) - Vec3d(mesh.positions[corners.x]);
    const Vec3d e2 = Vec3d(mesh.positions[corners.z]) - Vec3d(mesh.positions[corners.x]);
    const double slope = std::abs(glm::dot(glm::normalize(glm::cross(e1, e2)), Vec3d(ray.direction)));
    worstT = std::max(worstT, std::abs(hit.t - expected.t) * slope);
    worstPlace =
        std::max(worstPlace, glm::length((hit.u - expected.u) * e1 + (hit.v - expected.v) * e2) * slope);
  }
  EXPECT_GT(found, 5000);
  EXPECT_LT(doubtful, static_cast<int>(kRays) / 100) << "too many ties for the test to mean something";
  // Errors along a ray that grazes the plane grow by 1 / slope; coordinates are below 1, so that a few
  // roundings of 2^-24 are what is left. Measured: 2^-24.0 and 2^-23.6.
  EXPECT_LT(worstT, 0x1p-22);
  EXPECT_LT(worstPlace, 0x1p-22);
}

/// The nearest root beyond 0 in long double.
std::optional<long double> sphereRoot(const SphereShape& sphere, const Ray& ray) {
  using V = glm::tvec3<long double>;
  const V o = V(ray.origin) - V(sphere.center);
  const V d(ray.direction);
  const long double a = glm::dot(d, d), b = glm::dot(o, d);
  const long double c = glm::dot(o, o) - static_cast<long double>(sphere.radius) * sphere.radius;
  const long double discriminant = b * b - a * c;
  if (discriminant < 0.0L) return std::nullopt;
  // Citardauq: without cancellation for either root.
  const long double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const long double first = std::min(q / a, c / q), second = std::max(q / a, c / q);
  if (first > 0.0L) return first;
  if (second > 0.0L) return second;
  return std::nullopt;
}

TEST(TracerHits, SpheresAreExactHoweverSmallAndFar) {
  for (const double radius : {0x1p-22, 0x1p-16, 1e-3, 0.2, 0.9}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f));
    builder.sphere({0.9, 0.1, -0.3}, radius, white);
    builder.disc({-3.0, 0, 0}, {1, 0, 0}, 1.0,
                 white);  // keeps the normalisation that of a scene, not of a sphere
    const TracedScene traced = builder.compile();
    const SphereShape& sphere = traced.scene->spheres.front();
    const RandomKey key = randomKey(2);
    int hits = 0, doubtful = 0;
    constexpr int kRays = 4000;
    for (int i = 0; i < kRays; ++i) {
      const auto n = static_cast<std::uint32_t>(i);
      // Aimed within 1.3 radii of the centre; from far away, and a third from nearby or inside.
      const double away = i % 3 == 0 ? 3.0 * radius * uniform(key, n, 0) : 2.0;
      const Vec3d origin = Vec3d(0.9, 0.1, -0.3) + away * Vec3d(uniformDirection(uniform2(key, n, 1)));
      const Vec3d target =
          Vec3d(0.9, 0.1, -0.3) + 1.3 * radius * Vec3d(uniformDirection(uniform2(key, n, 3)));
      Ray ray = traced.ray(origin, target - origin);
      if (std::abs(origin.x) < 1e-12) continue;
      ray.tFar = 3.0f;
      const std::optional<long double> expected = sphereRoot(sphere, ray);
      // The disc is far behind most of the time; rays that meet it first do not count.
      const Hit hit = traced.tracer->intersect(ray);
      if (hit.found() && hit.geometry != 0u) continue;
      const Vec3d o = Vec3d(ray.origin) - Vec3d(sphere.center);
      const Vec3d d(ray.direction);
      const double impact = glm::length(o - glm::dot(o, d) / glm::dot(d, d) * d);
      if (std::abs(impact / sphere.radius - 1.0) < 1e-9) {
        ++doubtful;
        continue;
      }
      if (expected && *expected < 1e-9L) continue;
      ASSERT_EQ(hit.found(), expected.has_value())
          << "radius " << radius << ", ray " << i << ", passes at " << impact / sphere.radius << " radii";
      if (!expected) continue;
      ++hits;
      // One rounding to float, and what doubles lose: 2^-52 of the distance, more where the ray grazes.
      const double grazing = std::sqrt(std::max(1e-12, 1.0 - square(impact / sphere.radius)));
      const auto t = static_cast<double>(*expected);
      ASSERT_NEAR(hit.t, t, 0x1p-24 * t + 1e-15 / grazing) << "radius " << radius << ", ray " << i;
    }
    EXPECT_GT(hits, kRays / 5) << "radius " << radius;
    EXPECT_LT(doubtful, kRays / 100);
  }
}

TEST(TracerHits, DiscsAreExact) {
  for (const double radius : {1e-4, 0.05, 0.7}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f));
    builder.disc({0.3, -0.2, 0.4}, {0.3, 1.0, -0.5}, radius, white);
    builder.sphere({-3.0, 0, 0}, 0.01, white);
    const TracedScene traced = builder.compile();
    const DiscShape& disc = traced.scene->discs.front();
    const std::uint32_t geometry = 1;  // after the spheres
    const RandomKey key = randomKey(3);
    int hits = 0;
    for (std::uint32_t i = 0; i < 4000; ++i) {
      const Vec3d origin = Vec3d(0.3, -0.2, 0.4) + 1.5 * Vec3d(uniformDirection(uniform2(key, i, 0)));
      const Vec3d target = Vec3d(0.3, -0.2, 0.4) + 1.5 * radius * (2.0 * randomPoint(key, i, 2) - 1.0);
      const Ray ray = traced.ray(origin, target - origin);
      const Vec3d n(disc.normal);
      const double t =
          glm::dot(Vec3d(disc.center) - Vec3d(ray.origin), n) / glm::dot(Vec3d(ray.direction), n);
      const double away = glm::length(Vec3d(ray.origin) + t * Vec3d(ray.direction) - Vec3d(disc.center));
      if (std::abs(away / disc.radius - 1.0) < 1e-9) continue;
      const bool expected = t > 0.0 && away < disc.radius;
      const Hit hit = traced.tracer->intersect(ray);
      ASSERT_EQ(hit.found() && hit.geometry == geometry, expected) << "radius " << radius << ", ray " << i;
      if (!expected) continue;
      ++hits;
      // The computation is in double; the rest is one rounding to float.
      ASSERT_NEAR(hit.t, t, 0x1p-23 * t) << "radius " << radius << ", ray " << i;
    }
    EXPECT_GT(hits, 500) << "radius " << radius;
  }
}

TEST(TracerHits, LieBetweenNearAndFar) {
  const TracedScene traced = mixedShapes().compile();
  const RandomKey key = randomKey(4);
  int found = 0;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const Ray ray = randomRay(traced, key, i);
    const Hit hit = traced.tracer->intersect(ray);
    if (!hit.found()) continue;
    ++found;
    Ray shorter = ray;
    shorter.tFar = hit.t * 0.9999f;
    EXPECT_FALSE(traced.tracer->occluded(shorter)) << "ray " << i;
    EXPECT_FALSE(traced.tracer->intersect(shorter).found()) << "ray " << i;
    Ray longer = ray;
    longer.tFar = hit.t * 1.0001f;
    EXPECT_TRUE(traced.tracer->occluded(longer)) << "ray " << i;
    Ray later = ray;
    later.tNear = hit.t * 1.0001f;
    const Hit behind = traced.tracer->intersect(later);
    if (behind.found()) {
      EXPECT_GT(behind.t, later.tNear) << "ray " << i;
    }
  }
  EXPECT_GT(found, 1000);
}

// What Tracer::intersect promises: a packet is a way to be quick, not another answer.
TEST(TracerHits, PacketsGiveWhatSingleRaysGive) {
  const TracedScene traced = mixedShapes().compile();
  const RandomKey key = randomKey(5);
  int found = 0, differentBits = 0;
  std::uint32_t number = 0;
  for (const Coherence coherence : {Coherence::Coherent, Coherence::Incoherent}) {
    for (int round = 0; round < 800; ++round) {
      const int count = 1 + round % kPacketWidth;
      HitPacket hits;
      ShadowPacket shadows;
      Ray rays[kPacketWidth];
      // Alike as a gather's are, or not at all.
      const Ray first = randomRay(traced, key, number);
      for (int lane = 0; lane < count; ++lane) {
        rays[lane] = randomRay(traced, key, number++);
        if (round % 2 == 0) {
          rays[lane].origin = first.origin;
          rays[lane].direction = glm::normalize(first.direction + 0.1f * rays[lane].direction);
        }
        rays[lane].tFar = round % 3 == 0 ? 0.3f : kInfinity;
        hits.rays.set(lane, rays[lane]);
        shadows.set(lane, rays[lane]);
      }
      traced.tracer->intersect(hits, count, coherence);
      traced.tracer->occluded(shadows, count, coherence);
      for (int lane = 0; lane < count; ++lane) {
        const Hit one = traced.tracer->intersect(rays[lane]);
        const Hit other = hits.hit(lane);
        ASSERT_EQ(one.geometry, other.geometry) << "round " << round << ", lane " << lane;
        EXPECT_EQ(shadows.isOccluded(lane), one.found()) << "round " << round << ", lane " << lane;
        if (!one.found()) continue;
        ++found;
        ASSERT_EQ(one.primitive, other.primitive);
        differentBits += std::memcmp(&one, &other, sizeof(Hit)) != 0 ? 1 : 0;
        EXPECT_NEAR(one.t, other.t, 0x1p-21f) << "round " << round << ", lane " << lane;
      }
    }
  }
  EXPECT_GT(found, 2000);
  RecordProperty("hits with other last bits in a packet", differentBits);
  EXPECT_EQ(differentBits, 0) << "of " << found;
}

TEST(TracerHits, ScalingTheSceneByPowersOfTwoChangesNoBit) {
  const SceneBuilder original = mixedShapes();
  const TracedScene reference = original.compile();
  for (const int exponent : {-20, -10, 10, 20}) {
    SceneBuilder builder = original;
    const double scale = std::ldexp(1.0, exponent);
    for (ShapeDescription& shape : builder.description().shapes) {
      if (auto* sphere = std::get_if<SphereDescription>(&shape.geometry)) {
        sphere->center *= scale;
        sphere->radius *= scale;
      } else if (auto* disc = std::get_if<DiscDescription>(&shape.geometry)) {
        disc->center *= scale;
        disc->radius *= scale;
      } else {
        auto& mesh = std::get<MeshDescription>(shape.geometry);
        MeshGeometry scaled = *mesh.geometry;
        for (Vec3d& p : scaled.positions) p *= scale;
        mesh.geometry = std::make_shared<const MeshGeometry>(std::move(scaled));
      }
    }
    const TracedScene scaled = builder.compile();
    ASSERT_EQ(scaled.scene->normalisation.lengthExponent,
              reference.scene->normalisation.lengthExponent + exponent);
    const RandomKey key = randomKey(6);
    int found = 0;
    for (std::uint32_t i = 0; i < 3000; ++i) {
      const Ray ray = randomRay(reference, key, i);
      const Vec3d origin = reference.scene->normalisation.scenePoint(ray.origin) * scale;
      ASSERT_EQ(scaled.point(origin), ray.origin) << "the ray itself was changed by 2^" << exponent;
      const Hit a = reference.tracer->intersect(ray);
      const Hit b = scaled.tracer->intersect(ray);
      ASSERT_EQ(std::memcmp(&a, &b, sizeof(Hit)), 0) << "2^" << exponent << ", ray " << i;
      if (!a.found()) continue;
      ++found;
      const SurfacePoint p = reference.tracer->surfaceAt(ray, a);
      const SurfacePoint q = scaled.tracer->surfaceAt(ray, b);
      ASSERT_EQ(p.position, q.position);
      ASSERT_EQ(p.geometricNormal, q.geometricNormal);
      ASSERT_EQ(p.frame.x, q.frame.x);
      ASSERT_EQ(p.offset, q.offset);
      ASSERT_EQ(p.surface, q.surface);
    }
    EXPECT_GT(found, 1000);
  }
}

}  // namespace
}  // namespace lightvane
