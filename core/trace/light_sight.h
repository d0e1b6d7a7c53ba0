#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/light_tree.h"

namespace lightvane {

/// What part of each group of a light tree can be seen from where, as trials have it: so that rays go to
/// lights that shine there, and not to those of the next room. It changes with what probability a light is
/// tried, never whether it is: what was seen nowhere keeps a chance of kLeast of what it would have in the
/// open.
///
/// Space is cut into cells, of which there are coarse and fine ones; a place asks the finest about which
/// enough is known. What was tried too little in a cell is taken to be as the larger group it belongs to is
/// there. Immutable; any thread.
class LightSight {
 public:
  static constexpr float kLeast = 1.0f / 1024.0f;

  /// A ray to a light, and whether it arrived.
  struct Trial {
    Vec3 from{0.0f};
    std::uint32_t group = 0;  ///< LightTree::groupOf the light
    bool arrived = false;
  };

  /// Nothing known: every light counts as seen from everywhere.
  LightSight() = default;
  LightSight(const LightTree& tree, std::span<const Trial> trials);

  /// About a place; normalised units.
  LightTree::Sight at(const Vec3& place) const;
  /// The same of one that may be null: nothing known.
  static LightTree::Sight at(const LightSight* sight, const Vec3& place) {
    return sight != nullptr ? sight->at(place) : LightTree::Sight{};
  }

  std::size_t memoryBytes() const;

 private:
  std::size_t cellAt(const Vec3& place) const;

  Vec3 origin_{0.0f};   ///< of the cells
  Vec3 perUnit_{0.0f};  ///< fine cells in a unit of length
  std::vector<std::uint32_t>
      cells_;  ///< for each fine cell, its number among `sights_`; empty where nothing is known
  std::vector<std::vector<float>> sights_;
};

}  // namespace lightvane
