#include "core/scene/load_obj.h"

#include <algorithm>
#include <istream>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/watched_text.h"
#include "core/scene/mtl_text.h"
#include "core/scene/obj_text.h"
#include "core/scene/pixels.h"
#include "core/scene/polygon.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// The materials of a file, by their names.
struct ObjMaterials {
  std::vector<tinyobj::material_t> all;
  std::map<std::string, int> numbers;
  std::vector<std::string> warnings;

  /// Adds those of an MTL file.
  std::optional<Error> read(const fs::path& path, LoadWatch& watch) {
    Expected<std::string> text = readFile(path, watch);
    if (!text) {
      warnings.push_back(fmt::format("material file {}", text.error().message()));
      return std::nullopt;
    }
    const Expected<std::string> checked = checkedMtlText(path, *std::move(text), warnings, watch);
    if (!checked) return checked.error();
    WatchedText watched(*checked, watch);
    std::istream stream(&watched);
    std::string warning, problem;  // what our own check says better
    tinyobj::LoadMtl(&numbers, &all, &stream, &warning, &problem);
    watch.look();
    return std::nullopt;
  }

  int numberOf(const std::string& name) const {
    for (const std::string& known : {name, std::string(beforeComment(name))}) {
      if (const auto found = numbers.find(known); found != numbers.end()) return found->second;
    }
    return -1;
  }
};

/// The files that an mtllib names: one, whatever blanks its name has, or several with blanks between them.
std::vector<fs::path> libraryFiles(const fs::path& folder, const std::string& names, LoadWatch& watch) {
  std::error_code ignored;
  const fs::path whole = pathInAnyCase(folder / portablePath(names));
  if (fs::exists(whole, ignored)) return {whole};
  std::vector<fs::path> files;
  for (const TextWord& name : wordsOfLine(beforeComment(names), watch))
    files.push_back(pathInAnyCase(folder / portablePath(name.text)));
  // Of a name with blanks that is not there the whole is missing.
  const bool isAny = std::any_of(files.begin(), files.end(),
                                 [&ignored](const fs::path& file) { return fs::exists(file, ignored); });
  return isAny ? files : std::vector{whole};
}

constexpr int kAbsent = -1;      ///< a corner without a normal or texture coordinate
constexpr int kOutOfRange = -2;  ///< counted back to before the first

struct Corner {
  int position;  ///< these three from 0, or kAbsent, kOutOfRange
  int normal;
  int uv;
};

struct Face {
  std::size_t firstCorner;  ///< index into ObjData::corners
  std::size_t count;        ///< of its corners
  int material = kAbsent;   ///< index into ObjMaterials::all
};

/// An OBJ file as it is written, filled by tinyobjloader's callbacks.
struct ObjData {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;
  std::vector<Vec2> uvs;
  std::vector<Corner> corners;  ///< of all faces, one after another
  std::vector<Face> faces;
  ObjMaterials materials;
  std::vector<std::string> unknownMaterials;  ///< named by usemtl, in no MTL file; each once
  int currentMaterial = kAbsent;

  void addFace(const tinyobj::index_t* indices, int count) {
    faces.push_back({corners.size(), static_cast<std::size_t>(count), currentMaterial});
    for (int i = 0; i < count; ++i) {
      corners.push_back({fromZero(indices[i].vertex_index, positions.size()),
                         fromZero(indices[i].normal_index, normals.size()),
                         fromZero(indices[i].texcoord_index, uvs.size())});
    }
  }

  std::span<const Corner> cornersOf(const Face& face) const {
    return std::span(corners).subspan(face.firstCorner, face.count);
  }

  void useMaterial(const std::string& name) {
    currentMaterial = materials.numberOf(name);
    if (currentMaterial < 0 && unknown_.insert(name).second) unknownMaterials.push_back(name);
  }

 private:
  std::set<std::string> unknown_;

  /// OBJ counts from 1, and back from the last one so far where negative; 0 stands for none.
  static int fromZero(int index, std::size_t countSoFar) {
    if (index == 0) return kAbsent;
    if (index > 0) return index - 1;
    const int counted = static_cast<int>(countSoFar) + index;
    return counted >= 0 ? counted : kOutOfRange;
  }
};

