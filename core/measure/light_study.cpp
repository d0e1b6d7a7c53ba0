#include "core/measure/light_study.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include <fmt/format.h>

#include "core/base/math.h"
#include "core/render/vectors_of_lights.h"
#include "core/scene/light_facts.h"

namespace lightvane {
namespace {

// Powers of 4, and of 2 where auto's answer may change.
constexpr int kStudiedSamples[] = {1, 4, 16, 32, 64, 128, 256, 512};

// CPU times of the same picture agree to some 5 %, and these are differences of two times.
constexpr double kLeastSureFactor = 1.1;

constexpr double kInPercent = 100.0;

double metricOf(const SweepRun& run, std::string_view metric) {
  const auto found = run.metrics.find(std::string(metric));
  return found == run.metrics.end() ? std::numeric_limits<double>::quiet_NaN() : found->second;
}

double squaredErrorOf(const SweepRun& run, std::string_view metric) {
  const double value = metricOf(run, metric);
  return metric.ends_with(".relmse") ? value : square(value);
}

const SweepRun* runOfSeed(const SweepPoint& point, std::uint64_t seed) {
  const auto found = std::ranges::find(point.runs, seed, &SweepRun::seed);
  return found == point.runs.end() ? nullptr : &*found;
}

/// Of both modes with one seed.
struct ModeRuns {
  const SweepRun& never;
  const SweepRun& always;
};

DlvMode modeOf(bool keepsVectors) { return keepsVectors ? DlvMode::Always : DlvMode::Never; }

/// Nothing where that is no number.
std::optional<double> costFactor(const ModeRuns& runs, double darkSeconds, bool hasNoise,
                                 std::string_view metric) {
  const double seconds[] = {runs.never.cpuSeconds - darkSeconds, runs.always.cpuSeconds - darkSeconds};
  const double errors[] = {squaredErrorOf(runs.never, metric), squaredErrorOf(runs.always, metric)};
  if (!(seconds[0] > 0.0) || !(seconds[1] > 0.0)) return std::nullopt;
  const bool hasExact = errors[0] == 0.0 || errors[1] == 0.0;
  if (hasExact && hasNoise) return std::nullopt;
  const double times = seconds[0] / seconds[1];
  const double factor = errors[0] == errors[1] ? times : times * errors[0] / errors[1];
  return std::isnan(factor) ? std::nullopt : std::optional(factor);
}

ModeComparison meanFactorOf(const std::vector<double>& factors) {
  const auto [least, most] = std::ranges::minmax(factors);
  return {meanRatio(factors).mean, least, most};
}

/// What both measures are sure of, the less of it; 1 where that is nothing.
double sureFactor(const ModeComparison& a, const ModeComparison& b) {
  if (!a.isSure() || !b.isSure() || (a.factor > 1.0) != (b.factor > 1.0)) return 1.0;
  return a.factor > 1.0 ? std::min(a.factor, b.factor) : std::max(a.factor, b.factor);
}

ModeVerdict verdictOf(const ModeJudgement& judged) {
  if (!judged.relative || !judged.relmse) return ModeVerdict::NotMeasured;
  if (judged.factor == 1.0) return ModeVerdict::NoDifference;
  return (judged.factor > 1.0) == judged.autoKeepsVectors ? ModeVerdict::Right : ModeVerdict::Wrong;
}

std::string factorText(double factor) { return std::isfinite(factor) ? studyNumber(factor) : "∞"; }

std::string verdictText(const ModeJudgement& judged) {
  switch (judged.verdict) {
    case ModeVerdict::Right:
      return "right";
    case ModeVerdict::Wrong:
      return "wrong by " + factorText(judged.lossOf(judged.autoKeepsVectors));
    case ModeVerdict::NoDifference:
      return "no difference";
    case ModeVerdict::NotMeasured:
      break;
  }
  return kNoStudyValue;
}

std::string factorCell(const std::optional<ModeComparison>& compared) {
  if (!compared) return kNoStudyValue;
  const std::string factor = factorText(compared->factor);
  return compared->least == compared->most
             ? factor
             : fmt::format("{} ({} to {})", factor, factorText(compared->least), factorText(compared->most));
}

const StudiedScene* darkOf(std::span<const StudiedScene> scenes, const StudiedScene& light) {
  const auto found = std::ranges::find_if(scenes, [&](const StudiedScene& other) {
    return other.light && other.light->isNone() && other.name == light.name;
  });
  return found == scenes.end() ? nullptr : &*found;
}

/// Calls visit(light, judgement) for all there is.
template <class Visit>
void forEachJudged(std::span<const StudiedScene> scenes, const Visit& visit) {
  for (const StudiedScene& light : scenes) {
    if (!light.light || light.light->isNone()) continue;
    const StudiedScene* dark = darkOf(scenes, light);
    if (dark == nullptr) continue;
    for (const ModeJudgement& judged : judgeModes(light, *dark)) visit(light, judged);
  }
}

/// How often auto is right.
struct AutoScore {
  int right = 0, wrong = 0, open = 0;
  double worst = 1.0;

