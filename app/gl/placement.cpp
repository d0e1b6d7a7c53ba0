#include "app/gl/placement.h"

namespace lightvane {

Placement Placement::fit(int left, int top, int width, int height, int pictureWidth, int pictureHeight) {
  const Vec2 area(width, height);
  const Vec2 picture(std::max(pictureWidth, 1), std::max(pictureHeight, 1));
  const float zoom = std::min(area.x / picture.x, area.y / picture.y);
  // Whole pixels, so that a picture at zoom 1 is shown unfiltered.
  return {left, top, width, height, glm::floor(0.5f * (area - zoom * picture)), zoom};
}

Vec2 Placement::toPicture(const Vec2& framebufferPixel) const {
  return (framebufferPixel - Vec2(left, top) - offset) / zoom;
}

Vec2 Placement::toFramebuffer(const Vec2& picturePixel) const {
  return picturePixel * zoom + offset + Vec2(left, top);
}

Placement Placement::zoomedAbout(const Vec2& framebufferPixel, float factor) const {
  const Vec2 fixed = framebufferPixel - Vec2(left, top);
  Placement zoomed = *this;
  zoomed.zoom *= factor;
  zoomed.offset = fixed + (offset - fixed) * factor;
  return zoomed;
}

}  // namespace lightvane
