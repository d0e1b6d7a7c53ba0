#include "app/panels/parameter_rows.h"

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "app/panels/controls.h"
#include "app/panels/parameter_info.h"
#include "app/panels/widgets.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

// Steps of a seed: a drag over a panel's width tries some dozens.
constexpr double kSeedStepPixels = 8.0;
constexpr double kMarkSeconds = 2.5;

const Parameters kDefaults;

/// Reads one field of its type.
template <class T>
class FieldReader {
 public:
  FieldReader(std::string_view key, const T& otherwise) : key_(key), value_(otherwise) {}
  template <class U, class... Rest>
  void operator()(const U& value, const Field& field, const Rest&...) {
    if constexpr (std::is_same_v<T, U>) {
      if (key_ == field.key) value_ = value;
    }
  }
  const T& value() const { return value_; }

 private:
  std::string_view key_;
  T value_;
};

/// The field of that key and type; `otherwise` where there is none.
template <class T>
T fieldOf(const Parameters& parameters, std::string_view key, const T& otherwise) {
  FieldReader<T> reader(key, otherwise);
  visitParameters(parameters, reader);
  return reader.value();
}

std::string textOf(bool v) { return parameter_text::format(v); }
std::string textOf(const Length& v) { return parameter_text::format(v); }
std::string textOf(double v) { return shortNumber(v); }
std::string textOf(int v) { return std::to_string(v); }
std::string textOf(std::uint64_t v) { return std::to_string(v); }

/// Draws the fields of one group; the visitor of visitParameters.
class GroupDrawer {
 public:
  GroupDrawer(std::string_view group, Workspace& workspace, const PanelInput& input, PanelState& state,
              PanelOutput& output)
      : group_(group),
        filter_(state.parameters.filter),
        parameters_(workspace.setup.parameters),
        scene_(input.scene ? &*input.scene : nullptr),
        start_(scene_ != nullptr ? scene_->start : kDefaults),
        input_(input),
        state_(state),
        output_(output),
        palette_(paletteOf(workspace.display.theme)) {}

  void operator()(bool& value, const Field& field) {
    if (!shows(field)) return;
    const Row<bool> row = beginRow<bool>(field, value, "true or false");
    ControlLine line = lineOf(row);
    toggleLine(frame(), line, value);
    endRow(row, value, [&] { estimate(field, textOf(!value)); });
  }

  template <class E, std::size_t N>
  void operator()(E& value, const Field& field, const std::array<Choice<E>, N>& choices) {
    if (!shows(field)) return;
    const Row<E> row = beginRow<E>(field, value, listWords(choiceNames(choices)));
    std::array<const char*, N> names{};
    std::size_t current = 0;
    for (std::size_t i = 0; i < N; ++i) {
      names[i] = choices[i].name;
      if (choices[i].value == value) current = i;
    }
    const auto chosen = choiceLine(frame(), lineOf(row), names, current, [&](std::size_t i) {
      ImGui::BeginTooltip();
      showCost(field);
      estimate(field, names[i]);
      recordTooltip();
      ImGui::EndTooltip();
    });
    if (chosen) choose(value, choices[*chosen].value);
    endRow(row, value, [&] {
      for (std::size_t i = 0; i < N; ++i)
        if (i != current) estimate(field, names[i]);
    });
  }

