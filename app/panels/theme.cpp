#include "app/panels/theme.h"

#include <cmath>

namespace lightvane {
namespace {

constexpr ImU32 hex(unsigned rgb) {
  return IM_COL32((rgb >> 16) & 0xff, (rgb >> 8) & 0xff, rgb & 0xff, 0xff);
}

// Greys with a touch of blue, so that pictures beside them look neither warmer nor colder than they are; one
// accent. The costs' colours are Okabe and Ito's, lightened or darkened to stand out on the panel.
constexpr Palette kDark{.background = hex(0x131518),
                        .panel = hex(0x1d2024),
                        .popup = hex(0x24282d),
                        .frame = hex(0x2b3036),
                        .frameHovered = hex(0x353b43),
                        .frameActive = hex(0x3d444d),
                        .fill = hex(0x2a4257),
                        .border = hex(0x3a4048),
                        .text = hex(0xe6e8eb),
                        .dim = hex(0xa6adb6),
                        .accent = hex(0x6cb4ee),
                        .onAccent = hex(0x0f1a24),
                        .warning = hex(0xf0b45a),
                        .error = hex(0xff8b80),
                        .cost = {hex(0x9aa2ac), hex(0x56b4e9), hex(0xe69f00), hex(0xee7733)}};
constexpr Palette kLight{.background = hex(0xcfd3d8),
                         .panel = hex(0xf4f5f7),
                         .popup = hex(0xfcfcfd),
                         .frame = hex(0xe4e7eb),
                         .frameHovered = hex(0xdadee3),
                         .frameActive = hex(0xced4da),
                         .fill = hex(0xbcd5ea),
                         .border = hex(0xc3c9d0),
                         .text = hex(0x1a1d21),
                         .dim = hex(0x505862),
                         .accent = hex(0x12609e),
                         .onAccent = hex(0xffffff),
                         .warning = hex(0x8a5200),
                         .error = hex(0xb3261e),
                         .cost = {hex(0x6a727c), hex(0x0072b2), hex(0xa86400), hex(0xc03d00)}};

}  // namespace

const Palette& paletteOf(Theme theme) { return theme == Theme::Dark ? kDark : kLight; }

ImU32 withAlpha(ImU32 color, float alpha) {
  const auto a = static_cast<ImU32>(std::lround(alpha * 255.0f));
  return (color & ~IM_COL32_A_MASK) | (a << IM_COL32_A_SHIFT);
}

ImU32 toImU32(const Color8& color) { return IM_COL32(color.r, color.g, color.b, color.a); }

void applyTheme(Theme theme, float scale) {
  const Palette& p = paletteOf(theme);
  ImGuiStyle style;
  theme == Theme::Dark ? ImGui::StyleColorsDark(&style) : ImGui::StyleColorsLight(&style);
  style.WindowPadding = {10, 8};
  style.FramePadding = {7, 4};
  style.ItemSpacing = {6, 5};
  style.ItemInnerSpacing = {6, 4};
  style.IndentSpacing = 14;
  style.ScrollbarSize = 11;
  style.WindowRounding = 0;
  style.ChildRounding = 0;
  style.PopupRounding = 4;
  style.FrameRounding = 3;
  style.ScrollbarRounding = 6;
  style.TabRounding = 3;
  style.WindowBorderSize = 0;
  style.PopupBorderSize = 1;
  style.WindowMenuButtonPosition = ImGuiDir_None;
  style.ScaleAllSizes(scale);

  const auto set = [&](ImGuiCol which, ImU32 color) { style.Colors[which] = toVec4(color); };
  set(ImGuiCol_Text, p.text);
  set(ImGuiCol_TextDisabled, p.dim);
  set(ImGuiCol_WindowBg, p.panel);
  set(ImGuiCol_ChildBg, withAlpha(p.panel, 0.0f));
  set(ImGuiCol_PopupBg, p.popup);
  set(ImGuiCol_MenuBarBg, p.panel);
  set(ImGuiCol_TitleBg, p.popup);
  set(ImGuiCol_TitleBgActive, p.popup);
  set(ImGuiCol_Border, p.border);
  set(ImGuiCol_Separator, p.border);
  set(ImGuiCol_SeparatorHovered, p.accent);
  set(ImGuiCol_SeparatorActive, p.accent);
  set(ImGuiCol_FrameBg, p.frame);
  set(ImGuiCol_FrameBgHovered, p.frameHovered);
  set(ImGuiCol_FrameBgActive, p.frameActive);
  set(ImGuiCol_Button, p.frame);
  set(ImGuiCol_ButtonHovered, p.frameHovered);
  set(ImGuiCol_ButtonActive, p.frameActive);
  set(ImGuiCol_Header, p.frame);
  set(ImGuiCol_HeaderHovered, p.frameHovered);
  set(ImGuiCol_HeaderActive, p.frameActive);
  set(ImGuiCol_CheckMark, p.accent);
  set(ImGuiCol_SliderGrab, p.accent);
  set(ImGuiCol_SliderGrabActive, p.accent);
  set(ImGuiCol_PlotHistogram, p.accent);
  set(ImGuiCol_TextSelectedBg, p.fill);
  set(ImGuiCol_NavHighlight, p.accent);
  set(ImGuiCol_Tab, p.panel);
  set(ImGuiCol_TabHovered, p.frameHovered);
  set(ImGuiCol_TabActive, p.frameActive);
  set(ImGuiCol_ScrollbarBg, withAlpha(p.panel, 0.0f));
  set(ImGuiCol_ScrollbarGrab, p.frameActive);
  set(ImGuiCol_ScrollbarGrabHovered, p.border);
  set(ImGuiCol_ScrollbarGrabActive, p.dim);
  ImGui::GetStyle() = style;
}

void drawCostBadge(ImDrawList& list, const ImVec2& centre, float size, ChangeCost cost,
                   const Palette& palette) {
  const ImU32 color = palette.cost[static_cast<std::size_t>(cost)];
  const float r = 0.5f * size;
  const auto at = [&](float x, float y) { return ImVec2(centre.x + x * r, centre.y + y * r); };
  switch (cost) {
    case ChangeCost::Display:
      list.AddRectFilled(at(-0.9f, -0.25f), at(0.9f, 0.25f), color);
      break;
    case ChangeCost::Answer:
      list.AddCircleFilled(centre, 0.85f * r, color, 20);
      break;
    case ChangeCost::Vectors:
      list.AddTriangleFilled(at(0.0f, -1.0f), at(1.0f, 0.8f), at(-1.0f, 0.8f), color);
      break;
    case ChangeCost::Scene:
      list.AddRectFilled(at(-0.85f, -0.85f), at(0.85f, 0.85f), color);
      break;
  }
}

const char* costSentence(ChangeCost cost) {
  switch (cost) {
    case ChangeCost::Display:
      return "A change costs nothing: only the display follows.";
    case ChangeCost::Answer:
      return "A change answers the visible points again, from the vectors that exist.";
    case ChangeCost::Vectors:
      return "A change computes vectors anew.";
    case ChangeCost::Scene:
      return "A change compiles the scene anew.";
  }
  return "";
}

}  // namespace lightvane
