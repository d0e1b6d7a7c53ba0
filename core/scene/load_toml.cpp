#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <type_traits>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/base/text.h"
#include "core/scene/load_gltf.h"
#include "core/scene/load_obj.h"
#include "core/scene/load_ply.h"
#include "core/scene/load_scene.h"
#include "core/scene/pixels.h"
#include "core/scene/polygon.h"
#include "core/scene/supported.h"
#include "core/scene/toml_reader.h"
#include "core/scene/toml_tables.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// One function for each kind of table of docs/scene-format.md. Each reads the keys it knows into a
// description, whose initial values are the defaults, and then checks what no single key can tell.

constexpr int kFormatVersion = 1;
constexpr int kMostVolumicPoints = 1'000'000;

constexpr Interval kDegreesToHalfTurn{0.0, 180.0, "", " from 0 to 180"};
constexpr Interval kTurns{-3600.0, 3600.0, "", " from -3600 to 3600"};
constexpr Interval kPointCount{1.0, kMostVolumicPoints, "whole ", " from 1 to 1000000"};
constexpr Interval kVersion{1.0, kFormatVersion, "version ", ": 1"};
constexpr Interval kIndexOfRefraction{1e-3, 1e3, "", " above 0 (0.001 to 1000)"};

constexpr const char* kCameraExample =
    "add for example camera = {position = [0, 1, 5], target = [0, 1, 0], fov_y = 40}";

// ---- cameras

void readCameras(TomlTable& root, const toml::table* single, const std::vector<const toml::table*>& several,
                 SceneDescription& scene) {
  if (single && !several.empty()) {
    return root.fail("camera", "a file has either [camera] or [[cameras]], not both");
  }
  if (!single && several.empty()) {
    return root.report().fail({}, "the file has no camera", kCameraExample);
  }
  if (single) {
    TomlTable table(root.report(), *single, "[camera]");
    scene.cameras.push_back(readCamera(table));
  }
  std::set<std::string> names;
  for (const toml::table* entry : several) {
    TomlTable table(root.report(), *entry, titleOf("cameras", scene.cameras.size(), *entry));
    table.require("name", "a string that tells the cameras apart");
    scene.cameras.push_back(readCamera(table));
    const std::string& name = scene.cameras.back().name;
    if (!names.insert(name).second) table.fail("name", fmt::format("there is a camera \"{}\" already", name));
  }
}

// ---- textures

const std::vector<std::string> kTextureTypes = {"image", "checker", "wood", "marble"};
const std::vector<std::string> kWraps = {"repeat", "clamp"};
const std::vector<std::string> kFilters = {"linear", "nearest"};
const std::vector<std::string> kChannels = {"color", "alpha"};

constexpr Interval kDistortion{0.0, 100.0, "", " from 0 to 100"};
constexpr Interval kSharpness{0.01, 1000.0, "", " from 0.01 to 1000"};
constexpr Interval kOctaves{1.0, 16.0, "whole ", " from 1 to 16"};

ImageTextureDescription readImageTexture(TomlTable& table) {
  ImageTextureDescription image;
  table.require("file", "the name of a picture, relative to this file");
  table.read("file", image.file);
  std::string wrap;
  if (table.readWord("wrap", wrap, kWraps))
    image.wrap = wrap == "clamp" ? TextureWrap::Clamp : TextureWrap::Repeat;
  std::string filter;
  if (table.readWord("filter", filter, kFilters))
    image.filter = filter == "nearest" ? TextureFilter::Nearest : TextureFilter::Linear;
  std::string channel;
  if (table.readWord("channel", channel, kChannels))
    image.channel = channel == "alpha" ? TextureChannel::Alpha : TextureChannel::Color;
  return image;
}

TexturePatternDescription readPattern(TomlTable& table, const std::string& type) {
  if (type == "image") return readImageTexture(table);
  if (type == "checker") {
    CheckerDescription checker;
    table.read("even", checker.even, kUnitInterval);
    table.read("odd", checker.odd, kUnitInterval);
    return checker;
  }
  if (type == "wood") {
    WoodDescription wood;
    table.read("light", wood.light, kUnitInterval);
    table.read("dark", wood.dark, kUnitInterval);
    table.readDirection("axis", wood.axis);
    table.read("ring", wood.ring, kPositive);
    table.read("distortion", wood.distortion, kDistortion);
    table.read("grain", wood.grain, kUnitInterval);
    return wood;
  }
  MarbleDescription marble;
  table.read("base", marble.base, kUnitInterval);
  table.read("vein", marble.vein, kUnitInterval);
  table.readDirection("axis", marble.axis);
  table.read("spacing", marble.spacing, kPositive);
  table.read("distortion", marble.distortion, kDistortion);
  table.read("sharpness", marble.sharpness, kSharpness);
  table.read("octaves", marble.octaves, kOctaves);
  return marble;
}

