#include "core/inspect/frame_points.h"

namespace lightvane {

PointRef pointOfRecord(const VisiblePoints& points, const VectorPoint& place, const Birth& birth) {
  const PixelPoints pixel = pointsOfPixel(points, birth.pixel);
  for (std::uint32_t i = pixel.first; i < pixel.first + pixel.count; ++i) {
    const VisiblePoint& p = points.tiles[pixel.tile].points[i];
    if (p.position == place.position && p.normal == place.normal) return {pixel.tile, i};
  }
  return {};
}

}  // namespace lightvane
