#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/render/renderer.h"

namespace lightvane {

/// What a cache or checkpoint belongs to.
struct CacheIdentity {
  std::string sceneHash;                          ///< of everything but cameras and [render]
  std::map<std::string, std::string> parameters;  ///< every parameter, by key, as text
  std::string view;  ///< checkpoints only: camera, size, crop; a cache serves any view
};

/// A cache as it was read. `warnings` tells of parameters that differ from those asked for but do no harm.
struct CacheContent {
  Snapshot snapshot;
  std::map<std::string, std::string> parameters;
  std::vector<std::string> warnings;
};

/// Writes the vectors: version, identity, records and checksums, little endian, atomically (base/file.h).
Expected<void> writeCache(const std::filesystem::path& path, const Snapshot& snapshot,
                          const CacheIdentity& identity);

/// Reads vectors and builds their trees with `radii`. Refuses with one message, and changes nothing: a file
/// that is no cache, of a newer version, damaged or cut short (checksums), of another scene, or with vectors
/// that store something else (method.rules, ilv.store, dlv.store, dlv.normalise differ). Sizes are checked
/// before memory is taken.
Expected<CacheContent> readCache(const std::filesystem::path& path, const CacheIdentity& identity,
                                 const Scene& scene, const VectorParameters& parameters);

/// The same for a stopped rendering. Everything of the identity must be equal, but for parameters that only
/// say how long to go on (path.samples).
Expected<void> writeCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint,
                               const CacheIdentity& identity);
Expected<Checkpoint> readCheckpoint(const std::filesystem::path& path, const CacheIdentity& identity,
                                    const Scene& scene, const VectorParameters& parameters);

}  // namespace lightvane
