#include "core/base/parameter.h"

#include <cctype>

namespace lightvane {

const char* changeCostName(ChangeCost cost) {
  switch (cost) {
    case ChangeCost::Display:
      return "display";
    case ChangeCost::Answer:
      return "answer";
    case ChangeCost::Vectors:
      return "vectors";
    case ChangeCost::Scene:
      return "scene";
  }
  return "";
}

const char* tradeSentence(Trade trade) {
  switch (trade) {
    case Trade::Neither:
      return "";
    case Trade::LargerIsFaster:
      return "Larger is faster, smaller is more accurate.";
    case Trade::LargerIsMoreAccurate:
      return "Larger is more accurate, smaller is faster.";
    case Trade::OnIsMoreAccurate:
      return "On is more accurate, off is faster.";
  }
  return "";
}

std::string helpOf(const Field& field) {
  const std::string_view trade = tradeSentence(field.trade);
  return trade.empty() ? field.help : fmt::format("{} {}", field.help, trade);
}

namespace parameter_text {

std::string parse(std::string_view text, bool& value) {
  if (text == "true" || text == "false") {
    value = text == "true";
    return {};
  }
  return "true or false";
}

std::string parse(std::string_view text, Length& value) {
  std::string expected = "a length such as 1.5% (of the scene's diagonal) or 0.08m";
  std::size_t end = text.size();
  while (end > 0 && (std::isalpha(static_cast<unsigned char>(text[end - 1])) || text[end - 1] == '%')) --end;
  const std::string_view unit = text.substr(end);
  std::string_view digits = text.substr(0, end);
  while (!digits.empty() && digits.back() == ' ') digits.remove_suffix(1);
  double number = 0.0;
  if (!parse(digits, number).empty()) return expected;
  if (unit == "%") {
    value = Length::relative(number / 100.0);
  } else if (unit == "m") {
    value = Length::metres(number);
  } else {
    return expected;
  }
  return {};
}

}  // namespace parameter_text

std::string ParameterSetter::describeLengthRange(const Range<Length>& range) {
  return fmt::format("a length from {} to {} of the scene's diagonal, or in metres such as 0.08m",
                     parameter_text::format(range.min), parameter_text::format(range.max));
}

Expected<void> ParameterSetter::result(const std::string& where) const {
  if (!found_) {
    return makeError(where, fmt::format("there is no parameter '{}'", key_), suggestion(key_, keys_));
  }
  if (!expected_.empty())
    return makeError(where, fmt::format("{} takes {}, not '{}'", key_, expected_, text_));
  return {};
}

}  // namespace lightvane
