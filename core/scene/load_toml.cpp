#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <type_traits>

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/base/text.h"
#include "core/image/image_file.h"
#include "core/scene/load_obj.h"
#include "core/scene/load_ply.h"
#include "core/scene/load_scene.h"
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

// ---- materials

std::vector<SchlickLayerDescription> readLayers(TomlTable& material) {
  std::vector<SchlickLayerDescription> layers;
  for (const toml::table* entry : material.readTables("layers")) {
    TomlTable table(material.report(), *entry,
                    fmt::format("layer {} of {}", layers.size() + 1, material.title()));
    SchlickLayerDescription& layer = layers.emplace_back();
    table.read("color", layer.color, kUnitInterval);
    table.require("color", "its reflectance seen from above, [r, g, b]");
    table.read("roughness", layer.roughness, kUnitInterval);
    table.read("isotropy", layer.isotropy, kUnitInterval);
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
                                 std::vector<std::string>& warnings) {
  MaterialDescription material;
  material.name = name;
  table.read("diffuse", material.diffuse, kUnitInterval);
  table.read("mirror", material.mirror, kUnitInterval);
  table.read("transmission", material.transmission, kUnitInterval);
  table.read("ior", material.ior, kIndexOfRefraction);
  material.layers = readLayers(table);
  table.read("emission", material.emission, kLightPower);
  table.read("two_sided", material.twoSided);
  if (table.has("tangent")) table.readDirection("tangent", material.tangent.emplace(1.0, 0.0, 0.0));
  if (!table.finish()) return material;

  const auto refuseBeside = [&](std::string_view key, std::string_view other) {
    if (!other.empty())
      table.fail(key, fmt::format("cannot stand beside {}", other), "make it two materials");
  };
  if (table.has("transmission"))
    refuseBeside("transmission", firstPresent(table, {"diffuse", "mirror", "layers"}));
  if (table.has("layers")) refuseBeside("layers", firstPresent(table, {"diffuse", "mirror"}));
  if (table.has("ior") && !table.has("transmission")) {
    table.fail("ior", "an index of refraction without transmission", "add transmission = [1, 1, 1]");
  }
  if (table.has("two_sided") && !material.emits()) {
    table.fail("two_sided", "it is about emission, and this material emits nothing");
  }
  const float mostReflected = maxComponent(material.diffuse + material.mirror);
  if (mostReflected > 1.0f) {
    warnings.push_back(fmt::format("{}: {}: diffuse and mirror together reflect more than arrives ({:.3g})",
                                   table.report().place(table.table()), table.title(), mostReflected));
  }
  return material;
}

// ---- shapes

/// What shapes draw on beside their own tables.
struct ShapeContext {
  SceneDescription& scene;
  /// Mesh files that were read, by path, with the index of their first material in the scene, once a shape
  /// uses it.
  struct LoadedMesh {
    MeshFile mesh;
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
  table.require("file", "the name of an .obj or .ply file, relative to this file");
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
      break;
    case SceneFileKind::NotYet:
      return table.refuseUnsupported(
          "file", fmt::format("a mesh in a {} file", fs::path(mesh.file).extension().string()));
    case SceneFileKind::Toml:
    case SceneFileKind::Unknown:
      return table.fail("file",
                        fmt::format("expected the name of an .obj or .ply file, found \"{}\"", mesh.file));
  }
  SceneDescription& scene = context.scene;
  const fs::path path = (scene.path.parent_path() / mesh.file).lexically_normal();
  auto found = context.meshes.find(path);
  if (found == context.meshes.end()) {
    Expected<MeshFile> loaded = kind == SceneFileKind::Ply ? loadPly(path) : loadObj(path);
    if (!loaded) return table.fail("file", loaded.error().message());
    scene.warnings.insert(scene.warnings.end(), loaded->warnings.begin(), loaded->warnings.end());
    found = context.meshes.emplace(path, ShapeContext::LoadedMesh{std::move(*loaded), {}}).first;
  }
  auto& [obj, firstMaterial] = found->second;
  const std::string name = mesh.file;
  mesh = obj.geometry;
  mesh.file = name;
  if (table.has("material")) {
    mesh.triangleMaterials.clear();
    return;
  }
  if (!firstMaterial) {
    firstMaterial = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.insert(scene.materials.end(), obj.materials.begin(), obj.materials.end());
    scene.warnings.insert(scene.warnings.end(), obj.materialWarnings.begin(), obj.materialWarnings.end());
  }
  for (std::uint32_t& index : mesh.triangleMaterials) index += *firstMaterial;
  material = mesh.triangleMaterials.front();
}

/// The index of the material that the shape names; 0 where it names none.
std::size_t readMaterialName(TomlTable& table, const std::vector<std::string>& names) {
  std::string name;
  if (!table.read("material", name)) return 0;
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  std::string hint = suggestion(name, names);
  if (hint.empty())
    hint = names.empty() ? "the file has no [material.NAME]" : "there are " + listWords(names);
  table.fail("material", fmt::format("there is no material \"{}\"", name), hint);
  return 0;
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

/// The shapes of one light source send out the same radiance, since they are sampled as one.
void checkLightGroup(TomlTable& table, const ShapeDescription& shape, const SceneDescription& scene,
                     std::map<std::string, std::pair<Rgb, bool>>& emissions) {
  if (shape.light.empty()) return;
  std::vector<std::uint32_t> used = {static_cast<std::uint32_t>(shape.material)};
  if (const auto* mesh = std::get_if<MeshDescription>(&shape.geometry);
      mesh && !mesh->triangleMaterials.empty()) {
    used = mesh->triangleMaterials;
  }
  bool emits = false;
  for (const std::uint32_t index : used) {
    const MaterialDescription& material = scene.materials[index];
    if (!material.emits()) continue;
    emits = true;
    const std::pair<Rgb, bool> emission = {material.emission, material.twoSided};
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

/// Reads the picture that the light names.
void loadSky(TomlTable& table, const fs::path& folder, EnvironmentLightDescription& sky) {
  if (!table.has("image")) return;
  const Expected<LayeredImage> picture = readImage((folder / sky.image).lexically_normal());
  if (!picture) return table.fail("image", picture.error().message());
  if (!picture->hasRgb()) return table.fail("image", fmt::format("{} has no R, G and B", sky.image));
  auto pixels = std::make_shared<ImageRgb>(picture->rgb());
  for (int y = 0; y < pixels->height(); ++y) {
    for (int x = 0; x < pixels->width(); ++x) {
      const Rgb& c = pixels->at(x, y);
      const bool isLight = c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f && std::isfinite(maxComponent(c));
      if (isLight) continue;
      return table.fail(
          "image", fmt::format("pixel ({}, {}) of {} is [{}, {}, {}]: light is finite and not negative", x, y,
                               sky.image, c.r, c.g, c.b));
    }
  }
  sky.pixels = std::move(pixels);
}

void readLight(TomlTable& table, SceneDescription& scene) {
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
  if (auto* sky = std::get_if<EnvironmentLightDescription>(&light.geometry))
    loadSky(table, scene.path.parent_path(), *sky);
  scene.lights.push_back(std::move(light));
}

// ---- the file

SceneDescription readScene(TomlTable& root, const fs::path& path) {
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
  const toml::table* materials = root.readTable("material", "a material is [material.NAME]");
  const std::vector<const toml::table*> shapes = root.readTables("shape", "write [[shape]]");
  const std::vector<const toml::table*> lights = root.readTables("light", "write [[light]]");
  std::optional<TomlTable> render = root.subtable("render");
  root.refuseUnsupported("texture", "a texture");
  if (!root.finish()) return scene;

  readCameras(root, camera, cameras, scene);

  std::vector<std::string> materialNames;
  if (materials) {
    TomlTable table(report, *materials, "[material]");
    for (const auto& [key, node] : *materials) {
      const std::string name(key.str());
      const toml::table* entry = table.readTable(name);
      if (!entry) continue;
      TomlTable material(report, *entry, fmt::format("[material.{}]", name));
      scene.materials.push_back(readMaterial(material, name, scene.warnings));
      materialNames.push_back(name);
    }
  }

  ShapeContext context{scene, {}};
  std::map<std::string, std::pair<Rgb, bool>> emissions;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    TomlTable table(report, *shapes[i], titleOf("shape", i, *shapes[i]));
    readShape(table, materialNames, context);
    if (report.error()) return scene;
    checkLightGroup(table, scene.shapes.back(), scene, emissions);
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    TomlTable table(report, *lights[i], titleOf("light", i, *lights[i]));
    readLight(table, scene);
  }
  if (render) scene.render = readSettings(*render);
  return scene;
}

}  // namespace

Expected<SceneDescription> parseSceneToml(std::string_view text, const fs::path& path) {
  SceneDescription scene;
  const auto done = readToml(text, path, [&](TomlTable& root) { scene = readScene(root, path); });
  if (!done) return tl::unexpected(done.error());
  return scene;
}

}  // namespace lightvane
