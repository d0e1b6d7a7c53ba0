#pragma once

#include <string>

#include "core/scene/scene.h"

namespace lightvane {

// Numbers as people read them: in the scene's own units, three digits. Only letters of Latin-1, which every
// font has.

inline constexpr const char* kRadianceUnit = "W/(m² sr)";
inline constexpr const char* kIrradianceUnit = "W/m²";

/// The name of the unit of the scene's lengths: "m", "cm", ..., or "scene units" where none is that long.
std::string lengthUnit(const Scene& scene);

/// Three significant digits, or as many; "infinite" and "not a number" for what is.
std::string numberText(double value, int digits = 3);
/// "(0.12, 0.11, 0.0853)"
std::string rgbText(const Rgb& value);
/// A length given in normalised units: "0.12 m".
std::string lengthText(const Scene& scene, double normalised, int digits = 3);
/// A place given in normalised units: "(1.2, 0.5, -3) m".
std::string pointText(const Scene& scene, const Vec3& normalised);
/// "31.2°"
std::string angleText(double radians, int digits = 3);

/// The angle between unit vectors, radians; accurate for small ones.
float angleBetween(const Vec3& a, const Vec3& b);

}  // namespace lightvane
