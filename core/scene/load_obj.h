#pragma once

#include <filesystem>

#include "core/scene/mesh_file.h"

namespace lightvane {

/// Reads an OBJ file. Positions are float by the format. Polygons are cut into triangles; corners without a
/// normal in a file that has some get their face's. Errors name file, line and column; nothing malformed is
/// read as zero. Materials are those of the MTL files: Kd and map_Kd diffuse, below a layer of Ks and Ns
/// where it has one; Ke; and glass by illum, Tf and Ni. Throws LoadStopped as
/// `watch` says.
Expected<MeshFile> loadObj(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// An OBJ file as a scene of its own: see sceneOfMesh.
Expected<SceneDescription> loadObjScene(const std::filesystem::path& path,
                                        LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
