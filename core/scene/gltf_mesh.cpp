#include "core/scene/gltf_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "core/scene/gltf_accessor.h"
#include "core/scene/transform.h"

namespace lightvane {
namespace {

/// The place of a vertex that no triangle uses.
constexpr std::uint32_t kUnusedVertex = std::numeric_limits<std::uint32_t>::max();

/// A primitive and what messages call it.
struct PrimitiveSource {
  const GltfFile& file;
  const tinygltf::Primitive& primitive;
  std::string name;

  /// The accessor of an attribute; none where it has none.
  std::optional<int> accessorOf(const std::string& attribute) const {
    const auto found = primitive.attributes.find(attribute);
    if (found == primitive.attributes.end()) return std::nullopt;
    return found->second;
  }
  std::string title(const std::string& attribute) const { return attribute + " of " + name; }

  /// Reads an attribute that has one element for each vertex; empty where it has none.
  Expected<GltfNumbers> read(const std::string& attribute, std::size_t least, std::size_t most,
                             std::optional<std::size_t> vertices) const {
    const std::optional<int> accessor = accessorOf(attribute);
    if (!accessor) return GltfNumbers{};
    const std::size_t count = file.model.accessors[static_cast<std::size_t>(*accessor)].count;
    if (vertices && count != *vertices)
      return file.error(
          fmt::format("{} has {} elements, and there are {} positions", title(attribute), count, *vertices));
    return readGltfNumbers(file, *accessor, least, most, title(attribute));
  }
};

/// The triangles that corners in their order make: lists, strips or fans (section 3.7.2.1 of the
/// specification).
std::vector<glm::uvec3> trianglesOf(int mode, const std::vector<std::uint32_t>& corners, LoadWatch& watch) {
  std::vector<glm::uvec3> triangles;
  const bool isList = mode == TINYGLTF_MODE_TRIANGLES;
  for (std::size_t i = 0; i + 2 < corners.size(); i += isList ? 3 : 1) {
    watch.piece(triangles.size());
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      triangles.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
    } else {
      // Of a strip, every other triangle runs the other way.
      const std::size_t odd = isList ? 0 : i % 2;
      triangles.emplace_back(corners[i], corners[i + 1 + odd], corners[i + 2 - odd]);
    }
  }
  return triangles;
}

/// Numbers the vertices that triangles use anew, in their order, and returns which these were. Many files
/// have one set of vertices for all their primitives.
std::vector<std::uint32_t> keepUsed(std::size_t vertexCount, std::vector<glm::uvec3>& triangles,
                                    LoadWatch& watch) {
  std::vector<std::uint32_t> numbers(vertexCount, kUnusedVertex);
  std::size_t looked = 0;
  for (const glm::uvec3& t : triangles) {
    watch.piece(looked++);
    for (int i = 0; i < 3; ++i) numbers[t[i]] = 0;
  }
  std::vector<std::uint32_t> used;
  for (std::uint32_t v = 0; v < vertexCount; ++v) {
    watch.piece(v);
    if (numbers[v] == kUnusedVertex) continue;
    numbers[v] = static_cast<std::uint32_t>(used.size());
    used.push_back(v);
  }
  for (glm::uvec3& t : triangles) {
    watch.piece(looked++);
    for (int i = 0; i < 3; ++i) t[i] = numbers[t[i]];
  }
  return used;
}

Expected<std::vector<Vec3d>> positionsOf(const PrimitiveSource& source, const GltfNumbers& numbers,
                                         const std::vector<std::uint32_t>& used) {
  std::vector<Vec3d> positions;
  positions.reserve(used.size());
  for (const std::uint32_t v : used) {
    source.file.watch.piece(positions.size());
    const Vec3d position = numbers.vec3(v);
    if (!isFinite(position))
      return source.file.error(fmt::format("{}: vertex {} is at [{}, {}, {}]: expected finite numbers",
                                           source.title("POSITION"), v, position.x, position.y, position.z));
    positions.push_back(position);
  }
  return positions;
}

/// The normals; none, and a note, where one has no length.
std::vector<Vec3d> normalsOf(const PrimitiveSource& source, const GltfNumbers& numbers,
                             const std::vector<std::uint32_t>& used, GltfNotes& notes) {
  std::vector<Vec3d> normals;
  normals.reserve(used.size());
  for (const std::uint32_t v : used) {
    source.file.watch.piece(normals.size());
    const Vec3d normal = numbers.vec3(v);
    if (!(glm::length(normal) > 0.0) || !isFinite(normal)) {
      notes.say("meshes with normals of no length are flat-shaded");
      return {};
    }
    normals.push_back(normal);
  }
  return normals;
}

Expected<std::vector<Vec2>> uvsOf(const PrimitiveSource& source, const GltfNumbers& numbers,
                                  const std::vector<std::uint32_t>& used, const GltfUvs& uvs) {
  std::vector<Vec2> result;
  result.reserve(used.size());
  for (const std::uint32_t v : used) {
    source.file.watch.piece(result.size());
    const Vec3d uv = uvs.transform * Vec3d(numbers.vec2(v), 1.0);
    // v runs down in glTF.
    const Vec2 place(static_cast<float>(uv.x), static_cast<float>(1.0 - uv.y));
    if (!std::isfinite(place.x) || !std::isfinite(place.y))
      return source.file.error(
          fmt::format("texture coordinates of {}: vertex {} has [{}, {}]", source.name, v, uv.x, uv.y));
    result.push_back(place);
  }
  return result;
}

/// The vertex colours, where they differ, and their mean. Left out where one is not finite.
void readColors(const PrimitiveSource& source, const GltfNumbers& numbers,
                const std::vector<std::uint32_t>& used, GltfNotes& notes, GltfPrimitive& out) {
  if (used.empty()) return;
  const int material = source.primitive.material;
  const bool isOpaque =
      material < 0 || source.file.model.materials[static_cast<std::size_t>(material)].alphaMode == "OPAQUE";
  Vec3d sum(0.0);
  bool isConstant = true;
  std::vector<Rgb> colors;
  colors.reserve(used.size());
  for (const std::uint32_t v : used) {
    source.file.watch.piece(colors.size());
    const Vec3d color = numbers.vec3(v);
    if (!isFinite(color)) return notes.say("vertex colours that are not finite are left out");
    colors.emplace_back(glm::clamp(color, 0.0, 1.0));
    sum += Vec3d(colors.back());
    if (!isOpaque && numbers.components == 4 && numbers.values[4 * std::size_t{v} + 3] < 1.0)
      notes.unused("alpha of vertices");
    isConstant = isConstant && colors.back() == colors.front();
  }
  out.tint = isConstant ? colors.front() : Rgb(sum / static_cast<double>(used.size()));
  if (!isConstant) out.mesh.colors = std::move(colors);
}

/// Notes what of a primitive is not used.
void noteUnused(const tinygltf::Primitive& primitive, const std::string& uvName, GltfNotes& notes) {
  for (const auto& [name, accessor] : primitive.attributes) {
    const bool isUsed = name == "POSITION" || name == "NORMAL" || name == "COLOR_0" || name == uvName;
    const bool isOfSkins = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
    if (!isUsed && !isOfSkins) notes.unused("the attribute " + name);
  }
  if (!primitive.targets.empty()) notes.unused("morph targets");
}

/// The corners of a primitive in their order.
Expected<std::vector<std::uint32_t>> cornersOf(const PrimitiveSource& source, std::size_t vertexCount) {
  if (source.primitive.indices != -1)
    return readGltfIndices(source.file, source.primitive.indices, vertexCount, source.title("indices"));
  std::vector<std::uint32_t> corners(vertexCount);
  std::iota(corners.begin(), corners.end(), 0U);
  return corners;
}

/// Fills what a mesh has beside positions and triangles.
Expected<void> readAttributes(const PrimitiveSource& source, std::size_t vertexCount,
                              const std::vector<std::uint32_t>& used, const GltfUvs& uvs,
                              GltfNotes& geometryNotes, GltfNotes& materialNotes, GltfPrimitive& out) {
  const auto normals = source.read("NORMAL", 3, 3, vertexCount);
  if (!normals) return tl::unexpected(normals.error());
  if (!normals->empty()) out.mesh.normals = normalsOf(source, *normals, used, geometryNotes);

  const std::string uvName = fmt::format("TEXCOORD_{}", uvs.set);
  const auto coordinates = source.read(uvName, 2, 2, vertexCount);
  if (!coordinates) return tl::unexpected(coordinates.error());
  if (!coordinates->empty()) {
    Expected<std::vector<Vec2>> read = uvsOf(source, *coordinates, used, uvs);
    if (!read) return tl::unexpected(read.error());
    out.mesh.uvs = std::move(*read);
  }

  const auto colors = source.read("COLOR_0", 3, 4, vertexCount);
  if (!colors) return tl::unexpected(colors.error());
  if (!colors->empty()) readColors(source, *colors, used, materialNotes, out);
  noteUnused(source.primitive, uvName, geometryNotes);
  return {};
}

}  // namespace