void readTexture(TomlTable& table, const std::string& name, SceneDescription& scene, LoadWatch& watch) {
  std::string type;
  if (!table.readType("type", type, kTextureTypes)) return;
  TextureDescription texture{name, readPattern(table, type)};
  if (!table.finish()) return;
  if (auto* image = std::get_if<ImageTextureDescription>(&texture.pattern)) {
    const fs::path path = (scene.path.parent_path() / image->file).lexically_normal();
    const auto pixels = loadTexels(path, image->channel, watch);
    if (!pixels) return table.fail("file", pixels.error().message());
    image->pixels = *pixels;
  }
  scene.textures.push_back(std::move(texture));
}

// ---- materials

/// The index of `name` among `names`; none, and a message, where it is not there. `kind` is what it names.
std::optional<std::size_t> findNamed(TomlTable& table, std::string_view key, const std::string& name,
                                     const std::vector<std::string>& names, const char* kind) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string hint = suggestion(name, names);
  if (hint.empty())
    hint = names.empty() ? fmt::format("the file has no [{}.NAME]", kind) : "there are " + listWords(names);
  table.fail(key, fmt::format("there is no {} \"{}\"", kind, name), hint);
  return std::nullopt;
}

/// The texture that a table names, and its scale.
std::optional<TextureUse> readUse(TomlTable& entry, const std::vector<std::string>& textures) {
  std::string name;
  TextureUse use;
  entry.require("texture", "the name of a [texture.NAME]");
  const bool isNamed = entry.read("texture", name);
  entry.read("scale", use.scale, kPositive);
  if (!isNamed) return std::nullopt;
  const std::optional<std::size_t> found = findNamed(entry, "texture", name, textures, "texture");
  if (!found) return std::nullopt;
  use.texture = *found;
  return use;
}

/// A colour, or a texture and what it is multiplied by: {texture = "wood", scale = 0.4, color = [1, 1, 1]}.
void readColor(TomlTable& table, std::string_view key, const std::vector<std::string>& textures,
               const Interval& interval, Rgb& color, std::optional<TextureUse>& use) {
  std::optional<TomlTable> entry = table.hasTable(key) ? table.subtable(key) : std::nullopt;
  if (!entry) {
    table.read(key, color, interval);
    return;
  }
  color = Rgb(1.0f);
  use = readUse(*entry, textures);
  entry->read("color", color, interval);
  entry->finish();
}

void readReflectance(TomlTable& table, std::string_view key, const std::vector<std::string>& textures,
                     Rgb& color, std::optional<TextureUse>& use) {
  readColor(table, key, textures, kUnitInterval, color, use);
}

/// A number, or {texture = "leaf", scale = 1, value = 1, cutoff = 0.5}.
OpacityDescription readOpacity(TomlTable& table, const std::vector<std::string>& textures) {
  OpacityDescription opacity;
  std::optional<TomlTable> entry = table.hasTable("opacity") ? table.subtable("opacity") : std::nullopt;
  if (!entry) {
    table.read("opacity", opacity.value, kUnitInterval);
    return opacity;
  }
  opacity.texture = readUse(*entry, textures);
  entry->read("value", opacity.value, kUnitInterval);
  entry->read("cutoff", opacity.cutoff, kUnitInterval);
  entry->finish();
  return opacity;
}

const std::vector<std::string> kLayerModels = {"schlick", "ggx"};

std::vector<LayerDescription> readLayers(TomlTable& material, const std::vector<std::string>& textures,
                                         MaterialTextures& uses) {
  std::vector<LayerDescription> layers;
  for (const toml::table* entry : material.readTables("layers")) {
    TomlTable table(material.report(), *entry,
                    fmt::format("layer {} of {}", layers.size() + 1, material.title()));
    LayerDescription& layer = layers.emplace_back();
    std::optional<TextureUse> ofNone;  // of a layer too many
    readReflectance(table, "color", textures, layer.color,
                    layers.size() <= uses.layers.size() ? uses.layers[layers.size() - 1] : ofNone);
    table.require("color", "its reflectance seen from above, [r, g, b]");
    table.read("roughness", layer.roughness, kUnitInterval);
    std::string model;
    if (table.readWord("model", model, kLayerModels) && model == "ggx") layer.model = LayerModel::Ggx;
    if (layer.model == LayerModel::Ggx && table.has("isotropy")) {
      table.fail("isotropy", "cannot stand beside model = \"ggx\"",
                 "leave it out: such layers are isotropic");
    } else {
      table.read("isotropy", layer.isotropy, kUnitInterval);
    }
    table.finish();
  }
  if (material.has("layers") && (layers.empty() || layers.size() > 2)) {
    material.fail("layers", fmt::format("expected one or two layers, found {}", layers.size()));
  }
  return layers;
}

