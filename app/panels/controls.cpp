#include "app/panels/controls.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include "app/panels/widgets.h"
#include "core/base/number_text.h"
#include "core/base/parameter.h"

namespace lightvane {
namespace {

constexpr double kTooltipDelaySeconds = 0.35;
// Below this the mouse only clicked; ImGui's own threshold for drags.
constexpr float kDragThresholdPixels = 3.0f;

float em() { return ImGui::GetFontSize(); }

float widthOf(std::string_view text) { return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x; }

/// The largest size up to `size` that cuts no character of UTF-8.
std::size_t wholeCharacters(std::string_view text, std::size_t size) {
  while (size > 0 && size < text.size() && (static_cast<unsigned char>(text[size]) & 0xc0U) == 0x80U) --size;
  return size;
}

/// Of a word that alone is too wide, as paths are, what comes before the break: up to a slash, else to a
/// letter; all of it where it fits.
std::size_t startThatFits(std::string_view word, float width) {
  if (widthOf(word) <= width) return word.size();
  std::size_t size = wholeCharacters(word, word.size() - 1);
  while (size > 1 && widthOf(word.substr(0, size)) > width) size = wholeCharacters(word, size - 1);
  const std::size_t slash = word.substr(0, size).rfind('/');
  if (slash != std::string_view::npos && slash > 0) return slash + 1;
  return std::max<std::size_t>(size, 1);
}

ImVec2 lineSize(const ControlStyle& style) {
  const float width = style.width > 0.0f ? style.width : ImGui::GetContentRegionAvail().x;
  return {std::max(width, 2.0f * em()), ImGui::GetFrameHeight()};
}

/// The bar at the left of the item added last.
void drawChangedMark(const Palette& palette) {
  const ImVec2 min = ImGui::GetItemRectMin();
  ImGui::GetWindowDrawList()->AddRectFilled(min, {min.x + 0.2f * em(), ImGui::GetItemRectMax().y},
                                            palette.accent, ImGui::GetStyle().FrameRounding);
}

/// The frame of a line, of the item added last.
void drawFrame(const Palette& palette, bool changed, bool selected = false) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const float rounding = ImGui::GetStyle().FrameRounding;
  const ImU32 color = selected                 ? palette.fill
                      : ImGui::IsItemActive()  ? palette.frameActive
                      : ImGui::IsItemHovered() ? palette.frameHovered
                                               : palette.frame;
  list.AddRectFilled(min, max, color, rounding);
  if (changed) drawChangedMark(palette);
}

enum class Emphasis { Label, Value };

/// Label and value of a line, of the item added last, one of them stronger. `reserved`: what stands right of
/// the value.
void drawText(const Palette& palette, const ControlLine& line, float reserved,
              Emphasis emphasis = Emphasis::Value) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const float y = min.y + padding.y;
  const ImU32 strong = line.dimmed ? withAlpha(palette.dim, 0.6f) : palette.text;
  const ImU32 weak = line.dimmed ? withAlpha(palette.dim, 0.6f) : palette.dim;

  // The stronger one is shortened only where it alone has no room.
  const bool isLabel = emphasis == Emphasis::Label;
  const float inner = max.x - min.x - 2.0f * padding.x - reserved - line.indent;
  const float gap = 0.5f * em();
  std::string label = isLabel ? fitted(line.label, inner) : std::string();
  const std::string value = fitted(line.value, isLabel ? inner - widthOf(label) - gap : inner);
  const float valueWidth = widthOf(value);
  if (!isLabel) label = fitted(line.label, inner - valueWidth - gap);
  list.AddText({max.x - padding.x - reserved - valueWidth, y}, isLabel ? weak : strong, value.c_str());
  list.AddText({min.x + padding.x + line.indent, y}, isLabel ? strong : weak, label.c_str());
}

/// The item of a line: clicked anywhere.
bool lineItem(const ControlStyle& style, const ControlLine& line) {
  const bool clicked = ImGui::InvisibleButton(line.name.c_str(), lineSize(style));
  Widgets::recordItem(line.name, line.value);
  return clicked;
}

void drawTypedError(const Palette& palette, const ControlState& state) {
  if (state.typed && !state.typed->error.empty()) markedText(palette.error, state.typed->error);
}