Expected<GltfPrimitive> readGltfPrimitive(const GltfFile& file, int mesh, std::size_t index,
                                          const GltfUvs& uvs, GltfNotes& geometryNotes,
                                          GltfNotes& materialNotes) {
  const tinygltf::Mesh& parent = file.model.meshes[static_cast<std::size_t>(mesh)];
  const PrimitiveSource source{file, parent.primitives[index],
                               fmt::format("{}, primitive {}", gltfName("mesh", mesh, parent.name), index)};
  const int mode = source.primitive.mode;
  if (mode >= TINYGLTF_MODE_POINTS && mode <= TINYGLTF_MODE_LINE_STRIP) {
    geometryNotes.unused(mode == TINYGLTF_MODE_POINTS ? "points" : "lines");
    return GltfPrimitive{};
  }
  if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN)
    return file.error(fmt::format("{}: there is no mode {}", source.name, mode));
  const auto positions = source.read("POSITION", 3, 3, std::nullopt);
  if (!positions) return tl::unexpected(positions.error());
  if (positions->empty()) {
    geometryNotes.unused("primitives without positions");
    return GltfPrimitive{};
  }
  const std::size_t vertexCount = positions->count();
  const auto corners = cornersOf(source, vertexCount);
  if (!corners) return tl::unexpected(corners.error());
  if (mode == TINYGLTF_MODE_TRIANGLES && corners->size() % 3 != 0)
    geometryNotes.say("corners that are left after the last whole triangle of a mesh are left out");

  GltfPrimitive out;
  out.mesh.triangles = trianglesOf(mode, *corners, file.watch);
  const std::vector<std::uint32_t> used = keepUsed(vertexCount, out.mesh.triangles, file.watch);
  Expected<std::vector<Vec3d>> places = positionsOf(source, *positions, used);
  if (!places) return tl::unexpected(places.error());
  out.mesh.positions = std::move(*places);
  if (auto done = readAttributes(source, vertexCount, used, uvs, geometryNotes, materialNotes, out); !done)
    return tl::unexpected(done.error());
  return out;
}

