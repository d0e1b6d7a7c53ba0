#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/tasks.h"
#include "core/inspect/record_ref.h"
#include "core/render/pinned_vectors.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// The frame's vectors but for these, in trees that fit its parameters. Those that stay are renumbered. Null
/// for frames without vectors. Cost: a copy of all vectors.
std::shared_ptr<const Snapshot> withoutRecords(const RenderFrame& frame, std::span<const RecordRef> records);

/// The frame's vectors with these computed anew at their own points, under the frame's parameters and lights,
/// with other random numbers. All numbers stay, and of Birth all but its cost and identity: a vector computed
/// anew is where it was in the growth of the cache. The new seed is a hash of the old identity, so that the
/// same frame gives the same, and each further time gives other numbers. Vectors under which no surface is
/// found stay as they are. Null for frames without vectors, and where `stop` ended it early.
///
/// Not to be called from within a body of the pool. Cost: a millisecond for each ILV, on each thread; ends
/// within milliseconds of `stop`.
std::shared_ptr<const Snapshot> recomputed(const RenderFrame& frame, std::span<const RecordRef> records,
                                           TaskPool& pool, const StopFlag& stop);

/// The frame's vectors but for those in the places of `gone`, and with those of `come` that are lacking then;
/// both may be null. The same object where that changes nothing; null for frames without vectors.
std::shared_ptr<const Snapshot> exchanged(const RenderFrame& frame, const PinnedVectors* gone,
                                          const PinnedVectors* come);

// Pinned vectors, for SessionRequest::pinned. Values: these make others.

/// `pinned` (null: none) and copies of these vectors. One that stands in the place of a pinned vector takes
/// its place. Those of another scene, or whose numbers mean something else than the frame's, are let go.
/// `pinned` itself where the frame has none of the records.
std::shared_ptr<const PinnedVectors> pin(std::shared_ptr<const PinnedVectors> pinned,
                                         const RenderFrame& frame, std::span<const RecordRef> records);
/// `pinned` without these; null where none is left.
std::shared_ptr<const PinnedVectors> unpin(std::shared_ptr<const PinnedVectors> pinned,
                                           const RenderFrame& frame, std::span<const RecordRef> records);
/// Whether all of these vectors of the frame are pinned: for each, one of its place. Not so for none.
/// Cost: linear in the records and the pinned vectors.
bool arePinned(const PinnedVectors* pinned, const RenderFrame& frame, std::span<const RecordRef> records);
/// All of the frame's vectors that are. Cost: a look at every vector.
std::vector<RecordRef> pinnedRecords(const PinnedVectors* pinned, const RenderFrame& frame);

}  // namespace lightvane
