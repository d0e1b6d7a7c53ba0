#include "app/frame_identity.h"

#include <algorithm>

#include "app/view.h"

namespace lightvane {

PictureIdentity pictureIdentity(const RenderFrame& frame, const Document& document,
                                const CameraDescription& camera, const PictureLook& look) {
  PictureIdentity identity;
  identity.scenePath = document.path;
  identity.sceneHash = frame.scene->hash;
  identity.sceneSettings = document.description.render;
  identity.parameters = frame.parameters;
  const auto& cameras = document.description.cameras;
  const auto own = std::find_if(cameras.begin(), cameras.end(), [&](const CameraDescription& d) {
    return d.position == camera.position && d.target == camera.target && d.up == camera.up &&
           d.fovYDegrees == camera.fovYDegrees;
  });
  const CameraDescription& base = own != cameras.end() ? *own : cameras.front();
  if (own == cameras.end())
    identity.cameraChanges = {camera.position, camera.target, camera.up, camera.fovYDegrees};
  identity.cameraName = base.name;
  identity.isDefaultCamera = &base == &cameras.front();
  identity.region = frame.region;
  identity.isDefaultSize = frame.region.fullWidth == base.width && frame.region.fullHeight == base.height;
  for (std::size_t light = 0; light < frame.lights.direct.size(); ++light) {
    if (frame.lights.direct[light] != Rgb(1.0f))
      identity.lights.push_back({frame.scene->lightNames[light], frame.lights.direct[light]});
  }
  identity.lockedCache = frame.locked;
  identity.look = look;
  identity.look.exposureStops += static_cast<float>(camera.exposureStops - base.exposureStops);
  identity.passes = frame.statistics.passes;
  identity.complete = frame.complete;
  return identity;
}

CacheIdentity cacheIdentity(const RenderFrame& frame, const Document& document) {
  return vectorsIdentity(document.description, frame.lights.indirect, frame.parameters);
}

}  // namespace lightvane
