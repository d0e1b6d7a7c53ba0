#include "app/panels/overlay_settings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/base/number_text.h"

namespace lightvane {
namespace {

/// The look of each kind, in the order of OverlayKind.
std::array<OverlayLook*, kOverlayKinds> looksOf(OverlayStyle& style) {
  return {&style.indirectMarkers, &style.zones,        &style.gradients,   &style.directMarkers,
          &style.directZones,     &style.directGlyphs, &style.mirrorImages};
}

}  // namespace

std::array<OverlaySwitch, kOverlayKinds> usualLayers() {
  OverlayStyle style;
  std::array<OverlaySwitch, kOverlayKinds> layers;
  const auto looks = looksOf(style);
  for (std::size_t i = 0; i < kOverlayKinds; ++i) {
    layers[i] = {looks[i]->shown, looks[i]->size, looks[i]->opacity};
  }
  return layers;
}

std::uint64_t momentsOf(std::span<const std::uint32_t> passLengths) {
  return std::accumulate(passLengths.begin(), passLengths.end(), std::uint64_t{0});
}

BirthTime birthAt(std::span<const std::uint32_t> passLengths, std::uint64_t moment) {
  std::uint32_t pass = 0;
  std::uint64_t before = 0;
  while (pass + 1 < passLengths.size() && before + passLengths[pass] < moment) before += passLengths[pass++];
  // Orders count from 0: at the first moment of a pass its first vectors are seen.
  const std::uint64_t within = moment > before ? moment - before - 1 : 0;
  return {pass, static_cast<std::uint32_t>(within)};
}

std::string momentText(std::span<const std::uint32_t> passLengths, std::uint64_t moment) {
  if (passLengths.empty()) return {};
  const BirthTime birth = birthAt(passLengths, moment);
  const std::string pass = birth.pass == 0 ? "seed" : fmt::format("pass {}", birth.pass);
  return fmt::format("{}, {} of {}", pass, countText(birth.order + 1), countText(passLengths[birth.pass]));
}

OverlaySettings fittedTo(OverlaySettings settings, double areaInPoints) {
  // Beyond, more vectors would lie outside of the window than in it.
  constexpr double kLargest = 5.0;
  const double doublings = std::round(std::log2(std::max(areaInPoints, 1.0) / kUsualArea));
  const double most = settings.mostRecords * std::exp2(std::min(doublings, kLargest));
  settings.mostRecords = static_cast<int>(std::clamp(most, 1.0, 1e9));
  return settings;
}

OverlayStyle overlayStyle(const OverlaySettings& settings, std::span<const std::uint32_t> passLengths,
                          const std::vector<RecordRef>& selected) {
  OverlayStyle style;
  const auto looks = looksOf(style);
  for (std::size_t i = 0; i < kOverlayKinds; ++i) {
    const OverlaySwitch& layer = settings.layers[i];
    *looks[i] = {.shown = settings.shown && layer.shown, .size = layer.size, .opacity = layer.opacity};
  }
  style.coloring = settings.coloring;
  style.mostShown = static_cast<std::size_t>(settings.mostRecords);
  if (!settings.growth.all && !passLengths.empty())
    style.until = birthAt(passLengths, settings.growth.moment);
  style.selected = selected;
  return style;
}

}  // namespace lightvane
