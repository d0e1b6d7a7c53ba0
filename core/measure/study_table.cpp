#include "core/measure/study_table.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/math.h"
#include "core/measure/sweep_pick.h"

namespace lightvane {
namespace {

/// So many significant digits, and no power of ten for what is large.
std::string digitsOf(double value, int digits) {
  return value >= std::pow(10.0, digits) ? fmt::format("{:.0f}", value)
                                         : fmt::format("{:.{}g}", value, digits);
}

std::string meanAndSpread(const Spread& spread, std::size_t runs, double scale) {
  const std::string mean = digitsOf(scale * spread.mean, 3);
  return runs < 2 ? mean : fmt::format("{} ± {}", mean, digitsOf(scale * spread.standardDeviation, 2));
}

/// Lines of 120 characters at most, as the documents have them; a character is a byte here.
std::string wrapped(const std::string& text) {
  constexpr std::size_t kWidth = 120;
  std::string lines;
  std::size_t begin = 0;
  while (text.size() - begin > kWidth) {
    const std::size_t end = text.rfind(' ', begin + kWidth);
    lines += text.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  return lines + text.substr(begin);
}

}  // namespace

const SweepPoint* StudiedScene::pointNamed(std::string_view label) const {
  const auto found =
      std::ranges::find_if(sweep.points, [&](const SweepPoint& point) { return point.label == label; });
  return found == sweep.points.end() ? nullptr : &*found;
}

std::string studyNumber(double value) {
  return value >= 1e4                     ? fmt::format("{:.1e}", value)
         : value >= 100.0 || value == 0.0 ? fmt::format("{:.0f}", value)
         : value >= 10.0                  ? fmt::format("{:.1f}", value)
                                          : fmt::format("{:.2f}", value);
}

std::string studySpreadCell(const SweepPoint* point, const std::string& metric, double scale) {
  if (point == nullptr) return kNoStudyValue;
  const std::optional<Spread> spread = metricSpread(*point, metric);
  if (!spread || !std::isfinite(spread->mean)) return kNoStudyValue;
  return meanAndSpread(*spread, point->runs.size(), scale);
}

std::string studyTimeCell(const SweepPoint* point) {
  return point == nullptr ? kNoStudyValue : meanAndSpread(cpuSpread(*point), point->runs.size(), 1.0);
}

MeanRatio meanRatio(std::span<const double> ratios) {
  LV_CHECK(!ratios.empty(), "the mean of no ratios");
  const auto count = static_cast<double>(ratios.size());
  Spread logarithms;
  for (const double ratio : ratios) logarithms.mean += std::log(ratio);
  logarithms.mean /= count;
  double squares = 0.0;
  for (const double ratio : ratios) squares += square(std::log(ratio) - logarithms.mean);
  if (ratios.size() > 1) logarithms.standardDeviation = std::sqrt(squares / (count - 1.0));
  MeanRatio result{std::exp(logarithms.mean), {}, {}};
  if (const auto half = meanHalfWidth(logarithms, static_cast<int>(ratios.size()))) {
    result.low = std::exp(logarithms.mean - *half);
    result.high = std::exp(logarithms.mean + *half);
  }
  return result;
}

std::string studyRatioCell(const MeanRatio& ratio) {
  std::string text = studyNumber(ratio.mean);
  if (ratio.low && ratio.high)
    text += fmt::format(" [{}, {}]", studyNumber(*ratio.low), studyNumber(*ratio.high));
  return text;
}

std::string studyMarkdown(std::span<const StudyTable> tables) {
  std::string text;
  for (const StudyTable& table : tables) {
    text += fmt::format("{}## {}\n\n{}\n\n", text.empty() ? "" : "\n", table.title, wrapped(table.text));
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      text += "|";
      for (const std::string& cell : table.rows[r]) text += fmt::format(" {} |", cell);
      text += "\n";
      if (r > 0) continue;
      text += "|";
      for (std::size_t c = 0; c < table.rows[r].size(); ++c) text += c == 0 ? "---|" : "--:|";
      text += "\n";
    }
  }
  return text;
}

}  // namespace lightvane
