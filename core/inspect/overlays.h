#pragma once

#include "core/inspect/overlay.h"
#include "core/inspect/overlay_style.h"
#include "core/render/render_frame.h"

namespace lightvane {

// Overlays of a frame's vectors. Pure: the same frame and style give the same batch. Any thread. Everything
// in a batch is finite; a vector of which something is not is left out where that is drawn. Empty for frames
// without vectors. Cost: linear in the vectors that are shown, mirrorImages traces two rays for each that may
// be seen.
//
// Each function makes its own kind, whether the style shows it or not; buildOverlay goes by the style.

/// Places of DLVs: a colour for each light, hollow where the light is wholly occluded.
OverlayBatch directMarkers(const RenderFrame& frame, const OverlayStyle& style);
/// Arrows from DLVs along their directions; their lengths tell the energy.
OverlayBatch directGlyphs(const RenderFrame& frame, const OverlayStyle& style);
/// Places of ILVs, coloured by OverlayStyle::coloring.
OverlayBatch indirectMarkers(const RenderFrame& frame, const OverlayStyle& style);
/// Where ILVs may be used, under the frame's parameters.
OverlayBatch validityZones(const RenderFrame& frame, const OverlayStyle& style);
/// r_max around DLVs.
OverlayBatch directZones(const RenderFrame& frame, const OverlayStyle& style);
/// Arrows from ILVs towards where it gets brighter; their lengths tell the relative change over the radius.
OverlayBatch gradientGlyphs(const RenderFrame& frame, const OverlayStyle& style);
/// The cone that a DLV's light subtends, about its direction. Empty for ILVs.
OverlayBatch solidAngleCone(const RenderFrame& frame, const RecordRef& record, const OverlayStyle& style);
/// The markers of directMarkers and indirectMarkers as far as the style shows these, where the frame's camera
/// sees them in planar mirrors: behind the mirror.
OverlayBatch mirrorImages(const RenderFrame& frame, const OverlayStyle& style);

/// Frames about the pinned vectors.
OverlayBatch pinnedMarks(const RenderFrame& frame, const OverlayStyle& style);

/// Crosses over the vectors of stale kinds.
OverlayBatch staleMarks(const RenderFrame& frame, const OverlayStyle& style);

/// All that the style shows, in the order in which it is drawn, with one legend.
OverlayBatch buildOverlay(const RenderFrame& frame, const OverlayStyle& style);

}  // namespace lightvane