/// The first of `keys` that is present, or empty.
std::string_view firstPresent(TomlTable& table, std::initializer_list<std::string_view> keys) {
  const auto* const found =
      std::find_if(keys.begin(), keys.end(), [&](std::string_view key) { return table.has(key); });
  return found == keys.end() ? std::string_view() : *found;
}

MaterialDescription readMaterial(TomlTable& table, const std::string& name,
                                 const std::vector<std::string>& textures,
                                 std::vector<std::string>& warnings) {
  MaterialDescription material;
  material.name = name;
  readReflectance(table, "diffuse", textures, material.diffuse, material.textures.diffuse);
  readReflectance(table, "mirror", textures, material.mirror, material.textures.mirror);
  readReflectance(table, "transmission", textures, material.transmission, material.textures.transmission);
  table.read("ior", material.ior, kIndexOfRefraction);
  table.read("thin", material.thin);
  material.layers = readLayers(table, textures, material.textures);
  readColor(table, "emission", textures, kLightPower, material.emission, material.textures.emission);
  table.read("two_sided", material.twoSided);
  if (table.has("tangent")) table.readDirection("tangent", material.tangent.emplace(1.0, 0.0, 0.0));
  material.opacity = readOpacity(table, textures);
  if (!table.finish()) return material;

  const auto refuseBeside = [&](std::string_view key, std::string_view other) {
    if (!other.empty())
      table.fail(key, fmt::format("cannot stand beside {}", other), "make it two materials");
  };
  if (table.has("transmission"))
    refuseBeside("transmission", firstPresent(table, {"diffuse", "mirror", "layers"}));
  if (table.has("opacity")) refuseBeside("opacity", firstPresent(table, {"emission"}));
  if (table.has("layers")) {
    const bool isCoat = material.layers.size() == 1 && material.layers[0].model == LayerModel::Ggx;
    refuseBeside("layers",
                 isCoat ? firstPresent(table, {"mirror"}) : firstPresent(table, {"diffuse", "mirror"}));
  }
  if (table.has("ior") && !table.has("transmission")) {
    table.fail("ior", "an index of refraction without transmission", "add transmission = [1, 1, 1]");
  }
  if (table.has("thin") && !table.has("transmission")) {
    table.fail("thin", "it is about glass, and this material has no transmission",
               "add transmission = [1, 1, 1]");
  }
  if (table.has("two_sided") && !material.emits()) {
    table.fail("two_sided", "it is about emission, and this material emits nothing");
  }
  const float mostReflected = maxComponent(material.diffuse + material.mirror);
  // With textures, that is only the most that it could be.
  if (mostReflected > 1.0f && !material.textures.ofReflection()) {
    warnings.push_back(fmt::format("{}: {}: diffuse and mirror together reflect more than arrives ({:.3g})",
                                   table.report().place(table.table()), table.title(), mostReflected));
  }
  return material;
}

// ---- shapes

/// What shapes draw on beside their own tables.
struct ShapeContext {
  SceneDescription& scene;
  LoadWatch& watch;
  /// Mesh files that were read, by path, with the index of their first material in the scene, once a shape
  /// uses it.
  struct LoadedMesh {
    MeshFile file;  ///< but for its geometry
    std::shared_ptr<const MeshGeometry> geometry;
    std::optional<std::uint32_t> firstMaterial;
  };
  std::map<fs::path, LoadedMesh> meshes;
};

TransformDescription readTransform(TomlTable& shape) {
  TransformDescription transform;
  const toml::table* entry = shape.readTable("transform");
  if (!entry) return transform;
  TomlTable table(shape.report(), *entry, "transform of " + shape.title());
  table.read("translate", transform.translate);
  table.read("rotate", transform.rotateDegrees);
  table.readScale("scale", transform.scale, kPositive);
  table.finish();
  return transform;
}

