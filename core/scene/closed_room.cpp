#include "core/scene/closed_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "core/scene/transform.h"

namespace lightvane {
namespace {

constexpr std::size_t kRoomRays = 64;
// From one ray, straight up, to all of them: out of doors the first ones leave the scene, and few triangles
// lie in their way.
constexpr std::array<std::size_t, 3> kRaysOfRounds = {1, 8, kRoomRays};
// Triangles that a round looks at, at most: a larger scene counts as open.
constexpr std::size_t kMostLooks = std::size_t{1} << 24;
// Bright, and below what a display shows as white.
constexpr double kMeanRadiance = 0.4;
// Of a room: reflectances of 0 and 1 would ask for lamps without end or without light.
constexpr double kDarkestRoom = 0.1, kWhitestRoom = 0.8;
// Between a ray and what it meets: what is met edgewise would count as a wall without end.
constexpr double kLeastCosine = 0.1;

/// A ray from the camera, and the nearest that it meets.
struct RoomRay {
  Vec3d direction;
  double length = std::numeric_limits<double>::infinity();
  double cosine = 1.0;
  std::size_t material = 0;

  bool meets() const { return std::isfinite(length); }
};

/// Evenly over the sphere (Fibonacci's spiral), from straight up down.
std::array<RoomRay, kRoomRays> raysAllAround() {
  std::array<RoomRay, kRoomRays> rays;
  const double turn = kPiD * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const double y = 1.0 - 2.0 * static_cast<double>(i) / (kRoomRays - 1.0);
    const double s = std::sqrt(std::max(0.0, 1.0 - y * y));
    const double angle = turn * static_cast<double>(i);
    rays[i].direction = {s * std::cos(angle), y, s * std::sin(angle)};
  }
  return rays;
}

/// Whether a ray from the origin enters the box before its end.
bool entersBox(const RoomRay& ray, const BoundsD& box) {
  double from = 0.0, to = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = ray.direction[axis];
    if (d == 0.0 && (box.lower[axis] > 0.0 || box.upper[axis] < 0.0)) return false;
    if (d == 0.0) continue;
    const double a = box.lower[axis] / d, b = box.upper[axis] / d;
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

/// Rays of one origin against a triangle about it: they meet it where they are on the same side of the three
/// planes through its sides. Neighbours have the plane of their common side to the bit.
void meetTriangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, std::size_t material,
                  std::span<RoomRay> rays) {
  const Vec3d ab = glm::cross(a, b), bc = glm::cross(b, c), ca = glm::cross(c, a);
  const Vec3d normal = ab + bc + ca;
  const double height = glm::dot(a, normal);
  for (RoomRay& ray : rays) {
    const double x = glm::dot(ab, ray.direction), y = glm::dot(bc, ray.direction),
                 z = glm::dot(ca, ray.direction);
    if (!(x >= 0.0 && y >= 0.0 && z >= 0.0) && !(x <= 0.0 && y <= 0.0 && z <= 0.0)) continue;
    const double slope = glm::dot(normal, ray.direction);
    const double length = height / slope;
    if (!(length > 0.0 && length < ray.length)) continue;
    ray.length = length;
    ray.cosine = std::abs(slope) / glm::length(normal);
    ray.material = material;
  }
}

bool letsLightPass(const MaterialDescription& material) {
  return material.isGlass() || !material.opacity.isFull();
}

/// What the scene's shapes are to rays that begin at one place.
class RoomTracer {
 public:
  RoomTracer(const SceneDescription& scene, const Vec3d& eye, LoadWatch& watch)
      : scene_(scene), eye_(eye), watch_(watch) {}

  /// False where there is too much to look at.
  bool trace(std::span<RoomRay> rays) {
    std::size_t looks = 0;
    for (const ShapeDescription& shape : scene_.shapes) {
      watch_.look();
      const auto* mesh = std::get_if<MeshDescription>(&shape.geometry);
      if (mesh == nullptr || !isInTheWay(shape, *mesh, rays)) continue;
      looks += mesh->geometry->triangles.size();
      if (looks > kMostLooks) return false;
      meetMesh(shape, *mesh, rays);
    }
    return true;
  }

 private:
  bool isInTheWay(const ShapeDescription& shape, const MeshDescription& mesh, std::span<const RoomRay> rays) {
    const auto [box, isNew] = boxes_.try_emplace(mesh.geometry.get());
    if (isNew) box->second = boundsOf<Vec3d>(mesh.geometry->positions);
    const Transform transform(shape.transform, mesh.placement);
    BoundsD placed;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d &lower = box->second.lower, &upper = box->second.upper;
      placed.add(transform.point({corner & 1 ? upper.x : lower.x, corner & 2 ? upper.y : lower.y,
                                  corner & 4 ? upper.z : lower.z}) -
                 eye_);
    }
    return std::any_of(rays.begin(), rays.end(), [&](const RoomRay& ray) { return entersBox(ray, placed); });
  }