/// The text field in the place of a line. The text, when it is to be read.
std::optional<std::string> typeInLine(const ControlStyle& style, const ControlLine& line, TypedValue& typed) {
  const ImVec2 size = lineSize(style);
  const float labelWidth = std::min(widthOf(line.label), 0.5f * size.x);
  const float left = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  const std::string label = fitted(line.label, labelWidth);
  ImGui::PushStyleColor(ImGuiCol_Text, style.palette.dim);
  ImGui::TextUnformatted(label.c_str());
  ImGui::PopStyleColor();
  ImGui::SameLine(left + labelWidth + ImGui::GetStyle().ItemInnerSpacing.x, 0.0f);
  ImGui::SetNextItemWidth(left + size.x - ImGui::GetCursorPosX());
  if (typed.takeFocus) {
    ImGui::SetKeyboardFocusHere();
    typed.takeFocus = false;
  }
  const bool entered =
      ImGui::InputText(("##" + line.name).c_str(), &typed.text,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  Widgets::recordItem(line.name);
  const bool leftField = ImGui::IsItemDeactivated() && !entered;
  std::optional<std::string> result;
  if (entered || (leftField && typed.text != typed.before)) {
    result = typed.text;
  } else if (leftField) {
    style.state.typed.reset();
  }
  drawTypedError(style.palette, style.state);
  return result;
}

/// The part of the frame that stands for the value, and the mark of the reference.
void drawScale(const Palette& palette, const ValueScale& scale, double fraction,
               const std::optional<double>& reference, bool dimmed) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const float width = max.x - min.x;
  const auto x = [&](double t) { return min.x + static_cast<float>(t) * width; };
  const float rounding = ImGui::GetStyle().FrameRounding;
  if (fraction > 0.0) {
    list.AddRectFilled(min, {x(fraction), max.y}, withAlpha(palette.fill, dimmed ? 0.35f : 1.0f), rounding);
  }
  if (reference) {
    const float at = std::clamp(x(scale.toFraction(*reference)), min.x + 1.0f, max.x - 1.0f);
    list.AddLine({at, max.y - 0.16f * (max.y - min.y)}, {at, max.y}, palette.dim,
                 std::max(1.0f, em() / 14.0f));
  }
}

bool asksForTyping() {
  if (!ImGui::IsItemHovered()) return false;
  return ImGui::IsMouseDoubleClicked(0) || (ImGui::IsMouseClicked(0) && ImGui::GetIO().KeyCtrl);
}

/// Where the drag of the item added last stands: on the scale, or in steps. Nothing while nothing is dragged.
std::optional<double> dragLine(ControlState& state, const ControlLine& line, const NumberLine& number) {
  if (ImGui::IsItemActivated()) {
    state.dragged = DraggedValue{line.name, number.scale, number.scale.toFraction(number.value)};
    if (number.stepPixels > 0.0) state.dragged->fraction = 0.0;
  }
  if (!state.dragged || state.dragged->control != line.name) return std::nullopt;
  if (!ImGui::IsItemActive()) {
    state.dragged.reset();
    return std::nullopt;
  }
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsMouseDragging(0, kDragThresholdPixels) || io.MouseDelta.x == 0.0f) return std::nullopt;
  const float width = ImGui::GetItemRectSize().x;
  const double pixels = static_cast<double>(io.MouseDelta.x) * (io.KeyAlt ? 0.1 : 1.0);
  if (number.stepPixels > 0.0) {
    state.dragged->fraction += pixels / number.stepPixels;
    const double steps = std::trunc(state.dragged->fraction);
    state.dragged->fraction -= steps;
    return steps == 0.0 ? std::nullopt : std::optional(steps);
  }
  // Beyond the ends the position stays at the end, so that turning round acts at once.
  state.dragged->fraction =
      std::clamp(state.dragged->fraction + pixels / static_cast<double>(width), 0.0, 1.0);
  return state.dragged->scale.fromFraction(state.dragged->fraction);
}

}  // namespace

void ControlState::type(std::string control, const std::string& text) {
  dragged.reset();
  typed = TypedValue{.control = std::move(control), .text = text, .before = text, .error = {}};
}

bool buttonLine(const ControlStyle& style, const ControlLine& line) {
  const bool clicked = lineItem(style, line);
  drawFrame(style.palette, line.changed, line.selected);
  drawText(style.palette, line, 0.0f, Emphasis::Label);
  return clicked;
}

void drawFoldMark(const Palette& palette, bool open) {
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 c{min.x + 0.6f * em(), 0.5f * (min.y + ImGui::GetItemRectMax().y)};
  const float r = 0.26f * em();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (open) {
    list.AddTriangleFilled({c.x - r, c.y - 0.6f * r}, {c.x + r, c.y - 0.6f * r}, {c.x, c.y + 0.8f * r},
                           palette.dim);
  } else {
    list.AddTriangleFilled({c.x - 0.6f * r, c.y - r}, {c.x + 0.8f * r, c.y}, {c.x - 0.6f * r, c.y + r},
                           palette.dim);
  }
}

