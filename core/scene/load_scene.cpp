#include "core/scene/load_scene.h"

#include <new>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/scene/load_gltf.h"
#include "core/scene/load_obj.h"
#include "core/scene/load_ply.h"
#include "core/scene/supported.h"

namespace lightvane {

namespace {

Expected<SceneDescription> loadAny(const std::filesystem::path& path, LoadWatch& watch) {
  switch (sceneFileKind(path)) {
    case SceneFileKind::Toml: {
      const LoadStage stage(watch, "reading " + path.filename().string());
      watch.part(0.0, 0.1);
      const Expected<std::string> text = readFile(path, watch);
      if (!text) return tl::unexpected(text.error());
      return parseSceneToml(*text, path, watch);
    }
    case SceneFileKind::Obj:
      return loadObjScene(path, watch);
    case SceneFileKind::Ply:
      return loadPlyScene(path, watch);
    case SceneFileKind::Gltf:
      return loadGltfScene(path, watch);
    case SceneFileKind::Unknown:
      break;
  }
  return makeError(path.string(), fmt::format("expected a .toml, .obj, .ply, .gltf or .glb file, found {}",
                                              foundFile(path)));
}

}  // namespace

Expected<SceneDescription> loadScene(const std::filesystem::path& path, LoadWatch& watch) {
  try {
    return untilStopped([&] { return loadAny(path, watch); });
  } catch (const std::bad_alloc&) {
    return makeError(path.string(), "takes more memory than there is");
  }
}

std::string foundFile(const std::filesystem::path& path) {
  std::error_code unknown;
  if (std::filesystem::is_directory(path, unknown)) return "a folder";
  const std::string extension = path.extension().string();
  return extension.empty() ? "a name without an extension" : extension;
}

}  // namespace lightvane
