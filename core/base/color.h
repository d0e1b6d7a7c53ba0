#pragma once

#include <cmath>

#include "core/base/math.h"

namespace lightvane {

/// Linear Rec.709 red, green, blue.
using Rgb = glm::vec3;

/// Relative luminance of linear Rec.709 (ITU-R BT.709).
inline float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

/// The brightness by which the paper measures dispersion (section 4.2.2).
inline float paperBrightness(const Rgb& c) { return 0.299f * c.r + 0.587f * c.g + 0.114f * c.b; }

inline bool isFinite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }
inline bool isBlack(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }

/// A finite sample without a negative component: what may enter a picture or a record.
inline bool isValidSample(const Rgb& c) { return isFinite(c) && c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f; }

/// sRGB's opto-electronic transfer (IEC 61966-2-1), clamped to [0, 1].
inline float encodeSrgb(float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  if (linear >= 1.0f) return 1.0f;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// The inverse of encodeSrgb.
inline float decodeSrgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lightvane
