#include "core/scene/load_obj.h"

#include <algorithm>
#include <charconv>
#include <istream>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/watched_text.h"
#include "core/scene/pixels.h"
#include "core/scene/polygon.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// tinyobjloader takes whatever is not a number as 0. So every line is checked before it reads the file, and
// the places of faces are noted for messages about their indices.

/// A word of a line, with the column of its first character.
struct Word {
  std::string_view text;
  std::size_t column;
};

std::vector<Word> splitLine(std::string_view line, LoadWatch& watch) {
  std::vector<Word> words;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t", at)) != std::string_view::npos) {
    watch.piece(words.size() + 1);
    const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
    words.push_back({line.substr(at, end - at), at + 1});
    at = end;
  }
  return words;
}

// A line takes a microsecond or two.
constexpr std::size_t kLinesPerLook = 1024;

/// Calls `body(words, lineNumber)` for each line that holds something, until it returns an error.
template <class Body>
std::optional<Error> forEachLine(std::string_view text, LoadWatch& watch, const Body& body) {
  std::size_t lineNumber = 0;
  const std::size_t size = text.size();
  while (!text.empty()) {
    if (lineNumber++ % kLinesPerLook == 0)
      watch.look(1.0 - static_cast<double>(text.size()) / static_cast<double>(size));
    // "\n", "\r\n" and "\r" end a line, as for tinyobjloader.
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::vector<Word> words = splitLine(text.substr(0, end), watch);
    if (!words.empty() && words[0].text[0] != '#') {
      if (std::optional<Error> error = body(words, lineNumber)) return error;
    }
    const bool pair = text.substr(end, 2) == "\r\n";
    text.remove_prefix(std::min(text.size(), end + (pair ? 2 : 1)));
  }
  return std::nullopt;
}

/// A finite number that float can hold.
std::optional<double> parseFloat(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size() || status != std::errc()) return std::nullopt;
  if (!(std::abs(value) <= std::numeric_limits<float>::max())) return std::nullopt;
  return value;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn" of whole numbers other than 0.
bool isFaceCorner(std::string_view text) {
  int parts = 0;
  while (true) {
    const std::size_t slash = std::min(text.find('/'), text.size());
    const std::string_view part = text.substr(0, slash);
    int index = 0;
    const auto [end, status] = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool isIndex = status == std::errc() && end == part.data() + part.size() && index != 0;
    const bool mayBeEmpty = parts == 1 && slash < text.size();
    if (!isIndex && !(part.empty() && mayBeEmpty)) return false;
    if (++parts > 3) return false;
    if (slash == text.size()) return true;
    text.remove_prefix(slash + 1);
  }
}

std::string placeOf(const fs::path& path, std::size_t line, std::size_t column) {
  return fmt::format("{}:{}:{}", path.string(), line, column);
}

/// An error unless at least `count` numbers follow the line's first word.
std::optional<Error> checkNumbers(const fs::path& path, const std::vector<Word>& words, std::size_t line,
                                  std::size_t count) {
  if (words.size() < count + 1) {
    return Error{placeOf(path, line, words[0].column),
                 fmt::format("{}: expected {} numbers, found {}", words[0].text, count, words.size() - 1),
                 {}};
  }
  for (std::size_t i = 1; i <= count; ++i) {
    if (parseFloat(words[i].text)) continue;
    return Error{
        placeOf(path, line, words[i].column),
        fmt::format("{}: expected a finite number up to 3.4e38, found \"{}\"", words[0].text, words[i].text),
        {}};
  }
  return std::nullopt;
}

/// Statements that were skipped, each once, in the order of their first appearance.
class Skipped {
 public:
  void add(std::string_view statement) {
    if (seen_.emplace(statement).second) list_ += (list_.empty() ? "" : ", ") + std::string(statement);
  }
  bool empty() const { return list_.empty(); }
  const std::string& list() const { return list_; }

 private:
  std::set<std::string, std::less<>> seen_;
  std::string list_;
};

