#include "core/measure/preset_study.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "core/base/math.h"

namespace lightvane {
namespace {

/// What presets are chosen by: what their knobs govern. How direct light is sampled is another matter.
constexpr const char* kChosenBy = "indirect.relative";
constexpr const char* kWholePicture = "beauty.relative";

/// Whether a candidate may be worth a look. A last stride of 1 asks for vectors at every pixel, which does
/// not go with what is fast; one of 4 is for the fewest cells. So the list is half as long as all
/// combinations.
bool isWorthALook(const PresetCandidate& candidate) {
  if (candidate.lastStride == 4) return candidate.rows == 8;
  if (candidate.lastStride == 2) return true;
  return candidate.rows >= 12 && candidate.nMin == 4 && candidate.radiusScale <= 0.4;
}

/// All runs of a study that can be compared: seeds that every candidate has in every scene, and scenes whose
/// errors are all above 0.
struct StudiedCandidates {
  std::vector<PresetCandidate> candidates;
  std::size_t balanced = 0;
  std::vector<const StudiedScene*> scenes, leftOut;
  std::size_t seeds = 0;

  const SweepRun& run(std::size_t candidate, const StudiedScene& scene, std::size_t seed) const {
    return scene.pointNamed(candidates[candidate].label())->runs[seed];
  }
  /// Over balanced with the same seed.
  double time(std::size_t candidate, const StudiedScene& scene, std::size_t seed) const {
    return run(candidate, scene, seed).cpuSeconds / run(balanced, scene, seed).cpuSeconds;
  }
  double error(std::size_t candidate, const StudiedScene& scene, std::size_t seed, const char* metric) const {
    return run(candidate, scene, seed).metrics.at(metric) / run(balanced, scene, seed).metrics.at(metric);
  }
};

std::size_t placeOf(const std::vector<PresetCandidate>& candidates, const PresetCandidate& wanted) {
  return static_cast<std::size_t>(std::ranges::find(candidates, wanted) - candidates.begin());
}

bool areErrorsSound(const StudiedScene& scene, const std::vector<PresetCandidate>& candidates,
                    std::size_t seeds) {
  for (const PresetCandidate& candidate : candidates) {
    const SweepPoint* point = scene.pointNamed(candidate.label());
    for (std::size_t seed = 0; seed < seeds; ++seed) {
      const SweepRun& run = point->runs[seed];
      for (const char* metric : {kChosenBy, kWholePicture}) {
        const auto found = run.metrics.find(metric);
        if (found == run.metrics.end() || !(found->second > 0.0) || !std::isfinite(found->second))
          return false;
      }
      if (!(run.cpuSeconds > 0.0)) return false;
    }
  }
  return true;
}

StudiedCandidates comparable(std::span<const StudiedScene> scenes) {
  StudiedCandidates all;
  all.candidates = presetCandidates();
  all.balanced = placeOf(all.candidates, shippedCandidate(Preset::Balanced));
  if (scenes.empty()) return all;
  all.seeds = std::numeric_limits<std::size_t>::max();
  for (const StudiedScene& scene : scenes) {
    for (const PresetCandidate& candidate : all.candidates) {
      const SweepPoint* point = scene.pointNamed(candidate.label());
      all.seeds = std::min(all.seeds, point == nullptr ? 0 : point->runs.size());
    }
  }
  if (all.seeds == 0) return all;
  for (const StudiedScene& scene : scenes)
    (areErrorsSound(scene, all.candidates, all.seeds) ? all.scenes : all.leftOut).push_back(&scene);
  if (all.scenes.empty()) all.seeds = 0;
  return all;
}

CandidateWorth worthOf(const StudiedCandidates& all, std::size_t candidate, const char* metric) {
  CandidateWorth worth;
  for (std::size_t seed = 0; seed < all.seeds; ++seed) {
    std::vector<double> times, errors;
    for (const StudiedScene* scene : all.scenes) {
      times.push_back(all.time(candidate, *scene, seed));
      errors.push_back(all.error(candidate, *scene, seed, metric));
    }
    worth.times.push_back(meanRatio(times).mean);
    worth.errors.push_back(meanRatio(errors).mean);
  }
  return worth;
}

/// The largest and the least error of a candidate in any scene, over seeds.
std::pair<double, double> rangeOverScenes(const StudiedCandidates& all, std::size_t candidate) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const StudiedScene* scene : all.scenes) {
    std::vector<double> errors;
    for (std::size_t seed = 0; seed < all.seeds; ++seed)
      errors.push_back(all.error(candidate, *scene, seed, kChosenBy));
    least = std::min(least, meanRatio(errors).mean);
    most = std::max(most, meanRatio(errors).mean);
  }
  return {least, most};
}

