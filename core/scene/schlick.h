#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/math.h"
#include "core/scene/description.h"
#include "core/scene/direction_pair.h"
#include "core/scene/direction_table.h"

namespace lightvane {

// Ch. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer Graphics Forum 13(3),
// 1994. In direction_pair.h's symbols, with w = cosine between the tangent (our x axis) and H projected on
// the surface. One layer: f = S(u) [ a/pi + b G(v) G(v') Z(t) A(w) / (4 pi v v') + c Dirac ]. a + b + c = 1:
// what is reflected is shared among a Lambertian, a glossy and a mirror-like part.

/// One layer, without its colour factor S(u).
class SchlickLayer {
 public:
  /// Isotropies are taken from here up to 1. The limit p = 0 has a peak without width and no energy (the mean
  /// of A over the azimuth is (2/pi) sqrt(p) K(sqrt(1 - p^2)): 0.067 here), and float directions cannot
  /// resolve a narrower peak: near grazing angles too many of them round to w = 0, and the albedo passes 1.
  static constexpr float kSmallestIsotropy = 1e-4f;
  /// Below, a layer is a mirror: the glossy share is under 4e-8.
  static constexpr float kSmallestRoughness = 1e-8f;

  SchlickLayer() = default;
  explicit SchlickLayer(const LayerDescription& description);

  float lambertShare() const { return lambert_; }  ///< a
  float glossyShare() const { return glossy_; }    ///< b
  float diracShare() const { return dirac_; }      ///< c
  bool isAnisotropic() const { return isotropy_ < 1.0f && glossy_ > 0.0f; }
  /// b = 0: neither Z nor A matter.
  bool hasGlossy() const { return glossy_ > 0.0f; }

  /// a/pi + b G G' Z A / (4 pi v v'), sr^-1, with Z(t) = r / (1 + r t^2 - t^2)^2 and 1 - t^2 from H itself.
  float value(const DirectionPair& pair) const {
    float f = lambert_ * kInvPi;
    if (hasGlossy()) f += glossy(pair);
    return f;
  }

  /// Density of the direction that mirrors `outgoing` about sampleHalfVector's vector, sr^-1.
  float pdf(const DirectionPair& pair) const {
    const float slopeRoot = pair.slopeRoot(roughness_);
    return 0.5f * kInvPi * roughness_ * (1.0f + azimuthSquared(pair)) * pair.jacobian /
           (slopeRoot * slopeRoot);
  }
  /// A unit half vector with the density Z(t) t (1 + A^2(w)) / (2 pi).
  ///
  /// Z by Schlick's inversion. A has no closed inverse (its integral is elliptic), and the paper's
  /// approximate one is exceeded by A by up to p^-1.5; A^2 has one, its mean is 1, and half of it with half a
  /// uniform azimuth never falls below A. For p = 1 it is the paper's.
  Vec3 sampleHalfVector(const Vec2& u) const;

  /// Divides the glossy term by max(1, R(incoming), R(outgoing)) from now on, R being its directional albedo
  /// over its share b. What is left is at most b, so that with a + b + c = 1 the layer reflects at most S
  /// <= 1.
  void limitEnergy();

  /// The glossy term over its share, unlimited, integrated over the incoming directions: R(outgoing) and its
  /// moments.
  LayerMoments glossyMoments(const Vec3& outgoing) const;
  /// max(1, R(direction)); 1 unless limitEnergy was called.
  float excess(const Vec3& direction) const {
    if (direction.z >= excessBelow_) return 1.0f;
    return std::max(1.0f, excess_.at(direction) / shadow(direction.z));
  }

  /// The angle by which the mirror direction turns when H moves from N to where Z A has half its peak; pi/2
  /// where nothing is glossy.
  float halfWidth() const;

 private:
  /// v / G(v).
  float shadow(float cosine) const { return roughness_ + (1.0f - roughness_) * cosine; }
  /// A^2(w) = p / (p^2 - p^2 w^2 + w^2); 1, its mean, where H = N leaves w without a meaning.
  float azimuthSquared(const DirectionPair& pair) const {
    if (isotropy_ == 1.0f) return 1.0f;
    const float denominator = isotropy_ * isotropy_ * pair.halfY2 + pair.halfX2;
    if (!(denominator > 1e-30f)) return 1.0f;
    return isotropy_ * (pair.halfX2 + pair.halfY2) / denominator;
  }
  float glossy(const DirectionPair& pair) const {
    // One division for Z, G and G' together.
    const float slopeRoot = pair.slopeRoot(roughness_);
    const float shadowing = shadow(pair.incoming.z) * shadow(pair.outgoing.z);
    float f = 0.25f * kInvPi * glossy_ * roughness_ / (slopeRoot * slopeRoot * shadowing);
    if (isotropy_ < 1.0f) f *= std::sqrt(azimuthSquared(pair));
    if (std::min(pair.incoming.z, pair.outgoing.z) < excessBelow_) {
      f /= std::max(excess(pair.incoming), excess(pair.outgoing));
    }
    return f;
  }

  float roughness_ = 1.0f;
  float isotropy_ = 1.0f;
  float lambert_ = 1.0f;
  float glossy_ = 0.0f;
  float dirac_ = 0.0f;
  float excessBelow_ = 0.0f;  ///< cosine from which on R <= 1
  /// R v / G(v): R without its pole at grazing angles, which interpolation would not follow.
  DirectionTable<float> excess_;
};

}  // namespace lightvane
