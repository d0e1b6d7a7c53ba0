#include "core/measure/correction_study.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lightvane {
namespace {

constexpr double kFarthestBeyond = 2.0;

const SweepPoint* pointOf(const StudiedScene& scene, const StudyPoint& point) {
  return scene.pointNamed(point.label());
}

std::optional<double> meanErrorOf(const SweepPoint* point, const std::string& metric) {
  if (point == nullptr) return std::nullopt;
  const std::optional<Spread> spread = metricSpread(*point, metric);
  return spread ? std::optional(spread->mean) : std::nullopt;
}

/// Of two errors or times; nothing where it would not be a number above 0.
std::optional<double> quotient(std::optional<double> above, std::optional<double> below) {
  if (!above || !below) return std::nullopt;
  const double value = *above / *below;
  return *below > 0.0 && std::isfinite(value) && value > 0.0 ? std::optional(value) : std::nullopt;
}

std::optional<double> quotientOfTimes(const SweepPoint* above, const SweepPoint* below) {
  if (above == nullptr || below == nullptr) return std::nullopt;
  return quotient(cpuSpread(*above).mean, cpuSpread(*below).mean);
}

/// The error of a role at the time that the refined rules take, both with the first seed, which all points
/// have in common.
std::optional<ErrorAtTime> errorAtTimeOfAll(const StudiedScene& scene, StudyPoint point,
                                            const std::string& metric) {
  const SweepPoint* all = pointOf(scene, {});
  if (all == nullptr) return std::nullopt;
  std::vector<TimedError> measured;
  for (const StudyEffort effort : {StudyEffort::Coarse, StudyEffort::Usual, StudyEffort::Fine}) {
    point.effort = effort;
    const SweepPoint* done = pointOf(scene, point);
    if (done == nullptr) return std::nullopt;
    const SweepRun& run = done->runs.front();
    const auto error = run.metrics.find(metric);
    if (error == run.metrics.end()) return std::nullopt;
    measured.push_back({run.cpuSeconds, error->second});
  }
  return errorAtTime(measured, all->runs.front().cpuSeconds);
}

struct StudyFactor {
  double value = 1.0;
  bool isBeyond = false;
};

/// How a correction's point compares with the one that it differs from in that correction: without it with
/// all, alone with none.
struct StudyComparison {
  const StudiedScene& scene;
  StudyPoint point, base;

  std::optional<StudyFactor> ofError(const std::string& metric) const {
    return factor(
        quotient(meanErrorOf(pointOf(scene, point), metric), meanErrorOf(pointOf(scene, base), metric)));
  }
  std::optional<StudyFactor> ofTime() const {
    return factor(quotientOfTimes(pointOf(scene, point), pointOf(scene, base)));
  }
  std::optional<StudyFactor> ofErrorAtTime(const std::string& metric) const {
    const auto its = errorAtTimeOfAll(scene, point, metric);
    const auto other = errorAtTimeOfAll(scene, base, metric);
    if (!its || !other) return std::nullopt;
    std::optional<StudyFactor> result = factor(quotient(its->error, other->error));
    if (result) result->isBeyond = its->isBeyond || other->isBeyond;
    return result;
  }

