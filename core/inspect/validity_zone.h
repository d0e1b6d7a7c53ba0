#pragma once

#include <optional>

#include "core/inspect/overlay.h"
#include "core/vectors/validity.h"

namespace lightvane {

// Where a vector may be used, as a figure in its tangent plane: for points there that have the vector's own
// normal. What else refuses a vector (visibility, clearance, the lobe) depends on the point.

/// An ILV's zone: radius and gradient test under the rules, the rim by S_curv. Colour and record are the
/// caller's. Nothing where it is valid nowhere but at its own place.
std::optional<OverlayZone> validityZone(const IndirectLightVector& record, const IlvRules& rules);

/// A DLV's zone: r_max (normalised units), the rim by dlv.normal_cosine.
std::optional<OverlayZone> directZone(const DirectLightVector& record, const DlvParameters& parameters,
                                      float rMax);

/// Whether the zone has the point centre + uv.x axisU + uv.y axisV: what the shader asks for every pixel.
inline bool zoneContains(const OverlayZone& zone, const Vec2& uv) {
  if (!(uv.x * uv.x + uv.y * uv.y <= 1.0f)) return false;
  if (zone.cutU == 0.0f && zone.cutV == 0.0f) return true;
  const float across = zone.cutU * uv.x + zone.cutV * uv.y;
  return zone.cutLow <= across && across <= zone.cutHigh;
}

/// The coordinates of a point, projected along the zone's normal.
inline Vec2 zoneCoordinates(const OverlayZone& zone, const Vec3& point) {
  const Vec3 offset = point - zone.centre;
  return {glm::dot(offset, zone.axisU) / glm::dot(zone.axisU, zone.axisU),
          glm::dot(offset, zone.axisV) / glm::dot(zone.axisV, zone.axisV)};
}

}  // namespace lightvane
