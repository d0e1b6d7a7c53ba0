#include "app/gl/framebuffer.h"

#include <algorithm>

namespace lightvane {

Framebuffer::Framebuffer(const Gl& gl, int width, int height)
    : gl_(&gl),
      width_(std::max(width, 1)),
      height_(std::max(height, 1)),
      color_(makeTexture(gl, GL_NEAREST)),
      framebuffer_(gl) {
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color_.id(), 0);
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  LV_CHECK(status == GL_FRAMEBUFFER_COMPLETE, "status {:#x} of a {} x {} framebuffer", status, width_,
           height_);
}

void Framebuffer::bind() const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_->Viewport(0, 0, width_, height_);
}

void Framebuffer::bind(const Placement& placement) const {
  gl_->BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  gl_->Viewport(placement.left, height_ - placement.top - placement.height, placement.width,
                placement.height);
}

void Framebuffer::clear(const Color8& color) const {
  bind();
  const auto unit = [](std::uint8_t byte) { return static_cast<float>(byte) / 255.0f; };
  gl_->ClearColor(unit(color.r), unit(color.g), unit(color.b), unit(color.a));
  gl_->Clear(GL_COLOR_BUFFER_BIT);
}

void Framebuffer::fill(int left, int top, int width, int height, const Color8& color) const {
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(left, height_ - top - height, std::max(width, 0), std::max(height, 0));
  clear(color);
  gl_->Disable(GL_SCISSOR_TEST);
}

Image<Color8> Framebuffer::read() const {
  Image<Color8> bottomUp(width_, height_);
  gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  gl_->PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl_->ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bottomUp.data());
  Image<Color8> topDown(width_, height_);
  for (int y = 0; y < height_; ++y) {
    std::copy_n(&bottomUp.at(0, height_ - 1 - y), width_, &topDown.at(0, y));
  }
  return topDown;
}

void Framebuffer::copyTo(const Framebuffer& target) const {
  LV_CHECK(width_ == target.width_ && height_ == target.height_, "{} x {} to {} x {}", width_, height_,
           target.width_, target.height_);
  copyTo(target.framebuffer_.id());
}

void Framebuffer::copyToWindow() const { copyTo(0); }

void Framebuffer::copyTo(GLuint framebuffer) const {
  gl_->BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
  gl_->BindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  gl_->BlitFramebuffer(0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void blendPremultiplied(const Gl& gl) {
  gl.Enable(GL_BLEND);
  gl.BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

}  // namespace lightvane
