#include "app/panels/hemisphere_view.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/panels/widgets.h"
#include "core/inspect/color_map.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

// The mean of what arrives is shown as middle grey: photographers' 18 %.
constexpr float kMiddleGrey = 0.18f;

/// Radiance as a screen shows it, so that the mean is middle grey.
class RadianceColors {
 public:
  explicit RadianceColors(const Hemisphere& hemisphere) {
    double sum = 0.0;
    for (const GatherCell& cell : hemisphere.cells) sum += static_cast<double>(luminance(cell.radiance));
    if (sum > 0.0)
      scale_ = kMiddleGrey * static_cast<float>(static_cast<double>(hemisphere.cells.size()) / sum);
  }
  ImU32 operator()(const GatherCell& cell) const { return toImU32(screenColor(scale_ * cell.radiance)); }

 private:
  float scale_ = 0.0f;
};

/// Distances on a logarithmic scale from the nearest to the farthest hit; what met nothing is grey.
class DistanceColors {
 public:
  explicit DistanceColors(const Hemisphere& hemisphere) {
    for (const GatherCell& cell : hemisphere.cells) {
      if (!std::isfinite(cell.distance) || !(cell.distance > 0.0f)) continue;
      low_ = std::min(low_, cell.distance);
      high_ = std::max(high_, cell.distance);
    }
  }
  ImU32 operator()(const GatherCell& cell) const {
    if (!std::isfinite(cell.distance)) return IM_COL32(128, 128, 128, 255);
    const float t =
        high_ > low_ ? std::log(std::max(cell.distance, low_) / low_) / std::log(high_ / low_) : 0.0f;
    return toImU32(
        colorTable(ColorMap::Viridis)[static_cast<std::size_t>(std::clamp(t, 0.0f, 1.0f) * 255.0f)]);
  }

 private:
  float low_ = kInfinity;
  float high_ = 0.0f;
};

/// One cell as a piece of a ring, in steps that look round.
void drawCell(ImDrawList& list, const ImVec2& centre, float inner, float outer, float from, float to,
              ImU32 color) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / 0.15f)));
  for (int i = 0; i < steps; ++i) {
    const float a = from + (to - from) * static_cast<float>(i) / static_cast<float>(steps);
    const float b = from + (to - from) * static_cast<float>(i + 1) / static_cast<float>(steps);
    const auto at = [&](float r, float angle) {
      // Angles run from the tangent towards the bitangent; a screen's y points down.
      return ImVec2(centre.x + r * std::cos(angle), centre.y - r * std::sin(angle));
    };
    list.AddQuadFilled(at(inner, a), at(outer, a), at(outer, b), at(inner, b), color);
  }
}

template <class Colors>
void drawCells(const Hemisphere& hemisphere, const ImVec2& centre, float radius, const Colors& colors) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // Smoothed edges of neighbours would let the ground shine through between them.
  const ImDrawListFlags flags = list.Flags;
  list.Flags &= ~ImDrawListFlags_AntiAliasedFill;
  const auto rows = static_cast<float>(hemisphere.rows);
  const float step = kTwoPi / static_cast<float>(hemisphere.columns);
  for (int row = 0; row < hemisphere.rows; ++row) {
    const float inner = radius * std::sqrt(static_cast<float>(row) / rows);
    const float outer = radius * std::sqrt(static_cast<float>(row + 1) / rows);
    for (int column = 0; column < hemisphere.columns; ++column) {
      const auto c = static_cast<float>(column);
      drawCell(list, centre, inner, outer, c * step, (c + 1.0f) * step, colors(hemisphere.cell(row, column)));
    }
  }
  list.Flags = flags;
}

}  // namespace

std::optional<HemisphereCell> hemisphereCellAt(const Hemisphere& hemisphere, float x, float y) {
  const float squared = x * x + y * y;
  if (squared >= 1.0f || hemisphere.cells.empty()) return std::nullopt;
  const float angle = std::atan2(y, x);
  const float turn = (angle < 0.0f ? angle + kTwoPi : angle) / kTwoPi;
  return HemisphereCell{
      .row = std::min(static_cast<int>(squared * static_cast<float>(hemisphere.rows)), hemisphere.rows - 1),
      .column =
          std::min(static_cast<int>(turn * static_cast<float>(hemisphere.columns)), hemisphere.columns - 1)};
}

void drawHemisphere(const ControlStyle& style, const Hemisphere& hemisphere, HemisphereLook look,
                    const Scene& scene) {
  const float em = ImGui::GetFontSize();
  const float width = ImGui::GetContentRegionAvail().x;
  const float side = std::min(width, 16.0f * em);
  ImGui::InvisibleButton("inspector.hemisphere", {width, side});
  Widgets::recordItem("inspector.hemisphere");
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 centre{min.x + 0.5f * width, min.y + 0.5f * side};
  const float radius = 0.5f * side;
  if (look == HemisphereLook::Radiance) {
    drawCells(hemisphere, centre, radius, RadianceColors(hemisphere));
  } else {
    drawCells(hemisphere, centre, radius, DistanceColors(hemisphere));
  }
  ImGui::GetWindowDrawList()->AddCircle(centre, radius, style.palette.border, 64);
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto cell =
      hemisphereCellAt(hemisphere, (mouse.x - centre.x) / radius, (centre.y - mouse.y) / radius);
  if (!cell) return;
  const GatherCell& value = hemisphere.cell(cell->row, cell->column);
  showTooltip(style.palette, fmt::format("row {}, column {}", cell->row + 1, cell->column + 1),
              fmt::format("{} {}\n{}", rgbText(value.radiance), kRadianceUnit,
                          lengthText(scene, static_cast<double>(value.distance))));
}

}  // namespace lightvane
