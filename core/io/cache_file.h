#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/render/renderer.h"

namespace lightvane {

/// How the names of cache files end.
inline constexpr std::string_view kCacheEnding = ".lvcache";

/// What a cache or checkpoint belongs to.
struct CacheIdentity {
  std::string sceneHash;  ///< sceneHash(description, HashScope::Lighting): no cameras, no [render]
  std::map<std::string, std::string> parameters;  ///< every parameter, by key, as text
  std::string view;  ///< checkpoints only: camera, size, crop; a cache serves any view
};

/// A cache as it was read.
struct CacheContent {
  Snapshot snapshot;
  std::map<std::string, std::string> parameters;  ///< those that the vectors were computed with
  /// A line for each parameter that vectors are a function of (ChangeCost::Vectors) and that differs from
  /// what is asked for: the vectors are used as they are. What only says how vectors are used may differ
  /// silently.
  std::vector<std::string> warnings;
};

/// Writes the vectors: version, identity, records and checksums, little endian, atomically (base/file.h). The
/// same vectors and identity give the same bytes.
Expected<void> writeCache(const std::filesystem::path& path, const Snapshot& snapshot,
                          const CacheIdentity& identity);

/// Reads vectors, every bit as it was written, and builds their trees with the radii that `parameters` give
/// them. Refuses with one message: a file that is no cache, of another version, damaged or cut short
/// (checksums), of another scene, or with vectors that store something else (method.rules, ilv.store,
/// dlv.store, dlv.normalise differ). Takes no more memory than a small multiple of the file's size, whatever
/// the file says.
Expected<CacheContent> readCache(const std::filesystem::path& path, const CacheIdentity& identity,
                                 const Scene& scene, const VectorParameters& parameters);

/// The same for a stopped rendering. Everything of the identity must be equal, but for parameters that only
/// say how long to go on (path.samples).
Expected<void> writeCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint,
                               const CacheIdentity& identity);
Expected<Checkpoint> readCheckpoint(const std::filesystem::path& path, const CacheIdentity& identity,
                                    const Scene& scene, const VectorParameters& parameters);

}  // namespace lightvane
