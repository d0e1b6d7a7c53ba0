#pragma once

#include "app/gl/framebuffer.h"
#include "app/gl/shaders.h"

struct ImDrawData;

namespace lightvane {

/// Draws what ImGui has laid out. Our own, since ImGui's renderer loads GL by way of a window system and
/// cannot draw in memory. The one file that knows how ImGui's versions differ in this. On the GL thread,
/// which is ImGui's too.
class DrawLists {
 public:
  /// Also tells ImGui's current context what this renderer can do.
  static Expected<DrawLists> create(const Gl& gl, const ShaderSources& sources);

  /// Uploads the font atlas of ImGui's current context: before its first frame, and after any change of its
  /// fonts.
  void uploadFonts();

  /// Over what the target holds.
  void draw(const Framebuffer& target, const ImDrawData& data) const;

 private:
  DrawLists(const Gl& gl, ShaderProgram program);

  const Gl* gl_;
  ShaderProgram program_;
  GlVertexArray format_;
  GlBuffer vertices_, indices_;
  GlTexture fonts_;
};

}  // namespace lightvane
