#include "app/picking.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/inspect/record_names.h"

namespace lightvane {
namespace {

// Screen pixels.
constexpr float kPickRadius = 9.0f;

}  // namespace

std::optional<PixelRef> pixelAt(const Placement& picture, const Vec2& screen, int width, int height) {
  const Vec2 at = glm::floor(picture.toPicture(screen));
  if (!(at.x >= 0.0f && at.y >= 0.0f && at.x < static_cast<float>(width) &&
        at.y < static_cast<float>(height)))
    return std::nullopt;
  return PixelRef{static_cast<int>(at.x), static_cast<int>(at.y)};
}

std::optional<Vec3> surfaceAt(const RenderFrame& frame, const PixelRef& pixel) {
  const int x = pixel.x / frame.reduction;
  const int y = pixel.y / frame.reduction;
  const Film& film = *frame.film;
  if (x >= film.width || y >= film.height || !std::isfinite(film.depth().at(x, y))) return std::nullopt;
  return film.position().at(x, y);
}

RecordRef recordAt(const RenderFrame& frame, const OverlayBatch* overlay, const Placement& picture,
                   const Vec2& screen) {
  if (overlay == nullptr) return {};
  const auto reduction = static_cast<float>(frame.reduction);
  const Vec2 at = picture.toPicture(screen) / reduction;
  return pickMarker(*overlay, frame.camera, at.x, at.y, kPickRadius / (picture.zoom * reduction),
                    frame.film->depth());
}

Selection selectionAfterClick(const Selection& before, const RenderFrame& frame, const OverlayBatch* overlay,
                              const Placement& picture, const Vec2& screen, bool adds) {
  Selection selection = before;
  const RecordRef record = recordAt(frame, overlay, picture, screen);
  if (!record.isNone()) {
    const auto found = std::find(selection.records.begin(), selection.records.end(), record);
    if (!adds) {
      selection.records = {record};
    } else if (found != selection.records.end()) {
      selection.records.erase(found);
    } else {
      selection.records.insert(selection.records.begin(), record);
    }
    return selection;
  }
  if (!adds) selection.records.clear();
  selection.pixel =
      pixelAt(picture, screen, frame.film->width * frame.reduction, frame.film->height * frame.reduction);
  return selection;
}

Selection selectionAfterDrag(const Selection& before, const RenderFrame& frame, const PickedKinds& kinds,
                             const Placement& picture, const Vec2& from, const Vec2& to, bool adds) {
  const auto reduction = static_cast<float>(frame.reduction);
  const Vec2 a = picture.toPicture(from) / reduction;
  const Vec2 b = picture.toPicture(to) / reduction;
  Selection selection = before;
  if (!adds) selection.records.clear();
  const std::set<RecordRef> selectedBefore(selection.records.begin(), selection.records.end());
  for (const RecordRef& record : recordsWithin(frame, glm::min(a, b), glm::max(a, b), kinds)) {
    if (!selectedBefore.contains(record)) selection.records.push_back(record);
  }
  return selection;
}

std::optional<Ball> ballAround(const RenderFrame& frame, const Selection& selection) {
  // Of the scene's diagonal.
  constexpr float kLeastRadius = 0.05f;
  Bounds bounds;
  for (const RecordRef& record : selection.records) {
    if (const IndirectLightVector* ilv = findIndirect(frame, record)) bounds.add(ilv->point.position);
    if (const DirectLightVector* dlv = findDirect(frame, record)) bounds.add(dlv->point.position);
  }
  if (selection.pixel) {
    if (const auto point = surfaceAt(frame, *selection.pixel)) bounds.add(*point);
  }
  if (bounds.empty()) return std::nullopt;
  return Ball{bounds.centre(), std::max(0.5f * bounds.diagonal(), kLeastRadius * frame.scene->diagonal)};
}

}  // namespace lightvane
