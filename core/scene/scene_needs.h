#pragma once

#include <cstdint>
#include <vector>

namespace lightvane {

/// What a scene requires of the renderer, worked out once when it is compiled. A stage that is not needed is
/// not run, not stored and not shown.
struct SceneNeeds {
  bool specular = false;  ///< mirror, glass or a Dirac lobe: visible points need a stack of specular events
  bool glass = false;     ///< refraction: two branches an event
  bool panes = false;     ///< what shadow rays pass, at least in part: an acceleration structure with and one
                          ///< without
  bool lobes = false;     ///< non-Lambertian f_r,d: lobe records and outgoing directions
  bool diffuse = false;   ///< Lambertian parts: irradiance records
  bool anisotropy = false;  ///< tangents
  bool textures = false;    ///< texture coordinates, and what textures leave of colours
  bool areaLights = false;
  bool infiniteLights = false;  ///< light from outside the scene's bounds
  bool smoothNormals = false;   ///< vertex normals that differ from the geometric ones
  bool analyticShapes = false;  ///< spheres or discs: user geometry
  /// Dirac lights in a scene with mirrors or glass: their light by way of those is found by no method here.
  bool missingCaustics = false;
};

}  // namespace lightvane
