#pragma once

#include "app/gl/gl_functions.h"
#include "app/gl/placement.h"
#include "core/image/image.h"
#include "core/inspect/color_map.h"

namespace lightvane {

/// A picture of 8-bit RGBA that is drawn into: all that Lightvane shows is drawn into one first and then
/// copied to the window, so that tests and exports read the very bytes that the window shows. sRGB is the
/// shaders' business: GL's own conversion is left off. On the GL thread.
///
/// Whoever draws into one binds it and sets every state that it depends on, and leaves the scissor test off.
class Framebuffer {
 public:
  /// At least 1 x 1.
  Framebuffer(const Gl& gl, int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  const GlTexture& texture() const { return color_; }

  /// Makes it what is drawn into, and all of it visible.
  void bind() const;
  /// As bind(), with the placement's area alone as the viewport.
  void bind(const Placement& placement) const;
  /// Fills everything; the alpha of `color` too.
  void clear(const Color8& color) const;
  /// Fills a rectangle, from the top left; what is outside is cut off.
  void fill(int left, int top, int width, int height, const Color8& color) const;

  /// The pixels, row by row from the top left. Waits for the drawing to end.
  Image<Color8> read() const;
  /// Copies everything to another one of the same size: what rarely changes, before what always does is drawn
  /// over it.
  void copyTo(const Framebuffer& target) const;
  /// Copies everything to the window, which is of the same size.
  void copyToWindow() const;

 private:
  void copyTo(GLuint framebuffer) const;

  const Gl* gl_;
  int width_, height_;
  GlTexture color_;
  GlFramebuffer framebuffer_;
};

/// For everything that is drawn with premultiplied alpha.
void blendPremultiplied(const Gl& gl);

}  // namespace lightvane
