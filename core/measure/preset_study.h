#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/measure/study_table.h"
#include "core/render/parameters.h"

namespace lightvane {

// The study of presets: which sampling densities and thresholds are worth their time, over many scenes, and a
// rule that chooses `draft`, `balanced` and `fine` from it (docs/trade.md, "The presets").

/// A choice of what presets set under the refined rules, but for light.samples; and of ilv.n_min, which is
/// the same in all of them.
struct PresetCandidate {
  int rows = 0, columns = 0;
  double radiusScale = 0.0;
  int nMin = 0, lastStride = 0;

  /// "12x24, radius 0.4, 4 vectors, stride 2".
  std::string label() const;
  SweepSettings settings() const;
  bool operator==(const PresetCandidate&) const = default;
};

/// What a preset is now.
PresetCandidate shippedCandidate(Preset preset);
/// Every combination of a few values of each knob; those of all presets are among them.
std::vector<PresetCandidate> presetCandidates();

/// What a candidate takes and leaves, as parts of what the preset `balanced` does with the same seed: for
/// each seed, geometric means over scenes.
struct CandidateWorth {
  std::vector<double> times, errors;

  /// Geometric means over seeds.
  double time() const;
  double error() const;
};

/// A candidate that the rule chooses for a preset.
struct PresetPick {
  std::size_t best = 0;     ///< what measured best, whatever the chance
  std::size_t shipped = 0;  ///< what the preset is now
  /// The shipped error over the best one's, with its 95 % interval over seeds (Student's t of the
  /// logarithms).
  MeanRatio gain;
  /// The interval is above 1 as a whole. If not, the preset stays.
  bool isSure() const { return gain.low && *gain.low > 1.0; }
  std::size_t picked() const { return isSure() ? best : shipped; }
};

/// The most time that draft, balanced and fine may take, as multiples of that of the shipped balanced: about
/// what they took when this was first measured, so that their names mean what they meant.
inline constexpr std::array<double, 3> kPresetTimes = {0.5, 1.0, 5.0};

/// The rule: of all candidates that take no longer than a preset may, the one with the least error; and each
/// preset stays as it is where that is not better with 95 % confidence. `worth` are candidates, `shipped` the
/// places of draft, balanced and fine among them. Nothing where some candidate has no seeds. Pure.
std::optional<std::array<PresetPick, 3>> pickPresets(std::span<const CandidateWorth> worth,
                                                     const std::array<std::size_t, 3>& shipped);

/// What the candidates are worth, the front of them, and what the rule picks. Pure.
std::vector<StudyTable> presetTables(std::span<const StudiedScene> scenes);

}  // namespace lightvane
