// glTF 2.0: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html

#include "core/scene/load_gltf.h"

#include <algorithm>
#include <map>
#include <new>
#include <set>

#include <fmt/format.h>

#include "core/scene/closed_room.h"
#include "core/scene/gltf_accessor.h"
#include "core/scene/gltf_file.h"
#include "core/scene/gltf_material.h"
#include "core/scene/gltf_mesh.h"
#include "core/scene/gltf_nodes.h"
#include "core/scene/gltf_views.h"
#include "core/scene/transform.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// A primitive where a node has put it.
struct PlacedPrimitive {
  std::string name;
  std::uint32_t material = 0;
  std::shared_ptr<const MeshGeometry> mesh;
  glm::dmat4 toWorld{1.0};
};

/// Whether nodes with the same mesh are to have one or, where all becomes one mesh, each its own.
enum class Placing { Shared, Copied };

/// What a file has, read step by step.
class GltfReader {
 public:
  GltfReader(GltfFile file, Placing placing, GltfNotes notes)
      : file_(std::move(file)),
        placing_(placing),
        geometryNotes(std::move(notes)),
        materials(file_, materialNotes) {}

  Expected<void> run() {
    Expected<std::vector<GltfPlacedNode>> placed = placeGltfNodes(file_, geometryNotes);
    if (!placed) return tl::unexpected(placed.error());
    nodes = std::move(*placed);
    if (auto done = checkSize(); !done) return done;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      file_.watch.look(static_cast<double>(i) / static_cast<double>(nodes.size()));
      if (auto done = readMesh(nodes[i]); !done) return done;
    }
    if (primitives.empty()) return file_.error("it has no triangles");
    if (!file_.model.animations.empty()) geometryNotes.unused("animations");
    return {};
  }

  const GltfFile& file() const { return file_; }
  BoundsD bounds() const {
    BoundsD all;
    std::map<const MeshGeometry*, BoundsD> own;
    for (const PlacedPrimitive& primitive : primitives) {
      const auto [box, isNew] = own.try_emplace(primitive.mesh.get());
      if (isNew) box->second = boundsOf<Vec3d>(primitive.mesh->positions);
      const Transform transform({}, primitive.toWorld);
      std::size_t looked = 0;
      const auto place = [&](const Vec3d& p) {
        file_.watch.piece(looked++);
        return transform.point(p);
      };
      addPlaced<Vec3d>(primitive.mesh->positions, box->second, place, all);
    }
    return all;
  }

 private:
  /// A small file can place a large mesh many times.
  Expected<void> checkSize() const {
    std::size_t elements = 0;
    std::set<int> counted;
    for (const GltfPlacedNode& placed : nodes) {
      file_.watch.look();
      const int mesh = file_.model.nodes[static_cast<std::size_t>(placed.node)].mesh;
      if (mesh < 0 || (placing_ == Placing::Shared && !counted.insert(mesh).second)) continue;
      for (const auto& primitive : file_.model.meshes[static_cast<std::size_t>(mesh)].primitives) {
        elements += mostGltfElements(file_, primitive);
        if (elements > kMostGltfElements)
          return file_.error(fmt::format("its {} more than {} vertices and triangles",
                                         placing_ == Placing::Shared ? "meshes have" : "nodes place",
                                         kMostGltfElements));
      }
    }
    return {};
  }

  Expected<void> readMesh(const GltfPlacedNode& placed) {
    const tinygltf::Node& node = file_.model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.mesh < 0) return {};
    if (node.skin >= 0) geometryNotes.unused("skins");
    const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(node.mesh)];
    std::string name = !node.name.empty() ? node.name : mesh.name;
    if (name.empty()) name = fmt::format("mesh {}", node.mesh);
    const auto [own, isNew] = meshes_.try_emplace(node.mesh);
    for (std::size_t i = 0; isNew && i < mesh.primitives.size(); ++i) {
      auto read = readGltfPrimitive(file_, node.mesh, i, materials.uvsOf(mesh.primitives[i].material),
                                    geometryNotes, materialNotes);
      if (!read) return tl::unexpected(read.error());
      own->second.push_back({std::make_shared<const MeshGeometry>(std::move(read->mesh)), read->tint});
    }
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const PrimitiveOfMesh& part = own->second[i];
      if (part.mesh->triangles.empty()) continue;
      primitives.push_back(
          {name, materials.use(mesh.primitives[i].material, {part.tint, !part.mesh->colors.empty()}),
           part.mesh, placed.toWorld});
    }
    return {};
  }

  struct PrimitiveOfMesh {
    std::shared_ptr<const MeshGeometry> mesh;
    Rgb tint;
  };

  GltfFile file_;
  Placing placing_;
  std::map<int, std::vector<PrimitiveOfMesh>> meshes_;  ///< read once, however many nodes place them

 public:
  GltfNotes geometryNotes;
  GltfNotes materialNotes;
  GltfMaterials materials;
  std::vector<GltfPlacedNode> nodes;
  std::vector<PlacedPrimitive> primitives;
};

