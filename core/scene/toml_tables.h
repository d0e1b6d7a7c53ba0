#pragma once

#include <vector>

#include "core/scene/description.h"
#include "core/scene/toml_reader.h"

namespace lightvane {

// Tables that scene files have in common with others.

/// A `[camera]` or an entry of `[[cameras]]`; what is left out has the scene format's default.
CameraDescription readCamera(TomlTable& table);

/// The settings of a table such as `[render]`, in the order of the file. Nested tables become dotted keys.
std::vector<RenderSetting> readSettings(TomlTable& table);

}  // namespace lightvane
