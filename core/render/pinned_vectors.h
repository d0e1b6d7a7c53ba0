#pragma once

#include <memory>

#include "core/render/renderer.h"

namespace lightvane {

/// Vectors that somebody wants to keep whatever becomes of the others. Immutable, and shared by requests.
struct PinnedVectors {
  std::shared_ptr<const Scene> scene;  ///< that they belong to; with another they do nothing
  // What their numbers mean: under another way to store, they would be read as something else.
  VectorStore indirectStore = VectorStore::Split;
  VectorStore directStore = VectorStore::Split;
  Snapshot vectors;  ///< copies, with DLVs of every light; never asked for points, so of any radii

  std::size_t count() const { return vectors.indirect.size() + vectors.directCount(); }
};

/// `vectors`, and behind them those of `pinned` that they lack, in trees that fit the parameters. A vector is
/// lacking where none of its kind, light and key belongs to its very place (placeKey): one that was computed
/// anew there stands for it. Pinned vectors of another scene, or whose numbers mean something else than the
/// parameters say, are left out. Both may be null; the same object where nothing lacks, so that
/// withPinned(v, p, ...) == v says that all are there. Cost: a look at every vector, and the trees where some
/// are put back.
std::shared_ptr<const Snapshot> withPinned(std::shared_ptr<const Snapshot> vectors,
                                           const PinnedVectors* pinned,
                                           const std::shared_ptr<const Scene>& scene,
                                           const VectorParameters& parameters);

}  // namespace lightvane
