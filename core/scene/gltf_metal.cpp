#include "core/scene/gltf_metal.h"

#include <optional>

#include "core/scene/texture.h"

namespace lightvane {
namespace {

/// What a picture shows where there may be none.
class MaybePicture {
 public:
  explicit MaybePicture(const ImageTextureDescription* image) {
    if (image != nullptr) texture_.emplace(TextureDescription{"", *image});
  }
  Rgb at(const Vec2& uv) const { return texture_ ? texture_->at({}, uv) : Rgb(1.0f); }

 private:
  std::optional<Texture> texture_;
};

/// The values that a picture stores, which was decoded as if they were of a colour.
ImageTextureDescription asStored(ImageTextureDescription image, LoadWatch& watch) {
  auto stored = std::make_shared<ImageRgb>(image.pixels->width(), image.pixels->height());
  for (std::size_t i = 0; i < stored->size(); ++i) {
    watch.piece(i);
    (*stored)[i] = Rgb(encodeSrgb((*image.pixels)[i].b));
  }
  image.pixels = std::move(stored);
  return image;
}

/// The picture over the greatest value of each of its channels.
BakedColor overItsMost(ImageRgb pixels) {
  BakedColor baked;
  for (const Rgb& pixel : pixels) baked.most = glm::max(baked.most, pixel);
  if (isBlack(baked.most)) return baked;
  for (Rgb& pixel : pixels) {
    for (int c = 0; c < 3; ++c) pixel[c] = baked.most[c] > 0.0f ? pixel[c] / baked.most[c] : 0.0f;
  }
  baked.pixels = std::make_shared<const ImageRgb>(std::move(pixels));
  return baked;
}

}  // namespace

glm::ivec2 bakedSize(const MetalMixture& mixture) {
  glm::ivec2 size(1);
  for (const ImageTextureDescription* image : {mixture.base, mixture.metal}) {
    if (image != nullptr) size = glm::max(size, glm::ivec2(image->pixels->width(), image->pixels->height()));
  }
  return size;
}

BakedMetal bakeMetal(const MetalMixture& mixture, LoadWatch& watch) {
  const MaybePicture base(mixture.base);
  std::optional<ImageTextureDescription> stored;
  if (mixture.metal != nullptr) stored = asStored(*mixture.metal, watch);
  const MaybePicture metal(stored ? &*stored : nullptr);
  const glm::ivec2 size = bakedSize(mixture);
  ImageRgb diffuse(size.x, size.y);
  ImageRgb layer(size.x, size.y);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const std::size_t i = diffuse.index(x, y);
      watch.piece(i);
      // v rises from the picture's bottom.
      const Vec2 uv((static_cast<float>(x) + 0.5f) / static_cast<float>(size.x),
                    1.0f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size.y));
      const Rgb color = base.at(uv);
      const float share = mixture.metallic * metal.at(uv).b;
      diffuse[i] = color * (1.0f - share);
      layer[i] = glm::mix(mixture.dielectric, mixture.layerBase * color, share);
    }
  }
  return {overItsMost(std::move(diffuse)), overItsMost(std::move(layer))};
}

}  // namespace lightvane