 private:
  static std::optional<StudyFactor> factor(std::optional<double> value) {
    return value ? std::optional(StudyFactor{*value, false}) : std::nullopt;
  }
};

std::string cellOf(const std::optional<StudyFactor>& factor) {
  return factor ? (factor->isBeyond ? "~" : "") + studyNumber(factor->value) : kNoStudyValue;
}

/// "1.3 (0.98 to 2.1)": the median of the scenes, the least and the most; of two in the middle their
/// geometric mean, as these are ratios.
std::string cellOf(const std::vector<std::optional<StudyFactor>>& factors) {
  std::vector<double> values;
  bool isBeyond = false;
  for (const std::optional<StudyFactor>& factor : factors) {
    if (!factor) continue;
    values.push_back(factor->value);
    isBeyond = isBeyond || factor->isBeyond;
  }
  if (values.empty()) return kNoStudyValue;
  std::ranges::sort(values);
  const double median = std::sqrt(values[(values.size() - 1) / 2] * values[values.size() / 2]);
  std::string text = (isBeyond ? "~" : "") + studyNumber(median);
  if (values.size() > 1)
    text += fmt::format(" ({} to {})", studyNumber(values.front()), studyNumber(values.back()));
  return text;
}

constexpr double kPercent = 100.0;

StudyTable scenesTable(std::span<const StudiedScene> scenes) {
  StudyTable table{
      "The scenes, all corrections made and none",
      "Errors are means over the seeds ± their standard deviation among these: the root of the mean squared "
      "relative difference, in per cent, and relMSE. What the reference's own noise adds is taken off, and "
      "that noise is stated. CPU time is in seconds.",
      {{"scene", "pixels", "corrections", "CPU, s", "picture, %", "relMSE", "indirect, %", "relMSE",
        "noise of the reference: picture, %", "indirect, %"}}};
  for (const StudiedScene& scene : scenes) {
    const auto noise = scene.sweep.layerNoise.find("indirect");
    for (const StudyRole role : {StudyRole::All, StudyRole::None}) {
      const SweepPoint* point = pointOf(scene, {role, nullptr, StudyEffort::Usual});
      if (point == nullptr) continue;
      table.rows.push_back(
          {scene.name, fmt::format("{}x{}", scene.sweep.width, scene.sweep.height),
           role == StudyRole::All ? "all" : "none", studyTimeCell(point),
           studySpreadCell(point, "beauty.relative", kPercent), studySpreadCell(point, "beauty.relmse", 1.0),
           studySpreadCell(point, "indirect.relative", kPercent),
           studySpreadCell(point, "indirect.relmse", 1.0),
           scene.sweep.referenceNoise ? fmt::format("{:.2g}", kPercent * *scene.sweep.referenceNoise)
                                      : kNoStudyValue,
           noise != scene.sweep.layerNoise.end() ? fmt::format("{:.2g}", kPercent * noise->second)
                                                 : kNoStudyValue});
    }
  }
  return table;
}

/// Whether any scene has points of the correction.
bool isMeasured(std::span<const StudiedScene> scenes, StudyPoint point) {
  return std::ranges::any_of(scenes,
                             [&](const StudiedScene& scene) { return pointOf(scene, point) != nullptr; });
}

StudyTable worthTable(std::span<const StudiedScene> scenes, StudyRole role) {
  const bool isTakenBack = role == StudyRole::Without;
  StudyTable table;
  table.title = isTakenBack ? "Each correction taken back" : "Each correction made alone";
  table.text =
      isTakenBack
          ? "As a multiple of what the picture with all corrections has: above 1, the correction is worth "
            "having. The median of the scenes, and from the least to the most. The layer is direct light for "
            "corrections of DLVs, in the scenes that keep these, and indirect light for the others. At equal "
            "time: read at the CPU time of the picture with all corrections off the line through three "
            "settings of cells and radius, in logarithms, of the first seed; ~ where some scene's lies "
            "beyond these."
          : "As a multiple of what the picture with none has: below 1, the correction is a gain by itself. "
            "Likewise.";
  table.rows = {{"correction", "as printed", "refined", "CPU", "layer: relative", "layer: relMSE",
                 "picture: relative", "picture: relMSE", "at equal time: layer", "at equal time: picture"}};
  for (const Correction& correction : corrections()) {
    const StudyPoint point{role, &correction, StudyEffort::Usual};
    if (!isMeasured(scenes, point)) continue;
    const StudyPoint base{isTakenBack ? StudyRole::All : StudyRole::None, nullptr, StudyEffort::Usual};
    const std::string layer(correction.layer());
    const auto overScenes = [&](auto factorOf) {
      std::vector<std::optional<StudyFactor>> factors;
      for (const StudiedScene& scene : scenes)
        factors.push_back(factorOf(StudyComparison{scene, point, base}));
      return cellOf(factors);
    };
    const auto ofError = [&](const std::string& metric) {
      return overScenes([&](const StudyComparison& comparison) { return comparison.ofError(metric); });
    };
    const auto atTime = [&](const std::string& metric) {
      return overScenes([&](const StudyComparison& comparison) { return comparison.ofErrorAtTime(metric); });
    };
    table.rows.push_back({fmt::format("`{}`", correction.key), correction.printed, correction.refined,
                          overScenes([](const StudyComparison& comparison) { return comparison.ofTime(); }),
                          ofError(layer + ".relative"), ofError(layer + ".relmse"),
                          ofError("beauty.relative"), ofError("beauty.relmse"), atTime(layer + ".relative"),
                          atTime("beauty.relative")});
  }
  return table;
}

StudyTable bySceneTable(std::span<const StudiedScene> scenes, StudyRole role) {
  const bool isTakenBack = role == StudyRole::Without;
  StudyTable table;
  table.title = isTakenBack ? "Taken back, scene by scene" : "Made alone, scene by scene";
  table.text = fmt::format(
      "The relative error of the layer at equal time, as a multiple of that with {}. {} where the scene has "
      "no error to compare, or where no time within a factor of 2 was measured.",
      isTakenBack ? "all" : "none", kNoStudyValue);
  table.rows = {{"correction"}};
  for (const StudiedScene& scene : scenes) table.rows.front().push_back(scene.name);
  for (const Correction& correction : corrections()) {
    const StudyPoint point{role, &correction, StudyEffort::Usual};
    if (!isMeasured(scenes, point)) continue;
    const StudyPoint base{isTakenBack ? StudyRole::All : StudyRole::None, nullptr, StudyEffort::Usual};
    std::vector<std::string> row = {fmt::format("`{}`", correction.key)};
    for (const StudiedScene& scene : scenes)
      row.push_back(cellOf(
          StudyComparison{scene, point, base}.ofErrorAtTime(std::string(correction.layer()) + ".relative")));
    table.rows.push_back(std::move(row));
  }
  return table;
}

StudyTable keyTable() {
  StudyTable table{"The corrections",
                   "What each parameter is as printed and by the refined rules, and what it corrects.",
                   {{"correction", "as printed", "refined", "paper", "what is wrong as printed"}}};
  for (const Correction& correction : corrections()) {
    table.rows.push_back({fmt::format("`{}`", correction.key), correction.printed, correction.refined,
                          correction.paper.empty() ? kNoStudyValue : correction.paper, correction.corrects});
  }
  return table;
}

}  // namespace