  template <class T>
  void operator()(T& value, const Field& field, const Range<T>& range) {
    if (!shows(field)) return;
    const Row<T> row =
        beginRow<T>(field, value, fmt::format("{} to {}", textOf(range.min), textOf(range.max)));
    ControlLine line = lineOf(row);
    line.value = textOf(value);
    if (field.unit[0] != '\0') line.value += fmt::format(" {}", field.unit);
    NumberLine number{.value = static_cast<double>(value),
                      .reference = static_cast<double>(row.target),
                      .typing = parameter_text::format(value)};
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      number.stepPixels = kSeedStepPixels;
    } else {
      number.scale = ValueScale::about(range.min, range.max, row.usual, value, std::is_integral_v<T>);
    }
    const NumberChange change = numberLine(frame(), line, number);
    if (change.dragged) {
      if constexpr (std::is_same_v<T, std::uint64_t>) {
        // Wraps round below 0, as the range is that of the type.
        value += static_cast<std::uint64_t>(static_cast<std::int64_t>(*change.dragged));
      } else {
        value = static_cast<T>(*change.dragged);
      }
    }
    if (change.typed) takeTyped(field, *change.typed);
    endRow(row, value, [&] { estimateNeighbours(field, value, range); });
  }

  void operator()(Length& value, const Field& field, const Range<Length>& range) {
    if (!shows(field)) return;
    const Row<Length> row =
        beginRow<Length>(field, value, fmt::format("{} to {}", textOf(range.min), textOf(range.max)));
    const LengthUnit unit = unitOf(field, value);
    const auto inUnit = [&](const Length& length) { return lengthIn(unit, length, scene_); };
    ControlLine line = lineOf(row);
    line.value = shortNumber(inUnit(value));
    const NumberChange change =
        numberLine(frame(unitButtonWidth()), line,
                   {.scale = ValueScale::about(inUnit(range.min), inUnit(range.max), inUnit(row.usual),
                                               inUnit(value), false),
                    .value = inUnit(value),
                    .reference = inUnit(row.target),
                    .typing = fmt::format("{}", inUnit(value))});
    if (change.dragged) value = lengthOf(*change.dragged, unit, scene_);
    if (change.typed) takeTyped(field, canonicalLength(*change.typed, unit, scene_));
    const bool hovered = wantsTooltip(state_.controls, field.key);
    if (!isRefused(field)) {
      ImGui::SameLine(0.0f, 0.3f * ImGui::GetFontSize());
      drawUnitButton(value, field, unit);
    }
    const auto estimates = [&] {
      for (const double factor : {0.5, 2.0}) {
        const double length = factor * value.value();
        const Length other = value.isRelative() ? Length::relative(length) : Length::metres(length);
        if (length > 0.0) estimate(field, parameter_text::format(other));
      }
    };
    endRow(row, value, estimates, hovered);
  }

 private:
  template <class T>
  struct Row {
    Field field;
    std::string range;
    T usual;   ///< the default
    T start;   ///< the scene's
    T target;  ///< what a reset gives: the scene's, or where that is set already, the default
    bool changed;
    bool resettable;
    std::string idle;
  };

  bool shows(const Field& field) const {
    return groupOf(field.key) == group_ && matchesFilter(field, filter_);
  }

  template <class T>
  Row<T> beginRow(const Field& field, const T& value, std::string range) {
    const T usual = fieldOf(kDefaults, field.key, value);
    const T start = fieldOf(start_, field.key, value);
    const bool changed = !(value == start);
    focusHere(field, value);
    return {field,
            std::move(range),
            usual,
            start,
            changed ? start : usual,
            changed,
            changed || !(value == usual),
            whyFieldIsIdle(field.key, parameters_, scene_)};
  }

  template <class T>
  static ControlLine lineOf(const Row<T>& row) {
    return {.name = row.field.key,
            .label = row.field.label,
            .value = {},
            .dimmed = !row.idle.empty(),
            .changed = row.changed};
  }

  /// The palette asked for this field: it is scrolled to, marked for a while, and opened for typing.
  template <class T>
  void focusHere(const Field& field, const T& value) {
    ParametersPanelState& own = state_.parameters;
    if (own.focus == field.key) {
      own.focus.reset();
      own.marked = field.key;
      own.markedUntil = input_.timeSeconds + kMarkSeconds;
      ImGui::SetScrollHereY(0.3f);
      if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
        state_.controls.type(field.key, parameter_text::format(value));
      } else if constexpr (std::is_same_v<T, Length>) {
        state_.controls.type(field.key, fmt::format("{}", lengthIn(unitOf(field, value), value, scene_)));
      }
    }
  }

  ControlStyle frame(float alsoReserved = 0.0f) const {
    const float width = ImGui::GetContentRegionAvail().x - alsoReserved - badgeWidth() - resetButtonWidth();
    return {palette_, state_.controls, width};
  }

  static float badgeWidth() { return 1.1f * ImGui::GetFontSize() + ImGui::GetStyle().ItemSpacing.x; }
  static float unitButtonWidth() { return 2.3f * ImGui::GetFontSize(); }

  /// What is typed into the field's line; null where nothing is.
  const TypedValue* typedInto(const Field& field) const {
    const std::optional<TypedValue>& typed = state_.controls.typed;
    return typed && typed->control == field.key ? &*typed : nullptr;
  }
  /// Then its message stands below it, and the line's end is no place for anything.
  bool isRefused(const Field& field) const {
    const TypedValue* typed = typedInto(field);
    return typed != nullptr && !typed->error.empty();
  }

  /// Badge, reset, tooltip and mark of the line whose frame was drawn last.
  template <class T, class Estimates>
  void endRow(const Row<T>& row, T& value, const Estimates& estimates, std::optional<bool> hovered = {}) {
    const std::string key = row.field.key;
    const bool typing = typedInto(row.field) != nullptr;
    if (!typing && hovered.value_or(false)) showFieldTooltip(row, estimates);
    // Asked once a frame and control: asking of another item would say that the mouse is off it.
    if (!typing && !hovered && wantsTooltip(state_.controls, key)) showFieldTooltip(row, estimates);
    if (state_.parameters.marked == key && input_.timeSeconds < state_.parameters.markedUntil) {
      ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), palette_.accent,
                                          ImGui::GetStyle().FrameRounding, 0, 2.0f);
    }
    if (isRefused(row.field)) return;
    ImGui::SameLine();
    drawBadge(row.field);
    ImGui::SameLine();
    const std::string explanation =
        fmt::format("Sets it to {} {}", row.changed ? "the scene's" : "the default", textOfField(row.target));
    if (resetButton({palette_, state_.controls}, key, row.resettable, explanation)) {
      choose(value, row.target);
    }
  }

  /// Sets a field; rules set all that they name.
  template <class T>
  void choose(T& value, const T& chosen) {
    if constexpr (std::is_same_v<T, Rules>) {
      applyRules(parameters_.vectors, chosen);
    } else {
      value = chosen;
    }
  }

  void takeTyped(const Field& field, const std::string& text) {
    if (const Expected<void> done = setParameter(parameters_, field.key, text, ""); done) {
      acceptTyped(state_.controls);
    } else {
      refuseTyped(state_.controls, done.error().message());
    }
  }

  void drawBadge(const Field& field) {
    const float size = 1.1f * ImGui::GetFontSize();
    const std::string name = fmt::format("{}.cost", field.key);
    ImGui::Dummy({size, ImGui::GetFrameHeight()});
    Widgets::recordItem(name);
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    drawCostBadge(*ImGui::GetWindowDrawList(), {0.5f * (min.x + max.x), 0.5f * (min.y + max.y)}, 0.55f * size,
                  field.cost, palette_);
    if (wantsTooltip(state_.controls, name)) showTooltip(palette_, "", costText(field));
  }

  LengthUnit unitOf(const Field& field, const Length& value) const {
    if (value.isRelative()) return LengthUnit::Percent;
    return state_.parameters.inSceneUnits.contains(field.key) ? LengthUnit::Scene : LengthUnit::Metre;
  }

  /// Goes round the units; the length stays as long as it is. Without a scene nothing says how long that is.
  void drawUnitButton(Length& value, const Field& field, LengthUnit unit) {
    const std::string name = fmt::format("{}.unit", field.key);
    const bool sceneHasOther = scene_ != nullptr && lengthUnitText(LengthUnit::Scene, scene_) != "m";
    const LengthUnit next = unit == LengthUnit::Metre                      ? LengthUnit::Percent
                            : unit == LengthUnit::Percent && sceneHasOther ? LengthUnit::Scene
                                                                           : LengthUnit::Metre;
    const std::string text = fmt::format("{}##{}", lengthUnitText(unit, scene_), name);
    ImGui::BeginDisabled(scene_ == nullptr);
    const bool clicked = ImGui::Button(text.c_str(), {2.0f * ImGui::GetFontSize(), ImGui::GetFrameHeight()});
    ImGui::EndDisabled();
    Widgets::recordItem(name);
    tooltip({palette_, state_.controls}, name, "",
            fmt::format("In {}; click for {}", unitWords(unit), unitWords(next)));
    if (!clicked) return;
    next == LengthUnit::Scene ? static_cast<void>(state_.parameters.inSceneUnits.insert(field.key))
                              : static_cast<void>(state_.parameters.inSceneUnits.erase(field.key));
    value = lengthOf(lengthIn(next, value, scene_), next, scene_);
  }

  std::string unitWords(LengthUnit unit) const {
    return unit == LengthUnit::Percent ? "percent of the scene's diagonal" : lengthUnitText(unit, scene_);
  }

  template <class T>
  static std::string textOfField(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return std::string(nameOf(value));
    } else {
      return textOf(value);
    }
  }
  /// The name of an enum's value, which only the list of fields knows.
  template <class E>
  static std::string nameOf(E value) {
    std::string name;
    const auto visit = [&]<class T, class... Rest>(const T&, const Field&, const Rest&... rest) {
      if constexpr (std::is_same_v<T, E>) ((name = choiceName(rest, value)), ...);
    };
    visitParameters(kDefaults, visit);
    return name;
  }

  template <class T, class Estimates>
  void showFieldTooltip(const Row<T>& row, const Estimates& estimates) {
    const std::vector<std::string> lines = tooltipLines({.field = row.field,
                                                         .range = row.range,
                                                         .defaultValue = textOfField(row.usual),
                                                         .startValue = textOfField(row.start)});
    ImGui::BeginTooltip();
    ImGui::TextUnformatted(row.field.label);
    for (const std::string& line : lines) noteTextInTooltip(line);
    if (!row.idle.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, palette_.warning);
      wrappedTextInTooltip("No effect now. " + row.idle);
      ImGui::PopStyleColor();
    }
    showCost(row.field);
    estimates();
    recordTooltip();
    ImGui::EndTooltip();
  }

  void noteTextInTooltip(const std::string& text) const {
    ImGui::PushStyleColor(ImGuiCol_Text, palette_.dim);
    wrappedTextInTooltip(text);
    ImGui::PopStyleColor();
    told_ += text + '\n';
  }

  void recordTooltip() const { Widgets::recordWindow("tooltip", std::exchange(told_, {})); }

  void showCost(const Field& field) const {
    const float size = ImGui::GetFontSize();
    ImGui::Dummy({size, size});
    const ImVec2 min = ImGui::GetItemRectMin();
    drawCostBadge(*ImGui::GetWindowDrawList(), {min.x + 0.5f * size, min.y + 0.5f * size}, 0.6f * size,
                  field.cost, palette_);
    ImGui::SameLine();
    const std::string text = costText(field);
    ImGui::TextUnformatted(text.c_str());
    told_ += text + '\n';
  }

  /// What setting the field to `text` would cost, as a line of a tooltip.
  void estimate(const Field& field, const std::string& text) const {
    Parameters candidate = parameters_;
    if (!setParameter(candidate, field.key, text, "")) return;
    if (groupOf(field.key) == "method" && std::string_view(field.key) == "method.rules") {
      applyRules(candidate.vectors, candidate.vectors.rules);
    }
    const std::optional<ChangeEstimate> estimate =
        input_.estimateChange ? input_.estimateChange(candidate) : std::nullopt;
    output_.stale = staleKinds(estimate);
    if (const std::string change = changeText(field.key, candidate, estimate); !change.empty())
      noteTextInTooltip(fmt::format("{}: {}", text, change));
  }

  /// The same for half and for twice the value.
  template <class T>
  void estimateNeighbours(const Field& field, T value, const Range<T>& range) const {
    if constexpr (std::is_same_v<T, std::uint64_t>) {
      estimate(field, parameter_text::format(value + 1));
    } else {
      const T half = std::is_integral_v<T> ? static_cast<T>(value / 2) : static_cast<T>(value * T(0.5));
      const T twice = value == T(0) ? T(1) : static_cast<T>(std::min<double>(2.0 * value, range.max));
      for (const T other :
           {std::clamp(half, range.min, range.max), std::clamp(twice, range.min, range.max)}) {
        if (other != value) estimate(field, parameter_text::format(other));
      }
    }
  }

  std::string_view group_;
  std::string_view filter_;
  Parameters& parameters_;
  const SceneSummary* scene_;
  const Parameters& start_;
  const PanelInput& input_;
  PanelState& state_;
  PanelOutput& output_;
  const Palette& palette_;
  mutable std::string told_;  ///< lines of the tooltip that is being drawn
};

}  // namespace

void drawParameterRows(std::string_view group, Workspace& workspace, const PanelInput& input,
                       PanelState& state, PanelOutput& output) {
  GroupDrawer drawer(group, workspace, input, state, output);
  visitParameters(workspace.setup.parameters, drawer);
}

}  // namespace lightvane
