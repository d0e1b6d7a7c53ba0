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
  const auto own = std::find_if(cameras.begin(), cameras.end(),
                                [&](const CameraDescription& d) { return isSameView(d, camera); });
  const CameraDescription& base = own != cameras.end() ? *own : cameras.front();
  if (own == cameras.end()) identity.cameraChanges = changesTo(camera, base);
  identity.cameraName = base.name;
  identity.isDefaultCamera = &base == &cameras.front();
  identity.region = frame.region;
  identity.isDefaultSize = frame.region.fullWidth == base.width && frame.region.fullHeight == base.height;
  const auto factor = [](const std::vector<Rgb>& factors, std::size_t light) {
    return factors.empty() ? Rgb(1.0f) : factors[light];
  };
  bool isStale = false;
  for (std::size_t light = 0; light < frame.scene->lights.size(); ++light) {
    const Rgb direct = factor(frame.lights.direct, light);
    if (direct != Rgb(1.0f)) identity.lights.push_back({frame.scene->lightNames[light], direct});
    isStale = isStale || direct != factor(frame.lights.indirect, light);
  }
  // Each light is named: where none was, reflected light would be of `lights`.
  for (std::size_t light = 0; isStale && light < frame.scene->lights.size(); ++light)
    identity.indirectLights.push_back({frame.scene->lightNames[light], factor(frame.lights.indirect, light)});
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