float foldMarkWidth() { return 1.1f * em(); }

bool toggleLine(const ControlStyle& style, const ControlLine& line, bool& value) {
  const bool clicked = lineItem(style, line);
  if (clicked) value = !value;
  drawFrame(style.palette, line.changed);
  const float box = 0.85f * em();
  drawText(style.palette, line, box + 0.3f * em());

  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const ImVec2 a{max.x - ImGui::GetStyle().FramePadding.x - box, 0.5f * (min.y + max.y - box)};
  const ImVec2 b{a.x + box, a.y + box};
  const float rounding = 0.18f * em();
  const float opacity = line.dimmed ? 0.5f : 1.0f;
  if (value) {
    list.AddRectFilled(a, b, withAlpha(style.palette.accent, opacity), rounding);
    const ImVec2 tick[3] = {{a.x + 0.22f * box, a.y + 0.52f * box},
                            {a.x + 0.43f * box, a.y + 0.73f * box},
                            {a.x + 0.79f * box, a.y + 0.28f * box}};
    list.AddPolyline(tick, 3, style.palette.onAccent, 0, 0.13f * em());
  } else {
    list.AddRect(a, b, withAlpha(style.palette.dim, opacity), rounding, 0, std::max(1.0f, 0.08f * em()));
  }
  return clicked;
}

