#include "core/inspect/pick.h"

#include <cmath>
#include <optional>

namespace lightvane {
namespace {

/// Whether something nearer is seen where `seen` says that the point is, in pixels of the camera's picture.
bool isHidden(const Vec3& point, const Vec3& seen, const Camera& camera, const ImageFloat& depth) {
  // A vector lies on a surface; film depth is of the pixel's centre, which may be farther or nearer on a
  // slope.
  constexpr float kBehind = 0.03f;
  if (depth.empty() || seen.x < 0.0f || seen.y < 0.0f) return false;
  const auto column =
      static_cast<int>(seen.x * static_cast<float>(depth.width()) / static_cast<float>(camera.width));
  const auto row =
      static_cast<int>(seen.y * static_cast<float>(depth.height()) / static_cast<float>(camera.height));
  if (column >= depth.width() || row >= depth.height()) return false;
  const float surface = depth.at(column, row);
  return camera.distanceTo(point) > surface + kBehind * camera.eyeScale(surface);
}

}  // namespace

RecordRef pickMarker(const OverlayBatch& batch, const Camera& camera, float x, float y, float radiusPixels,
                     const ImageFloat& depth) {
  const OverlayMarker* best = nullptr;
  bool bestIsHidden = true;
  float bestDistance = kInfinity;
  for (const OverlayMarker& marker : batch.markers) {
    const std::optional<Vec3> seen = camera.project(marker.position);
    if (!seen || std::hypot(seen->x - x, seen->y - y) > radiusPixels) continue;
    const float distance = camera.distanceTo(marker.position);
    const bool hidden = !marker.inMirror && isHidden(marker.position, *seen, camera, depth);
    if (best != nullptr && (hidden > bestIsHidden || (hidden == bestIsHidden && distance >= bestDistance)))
      continue;
    best = &marker;
    bestIsHidden = hidden;
    bestDistance = distance;
  }
  return best == nullptr ? RecordRef{} : best->record;
}

std::vector<RecordRef> recordsWithin(const RenderFrame& frame, const Vec2& low, const Vec2& high,
                                     const PickedKinds& kinds) {
  std::vector<RecordRef> found;
  if (!frame.snapshot) return found;
  const auto isWithin = [&](const Vec3& point) {
    const std::optional<Vec3> seen = frame.camera.project(point);
    return seen && seen->x >= low.x && seen->x <= high.x && seen->y >= low.y && seen->y <= high.y &&
           !isHidden(point, *seen, frame.camera, frame.film->depth());
  };
  const auto addFrom = [&](const auto& records, std::uint32_t light) {
    for (std::uint32_t number = 0; number < records.size(); ++number) {
      if (isWithin(records[number].point.position)) found.push_back({light, number});
    }
  };
  if (kinds.indirect) addFrom(frame.snapshot->indirect, kNone);
  for (std::uint32_t light = 0; kinds.direct && light < frame.snapshot->direct.size(); ++light)
    addFrom(frame.snapshot->direct[light], light);
  return found;
}

}  // namespace lightvane
