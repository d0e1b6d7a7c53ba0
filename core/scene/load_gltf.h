#pragma once

#include "core/scene/mesh_file.h"

namespace lightvane {

/// Reads the triangles of a glTF 2.0 file (.gltf or .glb) with their materials, as the nodes of its default
/// scene place them; cameras and lights are left out. Errors name the file and the part of it. Takes no more
/// memory than a small multiple of the file, its buffers and the pictures that are used, and of 2^26 vertices
/// and triangles that nodes may place. Throws LoadStopped as `watch` says.
Expected<MeshFile> loadGltf(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// A glTF file as a scene: a shape for each primitive of each mesh that a node places, cameras and lights.
/// What it has none of is added, with a warning: a camera that sees all, a sky or, in a closed room, a lamp.
Expected<SceneDescription> loadGltfScene(const std::filesystem::path& path,
                                         LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
