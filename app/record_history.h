#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/render/pinned_vectors.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What was done to vectors by hand: their states are numbered, 0 the one in which nothing was. Setup names
/// one, so that undo and redo lead from state to state. On one thread.
class RecordHistory {
 public:
  /// A whole cache, and what it is of.
  struct Whole {
    std::shared_ptr<const Snapshot> vectors;
    std::shared_ptr<const Scene> scene;
    Parameters parameters;
    LightMix lights;

    bool isOf(const RenderFrame& frame) const {
      return scene == frame.scene && parameters == frame.parameters && lights == frame.lights;
    }
  };
  /// Vectors that went and that came, and those that were pinned before and after; each may be null. And the
  /// whole cache before: where vectors went, points may since have computed their own, which undo takes away.
  struct Step {
    std::shared_ptr<const PinnedVectors> gone = {}, come = {}, pinnedBefore = {}, pinnedAfter = {};
    std::shared_ptr<const Whole> before = {};
    std::shared_ptr<const Whole> after = {};  ///< of a step back

    Step inverse() const { return {come, gone, pinnedAfter, pinnedBefore, after, before}; }
  };

  /// The number of the state to which the step leads from that one.
  std::uint64_t add(std::uint64_t from, Step step);
  /// What is to be done, in this order, to come from one state to another. States that are not known any more
  /// are where nothing was done.
  std::vector<Step> way(std::uint64_t from, std::uint64_t to) const;
  /// Numbers go on, so that states of before are never taken for new ones.
  void clear() { arrivals_.clear(); }

 private:
  struct Arrival {
    std::uint64_t from = 0;
    Step step;
  };
  /// The state and those that it came from, the oldest last.
  std::vector<std::uint64_t> line(std::uint64_t state) const;

  std::uint64_t last_ = 0;
  std::map<std::uint64_t, Arrival> arrivals_;  ///< by the state to which they lead
};

}  // namespace lightvane