std::size_t mostGltfElements(const GltfFile& file, const tinygltf::Primitive& primitive) {
  const auto countOf = [&file](int accessor) {
    // Whether there are as many is seen when they are read.
    return std::min(file.model.accessors[static_cast<std::size_t>(accessor)].count, kMostGltfElements + 1);
  };
  const auto positions = primitive.attributes.find("POSITION");
  if (positions == primitive.attributes.end()) return 0;
  const std::size_t vertices = countOf(positions->second);
  const std::size_t corners = primitive.indices == -1 ? vertices : countOf(primitive.indices);
  return std::min(vertices, corners) + (primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners);
}

void placeGltfMesh(const glm::dmat4& toWorld, MeshGeometry& mesh, LoadWatch& watch) {
  const Transform transform({}, toWorld);
  std::size_t looked = 0;
  for (Vec3d& position : mesh.positions) {
    watch.piece(looked++);
    position = transform.point(position);
  }
  if (transform.flips()) {
    for (glm::uvec3& t : mesh.triangles) std::swap(t.y, t.z);
  }
  for (Vec3d& normal : mesh.normals) {
    watch.piece(looked++);
    normal = transform.normal(normal);
    // What a transform makes flat or a line has no normals left.
    if (normal == Vec3d(0.0)) {
      mesh.normals.clear();
      return;
    }
  }
}

void makeFlat(MeshGeometry& mesh, LoadWatch& watch) {
  MeshGeometry flat;
  for (const glm::uvec3& t : mesh.triangles) {
    watch.piece(flat.triangles.size());
    const Vec3d& a = mesh.positions[t.x];
    const Vec3d normal = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
    const double length = glm::length(normal);
    const auto first = static_cast<std::uint32_t>(flat.positions.size());
    flat.triangles.emplace_back(first, first + 1, first + 2);
    for (int i = 0; i < 3; ++i) {
      flat.positions.push_back(mesh.positions[t[i]]);
      // A triangle without area is not seen; any normal will do for it.
      flat.normals.push_back(length > 0.0 ? normal / length : Vec3d(0.0, 0.0, 1.0));
      if (!mesh.uvs.empty()) flat.uvs.push_back(mesh.uvs[t[i]]);
      if (!mesh.colors.empty()) flat.colors.push_back(mesh.colors[t[i]]);
    }
  }
  mesh.positions = std::move(flat.positions);
  mesh.normals = std::move(flat.normals);
  mesh.uvs = std::move(flat.uvs);
  mesh.colors = std::move(flat.colors);
  mesh.triangles = std::move(flat.triangles);
}

}  // namespace lightvane
