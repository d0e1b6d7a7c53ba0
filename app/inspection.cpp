#include "app/inspection.h"

#include <cmath>

namespace lightvane {
namespace {

constexpr float kServedPixels = 2.0f;
constexpr Color8 kServedColor{255, 255, 255, 170};

/// A mark on each pixel of the mask, where its surface is.
std::shared_ptr<const OverlayBatch> marksOn(const RenderFrame& frame, const Image<std::uint8_t>& mask,
                                            const RecordRef& record) {
  auto batch = std::make_shared<OverlayBatch>();
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i] == 0 || !std::isfinite(frame.film->depth()[i])) continue;
    batch->markers.push_back(
        {frame.film->position()[i], kServedPixels, kServedColor, MarkerShape::Disc, record});
  }
  return batch;
}

}  // namespace

void Inspection::update(const std::shared_ptr<const RenderFrame>& frame, const Selection& selection,
                        bool rests) {
  const RecordRef record = selection.records.empty() ? RecordRef{} : selection.records.front();
  const bool usable = frame && frame->reduction == 1 && frame->progress.spacing > 0;
  if (!usable || frame != frame_ || selection.pixel != pixelRef_) {
    pixel_.reset();
    full_.reset();
    waits_ = (waits_ || job_.isBusy()) && selection.pixel == pixelRef_;
    job_.cancel();
    pixelRef_ = selection.pixel;
    const bool inside =
        usable && pixelRef_ && pixelRef_->x < frame->film->width && pixelRef_->y < frame->film->height;
    if (inside) pixel_ = pixelReport(*frame, pixelRef_->x, pixelRef_->y);
  }
  if (!usable || frame != frame_ || record != recordRef_) {
    record_.reset();
    served_ = nullptr;
    recordRef_ = record;
    if (usable && frame->snapshot && !record.isNone()) {
      record_ = recordReport(*frame, record);
      served_ = marksOn(*frame, servedPixels(*frame, record), record);
    }
  }
  frame_ = usable ? frame : nullptr;
  if (auto full = job_.take()) full_ = *std::move(full);
  if (waits_ && rests && pixel_) computeHere();
}

void Inspection::computeHere() {
  if (!frame_ || !pixelRef_) return;
  full_.reset();
  waits_ = false;
  job_.start([frame = frame_, pixel = *pixelRef_](const StopFlag& stop) {
    return lightvane::computeHere(*frame, pixel.x, pixel.y, kSamples, stop);
  });
}

}  // namespace lightvane