  void meetMesh(const ShapeDescription& shape, const MeshDescription& mesh, std::span<RoomRay> rays) {
    const MeshGeometry& geometry = *mesh.geometry;
    const Transform transform(shape.transform, mesh.placement);
    positions_.clear();
    for (const Vec3d& position : geometry.positions) {
      watch_.piece(positions_.size());
      positions_.push_back(transform.point(position) - eye_);
    }
    for (std::size_t i = 0; i < geometry.triangles.size(); ++i) {
      watch_.piece(i);
      const std::size_t material =
          mesh.bringsMaterials() ? mesh.materials[geometry.triangleMaterials[i]] : shape.material;
      if (letsLightPass(scene_.materials[material])) continue;
      const glm::uvec3& corners = geometry.triangles[i];
      meetTriangle(positions_[corners.x], positions_[corners.y], positions_[corners.z], material, rays);
    }
  }

  const SceneDescription& scene_;
  Vec3d eye_;
  LoadWatch& watch_;
  std::map<const MeshGeometry*, BoundsD> boxes_;
  std::vector<Vec3d> positions_;  ///< of the mesh that is looked at, from the eye
};

/// A colour with its texture, by some places of a picture.
Rgb meanTextured(const SceneDescription& scene, const Rgb& color, const std::optional<TextureUse>& use) {
  const auto* image =
      use ? std::get_if<ImageTextureDescription>(&scene.textures[use->texture].pattern) : nullptr;
  if (image == nullptr || !image->pixels || isBlack(color)) return color;
  constexpr int kPlaces = 16;
  Vec3d sum(0.0);
  for (int y = 0; y < kPlaces; ++y) {
    for (int x = 0; x < kPlaces; ++x)
      sum += Vec3d(image->pixels->at((2 * x + 1) * image->pixels->width() / (2 * kPlaces),
                                     (2 * y + 1) * image->pixels->height() / (2 * kPlaces)));
  }
  return color * Rgb(sum / static_cast<double>(kPlaces * kPlaces));
}

double reflectanceOf(const SceneDescription& scene, const MaterialDescription& material) {
  Rgb color = meanTextured(scene, material.diffuse, material.textures.diffuse);
  color += meanTextured(scene, material.mirror, material.textures.mirror);
  for (std::size_t i = 0; i < material.layers.size(); ++i)
    color += meanTextured(scene, material.layers[i].color, material.textures.layers[i]);
  return std::clamp(static_cast<double>(color.r + color.g + color.b) / 3.0, 0.0, 1.0);
}

}  // namespace

std::optional<PointLightDescription> lampForClosedRoom(const SceneDescription& scene, LoadWatch& watch) {
  if (scene.cameras.empty()) return std::nullopt;
  const Vec3d eye = scene.cameras.front().position;
  std::array<RoomRay, kRoomRays> rays = raysAllAround();
  RoomTracer tracer(scene, eye, watch);
  std::size_t first = 0;
  for (const std::size_t end : kRaysOfRounds) {
    const std::span<RoomRay> round = std::span(rays).subspan(first, end - first);
    if (!tracer.trace(round)) return std::nullopt;
    if (!std::all_of(round.begin(), round.end(), [](const RoomRay& ray) { return ray.meets(); }))
      return std::nullopt;
    first = end;
  }
  double reflectance = 0.0, radius2 = 0.0;
  for (const RoomRay& ray : rays) {
    reflectance += reflectanceOf(scene, scene.materials[ray.material]) / kRoomRays;
    radius2 += square(ray.length) / (std::max(ray.cosine, kLeastCosine) * kRoomRays);
  }
  // As within a sphere whose walls are as large, 4 pi r^2: a lamp of I gives a radiance of I rho / (pi r^2 (1
  // - rho)), with what its walls send to each other.
  const double rho = std::clamp(reflectance, kDarkestRoom, kWhitestRoom);
  const double intensity = kMeanRadiance * kPiD * radius2 * (1.0 - rho) / rho;
  constexpr double kLargestIntensity = std::numeric_limits<float>::max();
  PointLightDescription lamp;
  lamp.position = eye + 0.5 * rays.front().length * rays.front().direction;
  lamp.intensity = Rgb(static_cast<float>(std::min(intensity, kLargestIntensity)));
  return lamp;
}

}  // namespace lightvane
