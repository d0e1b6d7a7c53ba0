#pragma once

#include <filesystem>
#include <optional>

namespace lightvane {

/// A file of the source tree in which the program was built, such as "assets/scenes/cornell.toml"; nothing
/// where the program lies elsewhere.
std::optional<std::filesystem::path> shippedFile(const std::filesystem::path& name);

}  // namespace lightvane
