#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/support/grid_mesh.h"
#include "tests/trace/scene_builder.h"

// Meshes that shapes share, held against the same scenes with copies of them.

namespace lightvane {
namespace {

using namespace trace_test;

/// A bumpy ball of radius 1 about a point: 2 * rings * rings triangles, with normals and colours.
MeshGeometry bumpyBall(std::uint32_t rings, const Vec3d& centre) {
  MeshGeometry mesh;
  const std::uint32_t sectors = rings;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j <= sectors; ++j) {
      const double theta = kPiD * i / rings, phi = 2.0 * kPiD * (j % sectors) / sectors;
      const double sine = i == rings ? 0.0 : std::sin(theta);
      const Vec3d normal(sine * std::cos(phi), std::cos(theta), sine * std::sin(phi));
      mesh.positions.push_back(centre + normal * (0.8 + 0.2 * std::cos(5.0 * phi) * sine));
      mesh.normals.push_back(normal);
      mesh.colors.emplace_back(Vec3(0.5 + 0.5 * normal));
    }
  }
  mesh.triangles = test::gridTriangles(rings, sectors);  // front sides outwards
  return mesh;
}

glm::dmat4 randomPlacement(RandomKey key, std::uint32_t i, bool mirrors) {
  const Vec3d turn = 360.0 * randomPoint(key, i, 0);
  const glm::dmat3 linear =
      glm::dmat3(glm::rotate(glm::dmat4(1.0), turn.x, glm::normalize(Vec3d(1, 2, 3)))) *
      (0.05 + 0.05 * randomPoint(key, i, 3).x) *
      glm::dmat3(mirrors ? -1.0 : 1.0, 0, 0, 0, 0.5 + randomPoint(key, i, 6).y, 0, 0.3, 0, 1);
  glm::dmat4 placement(linear);
  placement[3] = glm::dvec4(randomPoint(key, i, 9), 1.0);
  return placement;
}

struct TwoWays {
  TracedScene shared, copied;
};

constexpr std::uint32_t kCopies = 40;

/// The same balls twice: as instances, and each with triangles of its own. Every third is mirrored, and every
/// other one has the second material.
TwoWays ballsInTwoWays(std::uint32_t rings, const Vec3d& centre, SceneBuilder builder, std::size_t first,
                       std::size_t second) {
  const auto ball = std::make_shared<const MeshGeometry>(bumpyBall(rings, centre));
  SceneBuilder copies = builder;
  const RandomKey key = randomKey(77);
  for (std::uint32_t i = 0; i < kCopies; ++i) {
    const glm::dmat4 placement = glm::translate(randomPlacement(key, i, i % 3 == 0), -centre);
    const std::size_t material = i % 2 == 0 ? first : second;
    builder.mesh(ball, material, placement);
    copies.mesh(std::make_shared<const MeshGeometry>(*ball), material, placement);
  }
  return {builder.compile(), copies.compile()};
}

TwoWays ballsInTwoWays() {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f)), red = builder.diffuse(Rgb(0.5f, 0.1f, 0.1f));
  return ballsInTwoWays(24, Vec3d(0.0), std::move(builder), white, red);
}

Ray rayThroughCube(const TracedScene& traced, RandomKey key, std::uint32_t i) {
  const Vec3d from = randomPoint(key, i, 0) * 1.6 - 0.3;
  return traced.ray(from, randomPoint(key, i, 3) - from);
}