tinyobj::callback_t objDataCallbacks() {
  tinyobj::callback_t callback;
  callback.vertex_cb = [](void* data, float x, float y, float z, float) {
    static_cast<ObjData*>(data)->positions.emplace_back(x, y, z);
  };
  callback.normal_cb = [](void* data, float x, float y, float z) {
    static_cast<ObjData*>(data)->normals.emplace_back(x, y, z);
  };
  callback.texcoord_cb = [](void* data, float u, float v, float) {
    static_cast<ObjData*>(data)->uvs.emplace_back(u, v);
  };
  callback.index_cb = [](void* data, tinyobj::index_t* corners, int count) {
    static_cast<ObjData*>(data)->addFace(corners, count);
  };
  callback.usemtl_cb = [](void* data, const char* name, int) {
    static_cast<ObjData*>(data)->useMaterial(name);
  };
  return callback;
}

/// An error where a corner names something that the file does not have.
std::optional<Error> checkIndices(const fs::path& path, const ObjData& obj,
                                  const std::vector<std::size_t>& faceLines, LoadWatch& watch) {
  const auto isOutside = [](int index, std::size_t count) {
    return index == kOutOfRange || (index != kAbsent && static_cast<std::size_t>(index) >= count);
  };
  for (std::size_t i = 0; i < obj.faces.size(); ++i) {
    watch.piece(i);
    for (const Corner& corner : obj.cornersOf(obj.faces[i])) {
      const char* what = isOutside(corner.position, obj.positions.size()) ? "vertex"
                         : isOutside(corner.normal, obj.normals.size())   ? "normal"
                         : isOutside(corner.uv, obj.uvs.size())           ? "texture coordinate"
                                                                          : nullptr;
      if (!what) continue;
      return Error{
          textPlace(path, faceLines[i], 1),
          fmt::format("f: names a {} that the file does not have (it has {} vertices, {} normals, {} texture "
                      "coordinates)",
                      what, obj.positions.size(), obj.normals.size(), obj.uvs.size()),
          {}};
    }
  }
  return std::nullopt;
}

/// Cuts the faces into triangles; corners with the same indices become one vertex. triangleMaterials are left
/// out.
MeshGeometry makeMesh(const ObjData& obj, std::vector<std::size_t>& facesOfTriangles, LoadWatch& watch) {
  // A normal of length 0 is as good as none.
  const auto normalOf = [&obj](const Corner& corner) {
    return corner.normal == kAbsent ? Vec3d(0.0) : obj.normals[static_cast<std::size_t>(corner.normal)];
  };
  bool hasNormals = false;
  bool hasUvs = false;
  for (std::size_t f = 0; f < obj.faces.size(); ++f) {
    watch.piece(f);
    for (const Corner& corner : obj.cornersOf(obj.faces[f])) {
      hasNormals |= normalOf(corner) != Vec3d(0.0);
      hasUvs |= corner.uv != kAbsent;
    }
  }

  MeshGeometry mesh;
  std::map<std::tuple<int, int, int, std::size_t>, std::uint32_t> numbers;
  std::vector<Vec3d> outline;
  std::vector<std::uint32_t> vertices;
  for (std::size_t f = 0; f < obj.faces.size(); ++f) {
    watch.piece(f, obj.faces.size());
    const std::span<const Corner> corners = obj.cornersOf(obj.faces[f]);
    if (corners.size() < 3) continue;
    outline.clear();
    for (const Corner& corner : corners) {
      outline.push_back(obj.positions[static_cast<std::size_t>(corner.position)]);
    }
    // A polygon that crosses itself can have triangles but no area of its own; any normal will do for it.
    Vec3d faceNormal = polygonNormal(outline);
    if (faceNormal == Vec3d(0.0)) faceNormal = Vec3d(0.0, 0.0, 1.0);
    vertices.clear();
    for (std::size_t i = 0; i < outline.size(); ++i) {
      watch.piece(i + 1);
      const Corner& corner = corners[i];
      // A corner that gets its face's normal belongs to that face alone.
      const bool takesFaceNormal = hasNormals && normalOf(corner) == Vec3d(0.0);
      const auto [entry, isNew] =
          numbers.try_emplace({corner.position, takesFaceNormal ? kAbsent : corner.normal, corner.uv,
                               takesFaceNormal ? f + 1 : 0},
                              static_cast<std::uint32_t>(mesh.positions.size()));
      vertices.push_back(entry->second);
      if (!isNew) continue;
      mesh.positions.push_back(outline[i]);
      if (hasNormals) mesh.normals.push_back(takesFaceNormal ? faceNormal : normalOf(corner));
      if (hasUvs) {
        mesh.uvs.push_back(corner.uv == kAbsent ? Vec2(0.0f) : obj.uvs[static_cast<std::size_t>(corner.uv)]);
      }
    }
    for (const glm::uvec3& t : triangulate(outline, watch)) {
      mesh.triangles.emplace_back(vertices[t.x], vertices[t.y], vertices[t.z]);
      facesOfTriangles.push_back(f);
    }
  }
  return mesh;
}

