#include "core/measure/sweep.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "core/base/parameter.h"
#include "core/base/random.h"

namespace lightvane {
namespace {

constexpr int kMostSteps = 1000;

std::vector<std::string> splitAt(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const std::size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

/// Numbers from low to high as text, at equal ratios or at equal distances.
std::vector<std::string> numbersBetween(double low, double high, int count, bool byRatio, bool areWhole) {
  std::vector<std::string> numbers;
  for (int i = 0; i < count; ++i) {
    const double part = static_cast<double>(i) / (count - 1);
    const double number = byRatio ? low * std::pow(high / low, part) : low + (high - low) * part;
    std::string text = areWhole ? fmt::format("{:.0f}", number) : fmt::format("{:.4g}", number);
    if (numbers.empty() || numbers.back() != text) numbers.push_back(std::move(text));
  }
  return numbers;
}

Spread spreadOf(const std::vector<double>& values) {
  Spread spread{0.0, 0.0, values.front(), values.front()};
  for (const double value : values) {
    spread.mean += value / static_cast<double>(values.size());
    spread.least = std::min(spread.least, value);
    spread.most = std::max(spread.most, value);
  }
  double squares = 0.0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  if (values.size() > 1 && std::isfinite(spread.mean))
    spread.standardDeviation = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return spread;
}

}  // namespace

Expected<VariedParameter> parseVaried(const std::string& text, const std::string& where) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return makeError(where, fmt::format("expected KEY=A,B,C or KEY=LOW:HIGH:N, found '{}'", text));
  VariedParameter varied;
  varied.key = text.substr(0, equals);
  const std::string values = text.substr(equals + 1);
  if (values.find(':') == std::string::npos) {
    varied.values = splitAt(values, ',');
    const bool hasEmpty = std::find(varied.values.begin(), varied.values.end(), "") != varied.values.end();
    if (hasEmpty) return makeError(where, fmt::format("one of the values of '{}' is empty", text));
    std::vector<std::string> once;
    for (const std::string& value : varied.values) {
      if (std::find(once.begin(), once.end(), value) == once.end()) once.push_back(value);
    }
    varied.values = std::move(once);
  } else {
    const std::vector<std::string> parts = splitAt(values, ':');
    double low = 0.0, high = 0.0;
    int count = 0;
    const bool isRange = parts.size() == 3 && parameter_text::parse(parts[0], low).empty() &&
                         parameter_text::parse(parts[1], high).empty() &&
                         parameter_text::parse(parts[2], count).empty() && std::isfinite(low) &&
                         std::isfinite(high) && low < high && count >= 2 && count <= kMostSteps;
    if (!isRange) {
      return makeError(where,
                       fmt::format("expected {}=LOW:HIGH:N with LOW below HIGH and N from 2 to {}, found "
                                   "'{}'",
                                   varied.key, kMostSteps, values));
    }
    // Counts take whole numbers. From a number to one of ten times as much ratios are what counts.
    const bool areWhole = low == std::floor(low) && high == std::floor(high) && high >= 10.0;
    varied.values = numbersBetween(low, high, count, low > 0.0, areWhole);
    // Small counts by equal ratios are the same ones again and again.
    if (varied.values.size() < static_cast<std::size_t>(count))
      varied.values = numbersBetween(low, high, count, false, areWhole);
  }
  return varied;
}

std::vector<SweepSettings> sweepGrid(const std::vector<VariedParameter>& varied) {
  std::vector<SweepSettings> points = {{}};
  for (const VariedParameter& parameter : varied) {
    std::vector<SweepSettings> more;
    for (const SweepSettings& point : points) {
      for (const std::string& value : parameter.values) {
        more.push_back(point);
        more.back().emplace_back(parameter.key, value);
      }
    }
    points = std::move(more);
  }
  return points;
}

std::vector<SweepSettings> sweepAround(const std::vector<VariedParameter>& varied) {
  std::vector<SweepSettings> points = {{}};
  for (const VariedParameter& parameter : varied) {
    for (const std::string& value : parameter.values) points.push_back({{parameter.key, value}});
  }
  return points;
}

std::vector<SweepSettings> sweepRandom(const std::vector<VariedParameter>& varied, int count,
                                       std::uint64_t seed) {
  std::vector<SweepSettings> points;
  std::set<SweepSettings> known;
  const RandomKey key = randomKey(seed);
  // Where nearly all combinations are drawn already, another new one is hard to come by.
  const auto tries = static_cast<std::uint32_t>(100 * std::max(count, 1));
  for (std::uint32_t i = 0; i < tries && points.size() < static_cast<std::size_t>(count); ++i) {
    SweepSettings point;
    for (std::uint32_t p = 0; p < varied.size(); ++p) {
      const std::vector<std::string>& values = varied[p].values;
      const auto place = static_cast<std::size_t>(uniform(key, i, p) * static_cast<float>(values.size()));
      point.emplace_back(varied[p].key, values[std::min(place, values.size() - 1)]);
    }
    if (known.insert(point).second) points.push_back(std::move(point));
  }
  return points;
}

std::string SweepPoint::name() const {
  if (!label.empty()) return label;
  if (settings.empty()) return method;
  std::vector<std::string> texts;
  for (const auto& [key, value] : settings) texts.push_back(fmt::format("{}={}", key, value));
  return fmt::format("{}", fmt::join(texts, " "));
}

std::optional<Spread> metricSpread(const SweepPoint& point, std::string_view metric) {
  std::vector<double> values;
  for (const SweepRun& run : point.runs) {
    const auto found = run.metrics.find(std::string(metric));
    if (found == run.metrics.end() || std::isnan(found->second)) return std::nullopt;
    values.push_back(found->second);
  }
  if (values.empty()) return std::nullopt;
  return spreadOf(values);
}

Spread cpuSpread(const SweepPoint& point) {
  std::vector<double> values;
  for (const SweepRun& run : point.runs) values.push_back(run.cpuSeconds);
  return values.empty() ? Spread{} : spreadOf(values);
}

std::vector<std::size_t> paretoFront(const Sweep& sweep, std::string_view metric) {
  struct Place {
    double cpu, error;
    std::size_t index;
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    if (const auto error = metricSpread(sweep.points[i], metric))
      places.push_back({cpuSpread(sweep.points[i]).mean, error->mean, i});
  }
  std::ranges::sort(places, [](const Place& a, const Place& b) {
    return std::tie(a.cpu, a.error, a.index) < std::tie(b.cpu, b.error, b.index);
  });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const Place& place : places) {
    if (!(place.error < least)) continue;
    least = place.error;
    front.push_back(place.index);
  }
  return front;
}

}  // namespace lightvane
