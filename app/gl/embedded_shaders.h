#pragma once

#include <span>
#include <string_view>

namespace lightvane {

struct EmbeddedShader {
  std::string_view name;  ///< of the file, "picture.frag"
  std::string_view text;
};

/// The folder `shaders` as it was when the program was built. Defined in a file that shaders/embed.cmake
/// writes.
std::span<const EmbeddedShader> embeddedShaders();

}  // namespace lightvane
