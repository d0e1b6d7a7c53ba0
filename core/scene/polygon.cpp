#include "core/scene/polygon.h"

#include <array>
#include <numeric>

#include <fmt/format.h>

namespace lightvane {
namespace {

/// Vertices about their bounds' centre, in units of `size`.
struct NormalisedPolygon {
  std::vector<Vec3d> points;
  double size = 0.0;  ///< 0 where all vertices are the same point

  explicit NormalisedPolygon(std::span<const Vec3d> vertices) {
    BoundsD bounds;
    for (const Vec3d& v : vertices) bounds.add(v);
    if (bounds.empty()) return;
    const Vec3d extent = bounds.upper - bounds.lower;
    size = std::max({extent.x, extent.y, extent.z});
    const double divisor = size > 0.0 ? size : 1.0;
    points.reserve(vertices.size());
    for (const Vec3d& v : vertices) points.push_back((v - bounds.centre()) / divisor);
  }

  std::size_t next(std::size_t i) const { return i + 1 == points.size() ? 0 : i + 1; }

  /// Newell's normal, twice as long as the area.
  Vec3d doubleArea() const {
    Vec3d sum(0.0);
    for (std::size_t i = 0; i < points.size(); ++i) sum += glm::cross(points[i], points[next(i)]);
    return sum;
  }

  /// Unit, or zero where the area is no more than what rounding leaves of none.
  Vec3d normal() const {
    const Vec3d sum = doubleArea();
    const double length = glm::length(sum);
    return length > 1e-14 ? sum / length : Vec3d(0.0);
  }
};

std::optional<PolygonFault> findBentVertex(const NormalisedPolygon& polygon, const Vec3d& normal) {
  const std::vector<Vec3d>& p = polygon.points;
  const Vec3d centroid = std::accumulate(p.begin(), p.end(), Vec3d(0.0)) / static_cast<double>(p.size());
  const auto distanceOf = [&](const Vec3d& point) { return std::abs(glm::dot(normal, point - centroid)); };
  const auto farthest = std::max_element(
      p.begin(), p.end(), [&](const Vec3d& a, const Vec3d& b) { return distanceOf(a) < distanceOf(b); });
  const double distance = distanceOf(*farthest);
  if (distance <= kPlanarTolerance) return std::nullopt;
  const auto vertex = static_cast<std::size_t>(farthest - p.begin());
  return PolygonFault{
      vertex,
      fmt::format("not planar: vertex {} is {:.3g} off the plane, {:.2g} of the polygon's size "
                  "(up to {:g} counts as planar)",
                  vertex + 1, distance * polygon.size, distance, kPlanarTolerance),
      "split it into triangles"};
}

/// Convex: no corner turns the other way (but for the rounding of vertices on a straight edge), none folds
/// back, and all turns together make one round, where a star makes two.
std::optional<PolygonFault> findInwardVertex(const NormalisedPolygon& polygon, const Vec3d& normal) {
  const std::vector<Vec3d>& p = polygon.points;
  if (p.size() == 3) return std::nullopt;
  double turned = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const std::size_t corner = polygon.next(i);
    const Vec3d in = p[corner] - p[i];
    const Vec3d out = p[polygon.next(corner)] - p[corner];
    const double sine = glm::dot(normal, glm::cross(in, out));
    const double cosine = glm::dot(in, out);
    const bool turnsInwards = -sine > kPlanarTolerance * glm::length(in + out);
    const bool foldsBack = sine <= 0.0 && cosine < 0.0;
    if (turnsInwards || foldsBack) {
      return PolygonFault{corner, fmt::format("not convex at vertex {}", corner + 1),
                          "split it into convex polygons"};
    }
    turned += std::atan2(sine, cosine);
  }
  if (turned > 3.0 * kPiD) {
    return PolygonFault{0, "not convex: its outline crosses itself", "split it into convex polygons"};
  }
  return std::nullopt;
}

/// Whether `point` is in the triangle or on its edge; `normal` is that of the triangle's polygon.
bool isInTriangle(const Vec3d& point, const std::array<Vec3d, 3>& triangle, const Vec3d& normal) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d edge = triangle[(i + 1) % 3] - triangle[i];
    if (glm::dot(normal, glm::cross(edge, point - triangle[i])) < 0.0) return false;
  }
  return true;
}

}  // namespace

Vec3d polygonNormal(std::span<const Vec3d> vertices) { return NormalisedPolygon(vertices).normal(); }

std::optional<PolygonFault> findPolygonFault(std::span<const Vec3d> vertices) {
  if (vertices.size() < 3) {
    return PolygonFault{0, fmt::format("expected at least 3 vertices, found {}", vertices.size()), {}};
  }
  const NormalisedPolygon polygon(vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::size_t next = polygon.next(i);
    if (vertices[i] == vertices[next]) {
      return PolygonFault{next, fmt::format("vertices {} and {} are the same point", i + 1, next + 1),
                          "leave one out"};
    }
  }
  const Vec3d normal = polygon.normal();
  if (normal == Vec3d(0.0)) return PolygonFault{0, "the vertices enclose no area", {}};
  if (std::optional<PolygonFault> bent = findBentVertex(polygon, normal)) return bent;
  return findInwardVertex(polygon, normal);
}

// To look for an ear takes up to the square of the vertices that are left, in steps of some nanoseconds; for
// polygons that are smaller, their caller looks at the watch.
constexpr std::size_t kFewVertices = 16;
constexpr std::size_t kManyVertices = 256;

std::vector<glm::uvec3> triangulate(std::span<const Vec3d> vertices, LoadWatch& watch) {
  std::vector<glm::uvec3> triangles;
  if (vertices.size() < 3) return triangles;
  const NormalisedPolygon polygon(vertices);
  const std::vector<Vec3d>& p = polygon.points;
  const Vec3d normal = polygon.normal();

  std::vector<std::uint32_t> left(vertices.size());
  std::iota(left.begin(), left.end(), 0U);
  while (left.size() > 3) {
    // An ear turns outwards and holds no other vertex. Where there is none (a polygon that crosses itself or
    // has no area), the first corner goes, for the loop to end.
    std::size_t ear = 0;
    if (left.size() > kFewVertices) watch.look();
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left.size() > kManyVertices) watch.look();
      const std::size_t j = (i + 1) % left.size();
      const std::size_t k = (i + 2) % left.size();
      const std::array<Vec3d, 3> corner = {p[left[i]], p[left[j]], p[left[k]]};
      if (!(glm::dot(normal, glm::cross(corner[1] - corner[0], corner[2] - corner[1])) > 0.0)) continue;
      const bool holdsAnother = std::any_of(left.begin(), left.end(), [&](std::uint32_t v) {
        return p[v] != corner[0] && p[v] != corner[1] && p[v] != corner[2] &&
               isInTriangle(p[v], corner, normal);
      });
      if (holdsAnother) continue;
      ear = i;
      break;
    }
    const std::size_t tip = (ear + 1) % left.size();
    triangles.emplace_back(left[ear], left[tip], left[(ear + 2) % left.size()]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
  }
  triangles.emplace_back(left[0], left[1], left[2]);
  return triangles;
}

}  // namespace lightvane
