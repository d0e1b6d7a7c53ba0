#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/render/visible_points.h"

namespace lightvane {

/// A place of the seed (paper, section 3.3.1): a pixel, and which of its visible points.
struct SeedPlace {
  std::uint32_t pixel;  ///< index into the region's picture
  float which;          ///< in [0, 1)

  /// The chosen one of the pixel's points, those seen in mirrors among them; null where it has none. `points`
  /// are in the order of their pixels.
  const VisiblePoint* choose(std::span<const VisiblePoint> points) const;
};

/// Streams of random numbers, so that the two seeds do not share their places.
inline constexpr std::uint32_t kIndirectSeed = 0x696c76U;
inline constexpr std::uint32_t kDirectSeed = 0x646c76U;

/// `count` places, one in each cell of a grid over the picture.
std::vector<SeedPlace> seedPlaces(const PictureRegion& region, int count, std::uint64_t seed,
                                  std::uint32_t stream);

}  // namespace lightvane
