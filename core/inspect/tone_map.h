#pragma once

#include <cstdint>

#include "core/base/parameter.h"

namespace lightvane {

/// How radiance that a screen cannot show becomes what it can.
enum class ToneMap : std::uint8_t {
  Clip,      ///< what is brighter than white is white
  Reinhard,  ///< luminance L becomes L / (1 + L): Reinhard et al. 2002, eq. 3
  Filmic     ///< ACES' reference rendering and sRGB output, as fitted by S. Hill: a toe and a shoulder
};
inline constexpr std::array kToneMapNames{Choice{ToneMap::Clip, "none (clip)"},
                                          Choice{ToneMap::Reinhard, "Reinhard"},
                                          Choice{ToneMap::Filmic, "filmic"}};
/// Of files and command lines.
inline constexpr std::array kToneMapWords{
    Choice{ToneMap::Clip, "clip"}, Choice{ToneMap::Reinhard, "reinhard"}, Choice{ToneMap::Filmic, "filmic"}};
static_assert(kToneMapWords.size() == kToneMapNames.size());

}  // namespace lightvane
