#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace lightvane {

/// The files that scenes are made of, by their extension in any case.
enum class SceneFileKind { Toml, Obj, NotYet, Unknown };

inline SceneFileKind sceneFileKind(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".toml") return SceneFileKind::Toml;
  if (extension == ".obj") return SceneFileKind::Obj;
  if (extension == ".ply" || extension == ".gltf" || extension == ".glb") return SceneFileKind::NotYet;
  return SceneFileKind::Unknown;
}

/// What a message says about something that the scene format has and this version does not.
inline std::string unsupported(std::string_view feature) {
  return fmt::format("{} is not supported by this version of Lightvane", feature);
}

}  // namespace lightvane
