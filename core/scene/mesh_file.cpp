#include "core/scene/mesh_file.h"

#include <algorithm>
#include <cmath>

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
    forEachUse(material.textures, [&](TextureUse& use) { use.texture += firstTexture; });
    scene.materials.push_back(std::move(material));
  }
}

SceneDescription sceneOfMesh(const std::filesystem::path& path, MeshFile mesh, const std::string& format) {
  SceneDescription scene;
  scene.path = path;
  scene.name = path.stem().string();
  appendMaterials(mesh, scene);
  scene.warnings = std::move(mesh.warnings);
  scene.warnings.insert(scene.warnings.end(), mesh.materialWarnings.begin(), mesh.materialWarnings.end());

  // From the front, the right and above, as far away as the sphere around the bounds needs.
  BoundsD bounds;
  for (const glm::uvec3& t : mesh.geometry.triangles) {
    for (int i = 0; i < 3; ++i) bounds.add(mesh.geometry.positions[t[i]]);
  }
  const Vec3d towardsCamera = glm::normalize(Vec3d(0.5, 0.4, 1.0));
  const double radius = bounds.diagonal() > 0.0 ? 0.5 * bounds.diagonal() : 1.0;
  CameraDescription camera;
  camera.target = bounds.centre();
  camera.position =
      bounds.centre() + towardsCamera * (radius / std::sin(0.5 * camera.fovYDegrees * kPiD / 180.0));
  scene.cameras.push_back(camera);
  scene.warnings.push_back(
      fmt::format("{}: {} has no camera: one was placed so that all can be seen", path.string(), format));

  const bool emits = std::any_of(scene.materials.begin(), scene.materials.end(),
                                 [](const MaterialDescription& material) { return material.emits(); });
  if (!emits) {
    // A white surface that faces the light has radiance 1.
    DirectionalLightDescription light;
    light.direction = glm::normalize(-towardsCamera - Vec3d(0.0, 0.5, 0.0));
    light.irradiance = Rgb(kPi);
    scene.lights.push_back({"added", light});
    scene.warnings.push_back(
        fmt::format("{}: no material emits: a directional light was added", path.string()));
  }

  ShapeDescription shape;
  shape.name = scene.name;
  shape.material = mesh.geometry.triangleMaterials.front();
  shape.geometry = std::move(mesh.geometry);
  scene.shapes.push_back(std::move(shape));
  return scene;
}

}  // namespace lightvane
