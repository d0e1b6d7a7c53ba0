#pragma once

#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <imgui.h>

#include "app/panels/workspace.h"

namespace lightvane {

struct ScreenRect {
  ImVec2 min{0, 0}, max{0, 0};

  float width() const { return max.x - min.x; }
  float height() const { return max.y - min.y; }
  bool contains(const ImVec2& at) const {
    return at.x >= min.x && at.x < max.x && at.y >= min.y && at.y < max.y;
  }
  /// Its left and its right half, the line between them on a whole pixel.
  std::pair<ScreenRect, ScreenRect> halves() const {
    const float middle = std::floor(0.5f * (min.x + max.x));
    return {{min, {middle, max.y}}, {{middle, min.y}, max}};
  }
};

/// Where everything is: a menu bar at the top, a status bar at the bottom, side bars, and the picture between
/// them. In a window that is too narrow for two side bars, the right one has all tabs.
struct PanelLayout {
  ScreenRect menu, status, picture;
  std::optional<ScreenRect> left, right;
};

/// What a layout is a function of, in screen pixels.
struct LayoutInput {
  ImVec2 screen{0, 0};
  float scale = 1.0f;  ///< of the side bars' widths
  float menuHeight = 0.0f;
  float statusHeight = 0.0f;
  bool sideBars = true;
  float leftWidth = 0.0f;  ///< as asked for, at scale 1
  float rightWidth = 0.0f;
};
PanelLayout layoutPanels(const LayoutInput& input);

/// The widths that a side bar may have, at scale 1.
inline constexpr float kLeastBarWidth = 250.0f;
inline constexpr float kLargestBarWidth = 700.0f;

}  // namespace lightvane
