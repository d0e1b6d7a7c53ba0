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

/// A choice of what presets set under the refined rules, but for light.samples.
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
  /// How many times as good it is: of draft and fine the shipped error over its own, of balanced likewise
  /// squared error times time. With its 95 % interval over seeds (Student's t of the logarithms).
  double gain = 1.0;
  std::optional<double> low, high;
  /// The interval is above 1 as a whole. If not, the preset stays.
  bool isSure() const { return low && *low > 1.0; }
  std::size_t picked() const { return isSure() ? best : shipped; }
};

/// The most time that `draft` and `fine` may take, as multiples of that of the shipped `balanced`.
inline constexpr double kDraftTime = 0.5, kFineTime = 4.0;

/// The rule. `worth` are candidates, `shipped` the places of draft, balanced and fine among them. draft is
/// the least error within kDraftTime, fine the least error within kFineTime, balanced the least squared error
/// times time of those between the two in time; and each stays as it is where the best is not better with 95
/// % confidence. What is shipped may be chosen even where it takes longer than its limit. Nothing where there
/// are no seeds that all candidates have. Pure.
std::optional<std::array<PresetPick, 3>> pickPresets(std::span<const CandidateWorth> worth,
                                                     const std::array<std::size_t, 3>& shipped);

/// What the candidates are worth, the front of them, and what the rule picks. Pure.
std::vector<StudyTable> presetTables(std::span<const StudiedScene> scenes);

}  // namespace lightvane