TEST(Instances, AreHitWhereCopiesAre) {
  // Far from its own origin, a mesh must not lose digits.
  for (const double away : {0.0, 1e6}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f)), red = builder.diffuse(Rgb(0.5f, 0.1f, 0.1f));
    const TwoWays scenes = ballsInTwoWays(24, Vec3d(away, -away, 0.0), builder, white, red);
    ASSERT_EQ(scenes.shared.scene->instances.size(), kCopies);
    ASSERT_EQ(scenes.shared.scene->sharedMeshes.size(), 1U);
    ASSERT_TRUE(scenes.copied.scene->instances.empty());
    EXPECT_EQ(scenes.shared.scene->triangleCount(), scenes.copied.scene->triangleCount());
    EXPECT_EQ(scenes.shared.scene->normalisation.lengthExponent,
              scenes.copied.scene->normalisation.lengthExponent);
    int hits = 0, apart = 0;
    constexpr std::uint32_t kRays = 20'000;
    for (std::uint32_t i = 0; i < kRays; ++i) {
      const Ray ray = rayThroughCube(scenes.shared, randomKey(78), i);
      const Hit one = scenes.shared.tracer->intersect(ray), other = scenes.copied.tracer->intersect(ray);
      const bool isSame = one.found() == other.found() && (!one.found() || std::abs(one.t - other.t) < 1e-5f);
      if (!isSame) ++apart;
      if (!isSame || !one.found()) continue;
      ++hits;
      const SurfacePoint a = scenes.shared.tracer->surfaceAt(ray, one);
      const SurfacePoint b = scenes.copied.tracer->surfaceAt(ray, other);
      // Neighbouring triangles meet rays on their common edge, and a smooth normal at a grazing ray is used
      // or is not.
      if (glm::length(a.geometricNormal - b.geometricNormal) > 1e-3f ||
          glm::length(a.frame.z - b.frame.z) > 1e-2f) {
        ++apart;
        continue;
      }
      EXPECT_LT(glm::length(a.position - b.position), 2e-6f);
      EXPECT_EQ(a.material, b.material);
      EXPECT_EQ(scenes.shared.scene->surfaces[a.surface].shape,
                scenes.copied.scene->surfaces[b.surface].shape);
      EXPECT_EQ(a.frontSide, b.frontSide);
      EXPECT_LT(glm::length(a.tint.diffuse - b.tint.diffuse), 1e-4f);
    }
    EXPECT_GT(hits, 5000);
    EXPECT_LT(apart, 20);
  }
}

// The inverse of such a transform, and products of it, are out of single precision's range: Embree's
// assertions end the process.
TEST(Instances, AreNoneWhereTheyAreFarTooSmallToBeSeen) {
  const auto ball = std::make_shared<const MeshGeometry>(bumpyBall(24, Vec3d(0.0)));
  for (const double scale : {0.5, 1e-6, 1e-9, 1e-12, 1e-16, 1e-20, 1e-30, 1e-100}) {
    SceneBuilder builder;
    const std::size_t white = builder.diffuse(Rgb(0.5f));
    for (int i = 0; i < 2; ++i) {
      builder.mesh(ball, white, glm::translate(glm::dmat4(1.0), Vec3d(3.0 * i + 3.0, 0.0, 0.0)));
      builder.mesh(ball, white, glm::scale(glm::dmat4(1.0), Vec3d(scale)));
    }
    const TracedScene traced = builder.compile();
    EXPECT_EQ(traced.scene->instances.size(), scale > 1e-8 ? 4U : 2U) << scale;
    HitPacket packet;
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const Vec3d from = 4.0 * randomPoint(randomKey(81), i, 0) - Vec3d(2.0);
      const Vec3d to = scale * (randomPoint(randomKey(81), i, 3) - 0.5);
      const Ray ray = traced.ray(from, to - from);
      if (const Hit hit = traced.tracer->intersect(ray); hit.found()) {
        EXPECT_TRUE(isFinite(Vec3d(traced.tracer->surfaceAt(ray, hit).geometricNormal))) << scale;
      }
      const ClearSpace space = traced.tracer->clearSpace(traced.point(from), 1.0f, 0.0f);
      EXPECT_GT(space.radius(), 0.0f) << scale;
      packet.rays.set(static_cast<int>(i % kPacketWidth), ray);
      if (i % kPacketWidth == kPacketWidth - 1)
        traced.tracer->intersect(packet, kPacketWidth, Coherence::Coherent);
    }
  }
}

