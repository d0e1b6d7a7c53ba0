#pragma once

#include <memory>
#include <optional>

#include "app/gl/draw_lists.h"
#include "app/gl/overlay_layer.h"
#include "app/gl/picture_layer.h"

struct ImDrawData;

namespace lightvane {

/// A view, how it is shown and where.
struct ShownPicture {
  std::shared_ptr<const ViewImage> view;
  PictureStyle style;
  Placement placement;
};

/// Everything that the window shows, as values.
struct CanvasContent {
  Color8 background;
  std::optional<ShownPicture> picture;
  /// In place of `picture` from `wipe` on, a part of the area's width; or in its own half of the area.
  std::optional<ShownPicture> second;
  std::optional<float> wipe;
  std::optional<OverlayView> overlay;
  float uiScale = 1.0f;
  const ImDrawData* controls = nullptr;
};

/// Draws the window's content into a framebuffer of its own. On the GL thread.
class Canvas {
 public:
  /// Compiles what the first picture needs; `gl` must outlive the canvas.
  static Expected<Canvas> create(const Gl& gl, const ShaderSources& sources);

  /// The overlay's shaders are compiled when an overlay is drawn first: an error is theirs.
  Expected<void> draw(const CanvasContent& content, int width, int height);

  /// After a change of ImGui's fonts, before its next frame.
  void uploadFonts() { controls_.uploadFonts(); }
  const Framebuffer& framebuffer() const { return *framebuffer_; }

 private:
  Canvas(const Gl& gl, ShaderSources sources, PictureLayer pictures, DrawLists controls);
  void drawPictures(const CanvasContent& content);

  const Gl* gl_;
  ShaderSources sources_;
  PictureLayer pictures_;
  DrawLists controls_;
  std::optional<OverlayLayer> overlay_;
  std::unique_ptr<Framebuffer> framebuffer_;
  PictureTexture first_, second_;
  std::shared_ptr<const ViewImage> firstUploaded_, secondUploaded_;
  std::optional<ColorMap> firstMap_, secondMap_;
};

}  // namespace lightvane
