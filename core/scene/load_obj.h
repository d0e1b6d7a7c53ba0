#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/description.h"

namespace lightvane {

/// A Wavefront OBJ file as triangles, with what it says about materials.
struct ObjMesh {
  /// `triangleMaterials` index `materials` below.
  MeshDescription geometry;
  /// Those of the MTL files that a triangle uses, Kd as diffuse and Ke as emission; a grey one for triangles
  /// that name none.
  std::vector<MaterialDescription> materials;
  std::vector<std::string> warnings;          ///< what the geometry carries and we do not use
  std::vector<std::string> materialWarnings;  ///< the same of materials
};

/// Reads an OBJ file. Positions are float by the format. Polygons are cut into triangles; corners without a
/// normal in a file that has some get their face's. Errors name file, line and column; nothing malformed is
/// read as zero.
Expected<ObjMesh> loadObj(const std::filesystem::path& path);

/// An OBJ file as a scene of its own: one mesh with its own materials, a camera that sees all of it, and,
/// where no material emits, a directional light from behind the camera. Warnings say what was made up.
Expected<SceneDescription> loadObjScene(const std::filesystem::path& path);

}  // namespace lightvane