std::optional<std::size_t> choiceLine(const ControlStyle& style, const ControlLine& line,
                                      std::span<const char* const> choices, std::size_t current,
                                      const std::function<void(std::size_t)>& onHovered) {
  const std::string popup = line.name + ".list";
  if (lineItem(style, line)) ImGui::OpenPopup(popup.c_str());
  drawFrame(style.palette, line.changed);
  const float arrow = 0.5f * em();
  ControlLine shown = line;
  if (shown.value.empty() && current < choices.size()) shown.value = choices[current];
  drawText(style.palette, shown, arrow + 0.35f * em());
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const float x = max.x - ImGui::GetStyle().FramePadding.x - arrow;
  const float y = 0.5f * (min.y + max.y);
  ImGui::GetWindowDrawList()->AddTriangleFilled({x, y - 0.25f * arrow}, {x + arrow, y - 0.25f * arrow},
                                                {x + 0.5f * arrow, y + 0.4f * arrow}, style.palette.dim);

  std::optional<std::size_t> chosen;
  ImGui::SetNextWindowPos({min.x, max.y + 1.0f}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSizeConstraints({max.x - min.x, 0.0f}, {1e6f, 1e6f});
  if (style.state.openList == line.name) style.state.openList.clear();
  if (ImGui::BeginPopup(popup.c_str())) {
    style.state.openList = line.name;
    if (std::exchange(style.state.closeList, false)) ImGui::CloseCurrentPopup();
    for (std::size_t i = 0; i < choices.size(); ++i) {
      if (ImGui::Selectable(choices[i], i == current) && i != current) chosen = i;
      Widgets::recordItem(fmt::format("{}={}", line.name, choices[i]));
      if (onHovered && ImGui::IsItemHovered()) onHovered(i);
    }
    ImGui::EndPopup();
  }
  return chosen;
}

NumberChange numberLine(const ControlStyle& style, const ControlLine& line, const NumberLine& number) {
  NumberChange change;
  if (style.state.typed && style.state.typed->control == line.name) {
    change.typed = typeInLine(style, line, *style.state.typed);
    return change;
  }
  lineItem(style, line);
  if (asksForTyping()) {
    style.state.type(line.name, number.typing);
  } else {
    change.dragged = dragLine(style.state, line, number);
  }
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  drawFrame(style.palette, false);
  if (number.stepPixels <= 0.0) {
    const bool dragged = style.state.dragged && style.state.dragged->control == line.name;
    const ValueScale& scale = dragged ? style.state.dragged->scale : number.scale;
    drawScale(style.palette, scale, scale.toFraction(change.dragged.value_or(number.value)), number.reference,
              line.dimmed);
  }
  if (line.changed) drawChangedMark(style.palette);
  drawText(style.palette, line, 0.0f);
  return change;
}

void acceptTyped(ControlState& state) { state.typed.reset(); }

void refuseTyped(ControlState& state, std::string message) {
  if (!state.typed) return;
  state.typed->error = std::move(message);
  // Leaving the field again without a change must not ask again.
  state.typed->before = state.typed->text;
  state.typed->takeFocus = true;
}

bool plainNumberLine(const ControlStyle& style, const std::string& name, const std::string& label,
                     float& value, const PlainNumber& number, bool dimmed) {
  const auto text = [&](double v) { return shortNumber(v * number.shownTimes); };
  const std::string unit = number.unit[0] == '\0' ? "" : fmt::format(" {}", number.unit);
  const auto shown = [&](double v) {
    return v == 0.0 && number.zeroText[0] != '\0' ? std::string(number.zeroText) : text(v) + unit;
  };
  const auto current = static_cast<double>(value);
  const bool changed = current != number.reset;
  ControlStyle frame = style;
  frame.width = lineSize(style).x - resetButtonWidth();
  NumberChange change = numberLine(
      frame, {.name = name, .label = label, .value = shown(current), .dimmed = dimmed, .changed = changed},
      {.scale = number.scale, .value = current, .reference = number.reset, .typing = text(current)});
  const float before = value;
  if (change.dragged) value = static_cast<float>(std::clamp(*change.dragged, number.min, number.max));
  if (change.typed) {
    double typed = 0.0;
    const std::string expected = parameter_text::parse(*change.typed, typed);
    typed /= number.shownTimes;
    if (!expected.empty() || typed < number.min || typed > number.max) {
      refuseTyped(style.state, fmt::format("{} takes a number from {} to {}{}, not '{}'", label,
                                           text(number.min), text(number.max), unit, *change.typed));
    } else {
      value = static_cast<float>(typed);
      acceptTyped(style.state);
    }
  }
  if (number.cost) {
    tooltip(style, name, number.help, *number.cost);
  } else if (number.help[0] != '\0') {
    tooltip(style, name, "", number.help);
  }
  ImGui::SameLine();
  if (resetButton(style, name, changed, "Sets it to " + shown(number.reset))) {
    value = static_cast<float>(number.reset);
  }
  return value != before;
}

void tooltip(const ControlStyle& style, std::string_view name, std::string_view text, ChangeCost cost) {
  tooltip(style, name, "", fmt::format("{}\n{}", text, costSentence(cost)));
}

bool wantsTooltip(ControlState& state, std::string_view name) {
  if (!ImGui::IsItemHovered() || ImGui::IsMouseDown(0)) {
    if (state.hovered == name) state.hovered.clear();
    return false;
  }
  if (state.hovered != name) {
    state.hovered = name;
    state.hoveredSince = ImGui::GetTime();
  }
  const ImVec2 moved = ImGui::GetIO().MouseDelta;
  if (moved.x != 0.0f || moved.y != 0.0f) state.isQuiet = false;
  return !state.isQuiet && ImGui::GetTime() - state.hoveredSince >= kTooltipDelaySeconds;
}

bool awaitsTooltip(const ControlState& state) {
  // ImGui shows a tooltip in the frame after the one in which it is drawn first.
  constexpr double kSomeFrames = 0.1;
  return !state.hovered.empty() && ImGui::GetTime() - state.hoveredSince < kTooltipDelaySeconds + kSomeFrames;
}

void showTooltip(const Palette& palette, std::string_view title, std::string_view text) {
  ImGui::BeginTooltip();
  if (!title.empty()) wrappedTextInTooltip(title);
  if (!text.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, title.empty() ? palette.text : palette.dim);
    wrappedTextInTooltip(text);
    ImGui::PopStyleColor();
  }
  Widgets::recordWindow("tooltip", text);
  ImGui::EndTooltip();
}

void tooltip(const ControlStyle& style, std::string_view name, std::string_view title,
             std::string_view text) {
  if (wantsTooltip(style.state, name)) showTooltip(style.palette, title, text);
}

float resetButtonWidth() { return ImGui::GetFrameHeight() * 0.9f + ImGui::GetStyle().ItemSpacing.x; }

