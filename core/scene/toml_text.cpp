#include "core/scene/toml_text.h"

#include <algorithm>
#include <cstdint>

#include "core/base/parameter.h"

namespace lightvane {

std::string tomlString(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 0x20 || byte == 0x7f) {
      result += fmt::format("\\u{:04x}", byte);
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string tomlKey(std::string_view name) {
  const auto isBare = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), isBare) ? std::string(name)
                                                                        : tomlString(name);
}

std::string tomlNumber(double number) {
  std::string text = fmt::format("{}", number);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";  // "1e-05", "nan"
  return text;
}

std::string tomlNumber(float number) {
  // Rounding twice misses 7.038531e-26 alone, of all floats: that has its digits as a double.
  const std::string shortest = fmt::format("{}", number);
  double read = 0.0;
  const bool isRead = parameter_text::parse(shortest, read).empty() && static_cast<float>(read) == number;
  if (!isRead) return tomlNumber(static_cast<double>(number));
  return shortest.find_first_of(".e") == std::string::npos ? shortest + ".0" : shortest;
}

std::string tomlSetting(const std::string& value) {
  if (value == "true" || value == "false") return value;
  std::int64_t whole = 0;
  if (parameter_text::parse(value, whole).empty() && fmt::format("{}", whole) == value) return value;
  double number = 0.0;
  const bool isFloat = parameter_text::parse(value, number).empty() && fmt::format("{}", number) == value &&
                       value.find_first_of(".e") != std::string::npos;
  return isFloat ? value : tomlString(value);
}

std::string tomlLine(std::string_view key, std::string_view value, std::string_view help) {
  return help.empty() ? fmt::format("{} = {}\n", key, value)
                      : fmt::format("{} = {}  # {}\n", key, value, help);
}

}  // namespace lightvane
