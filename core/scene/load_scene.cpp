#include "core/scene/load_scene.h"

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/scene/load_gltf.h"
#include "core/scene/load_obj.h"
#include "core/scene/load_ply.h"
#include "core/scene/supported.h"

namespace lightvane {

Expected<SceneDescription> loadScene(const std::filesystem::path& path) {
  switch (sceneFileKind(path)) {
    case SceneFileKind::Toml:
      return readFile(path).and_then([&](const std::string& text) { return parseSceneToml(text, path); });
    case SceneFileKind::Obj:
      return loadObjScene(path);
    case SceneFileKind::Ply:
      return loadPlyScene(path);
    case SceneFileKind::Gltf:
      return loadGltfScene(path);
    case SceneFileKind::Unknown:
      break;
  }
  return makeError(path.string(), fmt::format("expected a .toml, .obj, .ply, .gltf or .glb file, found {}",
                                              foundFile(path)));
}

std::string foundFile(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return "a folder";
  const std::string extension = path.extension().string();
  return extension.empty() ? "a name without an extension" : extension;
}

}  // namespace lightvane
