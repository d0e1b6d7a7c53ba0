#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace lightvane {

// Values as TOML has them, so that reading gives them back exactly.

/// A basic string.
std::string tomlString(std::string_view text);
/// A key: bare where it may be, else a string.
std::string tomlKey(std::string_view name);

/// The shortest text that reads back as this number, and that TOML takes for a float.
std::string tomlNumber(double number);
/// Of a float, which is read as double and rounded.
std::string tomlNumber(float number);
template <class Vector>
std::string tomlTriple(const Vector& v) {
  return fmt::format("[{}, {}, {}]", tomlNumber(v.x), tomlNumber(v.y), tomlNumber(v.z));
}
/// A parameter's value: bare where TOML gives the very text back, as of numbers, else in quotes.
std::string tomlSetting(const std::string& value);

/// "key = value", and `help` as a comment.
std::string tomlLine(std::string_view key, std::string_view value, std::string_view help = {});

}  // namespace lightvane