std::optional<ErrorAtTime> errorAtTime(std::span<const TimedError> measured, double cpuSeconds) {
  if (measured.size() < 2 || !(cpuSeconds > 0.0)) return std::nullopt;
  const auto count = static_cast<double>(measured.size());
  double meanTime = 0.0, meanError = 0.0;
  double least = measured.front().cpuSeconds, most = least;
  for (const TimedError& one : measured) {
    if (!(one.cpuSeconds > 0.0) || !(one.error > 0.0) || !std::isfinite(one.error)) return std::nullopt;
    meanTime += std::log(one.cpuSeconds) / count;
    meanError += std::log(one.error) / count;
    least = std::min(least, one.cpuSeconds);
    most = std::max(most, one.cpuSeconds);
  }
  if (!(least < most) || cpuSeconds < least / kFarthestBeyond || cpuSeconds > most * kFarthestBeyond)
    return std::nullopt;
  double both = 0.0, squares = 0.0;
  for (const TimedError& one : measured) {
    const double time = std::log(one.cpuSeconds) - meanTime;
    both += time * (std::log(one.error) - meanError);
    squares += time * time;
  }
  const double error = std::exp(meanError + both / squares * (std::log(cpuSeconds) - meanTime));
  return ErrorAtTime{error, cpuSeconds < least || cpuSeconds > most};
}

std::vector<StudyTable> correctionTables(std::span<const StudiedScene> scenes) {
  return {keyTable(),
          scenesTable(scenes),
          worthTable(scenes, StudyRole::Without),
          worthTable(scenes, StudyRole::Alone),
          bySceneTable(scenes, StudyRole::Without),
          bySceneTable(scenes, StudyRole::Alone)};
}

}  // namespace lightvane
