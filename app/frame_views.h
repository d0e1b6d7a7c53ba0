#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/panels/panel_io.h"
#include "app/panels/workspace.h"
#include "core/inspect/overlays.h"
#include "core/inspect/view_image.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// The overlay that the display's choices and the selection ask for. `births` are those of birthOrder.
OverlayStyle overlayStyle(const OverlaySettings& settings, const Selection& selection,
                          const std::vector<BirthTime>& births);

/// When each vector of both kinds was computed, ascending: the moments of OverlaySettings::growth.
std::vector<BirthTime> birthOrder(const Snapshot& snapshot);

/// What is made from a frame to show it, kept for as long as nothing that it depends on changes: the picture
/// of a view, the overlay, the order of births. On one thread. Cost: a few milliseconds for 512 x 512 pixels
/// and 5,000 vectors, where something changed.
class FrameViews {
 public:
  /// Brings everything up to date. `frame` may be null; `reference`, too.
  void update(std::shared_ptr<const RenderFrame> frame, const Display& display, const Selection& selection,
              std::shared_ptr<const ImageRgb> reference);

  const std::shared_ptr<const RenderFrame>& frame() const { return frame_; }
  const std::shared_ptr<const ViewImage>& view() const { return view_; }  ///< null without a frame
  /// Null where nothing is to be drawn.
  const std::shared_ptr<const OverlayBatch>& overlay() const { return overlay_; }
  const std::shared_ptr<const ImageFloat>& depth() const { return depth_; }
  std::uint64_t moments() const { return births_.size(); }
  std::string momentText(std::uint64_t moment) const;

 private:
  void updateView(PictureView view, const std::shared_ptr<const ImageRgb>& reference);

  std::shared_ptr<const RenderFrame> frame_;
  std::shared_ptr<const ImageRgb> reference_;
  std::shared_ptr<const ViewImage> view_;
  std::shared_ptr<const Snapshot> computedSnapshot_;
  std::shared_ptr<const VisiblePoints> computedPoints_;
  std::vector<ComputedVector> computed_;
  OverlaySettings overlaySettings_;
  Selection overlaySelection_;
  std::shared_ptr<const OverlayBatch> overlay_;
  std::shared_ptr<const ImageFloat> depth_;
  std::shared_ptr<const Snapshot> birthsSnapshot_;
  std::vector<BirthTime> births_;
};

}  // namespace lightvane
