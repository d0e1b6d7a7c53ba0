#pragma once

#include <string>
#include <string_view>

#include "core/scene/load_scene.h"
#include "tests/support/temporary_folder.h"

namespace lightvane::test {

/// The error of text read as "scene.toml", or an empty string where there is none.
inline std::string parseError(std::string_view text) {
  const Expected<SceneDescription> scene = parseSceneToml(text, "scene.toml");
  return scene ? std::string() : scene.error().message();
}

}  // namespace lightvane::test
