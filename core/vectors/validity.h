#pragma once

#include <algorithm>
#include <cmath>

#include "core/scene/scene.h"
#include "core/vectors/parameters.h"
#include "core/vectors/records.h"

namespace lightvane {

// Where a vector may be used, and with what weight (paper, sections 4.2 and 5.4, 5.5). A is the vector, B the
// point.

/// The rule that keeps a vector from a point.
enum class Refusal : std::uint8_t {
  None,
  Distance,
  Curvature,
  Gradient,
  InFront,
  Lobe,
  Clearance,
  Visibility,
  BeyondMost  ///< valid, but n_max others are nearer
};
const char* refusalName(Refusal refusal);

/// The polynomial of section 4.2.3 as corrected: t = d / r_max, (2 t^3 - 3 t^2 + 1)^2; 1 at 0, 0 at r_max.
inline float dlvWeightNormalised(float distance, float rMax) {
  if (!(distance < rMax)) return 0.0f;
  const float t = distance / rMax;
  return square((2.0f * t - 3.0f) * t * t + 1.0f);
}
/// Section 4.2.3 as printed: [2 (r_max - d)^3 - 3 (r_max - d)^2 + 1]^2, with lengths in metres.
inline float dlvWeightPrinted(float distanceMetres, float rMaxMetres) {
  const float s = rMaxMetres - distanceMetres;
  return square((2.0f * s - 3.0f) * s * s + 1.0f);
}

/// Section 4.2.2: how unlike a set of brightnesses is, `mean` and `variance` of n values, in the measure that
/// DlvParameters::dispersion bounds: the variance as printed, or standard deviation over mean (0 where all is
/// dark).
inline double dlvDispersion(const DlvParameters& p, double mean, double variance) {
  if (p.dispersionMeasure == DlvDispersion::VarianceAbove) return variance;
  return mean > 0.0 ? std::sqrt(variance) / mean : 0.0;
}
/// Section 4.2.2: whether a set of brightnesses is alike enough. `mean` and `variance` of n values.
inline bool dlvDispersionAccepts(const DlvParameters& p, double mean, double variance) {
  // Divided before it is squared, so that no radiance is too large or too small; all dark is alike.
  const double dispersion = dlvDispersion(p, mean, variance);
  return p.dispersionMeasure == DlvDispersion::VarianceAbove ? dispersion > p.dispersion
                                                             : dispersion <= p.dispersion;
}

/// r_max in normalised units.
inline float dlvRadius(const DlvParameters& p, const Scene& scene) {
  return static_cast<float>(p.rMax.inNormalisedUnits(scene.diagonal, scene.metresPerNormalisedUnit()));
}

/// How the parameters see ILVs, worked out once: rules as numbers that the inner loops use.
struct IlvRules {
  explicit IlvRules(const IlvParameters& parameters, float sceneDiagonal);

  IlvParameters p;
  float sCurv;          ///< clamped
  float inverseCurv;    ///< 1 / (1 - S_curv); infinity for printed rules at S_curv = 1
  float largestRadius;  ///< where a gather met nothing and nothing else bounds it
};

/// The distance within which a vector is valid, normalised units.
float ilvRadius(const IndirectLightVector& record, const IlvRules& rules);

/// How far the vectors of both kinds reach under the parameters of a scene, normalised units: what their
/// trees are built with.
class VectorRadii {
 public:
  VectorRadii(const VectorParameters& parameters, const Scene& scene)
      : rules_(parameters.ilv, scene.diagonal), rMax_(dlvRadius(parameters.dlv, scene)) {}

  float operator()(const IndirectLightVector& record) const { return ilvRadius(record, rules_); }
  float operator()(const DirectLightVector&) const { return rMax_; }

