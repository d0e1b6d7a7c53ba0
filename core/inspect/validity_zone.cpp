#include "core/inspect/validity_zone.h"

#include <cmath>

namespace lightvane {
namespace {

/// The angle whose cosine is `leastCosine`, as a part of a right angle.
float rimOf(double leastCosine) {
  return static_cast<float>(std::acos(std::clamp(leastCosine, 0.0, 1.0)) / (0.5 * kPiD));
}

std::optional<OverlayZone> disc(const VectorPoint& place, float radius) {
  if (!(radius > 0.0f) || !std::isfinite(radius) || !isFinite(place.position)) return std::nullopt;
  OverlayZone zone;
  zone.centre = place.position;
  zone.axisU = radius * place.tangent;
  zone.axisV = radius * glm::cross(place.normal, place.tangent);
  if (!(glm::dot(zone.axisU, zone.axisU) > 0.0f) || !(glm::dot(zone.axisV, zone.axisV) > 0.0f))
    return std::nullopt;
  return zone;
}

/// The gradient's bound. Along the gradient's direction c in the plane, AB . grad E = s (c . uv) with s the
/// change over the radius; it must stay at or below S_E E.
void cutByGradient(OverlayZone& zone, const IlvCandidate& a, const IlvRules& rules) {
  if (rules.p.gradientTest == IlvGradientTest::Off) return;
  const Vec2 change(glm::dot(a.gradient, zone.axisU), glm::dot(a.gradient, zone.axisV));
  const float overRadius = std::hypot(change.x, change.y);
  const float bound = static_cast<float>(rules.p.sE) * a.brightness;
  // Also where there is no gradient, or none that is a number: then the test refuses nothing.
  if (!(overRadius > bound) || !std::isfinite(overRadius)) return;
  zone.cutU = change.x / overRadius;
  zone.cutV = change.y / overRadius;
  zone.cutHigh = bound / overRadius;
  // Signed: nothing is refused on the other side, also not by rounding.
  zone.cutLow = rules.p.gradientTest == IlvGradientTest::Absolute ? -zone.cutHigh : -2.0f;
}

}  // namespace

std::optional<OverlayZone> validityZone(const IndirectLightVector& record, const IlvRules& rules) {
  const IlvCandidate a = makeCandidate(record, rules);
  std::optional<OverlayZone> zone = disc(record.point, a.radius);
  if (!zone) return zone;
  zone->rim = rimOf(rules.sCurv);
  cutByGradient(*zone, a, rules);
  return zone;
}

std::optional<OverlayZone> directZone(const DirectLightVector& record, const DlvParameters& parameters,
                                      float rMax) {
  std::optional<OverlayZone> zone = disc(record.point, rMax);
  if (zone) zone->rim = rimOf(parameters.normalCosine);
  return zone;
}

}  // namespace lightvane
