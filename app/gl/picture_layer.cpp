#include "app/gl/picture_layer.h"

#include <cstring>

namespace lightvane {
namespace {

/// High enough that calls cost nothing beside the pixels, low enough that a finished tile does not upload a
/// picture: two rows of the renderer's tiles.
constexpr int kBandRows = 64;

/// Whether a developed picture serves both.
bool sameColors(const PictureStyle& a, const PictureStyle& b) {
  return a.exposureStops == b.exposureStops && a.toneMap == b.toneMap && a.scale.low == b.scale.low &&
         a.scale.high == b.scale.high && a.scale.logarithmic == b.scale.logarithmic;
}

}  // namespace

int PictureTexture::upload(const ViewImage& image, std::span<const Color8, 256> table) {
  if (image.empty()) {
    *this = PictureTexture(*gl_);
    return 0;
  }
  const auto rowLength = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels());
  LV_CHECK(image.values.size() == rowLength * static_cast<std::size_t>(image.height),
           "{} values, {} x {} pixels", image.values.size(), image.width, image.height);
  uploadColors(image, table);

  const bool threeValues = image.channels() == 3;
  const GLenum format = threeValues ? GL_RGB : GL_RED;
  const bool sameShape =
      width_ == image.width && height_ == image.height && uploaded_.size() == image.values.size();
  gl_->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (!sameShape) {
    values_ = makeTexture(*gl_, GL_NEAREST);
    gl_->TexImage2D(GL_TEXTURE_2D, 0, threeValues ? GL_RGB32F : GL_R32F, image.width, image.height, 0, format,
                    GL_FLOAT, nullptr);
    uploaded_.resize(image.values.size());
    developed_ = std::make_unique<Framebuffer>(*gl_, image.width, image.height);
  }
  gl_->BindTexture(GL_TEXTURE_2D, values_.id());
  width_ = image.width;
  height_ = image.height;
  kind_ = image.kind;

  int rows = 0;
  for (int top = 0; top < height_; top += kBandRows) {
    const int bandRows = std::min(kBandRows, height_ - top);
    const std::size_t first = static_cast<std::size_t>(top) * rowLength;
    const std::size_t count = static_cast<std::size_t>(bandRows) * rowLength;
    const float* values = &image.values[first];
    // By bytes: NaN equals itself.
    if (sameShape && std::memcmp(values, &uploaded_[first], count * sizeof(float)) == 0) continue;
    gl_->TexSubImage2D(GL_TEXTURE_2D, 0, 0, top, width_, bandRows, format, GL_FLOAT, values);
    std::copy_n(values, count, &uploaded_[first]);
    rows += bandRows;
  }
  stale_ |= rows > 0;
  return rows;
}

void PictureTexture::uploadColors(const ViewImage& image, std::span<const Color8, 256> table) {
  std::vector<Color8> colors(table.begin(), table.end());
  if (image.kind == ViewKind::Categories) {
    categoryCount_ = static_cast<int>(image.categories.size());
    LV_CHECK(image.categories.size() <= colors.size(), "{} categories", image.categories.size());
    for (std::size_t i = 0; i < image.categories.size(); ++i) colors[i] = image.categories[i].color;
  }
  if (colors == uploadedColors_) return;
  if (colors_.id() == 0) colors_ = makeTexture(*gl_, GL_NEAREST);
  gl_->BindTexture(GL_TEXTURE_2D, colors_.id());
  gl_->TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(colors.size()), 1, 0, GL_RGBA,
                  GL_UNSIGNED_BYTE, colors.data());
  uploadedColors_ = std::move(colors);
  stale_ = true;
}

Expected<PictureLayer> PictureLayer::create(const Gl& gl, const ShaderSources& sources) {
  Expected<ShaderProgram> develop = ShaderProgram::build(gl, sources, "screen.vert", "picture_develop.frag");
  if (!develop) return tl::unexpected(develop.error());
  Expected<ShaderProgram> show = ShaderProgram::build(gl, sources, "screen.vert", "picture.frag");
  if (!show) return tl::unexpected(show.error());
  return PictureLayer(gl, std::move(*develop), std::move(*show));
}

// Apart from drawing, since a picture has fewer pixels than the screen that shows it, and is looked at for
// longer than it changes.
void PictureLayer::develop(PictureTexture& picture, const PictureStyle& style) const {
  if (picture.empty() || (!picture.stale_ && sameColors(style, picture.developedStyle_))) return;
  picture.developedStyle_ = style;
  picture.stale_ = false;
  picture.developed_->bind();
  gl_->Disable(GL_BLEND);
  gl_->ActiveTexture(GL_TEXTURE1);
  gl_->BindTexture(GL_TEXTURE_2D, picture.colors_.id());
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, picture.values_.id());
  develop_.use();
  develop_.set("values", 0);
  develop_.set("colors", 1);
  develop_.set("kind", static_cast<int>(picture.kind_));
  develop_.set("gain", std::exp2(style.exposureStops));
  develop_.set("toneMap", static_cast<int>(style.toneMap));
  const auto onScale = [&](float value) {
    return style.scale.logarithmic ? std::log2(std::max(value, std::numeric_limits<float>::min())) : value;
  };
  develop_.set("low", onScale(style.scale.low));
  develop_.set("high", onScale(style.scale.high));
  develop_.set("logarithmic", style.scale.logarithmic);
  develop_.set("categoryCount", picture.categoryCount_);
  gl_->BindVertexArray(corners_.id());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
}

void PictureLayer::draw(const Framebuffer& target, PictureTexture& picture, const PictureStyle& style,
                        const Placement& placement) const {
  if (picture.empty()) return;
  develop(picture, style);
  target.bind(placement);
  blendPremultiplied(*gl_);
  gl_->ActiveTexture(GL_TEXTURE0);
  gl_->BindTexture(GL_TEXTURE_2D, picture.developed_->texture().id());
  show_.use();
  show_.set("picture", 0);
  const Vec2 corner = placement.toFramebuffer(Vec2(0.0f));
  show_.set("corner", Vec2(corner.x, static_cast<float>(target.height()) - corner.y));
  show_.set("zoom", placement.zoom);
  show_.set("smoothly", style.smooth && placement.zoom > 1.0f);
  gl_->BindVertexArray(corners_.id());
  gl_->DrawArrays(GL_TRIANGLES, 0, 3);
}

void PictureLayer::drawWipe(const Framebuffer& target, PictureTexture& left, const PictureStyle& leftStyle,
                            PictureTexture& right, const PictureStyle& rightStyle, const Placement& placement,
                            float position, int lineWidth) const {
  const int border =
      static_cast<int>(std::lround(std::clamp(position, 0.0f, 1.0f) * static_cast<float>(placement.width)));
  const int bottom = target.height() - placement.top - placement.height;
  // All of them, before the scissors are out.
  develop(left, leftStyle);
  develop(right, rightStyle);
  gl_->Enable(GL_SCISSOR_TEST);
  gl_->Scissor(placement.left, bottom, border, placement.height);
  draw(target, left, leftStyle, placement);
  gl_->Scissor(placement.left + border, bottom, placement.width - border, placement.height);
  draw(target, right, rightStyle, placement);
  gl_->Disable(GL_SCISSOR_TEST);

  const int lineLeft = std::max(border - lineWidth / 2, 0),
            lineRight = std::min(border - lineWidth / 2 + lineWidth, placement.width);
  target.fill(placement.left + lineLeft, placement.top, lineRight - lineLeft, placement.height,
              {255, 255, 255, 255});
}

}  // namespace lightvane
