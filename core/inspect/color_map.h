#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/parameter.h"

namespace lightvane {

/// A colour as a screen shows it: sRGB, straight alpha.
struct Color8 {
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
  bool operator==(const Color8&) const = default;
};

/// Colour maps that read the same for people with any kind of colour vision: lightness rises with the value
/// (Diverging: from its middle to both ends, blue to orange).
enum class ColorMap : std::uint8_t { Grey, Viridis, Cividis, Diverging };
/// Of files and command lines.
inline constexpr std::array kColorMapWords{
    Choice{ColorMap::Grey, "grey"}, Choice{ColorMap::Viridis, "viridis"},
    Choice{ColorMap::Cividis, "cividis"}, Choice{ColorMap::Diverging, "diverging"}};

/// 256 colours from the low end to the high end. Any thread; the tables are made once, at the first call.
std::span<const Color8, 256> colorTable(ColorMap map);
/// The colour at `position`, 0 the low end and 1 the high end, clamped.
Color8 colorAt(ColorMap map, float position);

/// Two kinds of things that are shown together have no colour in common.
enum class ColorFamily { Warm, Cool };
/// The colours of a family in turn; when all are used, from the first again.
Color8 categoryColor(ColorFamily family, std::size_t index);

}  // namespace lightvane
