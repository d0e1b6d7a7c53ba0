#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/render/parameters.h"
#include "core/scene/description.h"

namespace lightvane {

/// What the command line says about parameters. `key` is a parameter's, or "preset".
struct CommandLineSettings {
  std::vector<RenderSetting> settings;  ///< --method, --preset, --seed, --set; `where` names the option
  std::optional<RenderSetting> samplesPerPixel;  ///< --spp; its key is left to resolveParameters
};

/// The parameters that a scene's `[render]` and a command line together ask for. From weak to strong:
/// defaults, method.rules, preset, the other keys of `[render]`, those of the command line. Rules and presets
/// set many keys at once and act first wherever they are given; of several the last counts, and the command
/// line's after the scene's. Paths per pixel are meant by --spp where the method is `path`, visible samples
/// elsewhere.
///
/// Errors name the place of the setting: an unknown key (with the nearest), a value that does not fit, and an
/// option of the command line that contradicts a --set beside it.
Expected<Parameters> resolveParameters(std::span<const RenderSetting> scene,
                                       const CommandLineSettings& command);

/// Every parameter by its key, as text.
std::map<std::string, std::string> parametersAsText(const Parameters& parameters);

/// "key=value key=value": every parameter that differs from its default, in the list's order.
std::string nonDefaultParameters(const Parameters& parameters);

/// Settings of a command line with which resolveParameters gives `parameters` on this scene; few where a rule
/// says it in one. Those that differ from the defaults are named even where the scene says the same, because
/// `[render]` is no part of the scene's identity and may change.
std::vector<std::pair<std::string, std::string>> reproducingSettings(std::span<const RenderSetting> scene,
                                                                     const Parameters& parameters);

}  // namespace lightvane
