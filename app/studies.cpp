#include "app/studies.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "app/settings.h"
#include "app/sweep_work.h"
#include "core/measure/correction_study.h"
#include "core/measure/light_study.h"
#include "core/measure/preset_study.h"
#include "core/measure/rival_study.h"

namespace lightvane {
namespace {

constexpr const char* kCorrectionsOption = "--study corrections";

/// What the point's parameters are, as a table shows them: what differs among the points of a study.
SweepSettings correctionSettings(const Parameters& parameters) {
  const std::map<std::string, std::string> texts = parametersAsText(parameters);
  SweepSettings settings;
  for (const char* key : {"ilv.rows", "ilv.columns"}) settings.emplace_back(key, texts.at(key));
  for (const Correction& correction : corrections())
    settings.emplace_back(correction.key, texts.at(correction.key));
  return settings;
}

Expected<void> requireRefined(const SweepWork& work, const Parameters& shared, const char* option,
                              const char* what) {
  if (shared.vectors.rules == Rules::Refined) return {};
  return makeError(option, fmt::format("measures {} under the refined rules, and {} asks for method.rules={}",
                                       what, work.arguments().view.scene.stem().string(),
                                       choiceName(kRulesNames, shared.vectors.rules)));
}

Expected<void> planCorrections(SweepWork& work) {
  const auto shared = work.sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  if (auto refined = requireRefined(work, *shared, kCorrectionsOption, "corrections one by one"); !refined)
    return refined;
  for (const StudyPoint& point : studyPoints(work.keepsDirectVectors(*shared))) {
    auto parameters = work.parametersOf("vectors", point.settings(), kCorrectionsOption);
    if (!parameters) return tl::unexpected(parameters.error());
    applyEffort(*parameters, point.effort);
    // The line of errors over times takes one seed, the same of all points, so that what seeds differ in
    // meets them alike; the spread over seeds is told of the usual settings.
    const std::optional<int> seeds = point.effort == StudyEffort::Usual ? std::nullopt : std::optional(1);
    work.add({"vectors", correctionSettings(*parameters), *parameters, point.label(), seeds});
  }
  return {};
}

Expected<void> planRivals(SweepWork& work) {
  const auto shared = work.sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  for (const RivalPoint& point : rivalPoints()) {
    auto parameters = work.parametersOf(point.method, point.settings, "--study rivals");
    if (!parameters) return tl::unexpected(parameters.error());
    // Presets set it, too, but all methods are to sample direct light alike.
    parameters->transport.lightSamples = shared->transport.lightSamples;
    work.add({point.method, point.settings, *parameters, point.label, {}});
  }
  return {};
}

Expected<void> planPresets(SweepWork& work) {
  constexpr const char* kOption = "--study presets";
  const auto shared = work.sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  if (auto refined = requireRefined(work, *shared, kOption, "what presets set"); !refined) return refined;
  for (const PresetCandidate& candidate : presetCandidates()) {
    SweepSettings settings = candidate.settings();
    // Of a key that the scene sets itself, a preset is told nothing.
    std::erase_if(settings, [&](const auto& setting) {
      return std::ranges::any_of(work.description().render,
                                 [&](const RenderSetting& its) { return its.key == setting.first; });
    });
    auto parameters = work.parametersOf("vectors", settings, kOption);
    if (!parameters) return tl::unexpected(parameters.error());
    work.add({"vectors", settings, *parameters, candidate.label(), {}});
  }
  return {};
}

/// Of a work that is lit by one light, or by none.
Expected<void> planLights(SweepWork& work) {
  const auto shared = work.sharedParameters();
  if (!shared) return tl::unexpected(shared.error());
  const std::vector<Light>& lights = work.scene().lights;
  const std::vector<LightStudyPoint> points =
      lights.empty() ? std::vector{lightStudyDarkPoint()}
                     : lightStudyPoints(lights.front(), shared->transport.lightSamples);
  for (const LightStudyPoint& point : points) {
    auto parameters = work.parametersOf("vectors", point.settings(), "--study lights");
    if (!parameters) return tl::unexpected(parameters.error());
    work.add({"vectors", point.settings(), *parameters, point.label(), {}});
  }
  return {};
}

constexpr Study kStudies[] = {
    {"corrections", "what each correction of the paper is worth, taken back and made alone", 1,
     planCorrections, correctionTables},
    {"rivals", "how long methods without vectors take to the same error", 4, planRivals, rivalTables},
    {"presets", "what else presets might set, and which of it a rule picks for each", 3, planPresets,
     presetTables},
    {"lights", "whether dlv.mode=auto chooses right for each light", 3, planLights, lightTables,
     StudyLighting::EachLight},
};

}  // namespace

std::span<const Study> studies() { return kStudies; }

const Study* findStudy(std::string_view name) {
  const auto* const found = std::ranges::find(kStudies, name, &Study::name);
  return found == std::end(kStudies) ? nullptr : found;
}

std::vector<std::string> studyNames() {
  std::vector<std::string> names;
  for (const Study& study : kStudies) names.emplace_back(study.name);
  return names;
}

}  // namespace lightvane
