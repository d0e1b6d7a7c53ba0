#pragma once

#include "core/image/image.h"

namespace lightvane {

/// LDR-FLIP's error of each pixel, in [0, 1], between two pictures of linear light in [0, 1] (and of one
/// size), seen at the default of 67.02 pixels per degree: a 0.7 m wide screen of 3840 pixels from 0.7 m.
///
/// Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020, with the constants and the
/// borders of the authors' program, in float as there. The cost is about 0.1 to 0.2 s per million pixels.
ImageFloat flipMap(const ImageRgb& picture, const ImageRgb& reference);

}  // namespace lightvane
