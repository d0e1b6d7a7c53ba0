#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/load_watch.h"
#include "core/base/math.h"

namespace lightvane {

// Polygons as files give them, in double. Everything is reckoned relative to the polygon's size, the longest
// side of its bounds, so that it holds for any finite coordinates.

/// The unit normal by the right-hand rule (Newell: that of the best plane where the vertices are not in one);
/// zero where the vertices enclose no area.
Vec3d polygonNormal(std::span<const Vec3d> vertices);

/// Why a polygon cannot be used.
struct PolygonFault {
  std::size_t vertex;  ///< index of the vertex to look at
  std::string what;
  std::string hint;
};

/// The largest distance of a vertex from its polygon's plane, in units of the polygon's size: room for
/// coordinates written with six digits.
inline constexpr double kPlanarTolerance = 1e-5;

/// Tells whether vertices are a planar, convex polygon with an area; nothing is returned where they are.
std::optional<PolygonFault> findPolygonFault(std::span<const Vec3d> vertices);

/// Cuts any polygon into vertices - 2 triangles of the same orientation, as indices of its vertices: by
/// cutting ears, which is right for planar polygons that do not cross themselves, convex or not; others get
/// some triangles too. Quadratic in the number of vertices for convex polygons, cubic at worst.
/// Throws LoadStopped as `watch` says.
std::vector<glm::uvec3> triangulate(std::span<const Vec3d> vertices, LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
