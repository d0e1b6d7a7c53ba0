#include "core/measure/sweep_html.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "core/base/number_text.h"

namespace lightvane {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

/// The bytes of the character at the start; 0 where there is none (RFC 3629: no overlong forms, surrogates
/// or numbers above 10FFFF; XML has no FFFE and FFFF either).
std::size_t characterLength(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  std::uint32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  static constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};
  const bool isSurrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[length] || code > 0x10ffff || isSurrogate || code == 0xfffe || code == 0xffff) return 0;
  return length;
}

std::string superscript(int number) {
  static constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(number))
    text += c == '-' ? "⁻" : kDigits[static_cast<std::size_t>(c - '0')];
  return text;
}

/// Decimals that leave so many digits of a number.
int decimalsFor(double number, int digits) {
  if (number == 0.0 || !std::isfinite(number)) return 0;
  // Rounded first: 0.9999 is 1.00 and not 1.000.
  const std::string rounded = fmt::format("{:.{}e}", number, digits - 1);
  const int exponent = std::stoi(rounded.substr(rounded.find('e') + 1));
  return std::clamp(digits - 1 - exponent, 0, 9);
}

}  // namespace

std::string escapedHtml(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    const char c = text.front();
    const bool isControl = length == 1 && static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t';
    if (length == 0 || isControl) {
      out += kReplacement;
    } else if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else if (c == '\'') {
      out += "&#39;";
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string escapedUrlPath(std::string_view path) {
  static constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string out;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos)
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
  }
  return out;
}

std::size_t characterCount(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

std::string axisNumberText(double value) {
  const double size = std::abs(value);
  if (size == 0.0) return "0";
  if (size >= 0.999e-3 && size < 1e5) return fmt::format("{:.6g}", value);
  const int exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  // Two steps: 10^-310 alone would be rounded to few bits.
  const double mantissa = value / std::pow(10.0, exponent / 2) / std::pow(10.0, exponent - exponent / 2);
  const std::string power = "10" + superscript(exponent);
  const std::string digits = fmt::format("{:.4g}", mantissa);
  return digits == "1" ? power : digits + "·" + power;
}

std::string reportNumber(double value) {
  if (std::isnan(value)) return "–";
  if (std::isinf(value)) return value > 0.0 ? "∞" : "−∞";
  if (value != 0.0 && (std::abs(value) < 1e-4 || std::abs(value) >= 1e6)) return fmt::format("{:.2e}", value);
  return fmt::format("{:.{}f}", value, decimalsFor(value, 3));
}

std::string spreadText(const Spread& spread, bool hasSpread) {
  const double mean = spread.mean, deviation = spread.standardDeviation;
  if (!hasSpread || !std::isfinite(mean) || !std::isfinite(deviation)) return reportNumber(mean);
  const double larger = std::max(std::abs(mean), deviation);
  if (larger != 0.0 && (larger < 1e-4 || larger >= 1e6))
    return fmt::format("{:.2e} ± {:.1e}", mean, deviation);
  // A deviation far below the mean's digits needs no more of them.
  const int decimals =
      std::max(decimalsFor(mean, 3), std::min(decimalsFor(deviation, 1), decimalsFor(mean, 5)));
  return fmt::format("{:.{}f} ± {:.{}f}", mean, decimals, deviation, decimals);
}

}  // namespace lightvane
