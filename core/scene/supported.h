#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>

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

/// What a message says about something that the scene format has and this version does not.
inline std::string unsupported(std::string_view feature) {
  return fmt::format("{} is not supported by this version of Lightvane", feature);
}

}  // namespace lightvane
