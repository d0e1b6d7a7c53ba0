#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "core/base/load_watch.h"
#include "core/base/math.h"
#include "core/scene/description.h"
#include "core/scene/scene.h"
#include "core/scene/transform.h"

namespace lightvane {

/// Decides which shapes share their triangles, and compiles what they share: each mesh once, in coordinates
/// of its own, however many shapes place it. A shape shares where another one has the same triangles, these
/// are many, and none emits, since the pieces of an area light lie in the scene. What is far too small to be
/// seen is copied, too: the way into its coordinates is out of single precision's range.
class SharedMeshes {
 public:
  /// A ray that goes in and out of the coordinates of an instance with fewer triangles takes longer than
  /// among copies, and with more it is the other way round (lightvane_bench --instances).
  static constexpr std::size_t kFewestTriangles = 256;

  /// A mesh, where it stands among Scene::sharedMeshes, and what it takes to place it.
  struct Mesh {
    std::uint32_t index = 0;
    /// For each of its surfaces the number of a material of its file's; one number of no meaning where the
    /// shape's material is that of all.
    std::vector<std::uint32_t> materials;
    Vec3d centre{0.0};  ///< positions in the shape's units are centre + 2^lengthExponent * own
    int lengthExponent = 0;
    float reach = 0.0f;       ///< the largest of its own coordinates
    Bounds bounds;            ///< of these
    std::size_t dropped = 0;  ///< triangles without area that were left out
  };

  /// `scene` and `watch` must outlive it.
  SharedMeshes(const SceneDescription& scene, const Normalisation& normalisation, LoadWatch& watch);

  /// Whether the shape is to be an instance.
  bool has(std::size_t shape) const { return isShared_[shape]; }
  /// The mesh of a shape that is, compiled into `meshes` when it is first asked for. Shapes whose materials
  /// let light pass at other triangles have meshes of their own: acceleration structures know which do.
  const Mesh& meshOf(std::size_t shape, const std::vector<Material>& materials,
                     std::vector<TriangleMesh>& meshes);

 private:
  /// The triangles, whether the file's materials are used, and which of these are panes.
  using Key = std::tuple<const MeshGeometry*, bool, std::vector<bool>>;

  const SceneDescription& scene_;
  LoadWatch& watch_;
  std::vector<bool> isShared_;
  std::map<Key, Mesh> meshes_;
};

/// Where `transform` puts a mesh in normalised units; firstSurface is left to the caller.
MeshInstance placeInstance(const SharedMeshes::Mesh& mesh, const Transform& transform,
                           const Normalisation& normalisation);

}  // namespace lightvane