const std::vector<std::string> kShapeTypes = {"polygon", "sphere", "box", "disc", "mesh"};

/// Reads the keys that belong to a type of shape.
GeometryDescription readGeometry(TomlTable& table, const std::string& type) {
  if (type == "polygon") {
    PolygonDescription polygon;
    table.require("vertices", "an array of points [x, y, z]");
    table.read("vertices", polygon.vertices);
    return polygon;
  }
  if (type == "sphere") {
    SphereDescription sphere;
    table.read("center", sphere.center);
    table.read("radius", sphere.radius, kPositive);
    return sphere;
  }
  if (type == "box") {
    BoxDescription box;
    table.read("min", box.min);
    table.read("max", box.max);
    return box;
  }
  if (type == "disc") {
    DiscDescription disc;
    table.read("center", disc.center);
    table.readDirection("normal", disc.normal);
    table.read("radius", disc.radius, kPositive);
    return disc;
  }
  MeshDescription mesh;
  table.require("file", "the name of an .obj, .ply, .gltf or .glb file, relative to this file");
  table.read("file", mesh.file);
  return mesh;
}

void checkPolygon(TomlTable& table, const PolygonDescription& polygon) {
  if (const std::optional<PolygonFault> fault = findPolygonFault(polygon.vertices)) {
    table.failAt("vertices", fault->vertex, fault->what, fault->hint);
  }
}

void checkBox(TomlTable& table, const BoxDescription& box) {
  for (int axis = 0; axis < 3; ++axis) {
    if (box.min[axis] < box.max[axis]) continue;
    table.fail(table.has("max") ? "max" : "min",
               fmt::format("expected max above min on every axis, found {} to {} on {}", box.min[axis],
                           box.max[axis], "xyz"[axis]),
               box.min[axis] == box.max[axis] ? "use a polygon for a flat shape" : "swap them");
  }
}

/// Spheres stay spheres and discs discs: they can be scaled alike on all axes only.
void checkEvenScale(TomlTable& table, const TransformDescription& transform) {
  const Vec3d& s = transform.scale;
  if (s.x == s.y && s.y == s.z) return;
  table.fail("transform",
             fmt::format("expected the same scale on all axes, found [{}, {}, {}]", s.x, s.y, s.z),
             "use a mesh for ellipsoids and ellipses");
}

/// Fills the mesh from its file and, where the shape names no material of its own, gives it those of the
/// file.
void loadMesh(TomlTable& table, ShapeContext& context, MeshDescription& mesh, std::size_t& material) {
  const SceneFileKind kind = sceneFileKind(mesh.file);
  switch (kind) {
    case SceneFileKind::Obj:
    case SceneFileKind::Ply:
    case SceneFileKind::Gltf:
      break;
    case SceneFileKind::Toml:
    case SceneFileKind::Unknown:
      return table.fail(
          "file",
          fmt::format("expected the name of an .obj, .ply, .gltf or .glb file, found \"{}\"", mesh.file));
  }
  SceneDescription& scene = context.scene;
  const fs::path path = (scene.path.parent_path() / mesh.file).lexically_normal();
  auto found = context.meshes.find(path);
  if (found == context.meshes.end()) {
    Expected<MeshFile> loaded = kind == SceneFileKind::Ply    ? loadPly(path, context.watch)
                                : kind == SceneFileKind::Gltf ? loadGltf(path, context.watch)
                                                              : loadObj(path, context.watch);
    if (!loaded) return table.fail("file", loaded.error().message());
    scene.warnings.insert(scene.warnings.end(), loaded->warnings.begin(), loaded->warnings.end());
    auto geometry = std::make_shared<const MeshGeometry>(std::move(loaded->geometry));
    found =
        context.meshes.emplace(path, ShapeContext::LoadedMesh{std::move(*loaded), std::move(geometry), {}})
            .first;
  }
  auto& [loaded, geometry, firstMaterial] = found->second;
  mesh.geometry = geometry;
  if (table.has("material")) return;
  if (!firstMaterial) {
    firstMaterial = static_cast<std::uint32_t>(scene.materials.size());
    appendMaterials(loaded, scene);
    scene.warnings.insert(scene.warnings.end(), loaded.materialWarnings.begin(),
                          loaded.materialWarnings.end());
  }
  for (std::uint32_t i = 0; i < loaded.materials.size(); ++i) mesh.materials.push_back(*firstMaterial + i);
  material = mesh.materials[geometry->triangleMaterials.front()];
}