 private:
  IlvRules rules_;
  float rMax_;
};

/// A vector reduced to what weights need; made once for each candidate of a cluster.
struct IlvCandidate {
  Vec3 position;
  Vec3 normal;
  Vec3 outgoing;
  float radius;
  float inverseRadius;
  float meanRadius;     ///< d_mean of eq. 7
  float brightness;     ///< of E_A
  Vec3 gradient;        ///< of that brightness
  float gradientScale;  ///< by which gradients are shortened before they extrapolate
  float cosLobe;        ///< least cosine between outgoing directions; -2 where there is no lobe
  float inverseLobe;    ///< 1 / the angle of expiry
  float visibleWithin;  ///< beyond this distance a ray must tell
};
IlvCandidate makeCandidate(const IndirectLightVector& record, const IlvRules& rules);

/// Coplanar points differ by rounding; a vector counts as in front only beyond it.
inline constexpr float kInFrontSlope = 0.01f;
inline constexpr float kInFrontRounding = 0x1p-20f;

/// The weight of A at B, 0 with `refusal` where a rule keeps it away (visibility apart, which takes a ray).
inline float ilvWeight(const IlvCandidate& a, const Vec3& position, const Vec3& normal, const Vec3& outgoing,
                       const IlvRules& rules, Refusal& refusal) {
  refusal = Refusal::None;
  const Vec3 ab = position - a.position;
  const float distance = std::sqrt(ab.x * ab.x + ab.y * ab.y + ab.z * ab.z);
  if (!(distance <= a.radius)) {
    refusal = Refusal::Distance;
    return 0.0f;
  }
  const float bend = oneMinusCos(a.normal, normal);
  if (bend > 1.0f - rules.sCurv) {
    refusal = Refusal::Curvature;
    return 0.0f;
  }
  const float change = ab.x * a.gradient.x + ab.y * a.gradient.y + ab.z * a.gradient.z;
  const float bound = static_cast<float>(rules.p.sE) * a.brightness;
  if (rules.p.gradientTest == IlvGradientTest::Signed && change > bound) {
    refusal = Refusal::Gradient;
    return 0.0f;
  }
  if (rules.p.gradientTest == IlvGradientTest::Absolute && std::abs(change) > bound) {
    refusal = Refusal::Gradient;
    return 0.0f;
  }
  if (rules.p.inFront) {
    const Vec3 middle = 0.5f * (a.normal + normal);
    const float height = ab.x * middle.x + ab.y * middle.y + ab.z * middle.z;
    if (height < -(kInFrontSlope * distance + kInFrontRounding)) {
      refusal = Refusal::InFront;
      return 0.0f;
    }
  }
  float lobeWeight = 1.0f;
  if (a.cosLobe > -1.5f) {
    const float turn = oneMinusCos(a.outgoing, outgoing);
    if (!(1.0f - turn >= a.cosLobe)) {
      refusal = Refusal::Lobe;
      return 0.0f;
    }
    // The chord is close enough to the angle for a weight.
    lobeWeight = std::max(0.0f, 1.0f - std::sqrt(2.0f * turn) * a.inverseLobe);
  }
  switch (rules.p.weight) {
    case IlvWeight::Edge: {
      const float far = distance * a.inverseRadius;
      const float bent = std::sqrt(bend * rules.inverseCurv);
      return std::max(0.0f, 1.0f - std::max(far, bent)) * lobeWeight;
    }
    case IlvWeight::Absolute: {
      const float relative = a.brightness > 0.0f ? std::abs(change) / a.brightness : 0.0f;
      return (1.0f / (1.0f + distance / a.meanRadius)) * (1.0f / (1.0f + relative)) *
             (1.0f - bend * rules.inverseCurv) * lobeWeight;
    }
    case IlvWeight::Printed:
      // Eq. 7 with all that it implies: a pole where the relative change is -1, 0/0 at S_curv = 1 and at E =
      // 0.
      return (1.0f / (1.0f + distance / a.meanRadius)) * (1.0f / (1.0f + change / a.brightness)) *
             ((1.0f - bend - rules.sCurv) / (1.0f - rules.sCurv)) * lobeWeight;
  }
  return 0.0f;
}

/// The energy that A predicts for B: its own, or extrapolated along its gradients and clamped.
inline Rgb ilvExtrapolate(const IndirectLightVector& a, const Vec3& position, const Vec3& normal,
                          const IlvParameters& p, float gradientScale = 1.0f) {
  if (!p.extrapolate) return a.energy;
  const Vec3 ab = gradientScale * (position - a.point.position);
  const Vec3 turn = glm::cross(a.point.normal, normal);
  Rgb value;
  for (int c = 0; c < 3; ++c) {
    const float moved = ab.x * a.gradient[c].x + ab.y * a.gradient[c].y + ab.z * a.gradient[c].z;
    const float turned = turn.x * a.rotation[c].x + turn.y * a.rotation[c].y + turn.z * a.rotation[c].z;
    const float low = static_cast<float>(p.extrapolateMin) * a.energy[c];
    const float high = static_cast<float>(p.extrapolateMax) * a.energy[c];
    value[c] = std::min(std::max(a.energy[c] + moved + turned, low), high);
  }
  return value;
}

}  // namespace lightvane
