#include "app/frame_views.h"

#include <algorithm>

#include "core/inspect/record_edit.h"

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

void FrameViews::updateView(PictureView view) {
  const std::vector<ComputedVector>* computed = nullptr;
  if (view == PictureView::WhereComputed && frame_->points) {
    if (computedSnapshot_ != frame_->snapshot || computedPoints_ != frame_->points) {
      computed_ = computedVectors(*frame_);
      computedSnapshot_ = frame_->snapshot;
      computedPoints_ = frame_->points;
    }
    computed = &computed_;
  }
  // In the background, as it takes longer than a frame may.
  const ErrorEstimate unknown;
  const ErrorEstimate& estimate = estimate_ ? *estimate_ : unknown;
  view_ = std::make_shared<const ViewImage>(
      viewImage(*frame_, view, {base_, computed, &estimate, sources_.get(), source_}));
}

void FrameViews::take(std::shared_ptr<const ErrorEstimate> estimate) {
  if (estimate == estimate_) return;
  estimate_ = std::move(estimate);
  if (view_ && view_->view == PictureView::EstimatedError) updateView(PictureView::EstimatedError);
}

void FrameViews::take(std::shared_ptr<const ErrorSources> sources, std::optional<ErrorSource> source) {
  if (sources == sources_ && source == source_) return;
  sources_ = std::move(sources);
  source_ = source;
  if (view_ && view_->view == PictureView::ErrorSources) updateView(PictureView::ErrorSources);
}

void FrameViews::updateOverlay() {
  std::vector<RecordRef> selected = overlaySelection_.records;
  if (!overlaySelection_.hoveredRecord.isNone()) selected.push_back(overlaySelection_.hoveredRecord);
  OverlayStyle style = overlayStyle(overlaySettings_, passes_, selected);
  style.thinZones = true;
  style.stale = overlayStale_;
  if (overlaySettings_.shown) style.pinned = pinnedRecords(overlayPinned_.get(), *frame_);
  auto batch = std::make_shared<const OverlayBatch>(buildOverlay(*frame_, style));
  const bool isEmpty = batch->markers.empty() && batch->lines.empty() && batch->zones.empty();
  overlay_ = isEmpty ? nullptr : std::move(batch);
}

void FrameViews::update(std::shared_ptr<const RenderFrame> frame, PictureView view,
                        const OverlaySettings& overlays, const Selection& selection, const ErrorBase& base,
                        const std::shared_ptr<const PinnedVectors>& pinned, const StaleKinds& stale) {
  if (!frame) {
    *this = FrameViews();
    return;
  }
  const bool newFrame = frame != frame_;
  const bool newBase = !(base == base_);
  if (newFrame) {
    estimate_ = nullptr;
    sources_ = nullptr;
  }
  frame_ = std::move(frame);
  base_ = base;
  if (newFrame || !view_ || view_->view != view || (newBase && view == PictureView::Error)) updateView(view);
  if (newFrame) depth_ = std::shared_ptr<const ImageFloat>(frame_->film, &frame_->film->depth());
  if (passesSnapshot_ != frame_->snapshot) {
    passesSnapshot_ = frame_->snapshot;
    passes_ = frame_->snapshot ? passLengths(*frame_->snapshot) : std::vector<std::uint32_t>();
  }
  const bool isSame = overlaySettings_ == overlays && overlaySelection_ == selection &&
                      overlayPinned_ == pinned && overlayStale_ == stale;
  if (!newFrame && isSame) return;
  overlayStale_ = stale;
  overlaySettings_ = overlays;
  overlayPinned_ = pinned;
  overlaySelection_ = selection;
  updateOverlay();
}

}  // namespace lightvane
