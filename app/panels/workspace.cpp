#include "app/panels/workspace.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

bool sameCamera(const Camera& a, const Camera& b) {
  return a.position == b.position && a.right == b.right && a.up == b.up && a.forward == b.forward &&
         a.tanHalfFovY == b.tanHalfFovY && a.width == b.width && a.height == b.height &&
         a.exposureStops == b.exposureStops;
}

}  // namespace

Rgb lightFactor(std::span<const LightSetting> settings, std::size_t light) {
  if (light >= settings.size()) return Rgb(1.0f);
  const bool anySoloed =
      std::any_of(settings.begin(), settings.end(), [](const LightSetting& s) { return s.soloed; });
  const LightSetting& own = settings[light];
  // Solo wins over mute, as on a mixing desk: who solos a light wants to see it.
  if (anySoloed ? !own.soloed : own.muted) return Rgb(0.0f);
  return own.tint * std::exp2(own.stops);
}

bool Setup::operator==(const Setup& other) const {
  return parameters == other.parameters && sameCamera(camera, other.camera) && lights == other.lights &&
         cacheLocked == other.cacheLocked && threads == other.threads &&
         memoryMegabytes == other.memoryMegabytes;
}

}  // namespace lightvane
