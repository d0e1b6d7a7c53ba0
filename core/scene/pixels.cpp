#include "core/scene/pixels.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/image/image_file.h"

namespace lightvane {

namespace {

const std::string kReflectanceRule =
    "what a surface reflects lies in [0, 1]; what shines more takes the color beside its texture";

/// The picture's R, G and B, checked: see loadPixels.
Expected<std::shared_ptr<const ImageRgb>> checkedPixels(const Expected<LayeredImage>& picture,
                                                        const std::string& where, float most,
                                                        const std::string& rule, LoadWatch& watch) {
  if (!picture) return tl::unexpected(picture.error());
  if (!picture->hasRgb()) return makeError(where, "has no R, G and B");
  auto pixels = std::make_shared<ImageRgb>(picture->width, picture->height);
  const ImageFloat& red = picture->channels.at("R");
  const ImageFloat& green = picture->channels.at("G");
  const ImageFloat& blue = picture->channels.at("B");
  for (int y = 0; y < pixels->height(); ++y) {
    watch.look();
    for (int x = 0; x < pixels->width(); ++x) {
      const Rgb& c = pixels->at(x, y) = Rgb(red.at(x, y), green.at(x, y), blue.at(x, y));
      if (c.r >= 0.0f && c.g >= 0.0f && c.b >= 0.0f && maxComponent(c) <= most) continue;
      return makeError(where, fmt::format("pixel ({}, {}) is [{}, {}, {}]: {}", x, y, c.r, c.g, c.b, rule));
    }
  }
  return pixels;
}

Expected<std::shared_ptr<const ImageRgb>> alphaOf(const Expected<LayeredImage>& picture, LoadWatch& watch) {
  if (!picture) return tl::unexpected(picture.error());
  auto pixels = std::make_shared<ImageRgb>(picture->width, picture->height, Rgb(1.0f));
  if (const auto alpha = picture->channels.find("A"); alpha != picture->channels.end()) {
    // A file of floats may hold anything; what is no number hides nothing.
    for (std::size_t i = 0; i < pixels->size(); ++i) {
      watch.piece(i);
      const float value = alpha->second[i];
      (*pixels)[i] = Rgb(value >= 0.0f ? std::min(value, 1.0f) : value < 0.0f ? 0.0f : 1.0f);
    }
  }
  return pixels;
}

Expected<std::shared_ptr<const ImageRgb>> texelsOf(const Expected<LayeredImage>& picture,
                                                   const std::string& where, TextureChannel channel,
                                                   LoadWatch& watch) {
  return channel == TextureChannel::Alpha ? alphaOf(picture, watch)
                                          : checkedPixels(picture, where, 1.0f, kReflectanceRule, watch);
}

}  // namespace

Expected<std::shared_ptr<const ImageRgb>> loadPixels(const std::filesystem::path& path, float most,
                                                     const std::string& rule, LoadWatch& watch) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  return checkedPixels(readImage(path, watch), path.string(), most, rule, watch);
}

Expected<std::shared_ptr<const ImageRgb>> loadTexels(const std::filesystem::path& path,
                                                     TextureChannel channel, LoadWatch& watch) {
  const LoadStage stage(watch, "reading " + path.filename().string());
  return texelsOf(readImage(path, watch), path.string(), channel, watch);
}

Expected<std::shared_ptr<const ImageRgb>> readTexels(std::string_view bytes, const std::string& where,
                                                     TextureChannel channel, LoadWatch& watch) {
  return texelsOf(readImageBytes(bytes, where, watch), where, channel, watch);
}

}  // namespace lightvane
