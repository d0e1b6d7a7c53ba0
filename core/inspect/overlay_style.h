#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/parameter.h"
#include "core/inspect/record_ref.h"

namespace lightvane {

// What of the cache is drawn over the picture, and how: choices of the display, apart from the method.

/// When a vector was computed: its pass, then its number among those that the pass asked for.
struct BirthTime {
  std::uint32_t pass = 0;
  std::uint32_t order = 0;
  auto operator<=>(const BirthTime&) const = default;
};

/// What an ILV's colour says.
enum class VectorColoring : std::uint8_t {
  Key,       ///< what it serves: diffuse surfaces, or one BRDF
  Pass,      ///< in which pass it was computed
  Age,       ///< its number: dark is old
  Cost,      ///< rays that it took
  Energy,    ///< irradiance
  Distance,  ///< harmonic mean of the distances to what it saw
};
inline constexpr std::array kVectorColoringNames{
    Choice{VectorColoring::Key, "surface"},   Choice{VectorColoring::Pass, "pass"},
    Choice{VectorColoring::Age, "age"},       Choice{VectorColoring::Cost, "cost"},
    Choice{VectorColoring::Energy, "energy"}, Choice{VectorColoring::Distance, "distance"}};

/// Which vectors a change makes untrue; it is always all of a kind.
struct StaleKinds {
  bool indirect = false;
  bool direct = false;

  bool operator==(const StaleKinds&) const = default;
};

/// Of one kind of overlay.
struct OverlayLook {
  bool shown = false;
  float size = 1.0f;     ///< a factor for markers, line widths and glyphs; zones are at their true size
  float opacity = 1.0f;  ///< 0 to 1
};

struct OverlayStyle {
  OverlayLook directMarkers{.shown = true};
  OverlayLook directGlyphs;  ///< direction and energy of DLVs
  OverlayLook indirectMarkers{.shown = true};
  OverlayLook zones{.shown = true, .opacity = 0.35f};  ///< where ILVs may be used
  OverlayLook directZones{.opacity = 0.25f};           ///< r_max around DLVs
  OverlayLook gradients{.shown = true};                ///< of ILVs
  OverlayLook mirrorImages;                            ///< of the markers that are shown, in planar mirrors
  VectorColoring coloring = VectorColoring::Key;
  std::size_t mostShown = 2'000;   ///< of each kind: beyond it every second, fourth, ... is shown
  bool thinZones = false;          ///< of zones that cover each other's centres, the largest alone
  std::optional<BirthTime> until;  ///< vectors that were computed later are hidden
  /// Shown whatever the rest says (but for `until`); few of them with zone, gradient or cone, too.
  std::vector<RecordRef> selected;
  std::vector<RecordRef> pinned;  ///< drawn with a frame about their markers
  StaleKinds stale;               ///< crossed out
};

}  // namespace lightvane
