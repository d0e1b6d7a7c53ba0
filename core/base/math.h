#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/glm.hpp>

namespace lightvane {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec2d = glm::dvec2;
using Vec3d = glm::dvec3;

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr float kTwoPi = 2.0f * kPi;
inline constexpr float kInvPi = 1.0f / kPi;
inline constexpr double kPiD = 3.14159265358979323846;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline float square(float x) { return x * x; }
inline double square(double x) { return x * x; }

inline bool isFinite(const Vec3d& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

inline float maxComponent(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

/// 1 - cos(angle) between unit vectors, without the cancellation that 1 - dot(a, b) suffers for small angles.
inline float oneMinusCos(const Vec3& a, const Vec3& b) {
  const Vec3 difference = a - b;
  return 0.5f * glm::dot(difference, difference);
}

/// A direction about the z axis with density cos / pi, of `u` in [0, 1]^2.
inline Vec3 sampleCosine(const Vec2& u) {
  const float radius = std::sqrt(u.x);
  const float angle = kTwoPi * u.y;
  return {radius * std::cos(angle), radius * std::sin(angle), std::sqrt(std::max(0.0f, 1.0f - u.x))};
}

/// A place in the unit disc: the square of its radius, and its azimuth.
struct DiscPoint {
  double radiusSquared;
  double cosine, sine;
};
/// The unit square onto the unit disc; equal areas stay equal, neighbours neighbours (Shirley & Chiu, "A Low
/// Distortion Map Between Disk and Square", 1997).
inline DiscPoint concentricDisc(const Vec2d& u) {
  const double a = 2.0 * u.x - 1.0;
  const double b = 2.0 * u.y - 1.0;
  const bool aLeads = std::abs(a) > std::abs(b);
  const double leading = aLeads ? a : b;
  if (leading == 0.0) return {0.0, 1.0, 0.0};
  const double angle = 0.25 * kPiD * ((aLeads ? b : a) / leading);
  const double sign = std::copysign(1.0, leading);
  const double c = sign * std::cos(angle);
  const double s = sign * std::sin(angle);
  return aLeads ? DiscPoint{a * a, c, s} : DiscPoint{b * b, s, c};
}

/// A right-handed orthonormal basis: x and y span the tangent plane, z is the normal.
struct Frame {
  Vec3 x{1, 0, 0};
  Vec3 y{0, 1, 0};
  Vec3 z{0, 0, 1};

  /// Any frame about a unit normal; continuous but for the pole at z = -1.
  /// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
  static Frame aboutNormal(const Vec3& n) {
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float b = n.x * n.y * a;
    return {{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
  }

  /// The frame about unit normal `n` whose x axis is `tangent` projected on the surface; any frame where the
  /// tangent is parallel to the normal.
  static Frame aboutNormal(const Vec3& n, const Vec3& tangent) {
    const Vec3 projected = tangent - n * glm::dot(n, tangent);
    const float lengthSquared = glm::dot(projected, projected);
    if (!(lengthSquared > 1e-12f * glm::dot(tangent, tangent))) return aboutNormal(n);
    const Vec3 x = projected / std::sqrt(lengthSquared);
    return {x, glm::cross(n, x), n};
  }

  Vec3 toLocal(const Vec3& world) const {
    return {glm::dot(world, x), glm::dot(world, y), glm::dot(world, z)};
  }
  Vec3 toWorld(const Vec3& local) const { return local.x * x + local.y * y + local.z * z; }
};

/// An axis-aligned box; empty when made.
template <class V>
struct BoundsOf {
  V lower{std::numeric_limits<typename V::value_type>::infinity()};
  V upper{-std::numeric_limits<typename V::value_type>::infinity()};

  void add(const V& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
  void add(const BoundsOf& other) {
    lower = glm::min(lower, other.lower);
    upper = glm::max(upper, other.upper);
  }
  bool empty() const { return !(lower.x <= upper.x); }
  V centre() const { return lower + (upper - lower) * typename V::value_type(0.5); }
  typename V::value_type diagonal() const {
    return empty() ? typename V::value_type(0) : glm::length(upper - lower);
  }
};
using Bounds = BoundsOf<Vec3>;
using BoundsD = BoundsOf<Vec3d>;

struct Ball {
  Vec3 centre{0.0f};
  float radius = 0.0f;
};

/// Holds the positions of all items, rounding included.
template <class Items, class PositionOf>
Ball ballOf(const Items& items, const PositionOf& positionOf) {
  Bounds bounds;
  for (const auto& item : items) bounds.add(positionOf(item));
  Ball ball{bounds.centre(), 0.0f};
  for (const auto& item : items)
    ball.radius = std::max(ball.radius, glm::length(positionOf(item) - ball.centre));
  // Squares are compared: a point at the rim must not fall out by rounding.
  ball.radius *= 1.0f + 0x1p-20f;
  return ball;
}

}  // namespace lightvane
