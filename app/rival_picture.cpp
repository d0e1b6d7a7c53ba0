#include "app/rival_picture.h"

#include <utility>

namespace lightvane {

RivalPicture::RivalPicture(std::shared_ptr<const RenderFrame> frame)
    : frame_(std::move(frame)),
      beauty_(std::make_shared<const ImageRgb>(frame_->film->sceneBeauty(*frame_->scene))),
      variance_(std::make_shared<const ImageRgb>(frame_->film->sceneVariance(*frame_->scene))) {}

RivalPicture::RivalPicture(ImageRgb beauty, ImageRgb variance)
    : beauty_(std::make_shared<const ImageRgb>(std::move(beauty))),
      variance_(std::make_shared<const ImageRgb>(std::move(variance))) {}

std::shared_ptr<const ViewImage> RivalPicture::view(PictureView view, const ErrorBase& base) {
  const bool isUpToDate = view_ && wanted_ == view && (view != PictureView::Error || base_ == base);
  if (isUpToDate) return view_;
  wanted_ = view;
  base_ = base;
  ViewImage image;
  if (frame_ && view != PictureView::Beauty) image = viewImage(*frame_, view, {.base = base});
  if (image.empty()) image = frame_ ? viewImage(*frame_, PictureView::Beauty) : viewOfPicture(*beauty_);
  view_ = std::make_shared<const ViewImage>(std::move(image));
  return view_;
}

}  // namespace lightvane