std::vector<CandidateWorth> allWorth(const StudiedCandidates& all, const char* metric) {
  std::vector<CandidateWorth> worth;
  for (std::size_t i = 0; i < all.candidates.size(); ++i) worth.push_back(worthOf(all, i, metric));
  return worth;
}

std::string namesOf(const std::vector<const StudiedScene*>& scenes) {
  std::vector<std::string> names;
  for (const StudiedScene* scene : scenes) names.push_back(scene->name);
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string ratioOverSeeds(const std::vector<double>& ratios) { return studyRatioCell(meanRatio(ratios)); }

StudyTable picksTable(const StudiedCandidates& all, const std::vector<CandidateWorth>& worth,
                      const std::array<PresetPick, 3>& picks) {
  StudyTable table{
      "What the rule picks",
      fmt::format(
          "Of all candidates that take at most {}, {} and {} times the CPU time of the shipped "
          "balanced, the one with the least relative error of the indirect layer. CPU time and error "
          "are multiples of those of the shipped balanced. The gain is the shipped error over the best "
          "one's, with its 95 % interval over seeds; where that does not lie above 1 as a whole, the "
          "preset stays as it is.",
          kPresetTimes[0], kPresetTimes[1], kPresetTimes[2]),
      {{"preset", "now", "CPU", "error", "best", "CPU", "error", "gain", "scenes with less error",
        "the rule's choice"}}};
  for (std::size_t p = 0; p < picks.size(); ++p) {
    const PresetPick& pick = picks[p];
    const auto isLess = [&](const StudiedScene* scene) {
      double sum = 0.0;
      for (std::size_t seed = 0; seed < all.seeds; ++seed)
        sum += std::log(all.error(pick.best, *scene, seed, kChosenBy) /
                        all.error(pick.shipped, *scene, seed, kChosenBy));
      return sum < 0.0;
    };
    table.rows.push_back(
        {kPresetNames[p].name, all.candidates[pick.shipped].label(), studyNumber(worth[pick.shipped].time()),
         studyNumber(worth[pick.shipped].error()), all.candidates[pick.best].label(),
         studyNumber(worth[pick.best].time()), studyNumber(worth[pick.best].error()),
         studyRatioCell(pick.gain),
         fmt::format("{} of {}", std::ranges::count_if(all.scenes, isLess), all.scenes.size()),
         pick.picked() == pick.shipped ? "as it is" : all.candidates[pick.picked()].label()});
  }
  return table;
}

StudyTable candidatesTable(const StudiedCandidates& all, const std::vector<CandidateWorth>& worth,
                           const std::array<std::size_t, 3>& shipped) {
  StudyTable table{
      "The candidates",
      fmt::format(
          "From fast to slow: CPU time, relative error of the indirect layer, its square times the time, "
          "and the relative error of the whole picture, as multiples of those of the shipped balanced. "
          "Geometric means over scenes, then over seeds, with 95 % intervals over seeds; the range is of "
          "scenes. Front: no other candidate is faster and nearer to the reference by these means.{}",
          all.leftOut.empty()
              ? ""
              : fmt::format(" Left out, as errors there are 0 once the reference's noise is taken off: {}.",
                            namesOf(all.leftOut))),
      {{"candidate", "CPU", "error", "error² x CPU", "error, least and most", "picture's error", "front",
        "shipped as"}}};
  const std::vector<CandidateWorth> pictures = allWorth(all, kWholePicture);
  std::vector<std::size_t> order(worth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return worth[i].time(); });
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    const bool isFront = worth[i].error() < least;
    least = std::min(least, worth[i].error());
    const auto [low, high] = rangeOverScenes(all, i);
    const auto* const ships = std::ranges::find(shipped, i);
    table.rows.push_back(
        {all.candidates[i].label(), ratioOverSeeds(worth[i].times), ratioOverSeeds(worth[i].errors),
         studyNumber(square(worth[i].error()) * worth[i].time()),
         fmt::format("{} to {}", studyNumber(low), studyNumber(high)), ratioOverSeeds(pictures[i].errors),
         isFront ? "yes" : "", ships == shipped.end() ? "" : kPresetNames[ships - shipped.begin()].name});
  }
  return table;
}

}  // namespace

