#pragma once

#include <cstdint>

#include "core/base/color.h"
#include "core/base/math.h"
#include "core/base/random.h"

namespace lightvane {

// The light vectors themselves (paper, sections 4.1 and 5.3). Positions and distances are in normalised
// units, world space; energies in normalised radiometric units. All fields are a pure function of the point,
// the parameters and the seed, Birth apart.

/// Which tree a vector belongs to. Vectors are interpolated with others of the same key only.
using SurfaceKey = std::uint32_t;

/// The key of irradiance: shared by the Lambertian part of every surface.
inline constexpr SurfaceKey kLambertKey = 0;
/// Lobes, and whole BRDFs under the paper's own rules, have a key for each BRDF.
constexpr SurfaceKey brdfSurfaceKey(std::uint32_t brdfKey) { return brdfKey + 1; }

/// When a vector was computed and why it was there.
struct Birth {
  std::uint32_t pass = 0;        ///< 0 is the seed
  std::uint32_t order = 0;       ///< its number among the pass's vectors of its kind
  std::uint32_t pixel = 0;       ///< index of the picture's pixel that asked for it
  std::uint32_t rays = 0;        ///< its cost
  RandomKey identity;            ///< of its random numbers: a hash of all that it is a function of
  bool throughSpecular = false;  ///< the pixel sees it by way of a mirror or glass
};

/// What both kinds of vectors know of the point they belong to.
struct VectorPoint {
  Vec3 position{0.0f};
  Vec3 normal{0, 0, 1};    ///< shading normal, viewer's side, unit
  Vec3 tangent{1, 0, 0};   ///< with `normal` the coordinate system tangent to the surface
  Vec3 outgoing{0, 0, 1};  ///< towards the viewer, unit
  SurfaceKey key = kLambertKey;
  float footprint = 0.0f;  ///< width that a pixel of a picture 256 pixels high has here
};

/// A Direct Light Vector: what one light gives one point.
struct DirectLightVector {
  VectorPoint point;
  Vec3 direction{0.0f};     ///< D; zero where the light is wholly occluded
  float solidAngle = 0.0f;  ///< subtended by the light, sr
  /// `dlv.store = split`: irradiance. `vector`: P = L / f_r,d(D), eq. 4.
  Rgb energy{0.0f};
  Rgb lobeRadiance{0.0f};  ///< split only: what the lobe sends along `outgoing`
  bool occluded = false;
  Birth birth;
};

/// An Indirect Light Vector: what arrives at a point after at least one reflection.
struct IndirectLightVector {
  VectorPoint point;
  Vec3 direction{0.0f};  ///< D, section 5.2.2
  /// Split: irradiance (key kLambertKey), or the lobe's outgoing radiance with its colour already in.
  /// Vector: P = L / f_r,d(D), eq. 4.
  Rgb energy{0.0f};
  Rgb irradiance{0.0f};  ///< E of eq. 1; what gradients are relative to
  /// d energy / d position for each colour, per normalised unit of length, in the tangent plane.
  Vec3 gradient[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
  /// d energy / d rotation of the normal for each colour: an axis vector, per radian.
  Vec3 rotation[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
  float arithmeticMean = kInfinity;  ///< of the first hits' distances
  float harmonicMean = kInfinity;
  float leastDistance = kInfinity;
  float lobeWidth = 0.0f;  ///< half width of the lobe, radians; 0 for irradiance, which never expires
  Birth birth;
};

/// The name of the place that a vector belongs to: what Birth::identity is made of, but for seed and light.
/// Vectors of one place, kind and light stand for each other, whatever numbers they were computed with.
RandomKey placeKey(const IndirectLightVector& record);
RandomKey placeKey(const DirectLightVector& record);

}  // namespace lightvane
