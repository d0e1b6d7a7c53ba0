#include "core/scene/brdf.h"

namespace lightvane {

float fresnelDielectric(float cosIncident, float eta, float& cosTransmitted) {
  const float c = std::clamp(cosIncident, 0.0f, 1.0f);
  // Equal indices: no surface at all, also at cos = 0, where the formulas below are 0 / 0.
  if (eta == 1.0f) {
    cosTransmitted = c;
    return 0.0f;
  }
  const float sin2Transmitted = (1.0f - c) * (1.0f + c) / (eta * eta);
  if (sin2Transmitted >= 1.0f) {
    cosTransmitted = 0.0f;
    return 1.0f;
  }
  cosTransmitted = std::sqrt(1.0f - sin2Transmitted);
  const float perpendicular = (c - eta * cosTransmitted) / (c + eta * cosTransmitted);
  const float parallel = (eta * c - cosTransmitted) / (eta * c + cosTransmitted);
  return 0.5f * (perpendicular * perpendicular + parallel * parallel);
}

}  // namespace lightvane
