#include "core/render/light_slots.h"

#include <algorithm>

#include "core/render/renderer.h"
#include "core/trace/direct_light.h"

namespace lightvane {

LightSlots::LightSlots(const Scene& scene, const Parameters& parameters, std::span<const Rgb> factors)
    : keepsApart_(keepsLightsApart(scene, parameters)),
      slots_(scene.lights.size(), 0),
      lightFactors_(factors.begin(), factors.end()) {
  const std::vector<bool> hasVectors = lightsWithVectors(scene, parameters);
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light)
    (hasVectors[light] ? vectorLights_ : exactLights_).push_back(light);
  isByTile_ = vectorLights_.size() > kMostLightsInFull;
  const auto addSlot = [&](std::uint32_t light) {
    slots_[light] = factors_.size();
    factors_.push_back(factors.empty() ? Rgb(1.0f) : factors[light]);
  };
  if (keepsApart_) {
    for (const std::uint32_t light : exactLights_) addSlot(light);
  } else {
    factors_.emplace_back(1.0f);
  }
  for (const std::uint32_t light : vectorLights_) {
    if (isByTile_) {
      slots_[light] = kNone;
    } else {
      addSlot(light);
    }
  }
}

std::size_t LightSlots::slotOf(const TileAnswers& tile, std::uint32_t light) const {
  if (slots_[light] != kNone) return slots_[light];
  const auto own = std::find(tile.lights.begin(), tile.lights.end(), light);
  if (own == tile.lights.end()) return kNone;
  return sharedCount() + static_cast<std::size_t>(own - tile.lights.begin());
}

std::size_t LightSlots::claim(TileAnswers& tile, std::uint32_t light) const {
  const std::size_t slot = slotOf(tile, light);
  if (slot != kNone) return slot;
  tile.addLight(light);
  return count(tile) - 1;
}

std::size_t LightSlots::slotAt(const TileAnswers& tile, std::uint32_t light, std::size_t point) const {
  const std::size_t own = slotOf(tile, light);
  return own == kNone || tile.statesOf(own)[point] == TileAnswers::Faint ? 0 : own;
}

const Rgb& LightSlots::factorOf(const TileAnswers& tile, std::size_t slot) const {
  static constexpr Rgb kAsItIs(1.0f);
  if (slot < sharedCount()) return factors_[slot];
  return lightFactors_.empty() ? kAsItIs : lightFactors_[tile.lights[slot - sharedCount()]];
}

std::size_t LightSlots::indexOf(std::uint32_t light) const {
  return static_cast<std::size_t>(std::lower_bound(vectorLights_.begin(), vectorLights_.end(), light) -
                                  vectorLights_.begin());
}

bool LightSlots::hasVectors(std::uint32_t light) const {
  return std::binary_search(vectorLights_.begin(), vectorLights_.end(), light);
}

}  // namespace lightvane
