#pragma once

#include <optional>
#include <string>

#include "app/command_line.h"
#include "core/render/film.h"

namespace lightvane {

/// What of a scene a picture shows.
struct View {
  Camera camera;
  std::string cameraName;
  bool isDefaultCamera = true;
  bool isDefaultSize = true;
  PictureRegion region;
};

/// The scene's camera of this name (its first without one) at `size`, and the part of its picture that `crop`
/// leaves. Errors name the nearest camera, and the picture's size where the crop is not within it.
Expected<View> chooseView(const Scene& scene, const std::optional<std::string>& cameraName,
                          const std::optional<PictureSize>& size, const std::optional<PictureCrop>& crop);

/// "camera 'left', 640x480, all of it": equal where views are.
std::string viewText(const View& view);

}  // namespace lightvane
