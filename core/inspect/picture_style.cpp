#include "core/inspect/picture_style.h"

#include <cmath>
#include <limits>

#include "core/base/color.h"

// shaders/picture_develop.frag says the same in GLSL: change both.

namespace lightvane {
namespace {

constexpr Color8 kInvalidLight = {255, 0, 255, 255}, kInvalidDark = {160, 0, 160, 255};
constexpr Color8 kNoneLight = {92, 92, 92, 255}, kNoneDark = {76, 76, 76, 255};

std::uint8_t toByte(float unit) { return static_cast<std::uint8_t>(std::lround(unit * 255.0f)); }

/// https://github.com/TheRealMJP/BakingLab, ACES.hlsl: Stephen Hill's fit of the reference rendering
/// transform with the output transform for sRGB. glm's matrices are written by columns.
Rgb filmic(const Rgb& radiance) {
  static const glm::mat3 toFilm(0.59719f, 0.07600f, 0.02840f,  //
                                0.35458f, 0.90834f, 0.13383f,  //
                                0.04823f, 0.01566f, 0.83777f);
  static const glm::mat3 toScreen(1.60475f, -0.10208f, -0.00327f,  //
                                  -0.53108f, 1.10813f, -0.07276f,  //
                                  -0.07367f, -0.00605f, 1.07602f);
  const Rgb v = toFilm * radiance;
  return toScreen * ((v * (v + 0.0245786f) - 0.000090537f) / (v * (0.983729f * v + 0.4329510f) + 0.238081f));
}

Rgb toneMapped(const Rgb& radiance, ToneMap map) {
  switch (map) {
    case ToneMap::Reinhard:
      return radiance / (1.0f + luminance(radiance));
    case ToneMap::Filmic:
      return filmic(radiance);
    case ToneMap::Clip:
      break;
  }
  return radiance;
}

/// Where a value lies on its scale, 0 to 1.
float onScale(float value, const ViewScale& scale) {
  if (scale.logarithmic) {
    // The smallest normal number stands for what has no logarithm.
    constexpr float kTiny = std::numeric_limits<float>::min();
    const float low = std::log2(std::max(scale.low, kTiny)), high = std::log2(std::max(scale.high, kTiny));
    return std::clamp((std::log2(std::max(value, kTiny)) - low) / std::max(high - low, 1e-6f), 0.0f, 1.0f);
  }
  return std::clamp((value - scale.low) / std::max(scale.high - scale.low, 1e-30f), 0.0f, 1.0f);
}

Color8 fromTable(float unit, std::span<const Color8, 256> table) {
  const float at = unit * 255.0f;
  const auto below = static_cast<std::size_t>(at);
  const float part = at - static_cast<float>(below);
  const Color8 a = table[below], b = table[std::min<std::size_t>(below + 1, 255)];
  const auto between = [part](std::uint8_t x, std::uint8_t y) {
    return static_cast<std::uint8_t>(std::lround(static_cast<float>(x) + part * static_cast<float>(y - x)));
  };
  return {between(a.r, b.r), between(a.g, b.g), between(a.b, b.b), 255};
}

}  // namespace

Color8 screenColor(const Rgb& linear) {
  return {toByte(encodeSrgb(linear.r)), toByte(encodeSrgb(linear.g)), toByte(encodeSrgb(linear.b)), 255};
}

PictureStyle styleFor(const PictureLook& look, const ViewImage& image, double cameraExposureStops) {
  PictureStyle style;
  style.exposureStops = static_cast<float>(cameraExposureStops) + look.exposureStops;
  style.toneMap = look.toneMap;
  style.scale = image.scale;
  style.scale.map = look.scale.map.value_or(style.scale.map);
  if (look.scale.fixedRange) {
    style.scale.low = look.scale.low;
    style.scale.high = look.scale.high;
  }
  return style;
}

Color8 displayColor(const ViewImage& image, int x, int y, const PictureStyle& style,
                    std::span<const Color8, 256> table) {
  const float* value = image.pixel(x, y);
  const Color8 none = ((x / 8 + y / 8) % 2 == 0) ? kNoneLight : kNoneDark;
  if (image.kind == ViewKind::Radiance) {
    const Rgb radiance(value[0], value[1], value[2]);
    if (!isValidSample(radiance)) return (x + y) % 2 == 0 ? kInvalidLight : kInvalidDark;
    // White in every tone map, and its square does not overflow.
    constexpr Rgb kBrightest(1e6f);
    return screenColor(
        toneMapped(glm::min(radiance * std::exp2(style.exposureStops), kBrightest), style.toneMap));
  }
  if (std::isnan(value[0])) return none;
  if (image.kind == ViewKind::Color) return screenColor(Rgb(value[0], value[1], value[2]));
  if (image.kind == ViewKind::Scalar) return fromTable(onScale(value[0], style.scale), table);
  const float category = std::round(value[0]);
  if (!(category >= 0.0f && category < static_cast<float>(image.categories.size()))) return none;
  Color8 color = image.categories[static_cast<std::size_t>(category)].color;
  color.a = 255;
  return color;
}

Image<Color8> displayColors(const ViewImage& image, const PictureStyle& style) {
  const std::span<const Color8, 256> table = colorTable(style.scale.map);
  Image<Color8> pixels(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) pixels.at(x, y) = displayColor(image, x, y, style, table);
  }
  return pixels;
}

LayeredImage filePicture(const Image<Color8>& pixels) {
  LayeredImage image;
  image.width = pixels.width();
  image.height = pixels.height();
  ImageRgb colors(image.width, image.height);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Color8& c = pixels[i];
    colors[i] = {decodeSrgb(static_cast<float>(c.r) / 255.0f), decodeSrgb(static_cast<float>(c.g) / 255.0f),
                 decodeSrgb(static_cast<float>(c.b) / 255.0f)};
  }
  image.setRgb("", colors);
  return image;
}

LayeredImage screenPicture(const RenderFrame& frame, const PictureLook& look, const ViewSources& sources) {
  ViewSources shown = sources;
  shown.source = look.source;
  const ViewImage view = viewImage(frame, look.view, shown);
  return filePicture(displayColors(view, styleFor(look, view, frame.camera.exposureStops)));
}

}  // namespace lightvane
