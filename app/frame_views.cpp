#include "app/frame_views.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/inspect/record_names.h"

namespace lightvane {
std::vector<std::uint32_t> passLengths(const Snapshot& snapshot) {
  std::vector<std::uint32_t> lengths;
  const auto add = [&](const Birth& birth) {
    if (lengths.size() <= birth.pass) lengths.resize(birth.pass + 1);
    lengths[birth.pass] = std::max(lengths[birth.pass], birth.order + 1);
  };
  for (std::size_t i = 0; i < snapshot.indirect.size(); ++i) add(snapshot.indirect[i].birth);
  for (const auto& light : snapshot.direct) {
    for (std::size_t i = 0; i < light.size(); ++i) add(light[i].birth);
  }
  return lengths;
}

void FrameViews::updateView(PictureView view, const std::shared_ptr<const ImageRgb>& reference) {
  const std::vector<ComputedVector>* computed = nullptr;
  if (view == PictureView::WhereComputed && frame_->points) {
    if (computedSnapshot_ != frame_->snapshot || computedPoints_ != frame_->points) {
      computed_ = computedVectors(*frame_);
      computedSnapshot_ = frame_->snapshot;
      computedPoints_ = frame_->points;
    }
    computed = &computed_;
  }
  // A coarse first look has no reference of its size.
  const bool comparable = reference && frame_->reduction == 1 && reference->width() == frame_->film->width &&
                          reference->height() == frame_->film->height;
  view_ = std::make_shared<const ViewImage>(
      viewImage(*frame_, view, comparable ? reference.get() : nullptr, computed));
}

void FrameViews::update(std::shared_ptr<const RenderFrame> frame, const Display& display,
                        const Selection& selection, std::shared_ptr<const ImageRgb> reference) {
  if (!frame) {
    *this = FrameViews();
    return;
  }
  const bool newFrame = frame != frame_;
  const bool newReference = reference != reference_;
  frame_ = std::move(frame);
  reference_ = std::move(reference);
  if (newFrame || !view_ || view_->view != display.view ||
      (newReference && display.view == PictureView::Error))
    updateView(display.view, reference_);
  if (newFrame) depth_ = std::shared_ptr<const ImageFloat>(frame_->film, &frame_->film->depth);
  if (passesSnapshot_ != frame_->snapshot) {
    passesSnapshot_ = frame_->snapshot;
    passes_ = frame_->snapshot ? passLengths(*frame_->snapshot) : std::vector<std::uint32_t>();
  }
  if (!newFrame && overlaySettings_ == display.overlays && overlaySelection_ == selection) return;
  overlaySettings_ = display.overlays;
  overlaySelection_ = selection;
  std::vector<RecordRef> selected = selection.records;
  if (!selection.hoveredRecord.isNone()) selected.push_back(selection.hoveredRecord);
  OverlayStyle style = overlayStyle(display.overlays, passes_, selected);
  style.thinZones = true;
  auto batch = std::make_shared<const OverlayBatch>(buildOverlay(*frame_, style));
  const bool isEmpty = batch->markers.empty() && batch->lines.empty() && batch->zones.empty();
  overlay_ = isEmpty ? nullptr : std::move(batch);
}

}  // namespace lightvane
