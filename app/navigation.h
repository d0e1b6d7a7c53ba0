#pragma once

#include <optional>
#include <string>

#include "app/gl/placement.h"
#include "app/panels/layout.h"
#include "app/panels/workspace.h"
#include "core/scene/scene.h"

namespace lightvane {

/// What the mouse does over the picture, as it stands in a frame. Positions on the screen.
struct PictureMouse {
  Vec2 position{0.0f};
  bool overPicture = false;              ///< and over no panel
  bool down[3] = {false, false, false};  ///< left, right, middle
  float wheel = 0.0f;
  bool shift = false, ctrl = false, alt = false;
};

/// What came of it.
struct PictureMotion {
  std::optional<Camera> camera;
  std::optional<PicturePlacement> placement;
  std::optional<float> wipe;
  std::optional<Vec2> clicked;          ///< on the screen
  std::optional<ScreenRect> rectangle;  ///< being drawn
  std::optional<ScreenRect> chosen;     ///< drawn to its end
  bool held = false;                    ///< a drag is under way
  const char* label = "";               ///< what undo calls it
};

/// Everything that moves follows the mouse from where it was pressed, so that a drag there and back ends
/// where it began.
///
///   left drag          orbit about the point that was pressed      shift: pan      ctrl: dolly
///                      ctrl and shift: a rectangle of vectors
///   right drag         look around
///   middle drag, alt   move the picture        wheel: zoom it about the mouse, ctrl: dolly
///   click              select
class Navigation {
 public:
  struct View {
    Camera camera;
    Vec3 up{0, 1, 0};
    /// The point of the scene that is seen at a place on the screen, or a good stand-in.
    Vec3 pivot{0.0f};
    Placement picture;  ///< in screen pixels
    PicturePlacement placement;
    ScreenRect area;
    std::optional<float> wipe;  ///< where the wipe's line is, a part of the area's width
  };
  PictureMotion update(const PictureMouse& mouse, const View& view);

 private:
  enum class Drag { None, Undecided, Orbit, Pan, Dolly, Look, Picture, Wipe, Rectangle };
  void press(const PictureMouse& mouse, const View& view);
  Drag dragOf(const PictureMouse& mouse) const;
  PictureMotion drag(const PictureMouse& mouse, const View& view) const;
  PictureMotion release(const PictureMouse& mouse);

  Drag drag_ = Drag::None;
  int button_ = 0;
  Vec2 start_{0.0f};
  View begun_;
};

/// The placement in numbers: the picture of so many pixels in an area of the screen.
Placement placePicture(const PicturePlacement& placement, const ScreenRect& area, int pictureWidth,
                       int pictureHeight);
/// The zoomed and panned placement that shows `at`.
PicturePlacement placementOf(const Placement& at, const ScreenRect& area, int width, int height);

}  // namespace lightvane
