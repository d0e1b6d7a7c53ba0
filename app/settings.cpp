#include "app/settings.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

namespace lightvane {
namespace {

constexpr std::string_view kRulesKey = "method.rules";

/// Twice the same --set is how a script overrides another; an option and a --set of the same key are an
/// oversight.
Expected<void> refuseContradictions(std::span<const RenderSetting> settings) {
  const auto isSet = [](const RenderSetting& setting) { return setting.where.starts_with("--set"); };
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (settings[i].key != settings[j].key || (isSet(settings[i]) && isSet(settings[j]))) continue;
      return makeError(settings[j].where,
                       fmt::format("sets {}, and so does {}", settings[i].key, settings[i].where),
                       "give one of them");
    }
  }
  return {};
}

}  // namespace

Expected<Parameters> resolveParameters(std::span<const RenderSetting> scene,
                                       const CommandLineSettings& command) {
  std::vector<RenderSetting> all(scene.begin(), scene.end());
  all.insert(all.end(), command.settings.begin(), command.settings.end());
  Expected<Parameters> parameters = applySettings(Parameters{}, all);
  if (parameters && command.samplesPerPixel) {
    RenderSetting samples = *command.samplesPerPixel;
    samples.key = parameters->picture.method == Method::Path ? "path.samples" : "film.samples";
    all.push_back(samples);
    parameters = applySettings(Parameters{}, all);
  }
  if (!parameters) return parameters;
  if (auto checked = refuseContradictions(std::span(all).subspan(scene.size())); !checked) {
    return tl::unexpected(checked.error());
  }
  return parameters;
}

std::map<std::string, std::string> parametersAsText(const Parameters& parameters) {
  std::map<std::string, std::string> text;
  for (const FieldDescription& row : describeParameters(parameters)) text.emplace(row.field.key, row.value);
  return text;
}

std::string nonDefaultParameters(const Parameters& parameters) {
  const std::map<std::string, std::string> defaults = parametersAsText(Parameters{});
  std::string text;
  for (const FieldDescription& row : describeParameters(parameters)) {
    if (row.value == defaults.at(row.field.key)) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", row.field.key, row.value);
  }
  return text;
}

std::vector<std::pair<std::string, std::string>> reproducingSettings(std::span<const RenderSetting> scene,
                                                                     const Parameters& parameters) {
  const std::map<std::string, std::string> defaults = parametersAsText(Parameters{});
  Parameters ruled;
  applyRules(ruled.vectors, parameters.vectors.rules);
  const std::map<std::string, std::string> ofRules = parametersAsText(ruled);
  const std::map<std::string, std::string> wanted = parametersAsText(parameters);

  // The rules are named wherever the scene may have set others; every other key where it is not what they
  // give, with and without what the scene says.
  CommandLineSettings command;
  const bool sceneHasRules = std::any_of(
      scene.begin(), scene.end(), [](const RenderSetting& setting) { return setting.key == kRulesKey; });
  const std::string rulesKey(kRulesKey);
  if (wanted.at(rulesKey) != defaults.at(rulesKey) || sceneHasRules) {
    command.settings.push_back({rulesKey, wanted.at(rulesKey), ""});
  }
  const Expected<Parameters> onScene = resolveParameters(scene, command);
  const std::map<std::string, std::string> ofScene = onScene ? parametersAsText(*onScene) : ofRules;

  std::vector<std::pair<std::string, std::string>> settings;
  for (const FieldDescription& row : describeParameters(parameters)) {
    const std::string key = row.field.key;
    const bool isRules = key == kRulesKey;
    if (isRules ? !command.settings.empty() : row.value != ofRules.at(key) || row.value != ofScene.at(key)) {
      settings.emplace_back(key, row.value);
    }
  }
  return settings;
}

}  // namespace lightvane