/// Reads a file and gives it to `use`, which makes of it what is asked for.
template <class Result, class Use>
Expected<Result> withGltf(const fs::path& path, Placing placing, LoadWatch& watch, const Use& use) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  try {
    GltfNotes notes;
    watch.part(0.0, 0.3);
    Expected<GltfFile> file = readGltfFile(path, notes, watch);
    if (!file) return tl::unexpected(file.error());
    watch.part(0.3, 1.0);
    GltfReader reader(std::move(*file), placing, std::move(notes));
    if (auto done = reader.run(); !done) return tl::unexpected(done.error());
    return use(reader);
  } catch (const std::bad_alloc&) {
    return makeError(path.string(), "takes more memory than there is");
  }
}

/// Adds a primitive to a mesh in which all have normals or none, and so for colours and texture coordinates.
void appendPrimitive(const MeshGeometry& part, std::uint32_t material, MeshGeometry& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  mesh.colors.insert(mesh.colors.end(), part.colors.begin(), part.colors.end());
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + first);
  mesh.triangleMaterials.insert(mesh.triangleMaterials.end(), part.triangles.size(), material);
}

MeshGeometry flatten(const std::vector<PlacedPrimitive>& primitives, LoadWatch& watch) {
  const auto any = [&primitives](auto member) {
    return std::any_of(primitives.begin(), primitives.end(),
                       [&](const PlacedPrimitive& p) { return !((*p.mesh).*member).empty(); });
  };
  const bool hasNormals = any(&MeshGeometry::normals);
  const bool hasColors = any(&MeshGeometry::colors);
  const bool hasUvs = any(&MeshGeometry::uvs);
  MeshGeometry mesh;
  for (const PlacedPrimitive& primitive : primitives) {
    watch.look();
    MeshGeometry part = *primitive.mesh;
    placeGltfMesh(primitive.toWorld, part, watch);
    if (hasNormals && part.normals.empty()) makeFlat(part, watch);
    if (hasColors) part.colors.resize(part.positions.size(), Rgb(1.0f));
    if (hasUvs) part.uvs.resize(part.positions.size(), Vec2(0.0f));
    appendPrimitive(part, primitive.material, mesh);
  }
  return mesh;
}

MeshFile meshFileOf(GltfReader& reader) {
  const fs::path& path = reader.file().path;
  for (const GltfPlacedNode& placed : reader.nodes) {
    const tinygltf::Node& node = reader.file().model.nodes[static_cast<std::size_t>(placed.node)];
    if (node.camera >= 0) reader.geometryNotes.unused("cameras of a mesh");
    if (gltfLightOf(node) >= 0) reader.geometryNotes.unused("lights of a mesh");
  }
  MeshFile file;
  file.geometry = flatten(reader.primitives, reader.file().watch);
  file.materials = std::move(reader.materials.materials);
  file.textures = std::move(reader.materials.textures);
  file.warnings = reader.geometryNotes.warnings(path);
  file.materialWarnings = reader.materialNotes.warnings(path);
  return file;
}

/// Where nothing gives light: a lamp in a closed room, into which no sky shines, else a sky.
void addLight(SceneDescription& scene, LoadWatch& watch) {
  if (const auto lamp = lampForClosedRoom(scene, watch)) {
    scene.lights.push_back({"added", *lamp});
    scene.warnings.push_back(fmt::format(
        "{}: nothing in it gives light, and the camera is in a closed room: a lamp was added there",
        scene.path.string()));
    return;
  }
  // A white surface under the open sky has radiance 1. From all around, since metals show what surrounds
  // them.
  scene.lights.push_back({"added", EnvironmentLightDescription{}});
  scene.warnings.push_back(
      fmt::format("{}: nothing in it gives light: a sky was added", scene.path.string()));
}

Expected<SceneDescription> sceneOf(GltfReader& reader) {
  const GltfFile& file = reader.file();
  SceneDescription scene;
  scene.path = file.path;
  scene.name = file.path.stem().string();
  const BoundsD bounds = reader.bounds();
  if (auto done = addGltfCameras(file, reader.nodes, bounds, scene); !done)
    return tl::unexpected(done.error());
  if (auto done = addGltfLights(file, reader.nodes, reader.geometryNotes, scene); !done)
    return tl::unexpected(done.error());
  scene.materials = std::move(reader.materials.materials);
  scene.textures = std::move(reader.materials.textures);
  for (PlacedPrimitive& primitive : reader.primitives) {
    ShapeDescription shape;
    shape.name = std::move(primitive.name);
    shape.material = primitive.material;
    shape.geometry =
        MeshDescription{file.path.filename().string(), std::move(primitive.mesh), {}, primitive.toWorld};
    scene.shapes.push_back(std::move(shape));
  }
  scene.warnings = reader.geometryNotes.warnings(file.path);
  const std::vector<std::string> ofMaterials = reader.materialNotes.warnings(file.path);
  scene.warnings.insert(scene.warnings.end(), ofMaterials.begin(), ofMaterials.end());
  if (scene.cameras.empty()) addCamera(scene, bounds, "a glTF file");
  if (!hasLight(scene)) addLight(scene, file.watch);
  return scene;
}

}  // namespace

Expected<MeshFile> loadGltf(const fs::path& path, LoadWatch& watch) {
  return withGltf<MeshFile>(path, Placing::Copied, watch, meshFileOf);
}

Expected<SceneDescription> loadGltfScene(const fs::path& path, LoadWatch& watch) {
  return withGltf<SceneDescription>(path, Placing::Shared, watch, sceneOf);
}

}  // namespace lightvane
