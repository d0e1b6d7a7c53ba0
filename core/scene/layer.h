#pragma once

#include "core/scene/ggx.h"
#include "core/scene/schlick.h"

namespace lightvane {

/// One layer of a material, of either model, without its colour factor S(u). A Ggx layer is all glossy or,
/// below GgxLayer::kSmallestAlpha, all Dirac.
///
/// Models are told apart by a flag rather than by a pointer: what the hot path asks for stays inlined behind
/// one branch, which goes the same way for all pairs of directions of a material.
class Layer {
 public:
  Layer() = default;
  explicit Layer(const LayerDescription& description);

  /// The same in another colour.
  Layer inColor(const Rgb& color) const {
    Layer colored = *this;
    colored.color_ = color;
    return colored;
  }

  const Rgb& color() const { return color_; }
  bool isGgx() const { return isGgx_; }
  float lambertShare() const { return isGgx_ ? 0.0f : schlick_.lambertShare(); }
  float glossyShare() const { return isGgx_ ? (ggx_.isMirror() ? 0.0f : 1.0f) : schlick_.glossyShare(); }
  float diracShare() const { return isGgx_ ? (ggx_.isMirror() ? 1.0f : 0.0f) : schlick_.diracShare(); }
  bool isAnisotropic() const { return !isGgx_ && schlick_.isAnisotropic(); }
  bool hasGlossy() const { return glossyShare() > 0.0f; }

  /// All but the Dirac part, sr^-1.
  float value(const DirectionPair& pair) const { return isGgx_ ? ggx_.value(pair) : schlick_.value(pair); }
  /// Density of the direction that mirrors `outgoing` about sampleHalfVector's vector, sr^-1. Only where
  /// hasGlossy.
  float pdf(const DirectionPair& pair) const { return isGgx_ ? ggx_.pdf(pair) : schlick_.pdf(pair); }
  Vec3 sampleHalfVector(const Vec3& outgoing, const Vec2& u) const {
    return isGgx_ ? ggx_.sampleHalfVector(outgoing, u) : schlick_.sampleHalfVector(u);
  }

  /// Keeps the layer's albedo at or below 1 from now on: see SchlickLayer::limitEnergy. A Ggx layer's never
  /// is above.
  void limitEnergy() {
    if (!isGgx_) schlick_.limitEnergy();
  }
  /// The albedo at most of all but the Dirac part, and its moments, from those of 1/pi.
  LayerMoments moments(const Vec3& outgoing, const LayerMoments& lambert) const;
  /// The cosine-weighted means over all directions of the moments of a Ggx layer, its Dirac part too.
  LayerMoments meanMoments() const { return ggx_.meanMoments(); }

  float halfWidth() const { return isGgx_ ? ggx_.halfWidth() : schlick_.halfWidth(); }

 private:
  Rgb color_{0.0f};
  bool isGgx_ = false;
  SchlickLayer schlick_;
  GgxLayer ggx_;
};

/// The albedo of S(u) times a shape of these moments: C m0 + (1 - C) m1.
inline Rgb coloredAlbedo(const Rgb& color, const LayerMoments& moments) {
  return color * static_cast<float>(moments[0]) + (Rgb(1.0f) - color) * static_cast<float>(moments[1]);
}

}  // namespace lightvane
