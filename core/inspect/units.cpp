#include "core/inspect/units.h"

#include <cmath>

#include <fmt/format.h>

namespace lightvane {

std::string lengthUnit(const Scene& scene) {
  constexpr const char* kShort[][2] = {{"metre", "m"},       {"decimetre", "dm"}, {"centimetre", "cm"},
                                       {"millimetre", "mm"}, {"foot", "ft"},      {"inch", "in"}};
  for (const auto& [name, text] : kShort) {
    if (scene.metresPerUnit == metresPerUnit(name)) return text;
  }
  return "scene units";
}

std::string numberText(double value, int digits) {
  if (std::isnan(value)) return "not a number";
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "-infinite";
  return fmt::format("{:.{}g}", value == 0.0 ? 0.0 : value, digits);  // never -0
}

std::string rgbText(const Rgb& value) {
  return fmt::format("({}, {}, {})", numberText(value.r), numberText(value.g), numberText(value.b));
}

std::string lengthText(const Scene& scene, double normalised, int digits) {
  const double length = scene.normalisation.sceneLength(normalised);
  return std::isfinite(length) ? numberText(length, digits) + " " + lengthUnit(scene) : numberText(length);
}

std::string pointText(const Scene& scene, const Vec3& normalised) {
  const Vec3d p = scene.normalisation.scenePoint(normalised);
  return fmt::format("({}, {}, {}) {}", numberText(p.x, 4), numberText(p.y, 4), numberText(p.z, 4),
                     lengthUnit(scene));
}

std::string angleText(double radians, int digits) {
  return numberText(radians * (180.0 / kPiD), digits) + "°";
}

float angleBetween(const Vec3& a, const Vec3& b) {
  // Kahan's formula for unit vectors.
  return 2.0f * std::atan2(glm::length(a - b), glm::length(a + b));
}

}  // namespace lightvane
