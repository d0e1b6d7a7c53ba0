#pragma once

#include <string>

#include "core/base/error.h"
#include "core/scene/description.h"

namespace lightvane {

/// The scene as a file of its own format (docs/scene-format.md), to lie in the same folder as the scene: what
/// it draws on is named, not copied. Values that are the format's defaults are left out. Read again it is the
/// same scene, of the same hash; names of materials, lights and shapes stay. An error where a mesh is no file
/// that a scene could name: of a glTF file's parts, and of a scene that was made otherwise.
Expected<std::string> sceneToml(const SceneDescription& scene);

/// A camera as the `[camera]` of a scene file, or under another title.
std::string cameraToml(const CameraDescription& camera, const std::string& title = "[camera]");

}  // namespace lightvane