/// A statement that names a picture: map_Kd or map_Ke.
struct MtlPicture {
  const char* statement;
  const std::string& name;
  const tinyobj::texture_option_t& options;
};

/// Its texture, once for all statements that name it; none, and a warning, where it cannot be used.
std::optional<TextureUse> textureOf(const fs::path& path, const std::string& material,
                                    const MtlPicture& picture, MeshFile& mesh, LoadWatch& watch) {
  const auto& [statement, name, options] = picture;
  if (name.empty()) return std::nullopt;
  const auto say = [&](const char* what) {
    mesh.materialWarnings.push_back(
        fmt::format("{}: {}: {}", path.string(), material, fmt::format(fmt::runtime(what), statement)));
  };
  if (options.origin_offset[0] != 0.0f || options.origin_offset[1] != 0.0f) say("-o of {} is not used");
  if (!(options.scale[0] > 0.0f)) {
    say("-s of {} is not used where it is not above 0");
  } else if (options.scale[0] != options.scale[1]) {
    say("of an uneven -s of {} the first number is taken for both sides");
  }
  const fs::path named = portablePath(name);
  const fs::path found = named.parent_path() / pathInAnyCase(path.parent_path() / named).filename();
  const std::string portable = found.string();
  if (found != named)
    mesh.materialWarnings.push_back(fmt::format("{} of {}: there is no {}: {} is taken", statement, material,
                                                named.string(), found.filename().string()));
  TextureUse use;
  use.scale = options.scale[0] > 0.0f ? 1.0 / static_cast<double>(options.scale[0]) : 1.0;
  ImageTextureDescription image;
  image.file = portable;
  if (options.clamp) image.wrap = TextureWrap::Clamp;
  for (; use.texture < mesh.textures.size(); ++use.texture) {
    const auto& known = std::get<ImageTextureDescription>(mesh.textures[use.texture].pattern);
    if (known.file == image.file && known.wrap == image.wrap) return use;
  }
  const auto pixels =
      loadTexels((path.parent_path() / portable).lexically_normal(), TextureChannel::Color, watch);
  if (!pixels) {
    mesh.materialWarnings.push_back(
        fmt::format("{} of {} is not used: {}", statement, material, pixels.error().message()));
    return std::nullopt;
  }
  image.pixels = *pixels;
  mesh.textures.push_back({portable, std::move(image)});
  return use;
}

/// Illumination models of the MTL format: what it calls ray traced, and what it calls glass or refraction.
bool isMirrorModel(int illum) { return illum == 3 || illum == 5 || illum == 8; }
bool isGlassModel(int illum) { return illum == 4 || illum == 6 || illum == 7 || illum == 9; }

MaterialDescription convertMaterial(const fs::path& path, const tinyobj::material_t& source, MeshFile& mesh,
                                    LoadWatch& watch) {
  const auto rgb = [](const float(&color)[3]) { return Rgb(color[0], color[1], color[2]); };
  MaterialDescription material;
  material.name = fmt::format("{}: {}", path.filename().string(), source.name);
  // Many writers leave colours black beside a picture.
  const auto besidePicture = [&](const float(&color)[3], const std::optional<TextureUse>& use) {
    return use && isBlack(rgb(color)) ? Rgb(1.0f) : rgb(color);
  };
  material.textures.emission =
      textureOf(path, source.name, {"map_Ke", source.emissive_texname, source.emissive_texopt}, mesh, watch);
  material.emission = besidePicture(source.emission, material.textures.emission);
  // Tr is 1 - d, and tinyobjloader has both here. A light shines whatever it is called.
  if (!material.emits() && !isGlassModel(source.illum))
    material.opacity.value = std::clamp(static_cast<double>(source.dissolve), 0.0, 1.0);
  if (isGlassModel(source.illum)) {
    material.transmission = isBlack(rgb(source.transmittance)) ? Rgb(1.0f) : rgb(source.transmittance);
    material.ior = source.ior > 0.0f ? static_cast<double>(source.ior) : 1.5;
    return material;
  }
  const std::optional<TextureUse> texture =
      textureOf(path, source.name, {"map_Kd", source.diffuse_texname, source.diffuse_texopt}, mesh, watch);
  const Rgb diffuse = besidePicture(source.diffuse, texture);
  const Rgb specular = rgb(source.specular);
  // Model 1 has no highlights; 0 may also be that the file names none.
  if (isBlack(specular) || source.illum == 1) {
    material.diffuse = diffuse;
    material.textures.diffuse = texture;
    return material;
  }
  // Blinn's exponent n is about 2 / alpha^2 - 2 of a microfacet BRDF, and Schlick's r is alpha^2.
  const double roughness =
      isMirrorModel(source.illum) ? 0.0 : std::min(1.0, 2.0 / (static_cast<double>(source.shininess) + 2.0));
  material.layers = {{specular, roughness, 1.0}};
  if (texture || !isBlack(diffuse)) {
    material.layers.push_back({diffuse, 1.0, 1.0});
    material.textures.layers[1] = texture;
  }
  return material;
}

