#pragma once

#include <optional>

#include "app/gl/placement.h"
#include "app/panels/workspace.h"
#include "core/inspect/pick.h"

namespace lightvane {

// From places on the screen to what is seen there. `picture` is where the whole picture is on the screen, in
// its own pixels, which are frame.reduction times fewer in the frame's film.

/// The pixel at a place on the screen, of a picture of this size; nothing beside it.
std::optional<PixelRef> pixelAt(const Placement& picture, const Vec2& screen, int width, int height);

/// The point of the scene that the frame sees in a pixel of the whole picture; nothing where it sees none.
std::optional<Vec3> surfaceAt(const RenderFrame& frame, const PixelRef& pixel);

/// The vector whose marker is at a place on the screen, or none. `overlay` may be null.
RecordRef recordAt(const RenderFrame& frame, const OverlayBatch* overlay, const Placement& picture,
                   const Vec2& screen);

/// What is selected after a click: the vector whose marker is there, or else the pixel. `overlay` may be
/// null. `adds`: to what is selected, or takes the vector out of it.
Selection selectionAfterClick(const Selection& before, const RenderFrame& frame, const OverlayBatch* overlay,
                              const Placement& picture, const Vec2& screen, bool adds);

/// What is selected after a rectangle was drawn between two places on the screen: the vectors in it.
Selection selectionAfterDrag(const Selection& before, const RenderFrame& frame, const PickedKinds& kinds,
                             const Placement& picture, const Vec2& from, const Vec2& to, bool adds);

/// A ball around all that is selected, of a size that gives it some surroundings; nothing where nothing is.
std::optional<Ball> ballAround(const RenderFrame& frame, const Selection& selection);

}  // namespace lightvane
