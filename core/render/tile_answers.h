#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/color.h"

namespace lightvane {

/// What is known of the light at the visible points of one tile. Arrays run over VisibleTile::points; slots
/// are those of LightSlots, keys those of indirectKeys.
struct TileAnswers {
  /// Computed: the point has a vector of its own. Sampled: computed for it alone, and kept by no vector.
  /// Faint: of so little that its vectors are not asked; sampled by lot with others of that kind, and kept in
  /// the first slot with them.
  enum LightState : std::uint8_t { Unknown, Interpolated, Computed, Sampled, Faint };

  /// Why a point's direct light was computed in full: it was of the seed, its DLVs were too few or too
  /// unlike, or that was when the cache was filled for another rendering.
  enum LightReason : std::uint8_t { NotInFull, Seed, Earlier, TooFew, TooUnlike };

  std::vector<std::uint8_t> looked;   ///< a whole pass has looked at the point
  std::vector<std::uint8_t> sampled;  ///< direct light was sampled: `mirrored`, and all that no vectors give
  std::vector<std::uint8_t> satisfied;    ///< enough vectors were valid, or its own was computed
  std::vector<std::uint8_t> answered;     ///< at least one vector was valid, for every key of its BRDF
  std::vector<std::uint8_t> fullDlv;      ///< lights with vectors that were computed here
  std::vector<Rgb> lightDirect;           ///< [slot * points + point]: radiance towards the viewer
  std::vector<std::uint8_t> lightState;   ///< likewise: LightState, of lights with vectors
  std::vector<std::uint8_t> lightReason;  ///< likewise: LightReason
  std::vector<Rgb> mirrored;              ///< radiance towards the viewer from lights seen in planar mirrors
  std::vector<Rgb> indirect;              ///< [key * points + point]: radiance from vectors
  std::vector<std::uint8_t> own;          ///< likewise: the point's own vector was computed
  std::vector<std::uint16_t> ilvCount;    ///< ILVs that answered the first key
  std::vector<std::uint32_t> nearest;     ///< number of the nearest of them, or kNone
  std::vector<std::uint32_t> lights;      ///< of the slots behind those that all tiles have

  /// LightState of all points, of the light that has this slot.
  std::span<const std::uint8_t> statesOf(std::size_t slot) const {
    return std::span(lightState).subspan(slot * looked.size(), looked.size());
  }

  void resize(std::size_t points, std::size_t slots);
  /// A slot more, of a light that was taken for faint at the points that were sampled so far.
  void addLight(std::uint32_t light);
  /// What another tile's answers, of as many slots, know of its point `from` is known of the point `to`.
  void take(std::size_t to, const TileAnswers& others, std::size_t from);
};

}  // namespace lightvane