/// Checks an OBJ file's lines; fills the line of every face, in order.
std::optional<Error> checkObjLines(const fs::path& path, std::string_view text,
                                   std::vector<std::size_t>& faceLines, std::vector<std::string>& warnings,
                                   LoadWatch& watch) {
  Skipped skipped;
  bool moreThanPositions = false;
  std::optional<Error> error =
      forEachLine(text, watch, [&](const std::vector<Word>& words, std::size_t line) -> std::optional<Error> {
        const std::string_view statement = words[0].text;
        if (words.back().text.ends_with('\\')) {
          return Error{placeOf(path, line, words.back().column),
                       "a line continued by a backslash is not supported", "join the lines"};
        }
        if (statement == "v") {
          moreThanPositions |= words.size() > 4;
          return checkNumbers(path, words, line, 3);
        }
        if (statement == "vn") return checkNumbers(path, words, line, 3);
        if (statement == "vt") return checkNumbers(path, words, line, 2);
        if (statement == "f") {
          if (words.size() < 4) {
            return Error{placeOf(path, line, words[0].column),
                         fmt::format("f: expected at least 3 corners, found {}", words.size() - 1),
                         {}};
          }
          for (std::size_t i = 1; i < words.size(); ++i) {
            if (i % kLinesPerLook == 0) watch.look();
            if (isFaceCorner(words[i].text)) continue;
            return Error{
                placeOf(path, line, words[i].column),
                fmt::format("f: expected v, v/vt, v//vn or v/vt/vn in whole numbers from 1 (or below 0, "
                            "counted back), found \"{}\"",
                            words[i].text),
                {}};
          }
          faceLines.push_back(line);
          return std::nullopt;
        }
        // Names of parts, and smoothing groups, which say no more than the normals.
        static const std::set<std::string_view> kHarmless = {"g", "o", "s", "usemtl", "mtllib"};
        if (!kHarmless.contains(statement)) skipped.add(statement);
        return std::nullopt;
      });
  if (moreThanPositions) {
    warnings.push_back(fmt::format("{}: vertex weights or colours are not used", path.string()));
  }
  if (!skipped.empty()) warnings.push_back(fmt::format("{}: not used: {}", path.string(), skipped.list()));
  return error;
}

/// A statement of MTL files that we use, and the numbers that follow it.
struct MtlStatement {
  std::string_view name;
  std::size_t count;
  double least, greatest;
  const char* range;
};
constexpr double kMostFloat = std::numeric_limits<float>::max();
constexpr MtlStatement kMtlStatements[] = {
    {"Kd", 3, 0.0, 1.0, "in [0, 1]"},
    {"Ks", 3, 0.0, 1.0, "in [0, 1]"},
    {"Tf", 3, 0.0, 1.0, "in [0, 1]"},
    {"Ke", 3, 0.0, kMostFloat, "of at least 0"},
    {"Ns", 1, 0.0, kMostFloat, "of at least 0"},
    {"Ni", 1, 1e-3, 1e3, "from 0.001 to 1000"},
    {"d", 1, 0.0, 1.0, "in [0, 1]"},
    {"Tr", 1, 0.0, 1.0, "in [0, 1]"},
    {"illum", 1, 0.0, 10.0, "from 0 to 10"},
};

/// Checks an MTL file's numbers.
std::optional<Error> checkMtlLines(const fs::path& path, std::string_view text,
                                   std::vector<std::string>& warnings, LoadWatch& watch) {
  Skipped skipped;
  std::optional<Error> error =
      forEachLine(text, watch, [&](const std::vector<Word>& words, std::size_t line) -> std::optional<Error> {
        const std::string_view statement = words[0].text;
        if (statement == "newmtl" || statement == "map_Kd" || statement == "map_Ke") return std::nullopt;
        const auto* known = std::find_if(std::begin(kMtlStatements), std::end(kMtlStatements),
                                         [&](const MtlStatement& s) { return s.name == statement; });
        if (known == std::end(kMtlStatements)) {
          skipped.add(statement);
          return std::nullopt;
        }
        if (std::optional<Error> wrong = checkNumbers(path, words, line, known->count)) return wrong;
        for (std::size_t i = 1; i <= known->count; ++i) {
          const double number = *parseFloat(words[i].text);
          if (number >= known->least && number <= known->greatest) continue;
          return Error{
              placeOf(path, line, words[i].column),
              fmt::format("{}: expected {} {}, found {}", statement,
                          known->count == 3 ? "three numbers" : "a number", known->range, words[i].text),
              {}};
        }
        return std::nullopt;
      });
  if (!skipped.empty()) {
    warnings.push_back(
        fmt::format("{}: not used: {} (Kd, Ks, Ns, Ke, Ni, Tf, d, Tr, illum, map_Kd and map_Ke are)",
                    path.string(), skipped.list()));
  }
  return error;
}

/// Gives tinyobjloader the MTL files beside the OBJ file, checked.
class CheckedMtlReader : public tinyobj::MaterialReader {
 public:
  CheckedMtlReader(fs::path folder, LoadWatch& watch) : folder_(std::move(folder)), watch_(watch) {}

  bool operator()(const std::string& name, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* indices, std::string* warning, std::string* problem) override {
    try {
      return read(name, materials, indices, warning, problem);
    } catch (const LoadStopped&) {
      return false;  // not through the library: who called it looks again
    }
  }

