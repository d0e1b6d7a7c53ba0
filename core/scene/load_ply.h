#pragma once

#include "core/scene/mesh_file.h"

namespace lightvane {

/// Reads a PLY file (Turk 1994), ascii or binary in either byte order: vertices with positions, normals (nx,
/// ny, nz) and texture coordinates (s, t; u, v; texture_u, texture_v), and faces as lists of corners, which
/// are cut into triangles. Errors name the file and what of it does not fit, for ascii with line and column;
/// nothing malformed is read as zero. Takes no more memory than a small multiple of the file's size, whatever
/// its header says. Throws LoadStopped as `watch` says.
Expected<MeshFile> loadPly(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// A PLY file as a scene of its own: see sceneOfMesh.
Expected<SceneDescription> loadPlyScene(const std::filesystem::path& path,
                                        LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
