#include "core/vectors/validity.h"

namespace lightvane {

const char* refusalName(Refusal refusal) {
  switch (refusal) {
    case Refusal::None:
      return "none";
    case Refusal::Distance:
      return "distance";
    case Refusal::Curvature:
      return "curvature";
    case Refusal::Gradient:
      return "gradient";
    case Refusal::InFront:
      return "in front";
    case Refusal::Lobe:
      return "lobe";
    case Refusal::Clearance:
      return "clearance";
    case Refusal::Visibility:
      return "visibility";
    case Refusal::BeyondMost:
      return "beyond n_max";
  }
  return "";
}

IlvRules::IlvRules(const IlvParameters& parameters, float sceneDiagonal)
    : p(parameters),
      sCurv(static_cast<float>(parameters.curvatureClamp ? std::min(parameters.sCurv, 0.999)
                                                         : parameters.sCurv)),
      inverseCurv(1.0f / (1.0f - sCurv)),
      largestRadius(sceneDiagonal) {}

namespace {

/// What the gather says, before the picture's bounds.
float seenRadius(const IndirectLightVector& record, const IlvRules& rules) {
  const IlvParameters& p = rules.p;
  const float mean = p.radius == IlvRadius::Harmonic ? record.harmonicMean : record.arithmeticMean;
  float radius = static_cast<float>(p.radiusScale) *
                 std::min(mean, rules.largestRadius / static_cast<float>(std::max(p.radiusScale, 1e-6)));
  // A lobe's picture moves with the point: a narrow one is valid over that much less.
  if (record.lobeWidth > 0.0f) radius *= std::min(1.0f, record.lobeWidth);
  if (p.radiusMinHit > 0.0)
    radius = std::min(radius, static_cast<float>(p.radiusMinHit) * record.leastDistance);
  return radius;
}

float withinBounds(float radius, const IndirectLightVector& record, const IlvRules& rules) {
  const IlvParameters& p = rules.p;
  if (p.radiusMinPixels > 0.0)
    radius = std::max(radius, static_cast<float>(p.radiusMinPixels) * record.point.footprint);
  if (p.radiusMaxPixels > 0.0)
    radius = std::min(radius, static_cast<float>(p.radiusMaxPixels) * record.point.footprint);
  return std::min(radius, rules.largestRadius);
}

}  // namespace

float ilvRadius(const IndirectLightVector& record, const IlvRules& rules) {
  return withinBounds(seenRadius(record, rules), record, rules);
}

IlvCandidate makeCandidate(const IndirectLightVector& record, const IlvRules& rules) {
  IlvCandidate a;
  a.position = record.point.position;
  a.normal = record.point.normal;
  a.outgoing = record.point.outgoing;
  const float seen = seenRadius(record, rules);
  a.radius = withinBounds(seen, record, rules);
  a.inverseRadius = a.radius > 0.0f ? 1.0f / a.radius : 0.0f;
  a.meanRadius = rules.p.radius == IlvRadius::Harmonic ? record.harmonicMean : record.arithmeticMean;
  a.brightness = paperBrightness(record.irradiance);
  a.gradient = 0.299f * record.gradient[0] + 0.587f * record.gradient[1] + 0.114f * record.gradient[2];
  const float change = glm::length(a.gradient) * a.radius;
  const float most = static_cast<float>(rules.p.gradientLimit) * a.brightness;
  a.gradientScale = 1.0f;
  if (rules.p.gradientLimit > 0.0) {
    if (change > most) a.gradientScale = most / change;
    // Where the picture's least radius goes beyond what the gather vouches for, so would the gradient.
    if (seen < a.radius) a.gradientScale = std::min(a.gradientScale, seen / a.radius);
  }
  if (record.lobeWidth > 0.0f) {
    const float expiry = std::min(kPi, record.lobeWidth * static_cast<float>(rules.p.lobeAngle));
    a.cosLobe = std::cos(expiry);
    a.inverseLobe = 1.0f / expiry;
  } else {
    a.cosLobe = -2.0f;
    a.inverseLobe = 0.0f;
  }
  a.visibleWithin =
      rules.p.visibility ? static_cast<float>(rules.p.visibilityDistance) * record.leastDistance : kInfinity;
  return a;
}

}  // namespace lightvane
