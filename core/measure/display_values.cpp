#include "core/measure/display_values.h"

#include <algorithm>
#include <cmath>

namespace lightvane {

Rgb clippedLight(const Rgb& linear, double exposureStops) {
  // In double: neither 2^stops nor the product need fit a float.
  const double scale = std::exp2(exposureStops);
  const auto clipped = [scale](float value) {
    return static_cast<float>(std::clamp(static_cast<double>(value) * scale, 0.0, 1.0));
  };
  return {clipped(linear.r), clipped(linear.g), clipped(linear.b)};
}

Rgb displayValue(const Rgb& linear, double exposureStops) {
  const Rgb light = clippedLight(linear, exposureStops);
  return {encodeSrgb(light.r), encodeSrgb(light.g), encodeSrgb(light.b)};
}

}  // namespace lightvane