  void add(const ModeJudgement& judged) {
    right += judged.verdict == ModeVerdict::Right ? 1 : 0;
    wrong += judged.verdict == ModeVerdict::Wrong ? 1 : 0;
    open += judged.verdict == ModeVerdict::NoDifference ? 1 : 0;
    worst = std::max(worst, judged.lossOf(judged.autoKeepsVectors));
  }
};

std::string summaryOf(const AutoScore& score) {
  return fmt::format(
      "`auto` is right in {} of {} cases that can be told apart, of {} in all; at worst, squared error times "
      "time is {} times as large as with the other mode.",
      score.right, score.right + score.wrong, score.right + score.wrong + score.open,
      factorText(score.worst));
}

StudyTable lightsTable(std::span<const StudiedScene> scenes) {
  StudyTable table{"Whether DLVs pay, light by light", {}, {}};
  table.rows = {{"scene", "light", "kind", "shadow rays", "CPU, s: no light", "never", "always",
                 "error, %: never", "always", "noise of the reference", "never over always: relative",
                 "relMSE", "auto", "verdict"}};
  AutoScore score;
  forEachJudged(scenes, [&](const StudiedScene& light, const ModeJudgement& judged) {
    score.add(judged);
    const SweepPoint* never = light.pointNamed(LightStudyPoint{DlvMode::Never, judged.samples}.label());
    const SweepPoint* always = light.pointNamed(LightStudyPoint{DlvMode::Always, judged.samples}.label());
    const SweepPoint* dark = darkOf(scenes, light)->pointNamed(lightStudyDarkPoint().label());
    const auto noise = light.sweep.layerNoise.find("direct");
    table.rows.push_back({light.name, light.light->name, light.light->kind, std::to_string(judged.samples),
                          studyTimeCell(dark), studyTimeCell(never), studyTimeCell(always),
                          studySpreadCell(never, "direct.relative", kInPercent),
                          studySpreadCell(always, "direct.relative", kInPercent),
                          noise == light.sweep.layerNoise.end()
                              ? kNoStudyValue
                              : fmt::format("{:.2g}", kInPercent * noise->second),
                          factorCell(judged.relative), factorCell(judged.relmse),
                          choiceName(kDlvModeNames, modeOf(judged.autoKeepsVectors)), verdictText(judged)});
  });
  table.text = fmt::format(
      "Each light with all others out, sampled at every point (`dlv.mode=never`) and interpolated "
      "(`always`); "
      "shadow rays are those of a point. Errors are of direct light, means over the seeds ± their standard "
      "deviation. Never over always: squared error times CPU time, less that of the same picture without "
      "light, by two measures of error: the geometric mean over the seeds, and from the least to the most; "
      "above 1, vectors pay. A verdict takes every seed by both measures, each by more than {:.0f} %; its "
      "factor is the one of the two that is nearer to 1. {}",
      kInPercent * (kLeastSureFactor - 1.0), summaryOf(score));
  return table;
}

/// What all lights say at one number of shadow rays.
struct RaysScore {
  int vectors = 0, samples = 0, open = 0;  ///< lights that each is better for
  bool autoKeepsVectors = false;
  std::map<std::string, std::vector<double>> factors;  ///< by scene: of its lights, what is sure

