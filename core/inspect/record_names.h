#pragma once

#include <string>

#include "core/inspect/record_ref.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What vectors of a key serve, in words: "diffuse surfaces", "lobe of NAME" under `split`, "NAME".
std::string surfaceKeyName(const Scene& scene, SurfaceKey key, VectorStore store);
/// "ILV 12", "DLV 12 of LIGHT"
std::string recordName(const Scene& scene, const RecordRef& record);
/// The light's name, or "light 3" where it has none.
std::string lightName(const Scene& scene, std::uint32_t light);

/// The vector of that name in the frame's snapshot, or null.
const IndirectLightVector* findIndirect(const RenderFrame& frame, const RecordRef& record);
const DirectLightVector* findDirect(const RenderFrame& frame, const RecordRef& record);

}  // namespace lightvane
