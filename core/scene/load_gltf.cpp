// glTF 2.0: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html

#include "core/scene/load_gltf.h"

#include <algorithm>
#include <map>
#include <new>

#include <fmt/format.h>

#include "core/scene/gltf_accessor.h"
#include "core/scene/gltf_file.h"
#include "core/scene/gltf_material.h"
#include "core/scene/gltf_mesh.h"
#include "core/scene/gltf_nodes.h"
#include "core/scene/gltf_views.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// A primitive where a node has put it.
struct PlacedPrimitive {
  std::string name;
  std::uint32_t material = 0;
  MeshDescription mesh;
};

/// What a file has, read step by step.
class GltfReader {
 public:
  explicit GltfReader(GltfFile file, GltfNotes notes)
      : file_(std::move(file)), geometryNotes(std::move(notes)), materials(file_, materialNotes) {}

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
    for (const PlacedPrimitive& primitive : primitives) {
      for (std::size_t i = 0; i < primitive.mesh.positions.size(); ++i) {
        file_.watch.piece(i);
        all.add(primitive.mesh.positions[i]);
      }
    }
    return all;
  }

 private:
  /// A small file can place a large mesh many times.
  Expected<void> checkSize() const {
    std::size_t elements = 0;
    for (const GltfPlacedNode& placed : nodes) {
      file_.watch.look();
      const int mesh = file_.model.nodes[static_cast<std::size_t>(placed.node)].mesh;
      if (mesh < 0) continue;
      for (const auto& primitive : file_.model.meshes[static_cast<std::size_t>(mesh)].primitives) {
        elements += mostGltfElements(file_, primitive);
        if (elements > kMostGltfElements)
          return file_.error(
              fmt::format("its nodes place more than {} vertices and triangles", kMostGltfElements));
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
      own->second.push_back(std::move(*read));
    }
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const GltfPrimitive& part = own->second[i];
      if (part.mesh.triangles.empty()) continue;
      PlacedPrimitive primitive{name, materials.use(mesh.primitives[i].material, part.tint), part.mesh};
      placeGltfMesh(placed.toWorld, primitive.mesh, file_.watch);
      primitives.push_back(std::move(primitive));
    }
    return {};
  }

  GltfFile file_;
  std::map<int, std::vector<GltfPrimitive>> meshes_;  ///< read once, however many nodes place them

 public:
  GltfNotes geometryNotes;
  GltfNotes materialNotes;
  GltfMaterials materials;
  std::vector<GltfPlacedNode> nodes;
  std::vector<PlacedPrimitive> primitives;
};

/// Reads a file and gives it to `use`, which makes of it what is asked for.
template <class Result, class Use>
Expected<Result> withGltf(const fs::path& path, LoadWatch& watch, const Use& use) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  try {
    GltfNotes notes;
    watch.part(0.0, 0.3);
    Expected<GltfFile> file = readGltfFile(path, notes, watch);
    if (!file) return tl::unexpected(file.error());
    watch.part(0.3, 1.0);
    GltfReader reader(std::move(*file), std::move(notes));
    if (auto done = reader.run(); !done) return tl::unexpected(done.error());
    return use(reader);
  } catch (const std::bad_alloc&) {
    return makeError(path.string(), "takes more memory than there is");
  }
}

/// Adds a primitive to a mesh in which all have normals or none, and all texture coordinates or none.
void appendPrimitive(const PlacedPrimitive& primitive, MeshDescription& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const MeshDescription& part = primitive.mesh;
  mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
  mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  for (const glm::uvec3& t : part.triangles) mesh.triangles.push_back(t + first);
  mesh.triangleMaterials.insert(mesh.triangleMaterials.end(), part.triangles.size(), primitive.material);
}

MeshDescription flatten(std::vector<PlacedPrimitive>& primitives, LoadWatch& watch) {
  const auto any = [&primitives](auto member) {
    return std::any_of(primitives.begin(), primitives.end(),
                       [&](const PlacedPrimitive& p) { return !(p.mesh.*member).empty(); });
  };
  const bool hasNormals = any(&MeshDescription::normals);
  const bool hasUvs = any(&MeshDescription::uvs);
  MeshDescription mesh;
  for (PlacedPrimitive& primitive : primitives) {
    watch.look();
    if (hasNormals && primitive.mesh.normals.empty()) makeFlat(primitive.mesh, watch);
    if (hasUvs) primitive.mesh.uvs.resize(primitive.mesh.positions.size(), Vec2(0.0f));
    appendPrimitive(primitive, mesh);
    primitive.mesh = {};
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
  file.geometry.file = path.filename().string();
  file.materials = std::move(reader.materials.materials);
  file.textures = std::move(reader.materials.textures);
  file.warnings = reader.geometryNotes.warnings(path);
  file.materialWarnings = reader.materialNotes.warnings(path);
  return file;
}

void addSky(SceneDescription& scene) {
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
    primitive.mesh.file = file.path.filename().string();
    shape.geometry = std::move(primitive.mesh);
    scene.shapes.push_back(std::move(shape));
  }
  scene.warnings = reader.geometryNotes.warnings(file.path);
  const std::vector<std::string> ofMaterials = reader.materialNotes.warnings(file.path);
  scene.warnings.insert(scene.warnings.end(), ofMaterials.begin(), ofMaterials.end());
  if (scene.cameras.empty()) addCamera(scene, bounds, "a glTF file");
  if (!hasLight(scene)) addSky(scene);
  return scene;
}

}  // namespace

Expected<MeshFile> loadGltf(const fs::path& path, LoadWatch& watch) {
  return withGltf<MeshFile>(path, watch, meshFileOf);
}

Expected<SceneDescription> loadGltfScene(const fs::path& path, LoadWatch& watch) {
  return withGltf<SceneDescription>(path, watch, sceneOf);
}

}  // namespace lightvane
