#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/check.h"
#include "core/trace/direct_light.h"

namespace lightvane::trace_test {

/// Of the unit cube.
inline Vec3d randomPoint(RandomKey key, std::uint32_t i, std::uint32_t dimension) {
  return {uniform(key, i, dimension), uniform(key, i, dimension + 1), uniform(key, i, dimension + 2)};
}

/// A scene with what traces it. Closed forms are in scene units; the helpers convert both ways.
struct TracedScene {
  explicit TracedScene(std::shared_ptr<const Scene> compiled)
      : scene(std::move(compiled)), tracer(std::make_unique<Tracer>(scene)) {}

  Vec3 point(const Vec3d& scenePoint) const { return scene->normalisation.point(scenePoint); }
  /// One normalised unit of length in scene units.
  double unitLength() const { return scene->normalisation.sceneLength(1.0); }
  /// Radiances and irradiances alike: normalised times this is what the description said.
  double unitRadiance() const { return static_cast<double>(scene->normalisation.radianceScale()); }

  Ray ray(const Vec3d& sceneOrigin, const Vec3d& direction) const {
    return {point(sceneOrigin), Vec3(glm::normalize(direction)), 0.0f, kInfinity};
  }
  /// What a ray meets, seen from where it comes from.
  LitPoint litPoint(const Vec3d& sceneOrigin, const Vec3d& direction) const {
    const Ray r = ray(sceneOrigin, direction);
    const Hit hit = tracer->intersect(r);
    LV_CHECK(hit.found(), "the ray from ({}, {}, {}) meets nothing", sceneOrigin.x, sceneOrigin.y,
             sceneOrigin.z);
    return {tracer->surfaceAt(r, hit), -r.direction};
  }
  /// A surface of the given material that is not there: it receives light, and changes none.
  LitPoint imaginaryPoint(const Vec3d& scenePoint, const Vec3d& normal, std::size_t material,
                          const Vec3d& outgoing) const {
    LitPoint lit;
    lit.surface.position = point(scenePoint);
    lit.surface.geometricNormal = Vec3(glm::normalize(normal));
    lit.surface.frame = Frame::aboutNormal(lit.surface.geometricNormal);
    lit.surface.material = static_cast<std::uint32_t>(material);
    lit.outgoing = Vec3(glm::normalize(outgoing));
    return lit;
  }

  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Tracer> tracer;
};

/// Describes a scene shape by shape.
class SceneBuilder {
 public:
  SceneBuilder() {
    description_.name = "test";
    description_.cameras.emplace_back();
  }

  std::size_t material(const MaterialDescription& m) {
    description_.materials.push_back(m);
    return description_.materials.size() - 1;
  }
  std::size_t diffuse(const Rgb& reflectance, const Rgb& emission = Rgb(0.0f)) {
    MaterialDescription m;
    m.diffuse = reflectance;
    m.emission = emission;
    return material(m);
  }
  std::size_t mirror(const Rgb& reflectance) {
    MaterialDescription m;
    m.mirror = reflectance;
    return material(m);
  }
  std::size_t glass(double ior) {
    MaterialDescription m;
    m.transmission = Rgb(1.0f);
    m.ior = ior;
    return material(m);
  }
  std::size_t glossy(const Rgb& color, double roughness) {
    MaterialDescription m;
    m.layers.push_back({color, roughness, 1.0});
    return material(m);
  }

  SceneBuilder& polygon(std::vector<Vec3d> vertices, std::size_t material, const std::string& light = {}) {
    return shape(PolygonDescription{std::move(vertices)}, material, light);
  }
  /// The front side is where u x v points.
  SceneBuilder& rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v, std::size_t material) {
    return polygon({corner, corner + u, corner + u + v, corner + v}, material);
  }
  SceneBuilder& sphere(const Vec3d& center, double radius, std::size_t material) {
    return shape(SphereDescription{center, radius}, material, {});
  }
  SceneBuilder& disc(const Vec3d& center, const Vec3d& normal, double radius, std::size_t material) {
    return shape(DiscDescription{center, normal, radius}, material, {});
  }
  SceneBuilder& box(const Vec3d& min, const Vec3d& max, std::size_t material) {
    return shape(BoxDescription{min, max}, material, {});
  }
  SceneBuilder& mesh(std::vector<Vec3d> positions, std::vector<glm::uvec3> triangles, std::size_t material) {
    MeshGeometry m;
    m.positions = std::move(positions);
    m.triangles = std::move(triangles);
    return mesh(std::make_shared<const MeshGeometry>(std::move(m)), material);
  }
  SceneBuilder& mesh(std::shared_ptr<const MeshGeometry> triangles, std::size_t material,
                     const glm::dmat4& placement = glm::dmat4(1.0)) {
    MeshDescription m;
    m.geometry = std::move(triangles);
    m.placement = placement;
    return shape(std::move(m), material, {});
  }
  SceneBuilder& light(LightGeometryDescription geometry) {
    description_.lights.push_back({"", std::move(geometry)});
    return *this;
  }
  /// The cube [0, 1]^3 seen from inside, with six lights or one.
  SceneBuilder& closedCube(std::size_t material, const std::string& light = {});

  SceneDescription& description() { return description_; }
  TracedScene compile() const {
    Expected<std::shared_ptr<const Scene>> scene = Scene::compile(description_);
    LV_CHECK(scene.has_value(), "{}", scene.error().what);
    return TracedScene(*scene);
  }

 private:
  SceneBuilder& shape(GeometryDescription geometry, std::size_t material, const std::string& light) {
    ShapeDescription s;
    s.material = material;
    s.light = light;
    s.geometry = std::move(geometry);
    description_.shapes.push_back(std::move(s));
    return *this;
  }

  SceneDescription description_;
};

inline SceneBuilder& SceneBuilder::closedCube(std::size_t material, const std::string& light) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {0.0, 1.0}) {
      std::vector<Vec3d> corners(4, Vec3d(0.0));
      for (Vec3d& corner : corners) corner[axis] = side;
      corners[1][side == 0.0 ? u : v] = 1.0;
      corners[2][u] = corners[2][v] = 1.0;
      corners[3][side == 0.0 ? v : u] = 1.0;
      polygon(std::move(corners), material, light);
    }
  }
  return *this;
}

}  // namespace lightvane::trace_test
