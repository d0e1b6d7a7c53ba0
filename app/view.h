#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/command_line.h"
#include "core/io/cache_file.h"
#include "core/render/film.h"

namespace lightvane {

/// What of a scene a picture shows.
struct View {
  Camera camera;
  std::string cameraName;
  bool isDefaultCamera = true;
  bool isDefaultSize = true;
  CameraChanges changes;
  PictureRegion region;
};

/// The scene's camera of this name (its first without one) with its changes, at `size`, and the part of its
/// picture that `crop` leaves. Errors name the nearest camera, and the picture's size where the crop is not
/// within it.
Expected<View> chooseView(const SceneDescription& description, const Scene& scene,
                          const RenderArguments& arguments);

/// The changes that make the camera `from` see what `camera` sees.
CameraChanges changesTo(const CameraDescription& camera, const CameraDescription& from);

/// "camera 'left', 640x480, all of it": equal where views are.
std::string viewText(const View& view);

/// The name of a scene whose lights are multiplied: vectors hold their light. The hash itself where none is.
std::string litHash(const std::string& hash, std::span<const Rgb> factors);

/// What vectors belong to that were computed on this scene with its lights multiplied by these factors.
CacheIdentity vectorsIdentity(const SceneDescription& description, std::span<const Rgb> factors,
                              const Parameters& parameters);

/// A factor for each light of the scene; empty where none is changed. Errors name the option and the nearest
/// light.
Expected<std::vector<Rgb>> lightFactors(const Scene& scene, std::span<const LightChange> changes,
                                        const std::string& option);

}  // namespace lightvane