TEST(Instances, LetNoRayMeetTheSurfaceThatItLeaves) {
  const TwoWays scenes = ballsInTwoWays();
  int left = 0;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const Ray ray = rayThroughCube(scenes.shared, randomKey(79), i);
    const Hit hit = scenes.shared.tracer->intersect(ray);
    if (!hit.found()) continue;
    const SurfacePoint point = scenes.shared.tracer->surfaceAt(ray, hit);
    // Grazing: the hardest.
    const Vec3 along = glm::normalize(point.frame.x + 0.01f * point.geometricNormal);
    const Ray away{point.originTowards(along), along, 0.0f, kInfinity};
    const Hit next = scenes.shared.tracer->intersect(away);
    ++left;
    if (next.found() && next.instance == hit.instance && next.primitive == hit.primitive)
      ADD_FAILURE() << "ray " << i << " meets its own triangle after " << next.t;
  }
  EXPECT_GT(left, 5000);
}

TEST(Instances, GiveTheLightThatCopiesGive) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  builder.rectangle({-3, -0.1, 3}, {6, 0, 0}, {0, 0, -6}, white);
  builder.light(DirectionalLightDescription{{-0.7, -0.6, -0.3}, Rgb(1.0f), 0.0});
  builder.light(PointLightDescription{{0.5, 1.5, 0.5}, Rgb(1.0f)});
  builder.sphere({1.5, 2.0, 0.2}, 0.3, builder.diffuse(Rgb(0.0f), Rgb(5.0f)));
  const TwoWays scenes = ballsInTwoWays(24, Vec3d(0.0), builder, white, white);
  DirectLightSampler shared(*scenes.shared.tracer, {}), copied(*scenes.copied.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  int lit = 0, apart = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const Ray seen = rayThroughCube(scenes.copied, randomKey(83), i);
    const Hit hit = scenes.copied.tracer->intersect(seen);
    if (!hit.found()) continue;
    const LitPoint point{scenes.copied.tracer->surfaceAt(seen, hit), -seen.direction};
    for (std::uint32_t light = 0; light < 3; ++light) {
      const RandomKey key = randomKey(84).with(i);
      const float one = shared.estimate(point, light, 16, key, counts, faults).irradiance.r;
      const float other = copied.estimate(point, light, 16, key, counts, faults).irradiance.r;
      lit += other > 0.0f ? 1 : 0;
      apart += std::abs(one - other) > 1e-4f * other ? 1 : 0;
    }
  }
  EXPECT_GT(lit, 1000);
  EXPECT_LT(apart, 100) << "edges that one ray or another meets";
}

TEST(Instances, TakeTheMemoryOfOneMesh) {
  const TwoWays scenes = ballsInTwoWays();
  EXPECT_LT(scenes.shared.tracer->memoryBytes() * 10, scenes.copied.tracer->memoryBytes());
}

TEST(Instances, PassWhatTheirMaterialsLetPass) {
  SceneBuilder builder;
  MaterialDescription veil;
  veil.diffuse = Rgb(0.5f);
  veil.opacity.value = 0.25;
  const std::size_t thin = builder.material(veil), white = builder.diffuse(Rgb(0.5f));
  const TwoWays scenes = ballsInTwoWays(24, Vec3d(0.0), builder, thin, white);
  EXPECT_EQ(scenes.shared.scene->sharedMeshes.size(), 2U) << "one that light passes, one that it does not";
  int partly = 0, apart = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const Ray ray = rayThroughCube(scenes.shared, randomKey(80), i);
    Rgb passed[2];
    bool isOccluded[2];
    for (const TracedScene* traced : {&scenes.shared, &scenes.copied}) {
      const int way = traced == &scenes.shared ? 0 : 1;
      ShadowPacket packet;
      packet.set(0, ray);
      traced->tracer->shadow(packet, 1, Coherence::Incoherent, {&passed[way], 1});
      isOccluded[way] = packet.isOccluded(0);
    }
    if (isOccluded[0] != isOccluded[1]) ++apart;
    if (isOccluded[0] || isOccluded[1]) continue;
    if (glm::length(passed[0] - passed[1]) > 1e-5f) ++apart;
    partly += passed[0].r < 1.0f ? 1 : 0;
  }
  EXPECT_GT(partly, 500);
  EXPECT_LT(apart, 5);
}

