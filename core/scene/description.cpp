#include "core/scene/description.h"

#include <array>
#include <utility>

namespace lightvane {
namespace {

constexpr std::array<std::pair<const char*, double>, 6> kUnits = {{{"metre", 1.0},
                                                                   {"decimetre", 0.1},
                                                                   {"centimetre", 0.01},
                                                                   {"millimetre", 0.001},
                                                                   {"foot", 0.3048},
                                                                   {"inch", 0.0254}}};

}  // namespace

double metresPerUnit(const std::string& unit) {
  for (const auto& [name, metres] : kUnits) {
    if (unit == name) return metres;
  }
  return 0.0;
}

std::vector<std::string> unitNames() {
  std::vector<std::string> names;
  for (const auto& unit : kUnits) names.emplace_back(unit.first);
  return names;
}

double SceneDescription::metresPerUnit() const { return lightvane::metresPerUnit(units); }

bool isSameView(const CameraDescription& a, const CameraDescription& b) {
  CameraDescription like = a;
  like.name = b.name;
  like.width = b.width;
  like.height = b.height;
  like.exposureStops = b.exposureStops;
  return like == b;
}

}  // namespace lightvane
