#include "app/picture_marks.h"

#include <algorithm>
#include <span>
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

void markValues(const ScreenRect& area, const Placement& picture, const ViewImage& view,
                const PictureStyle& style) {
  // Three digits, a sign and an exponent; three lines.
  constexpr float kLeastCell = 6.0f;
  const float em = ImGui::GetFontSize();
  if (picture.zoom < kLeastCell * em) return;
  const Clipped list(area);
  const std::span<const Color8, 256> table = colorTable(style.scale.map);
  const Vec2 low = glm::floor(picture.toPicture({area.min.x, area.min.y}));
  const Vec2 high = picture.toPicture({area.max.x, area.max.y});
  const int x1 = std::min(view.width - 1, static_cast<int>(high.x));
  const int y1 = std::min(view.height - 1, static_cast<int>(high.y));
  for (int y = std::max(0, static_cast<int>(low.y)); y <= y1; ++y) {
    for (int x = std::max(0, static_cast<int>(low.x)); x <= x1; ++x) {
      const std::vector<std::string> lines = viewValueLines(view, x, y);
      const Color8 ground = displayColor(view, x, y, style, table);
      // Of Rec. 709, on encoded values: near enough to choose between two.
      const bool isBright = 0.213f * ground.r + 0.715f * ground.g + 0.072f * ground.b > 127.0f;
      const Vec2 corner = picture.toFramebuffer({static_cast<float>(x), static_cast<float>(y)});
      const float room = picture.zoom - 0.6f * em;
      for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string text = fitted(lines[i], room);
        list->AddText({corner.x + 0.3f * em, corner.y + (0.3f + 1.2f * static_cast<float>(i)) * em},
                      isBright ? kDark : kLight, text.c_str());
      }
    }
  }
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