/// Fills the materials of `mesh` with those that its triangles use, in the order of their first use.
void assignMaterials(const fs::path& path, const ObjData& obj,
                     const std::vector<std::size_t>& facesOfTriangles, MeshFile& mesh, LoadWatch& watch) {
  std::map<int, std::uint32_t> numbers;
  for (const std::size_t f : facesOfTriangles) {
    watch.piece(mesh.geometry.triangleMaterials.size());
    const int source = obj.faces[f].material;
    const auto [entry, isNew] =
        numbers.try_emplace(source, static_cast<std::uint32_t>(mesh.materials.size()));
    mesh.geometry.triangleMaterials.push_back(entry->second);
    if (!isNew) continue;
    if (source != kAbsent) {
      const tinyobj::material_t& material = obj.materials.all[static_cast<std::size_t>(source)];
      mesh.materials.push_back(convertMaterial(path, material, mesh, watch));
      continue;
    }
    mesh.materials.push_back(defaultMaterial(path));
    mesh.materialWarnings.push_back(defaultMaterialWarning(path));
  }
  for (const std::string& name : obj.unknownMaterials) {
    mesh.materialWarnings.push_back(
        fmt::format("{}: no material file has the material {}", path.string(), name));
  }
}

}  // namespace

Expected<MeshFile> loadObj(const fs::path& path, LoadWatch& watch) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  watch.part(0.0, 0.05);
  Expected<std::string> text = readFile(path, watch);
  if (!text) return tl::unexpected(text.error());
  watch.part(0.05, 0.2);
  tidyObjText(*text, watch);
  Expected<ObjLines> lines = checkObjText(path, *text, watch);
  if (!lines) return tl::unexpected(lines.error());
  if (lines->faces.empty())
    return makeError(path.string(), "the file has no faces", "expected lines such as f 1 2 3");

  MeshFile mesh;
  mesh.warnings = std::move(lines->warnings);
  ObjData obj;
  std::set<fs::path> read;  // many writers name their file once for every part
  for (const std::string& names : lines->libraries) {
    for (const fs::path& library : libraryFiles(path.parent_path(), names, watch)) {
      if (!read.insert(library).second) continue;
      if (std::optional<Error> error = obj.materials.read(library, watch)) return tl::unexpected(*error);
    }
  }
  watch.part(0.2, 0.5);
  WatchedText watched(*text, watch);
  std::istream stream(&watched);
  std::string libraryWarnings;  // what the line check and the collector say better
  std::string libraryErrors;
  const bool isRead = tinyobj::LoadObjWithCallback(stream, objDataCallbacks(), &obj, nullptr,
                                                   &libraryWarnings, &libraryErrors);
  watch.look();
  if (!isRead || !libraryErrors.empty()) return makeError(path.string(), "cannot be read: " + libraryErrors);
  LV_CHECK(obj.faces.size() == lines->faces.size(), "{} faces read, {} counted", obj.faces.size(),
           lines->faces.size());
  if (std::optional<Error> error = checkIndices(path, obj, lines->faces, watch))
    return tl::unexpected(*error);

  watch.part(0.5, 1.0);
  std::vector<std::size_t> facesOfTriangles;
  mesh.geometry = makeMesh(obj, facesOfTriangles, watch);
  if (mesh.geometry.triangles.empty())
    return makeError(path.string(), "the file has no face of three corners or more");
  mesh.materialWarnings = std::move(obj.materials.warnings);
  assignMaterials(path, obj, facesOfTriangles, mesh, watch);
  return mesh;
}

Expected<SceneDescription> loadObjScene(const fs::path& path, LoadWatch& watch) {
  Expected<MeshFile> mesh = loadObj(path, watch);
  if (!mesh) return tl::unexpected(mesh.error());

  return sceneOfMesh(path, std::move(*mesh), "an OBJ file", watch);
}

}  // namespace lightvane
