#pragma once

#include <string>

#include "app/gl/placement.h"
#include "app/panels/layout.h"
#include "core/inspect/picture_style.h"

namespace lightvane {

// What is drawn right over the picture, under all panels, with ImGui's background list. `scale`: screen
// pixels that a line is wide.

/// A frame about a pixel, light on dark, that never gets so small that it is not seen.
void markPixel(const ScreenRect& area, const Placement& picture, const PixelRef& pixel, float scale);

/// The values in each pixel's square, where these are so large that there is room.
void markValues(const ScreenRect& area, const Placement& picture, const ViewImage& view,
                const PictureStyle& style);

/// The rectangle between two places on the screen, while it is drawn.
void markRectangle(const ScreenRect& area, const Vec2& from, const Vec2& to, float scale);

/// What is on the left and on the right of a line at `x`, with the line where it can be dragged.
struct SplitLabels {
  std::string left;
  std::string right;
  float x = 0.0f;
  bool line = false;
};
void markSplit(const ScreenRect& area, const SplitLabels& labels, float scale);

}  // namespace lightvane
