#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/scene/description.h"
#include "core/scene/direction_pair.h"

namespace lightvane {

// Microfacets whose normals follow Trowbridge and Reitz (JOSA 65(5), 1975), as Walter et al. ("Microfacet
// Models for Refraction through Rough Surfaces", EGSR 2007) use them and call GGX. f = S(u) D(t) G2 / (4 v
// v'), D = alpha^2 / (pi (1 + alpha^2 t^2 - t^2)^2), and Smith's G2 with the heights of masking and shadowing
// correlated (Heitz, "Understanding the Masking-Shadowing Function", JCGT 3(2), 2014, eq. 99):
//
//   G2 / (4 v v') = 1 / (2 (v' root(v) + v root(v'))),  root(c) = sqrt(alpha^2 + (1 - alpha^2) c^2),
//   G1(v) / v = 2 / (v + root(v)).
//
// Single scattering: what several facets reflect in turn is missing (of a white layer 59 % at alpha = 1, 12 %
// at 0.25).

/// One isotropic layer of these, without its colour factor S(u).
class GgxLayer {
 public:
  /// Below, a layer is a mirror (a roughness below 0.01). Directions in float are off by 6e-8 and with them
  /// H: a peak as narrow as this one is still resolved to 0.2 %, one of 1e-6 would be noise.
  static constexpr float kSmallestAlpha = 1e-4f;

  GgxLayer() = default;
  explicit GgxLayer(const LayerDescription& description);

  bool isMirror() const { return alpha_ == 0.0f; }

  /// D G2 / (4 v v'), sr^-1.
  float value(const DirectionPair& pair) const {
    const float v = pair.outgoing.z;
    const float shadowing = v * root(pair.incoming.z) + pair.incoming.z * root(v);
    return 0.5f * kInvPi * alpha2_ / std::max(square(pair.slopeRoot(alpha2_)) * shadowing, kSmallestDivisor);
  }

  /// Density of the direction that mirrors `outgoing` about sampleHalfVector's vector, sr^-1: D G1(v) / (4
  /// v), which integrates to 1 over the sphere.
  float pdf(const DirectionPair& pair) const {
    const float visible = pair.outgoing.z + root(pair.outgoing.z);
    return 0.5f * kInvPi * alpha2_ / std::max(square(pair.slopeRoot(alpha2_)) * visible, kSmallestDivisor);
  }
  /// A unit normal out of those that are seen along `outgoing` (Heitz, "Sampling the GGX Distribution of
  /// Visible Normals", JCGT 7(4), 2018), by a spherical cap (Dupuy & Benyoub, "Sampling Visible GGX Normals
  /// with Spherical Caps", 2023).
  ///
  /// Half vectors with the density D t, as Schlick's layer draws them, would leave weights G2 u / (v t) of up
  /// to 1 / alpha at grazing angles; here a sample weighs G2 / G1(v) <= 1, its density is nowhere 0, and few
  /// are lost below the horizon.
  Vec3 sampleHalfVector(const Vec3& outgoing, const Vec2& u) const;

  /// The shape's directional albedo for a direction of this cosine, and its moments. A mirror's too.
  LayerMoments moments(double cosine) const;
  /// Their means over a cosine-weighted hemisphere.
  LayerMoments meanMoments() const;

  /// See halfPeakWidth; pi/2 for a mirror, which has no lobe.
  float halfWidth() const { return isMirror() ? 0.5f * kPi : halfPeakWidth(alpha2_); }

 private:
  // Keeps values finite where both directions graze by less than 1e-17.
  static constexpr float kSmallestDivisor = 1e-37f;

  float root(float cosine) const { return std::sqrt(alpha2_ + (1.0f - alpha2_) * cosine * cosine); }

  float alpha_ = 1.0f;
  float alpha2_ = 1.0f;
};

}  // namespace lightvane
