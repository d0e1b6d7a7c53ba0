#include "app/picture_marks.h"

#include <algorithm>
#include <utility>

#include <imgui.h>

#include "app/panels/controls.h"

namespace lightvane {
namespace {

// Light on dark: one of them is seen on any picture.
constexpr ImU32 kDark = IM_COL32(0, 0, 0, 255);
constexpr ImU32 kLight = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kLabelGround = IM_COL32(0, 0, 0, 170);

/// The list, clipped to the picture's area for as long as this lives.
class Clipped {
 public:
  explicit Clipped(const ScreenRect& area) : list_(ImGui::GetBackgroundDrawList()) {
    list_->PushClipRect(area.min, area.max);
  }
  ~Clipped() { list_->PopClipRect(); }
  Clipped(const Clipped&) = delete;
  Clipped& operator=(const Clipped&) = delete;
  ImDrawList* operator->() const { return list_; }

 private:
  ImDrawList* list_;
};

void frame(const Clipped& list, const ImVec2& min, const ImVec2& max, float scale) {
  list->AddRect(min, max, kDark, 0.0f, 0, 3.0f * scale);
  list->AddRect(min, max, kLight, 0.0f, 0, scale);
}

/// A text at the upper edge of the area, in the strip from `left` to `right`.
void label(const Clipped& list, const ScreenRect& area, float left, float right, const std::string& text) {
  const float em = ImGui::GetFontSize();
  const float pad = 0.4f * em;
  const std::string shown = fitted(text, right - left - 4.0f * pad);
  const ImVec2 size = ImGui::CalcTextSize(shown.c_str());
  if (shown.empty() || size.x + 4.0f * pad > right - left) return;
  const ImVec2 at{0.5f * (left + right - size.x), area.min.y + 1.5f * pad};
  list->AddRectFilled({at.x - pad, at.y - 0.5f * pad}, {at.x + size.x + pad, at.y + size.y + 0.5f * pad},
                      kLabelGround, 0.3f * em);
  list->AddText(at, kLight, shown.c_str());
}

}  // namespace

void markPixel(const ScreenRect& area, const Placement& picture, const PixelRef& pixel, float scale) {
  constexpr float kLeastHalf = 5.0f;
  const Vec2 middle =
      picture.toFramebuffer({static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f});
  const float half = std::max(kLeastHalf * scale, 0.5f * picture.zoom);
  frame(Clipped(area), {middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}, scale);
}

void markRectangle(const ScreenRect& area, const Vec2& from, const Vec2& to, float scale) {
  const Vec2 low = glm::min(from, to);
  const Vec2 high = glm::max(from, to);
  frame(Clipped(area), {low.x, low.y}, {high.x, high.y}, scale);
}

void markSplit(const ScreenRect& area, const SplitLabels& labels, float scale) {
  const Clipped list(area);
  if (labels.line) {
    list->AddLine({labels.x, area.min.y}, {labels.x, area.max.y}, kDark, 3.0f * scale);
    list->AddLine({labels.x, area.min.y}, {labels.x, area.max.y}, kLight, scale);
  }
  label(list, area, area.min.x, labels.x, labels.left);
  label(list, area, labels.x, area.max.x, labels.right);
}

}  // namespace lightvane
