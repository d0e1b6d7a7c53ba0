#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/length.h"
#include "core/base/text.h"

namespace lightvane {

// A parameter struct has one visitor that names its fields; everything else about them is read off that list:
// --set, a scene's [render], `lightvane parameters`, docs/parameters.md, and panels.
//
//   template <class P, class Visit> void visitParameters(P& p, Visit&& visit) {
//     visit(p.ilv.nMin, Field{.key = "ilv.n_min", ...}, Range{1, 64});
//   }

/// What changing a field makes stale, the least first.
enum class ChangeCost {
  Display,  ///< nothing that was computed
  Answer,   ///< visible points are answered again from the vectors that exist
  Vectors,  ///< vectors of that kind are computed anew
  Scene     ///< the scene is compiled anew
};

const char* changeCostName(ChangeCost cost);

/// What speed and accuracy a value is traded for.
enum class Trade {
  Neither,  ///< nothing, or as the help says
  LargerIsFaster,
  LargerIsMoreAccurate,
  OnIsMoreAccurate
};
/// "Larger is faster, smaller is more accurate."; empty for Neither.
const char* tradeSentence(Trade trade);

/// Everything that is said about a field beside its value.
struct Field {
  const char* key;        ///< "ilv.n_min"
  const char* label;      ///< "Fewest vectors"
  const char* unit = "";  ///< "", "deg", "px"
  ChangeCost cost = ChangeCost::Answer;
  const char* paper = "";  ///< section or equation; empty where the paper has nothing like it
  const char* help = "";   ///< one sentence
  Trade trade = Trade::Neither;
};

/// The help, and what the field trades.
std::string helpOf(const Field& field);

template <class T>
struct Range {
  T min;
  T max;
};
template <class T>
Range(T, T) -> Range<T>;

/// The values of an enum field, by the names that files and command lines use.
template <class E>
struct Choice {
  E value;
  const char* name;
};

template <class E>
Choice(E, const char*) -> Choice<E>;

/// The value of that name.
template <class E, std::size_t N>
std::optional<E> choiceNamed(const std::array<Choice<E>, N>& choices, std::string_view name) {
  for (const Choice<E>& choice : choices) {
    if (name == choice.name) return choice.value;
  }
  return std::nullopt;
}
/// The name of a value; empty where it has none.
template <class E, std::size_t N>
const char* choiceName(const std::array<Choice<E>, N>& choices, E value) {
  for (const Choice<E>& choice : choices) {
    if (value == choice.value) return choice.name;
  }
  return "";
}
/// All names, in their order.
template <class E, std::size_t N>
std::vector<std::string> choiceNames(const std::array<Choice<E>, N>& choices) {
  std::vector<std::string> names;
  for (const Choice<E>& choice : choices) names.emplace_back(choice.name);
  return names;
}

/// A field as text, for listings.
struct FieldDescription {
  Field field;
  std::string value;
  std::string range;  ///< "1 to 64", "true or false", "printed, paper or refined"
};

namespace parameter_text {

inline std::string format(bool v) { return v ? "true" : "false"; }
template <class T>
  requires std::is_arithmetic_v<T>
std::string format(T v) {
  return fmt::format("{}", v);
}
inline std::string format(const Length& v) {
  return v.isRelative() ? fmt::format("{:.9g}%", v.value() * 100.0) : fmt::format("{:.9g}m", v.value());
}

/// What was expected where `text` does not fit; empty where it was read.
std::string parse(std::string_view text, bool& value);
std::string parse(std::string_view text, Length& value);
template <class T>
  requires std::is_arithmetic_v<T>
std::string parse(std::string_view text, T& value) {
  T parsed{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::is_integral_v<T> ? "a whole number" : "a number";
  }
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(parsed)) return "a finite number";
  }
  value = parsed;
  return {};
}

}  // namespace parameter_text

/// Sets one field by its key; used by setParameter.
class ParameterSetter {
 public:
  ParameterSetter(std::string_view key, std::string_view text) : key_(key), text_(text) {}

  template <class T>
  void operator()(T& value, const Field& field, const Range<T>& range) {
    if (!matches(field)) return;
    T parsed = value;
    std::string expected = parameter_text::parse(text_, parsed);
    if constexpr (std::is_arithmetic_v<T>) {
      if (expected.empty() && (parsed < range.min || parsed > range.max)) expected = "a value";
      if (!expected.empty()) expected += fmt::format(" from {} to {}", range.min, range.max);
    } else {
      const bool inside = !parsed.isRelative() ||
                          (parsed.value() >= range.min.value() && parsed.value() <= range.max.value());
      if (expected.empty() && (!inside || parsed.value() < 0.0)) expected = describeLengthRange(range);
    }
    finish(value, parsed, expected);
  }
  void operator()(bool& value, const Field& field) {
    if (!matches(field)) return;
    bool parsed = value;
    const std::string expected = parameter_text::parse(text_, parsed);
    finish(value, parsed, expected);
  }
  template <class E, std::size_t N>
  void operator()(E& value, const Field& field, const std::array<Choice<E>, N>& choices) {
    if (!matches(field)) return;
    const std::optional<E> named = choiceNamed(choices, text_);
    finish(value, named.value_or(value), named ? std::string() : listWords(choiceNames(choices)));
  }

  /// An error that names the key and what was expected, or the nearest key where there is none of that name.
  Expected<void> result(const std::string& where) const;

 private:
  bool matches(const Field& field) {
    keys_.emplace_back(field.key);
    if (key_ != field.key) return false;
    found_ = true;
    return true;
  }
  template <class T>
  void finish(T& value, const T& parsed, const std::string& expected) {
    if (expected.empty()) {
      value = parsed;
    } else {
      expected_ = expected;
    }
  }
  static std::string describeLengthRange(const Range<Length>& range);

  std::string_view key_;
  std::string_view text_;
  bool found_ = false;
  std::string expected_;
  std::vector<std::string> keys_;
};

/// Sets the field `key` from text. Errors name `where` ("--set ilv.n_min=x", "file:3:1"), what was expected
/// and what was found, or the nearest key.
template <class P>
Expected<void> setParameter(P& parameters, std::string_view key, std::string_view text,
                            const std::string& where) {
  ParameterSetter setter(key, text);
  visitParameters(parameters, setter);
  return setter.result(where);
}

/// Collects the fields as text; used by describeParameters.
struct ParameterDescriber {
  std::vector<FieldDescription> rows;
  template <class T>
  void operator()(const T& value, const Field& field, const Range<T>& range) {
    rows.push_back({field, parameter_text::format(value),
                    parameter_text::format(range.min) + " to " + parameter_text::format(range.max)});
  }
  void operator()(const bool& value, const Field& field) {
    rows.push_back({field, parameter_text::format(value), "true or false"});
  }
  template <class E, std::size_t N>
  void operator()(const E& value, const Field& field, const std::array<Choice<E>, N>& choices) {
    rows.push_back({field, choiceName(choices, value), listWords(choiceNames(choices))});
  }
};
/// Every field in the visitor's order, as text.
template <class P>
std::vector<FieldDescription> describeParameters(const P& parameters) {
  ParameterDescriber describer;
  visitParameters(parameters, describer);
  return std::move(describer.rows);
}

}  // namespace lightvane
