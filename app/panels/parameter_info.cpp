#include "app/panels/parameter_info.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/panels/theme.h"
#include "core/base/number_text.h"
#include "core/base/text.h"

namespace lightvane {
namespace {

struct KnownGroup {
  std::string_view prefix;
  const char* title;
};
// The method first, then what is turned most. Prefixes that are not here come last, under their own name.
constexpr std::array kKnownGroups{KnownGroup{"method", "Method"},
                                  KnownGroup{"ilv", "Indirect light vectors (ILV)"},
                                  KnownGroup{"dlv", "Direct light vectors (DLV)"},
                                  KnownGroup{"passes", "Passes"},
                                  KnownGroup{"light", "Light sampling"},
                                  KnownGroup{"path", "Paths"},
                                  KnownGroup{"specular", "Mirrors and glass"},
                                  KnownGroup{"film", "Antialiasing"},
                                  KnownGroup{"naive", "Naive gather"},
                                  KnownGroup{"direct", "Direct light only"}};

std::vector<ParameterGroup> makeGroups() {
  std::vector<std::string> present;
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string prefix(groupOf(row.field.key));
    if (std::find(present.begin(), present.end(), prefix) == present.end()) present.push_back(prefix);
  }
  std::vector<ParameterGroup> groups;
  for (const KnownGroup& known : kKnownGroups) {
    const auto found = std::find(present.begin(), present.end(), known.prefix);
    if (found == present.end()) continue;
    groups.push_back({*found, known.title});
    present.erase(found);
  }
  for (const std::string& prefix : present) groups.push_back({prefix, prefix});
  return groups;
}

bool anyLightHasVectors(const SceneSummary& scene) {
  return std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const SceneLight& light) { return light.hasVectors; });
}

double metresPer(LengthUnit unit, const SceneSummary* scene) {
  return unit == LengthUnit::Scene && scene != nullptr ? scene->metresPerUnit : 1.0;
}

double diagonalMetres(const SceneSummary* scene) { return scene == nullptr ? 1.0 : scene->diagonalMetres; }

/// A count of which nobody knows more than two digits.
std::string aboutText(std::size_t count) {
  std::size_t step = 1;
  while (count / step >= 100) step *= 10;
  return countText((count + step / 2) / step * step);
}

}  // namespace

const std::vector<ParameterGroup>& parameterGroups() {
  static const std::vector<ParameterGroup> groups = makeGroups();
  return groups;
}

std::string_view groupOf(std::string_view key) {
  const std::size_t dot = key.find('.');
  // The seed names the whole picture's random numbers.
  return dot == std::string_view::npos ? "method" : key.substr(0, dot);
}

std::string whyGroupIsIdle(std::string_view group, const Parameters& parameters, const SceneSummary* scene) {
  const Method method = parameters.picture.method;
  const bool ofVectors = group == "ilv" || group == "dlv" || group == "passes";
  if (ofVectors && method != Method::Vectors) return "Of the method 'vectors' only.";
  if (group == "naive" && method != Method::Naive) return "Of the method 'naive' only.";
  if (group == "direct" && method != Method::Direct) return "Of the method 'direct' only.";
  if (group == "passes" && parameters.vectors.rules == Rules::Printed) {
    return "The printed rules work in one pass, row by row.";
  }
  if (scene == nullptr) return {};
  if (group == "dlv" && !anyLightHasVectors(*scene)) {
    return parameters.vectors.dlv.mode == DlvMode::Never
               ? "Direct light vectors are switched off (dlv.mode)."
               : "No light of this scene has direct light vectors: its exact direct light costs less "
                 "(dlv.mode = always computes them all the same).";
  }
  if (group == "specular" && !scene->needs.specular) return "This scene has neither mirrors nor glass.";
  return {};
}

std::string whyFieldIsIdle(std::string_view key, const Parameters& parameters, const SceneSummary* scene) {
  // The switch of a group is never without effect.
  if (key != "dlv.mode" || parameters.picture.method != Method::Vectors) {
    if (std::string why = whyGroupIsIdle(groupOf(key), parameters, scene); !why.empty()) return why;
  }
  const IlvParameters& ilv = parameters.vectors.ilv;
  const Method method = parameters.picture.method;
  if (key == "path.samples" && method != Method::Path) return "Of the method 'path' only.";
  if ((key == "light.samples" || key == "light.mirrored") && method == Method::Path) {
    return "The method 'path' samples lights after each bounce only.";
  }
  if (key == "light.mirrored" && scene != nullptr && !scene->needs.specular) {
    return "This scene has no mirrors.";
  }
  if (key == "ilv.lobe_angle" && scene != nullptr && !scene->needs.lobes) {
    return "This scene has no glossy surfaces.";
  }
  if (key == "ilv.S_E" && ilv.gradientTest == IlvGradientTest::Off) return "ilv.gradient_test is off.";
  const bool ofExtrapolation =
      key == "ilv.gradient_limit" || key == "ilv.extrapolate_min" || key == "ilv.extrapolate_max";
  if (ofExtrapolation && !ilv.extrapolate) return "ilv.extrapolate is off.";
  if (key == "ilv.visibility_distance" && !ilv.visibility) return "ilv.visibility is off.";
  return {};
}