std::string PresetCandidate::label() const {
  return fmt::format("{}x{}, radius {}, {} vectors, stride {}", rows, columns, radiusScale, nMin, lastStride);
}

SweepSettings PresetCandidate::settings() const {
  return {{"ilv.rows", std::to_string(rows)},
          {"ilv.columns", std::to_string(columns)},
          {"ilv.radius_scale", fmt::format("{}", radiusScale)},
          {"ilv.n_min", std::to_string(nMin)},
          {"passes.last_stride", std::to_string(lastStride)}};
}

PresetCandidate shippedCandidate(Preset preset) {
  Parameters parameters;
  applyPreset(parameters, preset);
  const IlvParameters& ilv = parameters.vectors.ilv;
  return {ilv.rows, ilv.columns, ilv.radiusScale, ilv.nMin, parameters.picture.lastStride};
}

std::vector<PresetCandidate> presetCandidates() {
  std::vector<PresetCandidate> candidates;
  // Twice as many columns as rows: a cell is then about as wide as it is high half way up the hemisphere.
  for (const int rows : {8, 12, 16, 20}) {
    for (const double radiusScale : {0.5, 0.4, 0.3}) {
      for (const int nMin : {2, 4}) {
        for (const int lastStride : {4, 2, 1}) {
          const PresetCandidate candidate{rows, 2 * rows, radiusScale, nMin, lastStride};
          if (isWorthALook(candidate)) candidates.push_back(candidate);
        }
      }
    }
  }
  // Whatever ships is there to be compared with.
  for (const auto& preset : kPresetNames) {
    const PresetCandidate shipped = shippedCandidate(preset.value);
    if (placeOf(candidates, shipped) == candidates.size()) candidates.push_back(shipped);
  }
  return candidates;
}

double CandidateWorth::time() const { return meanRatio(times).mean; }
double CandidateWorth::error() const { return meanRatio(errors).mean; }

std::optional<std::array<PresetPick, 3>> pickPresets(std::span<const CandidateWorth> worth,
                                                     const std::array<std::size_t, 3>& shipped) {
  const auto hasSeeds = [](const CandidateWorth& one) { return !one.errors.empty(); };
  if (worth.empty() || !std::ranges::all_of(worth, hasSeeds)) return std::nullopt;
  std::array<PresetPick, 3> picks;
  for (std::size_t p = 0; p < picks.size(); ++p) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < worth.size(); ++i) {
      if (worth[i].time() <= kPresetTimes[p] && (!best || worth[i].error() < worth[*best].error())) best = i;
    }
    picks[p] = {best.value_or(shipped[p]), shipped[p], {}};
    std::vector<double> gains;
    for (std::size_t seed = 0; seed < worth[picks[p].best].errors.size(); ++seed)
      gains.push_back(worth[shipped[p]].errors[seed] / worth[picks[p].best].errors[seed]);
    picks[p].gain = meanRatio(gains);
  }
  return picks;
}

std::vector<StudyTable> presetTables(std::span<const StudiedScene> scenes) {
  const StudiedCandidates all = comparable(scenes);
  if (all.seeds == 0) {
    const char* why = all.leftOut.empty()
                          ? "Nothing: no seed of all candidates is done in every scene."
                          : "Nothing: in no scene all errors are above 0 once the reference's noise is taken "
                            "off. References of more paths would tell.";
    return {{"What the rule picks", why, {{"preset"}}}};
  }
  const std::vector<CandidateWorth> worth = allWorth(all, kChosenBy);
  std::array<std::size_t, 3> shipped{};
  for (std::size_t p = 0; p < shipped.size(); ++p)
    shipped[p] = placeOf(all.candidates, shippedCandidate(kPresetNames[p].value));
  const auto picks = pickPresets(worth, shipped);
  std::vector<StudyTable> tables;
  if (picks) tables.push_back(picksTable(all, worth, *picks));
  tables.push_back(candidatesTable(all, worth, shipped));
  return tables;
}

}  // namespace lightvane
