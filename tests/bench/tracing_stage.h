#pragma once

#include <string>
#include <vector>

#include "tests/bench/embree_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/workbench.h"

namespace lightvane {

/// How fast rays of one kind are traced, by core/trace and by Embree alone, in seconds of CPU a ray.
struct RayKind {
  std::string name;
  bool occlusion = false;
  bool coherent = false;
  std::vector<Ray> rays;

  Samples ours, one, eight, sixteen;

  /// Round by round, Embree's seconds in its faster way (by the medians) over ours: the part of its rate that
  /// is left.
  Samples rateRatio() const;
  const Samples& fastestPeer() const;
};

/// The rays of a Cornell box's rendering: first rays of gathers (8 x 16 above at most `points` of the unit's
/// points on the floor), their bounces, shadow rays from those points and from where the first rays arrive;
/// at least `rays` of each in turn, `rounds` times.
struct TracingStage {
  TracingStage(const BenchScene& cornell, const EmbreeUnit& unit, std::size_t points, std::size_t rays,
               int rounds);

  RayKind gather, bounce, pointShadow, bounceShadow;
};

}  // namespace lightvane
