#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/scene/gltf_file.h"

namespace lightvane {

/// A node of the scene, with the transforms of all its parents.
struct GltfPlacedNode {
  int node = -1;
  glm::dmat4 toWorld{1.0};
};

/// The nodes of the file's default scene (else its first, else of the whole file), depth first. An error
/// where they are no trees, or where a transform is none.
Expected<std::vector<GltfPlacedNode>> placeGltfNodes(const GltfFile& file, GltfNotes& notes);

}  // namespace lightvane
