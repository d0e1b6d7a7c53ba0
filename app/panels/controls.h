#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <imgui.h>

#include "app/panels/theme.h"
#include "app/panels/value_scale.h"

namespace lightvane {

// The controls that all panels are made of: one framed line each, with its label on the left and its value on
// the right, so that a narrow bar holds many and none is cut off. Dragging changes a number (with Alt, ten
// times as fine); a double click or Ctrl+click lets it be typed. Each is recorded under its name.

/// A number that is being typed.
struct TypedValue {
  std::string control;
  std::string text;
  std::string before;      ///< the text when typing began
  std::string error = {};  ///< why the text was refused; stays until it is mended or typing is cancelled
  bool takeFocus = true;   ///< in the next frame
};

/// A number that is being dragged.
struct DraggedValue {
  std::string control;
  ValueScale scale = ValueScale::linear(0.0, 1.0);  ///< as it was when the mouse went down
  double fraction = 0.0;                            ///< not rounded, as values are
};

/// What controls remember between frames: of all, one is typed in or dragged at a time.
struct ControlState {
  std::optional<TypedValue> typed;
  std::optional<DraggedValue> dragged;
  std::string openList;       ///< the control whose list of choices is open
  bool closeList = false;     ///< in the next frame
  std::string hovered;        ///< the control that the mouse rests on
  double hoveredSince = 0.0;  ///< ImGui's clock
  /// No tooltip until the mouse moves: somebody pressed a key, and looks at what that does.
  bool isQuiet = false;

  /// Opens a control's text field; the mouse is not needed.
  void type(std::string control, const std::string& text);
};

/// What controls are drawn with.
struct ControlStyle {
  const Palette& palette;
  ControlState& state;
  float width = 0.0f;  ///< of the frame; 0 takes what is left of the line
};

/// The looks of one line.
struct ControlLine {
  std::string name;  ///< unique; recorded
  std::string label = {};
  std::string value = {};  ///< as shown on the right
  bool dimmed = false;     ///< is of no effect as things are
  bool changed = false;    ///< marked by a bar at its left
  bool selected = false;
  float indent = 0.0f;  ///< of the label, for what stands before it
};

/// A line that is clicked. True when it was.
bool buttonLine(const ControlStyle& style, const ControlLine& line);

/// The mark of what unfolds, in the item added last: pointing down where it is open.
void drawFoldMark(const Palette& palette, bool open);
/// What drawFoldMark takes of a line.
float foldMarkWidth();

/// A switch. True when `value` was changed.
bool toggleLine(const ControlStyle& style, const ControlLine& line, bool& value);

/// One of several names. The choice's number, when one was made. `onHovered`, where there is one, is told
/// which one the mouse is over in the open list, within a tooltip.
std::optional<std::size_t> choiceLine(const ControlStyle& style, const ControlLine& line,
                                      std::span<const char* const> choices, std::size_t current,
                                      const std::function<void(std::size_t)>& onHovered = {});

/// A number on a scale.
struct NumberLine {
  ValueScale scale = ValueScale::linear(0.0, 1.0);
  double value = 0.0;
  std::optional<double> reference = {};  ///< marked on the scale: what a reset gives
  std::string typing = {};               ///< the text to begin typing with
  double stepPixels = 0.0;               ///< where above 0, there is no scale: dragging so far is a step
};
struct NumberChange {
  std::optional<double> dragged;     ///< the number on the scale; or whole steps since the frame before
  std::optional<std::string> typed;  ///< to be read by the caller, who says what is wrong with refuseTyped
};
NumberChange numberLine(const ControlStyle& style, const ControlLine& line, const NumberLine& number);
/// The text that was typed is accepted, and its field closed; or refused, and the field stays with the
/// message below it.
void acceptTyped(ControlState& state);
void refuseTyped(ControlState& state, std::string message);

/// A number without ceremony: on a scale, typed within [min, max], shown with `unit`.
struct PlainNumber {
  double min = 0.0, max = 1.0;
  ValueScale scale = ValueScale::linear(0.0, 1.0);
  double reset = 0.0;
  const char* unit = "";
  double shownTimes = 1.0;              ///< 100 for percent
  const char* help = "";                ///< its tooltip
  std::optional<ChangeCost> cost = {};  ///< what a change of it costs: in the tooltip
  const char* zeroText = "";            ///< shown in place of 0, where that has a meaning of its own
};
bool plainNumberLine(const ControlStyle& style, const std::string& name, const std::string& label,
                     float& value, const PlainNumber& number, bool dimmed = false);

/// True where the mouse has rested on the item added last for long enough to be told about it. `name` is the
/// control's.
bool wantsTooltip(ControlState& state, std::string_view name);
/// Whether frames are needed for a tooltip to come: its delay ends without an event.
bool awaitsTooltip(const ControlState& state);
/// A tooltip of some lines, the first of them stronger than the others.
void showTooltip(const Palette& palette, std::string_view title, std::string_view text);
/// Both: for controls that need only a sentence.
void tooltip(const ControlStyle& style, std::string_view name, std::string_view title, std::string_view text);
/// Likewise, and what a change costs.
void tooltip(const ControlStyle& style, std::string_view name, std::string_view text, ChangeCost cost);

/// A small button with an arrow that turns back: sets what is left of it to where it was. Recorded as
/// "name.reset". Takes its place whether or not it is `shown`, so that lines do not jump.
bool resetButton(const ControlStyle& style, const std::string& name, bool shown,
                 std::string_view explanation);
/// What resetButton takes of a line, spacing included.
float resetButtonWidth();

/// `text` with line breaks, so that it is no wider than `width` where it has spaces. ImGui breaks after
/// commas and points, too: in the middle of 2,928 and of dlv.mode.
std::string wrapped(std::string_view text, float width);
/// Text that wraps at the right end of its window, or in tooltips, which have none.
void wrappedText(std::string_view text);
void wrappedTextInTooltip(std::string_view text);
/// Text that wraps, of less weight.
void noteText(const Palette& palette, std::string_view text);
/// Text that wraps, with a mark before it in that colour.
void markedText(ImU32 color, std::string_view text);
/// A fact: its name on the left, its text on the right; below it, and wrapped, where one line is too short.
void factLine(const Palette& palette, std::string_view label, std::string_view text);
/// A heading within a panel.
void heading(const Palette& palette, std::string_view text);

/// `text` where it fits `width`; otherwise as much of it as does, and "...".
std::string fitted(std::string_view text, float width);

}  // namespace lightvane
