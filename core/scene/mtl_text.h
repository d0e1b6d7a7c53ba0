#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/load_watch.h"

namespace lightvane {

/// An MTL file for tinyobjloader: what we use of it, a statement a line, with all numbers that a statement
/// can have, each in its range. What is dropped or changed is said in `warnings`; an error where a number is
/// none. Throws LoadStopped as `watch` says.
Expected<std::string> checkedMtlText(const std::filesystem::path& path, std::string text,
                                     std::vector<std::string>& warnings, LoadWatch& watch);

}  // namespace lightvane
