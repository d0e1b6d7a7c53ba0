#pragma once

#include "core/base/math.h"

namespace lightvane {

/// Where a picture is shown: a part of the window, and how the picture lies in it. In framebuffer pixels,
/// from the top left and downwards (a window's points times its content scale).
struct Placement {
  int left = 0, top = 0, width = 0, height = 0;  ///< the area; nothing is drawn outside of it
  Vec2 offset{0.0f};                             ///< of the picture's top left corner from the area's
  float zoom = 1.0f;                             ///< framebuffer pixels that a pixel of the picture is wide

  bool operator==(const Placement&) const = default;

  /// The whole picture, as large as the area has room for, in its middle.
  static Placement fit(int left, int top, int width, int height, int pictureWidth, int pictureHeight);

  Vec2 toPicture(const Vec2& framebufferPixel) const;
  Vec2 toFramebuffer(const Vec2& picturePixel) const;

  /// `factor` times as large, with the same point of the picture at `framebufferPixel`.
  Placement zoomedAbout(const Vec2& framebufferPixel, float factor) const;
};

}  // namespace lightvane