  std::optional<Error> error;
  std::vector<std::string> warnings;

 private:
  bool read(const std::string& name, std::vector<tinyobj::material_t>* materials,
            std::map<std::string, int>* indices, std::string* warning, std::string* problem) {
    const fs::path path = folder_ / name;
    const Expected<std::string> text = readFile(path, watch_);
    if (!text) {
      warnings.push_back(fmt::format("material file {}", text.error().message()));
      return false;
    }
    std::optional<Error> wrong = checkMtlLines(path, *text, warnings, watch_);
    if (wrong) {
      if (!error) error = std::move(wrong);
      return false;
    }
    WatchedText watched(*text, watch_);
    std::istream stream(&watched);
    tinyobj::LoadMtl(indices, materials, &stream, warning, problem);
    return true;
  }

  fs::path folder_;
  LoadWatch& watch_;
};

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
  int material = kAbsent;   ///< index into ObjData::materials
};

/// An OBJ file as it is written, filled by tinyobjloader's callbacks.
struct ObjData {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;
  std::vector<Vec2> uvs;
  std::vector<Corner> corners;  ///< of all faces, one after another
  std::vector<Face> faces;
  std::vector<tinyobj::material_t> materials;
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

  void useMaterial(const std::string& name, int index) {
    currentMaterial = index;
    const bool isNoted =
        std::find(unknownMaterials.begin(), unknownMaterials.end(), name) != unknownMaterials.end();
    if (index < 0 && !isNoted) unknownMaterials.push_back(name);
  }

 private:
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
  callback.usemtl_cb = [](void* data, const char* name, int index) {
    static_cast<ObjData*>(data)->useMaterial(name, index);
  };
  callback.mtllib_cb = [](void* data, const tinyobj::material_t* materials, int count) {
    static_cast<ObjData*>(data)->materials.assign(materials, materials + count);
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
          placeOf(path, faceLines[i], 1),
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
  if (options.scale[0] != options.scale[1] || options.origin_offset[0] != 0.0f ||
      options.origin_offset[1] != 0.0f) {
    mesh.materialWarnings.push_back(
        fmt::format("{}: {}: -o and uneven -s of {} are not used", path.string(), material, statement));
  }
  // Backslashes part folders where many such files were written.
  std::string portable = name;
  std::replace(portable.begin(), portable.end(), '\\', '/');
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
      const tinyobj::material_t& material = obj.materials[static_cast<std::size_t>(source)];
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
  const Expected<std::string> text = readFile(path, watch);
  if (!text) return tl::unexpected(text.error());
  watch.part(0.05, 0.2);

  MeshFile mesh;
  std::vector<std::size_t> faceLines;
  if (std::optional<Error> error = checkObjLines(path, *text, faceLines, mesh.warnings, watch))
    return tl::unexpected(*error);
  if (faceLines.empty())
    return makeError(path.string(), "the file has no faces", "expected lines such as f 1 2 3");

  ObjData obj;
  CheckedMtlReader mtlReader(path.parent_path(), watch);
  watch.part(0.2, 0.5);
  WatchedText watched(*text, watch);
  std::istream stream(&watched);
  std::string libraryWarnings;  // what the line check and the collector say better
  std::string libraryErrors;
  const bool isRead = tinyobj::LoadObjWithCallback(stream, objDataCallbacks(), &obj, &mtlReader,
                                                   &libraryWarnings, &libraryErrors);
  watch.look();
  if (mtlReader.error) return tl::unexpected(*mtlReader.error);
  if (!isRead || !libraryErrors.empty()) return makeError(path.string(), "cannot be read: " + libraryErrors);
  LV_CHECK(obj.faces.size() == faceLines.size(), "{} faces read, {} counted", obj.faces.size(),
           faceLines.size());
  if (std::optional<Error> error = checkIndices(path, obj, faceLines, watch)) return tl::unexpected(*error);

  watch.part(0.5, 1.0);
  std::vector<std::size_t> facesOfTriangles;
  mesh.geometry = makeMesh(obj, facesOfTriangles, watch);
  mesh.materialWarnings = std::move(mtlReader.warnings);
  assignMaterials(path, obj, facesOfTriangles, mesh, watch);
  return mesh;
}

Expected<SceneDescription> loadObjScene(const fs::path& path, LoadWatch& watch) {
  Expected<MeshFile> mesh = loadObj(path, watch);
  if (!mesh) return tl::unexpected(mesh.error());

  return sceneOfMesh(path, std::move(*mesh), "an OBJ file", watch);
}

}  // namespace lightvane
