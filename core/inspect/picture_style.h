#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/image/image.h"
#include "core/inspect/tone_map.h"
#include "core/inspect/view_image.h"

namespace lightvane {

/// How the numbers of Scalar views become colours, where the view's own choice is overridden.
struct ScaleOverride {
  std::optional<ColorMap> map;
  bool fixedRange = false;  ///< otherwise the view's own, which follows the picture
  float low = 0.0f;
  float high = 1.0f;

  bool operator==(const ScaleOverride&) const = default;
};

inline constexpr float kMaxExposureStops = 20.0f;

/// What of a frame is shown on a screen, and how.
struct PictureLook {
  PictureView view = PictureView::Beauty;
  float exposureStops = 0.0f;  ///< beside the camera's own
  ToneMap toneMap = ToneMap::Clip;
  ScaleOverride scale;
  std::optional<ErrorSource> source = {};  ///< of the view ErrorSources: see ViewSources

  bool operator==(const PictureLook&) const = default;
};

/// How the numbers of a view become colours. Changing it costs no upload.
struct PictureStyle {
  // Of Radiance views.
  float exposureStops = 0.0f;  ///< radiance is multiplied by 2^exposureStops first
  ToneMap toneMap = ToneMap::Clip;
  // Of Scalar views. Who takes a colour table beside a style takes that of this map.
  ViewScale scale;

  bool smooth = false;  ///< linear instead of crisp squares where the picture is magnified
};

/// Of a view of a frame whose camera has this exposure.
PictureStyle styleFor(const PictureLook& look, const ViewImage& image, double cameraExposureStops);

/// A colour with linear components in [0, 1], encoded as sRGB.
Color8 screenColor(const Rgb& linear);

/// What a pixel of a view looks like at zoom 1: the same that PictureLayer draws, to 1/255. Pure, any thread.
///
/// - Radiance: NaN, infinite or negative pixels are magenta, in two shades as on a chessboard.
/// - Color, Scalar, Categories: pixels of NaN ("none") are a grey chessboard of 8 x 8 pixels a field.
///
/// `table` is that of the scale's colour map; not read for other kinds than Scalar.
Color8 displayColor(const ViewImage& image, int x, int y, const PictureStyle& style,
                    std::span<const Color8, 256> table);

/// All pixels of a view that is not empty, by displayColor and the scale's own colour map.
Image<Color8> displayColors(const ViewImage& image, const PictureStyle& style);

/// A picture of a screen as picture files have it: writing it as PNG gives these very colours.
LayeredImage filePicture(const Image<Color8>& pixels);

/// What a screen shows of a frame, as picture files have it.
LayeredImage screenPicture(const RenderFrame& frame, const PictureLook& look = {},
                           const ViewSources& sources = {});

}  // namespace lightvane
