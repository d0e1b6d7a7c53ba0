#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/scene/scene.h"
#include "core/vectors/snapshot.h"

namespace lightvane {

/// What a point cloud says of where it comes from, in comments.
struct PlyOrigin {
  std::string program;  ///< "Lightvane 1.0.0"
  std::string scene;    ///< the file
};

/// Whether the path's extension is that of a point cloud.
bool isPlyPath(const std::filesystem::path& path);

/// The vectors of a snapshot as a point cloud for other programs: binary little-endian PLY 1.0, ILVs first
/// and then the DLVs of each light, a vertex each. Places and lengths are in the scene's own units, energies
/// in its own radiometric ones; the header says what every property is. Properties that a kind of vector does
/// not have are 0. `parameters` are those of the rendering, which tell how far the vectors reach. The same
/// snapshot gives the same bytes.
std::string encodePly(const Snapshot& snapshot, const Scene& scene, const VectorParameters& parameters,
                      const PlyOrigin& origin);

/// encodePly's bytes in a file, written as writeFileAtomically does. Errors as there.
Expected<void> writePly(const std::filesystem::path& path, const Snapshot& snapshot, const Scene& scene,
                        const VectorParameters& parameters, const PlyOrigin& origin);

}  // namespace lightvane