bool resetButton(const ControlStyle& style, const std::string& name, bool shown,
                 std::string_view explanation) {
  const ImVec2 size{resetButtonWidth() - ImGui::GetStyle().ItemSpacing.x, ImGui::GetFrameHeight()};
  if (!shown) {
    ImGui::Dummy(size);
    return false;
  }
  const std::string id = name + ".reset";
  const bool clicked = ImGui::InvisibleButton(id.c_str(), size);
  Widgets::recordItem(id);
  const ImVec2 min = ImGui::GetItemRectMin();
  const ImVec2 max = ImGui::GetItemRectMax();
  const ImVec2 centre{0.5f * (min.x + max.x), 0.5f * (min.y + max.y)};
  const ImU32 color = ImGui::IsItemHovered() ? style.palette.accent : style.palette.dim;
  // Three quarters of a circle, and the head of an arrow at its beginning.
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float r = 0.3f * em();
  constexpr float kQuarter = 1.57079633f;
  list.PathArcTo(centre, r, -1.6f * kQuarter, 1.5f * kQuarter, 16);
  list.PathStroke(color, 0, std::max(1.0f, 0.09f * em()));
  const ImVec2 tip{centre.x + r * std::cos(-1.6f * kQuarter), centre.y + r * std::sin(-1.6f * kQuarter)};
  const float h = 0.28f * em();
  list.AddTriangleFilled({tip.x - 0.75f * h, tip.y + 0.1f * h}, {tip.x + 0.55f * h, tip.y - 0.85f * h},
                         {tip.x + 0.6f * h, tip.y + 0.8f * h}, color);
  tooltip(style, id, "", explanation);
  return clicked;
}

std::string wrapped(std::string_view text, float width) {
  std::string result;
  while (!text.empty()) {
    const std::string_view paragraph = text.substr(0, text.find('\n'));
    std::size_t fits = paragraph.size();
    // Word by word from the left: the last that ends within the width.
    if (widthOf(paragraph) > width) {
      fits = std::min(paragraph.find(' '), paragraph.size());
      while (fits < paragraph.size()) {
        const std::size_t next = std::min(paragraph.find(' ', fits + 1), paragraph.size());
        if (widthOf(paragraph.substr(0, next)) > width) break;
        fits = next;
      }
      fits = startThatFits(paragraph.substr(0, fits), width);
    }
    result += paragraph.substr(0, fits);
    const bool isBroken = fits < text.size();
    if (isBroken) result += '\n';
    const bool atGap = isBroken && (text[fits] == ' ' || text[fits] == '\n');
    text.remove_prefix(fits + (atGap ? 1 : 0));
  }
  return result;
}

void wrappedText(std::string_view text) {
  ImGui::TextUnformatted(wrapped(text, ImGui::GetContentRegionAvail().x).c_str());
}

void wrappedTextInTooltip(std::string_view text) {
  constexpr float kTooltipWidth = 26.0f;
  ImGui::TextUnformatted(wrapped(text, kTooltipWidth * em()).c_str());
}

void noteText(const Palette& palette, std::string_view text) {
  ImGui::PushStyleColor(ImGuiCol_Text, palette.dim);
  wrappedText(text);
  ImGui::PopStyleColor();
}

void markedText(ImU32 color, std::string_view text) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float bar = 0.2f * em();
  ImGui::Indent(4.0f * bar);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  wrappedText(text);
  ImGui::PopStyleColor();
  ImGui::Unindent(4.0f * bar);
  ImGui::GetWindowDrawList()->AddRectFilled({at.x + bar, at.y},
                                            {at.x + 2.0f * bar, ImGui::GetItemRectMax().y}, color);
}

void factLine(const Palette& palette, std::string_view label, std::string_view text) {
  const float left = ImGui::GetCursorPosX();
  const float room = ImGui::GetContentRegionAvail().x;
  ImGui::PushStyleColor(ImGuiCol_Text, palette.dim);
  ImGui::TextUnformatted(fitted(label, room).c_str());
  ImGui::PopStyleColor();
  const float width = widthOf(text);
  if (widthOf(label) + width + em() <= room) {
    ImGui::SameLine(left + room - width, 0.0f);
    ImGui::TextUnformatted(text.data(), text.data() + text.size());
    return;
  }
  ImGui::Indent(em());
  wrappedText(text);
  ImGui::Unindent(em());
}

void heading(const Palette& palette, std::string_view text) {
  ImGui::Dummy({0.0f, 0.15f * em()});
  ImGui::PushStyleColor(ImGuiCol_Text, palette.dim);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopStyleColor();
}

std::string fitted(std::string_view text, float width) {
  if (widthOf(text) <= width) return std::string(text);
  static constexpr std::string_view kDots = "...";
  const float room = width - widthOf(kDots);
  std::size_t size = text.size();
  while (size > 0 && widthOf(text.substr(0, size)) > room) size = wholeCharacters(text, size - 1);
  return size == 0 ? std::string() : std::string(text.substr(0, size)) + std::string(kDots);
}

}  // namespace lightvane
