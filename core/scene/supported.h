#pragma once

#include <filesystem>
#include <string>

#include "core/base/file.h"

namespace lightvane {

/// The files that scenes are made of, by their extension in any case.
enum class SceneFileKind { Toml, Obj, Ply, Gltf, Unknown };

inline SceneFileKind sceneFileKind(const std::filesystem::path& path) {
  const std::string ending = fileEnding(path);
  if (ending == ".toml") return SceneFileKind::Toml;
  if (ending == ".obj") return SceneFileKind::Obj;
  if (ending == ".ply") return SceneFileKind::Ply;
  if (ending == ".gltf" || ending == ".glb") return SceneFileKind::Gltf;
  return SceneFileKind::Unknown;
}

}  // namespace lightvane