/// The index of the material that the shape names; 0 where it names none.
std::size_t readMaterialName(TomlTable& table, const std::vector<std::string>& names) {
  std::string name;
  if (!table.read("material", name)) return 0;
  return findNamed(table, "material", name, names, "material").value_or(0);
}

void readShape(TomlTable& table, const std::vector<std::string>& materialNames, ShapeContext& context) {
  std::string type;
  if (!table.readType("type", type, kShapeTypes)) return;
  ShapeDescription shape;
  table.read("name", shape.name);
  if (type != "mesh") table.require("material", "the name of a [material.NAME]");
  shape.material = readMaterialName(table, materialNames);
  table.read("light", shape.light);
  shape.transform = readTransform(table);
  shape.geometry = readGeometry(table, type);
  if (!table.finish()) return;

  if (const auto* polygon = std::get_if<PolygonDescription>(&shape.geometry)) checkPolygon(table, *polygon);
  if (const auto* box = std::get_if<BoxDescription>(&shape.geometry)) checkBox(table, *box);
  if (auto* mesh = std::get_if<MeshDescription>(&shape.geometry))
    loadMesh(table, context, *mesh, shape.material);
  if (type == "sphere" || type == "disc") checkEvenScale(table, shape.transform);
  context.scene.shapes.push_back(std::move(shape));
}

/// What the shapes of one light have in common.
struct Emission {
  Rgb radiance;
  std::optional<TextureUse> texture;
  bool twoSided;

  bool operator==(const Emission&) const = default;
};

/// The shapes of one light source send out the same radiance, since they are sampled as one.
void checkLightGroup(TomlTable& table, const ShapeDescription& shape, const SceneDescription& scene,
                     std::map<std::string, Emission>& emissions) {
  if (shape.light.empty()) return;
  std::vector<std::uint32_t> used = {static_cast<std::uint32_t>(shape.material)};
  if (const auto* mesh = std::get_if<MeshDescription>(&shape.geometry); mesh && mesh->bringsMaterials())
    used = mesh->materials;
  bool emits = false;
  for (const std::uint32_t index : used) {
    const MaterialDescription& material = scene.materials[index];
    if (!material.emits()) continue;
    emits = true;
    const Emission emission = {material.emission, material.textures.emission, material.twoSided};
    const auto [first, isNew] = emissions.try_emplace(shape.light, emission);
    if (!isNew && first->second != emission) {
      return table.fail("light",
                        fmt::format("the material {} emits otherwise than the rest of the light \"{}\"",
                                    material.name, shape.light),
                        "shapes that are one light need the same emission and two_sided");
    }
  }
  if (!emits) {
    table.fail("light",
               fmt::format("the shape is to be part of the light \"{}\", but does not emit", shape.light),
               "give it a material with emission");
  }
}

// ---- lights

const std::vector<std::string> kLightTypes = {"point", "spot", "directional", "sphere", "environment"};

LightGeometryDescription readLightGeometry(TomlTable& table, const std::string& type) {
  if (type == "point") {
    PointLightDescription light;
    table.read("position", light.position);
    table.read("intensity", light.intensity, kLightPower);
    return light;
  }
  if (type == "spot") {
    SpotLightDescription light;
    table.read("position", light.position);
    table.readDirection("direction", light.direction);
    table.read("intensity", light.intensity, kLightPower);
    table.read("inner", light.innerDegrees, kDegreesToHalfTurn);
    table.read("outer", light.outerDegrees, kDegreesToHalfTurn);
    return light;
  }
  if (type == "directional") {
    DirectionalLightDescription light;
    table.readDirection("direction", light.direction);
    table.read("irradiance", light.irradiance, kLightPower);
    table.read("angle", light.angleDegrees, kDegreesToHalfTurn);
    return light;
  }
  if (type == "environment") {
    EnvironmentLightDescription light;
    table.read("radiance", light.radiance, kLightPower);
    table.read("image", light.image);
    table.read("rotate", light.rotateDegrees, kTurns);
    table.readDirection("up", light.up);
    return light;
  }
  VolumicSphereLightDescription light;
  table.read("center", light.center);
  table.read("radius", light.radius, kPositive);
  table.read("intensity", light.intensity, kLightPower);
  table.read("points", light.points, kPointCount);
  return light;
}

