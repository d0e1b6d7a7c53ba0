#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/render/tile_answers.h"
#include "core/scene/scene.h"

namespace lightvane {

struct Parameters;

/// Where TileAnswers keep what each light of the scene gives their points. Lights without vectors come first,
/// each with a slot of its own or, where they are many, all with the first one. Those with vectors have a
/// slot each, in every tile; where they are many, each tile has slots for those that are worth vectors
/// somewhere in it, and what the others give lies in the first slot, too.
class LightSlots {
 public:
  LightSlots() = default;
  /// `factors`: by which the picture multiplies each light (LightMix::direct); empty: all as they are.
  LightSlots(const Scene& scene, const Parameters& parameters, std::span<const Rgb> factors);

  std::span<const std::uint32_t> vectorLights() const { return vectorLights_; }
  std::span<const std::uint32_t> exactLights() const { return exactLights_; }
  /// Whether each light without vectors has a slot, in which it can be dimmed.
  bool keepsApart() const { return keepsApart_; }
  /// Whether lights with vectors are so many that not all are asked everywhere.
  bool isByTile() const { return isByTile_; }

  /// Slots that every tile has. Those of lights with vectors that are not by tile are the last of them.
  std::size_t sharedCount() const { return factors_.size(); }
  /// Slots of lights without vectors, the first ones.
  std::size_t exactCount() const { return sharedCount() - (isByTile_ ? 0 : vectorLights_.size()); }
  std::size_t count(const TileAnswers& tile) const { return sharedCount() + tile.lights.size(); }

  /// The slot of a light in a tile, or kNone of one that is worth no vectors there.
  std::size_t slotOf(const TileAnswers& tile, std::uint32_t light) const;
  /// Its slot, which the tile is given where it has none of the light.
  std::size_t claim(TileAnswers& tile, std::uint32_t light) const;
  /// Where what a point of the tile got from the light lies, alone or with others'.
  std::size_t slotAt(const TileAnswers& tile, std::uint32_t light, std::size_t point) const;
  /// By what the picture multiplies what lies in a slot.
  const Rgb& factorOf(const TileAnswers& tile, std::size_t slot) const;

  /// Calls visit(index, slot) for each light with vectors that has a slot in the tile: its index in
  /// vectorLights().
  template <class Visit>
  void forEachAsked(const TileAnswers& tile, const Visit& visit) const {
    if (!isByTile_) {
      for (std::size_t i = 0; i < vectorLights_.size(); ++i) visit(i, exactCount() + i);
      return;
    }
    for (std::size_t i = 0; i < tile.lights.size(); ++i) visit(indexOf(tile.lights[i]), sharedCount() + i);
  }
  /// Its index in vectorLights(), of a light that has vectors.
  std::size_t indexOf(std::uint32_t light) const;
  bool hasVectors(std::uint32_t light) const;

 private:
  std::vector<std::uint32_t> vectorLights_, exactLights_;  ///< ascending
  bool keepsApart_ = true;
  bool isByTile_ = false;
  std::vector<std::size_t> slots_;  ///< of each light; kNone where tiles have it
  std::vector<Rgb> factors_;        ///< of shared slots
  std::vector<Rgb> lightFactors_;   ///< of each light; empty: 1
};

}  // namespace lightvane
