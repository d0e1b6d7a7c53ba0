#include "core/base/number_text.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace lightvane {
namespace {

/// Three digits of `number` in the largest of `units` that leaves it at 1 or above.
template <std::size_t N>
std::string inUnits(double number, double factor, const std::array<const char*, N>& units) {
  std::size_t unit = 0;
  while (number >= factor * (1.0 - 0.5e-3) && unit + 1 < N) {
    number /= factor;
    ++unit;
  }
  const int decimals = unit == 0 || number >= 99.95 ? 0 : number >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}", number, decimals, units[unit]);
}

}  // namespace

std::string countText(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3;) {
    at -= 3;
    text.insert(at, ",");
  }
  return text;
}

std::string shortCount(double count) {
  static constexpr std::array kUnits{"", " k", " M", " G", " T"};
  return inUnits(count, 1000.0, kUnits);
}

std::string byteText(std::uint64_t bytes) {
  static constexpr std::array kUnits{" B", " kB", " MB", " GB", " TB"};
  return inUnits(static_cast<double>(bytes), 1000.0, kUnits);
}

std::string durationText(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1000.0);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string shortNumber(double value) {
  if (value == 0.0) return "0";  // nor -0
  const bool isCount = value == std::round(value) && std::abs(value) < 1e7;
  return isCount ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

}  // namespace lightvane
