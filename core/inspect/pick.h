#pragma once

#include <vector>

#include "core/inspect/overlay.h"
#include "core/render/render_frame.h"

namespace lightvane {

// Which vectors the pointer means. Pure; any thread. Cost: a projection for each vector.

/// The vector under the pointer, or none: of the markers whose centres are within `radiusPixels` of (x, y),
/// in pixels of the camera's whole picture, the one nearest to the viewer, those behind a surface last.
/// `depth` is that picture's Film::depth, of any resolution; empty where it is not known.
RecordRef pickMarker(const OverlayBatch& batch, const Camera& camera, float x, float y, float radiusPixels,
                     const ImageFloat& depth);

/// Kinds of vectors to be taken.
struct PickedKinds {
  bool indirect = true;
  bool direct = true;
};
/// The vectors whose points are seen within a rectangle of the frame's picture, in its pixels, whether or not
/// they have markers: ILVs first, then light by light, by their numbers. What a surface hides is left out.
std::vector<RecordRef> recordsWithin(const RenderFrame& frame, const Vec2& low, const Vec2& high,
                                     const PickedKinds& kinds);

}  // namespace lightvane
