#include "app/inspection.h"

#include <cmath>

#include "core/inspect/frame_points.h"
#include "core/render/change.h"

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

FullSubject fullSubject(const RenderFrame& frame, const PixelRef& pixel) {
  FullSubject subject{frame.scene, frame.camera, frame.parameters, frame.lights, frame.points != nullptr, {},
                      {}};
  // How bright the picture is shown changes none of it.
  subject.camera.exposureStops = 0.0;
  const bool isInside =
      pixel.x >= 0 && pixel.y >= 0 && pixel.x < frame.camera.width && pixel.y < frame.camera.height;
  if (!frame.points || !isInside) return subject;
  const PixelPoints points = pointsOfPixel(
      *frame.points, static_cast<std::uint32_t>(pixel.y * frame.points->region.width + pixel.x));
  if (points.count == 0) return subject;
  const TileAnswers& answers = *frame.answers[points.tile];
  const std::size_t pointsOfTile = answers.looked.size();
  for (std::size_t p = points.first; p < points.first + points.count; ++p) {
    subject.looked.push_back(answers.looked[p]);
    subject.answers.push_back(answers.mirrored[p]);
    for (std::size_t i = p; i < answers.lightDirect.size(); i += pointsOfTile)
      subject.answers.push_back(answers.lightDirect[i]);
    for (std::size_t i = p; i < answers.indirect.size(); i += pointsOfTile)
      subject.answers.push_back(answers.indirect[i]);
  }
  return subject;
}

bool isLitAlike(const FullSubject& a, const FullSubject& b) {
  if (a.scene != b.scene || a.camera != b.camera || a.lights != b.lights || a.hasPoints != b.hasPoints)
    return false;
  if (a.parameters == b.parameters) return true;
  const StillTrue still = stillTrue(*a.scene, a.parameters, b.parameters);
  return still.points && still.sampled && still.indirectVectors && still.directVectors;
}

bool isAlike(const FullSubject& a, const FullSubject& b) {
  return a.looked == b.looked && a.answers == b.answers && isLitAlike(a, b);
}

/// `frame` is null while there is none to compare with.
void Inspection::compareFull(const RenderFrame* frame) {
  holds_ = false;
  if (!subject_) return;
  if (frame != nullptr && pixelRef_) {
    const FullSubject now = fullSubject(*frame, *pixelRef_);
    holds_ = isAlike(*subject_, now);
    // While it is rendered again, the same answers may yet come.
    if (full_ && !isLitAlike(*subject_, now)) full_.reset();
  }
  if (!holds_ && job_.isBusy()) {
    waits_ = true;
    job_.cancel();
  }
  if (!full_ && !job_.isBusy()) subject_.reset();
}

void Inspection::update(const std::shared_ptr<const RenderFrame>& frame, const Selection& selection,
                        bool rests) {
  const RecordRef record = selection.records.empty() ? RecordRef{} : selection.records.front();
  const bool usable = frame && frame->reduction == 1 && frame->progress.spacing > 0;
  if (selection.pixel != pixelRef_) {
    full_.reset();
    subject_.reset();
    waits_ = false;
    job_.cancel();
  }
  if (!usable || frame != frame_ || selection.pixel != pixelRef_) {
    pixel_.reset();
    pixelRef_ = selection.pixel;
    const bool inside =
        usable && pixelRef_ && pixelRef_->x < frame->film->width && pixelRef_->y < frame->film->height;
    if (inside) pixel_ = pixelReport(*frame, pixelRef_->x, pixelRef_->y);
    compareFull(usable ? frame.get() : nullptr);
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
  if (full_ && usable && rests && !holds_) {
    full_.reset();
    subject_.reset();
  }
  if (waits_ && rests && pixel_) computeHere();
}

void Inspection::computeHere() {
  if (!pixelRef_) return;
  full_.reset();
  // Coarse frames have nothing to compute at.
  waits_ = frame_ == nullptr;
  if (waits_) return;
  subject_ = fullSubject(*frame_, *pixelRef_);
  holds_ = true;
  job_.start([frame = frame_, pixel = *pixelRef_](const StopFlag& stop) {
    return lightvane::computeHere(*frame, pixel.x, pixel.y, kSamples, stop);
  });
}

}  // namespace lightvane
