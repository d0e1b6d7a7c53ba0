#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/color.h"
#include "core/base/math.h"

namespace lightvane {

// What the layer models have in common: Schlick's Fresnel factor S(u) = C + (1 - C)(1 - u)^5, the half vector
// H of two directions, and the shape of the peak about it. t = N.H, u = V.H, v = N.V, v' = N.V'.

/// (1 - u)^5.
inline float schlickFresnel(float cosine) {
  const float x = std::max(0.0f, 1.0f - cosine);
  const float x2 = x * x;
  return x2 * x2 * x;
}
/// S(u), from fresnel = (1 - u)^5.
inline Rgb schlickColor(const Rgb& color, float fresnel) { return color + (Rgb(1.0f) - color) * fresnel; }

/// What a pair of directions above the surface has to say to every layer: the half vector H, never normalised
/// by itself, so that nothing cancels at grazing angles.
struct DirectionPair {
  DirectionPair(const Vec3& incomingDirection, const Vec3& outgoingDirection)
      : incoming(incomingDirection), outgoing(outgoingDirection) {
    const Vec3 sum = incoming + outgoing;
    const float lengthSquared = glm::dot(sum, sum);
    // Below, squares underflow: a pair that grazes the surface, mirrored about N = H, u = 0.
    constexpr float kSmallest = 1e-30f;
    if (lengthSquared < kSmallest) {
      halfZ2 = 1.0f;
      fresnel = 1.0f;
      jacobian = 0.5f / std::sqrt(kSmallest);
      return;
    }
    const float inverse = 1.0f / lengthSquared;
    halfX2 = sum.x * sum.x * inverse;
    halfY2 = sum.y * sum.y * inverse;
    halfZ2 = sum.z * sum.z * inverse;
    fresnel = schlickFresnel(0.5f * std::sqrt(lengthSquared));
    jacobian = 0.5f * sum.z * inverse;
  }

  /// 1 + r t^2 - t^2 from H itself: Z(t) = r / slopeRoot^2, Schlick's and, with r = alpha^2, pi times
  /// Trowbridge and Reitz's distribution.
  float slopeRoot(float r) const { return halfX2 + halfY2 + r * halfZ2; }

  Vec3 incoming;
  Vec3 outgoing;
  float halfX2 = 0.0f, halfY2 = 0.0f, halfZ2 = 0.0f;  ///< squared components of the unit H; t^2 = halfZ2
  float fresnel = 0.0f;                               ///< (1 - u)^5
  float jacobian =
      0.0f;  ///< t / (4u): from projected solid angle of H to solid angle of the incoming direction
};

/// The angle by which the mirror direction turns when H moves from N to where Z has half its peak, that being
/// `across` times as far as where the peak is round; pi/2 at most, also where Z never falls to the half.
inline float halfPeakWidth(float r, float across = 1.0f) {
  // Z(t) = Z(1) / 2 where 1 + r t^2 - t^2 = sqrt(2) r: the sine of H's angle is then sqrt((sqrt(2) - 1) r /
  // (1 - r)).
  const float sine2 = (std::sqrt(2.0f) - 1.0f) * r;
  if (sine2 >= 1.0f - r) return 0.5f * kPi;
  // The mirror direction turns by twice the angle of H.
  return std::min(0.5f * kPi, 2.0f * std::asin(std::sqrt(sine2 / (1.0f - r))) * across);
}

/// The directional albedo of a layer's shape, and what it comes to when weighted by the Fresnel factor F = (1
/// - u)^5 and by F^2: enough for every colour of one or two layers.
using LayerMoments = std::array<double, 3>;

}  // namespace lightvane
