#include "app/gl/draw_lists.h"

#include <cstddef>
#include <cstdint>

#include <imgui.h>

namespace lightvane {
namespace {

// ImTextureID is a pointer in old versions of ImGui and a number in new ones: the one cast that converts
// either.
ImTextureID textureId(GLuint texture) {
  return (ImTextureID)(std::uintptr_t)texture;  // NOLINT(performance-no-int-to-ptr): a name, never followed
}
GLuint textureName(ImTextureID id) { return static_cast<GLuint>((std::uintptr_t)id); }

}  // namespace

DrawLists::DrawLists(const Gl& gl, ShaderProgram program)
    : gl_(&gl), program_(std::move(program)), format_(gl), vertices_(gl), indices_(gl) {
  gl.BindVertexArray(format_.id());
  gl.BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.id());
  const auto attribute = [&gl](GLuint location, int count, GLenum type, GLboolean normalised,
                               std::size_t offset) {
    gl.EnableVertexAttribArray(location);
    gl.VertexAttribPointer(location, count, type, normalised, sizeof(ImDrawVert), inBuffer(offset));
  };
  attribute(0, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, pos));
  attribute(1, 2, GL_FLOAT, GL_FALSE, offsetof(ImDrawVert, uv));
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ImDrawVert, col));
}

Expected<DrawLists> DrawLists::create(const Gl& gl, const ShaderSources& sources) {
  Expected<ShaderProgram> program = ShaderProgram::build(gl, sources, "draw_list.vert", "draw_list.frag");
  if (!program) return tl::unexpected(program.error());
  // Lists of more vertices than an index counts.
  ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  return DrawLists(gl, std::move(*program));
}

void DrawLists::uploadFonts() {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  fonts_ = makeTexture(*gl_, GL_LINEAR);
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
  atlas.SetTexID(textureId(fonts_.id()));
}

void DrawLists::draw(const Framebuffer& target, const ImDrawData& data) const {
  const auto setState = [&] {
    target.bind();
    gl_->Enable(GL_SCISSOR_TEST);
    gl_->Enable(GL_BLEND);
    // ImGui's colours are not premultiplied.
    gl_->BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    gl_->ActiveTexture(GL_TEXTURE0);
    gl_->BindVertexArray(format_.id());
    gl_->BindBuffer(GL_ARRAY_BUFFER, vertices_.id());
    program_.use();
    program_.set("image", 0);
    program_.set("displayPosition", Vec2(data.DisplayPos.x, data.DisplayPos.y));
    program_.set("displaySize", Vec2(data.DisplaySize.x, data.DisplaySize.y));
  };
  setState();

  const Vec2 scale(data.FramebufferScale.x, data.FramebufferScale.y);
  const Vec2 origin(data.DisplayPos.x, data.DisplayPos.y);
  for (int i = 0; i < data.CmdListsCount; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    gl_->BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_->BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                    GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback == ImDrawCallback_ResetRenderState) {
        setState();
        continue;
      }
      if (command.UserCallback != nullptr) {
        command.UserCallback(&list, &command);
        continue;
      }
      const Vec2 lower = (Vec2(command.ClipRect.x, command.ClipRect.y) - origin) * scale;
      const Vec2 upper = (Vec2(command.ClipRect.z, command.ClipRect.w) - origin) * scale;
      if (upper.x <= lower.x || upper.y <= lower.y) continue;
      gl_->Scissor(static_cast<GLint>(lower.x),
                   static_cast<GLint>(static_cast<float>(target.height()) - upper.y),
                   static_cast<GLsizei>(upper.x - lower.x), static_cast<GLsizei>(upper.y - lower.y));
      gl_->BindTexture(GL_TEXTURE_2D, textureName(command.GetTexID()));
      const std::size_t firstIndex = command.IdxOffset * sizeof(ImDrawIdx);
      gl_->DrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                                  sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                                  inBuffer(firstIndex), static_cast<GLint>(command.VtxOffset));
    }
  }
  gl_->Disable(GL_SCISSOR_TEST);
}

}  // namespace lightvane
