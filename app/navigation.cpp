#include "app/navigation.h"

#include <algorithm>
#include <cmath>

#include "app/camera_motion.h"

namespace lightvane {
namespace {

// A hand is not steady: less than this is a click.
constexpr float kDragPixels = 4.0f;
// A drag over a thousand pixels turns by about a half circle.
constexpr float kRadiansPerPixel = 0.003f;
constexpr float kDollyPerPixel = 0.005f;
constexpr float kZoomPerNotch = 1.2f;
constexpr float kDollyPerNotch = 0.9f;
constexpr float kWipeGripPixels = 6.0f;
constexpr float kLeastZoom = 1.0f / 64.0f;
constexpr float kLargestZoom = 128.0f;

float wipeOnScreen(const ScreenRect& area, float wipe) { return area.min.x + wipe * area.width(); }

ScreenRect rectangleBetween(const Vec2& a, const Vec2& b) {
  const Vec2 low = glm::min(a, b);
  const Vec2 high = glm::max(a, b);
  return {{low.x, low.y}, {high.x, high.y}};
}

PictureMotion turnWheel(const PictureMouse& mouse, const Navigation::View& view) {
  PictureMotion motion;
  if (mouse.ctrl) {
    motion.label = "Dolly";
    motion.camera = dollied(view.camera, view.pivot, std::pow(kDollyPerNotch, mouse.wheel));
  } else {
    const float zoom =
        std::clamp(view.picture.zoom * std::pow(kZoomPerNotch, mouse.wheel), kLeastZoom, kLargestZoom);
    motion.placement = placementOf(view.picture.zoomedAbout(mouse.position, zoom / view.picture.zoom),
                                   view.area, view.camera.width, view.camera.height);
  }
  return motion;
}

}  // namespace

Placement placePicture(const PicturePlacement& placement, const ScreenRect& area, int pictureWidth,
                       int pictureHeight) {
  const auto left = static_cast<int>(std::lround(area.min.x));
  const auto top = static_cast<int>(std::lround(area.min.y));
  const int areaWidth = std::max(1, static_cast<int>(std::lround(area.width())));
  const int areaHeight = std::max(1, static_cast<int>(std::lround(area.height())));
  if (placement.fit) return Placement::fit(left, top, areaWidth, areaHeight, pictureWidth, pictureHeight);
  Placement at{left, top, areaWidth, areaHeight, Vec2(0.0f), placement.zoom};
  const Vec2 middle(0.5f * static_cast<float>(areaWidth), 0.5f * static_cast<float>(areaHeight));
  const Vec2 half(0.5f * placement.zoom * static_cast<float>(pictureWidth),
                  0.5f * placement.zoom * static_cast<float>(pictureHeight));
  // Whole pixels, so that at 1:1 a pixel of the picture is one of the screen.
  at.offset = glm::round(middle + placement.pan - half);
  return at;
}

PicturePlacement placementOf(const Placement& at, const ScreenRect& area, int width, int height) {
  const Vec2 middle(0.5f * area.width(), 0.5f * area.height());
  const Vec2 half(0.5f * at.zoom * static_cast<float>(width), 0.5f * at.zoom * static_cast<float>(height));
  return {false, at.zoom, at.offset + half - middle};
}

PictureMotion Navigation::drag(const PictureMouse& mouse, const View& view) const {
  PictureMotion motion;
  motion.held = true;
  const Vec2 moved = mouse.position - start_;
  const float depth = glm::dot(begun_.pivot - begun_.camera.position, begun_.camera.forward);
  switch (drag_) {
    case Drag::Orbit:
      motion.label = "Orbit";
      motion.camera = orbited(begun_.camera, begun_.pivot, begun_.up, -kRadiansPerPixel * moved.x,
                              -kRadiansPerPixel * moved.y);
      break;
    case Drag::Pan:
      motion.label = "Pan";
      motion.camera = panned(begun_.camera, moved / begun_.picture.zoom, std::max(depth, 1e-3f));
      break;
    case Drag::Dolly:
      motion.label = "Dolly";
      motion.camera = dollied(begun_.camera, begun_.pivot, std::exp(kDollyPerPixel * moved.y));
      break;
    case Drag::Look:
      motion.label = "Look around";
      motion.camera =
          turned(begun_.camera, begun_.up, -kRadiansPerPixel * moved.x, -kRadiansPerPixel * moved.y);
      break;
    case Drag::Picture: {
      PicturePlacement placement = begun_.placement;
      if (placement.fit)
        placement = placementOf(begun_.picture, view.area, begun_.camera.width, begun_.camera.height);
      placement.pan += moved;
      motion.placement = placement;
      break;
    }
    case Drag::Wipe:
      motion.wipe = std::clamp((mouse.position.x - view.area.min.x) / view.area.width(), 0.0f, 1.0f);
      break;
    case Drag::Rectangle:
      motion.held = false;
      motion.rectangle = rectangleBetween(start_, mouse.position);
      break;
    case Drag::None:
    case Drag::Undecided:
      break;
  }
  return motion;
}

void Navigation::press(const PictureMouse& mouse, const View& view) {
  for (int button = 0; button < 3; ++button) {
    if (!mouse.down[button]) continue;
    button_ = button;
    start_ = mouse.position;
    begun_ = view;
    const bool isOnWipe = button == 0 && view.wipe &&
                          std::abs(mouse.position.x - wipeOnScreen(view.area, *view.wipe)) <= kWipeGripPixels;
    drag_ = isOnWipe ? Drag::Wipe : Drag::Undecided;
    return;
  }
}

Navigation::Drag Navigation::dragOf(const PictureMouse& mouse) const {
  if (button_ == 1) return Drag::Look;
  if (button_ == 2 || mouse.alt) return Drag::Picture;
  if (mouse.ctrl && mouse.shift) return Drag::Rectangle;
  if (mouse.shift) return Drag::Pan;
  return mouse.ctrl ? Drag::Dolly : Drag::Orbit;
}

PictureMotion Navigation::release(const PictureMouse& mouse) {
  PictureMotion motion;
  if (drag_ == Drag::Undecided) motion.clicked = start_;
  if (drag_ == Drag::Rectangle) motion.chosen = rectangleBetween(start_, mouse.position);
  drag_ = Drag::None;
  return motion;
}

PictureMotion Navigation::update(const PictureMouse& mouse, const View& view) {
  if (drag_ != Drag::None && !mouse.down[button_]) return release(mouse);
  if (drag_ == Drag::None && mouse.overPicture) press(mouse, view);
  if (drag_ == Drag::Undecided && glm::length(mouse.position - start_) >= kDragPixels) drag_ = dragOf(mouse);
  if (drag_ != Drag::None) return drag(mouse, view);
  return mouse.overPicture && mouse.wheel != 0.0f ? turnWheel(mouse, view) : PictureMotion{};
}

}  // namespace lightvane
