#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/workspace.h"
#include "core/inspect/error_sources.h"
#include "core/inspect/overlays.h"
#include "core/inspect/view_image.h"
#include "core/render/pinned_vectors.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// For each pass 1 + the largest Birth::order among its vectors: the scale of OverlaySettings::growth.
std::vector<std::uint32_t> passLengths(const Snapshot& snapshot);

/// What is made from a frame to show it, kept for as long as nothing that it depends on changes: the picture
/// of a view, the overlay, how the cache grew. On one thread. Cost: a few milliseconds for 512 x 512 pixels
/// and 5,000 vectors, where something changed.
class FrameViews {
 public:
  /// Brings everything up to date. `frame` may be null. `base` is what the Error view is against.
  void update(std::shared_ptr<const RenderFrame> frame, PictureView view, const OverlaySettings& overlays,
              const Selection& selection, const ErrorBase& base,
              const std::shared_ptr<const PinnedVectors>& pinned, const StaleKinds& stale);
  /// What the EstimatedError view shows, once it is known of the frame. Until then that is empty.
  void take(std::shared_ptr<const ErrorEstimate> estimate);
  /// What the ErrorSources view shows, likewise, and which of them.
  void take(std::shared_ptr<const ErrorSources> sources, std::optional<ErrorSource> source);

  const std::shared_ptr<const RenderFrame>& frame() const { return frame_; }
  const std::shared_ptr<const ViewImage>& view() const { return view_; }  ///< null without a frame
  /// Null where nothing is to be drawn.
  const std::shared_ptr<const OverlayBatch>& overlay() const { return overlay_; }
  const std::shared_ptr<const ImageFloat>& depth() const { return depth_; }
  const std::vector<std::uint32_t>& passes() const { return passes_; }

 private:
  void updateView(PictureView view);
  void updateOverlay();

  std::shared_ptr<const RenderFrame> frame_;
  ErrorBase base_;
  std::shared_ptr<const ErrorEstimate> estimate_;
  std::shared_ptr<const ErrorSources> sources_;
  std::optional<ErrorSource> source_;
  std::shared_ptr<const ViewImage> view_;
  std::shared_ptr<const Snapshot> computedSnapshot_;
  std::shared_ptr<const VisiblePoints> computedPoints_;
  std::vector<ComputedVector> computed_;
  OverlaySettings overlaySettings_;
  Selection overlaySelection_;
  std::shared_ptr<const PinnedVectors> overlayPinned_;
  StaleKinds overlayStale_;
  std::shared_ptr<const OverlayBatch> overlay_;
  std::shared_ptr<const ImageFloat> depth_;
  std::shared_ptr<const Snapshot> passesSnapshot_;
  std::vector<std::uint32_t> passes_;
};

}  // namespace lightvane
