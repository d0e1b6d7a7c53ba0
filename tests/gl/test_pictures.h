#pragma once

#include <array>

#include "core/inspect/picture_style.h"

namespace lightvane {

/// A colour map of five colours, from dark blue to yellow.
inline std::array<Color8, 256> testTable() {
  constexpr std::array<Rgb, 5> kColors = {Rgb(0.27f, 0.00f, 0.33f), Rgb(0.23f, 0.32f, 0.55f),
                                          Rgb(0.13f, 0.57f, 0.55f), Rgb(0.37f, 0.79f, 0.38f),
                                          Rgb(0.99f, 0.91f, 0.15f)};
  std::array<Color8, 256> table{};
  for (std::size_t i = 0; i < 256; ++i) {
    const float at = static_cast<float>(i) / 255.0f * 4.0f;
    const std::size_t below = std::min<std::size_t>(static_cast<std::size_t>(at), 3);
    const Rgb c = 255.0f * glm::mix(kColors[below], kColors[below + 1], at - static_cast<float>(below));
    table[i] = {static_cast<std::uint8_t>(c.r), static_cast<std::uint8_t>(c.g),
                static_cast<std::uint8_t>(c.b), 255};
  }
  return table;
}

inline ViewImage makeView(ViewKind kind, int width, int height) {
  ViewImage image;
  image.kind = kind;
  image.width = width;
  image.height = height;
  image.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                      static_cast<std::size_t>(image.channels()));
  return image;
}

/// Twelve stops from left to right; hues from the top down, grey in the lowest quarter.
inline ViewImage radianceRamp(int width, int height) {
  ViewImage image = makeView(ViewKind::Radiance, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float stops = 12.0f * static_cast<float>(x) / static_cast<float>(width - 1) - 8.0f;
      const float hue = kTwoPi * static_cast<float>(y) / (0.75f * static_cast<float>(height));
      const bool grey = 4 * y >= 3 * height;
      for (int c = 0; c < 3; ++c) {
        const float tint = grey ? 1.0f : 0.5f + 0.45f * std::cos(hue - kTwoPi * static_cast<float>(c) / 3.0f);
        image.values[static_cast<std::size_t>((y * width + x) * 3 + c)] = tint * std::exp2(stops);
      }
    }
  }
  return image;
}

/// A round hill from 0.001 to 1, and nothing (NaN) outside of it.
inline ViewImage scalarHill(int width, int height) {
  ViewImage image = makeView(ViewKind::Scalar, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Vec2 from = Vec2(x, y) / Vec2(width, height) * 2.0f - 1.0f;
      const float r = glm::length(from);
      image.values[static_cast<std::size_t>(y * width + x)] =
          r > 0.95f ? std::numeric_limits<float>::quiet_NaN() : std::pow(10.0f, -3.0f * r);
    }
  }
  return image;
}

inline ViewImage categoryBlocks(int width, int height) {
  ViewImage image = makeView(ViewKind::Categories, width, height);
  image.categories = {
      {"seed", {230, 159, 0, 255}}, {"full", {86, 180, 233, 255}}, {"interpolated", {0, 158, 115, 255}}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int block = (4 * x / width + 3 * y / height) % 4;
      image.values[static_cast<std::size_t>(y * width + x)] =
          block == 3 ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(block);
    }
  }
  return image;
}

inline ViewImage colorSquares(int width, int height) {
  ViewImage image = makeView(ViewKind::Color, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float* pixel = &image.values[static_cast<std::size_t>((y * width + x) * 3)];
      pixel[0] = static_cast<float>(x) / static_cast<float>(width - 1);
      pixel[1] = static_cast<float>(y) / static_cast<float>(height - 1);
      pixel[2] = (x / 8 + y / 8) % 2 == 0 ? 0.15f : 0.6f;
    }
  }
  return image;
}

}  // namespace lightvane
