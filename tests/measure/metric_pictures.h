#pragma once

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/image/image.h"
#include "core/measure/metric.h"

namespace lightvane {

/// The metric of this name, which must exist.
inline const MetricInfo& metricNamed(std::string_view name) {
  const MetricInfo* found = findMetric(name);
  if (found == nullptr) throw std::runtime_error("no metric " + std::string(name));
  return *found;
}

inline MetricResult measure(std::string_view name, const MetricInput& input) {
  return metricNamed(name).compute(input);
}

inline double valueOf(std::string_view name, const ImageRgb& picture, const ImageRgb& reference) {
  return measure(name, {.picture = picture, .reference = reference}).value;
}

/// Evenly distributed numbers of this deviation about 0, addressed by pixel and colour.
inline void addNoise(ImageRgb& image, float deviation, std::uint64_t seed) {
  const RandomKey key = randomKey(seed);
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float number = uniform(key, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(c));
      image[i][c] += deviation * std::sqrt(3.0f) * (2.0f * number - 1.0f);
    }
  }
}

/// Colours in (0, 1) without any order.
inline ImageRgb randomPicture(int width, int height, std::uint64_t seed) {
  ImageRgb image(width, height);
  const RandomKey key = randomKey(seed);
  for (std::size_t i = 0; i < image.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      image[i][c] =
          0.01f + 0.98f * uniform(key, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(c));
  }
  return image;
}

inline ImageRgb scaledPicture(ImageRgb image, float factor) {
  for (Rgb& pixel : image) pixel *= factor;
  return image;
}

inline double largestOf(const ImageFloat& map) {
  double largest = 0.0;
  for (const float value : map) largest = std::max(largest, static_cast<double>(value));
  return largest;
}

/// The patterns of tests/measure/flip_test.cpp and ssim_test.cpp: 24x18 pixels whose colours are 32nds, exact
/// in float, with texture, flat parts and a disc that differs.
inline ImageRgb patternPicture(bool reference) {
  ImageRgb image(24, 18);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        int value = x * 7 + y * 13 + c * 5 + x * y * 3;
        if (!reference) {
          if ((x - 12) * (x - 12) + (y - 9) * (y - 9) < 30) value += 4;
          value += c * (x / 6);
        }
        image.at(x, y)[c] = static_cast<float>(value % 32) / 32.0f;
      }
    }
  }
  return image;
}

}  // namespace lightvane
