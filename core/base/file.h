#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/base/load_watch.h"

namespace lightvane {

/// What a path's name ends in, in lower case: ".png" of "room/Picture.PNG", empty where there is no dot.
std::string fileEnding(const std::filesystem::path& path);

/// The whole content of a file, or of a pipe until all who write to it have closed it. Errors name the path
/// and what the system said. Throws LoadStopped as `watch` says.
Expected<std::string> readFile(const std::filesystem::path& path, LoadWatch& watch = LoadWatch::none());

/// Writes `content` under a temporary name in the same folder and renames it: readers see the old file or the
/// new one, never half of it. On an error nothing is left behind.
Expected<void> writeFileAtomically(const std::filesystem::path& path, std::string_view content);

/// As writeFileAtomically, for libraries that write a file by its name: `write` gets the temporary name.
Expected<void> replaceFileAtomically(
    const std::filesystem::path& path,
    const std::function<Expected<void>(const std::filesystem::path&)>& write);

}  // namespace lightvane
