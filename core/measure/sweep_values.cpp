#include "core/measure/sweep_values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

namespace lightvane {
namespace {

constexpr const char* kVectors = "vectors";
constexpr const char* kDefault = "default";

ReportMetric reportMetric(const std::string& key) {
  const std::size_t dot = key.rfind('.');
  if (dot == std::string::npos) return {key, "", findMetric(key)};
  return {key, key.substr(0, dot), findMetric(key.substr(dot + 1))};
}

/// Beauty, then the other layers; in each the metrics as they are always listed, then unknown ones.
auto displayOrder(const ReportMetric& metric) {
  const std::ptrdiff_t place = metric.info != nullptr ? metric.info - metrics().data() : 1000;
  return std::tuple(metric.layer != "beauty", metric.layer, place, metric.key);
}

bool hasUnit(const ReportMetric& metric, MetricUnit unit) {
  return metric.info != nullptr && metric.info->unit == unit;
}
BetterValue betterOf(const ReportMetric& metric) {
  return metric.info != nullptr ? metric.info->better : BetterValue::Lower;
}

/// Geometric on a logarithmic axis, where a factor is a distance; nothing where it is no number.
std::optional<double> meanOnScale(const std::vector<double>& values, PlotScale scale) {
  if (values.empty()) return std::nullopt;
  double sum = 0.0;
  for (const double value : values) sum += scale == PlotScale::Log ? std::log(std::max(value, 0.0)) : value;
  const double mean = sum / static_cast<double>(values.size());
  if (std::isnan(mean)) return std::nullopt;
  return scale == PlotScale::Log ? std::exp(mean) : mean;
}

/// "" where it is as it would be without a sweep.
std::string settingOf(const SweepSettings& settings, const std::string& key) {
  for (const auto& [name, value] : settings) {
    if (name == key) return value;
  }
  return {};
}

KnobMean knobMean(const KnobEffect& effect, const std::string& method, PlotScale scale,
                  const std::vector<PlottedPoint>& points,
                  const std::vector<std::vector<std::size_t>>& pointsByCategory, std::size_t combinations,
                  bool isOfAll) {
  KnobMean mean{method, {}, {}, combinations, isOfAll};
  for (std::size_t c = 0; c < effect.categories.size(); ++c) {
    std::vector<double> errors, seconds;
    for (const std::size_t p : pointsByCategory[c]) {
      errors.push_back(points[p].error);
      seconds.push_back(points[p].cpu.mean);
    }
    mean.error.push_back(meanOnScale(errors, scale));
    mean.seconds.push_back(meanOnScale(seconds, PlotScale::Log));
  }
  return mean;
}

}  // namespace

std::string ReportMetric::label() const {
  return info != nullptr ? std::string(info->label) : key.substr(layer.empty() ? 0 : layer.size() + 1);
}

std::string ReportMetric::unit() const {
  if (hasUnit(*this, MetricUnit::Fraction)) return "%";
  return hasUnit(*this, MetricUnit::Decibel) ? "dB" : "";
}

std::string ReportMetric::labelWithUnit() const { return unit().empty() ? label() : label() + ", " + unit(); }

std::string ReportMetric::axisTitle() const {
  std::string title = label();
  if (betterOf(*this) == BetterValue::NearZero) title = "|" + title + "|";
  if (betterOf(*this) == BetterValue::Higher) {
    if (scale() == PlotScale::Log)
      title = "1 − " + title;
    else
      return title + ", " + unit() + " (more is better, and lower here)";
  }
  return unit().empty() ? title : title + ", " + unit();
}

PlotScale ReportMetric::scale() const {
  return hasUnit(*this, MetricUnit::Decibel) ? PlotScale::Linear : PlotScale::Log;
}

Spread ReportMetric::shown(const Spread& spread) const {
  const double factor = hasUnit(*this, MetricUnit::Fraction) ? 100.0 : 1.0;
  return {factor * spread.mean, factor * spread.standardDeviation, factor * spread.least,
          factor * spread.most};
}

double ReportMetric::plotted(double value) const {
  if (hasUnit(*this, MetricUnit::Fraction)) value *= 100.0;
  if (betterOf(*this) == BetterValue::NearZero) return std::abs(value);
  return betterOf(*this) == BetterValue::Higher && scale() == PlotScale::Log ? 1.0 - value : value;
}

double ReportMetric::loss(double value) const {
  // The root of the mean squared difference of which the decibels are.
  if (betterOf(*this) == BetterValue::Higher && scale() == PlotScale::Linear)
    return std::pow(10.0, -value / 20.0);
  return plotted(value);
}

std::vector<ReportMetric> reportMetrics(const Sweep& sweep, const std::string& first) {
  std::map<std::string, std::size_t> pointsWith;
  for (const SweepPoint& point : sweep.points) {
    std::set<std::string> keys;
    for (const SweepRun& run : point.runs) {
      for (const auto& [key, value] : run.metrics) keys.insert(key);
    }
    for (const std::string& key : keys) pointsWith[key] += metricSpread(point, key) ? 1 : 0;
  }
  std::vector<ReportMetric> chosen;
  for (const auto& [key, count] : pointsWith) {
    if (count == sweep.points.size() || (key == first && count > 0)) chosen.push_back(reportMetric(key));
  }
  std::ranges::sort(chosen, {}, [&](const ReportMetric& metric) {
    return std::tuple_cat(std::tuple(metric.key != first), displayOrder(metric));
  });
  return chosen;
}

std::vector<PlottedPoint> plottedPoints(const Sweep& sweep, const ReportMetric& metric) {
  std::vector<PlottedPoint> points;
  for (std::size_t p = 0; p < sweep.points.size(); ++p) {
    const std::optional<Spread> spread = metricSpread(sweep.points[p], metric.key);
    if (!spread) continue;
    PlottedPoint plotted{p,   cpuSpread(sweep.points[p]), *spread, metric.plotted(spread->mean), 0.0,
                         0.0, metric.loss(spread->mean)};
    const auto [low, high] = std::minmax({metric.plotted(spread->least), metric.plotted(spread->most)});
    // Signed values on both sides of 0 come as near to it as can be.
    const bool hasZero =
        betterOf(metric) == BetterValue::NearZero && spread->least < 0.0 && spread->most > 0.0;
    plotted.leastError = hasZero ? 0.0 : low;
    plotted.mostError = high;
    points.push_back(plotted);
  }
  return points;
}

std::vector<std::size_t> reportFront(const Sweep& sweep, const std::vector<PlottedPoint>& points) {
  Sweep losses;
  losses.points.resize(sweep.points.size());
  for (const PlottedPoint& point : points) {
    SweepRun run;
    run.cpuSeconds = point.cpu.mean;
    run.metrics["loss"] = point.loss;
    losses.points[point.point].runs.push_back(run);
  }
  // Points without the metric have no run here; the front is of those that have it.
  std::vector<std::size_t> kept;
  std::vector<SweepPoint> measured;
  for (std::size_t p = 0; p < losses.points.size(); ++p) {
    if (losses.points[p].runs.empty()) continue;
    kept.push_back(p);
    measured.push_back(std::move(losses.points[p]));
  }
  losses.points = std::move(measured);
  std::vector<std::size_t> front = paretoFront(losses, "loss");
  for (std::size_t& p : front) p = kept[p];
  return front;
}

bool isRival(const SweepPoint& point) { return point.method != kVectors; }

RivalTimes::RivalTimes(const Sweep& sweep, const std::vector<PlottedPoint>& points) {
  const PlottedPoint* best = nullptr;
  for (const PlottedPoint& point : points) {
    if (!isRival(sweep.points[point.point])) continue;
    // Of equal errors the slower: it has the wider range.
    if (best == nullptr || std::tuple(point.loss, -point.cpu.mean) < std::tuple(best->loss, -best->cpu.mean))
      best = &point;
  }
  if (best == nullptr) return;
  method_ = sweep.points[best->point].method;
  std::vector<Sample> samples;
  for (const PlottedPoint& point : points) {
    const bool hasLogarithms = point.loss > 0.0 && point.cpu.mean > 0.0 && std::isfinite(point.loss);
    if (sweep.points[point.point].method == method_ && hasLogarithms)
      samples.push_back({point.cpu.mean, point.loss});
  }
  std::ranges::sort(samples, {}, [](const Sample& s) { return std::pair(s.seconds, s.loss); });
  for (const Sample& sample : samples) {
    if (front_.empty() || sample.loss < front_.back().loss) front_.push_back(sample);
  }
}

std::optional<double> RivalTimes::secondsFor(double loss) const {
  if (front_.empty() || !(loss <= front_.front().loss) || loss < front_.back().loss) return std::nullopt;
  const auto after = std::ranges::find_if(front_, [&](const Sample& sample) { return sample.loss <= loss; });
  if (after->loss == loss) return after->seconds;
  const Sample &a = *(after - 1), &b = *after;
  const double part = std::log(a.loss / loss) / std::log(a.loss / b.loss);
  return a.seconds * std::pow(b.seconds / a.seconds, part);
}

KnobEffect knobEffect(const Sweep& sweep, const VariedParameter& knob, const ReportMetric& metric,
                      const std::vector<PlottedPoint>& points) {
  // Points by all but this parameter, and then by its value.
  std::map<std::pair<std::string, SweepSettings>, std::map<std::string, std::size_t>> groups;
  const auto categoryOf = [&](const PlottedPoint& point) {
    return settingOf(sweep.points[point.point].settings, knob.key);
  };
  for (std::size_t p = 0; p < points.size(); ++p) {
    const SweepPoint& point = sweep.points[points[p].point];
    SweepSettings others = point.settings;
    std::erase_if(others, [&](const auto& setting) { return setting.first == knob.key; });
    std::ranges::sort(others);
    groups[{point.method, others}].try_emplace(categoryOf(points[p]), p);
  }
  std::erase_if(groups, [](const auto& group) { return group.second.size() < 2; });

  // Methods that have the parameter; what points of others are is not its effect.
  std::set<std::string> methods;
  for (const PlottedPoint& point : points) {
    if (!categoryOf(point).empty()) methods.insert(sweep.points[point.point].method);
  }
  KnobEffect effect;
  std::vector<std::string> values;  // by text, "" for the default
  const bool hasDefault =
      std::ranges::any_of(groups, [](const auto& group) { return group.second.contains(""); });
  if (hasDefault) values.emplace_back();
  for (const std::string& value : knob.values) {
    if (std::ranges::find(values, value) == values.end()) values.push_back(value);
  }
  for (const std::string& value : values) effect.categories.push_back(value.empty() ? kDefault : value);

  for (const std::string& method : methods) {
    std::vector<std::vector<std::size_t>> complete(values.size()), all(values.size());
    std::size_t combinations = 0;
    for (const auto& group : groups) {
      if (group.first.first != method) continue;
      const std::map<std::string, std::size_t>& byValue = group.second;
      KnobLine line{method, {}};
      for (const std::string& value : values) {
        const auto found = byValue.find(value);
        line.points.emplace_back();
        if (found != byValue.end()) line.points.back() = found->second;
      }
      // Means over different sets of combinations would show what these differ in.
      if (std::ranges::all_of(values, [&](const std::string& value) { return byValue.contains(value); })) {
        ++combinations;
        for (std::size_t c = 0; c < values.size(); ++c) complete[c].push_back(byValue.at(values[c]));
      }
      effect.lines.push_back(std::move(line));
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto category = std::ranges::find(values, categoryOf(points[p]));
      if (sweep.points[points[p].point].method != method || category == values.end()) continue;
      all[static_cast<std::size_t>(category - values.begin())].push_back(p);
    }
    const bool isOfAll = combinations == 0;
    effect.means.push_back(
        knobMean(effect, method, metric.scale(), points, isOfAll ? all : complete, combinations, isOfAll));
  }
  return effect;
}

}  // namespace lightvane
