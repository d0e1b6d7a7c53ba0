#include "core/render/parameters.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "core/base/text.h"

namespace lightvane {
namespace {

constexpr std::string_view kRulesKey = "method.rules";
constexpr std::string_view kPresetKey = "preset";

/// The choice that `setting` names.
template <class E, std::size_t N>
Expected<E> readChoice(const RenderSetting& setting, const std::array<Choice<E>, N>& choices) {
  if (const auto value = choiceNamed(choices, setting.value)) return *value;
  const std::vector<std::string> names = choiceNames(choices);
  return makeError(setting.where,
                   fmt::format("{} takes {}, not '{}'", setting.key, listWords(names), setting.value),
                   suggestion(setting.value, names));
}

const RenderSetting* findLast(std::span<const RenderSetting> settings, std::string_view key) {
  const auto found = std::find_if(settings.rbegin(), settings.rend(),
                                  [&](const RenderSetting& setting) { return setting.key == key; });
  return found == settings.rend() ? nullptr : &*found;
}

}  // namespace

Expected<Parameters> applySettings(Parameters parameters, std::span<const RenderSetting> settings) {
  if (const RenderSetting* rules = findLast(settings, kRulesKey)) {
    const auto value = readChoice(*rules, kRulesNames);
    if (!value) return tl::unexpected(value.error());
    applyRules(parameters.vectors, *value);
  }
  if (const RenderSetting* preset = findLast(settings, kPresetKey)) {
    const auto value = readChoice(*preset, kPresetNames);
    if (!value) return tl::unexpected(value.error());
    applyPreset(parameters, *value);
  }
  for (const RenderSetting& setting : settings) {
    if (setting.key == kPresetKey) continue;
    if (auto done = setParameter(parameters, setting.key, setting.value, setting.where); !done)
      return tl::unexpected(done.error());
  }
  return parameters;
}

bool isAdaptive(const Parameters& parameters) {
  const PictureParameters& picture = parameters.picture;
  return picture.filmContrast > 0.0 && picture.filmSamples > 1 && picture.method == Method::Vectors &&
         parameters.vectors.rules != Rules::Printed;
}

EnergyRule energyRuleFor(const Parameters& parameters) {
  return parameters.vectors.rules == Rules::Printed ? EnergyRule::Printed : EnergyRule::Refined;
}

std::vector<std::string> contradictions(const Parameters& parameters) {
  std::vector<std::string> found;
  const auto compare = [&](const char* least, int nMin, const char* most, int nMax) {
    if (nMin <= nMax) return;
    found.push_back(
        fmt::format("{} = {} vectors are asked for where {} = {} are used: many more are computed than "
                    "serve anything",
                    least, nMin, most, nMax));
  };
  const VectorParameters& vectors = parameters.vectors;
  compare("ilv.n_min", vectors.ilv.nMin, "ilv.n_max", vectors.ilv.nMax);
  compare("dlv.n_min", vectors.dlv.nMin, "dlv.n_max", vectors.dlv.nMax);
  return found;
}

void applyPreset(Parameters& p, Preset preset) {
  // The defaults of the structs are `balanced`. docs/trade.md states what was measured to choose these, and
  // the rule.
  const Parameters balanced;
  IlvParameters& ilv = p.vectors.ilv;
  p.transport.lightSamples = balanced.transport.lightSamples;
  p.picture.lastStride = balanced.picture.lastStride;
  ilv.rows = balanced.vectors.ilv.rows;
  ilv.columns = balanced.vectors.ilv.columns;
  switch (preset) {
    case Preset::Draft:
      p.transport.lightSamples = 4;
      ilv.rows = 8;
      ilv.columns = 16;
      break;
    case Preset::Balanced:
      break;
    case Preset::Fine:
      p.picture.lastStride = 1;
      ilv.rows = 20;
      ilv.columns = 40;
      break;
  }
  // The paper's radius is part of its rules: a preset must not turn them into ours.
  if (p.vectors.rules != Rules::Refined) return;
  ilv.radiusScale = preset == Preset::Draft  ? 0.5
                    : preset == Preset::Fine ? 0.3
                                             : balanced.vectors.ilv.radiusScale;
}

}  // namespace lightvane
