#pragma once

#include "core/base/math.h"

namespace lightvane {

/// How the scene's own numbers become the renderer's: lengths so that the scene fits a box of about 1 around
/// the origin, radiances so that the brightest is about 1. Both factors are powers of two, so that scaling a
/// scene by a power of two changes no bit of what is computed.
struct Normalisation {
  Vec3d centre{0.0};         ///< in scene units
  int lengthExponent = 0;    ///< scene units = centre + normalised * 2^lengthExponent
  int radianceExponent = 0;  ///< W m^-2 sr^-1 = normalised * 2^radianceExponent

  Vec3 point(const Vec3d& scenePoint) const;
  float length(double sceneLength) const;
  Vec3d scenePoint(const Vec3& normalised) const;
  double sceneLength(double normalised) const;
  float radianceScale() const;  ///< 2^radianceExponent
};

}  // namespace lightvane
