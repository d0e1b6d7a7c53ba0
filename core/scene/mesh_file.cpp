#include "core/scene/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace lightvane {

MaterialDescription defaultMaterial(const std::filesystem::path& path) {
  MaterialDescription grey;
  grey.name = fmt::format("{}: no material", path.filename().string());
  grey.diffuse = Rgb(kDefaultReflectance);
  return grey;
}

std::string defaultMaterialWarning(const std::filesystem::path& path) {
  return fmt::format("{}: triangles without a material get a diffuse grey of {:.1f}", path.string(),
                     kDefaultReflectance);
}

void appendMaterials(const MeshFile& mesh, SceneDescription& scene) {
  const std::size_t firstTexture = scene.textures.size();
  scene.textures.insert(scene.textures.end(), mesh.textures.begin(), mesh.textures.end());
  for (MaterialDescription material : mesh.materials) {
    forEachUse(material, [&](TextureUse& use) { use.texture += firstTexture; });
    scene.materials.push_back(std::move(material));
  }
}

namespace {

// Of cameras that are made up: from what they look at.
const Vec3d kTowardsCamera = glm::normalize(Vec3d(0.5, 0.4, 1.0));

Rgb powerOf(const LightGeometryDescription& light) {
  if (const auto* sun = std::get_if<DirectionalLightDescription>(&light)) return sun->irradiance;
  if (const auto* sky = std::get_if<EnvironmentLightDescription>(&light)) return sky->radiance;
  if (const auto* spot = std::get_if<SpotLightDescription>(&light)) return spot->intensity;
  if (const auto* point = std::get_if<PointLightDescription>(&light)) return point->intensity;
  return std::get<VolumicSphereLightDescription>(light).intensity;
}

}  // namespace

void addCamera(SceneDescription& scene, const BoundsD& bounds, const std::string& format) {
  // As far away as the sphere around the bounds needs.
  const double radius = bounds.diagonal() > 0.0 ? 0.5 * bounds.diagonal() : 1.0;
  CameraDescription camera;
  camera.target = bounds.centre();
  camera.position =
      bounds.centre() + kTowardsCamera * (radius / std::sin(0.5 * camera.fovYDegrees * kPiD / 180.0));
  scene.cameras.push_back(camera);
  scene.warnings.push_back(
      fmt::format("{}: {} has no camera: one was placed outside of all it has", scene.path.string(), format));
}

bool hasLight(const SceneDescription& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const MaterialDescription& material) { return material.emits(); }) ||
         std::any_of(scene.lights.begin(), scene.lights.end(),
                     [](const LightDescription& light) { return !isBlack(powerOf(light.geometry)); });
}

SceneDescription sceneOfMesh(const std::filesystem::path& path, MeshFile mesh, const std::string& format,
                             LoadWatch& watch) {
  SceneDescription scene;
  scene.path = path;
  scene.name = path.stem().string();
  appendMaterials(mesh, scene);
  scene.warnings = std::move(mesh.warnings);
  scene.warnings.insert(scene.warnings.end(), mesh.materialWarnings.begin(), mesh.materialWarnings.end());

  BoundsD bounds;
  std::size_t looked = 0;
  for (const glm::uvec3& t : mesh.geometry.triangles) {
    watch.piece(looked++);
    for (int i = 0; i < 3; ++i) bounds.add(mesh.geometry.positions[t[i]]);
  }
  addCamera(scene, bounds, format);
  if (!hasLight(scene)) {
    // A white surface that faces the light has radiance 1.
    DirectionalLightDescription light;
    light.direction = glm::normalize(-kTowardsCamera - Vec3d(0.0, 0.5, 0.0));
    light.irradiance = Rgb(kPi);
    scene.lights.push_back({"added", light});
    scene.warnings.push_back(
        fmt::format("{}: no material emits: a directional light was added", path.string()));
  }

  ShapeDescription shape;
  shape.name = scene.name;
  shape.material = mesh.geometry.triangleMaterials.front();
  MeshDescription placed;
  placed.file = path.filename().string();
  placed.materials.resize(mesh.materials.size());
  std::iota(placed.materials.begin(), placed.materials.end(), 0U);
  placed.geometry = std::make_shared<const MeshGeometry>(std::move(mesh.geometry));
  shape.geometry = std::move(placed);
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace lightvane
