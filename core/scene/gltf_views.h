#pragma once

#include "core/scene/description.h"
#include "core/scene/gltf_nodes.h"

namespace lightvane {

/// Adds the cameras of the placed nodes, each with a name of its own. They look at the distance of the
/// bounds' middle where that lies before them.
Expected<void> addGltfCameras(const GltfFile& file, const std::vector<GltfPlacedNode>& nodes,
                              const BoundsD& bounds, SceneDescription& scene);

/// Adds the lights of KHR_lights_punctual of the placed nodes; their numbers are taken as radiometric ones.
Expected<void> addGltfLights(const GltfFile& file, const std::vector<GltfPlacedNode>& nodes, GltfNotes& notes,
                             SceneDescription& scene);

}  // namespace lightvane
