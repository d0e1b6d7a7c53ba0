#include "core/measure/corrections.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/base/check.h"

namespace lightvane {
namespace {

struct CorrectionEntry {
  const char* key;
  const char* corrects;
  /// Where the rules `printed` do not set it; null: they do.
  const char* printed = nullptr;
};

// In the order of docs/method.md. The paper names no level of recursion: 4 is the largest that we would call
// its "small predefined level", and so the kindest to it.
constexpr CorrectionEntry kCorrections[] = {
    {"dlv.weight", "the weight grows with distance, and depends on the unit of length"},
    {"dlv.dispersion_measure", "the test takes neighbours that scatter, by a measure that has a unit"},
    {"dlv.dispersion", "the threshold of scatter is wide"},
    {"dlv.normal_cosine", "vectors of the floor serve the wall"},
    {"dlv.normalise", "the mean direction is shorter than 1, and 0/0 where the light is hidden"},
    {"dlv.store", "one direction stands for a lobe that may be 0 towards it"},
    {"dlv.r_max", "a radius in metres, whatever the scene's size"},
    {"ilv.gradient_test", "a signed test passes every fall of light; the test itself selects noise"},
    {"ilv.gradient", "eq. 6 leaves out that near things grow and hide others"},
    {"ilv.extrapolate", "a vector's light is not moved to the point that it serves"},
    {"ilv.radius", "a mean of distances that far things rule"},
    {"ilv.radius_scale", "vectors reach as far as that mean"},
    {"ilv.radius_min", "corners take a vector for every pixel"},
    {"ilv.radius_max", "radii grow without bound"},
    {"ilv.radius_min_hit", "what a gather met nearest does not bound its radius"},
    {"ilv.weight", "1/2 at the edge of validity, with a pole where the signed change is -1"},
    {"ilv.curvature_clamp", "0/0 where S_curv is 1"},
    {"ilv.store", "as for direct light, and a tree for each BRDF"},
    {"ilv.in_front", "vectors in front of a point see what it does not"},
    {"ilv.visibility", "light passes thin walls"},
    {"ilv.clearance", "light creeps into gaps that are narrower than a vector's radius"},
    {"ilv.n_min", "few vectors make the cache dense enough"},
    {"ilv.n_min_last", "the last pass asks for as many vectors as the first"},
    {"passes.thin", "points side by side take a vector each", "0"},
    {"path.max_bounces", "a small level of recursion loses what was reflected more often", "4"},
    {"light.mirrored", "rays meet lights in mirrors by chance", "false"},
};

const FieldDescription& rowOf(const std::vector<FieldDescription>& rows, std::string_view key) {
  const auto found =
      std::ranges::find_if(rows, [&](const FieldDescription& row) { return row.field.key == key; });
  LV_CHECK(found != rows.end(), "there is no parameter {}", key);
  return *found;
}

std::vector<Correction> readCorrections() {
  Parameters printed;
  applyRules(printed.vectors, Rules::Printed);
  const std::vector<FieldDescription> before = describeParameters(printed);
  const std::vector<FieldDescription> after = describeParameters(Parameters{});
  std::vector<Correction> all;
  for (const CorrectionEntry& entry : kCorrections) {
    const FieldDescription& refined = rowOf(after, entry.key);
    all.push_back({entry.key, entry.printed != nullptr ? entry.printed : rowOf(before, entry.key).value,
                   refined.value, refined.field.paper, entry.corrects});
  }
  return all;
}

constexpr std::string_view effortSuffix(StudyEffort effort) {
  return effort == StudyEffort::Coarse ? ", coarse" : effort == StudyEffort::Fine ? ", fine" : "";
}

}  // namespace

std::span<const Correction> corrections() {
  static const std::vector<Correction> all = readCorrections();
  return all;
}

std::string StudyPoint::label() const {
  const std::string_view suffix = effortSuffix(effort);
  switch (role) {
    case StudyRole::All:
      return fmt::format("all{}", suffix);
    case StudyRole::None:
      return fmt::format("none{}", suffix);
    case StudyRole::Without:
      return fmt::format("without {}{}", correction->key, suffix);
    case StudyRole::Alone:
      return fmt::format("{} alone{}", correction->key, suffix);
  }
  LV_CHECK(false, "role {}", static_cast<int>(role));
  return {};
}

SweepSettings StudyPoint::settings() const {
  SweepSettings settings;
  for (const Correction& other : corrections()) {
    const bool isIt = &other == correction;
    const bool isMade =
        role == StudyRole::All || (role == StudyRole::Without && !isIt) || (role == StudyRole::Alone && isIt);
    settings.emplace_back(other.key, isMade ? other.refined : other.printed);
  }
  return settings;
}

std::vector<StudyPoint> studyPoints(bool hasDirectVectors) {
  std::vector<StudyPoint> points;
  const auto add = [&](StudyRole role, const Correction* correction) {
    for (const StudyEffort effort : {StudyEffort::Coarse, StudyEffort::Usual, StudyEffort::Fine})
      points.push_back({role, correction, effort});
  };
  add(StudyRole::All, nullptr);
  add(StudyRole::None, nullptr);
  for (const Correction& correction : corrections()) {
    if (!hasDirectVectors && correction.layer() == "direct") continue;
    add(StudyRole::Without, &correction);
    add(StudyRole::Alone, &correction);
  }
  return points;
}

void applyEffort(Parameters& parameters, StudyEffort effort) {
  if (effort == StudyEffort::Usual) return;
  const IlvParameters balanced;
  Parameters preset;
  applyPreset(preset, effort == StudyEffort::Coarse ? Preset::Draft : Preset::Fine);
  const IlvParameters& wanted = preset.vectors.ilv;
  IlvParameters& ilv = parameters.vectors.ilv;
  const auto scaled = [](int count, int to, int from) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(count) * to / from)));
  };
  ilv.rows = scaled(ilv.rows, wanted.rows, balanced.rows);
  ilv.columns = scaled(ilv.columns, wanted.columns, balanced.columns);
  ilv.radiusScale *= wanted.radiusScale / balanced.radiusScale;
}

}  // namespace lightvane
