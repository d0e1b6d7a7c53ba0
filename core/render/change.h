#pragma once

#include <memory>

#include "core/render/renderer.h"

namespace lightvane {

/// What of a finished or stopped rendering still holds when only its parameters change: a pure function of
/// both, read off the fields that differ. What holds is the same to the bit if it is computed again.
struct StillTrue {
  bool points = true;           ///< KnownView::points and surfaces
  bool sampled = true;          ///< KnownView::sampled
  bool indirectVectors = true;  ///< ILVs
  bool directVectors = true;    ///< DLVs
  bool radii = true;            ///< how far vectors reach: trees can stay as they are
};
StillTrue stillTrue(const Scene& scene, const Parameters& before, const Parameters& after);
/// The same where lights may change too: ILVs, and lights in mirrors, hold for the factors of
/// LightMix::indirect that they were made with; DLVs know no factors.
StillTrue stillTrue(const Scene& scene, const Parameters& before, const LightMix& lightsBefore,
                    const Parameters& after, const LightMix& lightsAfter);

/// The vectors of `snapshot` that still hold, in trees that fit the radii of `after`; null where none does.
/// Cost: none where all holds, else building the trees.
std::shared_ptr<const Snapshot> stillTrueVectors(std::shared_ptr<const Snapshot> snapshot,
                                                 const StillTrue& still, const Scene& scene,
                                                 const Parameters& after);

}  // namespace lightvane