  void add(const std::string& scene, const ModeJudgement& judged) {
    ++(judged.factor > 1.0 ? vectors : judged.factor < 1.0 ? samples : open);
    autoKeepsVectors = judged.autoKeepsVectors;
    // Where one of them is exact there is no saying by how much it is better.
    if (judged.factor > 0.0 && std::isfinite(judged.factor)) factors[scene].push_back(judged.factor);
  }
  std::string meanOverScenes() const {
    std::vector<double> means;
    for (const auto& [scene, its] : factors) means.push_back(meanRatio(its).mean);
    return means.empty() ? kNoStudyValue : studyRatioCell(meanRatio(means));
  }
};

StudyTable raysTable(std::span<const StudiedScene> scenes) {
  StudyTable table{
      "Whether DLVs pay, by shadow rays",
      "Over all lights with so many shadow rays a point: for how many of them either is better, and what "
      "never costs over always: the geometric mean over the scenes, each of which counts as one however many "
      "lights it has, with 1 for what cannot be told apart; in brackets what holds it with 95 %. Above 1, "
      "vectors pay.",
      {{"shadow rays", "vectors better", "samples better", "no difference", "never over always", "auto"}}};
  std::map<int, RaysScore> scores;
  forEachJudged(scenes, [&](const StudiedScene& light, const ModeJudgement& judged) {
    if (judged.verdict != ModeVerdict::NotMeasured) scores[judged.samples].add(light.name, judged);
  });
  for (const auto& [rays, score] : scores) {
    table.rows.push_back({std::to_string(rays), std::to_string(score.vectors), std::to_string(score.samples),
                          std::to_string(score.open), score.meanOverScenes(),
                          choiceName(kDlvModeNames, modeOf(score.autoKeepsVectors))});
  }
  return table;
}

}  // namespace

std::vector<std::uint32_t> strongestLights(const Scene& scene, std::size_t most) {
  std::vector<std::uint32_t> lights(scene.lights.size());
  std::iota(lights.begin(), lights.end(), 0U);
  const auto power = [&](std::uint32_t light) {
    return lightPower(scene.lights[light], 0.5f * scene.diagonal);
  };
  std::ranges::stable_sort(lights, std::greater<>(), power);
  lights.resize(std::min(lights.size(), most));
  std::ranges::sort(lights);
  return lights;
}

std::string LightStudyPoint::label() const {
  return fmt::format("{}, {} sample{}", choiceName(kDlvModeNames, mode), samples, samples == 1 ? "" : "s");
}

SweepSettings LightStudyPoint::settings() const {
  // One ray a gather, and vectors that reach as far as they may.
  return {{"dlv.mode", std::string(choiceName(kDlvModeNames, mode))},
          {"light.samples", std::to_string(samples)},
          {"light.mirrored", "false"},
          {"ilv.rows", "1"},
          {"ilv.columns", "1"},
          {"ilv.n_min", "1"},
          {"ilv.radius_scale", "100"},
          {"ilv.radius_max", "0"},
          {"ilv.radius_min_hit", "0"},
          {"ilv.in_front", "false"},
          {"ilv.visibility", "false"},
          {"ilv.clearance", "0"}};
}

std::vector<int> lightStudySamples(const Light& light, int own) {
  std::set<int> samples;
  for (const int asked : kStudiedSamples) samples.insert(shadowRaysOf(light, asked));
  samples.insert(shadowRaysOf(light, own));
  return {samples.begin(), samples.end()};
}

std::vector<LightStudyPoint> lightStudyPoints(const Light& light, int own) {
  std::vector<LightStudyPoint> points;
  for (const int samples : lightStudySamples(light, own)) {
    points.push_back({DlvMode::Never, samples});
    points.push_back({DlvMode::Always, samples});
  }
  return points;
}

LightStudyPoint lightStudyDarkPoint() { return {DlvMode::Never, 1}; }

bool ModeComparison::isSure() const { return least > kLeastSureFactor || most < 1.0 / kLeastSureFactor; }

std::optional<ModeComparison> compareModes(const StudiedScene& light, const SweepPoint& dark, int samples,
                                           std::string_view metric) {
  const SweepPoint* never = light.pointNamed(LightStudyPoint{DlvMode::Never, samples}.label());
  const SweepPoint* always = light.pointNamed(LightStudyPoint{DlvMode::Always, samples}.label());
  if (never == nullptr || always == nullptr || dark.runs.empty()) return std::nullopt;
  const double darkSeconds = cpuSpread(dark).mean;
  const auto noise = light.sweep.layerNoise.find("direct");
  const bool hasNoise = noise != light.sweep.layerNoise.end() && noise->second > 0.0;
  std::vector<double> factors;
  for (const SweepRun& run : never->runs) {
    const SweepRun* other = runOfSeed(*always, run.seed);
    if (other == nullptr) continue;
    const std::optional<double> factor = costFactor({run, *other}, darkSeconds, hasNoise, metric);
    if (!factor) return std::nullopt;
    factors.push_back(*factor);
  }
  if (factors.empty()) return std::nullopt;
  const ModeComparison compared = meanFactorOf(factors);
  return std::isnan(compared.factor) ? std::nullopt : std::optional(compared);
}

double ModeJudgement::lossOf(bool keepsVectors) const {
  return std::max(1.0, keepsVectors ? 1.0 / factor : factor);
}

std::vector<ModeJudgement> judgeModes(const StudiedScene& light, const StudiedScene& dark) {
  std::vector<ModeJudgement> all;
  const SweepPoint* base = dark.pointNamed(lightStudyDarkPoint().label());
  if (base == nullptr || !light.light) return all;
  for (const SweepPoint& point : light.sweep.points) {
    const auto samples =
        std::ranges::find(point.settings, "light.samples", &SweepSettings::value_type::first);
    if (samples == point.settings.end()) continue;
    ModeJudgement judged;
    judged.samples = std::stoi(samples->second);
    if (point.label != LightStudyPoint{DlvMode::Never, judged.samples}.label()) continue;
    judged.autoKeepsVectors = autoKeepsVectors(judged.samples);
    judged.relative = compareModes(light, *base, judged.samples, "direct.relative");
    judged.relmse = compareModes(light, *base, judged.samples, "direct.relmse");
    if (judged.relative && judged.relmse) judged.factor = sureFactor(*judged.relative, *judged.relmse);
    judged.verdict = verdictOf(judged);
    all.push_back(judged);
  }
  return all;
}

std::vector<StudyTable> lightTables(std::span<const StudiedScene> scenes) {
  return {lightsTable(scenes), raysTable(scenes)};
}

}  // namespace lightvane