std::vector<std::string> tooltipLines(const FieldFacts& facts) {
  std::vector<std::string> lines;
  lines.emplace_back(facts.field.help);
  if (facts.field.trade != Trade::Neither) lines.emplace_back(tradeSentence(facts.field.trade));
  std::string key = fmt::format("{}: {}", facts.field.key, facts.range);
  if (facts.field.unit[0] != '\0') key += fmt::format(" {}", facts.field.unit);
  lines.push_back(key);
  std::string values = "Default " + facts.defaultValue;
  if (facts.startValue != facts.defaultValue) values += fmt::format(", this scene {}", facts.startValue);
  lines.push_back(values);
  if (facts.field.paper[0] != '\0') {
    const std::string_view place = facts.field.paper;
    lines.push_back(place.starts_with("eq") ? fmt::format("Paper: {}", place)
                                            : fmt::format("Paper: section {}", place));
  }
  return lines;
}

std::string costText(const Field& field) {
  const std::string_view key = field.key;
  if (key == "method.name") return "A change makes the picture anew; the vectors stay, for when it has them.";
  if (key == "path.samples") return "A change traces all paths anew.";
  if (key == "naive.samples") return "A change gathers anew at every visible point.";
  return costSentence(field.cost);
}

std::string changeText(std::string_view key, const Parameters& candidate,
                       const std::optional<ChangeEstimate>& estimate) {
  const bool isMethod = key == "method.name";
  const auto counted = [](int count, const char* what) {
    return fmt::format("{} {}{}", countText(static_cast<std::size_t>(count)), what, count == 1 ? "" : "s");
  };
  // The rivals compute no vector, and that is the least of what they cost.
  switch (candidate.picture.method) {
    case Method::Vectors:
      if (isMethod && !estimate) return "light vectors, new ones where those that exist do not suffice";
      break;
    case Method::Path:
      if (isMethod || key == "path.samples")
        return counted(candidate.picture.pathSamples, "path") + " for each pixel";
      break;
    case Method::Naive:
      if (isMethod || key == "naive.samples")
        return fmt::format("a full gather at every visible point, of {} each",
                           counted(candidate.picture.naiveSamples, "ray"));
      break;
    case Method::Direct:
      if (isMethod)
        return counted(candidate.transport.lightSamples, "shadow ray") +
               " to each light at every visible point, and no gather";
      break;
  }
  return estimateText(estimate);
}

StaleKinds staleKinds(const std::optional<ChangeEstimate>& estimate) {
  if (!estimate) return {};
  return {estimate->staleIndirect > 0, estimate->staleDirect > 0};
}

std::string estimateText(const std::optional<ChangeEstimate>& estimate) {
  if (!estimate) return {};
  std::vector<std::string> anew;
  const auto add = [&](std::size_t count, const char* kind) {
    if (count > 0) anew.push_back(fmt::format("{} new {}{}", aboutText(count), kind, count == 1 ? "" : "s"));
  };
  add(estimate->newIndirect, "ILV");
  add(estimate->newDirect, "DLV");
  std::string text = anew.empty() ? "no new vector" : fmt::format("about {}", fmt::join(anew, " and "));
  std::vector<std::string> stale;
  if (estimate->staleIndirect > 0) stale.push_back(countText(estimate->staleIndirect) + " ILVs");
  if (estimate->staleDirect > 0) stale.push_back(countText(estimate->staleDirect) + " DLVs");
  if (!stale.empty()) text += fmt::format("; {} become stale", fmt::join(stale, " and "));
  return text;
}

bool matchesFilter(const Field& field, std::string_view filter) {
  const std::string text = lowered(fmt::format("{} {} {}", field.key, field.label, field.help));
  std::istringstream words(lowered(filter));
  for (std::string word; words >> word;) {
    if (text.find(word) == std::string::npos) return false;
  }
  return true;
}

std::string lengthUnitText(LengthUnit unit, const SceneSummary* scene) {
  if (unit == LengthUnit::Percent) return "%";
  return unit == LengthUnit::Metre || scene == nullptr ? "m" : scene->unit;
}

double lengthIn(LengthUnit unit, const Length& length, const SceneSummary* scene) {
  if (unit == LengthUnit::Percent) {
    return 100.0 * (length.isRelative() ? length.value() : length.value() / diagonalMetres(scene));
  }
  const double metres = length.isRelative() ? length.value() * diagonalMetres(scene) : length.value();
  return metres / metresPer(unit, scene);
}

Length lengthOf(double number, LengthUnit unit, const SceneSummary* scene) {
  return unit == LengthUnit::Percent ? Length::relative(number / 100.0)
                                     : Length::metres(number * metresPer(unit, scene));
}

std::string canonicalLength(std::string_view typed, LengthUnit unit, const SceneSummary* scene) {
  double number = 0.0;
  const auto inUnit = [&](std::string_view digits, LengthUnit its) {
    while (!digits.empty() && digits.back() == ' ') digits.remove_suffix(1);
    if (!parameter_text::parse(digits, number).empty()) return std::string();
    return parameter_text::format(lengthOf(number, its, scene));
  };
  if (std::string plain = inUnit(typed, unit); !plain.empty()) return plain;
  const std::string sceneUnit = lengthUnitText(LengthUnit::Scene, scene);
  if (sceneUnit != "m" && typed.ends_with(sceneUnit)) {
    std::string named = inUnit(typed.substr(0, typed.size() - sceneUnit.size()), LengthUnit::Scene);
    if (!named.empty()) return named;
  }
  return std::string(typed);
}

}  // namespace lightvane
