#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace lightvane {

/// A file of the source tree in which the program was built, such as "assets/scenes/cornell.toml"; nothing
/// where the program lies elsewhere.
std::optional<std::filesystem::path> shippedFile(const std::filesystem::path& name);
/// The scenes of that source tree, by their names; none where the program lies elsewhere.
std::vector<std::filesystem::path> shippedScenes();

}  // namespace lightvane
