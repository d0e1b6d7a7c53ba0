#pragma once

#include <memory>
#include <span>

#include "core/inspect/record_ref.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// The frame's vectors but for these, in trees that fit its parameters. Those that stay are renumbered. Null
/// for frames without vectors. Cost: a copy of all vectors.
std::shared_ptr<const Snapshot> withoutRecords(const RenderFrame& frame, std::span<const RecordRef> records);

}  // namespace lightvane
