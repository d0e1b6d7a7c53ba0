#include "core/image/image.h"

#include <array>

namespace lightvane {
namespace {

constexpr std::array<const char*, 3> kRgbSuffixes = {"R", "G", "B"};

std::string channelName(const std::string& layer, int component) {
  const std::string suffix = kRgbSuffixes[static_cast<std::size_t>(component)];
  return layer.empty() ? suffix : layer + "." + suffix;
}

}  // namespace

void LayeredImage::setRgb(const std::string& layer, const ImageRgb& pixels) {
  LV_CHECK(pixels.width() == width && pixels.height() == height, "layer '{}' is {}x{}, the picture is {}x{}",
           layer, pixels.width(), pixels.height(), width, height);
  for (int component = 0; component < 3; ++component) {
    ImageFloat& channel = channels[channelName(layer, component)];
    channel = ImageFloat(width, height);
    for (std::size_t i = 0; i < pixels.size(); ++i) channel[i] = pixels[i][component];
  }
}

ImageRgb LayeredImage::rgb(const std::string& layer) const {
  ImageRgb pixels(width, height, Rgb(0.0f));
  for (int component = 0; component < 3; ++component) {
    const auto channel = channels.find(channelName(layer, component));
    if (channel == channels.end()) continue;
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i][component] = channel->second[i];
  }
  return pixels;
}

bool LayeredImage::hasRgb(const std::string& layer) const {
  for (int component = 0; component < 3; ++component) {
    if (!channels.contains(channelName(layer, component))) return false;
  }
  return true;
}

}  // namespace lightvane
