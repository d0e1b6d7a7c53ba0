#include "core/trace/clear_space.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

using Plane = ClearSpace::Plane;

double heightOver(const Plane& plane, const Vec3d& point) {
  return glm::dot(Vec3d(plane.normal), point) + static_cast<double>(plane.offset);
}

Plane planeThrough(const Vec3d& place, const Vec3d& normal) {
  const Vec3 rounded(normal);
  return {rounded, static_cast<float>(-glm::dot(Vec3d(rounded), place))};
}

/// A surface as ClearSpace sees it: what of it is nearest to a place, how high it reaches over a plane, and
/// the plane that it lies in, with a normal of any length; zero where it lies in none.
struct Triangle {
  Vec3d a, b, c;

  /// Ericson, Real-Time Collision Detection (2005), section 5.1.5.
  Vec3d nearestTo(const Vec3d& p) const {
    const Vec3d ab = b - a, ac = c - a, ap = p - a;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const Vec3d bp = p - b;
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
    const Vec3d cp = p - c;
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
      return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
    return a + (vb * ab + vc * ac) / (va + vb + vc);
  }
  double greatestHeight(const Plane& plane) const {
    return std::max({heightOver(plane, a), heightOver(plane, b), heightOver(plane, c)});
  }
  Vec3d normal() const { return glm::cross(b - a, c - a); }
  Vec3d place() const { return a; }
};

struct Sphere {
  Vec3d centre;
  double radius;

  Vec3d nearestTo(const Vec3d& p) const {
    const Vec3d way = p - centre;
    return centre + radius / glm::length(way) * way;
  }
  double greatestHeight(const Plane& plane) const { return heightOver(plane, centre) + radius; }
  static Vec3d normal() { return Vec3d(0.0); }
  Vec3d place() const { return centre; }
};

struct Disc {
  Vec3d centre, axis;
  double radius;

  Vec3d nearestTo(const Vec3d& p) const {
    const Vec3d way = p - centre;
    const Vec3d inPlane = way - glm::dot(way, axis) * axis;
    const double length = glm::length(inPlane);
    return centre + (length > radius ? radius / length : 1.0) * inPlane;
  }
  double greatestHeight(const Plane& plane) const {
    const double cosine = glm::dot(Vec3d(plane.normal), axis);
    return heightOver(plane, centre) + radius * std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  }
  Vec3d normal() const { return axis; }
  Vec3d place() const { return centre; }
};

}  // namespace

void ClearSpace::keepOut(const Vec3& a, const Vec3& b, const Vec3& c) {
  keepSurfaceOut(Triangle{Vec3d(a), Vec3d(b), Vec3d(c)});
}

void ClearSpace::keepOut(const SphereShape& sphere) {
  keepSurfaceOut(Sphere{Vec3d(sphere.center), static_cast<double>(sphere.radius)});
}

void ClearSpace::keepOut(const DiscShape& disc) {
  keepSurfaceOut(Disc{Vec3d(disc.center), Vec3d(disc.normal), static_cast<double>(disc.radius)});
}

template <class Surface>
void ClearSpace::keepSurfaceOut(const Surface& surface) {
  const double tolerance = 0.25 * static_cast<double>(margin_);
  const auto isBehind = [&](const Plane& plane) { return surface.greatestHeight(plane) <= tolerance; };
  const std::span<const Plane> known = planes();
  if (std::any_of(known.begin(), known.end(), isBehind)) return;
  const Vec3d centre(centre_);
  const Vec3d nearest = surface.nearestTo(centre);
  const Vec3d way = centre - nearest;
  const double distance = glm::length(way);
  if (distance >= static_cast<double>(radius_)) return;
  const Vec3d normal = surface.normal();
  const double size = glm::length(normal);
  if (size > 0.0) {
    const double height = glm::dot(normal, centre - surface.place()) / size;
    const Plane own = planeThrough(surface.place(), (height < 0.0 ? -1.0 : 1.0) / size * normal);
    // The other triangles of a wall lie in that, too.
    const bool passesCentre = std::abs(height) <= 8.0 * static_cast<double>(margin_);
    if ((passesCentre || std::abs(height) >= 0.5 * distance) && isBehind(own)) return add(own);
  }
  if (distance > 0.0) {
    const Plane between = planeThrough(nearest, way / distance);
    if (isBehind(between)) return add(between);
  }
  // It is too near, or it lies around the centre. (Nothing of it is nearer, and what is not a number is not.)
  radius_ = distance > 0.0 ? std::nextafter(static_cast<float>(distance), 0.0f) : 0.0f;
}

void ClearSpace::add(const Plane& plane) {
  const auto heightOfCentre = [&](const Plane& each) { return heightOver(each, Vec3d(centre_)); };
  Plane left = plane;
  if (count_ < kMostPlanes) {
    planes_[static_cast<std::size_t>(count_++)] = plane;
    return;
  }
  // What lies behind a plane is no nearer than the plane: without the farthest, the ball ends there.
  Plane& farthest = *std::max_element(
      planes_.begin(), planes_.end(),
      [&](const Plane& one, const Plane& other) { return heightOfCentre(one) < heightOfCentre(other); });
  if (heightOfCentre(plane) < heightOfCentre(farthest)) std::swap(left, farthest);
  // Behind, up to the tolerance.
  const double height = heightOfCentre(left) - static_cast<double>(margin_);
  radius_ = std::min(radius_, std::max(0.0f, static_cast<float>(height)));
}

bool ClearSpace::holds(const Vec3& point) const {
  const Vec3 away = point - centre_;
  const std::span<const Plane> cuts = planes();
  return glm::dot(away, away) < radius_ * radius_ &&
         std::all_of(cuts.begin(), cuts.end(), [&](const Plane& plane) {
           return glm::dot(plane.normal, point) + plane.offset > margin_;
         });
}

}  // namespace lightvane
