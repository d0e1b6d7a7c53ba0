#include "app/view.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/text.h"

namespace lightvane {

Expected<View> chooseView(const Scene& scene, const std::optional<std::string>& cameraName,
                          const std::optional<PictureSize>& size, const std::optional<PictureCrop>& crop) {
  std::size_t index = 0;
  if (cameraName) {
    const auto found = std::find(scene.cameraNames.begin(), scene.cameraNames.end(), *cameraName);
    if (found == scene.cameraNames.end()) {
      std::vector<std::string> names = scene.cameraNames;
      std::erase(names, "");
      const std::string nearest = suggestion(*cameraName, names);
      return makeError("--camera", fmt::format("the scene has no camera '{}'", *cameraName),
                       !nearest.empty() ? nearest
                       : names.empty()  ? "its camera has no name: leave --camera out"
                                        : "it has " + listWords(names));
    }
    index = static_cast<std::size_t>(found - scene.cameraNames.begin());
  }
  View view;
  view.camera = scene.cameras[index];
  view.cameraName = scene.cameraNames[index];
  view.isDefaultCamera = index == 0;
  if (size) {
    view.isDefaultSize = size->width == view.camera.width && size->height == view.camera.height;
    view.camera.width = size->width;
    view.camera.height = size->height;
  }
  view.region = {view.camera.width, view.camera.height, 0, 0, view.camera.width, view.camera.height};
  if (crop) {
    if (crop->width > view.camera.width - crop->x || crop->height > view.camera.height - crop->y) {
      return makeError(
          "--crop",
          fmt::format("{},{},{},{} reaches out of the picture", crop->x, crop->y, crop->width, crop->height),
          fmt::format("the picture has {}x{} pixels", view.camera.width, view.camera.height));
    }
    view.region.x = crop->x;
    view.region.y = crop->y;
    view.region.width = crop->width;
    view.region.height = crop->height;
  }
  return view;
}

std::string viewText(const View& view) {
  const PictureRegion& region = view.region;
  const std::string camera = view.cameraName.empty() ? "camera" : fmt::format("camera '{}'", view.cameraName);
  return fmt::format("{}, {}x{}, pixels {},{},{},{}", camera, region.fullWidth, region.fullHeight, region.x,
                     region.y, region.width, region.height);
}

}  // namespace lightvane