void readLight(TomlTable& table, SceneDescription& scene, LoadWatch& watch) {
  std::string type;
  if (!table.readType("type", type, kLightTypes)) return;
  LightDescription light;
  table.read("name", light.name);
  light.geometry = readLightGeometry(table, type);
  if (!table.finish()) return;
  if (const auto* spot = std::get_if<SpotLightDescription>(&light.geometry)) {
    if (spot->innerDegrees > spot->outerDegrees) {
      table.fail(table.has("inner") ? "inner" : "outer",
                 fmt::format("expected inner up to outer, found inner {} and outer {}", spot->innerDegrees,
                             spot->outerDegrees));
    }
  }
  if (auto* sky = std::get_if<EnvironmentLightDescription>(&light.geometry); sky && table.has("image")) {
    const float most = std::numeric_limits<float>::max() / std::max(1.0f, maxComponent(sky->radiance));
    const auto pixels =
        loadPixels((scene.path.parent_path() / sky->image).lexically_normal(), most,
                   "light is finite and not negative, and so is its product with radiance", watch);
    if (!pixels) return table.fail("image", pixels.error().message());
    sky->pixels = *pixels;
  }
  scene.lights.push_back(std::move(light));
}

// ---- the file

/// Gives each [kind.NAME] to `read`, and returns the names.
std::vector<std::string> readNamed(TomlReport& report, const toml::table* tables, const std::string& kind,
                                   const std::function<void(TomlTable&, const std::string&)>& read) {
  std::vector<std::string> names;
  if (!tables) return names;
  TomlTable outer(report, *tables, fmt::format("[{}]", kind));
  for (const auto& [key, node] : *tables) {
    const std::string name(key.str());
    const toml::table* entry = outer.readTable(name);
    if (!entry) continue;
    TomlTable table(report, *entry, fmt::format("[{}.{}]", kind, name));
    read(table, name);
    names.push_back(name);
  }
  return names;
}

SceneDescription readScene(TomlTable& root, const fs::path& path, LoadWatch& watch) {
  SceneDescription scene;
  scene.path = path;
  TomlReport& report = root.report();
  if (root.table().empty()) {
    report.fail({}, "the file says nothing", "a scene starts with version = 1 and a [camera]");
  }

  // What a later version means is unknown: nothing else is worth a message.
  int version = kFormatVersion;
  root.require("version", "version = 1");
  if (root.has("version") && !root.read("version", version, kVersion)) return scene;
  root.read("name", scene.name);
  root.readWord("units", scene.units, unitNames());
  const toml::table* camera = root.readTable("camera", "several cameras are [[cameras]]");
  const std::vector<const toml::table*> cameras = root.readTables("cameras", "write [[cameras]]");
  const toml::table* textures = root.readTable("texture", "a texture is [texture.NAME]");
  const toml::table* materials = root.readTable("material", "a material is [material.NAME]");
  const std::vector<const toml::table*> shapes = root.readTables("shape", "write [[shape]]");
  const std::vector<const toml::table*> lights = root.readTables("light", "write [[light]]");
  std::optional<TomlTable> render = root.subtable("render");
  if (!root.finish()) return scene;

  readCameras(root, camera, cameras, scene);

  const std::vector<std::string> textureNames =
      readNamed(report, textures, "texture",
                [&](TomlTable& table, const std::string& name) { readTexture(table, name, scene, watch); });
  const std::vector<std::string> materialNames =
      readNamed(report, materials, "material", [&](TomlTable& table, const std::string& name) {
        watch.look();
        scene.materials.push_back(readMaterial(table, name, textureNames, scene.warnings));
      });

  ShapeContext context{scene, watch, {}};
  std::map<std::string, Emission> emissions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    watch.look(static_cast<double>(i) / static_cast<double>(shapes.size()));
    TomlTable table(report, *shapes[i], titleOf("shape", i, *shapes[i]));
    readShape(table, materialNames, context);
    if (report.error()) return scene;
    checkLightGroup(table, scene.shapes.back(), scene, emissions);
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    watch.look();
    TomlTable table(report, *lights[i], titleOf("light", i, *lights[i]));
    readLight(table, scene, watch);
  }
  if (render) scene.render = readSettings(*render);
  return scene;
}

}  // namespace

Expected<SceneDescription> parseSceneToml(std::string_view text, const fs::path& path, LoadWatch& watch) {
  SceneDescription scene;
  watch.part(0.1, 0.5);
  const auto read = [&](TomlTable& root) {
    watch.part(0.5, 1.0);
    scene = readScene(root, path, watch);
  };
  const auto done = readToml(text, path, read, watch);
  if (!done) return tl::unexpected(done.error());
  return scene;
}

}  // namespace lightvane
