#include "app/canvas.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

/// Uploads the view where the texture holds another one, or other colours.
void bringUpToDate(PictureTexture& texture, const ShownPicture& shown,
                   std::shared_ptr<const ViewImage>& uploaded, std::optional<ColorMap>& map) {
  if (uploaded == shown.view && map == shown.style.scale.map) return;
  texture.upload(*shown.view, colorTable(shown.style.scale.map));
  uploaded = shown.view;
  map = shown.style.scale.map;
}

}  // namespace

Expected<Canvas> Canvas::create(const Gl& gl, const ShaderSources& sources) {
  auto pictures = PictureLayer::create(gl, sources);
  if (!pictures) return tl::unexpected(pictures.error());
  auto controls = DrawLists::create(gl, sources);
  if (!controls) return tl::unexpected(controls.error());
  return Canvas(gl, sources, *std::move(pictures), *std::move(controls));
}

Canvas::Canvas(const Gl& gl, ShaderSources sources, PictureLayer pictures, DrawLists controls)
    : gl_(&gl),
      sources_(std::move(sources)),
      pictures_(std::move(pictures)),
      controls_(std::move(controls)),
      first_(gl),
      second_(gl) {}

void Canvas::drawPictures(const CanvasContent& content) {
  if (!content.picture) return;
  bringUpToDate(first_, *content.picture, firstUploaded_, firstMap_);
  if (!content.second) {
    pictures_.draw(*framebuffer_, first_, content.picture->style, content.picture->placement);
    return;
  }
  bringUpToDate(second_, *content.second, secondUploaded_, secondMap_);
  if (content.wipe) {
    pictures_.drawWipe(*framebuffer_, first_, content.picture->style, second_, content.second->style,
                       content.picture->placement, *content.wipe,
                       std::max(1, static_cast<int>(std::lround(content.uiScale))));
  } else {
    pictures_.draw(*framebuffer_, first_, content.picture->style, content.picture->placement);
    pictures_.draw(*framebuffer_, second_, content.second->style, content.second->placement);
  }
}

Expected<void> Canvas::draw(const CanvasContent& content, int width, int height) {
  width = std::max(1, width);
  height = std::max(1, height);
  if (!framebuffer_ || framebuffer_->width() != width || framebuffer_->height() != height)
    framebuffer_ = std::make_unique<Framebuffer>(*gl_, width, height);
  framebuffer_->bind();
  framebuffer_->clear(content.background);
  drawPictures(content);
  Expected<void> done;
  if (content.overlay && !content.overlay->batches.empty()) {
    if (!overlay_) {
      auto overlay = OverlayLayer::create(*gl_, sources_);
      if (overlay) {
        overlay_ = *std::move(overlay);
      } else {
        done = tl::unexpected(overlay.error());
      }
    }
    if (overlay_) {
      overlay_->update(*content.overlay);
      // Vectors are of the first picture.
      overlay_->composite(*framebuffer_, 1.0f, content.second && content.wipe ? *content.wipe : 1.0f);
    }
  }
  if (content.controls != nullptr) controls_.draw(*framebuffer_, *content.controls);
  return done;
}

}  // namespace lightvane
