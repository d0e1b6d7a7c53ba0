#pragma once

#include "core/image/image.h"

namespace lightvane {

// Masks are 1 where a pixel counts and 0 where it does not. All of these are pure; any thread.

/// 0 within `reach` pixels of an edge of the geometry. There a pixel is part of one surface and part of
/// another, so that the slightest difference in how rays are placed is a large error that is none of the
/// method's.
///
/// `depth` is along the rays, infinity where nothing was met; `normal` need not be of unit length, and is 0
/// where nothing was met. Either may be empty: then the other alone is looked at.
ImageFloat edgeMask(const ImageFloat& depth, const ImageRgb& normal, int reach = 2);

/// 0 where light is seen straight from its source.
ImageFloat lightMask(const ImageRgb& emission);

/// 1 where both are. An empty one stands for all pixels.
ImageFloat bothMasks(const ImageFloat& a, const ImageFloat& b);

}  // namespace lightvane
