#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/measure/study_table.h"
#include "core/scene/scene.h"
#include "core/vectors/parameters.h"

namespace lightvane {

// Whether the direct light of each light had better be interpolated from vectors or sampled at every point,
// and whether `dlv.mode=auto` takes what is better.

/// Lights of a scene that are studied, rising: where there are more than `most`, those with the most power.
std::vector<std::uint32_t> strongestLights(const Scene& scene, std::size_t most);

/// One way to render one light.
struct LightStudyPoint {
  DlvMode mode = DlvMode::Never;  ///< Never or Always
  int samples = 1;                ///< light.samples

  /// "never, 16 samples".
  std::string label() const;
  /// With indirect light as cheap as it gets: what is measured is direct light, and a gather takes longer.
  SweepSettings settings() const;
};

/// Numbers of samples of a light of which auto's choice is studied, rising; `own` is what its scene asks for.
/// None is more than the light has places: each is the number of shadow rays, too.
std::vector<int> lightStudySamples(const Light& light, int own);

/// The points of one light, `never` and `always` in turn.
std::vector<LightStudyPoint> lightStudyPoints(const Light& light, int own);
/// What is rendered of a scene without any light, to know what its pictures take beside that.
LightStudyPoint lightStudyDarkPoint();

/// What `never` costs over what `always` costs, in squared error times CPU time of the light alone: the time
/// in which either would be as accurate as the other, as noise falls. Above 1, vectors pay.
struct ModeComparison {
  double factor = 1.0;  ///< geometric mean over the seeds that both have; 0 where `never` alone is exact
  double least = 1.0, most = 1.0;  ///< of the seeds

  /// Whether every seed says the same, by more than clocks leave open.
  bool isSure() const;
};

/// By a layer's metric, "direct.relative" (an error) or "direct.relmse" (its square). `dark` is of the scene
/// without a light. Nothing where one of them has no run, no time is left beside that of `dark`, or an error
/// is lost in the reference's noise.
std::optional<ModeComparison> compareModes(const StudiedScene& light, const SweepPoint& dark, int samples,
                                           std::string_view metric);

enum class ModeVerdict { Right, Wrong, NoDifference, NotMeasured };

/// What `auto` chooses for one light at one number of samples, and whether that is right.
struct ModeJudgement {
  int samples = 0;  ///< shadow rays of a point: the light has as many places to offer
  bool autoKeepsVectors = false;
  std::optional<ModeComparison> relative, relmse;
  /// The one of the two that is nearer to 1 where both are sure of the same; 1 where they are not.
  double factor = 1.0;
  ModeVerdict verdict = ModeVerdict::NotMeasured;

  /// By how much squared error times time is larger than with the other mode, of a rule that chooses so.
  double lossOf(bool keepsVectors) const;
};

/// Of one light, by rising samples; those that are not done at all are left out.
std::vector<ModeJudgement> judgeModes(const StudiedScene& light, const StudiedScene& dark);

/// Light by light, then what all say at each number of shadow rays. Pure.
std::vector<StudyTable> lightTables(std::span<const StudiedScene> scenes);

}  // namespace lightvane
