#include "app/frame_views.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/inspect/record_names.h"

namespace lightvane {
namespace {

VectorColoring coloringOf(IlvColoring coloring) {
  switch (coloring) {
    case IlvColoring::Brdf:
      return VectorColoring::Key;
    case IlvColoring::Birth:
      return VectorColoring::Pass;
    case IlvColoring::Age:
      return VectorColoring::Age;
    case IlvColoring::Cost:
      return VectorColoring::Cost;
    case IlvColoring::Energy:
      return VectorColoring::Energy;
    case IlvColoring::Distance:
      return VectorColoring::Distance;
  }
  return VectorColoring::Key;
}

}  // namespace

OverlayStyle overlayStyle(const OverlaySettings& settings, const Selection& selection,
                          const std::vector<BirthTime>& births) {
  const auto look = [&](OverlayKind kind) {
    const OverlaySwitch& layer = settings.layer(kind);
    return OverlayLook{settings.shown && layer.shown, layer.size, layer.opacity};
  };
  OverlayStyle style;
  style.indirectMarkers = look(OverlayKind::Ilv);
  style.indirectGlyphs = look(OverlayKind::IlvDirections);
  style.zones = look(OverlayKind::IlvZones);
  style.gradients = look(OverlayKind::IlvGradients);
  style.directMarkers = look(OverlayKind::Dlv);
  style.directZones = look(OverlayKind::DlvRadius);
  style.directGlyphs = look(OverlayKind::DlvDirections);
  style.mirrorImages = {settings.shown, 1.0f, 0.8f};
  style.coloring = coloringOf(settings.coloring);
  style.thinZones = true;
  style.mostShown = static_cast<std::size_t>(std::max(1, settings.mostRecords));
  style.selected = selection.records;
  if (!selection.hoveredRecord.isNone()) style.selected.push_back(selection.hoveredRecord);
  const GrowthTime& growth = settings.growth;
  if (!growth.all && !births.empty())
    style.until = births[std::min<std::size_t>(growth.moment, births.size() - 1)];
  return style;
}

std::vector<BirthTime> birthOrder(const Snapshot& snapshot) {
  std::vector<BirthTime> births;
  births.reserve(snapshot.indirect.size() + snapshot.directCount());
  const auto add = [&](const Birth& birth) { births.push_back({birth.pass, birth.order}); };
  for (std::size_t i = 0; i < snapshot.indirect.size(); ++i) add(snapshot.indirect[i].birth);
  for (const auto& light : snapshot.direct) {
    for (std::size_t i = 0; i < light.size(); ++i) add(light[i].birth);
  }
  std::sort(births.begin(), births.end());
  return births;
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
  if (birthsSnapshot_ != frame_->snapshot) {
    birthsSnapshot_ = frame_->snapshot;
    births_ = frame_->snapshot ? birthOrder(*frame_->snapshot) : std::vector<BirthTime>();
  }
  if (!newFrame && overlaySettings_ == display.overlays && overlaySelection_ == selection) return;
  overlaySettings_ = display.overlays;
  overlaySelection_ = selection;
  auto batch = std::make_shared<const OverlayBatch>(
      buildOverlay(*frame_, overlayStyle(display.overlays, selection, births_)));
  const bool isEmpty = batch->markers.empty() && batch->lines.empty() && batch->zones.empty();
  overlay_ = isEmpty ? nullptr : std::move(batch);
}

std::string FrameViews::momentText(std::uint64_t moment) const {
  if (births_.empty()) return {};
  const std::size_t at = std::min<std::size_t>(moment, births_.size() - 1);
  return fmt::format("pass {}, vector {} of {}", births_[at].pass, countText(at + 1),
                     countText(births_.size()));
}

}  // namespace lightvane
