#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "core/base/color.h"
#include "core/base/math.h"

namespace lightvane {

// Light sources, compiled: normalised units, float. Everything that sends light straight to a point.

/// One emitting piece of an area light.
struct EmitterTriangle {
  Vec3 a, b, c;       ///< front side by the right-hand rule
  Vec3 normal;        ///< unit
  float area;
};
struct EmitterSphere {
  Vec3 center;
  float radius;
};
struct EmitterDisc {
  Vec3 center;
  Vec3 normal;        ///< unit
  float radius;
};

struct PointLight {
  Vec3 position;
  Rgb intensity;
};
struct SpotLight {
  Vec3 position;
  Vec3 direction;  ///< unit, into the scene
  Rgb intensity;
  float cosInner, cosOuter;
};
struct DirectionalLight {
  Vec3 toLight;      ///< unit
  Rgb irradiance;    ///< on a facing surface
  float cosHalfAngle;  ///< 1 for a Dirac
};
struct VolumicSphereLight {
  std::vector<Vec3> points;
  Rgb intensity;  ///< of each point
};
/// One or more emitting shapes that count as one source.
struct AreaLight {
  std::vector<EmitterTriangle> triangles;
  std::vector<EmitterSphere> spheres;
  std::vector<EmitterDisc> discs;
  Rgb radiance;
  bool twoSided = false;
  /// The planar, convex outline of a light that is a single polygon, in order; empty otherwise. Lets one solid-angle
  /// map serve the whole light, which keeps the samples stratified across its triangles.
  std::vector<Vec3> polygon;
  std::vector<float> areaCdf;  ///< over triangles, spheres, discs in this order; ends at 1
  float totalArea = 0.0f;

  /// Fills areaCdf and totalArea from the pieces.
  void finish();
};

using Light = std::variant<PointLight, SpotLight, DirectionalLight, VolumicSphereLight, AreaLight>;

/// One direction from which a light reaches a point, if nothing stands between.
struct LightSample {
  Vec3 direction{0.0f};   ///< unit, from the point to the light
  float distance = 0.0f;  ///< normalised units; infinity for directional lights
  /// What the sample stands for, W m^-2 on a surface that faces it: radiance / density for lights with an extent, the
  /// irradiance itself for Dirac lights. Add f * cos * weight over the samples and divide by their number.
  Rgb weight{0.0f};
  float pdf = 0.0f;       ///< density over solid angle, sr^-1; 0 for Dirac lights
};

/// A sample of `light` as seen from `point`; no surface at the point is assumed. False where the light cannot reach it
/// (behind a one-sided light, outside a spot's cone); that counts as a sample of zero.
/// `u` in [0, 1)^2, stratified by the caller. Area lights are sampled by solid angle where a closed form exists
/// (polygons: spherical triangles; spheres: the cone), by area elsewhere and where the solid angle is too small for it.
bool sampleLight(const Light& light, const Vec3& point, const Vec2& u, LightSample& sample);

/// The density with which sampleLight would choose `direction` from `point`, where a ray that way meets piece `piece`
/// of the area light at `distance`, under `cosAtLight` (absolute). Pieces are numbered triangles first, then spheres,
/// then discs. 0 for Dirac lights.
float lightPdf(const Light& light, const Vec3& point, const Vec3& direction, std::uint32_t piece, float distance,
               float cosAtLight);

/// The density with which the direction `direction` is chosen for a light at infinity (directional with an angle);
/// 0 for all others and outside its cone.
float lightPdfAtInfinity(const Light& light, const Vec3& direction);
/// Radiance that arrives along a ray that leaves the scene in `direction` (a sun's disc); black for all others.
Rgb radianceFromInfinity(const Light& light, const Vec3& direction);

/// Lights that a ray of no extent cannot meet: point, spot, volumic sphere, directional without an angle.
bool isDirac(const Light& light);

/// An upper bound of the irradiance that `light` can give a surface at `point`: for choosing among lights. Never zero
/// where the light can reach the point.
float irradianceBound(const Light& light, const Vec3& point);

/// Radiant power in W, all colours' luminance: for statistics and for choosing among many lights. Directional lights
/// give their irradiance times `sceneRadius`^2 pi.
float lightPower(const Light& light, float sceneRadius);

/// The number of independent samples a source has to offer: 1 for a Dirac, the number of points for a volumic sphere,
/// 0 for no limit.
int distinctSamples(const Light& light);

}  // namespace lightvane
