#pragma once

#include <array>
#include <span>

#include "core/base/math.h"
#include "core/scene/scene.h"

namespace lightvane {

/// A convex part of space into which no surface reaches: a ball, cut by planes. Two points that are within
/// the ball, and higher than the margin over each of the planes, see each other, and no ray has to tell. Made
/// by Tracer::clearSpace; lengths are in normalised units.
///
/// Each surface that reaches into the ball is kept out by a plane that it lies behind: one that is there
/// already, its own, where the centre lies in that or well before it, or else the one that stands at right
/// angles on the shortest way from the centre to the surface. Where planes run out, the ball shrinks.
class ClearSpace {
 public:
  static constexpr int kMostPlanes = 8;

  /// Surfaces behind a plane may come before it by a quarter of the margin, which has to be some times the
  /// rounding of a coordinate.
  ClearSpace(const Vec3& centre, float radius, float margin)
      : centre_(centre), radius_(radius), margin_(margin) {}

  void keepOut(const Vec3& a, const Vec3& b, const Vec3& c);
  void keepOut(const SphereShape& sphere);
  void keepOut(const DiscShape& disc);

  struct Plane {
    Vec3 normal;   ///< unit, away from the surfaces behind it
    float offset;  ///< dot(normal, x) + offset is the height of x
  };

  const Vec3& centre() const { return centre_; }
  float radius() const { return radius_; }
  float margin() const { return margin_; }
  std::span<const Plane> planes() const { return {planes_.data(), static_cast<std::size_t>(count_)}; }

  bool holds(const Vec3& point) const;

 private:
  template <class Surface>
  void keepSurfaceOut(const Surface& surface);
  void add(const Plane& plane);

  Vec3 centre_;
  float radius_;
  float margin_;
  int count_ = 0;
  std::array<Plane, kMostPlanes> planes_;
};

}  // namespace lightvane
