#include "core/inspect/frame_points.h"

#include <algorithm>

namespace lightvane {

PixelPoints pointsOfPixel(const VisiblePoints& points, std::uint32_t pixel) {
  const auto width = static_cast<std::uint32_t>(points.region.width);
  constexpr auto kTileSize = static_cast<std::uint32_t>(VisiblePoints::kTileSize);
  const std::uint32_t tilesX = (width + kTileSize - 1) / kTileSize;
  const std::uint32_t tile = pixel / width / kTileSize * tilesX + pixel % width / kTileSize;
  if (tile >= points.tiles.size()) return {};
  const std::vector<VisiblePoint>& all = points.tiles[tile].points;
  const auto first =
      std::lower_bound(all.begin(), all.end(), pixel,
                       [](const VisiblePoint& p, std::uint32_t wanted) { return p.pixel < wanted; });
  auto last = first;
  while (last != all.end() && last->pixel == pixel) ++last;
  return {tile, static_cast<std::uint32_t>(first - all.begin()), static_cast<std::uint32_t>(last - first)};
}

PointRef pointOfRecord(const VisiblePoints& points, const VectorPoint& place, const Birth& birth) {
  const PixelPoints pixel = pointsOfPixel(points, birth.pixel);
  for (std::uint32_t i = pixel.first; i < pixel.first + pixel.count; ++i) {
    const VisiblePoint& p = points.tiles[pixel.tile].points[i];
    if (p.position == place.position && p.normal == place.normal) return {pixel.tile, i};
  }
  return {};
}

}  // namespace lightvane
