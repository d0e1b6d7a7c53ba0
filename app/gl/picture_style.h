#pragma once

#include <cstdint>
#include <span>

#include "core/inspect/tone_map.h"
#include "core/inspect/view_image.h"

namespace lightvane {

/// How the numbers of a view become colours. Changing it costs no upload.
struct PictureStyle {
  // Of Radiance views.
  float exposureStops = 0.0f;  ///< radiance is multiplied by 2^exposureStops first
  ToneMap toneMap = ToneMap::Clip;
  // Of Scalar views. Begin with the view's own; `map` is not read: the colour table is an argument.
  ViewScale scale;

  bool smooth = false;  ///< linear instead of crisp squares where the picture is magnified
};

/// What a pixel of a view looks like at zoom 1: the same that PictureLayer draws, to 1/255. For exports and
/// tests; pure, any thread.
///
/// - Radiance: NaN, infinite or negative pixels are magenta, in two shades as on a chessboard.
/// - Color, Scalar, Categories: pixels of NaN ("none") are a grey chessboard of 8 x 8 pixels a field.
///
/// `table` is that of the scale's colour map; not read for other kinds than Scalar.
Color8 displayColor(const ViewImage& image, int x, int y, const PictureStyle& style,
                    std::span<const Color8, 256> table);

}  // namespace lightvane
