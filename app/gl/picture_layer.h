#pragma once

#include <memory>
#include <span>
#include <vector>

#include "app/gl/framebuffer.h"
#include "app/gl/shaders.h"
#include "core/inspect/picture_style.h"
#include "core/inspect/view_image.h"

namespace lightvane {

/// A view on the graphics card: its numbers as they are, so that exposure, tone mapping, range and colours
/// change without an upload. On the GL thread.
class PictureTexture {
 public:
  explicit PictureTexture(const Gl& gl) : gl_(&gl) {}

  /// Uploads what differs from the last picture, by bands of rows; returns how many rows that was. Cost: a
  /// comparison of all values, and the upload. `table` is the colour map's; views of other kinds than Scalar
  /// ignore it.
  int upload(const ViewImage& image, std::span<const Color8, 256> table);

  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return width_ == 0; }

 private:
  friend class PictureLayer;
  void uploadColors(const ViewImage& image, std::span<const Color8, 256> table);

  const Gl* gl_;
  GlTexture values_, colors_;
  int width_ = 0, height_ = 0;
  ViewKind kind_ = ViewKind::Radiance;
  int categoryCount_ = 0;
  std::vector<float> uploaded_;
  std::vector<Color8> uploadedColors_;

  // Made by PictureLayer, from the values in this style, where it is not stale.
  std::unique_ptr<Framebuffer> developed_;
  PictureStyle developedStyle_;
  bool stale_ = true;
};

/// Draws pictures. Magnified pixels are squares, with a thin grid from zoom 8 on, or smooth; minified ones
/// are the mean of the colours they cover. On the GL thread.
class PictureLayer {
 public:
  static Expected<PictureLayer> create(const Gl& gl, const ShaderSources& sources);

  /// Over what the target holds; an empty picture draws nothing.
  void draw(const Framebuffer& target, PictureTexture& picture, const PictureStyle& style,
            const Placement& placement) const;

  /// Two pictures in one place: `left` up to `position` (0 to 1 of the area's width), `right` from there on,
  /// a line of `lineWidth` framebuffer pixels between.
  void drawWipe(const Framebuffer& target, PictureTexture& left, const PictureStyle& leftStyle,
                PictureTexture& right, const PictureStyle& rightStyle, const Placement& placement,
                float position, int lineWidth) const;

 private:
  PictureLayer(const Gl& gl, ShaderProgram develop, ShaderProgram show)
      : gl_(&gl), develop_(std::move(develop)), show_(std::move(show)), corners_(gl) {}
  void develop(PictureTexture& picture, const PictureStyle& style) const;

  const Gl* gl_;
  ShaderProgram develop_, show_;
  GlVertexArray corners_;  // without attributes: core profiles draw nothing without one
};

}  // namespace lightvane
