#pragma once

#include <memory>
#include <vector>

#include "core/scene/description.h"
#include "core/scene/normalisation.h"

namespace lightvane {

/// A texture ready to be asked. Immutable, any thread.
class Texture {
 public:
  /// The description's numbers must be in their ranges: the loader sees to that.
  explicit Texture(const TextureDescription& description);

  /// Asks for texture coordinates; others are solid and ask for a place.
  bool usesUv() const { return usesUv_; }
  /// The picture that it shows; null for other kinds.
  const ImageTextureDescription* image() const { return std::get_if<ImageTextureDescription>(&pattern_); }

  /// Texture coordinates, kept within where single precision has fractions.
  static Vec2 withinReach(const Vec2& uv);

  /// The colour at a place in scene units and at texture coordinates, both over the use's scale. Components
  /// are in [0, 1].
  Rgb at(const Vec3d& place, const Vec2& uv) const;

 private:
  TexturePatternDescription pattern_;
  bool usesUv_ = false;
  Vec3d axis_{0.0, 0.0, 1.0}, across_{1.0, 0.0, 0.0}, deep_{0.0, 1.0, 0.0};  ///< of solid ones, orthonormal
};

/// The colour of a texture as a surface uses it, at a place in normalised units and at texture coordinates.
Rgb placedColor(const Texture& texture, const TextureUse& use, const Normalisation& normalisation,
                const Vec3& position, const Vec2& uv);

/// Texture coordinates of a sphere at a unit normal: longitude about y and latitude, as on a globe whose
/// map's middle is seen from +z, with y up.
Vec2 sphereUv(const Vec3& normal);

/// Those of a disc: over the square around it. `normal` is unit; lengths are of any one unit.
Vec2 discUv(const Vec3& center, const Vec3& normal, float radius, const Vec3& position);

}  // namespace lightvane
