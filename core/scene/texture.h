#pragma once

#include <memory>
#include <vector>

#include "core/scene/description.h"

namespace lightvane {

/// A texture ready to be asked. Immutable, any thread.
class Texture {
 public:
  /// The description's numbers must be in their ranges: the loader sees to that.
  explicit Texture(const TextureDescription& description);

  /// Asks for texture coordinates; others are solid and ask for a place.
  bool usesUv() const { return usesUv_; }

  /// The colour at a place in scene units and at texture coordinates, both over the use's scale. Components
  /// are in [0, 1].
  Rgb at(const Vec3d& place, const Vec2& uv) const;

 private:
  TexturePatternDescription pattern_;
  bool usesUv_ = false;
  Vec3d axis_{0.0, 0.0, 1.0}, across_{1.0, 0.0, 0.0}, deep_{0.0, 1.0, 0.0};  ///< of solid ones, orthonormal
};

}  // namespace lightvane
