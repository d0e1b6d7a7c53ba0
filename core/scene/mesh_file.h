#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/scene/description.h"

namespace lightvane {

/// What a surface without a material reflects; light enough to show shading, dark enough to show
/// interreflection.
inline constexpr float kDefaultReflectance = 0.7f;

/// A file of triangles, with what it says about materials.
struct MeshFile {
  /// `triangleMaterials` index `materials` below.
  MeshGeometry geometry;
  std::vector<MaterialDescription> materials;  ///< those that a triangle uses, at least one
  std::vector<TextureDescription> textures;    ///< of these
  std::vector<std::string> warnings;           ///< what the geometry carries and we do not use
  std::vector<std::string> materialWarnings;   ///< the same of materials
};

/// The grey of triangles without a material, and the sentence that says so.
MaterialDescription defaultMaterial(const std::filesystem::path& path);
std::string defaultMaterialWarning(const std::filesystem::path& path);

/// Adds the file's materials, with their textures, to the scene's.
void appendMaterials(const MeshFile& mesh, SceneDescription& scene);

/// Adds a camera from the front, the right and above that sees all within the bounds, and a warning that says
/// so; `format` is what it calls the file: "an OBJ file".
void addCamera(SceneDescription& scene, const BoundsD& bounds, const std::string& format);

/// Whether a material emits or there is a light that is not black.
bool hasLight(const SceneDescription& scene);

/// A file of triangles as a scene of its own: one mesh with its own materials, a camera that sees all of it,
/// and, where no material emits, a directional light from behind the camera. Warnings say what was made up;
/// `format` is what they call the file: "an OBJ file". Throws LoadStopped as `watch` says.
SceneDescription sceneOfMesh(const std::filesystem::path& path, MeshFile mesh, const std::string& format,
                             LoadWatch& watch);

}  // namespace lightvane
