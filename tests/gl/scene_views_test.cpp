// Every view and every kind of overlay of a real scene, as the window draws them. docs/images has them in the
// window.

#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/gl/overlay_layer.h"
#include "app/gl/picture_layer.h"
#include "core/inspect/error_sources.h"
#include "core/inspect/overlays.h"
#include "core/inspect/record_edit.h"
#include "core/inspect/view_image.h"
#include "tests/gl/golden.h"
#include "tests/gl/memory_gl.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

constexpr int kSize = 96;
constexpr int kZoom = 3;

const RenderFrame& roomFrame() {
  static const RenderFrame frame = inspect_test::renderShipped(
      "cornell-mirror.toml", kSize, {{"preset", "draft"}, {"dlv.mode", "always"}, {"ilv.seed", "40"}});
  return frame;
}

/// The same room with other settings: what the error is against.
ErrorBase otherPicture() {
  const RenderFrame frame =
      inspect_test::renderShipped("cornell-mirror.toml", kSize, {{"preset", "draft"}, {"seed", "2"}});
  return {std::make_shared<const ImageRgb>(frame.film->toLayers(*frame.scene).rgb()), "another seed"};
}

class SceneViews : public GlTest {
 protected:
  static Placement placement() { return {0, 0, kZoom * kSize, kZoom * kSize, Vec2(0.0f), kZoom}; }

  void draw(const Framebuffer& target, const ViewImage& image) {
    PictureStyle style;
    style.scale = image.scale;
    PictureTexture picture(gl());
    picture.upload(image, colorTable(image.scale.map));
    pictures_.draw(target, picture, style, placement());
  }
  Image<Color8> drawn(const ViewImage& image) {
    const Framebuffer target(gl(), kZoom * kSize, kZoom * kSize);
    target.clear({30, 30, 33, 255});
    draw(target, image);
    return target.read();
  }
  /// The overlay over the picture.
  Image<Color8> drawn(const OverlayStyle& style) {
    const RenderFrame& frame = roomFrame();
    const Framebuffer target(gl(), kZoom * kSize, kZoom * kSize);
    draw(target, viewImage(frame, PictureView::Beauty));
    OverlayLayer layer = OverlayLayer::create(gl(), {}).value();
    OverlayView view;
    view.batches = {std::make_shared<const OverlayBatch>(buildOverlay(frame, style))};
    view.depth = std::shared_ptr<const ImageFloat>(frame.film, &frame.film->depth());
    view.camera = frame.camera;
    view.placement = placement();
    layer.update(view);
    layer.composite(target, 1.0f);
    return target.read();
  }

  void expectGoldenScene(const OverlayStyle& style, const std::string& name) {
    const Image<Color8> bare = drawn(viewImage(roomFrame(), PictureView::Beauty));
    expectGoldenOverlay(gl(), drawn(style), bare, "scene_" + name, GoldenOf::Rendering);
  }

  const PictureLayer pictures_ = PictureLayer::create(gl(), {}).value();
};

TEST_F(SceneViews, EveryViewIsDrawn) {
  const ErrorBase base = otherPicture();
  TaskPool pool(2);
  const StopFlag goOn = false;
  const ErrorSources sources = errorSources(roomFrame(), {32, 4}, pool, goOn).value();
  for (const PictureViewInfo& info : pictureViews()) {
    SCOPED_TRACE(info.name);
    const ViewImage image = viewImage(roomFrame(), info.view, {.base = base, .errorSources = &sources});
    ASSERT_FALSE(image.empty()) << image.title;
    expectGolden(gl(), drawn(image), fmt::format("view_{}", info.name), GoldenOf::Rendering);
  }
}

TEST_F(SceneViews, EveryKindOfOverlayIsDrawn) {
  OverlayStyle nothing;
  for (OverlayLook* look :
       {&nothing.directMarkers, &nothing.indirectMarkers, &nothing.zones, &nothing.gradients})
    look->shown = false;
  const std::pair<const char*, OverlayLook OverlayStyle::*> kinds[] = {
      {"ilvs", &OverlayStyle::indirectMarkers},   {"zones", &OverlayStyle::zones},
      {"gradients", &OverlayStyle::gradients},    {"dlvs", &OverlayStyle::directMarkers},
      {"dlv_radius", &OverlayStyle::directZones}, {"dlv_directions", &OverlayStyle::directGlyphs}};
  for (const auto& [name, look] : kinds) {
    OverlayStyle style = nothing;
    (style.*look).shown = true;
    style.mostShown = 200;
    style.thinZones = true;
    expectGoldenScene(style, name);
  }
  OverlayStyle mirrored = nothing;
  mirrored.indirectMarkers.shown = mirrored.mirrorImages.shown = true;
  expectGoldenScene(mirrored, "mirror_images");
}

TEST_F(SceneViews, SelectedAndPinnedVectorsAreDrawnWhateverIsHidden) {
  OverlayStyle style;
  for (OverlayLook* look : {&style.directMarkers, &style.indirectMarkers, &style.zones, &style.gradients})
    look->shown = false;
  style.selected = {{kNone, 30}, {0, 12}};
  style.pinned = {{kNone, 5}, {kNone, 60}};
  expectGoldenScene(style, "selected");
}

TEST_F(SceneViews, EachColouringOfIlvsIsDrawn) {
  for (const auto& choice : kVectorColoringNames) {
    OverlayStyle style;
    style.directMarkers.shown = style.zones.shown = style.gradients.shown = false;
    style.coloring = choice.value;
    expectGoldenScene(style, fmt::format("by_{}", choice.name));
  }
}

}  // namespace
}  // namespace lightvane