TEST(Instances, AreKeptOutOfClearSpaces) {
  const TwoWays scenes = ballsInTwoWays();
  const TracedScene& traced = scenes.shared;
  constexpr float kMargin = 0x1p-19f;
  int told = 0, wrong = 0, toldOfCopies = 0;
  for (std::uint32_t i = 0; i < 300; ++i) {
    const Ray ray = rayThroughCube(traced, randomKey(81), i);
    const Hit hit = traced.tracer->intersect(ray);
    if (!hit.found()) continue;
    const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
    const Vec3 centre = point.position + 0.02f * point.geometricNormal;
    const ClearSpace space = traced.tracer->clearSpace(centre, 0.1f, kMargin);
    const ClearSpace ofCopies = scenes.copied.tracer->clearSpace(centre, 0.1f, kMargin);
    for (std::uint32_t pair = 0; pair < 100; ++pair) {
      const RandomKey key = randomKey(82).with(i);
      const Vec3 a = centre + 0.03f * Vec3(2.0 * randomPoint(key, pair, 0) - 1.0);
      const Vec3 b = centre + 0.03f * Vec3(2.0 * randomPoint(key, pair, 3) - 1.0);
      toldOfCopies += ofCopies.holds(a) && ofCopies.holds(b) ? 1 : 0;
      if (!space.holds(a) || !space.holds(b)) continue;
      ++told;
      const float length = glm::length(b - a);
      wrong += traced.tracer->occluded(Ray{a, (b - a) / length, 0.0f, length}) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(told, 1000);
  EXPECT_NEAR(told, toldOfCopies, 0.1 * toldOfCopies);
}

/// How many of two shapes with these triangles become instances.
std::size_t instancesOf(const MeshGeometry& mesh, const MaterialDescription& material,
                        const glm::dmat4& placement = glm::dmat4(1.0)) {
  SceneBuilder builder;
  const std::size_t m = builder.material(material);
  const auto shared = std::make_shared<const MeshGeometry>(mesh);
  builder.mesh(shared, m, placement).mesh(shared, m, glm::translate(glm::dmat4(1.0), Vec3d(3.0)));
  return builder.compile().scene->instances.size();
}

TEST(Instances, AreMadeWhereItPays) {
  MaterialDescription white;
  white.diffuse = Rgb(0.5f);
  EXPECT_EQ(instancesOf(bumpyBall(24, Vec3d(0.0)), white), 2U);
  EXPECT_EQ(instancesOf(bumpyBall(8, Vec3d(0.0)), white), 0U) << "few triangles";
  EXPECT_EQ(instancesOf(bumpyBall(24, Vec3d(0.0)), white, glm::scale(glm::dmat4(1.0), Vec3d(1, 1, 0))), 0U)
      << "flat, and the other one is alone then";
  EXPECT_EQ(instancesOf(bumpyBall(24, Vec3d(0.0)), white, glm::scale(glm::dmat4(1.0), Vec3d(1, 1, 30))), 0U)
      << "so drawn out that rays would lose digits";
  MaterialDescription lamp = white;
  lamp.emission = Rgb(1.0f);
  EXPECT_EQ(instancesOf(bumpyBall(24, Vec3d(0.0)), lamp), 0U) << "pieces of lights lie in the scene";
}

TEST(Instances, AreWhatSavesScenesThatAreTooLarge) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  MeshGeometry mesh = bumpyBall(8, Vec3d(0.0));
  mesh.normals.clear();
  mesh.colors.clear();
  mesh.positions.resize(70'000, Vec3d(0.0));
  const auto shared = std::make_shared<const MeshGeometry>(std::move(mesh));
  for (int i = 0; i < 1000; ++i) builder.mesh(shared, white);
  const auto scene = Scene::compile(builder.description());
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message().find("meshes have more than 67108864"), std::string::npos)
      << scene.error().message();
}

}  // namespace
}  // namespace lightvane
