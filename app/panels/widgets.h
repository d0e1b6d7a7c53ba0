#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <imgui.h>

namespace lightvane {

/// Where a widget was drawn, on the screen.
struct WidgetPlace {
  std::string name;
  ImVec2 min, max;
  ImVec2 clipMin, clipMax;  ///< of its window: what lies outside is not seen
  std::string text;         ///< the value or message that it shows; empty for most

  ImVec2 centre() const { return {0.5f * (min.x + max.x), 0.5f * (min.y + max.y)}; }
  bool isClippedHorizontally() const;
  bool isVisible() const;  ///< its middle is
};

/// The places of named widgets, so that tests and drivers of the real window find a control by its name. Off
/// until somebody asks: panels of ordinary runs record nothing. One list, as ImGui has one context.
class Widgets {
 public:
  static void setRecording(bool on);
  static bool isRecording();
  /// Forgets the frame before.
  static void beginFrame();

  /// The rectangle of a widget in the window that is being drawn.
  static void record(std::string_view name, const ImVec2& min, const ImVec2& max, std::string_view text = {});
  /// As record, for the item that was added last.
  static void recordItem(std::string_view name, std::string_view text = {});

  /// As record, for what may be anywhere on the screen.
  static void recordOnScreen(std::string_view name, const ImVec2& min, const ImVec2& max,
                             std::string_view text = {});
  /// As recordOnScreen, for the window that is being drawn.
  static void recordWindow(std::string_view name, std::string_view text = {});

  static std::optional<WidgetPlace> find(std::string_view name);
  static const std::vector<WidgetPlace>& all();
};

/// A line for each widget that can be seen: "name x0 y0 x1 y1" in screen pixels, and its text where it has
/// one.
std::string widgetsAsText();

}  // namespace lightvane
