#include "app/panels/layout.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

// The picture keeps this part of the window's width; beside two bars, at least so many pixels at scale 1.
constexpr float kPicturePart = 0.4f;
constexpr float kLeastPicture = 480.0f;

}  // namespace

PanelLayout layoutPanels(const LayoutInput& input) {
  PanelLayout layout;
  const float top = input.menuHeight;
  const float bottom = std::max(top, input.screen.y - input.statusHeight);
  layout.menu = {{0.0f, 0.0f}, {input.screen.x, top}};
  layout.status = {{0.0f, bottom}, {input.screen.x, input.screen.y}};
  layout.picture = {{0.0f, top}, {input.screen.x, bottom}};
  if (!input.sideBars) return layout;

  const float scale = input.scale;
  const bool roomForTwo = input.screen.x >= (2.0f * kLeastBarWidth + kLeastPicture) * scale;
  const float largest = (1.0f - kPicturePart) * input.screen.x * (roomForTwo ? 0.5f : 1.0f);
  const auto width = [&](float asked) {
    return std::floor(std::min(std::clamp(asked, kLeastBarWidth, kLargestBarWidth) * scale, largest));
  };
  if (roomForTwo) {
    layout.left = {{0.0f, top}, {width(input.leftWidth), bottom}};
    layout.picture.min.x = layout.left->max.x;
  }
  layout.right = {{input.screen.x - width(input.rightWidth), top}, {input.screen.x, bottom}};
  layout.picture.max.x = layout.right->min.x;
  return layout;
}

}  // namespace lightvane
