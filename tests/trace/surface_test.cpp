#include <algorithm>
#include <map>

#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// Where rays land and where they start again.

namespace lightvane {
namespace {

using namespace trace_test;

/// Triangles from slivers and crumbs to ones as large as the scene, spheres and discs, all over it.
TracedScene shapesOfAllSizes() {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  const RandomKey key = randomKey(21);
  std::vector<Vec3d> positions;
  std::vector<glm::uvec3> triangles;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const double size = std::pow(10.0, -4.0 * uniform(key, i, 0));
    const Vec3d centre = randomPoint(key, i, 1);
    const Vec3d sliver = i % 4 == 0 ? Vec3d(1.0, 1e-3, 1.0) : Vec3d(1.0);
    for (std::uint32_t k = 0; k < 3; ++k) {
      positions.push_back(centre + size * sliver * (randomPoint(key, i, 4 + 3 * k) - 0.5));
    }
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  builder.mesh(std::move(positions), std::move(triangles), white);
  for (std::uint32_t i = 1000; i < 1100; ++i) {
    const double size = 0.2 * std::pow(10.0, -4.0 * uniform(key, i, 0));
    builder.sphere(randomPoint(key, i, 1), size, white);
    builder.disc(randomPoint(key, i, 4), randomPoint(key, i, 7) - 0.5, 2.0 * size, white);
  }
  return builder.compile();
}

/// Aims at every primitive from random places near and far and calls visit(ray, hit) for what is met.
template <class Visit>
void forRandomHits(const TracedScene& traced, std::uint32_t raysEach, const Visit& visit) {
  const Scene& scene = *traced.scene;
  const RandomKey key = randomKey(22);
  std::uint32_t number = 0;
  const auto aim = [&](const Vec3d& target, double size) {
    for (std::uint32_t r = 0; r < raysEach; ++r, ++number) {
      const double away = r % 2 == 0 ? 3.0 * size : 1.0;
      const Vec3d origin = target + away * Vec3d(uniformDirection(uniform2(key, number, 0)));
      const Ray ray{Vec3(origin), Vec3(glm::normalize(target - Vec3d(Vec3(origin)))), 0.0f, kInfinity};
      const Hit hit = traced.tracer->intersect(ray);
      if (hit.found()) visit(ray, hit, number);
    }
  };
  for (const TriangleMesh& mesh : scene.meshes) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
      const Vec3d a(mesh.positions[mesh.triangles[i].x]);
      const Vec3d b(mesh.positions[mesh.triangles[i].y]);
      const Vec3d c(mesh.positions[mesh.triangles[i].z]);
      const double u = uniform(key, i, 8), v = (1.0 - u) * uniform(key, i, 9);
      aim((1.0 - u - v) * a + u * b + v * c, glm::length(b - a));
    }
  }
  for (const SphereShape& s : scene.spheres) aim(Vec3d(s.center), s.radius);
  for (const DiscShape& d : scene.discs) aim(Vec3d(d.center), d.radius);
}

