#pragma once

#include <string>

#include <imgui.h>

#include "app/panels/theme.h"

namespace lightvane {

/// A window in the middle of the screen, over everything else, never larger than the screen: of help, dialogs
/// and messages. Open while the object lives.
class FloatingWindow {
 public:
  /// `size`: in heights of the font; a height of 0 follows the content. `open` is cleared by the cross in the
  /// title; `focus` brings it to the front. Recorded as "window." and `name`.
  FloatingWindow(const char* title, const char* name, const ImVec2& size, const Palette& palette, bool& open,
                 bool focus);
  ~FloatingWindow();
  FloatingWindow(const FloatingWindow&) = delete;
  FloatingWindow& operator=(const FloatingWindow&) = delete;
};

}  // namespace lightvane
