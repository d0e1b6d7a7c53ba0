#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/scene/description.h"

namespace lightvane {

/// Reads a scene by its extension: `.toml` (docs/scene-format.md), `.obj`, `.ply`, `.gltf` or
/// `.glb`. Errors name file, line, column and key, what was expected, what was found, and the nearest known
/// key. Where `watch` stops it, the error has isStop, within a few milliseconds but for what libraries read
/// at one go (docs/performance.md).
Expected<SceneDescription> loadScene(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// What a message finds at a path in place of a file that could be read: ".stl", "a folder", "a name without
/// an extension".
std::string foundFile(const std::filesystem::path& path);

/// The TOML reader alone; `path` is what messages name and what relative file names are relative to. Throws
/// LoadStopped as `watch` says.
Expected<SceneDescription> parseSceneToml(std::string_view text, const std::filesystem::path& path,
                                          LoadWatch& watch = LoadWatch::none());

}  // namespace lightvane