/// Distance of a surface point from its own primitive, and the largest coordinate of that, in double.
std::pair<double, double> offSurface(const Scene& scene, const Hit& hit, const Vec3& position) {
  if (hit.geometry < scene.meshes.size()) {
    const TriangleMesh& mesh = scene.meshes[hit.geometry];
    const glm::uvec3& t = mesh.triangles[hit.primitive];
    const Vec3d a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const double distance = std::abs(glm::dot(Vec3d(position) - a, glm::normalize(glm::cross(b - a, c - a))));
    double extent = 0.0;
    for (const Vec3d& p : {a, b, c}) extent = std::max({extent, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return {distance, extent};
  }
  if (hit.geometry == scene.meshes.size()) {
    const SphereShape& s = scene.spheres[hit.primitive];
    return {std::abs(glm::length(Vec3d(position) - Vec3d(s.center)) - s.radius),
            maxComponent(glm::abs(s.center)) + s.radius};
  }
  const DiscShape& d = scene.discs[hit.primitive];
  return {std::abs(glm::dot(Vec3d(position) - Vec3d(d.center), Vec3d(d.normal))),
          maxComponent(glm::abs(d.center)) + d.radius};
}

// The claim that kRelativeOffset in tracer.cpp rests on: 2^-21 of the largest coordinate.
TEST(SurfacePoints, LieOnTheirPrimitives) {
  const TracedScene traced = shapesOfAllSizes();
  std::map<std::string, double> worst;
  std::map<std::string, int> hits;
  forRandomHits(traced, 40, [&](const Ray& ray, const Hit& hit, std::uint32_t) {
    const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
    const auto [distance, extent] = offSurface(*traced.scene, hit, point.position);
    const std::string kind = hit.geometry == 0 ? "triangles" : hit.geometry == 1 ? "spheres" : "discs";
    ++hits[kind];
    worst[kind] = std::max(worst[kind], distance / extent);
    ASSERT_NEAR(point.offset, 0x1p-18 * extent, 0x1p-40 * extent);
  });
  for (const auto& [kind, error] : worst) {
    EXPECT_GT(hits[kind], 2000) << kind;
    RecordProperty("largest error of " + kind + " as a power of two", std::to_string(std::log2(error)));
    EXPECT_LT(error, 0x1p-21) << kind << ": 2^" << std::log2(error) << " of the largest coordinate";
    // A bound that is never come near would say nothing.
    EXPECT_GT(error, 0x1p-26) << kind;
  }
}

TEST(SurfacePoints, FaceTheViewerAndKnowTheirSide) {
  const TracedScene traced = shapesOfAllSizes();
  int fronts = 0, backs = 0;
  forRandomHits(traced, 4, [&](const Ray& ray, const Hit& hit, std::uint32_t) {
    const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
    EXPECT_LE(glm::dot(ray.direction, point.geometricNormal), 0.0f);
    EXPECT_LT(glm::dot(ray.direction, point.frame.z), 0.0f);
    EXPECT_NEAR(glm::length(point.geometricNormal), 1.0f, 1e-6f);
    (point.frontSide ? fronts : backs) += 1;
  });
  EXPECT_GT(fronts, 500);
  EXPECT_GT(backs, 500);
}

/// Directions over the half space of `normal`, half of them within 10^-1 to 10^-6 of its plane.
Vec3 leavingDirection(const Vec3& normal, RandomKey key, std::uint32_t i) {
  const Frame frame = Frame::aboutNormal(normal);
  if (i % 2 == 0) return frame.toWorld(cosineDirection(uniform2(key, i, 20)));
  const float cosine = std::pow(10.0f, -1.0f - 5.0f * uniform(key, i, 22));
  const float phi = kTwoPi * uniform(key, i, 23);
  return glm::normalize(frame.toWorld({std::cos(phi), std::sin(phi), cosine}));
}

TEST(SurfacePoints, RaysThatLeaveDoNotMeetTheirOwnPrimitive) {
  const TracedScene traced = shapesOfAllSizes();
  const RandomKey key = randomKey(23);
  int rays = 0, selfHits = 0;
  forRandomHits(traced, 12, [&](const Ray& ray, const Hit& hit, std::uint32_t number) {
    const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
    for (std::uint32_t k = 0; k < 6; ++k) {
      Vec3 direction = leavingDirection(point.geometricNormal, key, 6 * number + k);
      // Through the surface too, as glass does it; a sphere is then met from within, later.
      const bool through = k >= 4;
      if (through) direction = -direction;
      const Hit next = traced.tracer->intersect({point.originTowards(direction), direction, 0.0f, kInfinity});
      ++rays;
      if (!next.found() || next.geometry != hit.geometry || next.primitive != hit.primitive) continue;
      // From within a sphere the other end of the chord is met, farther away than the origin is deep.
      if (hit.geometry == 1 && next.t > point.offset) continue;
      ++selfHits;
      ADD_FAILURE() << "ray " << number << " leaves geometry " << hit.geometry
                    << " and meets it at t = " << next.t << ", cosine "
                    << glm::dot(direction, point.geometricNormal);
    }
  });
  EXPECT_GT(rays, 30'000);
  EXPECT_EQ(selfHits, 0) << "of " << rays;
}

struct ClosedMesh {
  std::vector<Vec3d> positions;
  std::vector<glm::uvec3> triangles;
};

/// An icosahedron whose triangles are divided `levels` times, on the sphere about (0.3, 0.2, 0.1) of radius
/// 0.7; turned so that nothing is aligned to an axis.
ClosedMesh icosphere(int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  ClosedMesh mesh{{{-1, g, 0},
                   {1, g, 0},
                   {-1, -g, 0},
                   {1, -g, 0},
                   {0, -1, g},
                   {0, 1, g},
                   {0, -1, -g},
                   {0, 1, -g},
                   {g, 0, -1},
                   {g, 0, 1},
                   {-g, 0, -1},
                   {-g, 0, 1}},
                  {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                   {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                   {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (isNew) mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
      return entry->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : mesh.triangles) {
      const std::uint32_t ab = middle(t.x, t.y), bc = middle(t.y, t.z), ca = middle(t.z, t.x);
      for (const glm::uvec3& part : {glm::uvec3(t.x, ab, ca), {t.y, bc, ab}, {t.z, ca, bc}, {ab, bc, ca}}) {
        finer.push_back(part);
      }
    }
    mesh.triangles = std::move(finer);
    for (Vec3d& p : mesh.positions) p = glm::normalize(p);
  }
  for (Vec3d& p : mesh.positions) {
    p = glm::normalize(p);
    p = Vec3d(0.6 * p.x - 0.8 * p.y, 0.8 * p.x + 0.6 * p.y, p.z) * 0.7 + Vec3d(0.3, 0.2, 0.1);
  }
  return mesh;
}

TracedScene compileMesh(const ClosedMesh& mesh) {
  SceneBuilder builder;
  const std::size_t white = builder.diffuse(Rgb(0.5f));
  builder.mesh(mesh.positions, mesh.triangles, white);
  return builder.compile();
}

// Nothing of a convex body is in front of any of its faces, so that no leaving ray may meet anything.
TEST(SurfacePoints, RaysThatLeaveAConvexBodyMeetNothing) {
  for (const int levels : {0, 2, 4}) {
    const TracedScene traced = compileMesh(icosphere(levels));
    const RandomKey key = randomKey(24);
    int rays = 0;
    const auto raysEach = static_cast<std::uint32_t>(levels == 0 ? 500 : levels == 2 ? 40 : 4);
    const Vec3 centre = traced.point({0.3, 0.2, 0.1});
    forRandomHits(traced, raysEach, [&](const Ray& ray, const Hit& hit, std::uint32_t number) {
      if (glm::dot(ray.origin - centre, ray.origin - centre) <
          0.8f * 0.8f / square(float(traced.unitLength())))
        return;  // seen from inside
      const SurfacePoint point = traced.tracer->surfaceAt(ray, hit);
      for (std::uint32_t k = 0; k < 4; ++k, ++rays) {
        const Vec3 direction = leavingDirection(point.geometricNormal, key, 4 * number + k);
        const Ray leaving{point.originTowards(direction), direction, 0.0f, kInfinity};
        EXPECT_FALSE(traced.tracer->occluded(leaving))
            << levels << " levels, ray " << number << ": cosine "
            << glm::dot(direction, point.geometricNormal) << ", t " << traced.tracer->intersect(leaving).t;
      }
    });
    EXPECT_GT(rays, 5000);
  }
}

// RTC_SCENE_FLAG_ROBUST: a ray through a shared edge or corner meets one of its triangles.
TEST(SurfacePoints, ClosedBodiesHaveNoGapsAtEdgesAndCorners) {
  const ClosedMesh mesh = icosphere(3);
  const TracedScene traced = compileMesh(mesh);
  const TriangleMesh& compiled = traced.scene->meshes.front();
  const RandomKey key = randomKey(25);
  std::uint32_t rays = 0, misses = 0, packetMisses = 0;
  for (std::uint32_t i = 0; i < compiled.triangles.size(); ++i) {
    const Vec3d a(compiled.positions[compiled.triangles[i].x]);
    const Vec3d b(compiled.positions[compiled.triangles[i].y]);
    HitPacket packet;
    for (int lane = 0; lane < kPacketWidth; ++lane, ++rays) {
      // The corner itself, the edge's middle, and elsewhere on the edge.
      const double s = lane < 2 ? 0.0 : lane < 4 ? 0.5 : uniform(key, rays, 0);
      const Vec3d target = a + s * (b - a);
      const Vec3 origin =
          traced.point(Vec3d(0.3, 0.2, 0.1) + 0.4 * (Vec3d(uniformDirection(uniform2(key, rays, 1)))));
      const Ray ray{origin, Vec3(glm::normalize(target - Vec3d(origin))), 0.0f, kInfinity};
      packet.rays.set(lane, ray);
      misses += traced.tracer->intersect(ray).found() ? 0 : 1;
    }
    traced.tracer->intersect(packet, kPacketWidth, Coherence::Coherent);
    for (int lane = 0; lane < kPacketWidth; ++lane) packetMisses += packet.hit(lane).found() ? 0 : 1;
  }
  EXPECT_GT(rays, 9000u);
  EXPECT_EQ(misses, 0u) << "of " << rays;
  EXPECT_EQ(packetMisses, 0u) << "of " << rays;
}

TEST(CompiledScene, WarnsOfBrushingWithoutDirection) {
  for (const bool hasTangent : {false, true}) {
    SceneBuilder builder;
    MaterialDescription steel;
    steel.name = "steel";
    steel.layers.push_back({Rgb(0.5f), 0.6, 0.3});
    if (hasTangent) steel.tangent = Vec3d(1, 0, 0);
    const std::size_t material = builder.material(steel);
    builder.rectangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, material);
    builder.rectangle({0, 0, 2}, {1, 0, 0}, {0, 0, -1}, material);
    const TracedScene traced = builder.compile();
    const std::vector<std::string>& warnings = traced.scene->warnings;
    const auto about = std::count_if(warnings.begin(), warnings.end(), [](const std::string& warning) {
      return warning.find("'steel' has isotropy below 1") != std::string::npos;
    });
    EXPECT_EQ(about, hasTangent ? 0 : 1) << "once for the material";
  }
}

}  // namespace
}  // namespace lightvane
