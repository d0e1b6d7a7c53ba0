#include "core/scene/normalisation.h"

#include <cmath>

namespace lightvane {

Vec3 Normalisation::point(const Vec3d& scenePoint) const {
  const double scale = std::ldexp(1.0, -lengthExponent);
  return {(scenePoint - centre) * scale};
}
float Normalisation::length(double sceneLength) const {
  return static_cast<float>(std::ldexp(sceneLength, -lengthExponent));
}
Vec3d Normalisation::scenePoint(const Vec3& normalised) const {
  return centre + Vec3d(normalised) * std::ldexp(1.0, lengthExponent);
}
double Normalisation::sceneLength(double normalised) const { return std::ldexp(normalised, lengthExponent); }
float Normalisation::radianceScale() const { return std::ldexp(1.0f, radianceExponent); }

}  // namespace lightvane
