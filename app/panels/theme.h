#pragma once

#include <imgui.h>

#include "app/panels/workspace.h"
#include "core/base/parameter.h"

namespace lightvane {

/// The colours of a theme, by what they are for. Text keeps a contrast of 4.5 or more on everything that it
/// stands on (WCAG 2.1, 1.4.3); a test measures it.
struct Palette {
  ImU32 background;  ///< about the picture
  ImU32 panel;       ///< side bars, menu, status bar
  ImU32 popup;       ///< menus, tooltips, dialogs
  ImU32 frame;       ///< controls
  ImU32 frameHovered;
  ImU32 frameActive;
  ImU32 fill;  ///< the part of a control left of its value
  ImU32 border;
  ImU32 text;
  ImU32 dim;       ///< text that says less
  ImU32 accent;    ///< what was changed, chosen, or runs
  ImU32 onAccent;  ///< text on the accent
  ImU32 warning;
  ImU32 error;
  ImU32 cost[4];  ///< by ChangeCost
};

const Palette& paletteOf(Theme theme);

inline ImVec4 toVec4(ImU32 color) { return ImGui::ColorConvertU32ToFloat4(color); }
/// The colour with an opacity of its own.
ImU32 withAlpha(ImU32 color, float alpha);
ImU32 toImU32(const Color8& color);

/// Sets ImGui's style. `scale`: of all sizes, 1 on a monitor of 96 dots per inch. To be called when either
/// changes.
void applyTheme(Theme theme, float scale);

/// The mark of a change's cost, a shape and a colour each: a dash, a disc, a triangle, a square.
void drawCostBadge(ImDrawList& list, const ImVec2& centre, float size, ChangeCost cost,
                   const Palette& palette);
/// What a change of that cost makes the renderer do, in a sentence.
const char* costSentence(ChangeCost cost);

}  // namespace lightvane
