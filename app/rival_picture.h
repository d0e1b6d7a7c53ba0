#pragma once

#include <memory>

#include "core/inspect/view_image.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// A picture that others are held against, and its views as they are asked for. On one thread.
class RivalPicture {
 public:
  explicit RivalPicture(std::shared_ptr<const RenderFrame> frame);
  /// From a file, in the scene's units: its beauty is all there is, and the variance of its pixels, which may
  /// be empty.
  RivalPicture(ImageRgb beauty, ImageRgb variance);

  /// Null for a picture from a file.
  const std::shared_ptr<const RenderFrame>& frame() const { return frame_; }
  /// In the scene's units.
  const std::shared_ptr<const ImageRgb>& beauty() const { return beauty_; }
  /// Of the beauty's pixels; empty where it is not known.
  const std::shared_ptr<const ImageRgb>& variance() const { return variance_; }
  /// The view; beauty where the picture has no such view. Made anew where the view is another one than
  /// before, or what its error is against.
  std::shared_ptr<const ViewImage> view(PictureView view, const ErrorBase& base);

 private:
  std::shared_ptr<const RenderFrame> frame_;
  std::shared_ptr<const ImageRgb> beauty_, variance_;
  std::shared_ptr<const ViewImage> view_;
  PictureView wanted_ = PictureView::Beauty;
  ErrorBase base_;
};

}  // namespace lightvane
