#include "app/view.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

#include "app/picture_metadata.h"
#include "core/base/text.h"

namespace lightvane {
namespace {

/// Errors name the option that does not go with the camera.
Expected<CameraDescription> changedCamera(CameraDescription camera, const CameraChanges& changes) {
  camera.position = changes.position.value_or(camera.position);
  camera.target = changes.target.value_or(camera.target);
  camera.up = changes.up.value_or(camera.up);
  if (changes.fovYDegrees) {
    camera.projection = Projection::Perspective;
    camera.fovYDegrees = *changes.fovYDegrees;
  }
  if (changes.orthographicHeight) {
    camera.projection = Projection::Orthographic;
    camera.orthographicHeight = *changes.orthographicHeight;
    camera.lensRadius = 0.0;
    camera.focusDistance.reset();
  }
  const bool isOrthographic = camera.projection == Projection::Orthographic;
  if (isOrthographic && changes.lensRadius.value_or(0.0) > 0.0)
    return makeError("--lens-radius", "an orthographic camera has no lens", "--fov-y makes it perspective");
  camera.lensRadius = changes.lensRadius.value_or(camera.lensRadius);
  if (changes.focusDistance && !(camera.lensRadius > 0.0)) {
    return makeError("--focus-distance", "the camera has no lens: all is sharp",
                     isOrthographic ? "" : "add --lens-radius");
  }
  if (changes.focusDistance) camera.focusDistance = changes.focusDistance;
  return camera;
}

}  // namespace

CameraChanges changesTo(const CameraDescription& camera, const CameraDescription& from) {
  CameraChanges changes;
  changes.position = camera.position;
  changes.target = camera.target;
  changes.up = camera.up;
  if (camera.projection == Projection::Orthographic) {
    changes.orthographicHeight = camera.orthographicHeight;
    return changes;
  }
  changes.fovYDegrees = camera.fovYDegrees;
  if (camera.lensRadius > 0.0 || from.lensRadius > 0.0) changes.lensRadius = camera.lensRadius;
  if (camera.lensRadius > 0.0) changes.focusDistance = camera.resolvedFocusDistance();
  return changes;
}

Expected<View> chooseView(const SceneDescription& description, const Scene& scene,
                          const RenderArguments& arguments) {
  const auto& [cameraName, size, crop] = std::tie(arguments.camera, arguments.size, arguments.crop);
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
  view.changes = arguments.cameraChanges;
  if (view.changes.any()) {
    const auto changed = changedCamera(description.cameras[index], view.changes);
    if (!changed) return tl::unexpected(changed.error());
    std::string options;
    for (const auto& [option, value] : cameraOptions(view.changes))
      options += (options.empty() ? "" : ", ") + option;
    const auto camera = compileCamera(scene.normalisation, *changed, options);
    if (!camera) return tl::unexpected(camera.error());
    view.camera = *camera;
  }
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
  std::string camera = view.cameraName.empty() ? "camera" : fmt::format("camera '{}'", view.cameraName);
  for (const auto& [option, value] : cameraOptions(view.changes))
    camera += fmt::format(" {} {}", option, value);
  return fmt::format("{}, {}x{}, pixels {},{},{},{}", camera, region.fullWidth, region.fullHeight, region.x,
                     region.y, region.width, region.height);
}

std::string litHash(const std::string& hash, std::span<const Rgb> factors) {
  std::string text = hash;
  for (const Rgb& f : factors) text += fmt::format(" {},{},{}", f.r, f.g, f.b);
  return text;
}

CacheIdentity vectorsIdentity(const SceneDescription& description, std::span<const Rgb> factors,
                              const Parameters& parameters) {
  return {litHash(sceneHash(description, HashScope::Lighting), factors), parametersAsText(parameters), ""};
}

Expected<std::vector<Rgb>> lightFactors(const Scene& scene, std::span<const LightChange> changes,
                                        const std::string& option) {
  std::vector<Rgb> factors;
  for (const LightChange& change : changes) {
    const auto found = std::find(scene.lightNames.begin(), scene.lightNames.end(), change.light);
    if (found == scene.lightNames.end()) {
      const std::string nearest = suggestion(change.light, scene.lightNames);
      return makeError(option, fmt::format("the scene has no light '{}'", change.light),
                       !nearest.empty()           ? nearest
                       : scene.lightNames.empty() ? "it has none"
                                                  : "it has " + listWords(scene.lightNames));
    }
    factors.resize(scene.lights.size(), Rgb(1.0f));
    factors[static_cast<std::size_t>(found - scene.lightNames.begin())] *= change.factor;
  }
  if (std::all_of(factors.begin(), factors.end(), [](const Rgb& factor) { return factor == Rgb(1.0f); }))
    return {};
  return factors;
}

}  // namespace lightvane
