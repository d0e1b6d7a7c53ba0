#include "app/panels/workspace.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
Rgb lightFactor(std::span<const LightSetting> settings, std::size_t light) {
  if (light >= settings.size()) return Rgb(1.0f);
  const bool anySoloed =
      std::any_of(settings.begin(), settings.end(), [](const LightSetting& s) { return s.soloed; });
  const LightSetting& own = settings[light];
  // Solo wins over mute, as on a mixing desk: who solos a light wants to see it.
  if (anySoloed ? !own.soloed : own.muted) return Rgb(0.0f);
  return own.tint * std::exp2(own.stops);
}

}  // namespace lightvane
