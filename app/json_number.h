#pragma once

#include <cmath>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

namespace lightvane {

/// JSON has no infinity: it is a word there; what is no number is null.
inline nlohmann::ordered_json jsonNumber(double value) {
  if (std::isinf(value)) return value > 0.0 ? "infinite" : "-infinite";
  return value;
}
/// The number that jsonNumber has written; NaN of all else.
inline double numberOfJson(const nlohmann::ordered_json& json) {
  if (json.is_number()) return json.get<double>();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (json == "infinite") return kInfinite;
  return json == "-infinite" ? -kInfinite : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace lightvane
