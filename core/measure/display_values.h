#pragma once

#include "core/base/color.h"

namespace lightvane {

/// What a screen emits for linear light: scaled, and clipped to [0, 1].
Rgb clippedLight(const Rgb& linear, double exposureStops);

/// The values that a screen is sent for linear light: clippedLight encoded by sRGB.
Rgb displayValue(const Rgb& linear, double exposureStops);

}  // namespace lightvane
