#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "core/image/image_format.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {

inline void writeBytes(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

struct Size {
  int width;
  int height;
};

inline void PrintTo(const Size& size, std::ostream* out) { *out << size.width << "x" << size.height; }

// One pixel; odd sides, too narrow for runs in HDR; wide enough for them; with runs longer than a code holds.
inline const std::vector<Size> kSizes = {{1, 1}, {7, 5}, {300, 2}, {9, 33}};

/// Names a format in failures and in the names of tests, instead of its address.
inline void PrintTo(const ImageFormat* format, std::ostream* out) { *out << format->extension.substr(1); }

/// Different values in every pixel and component but for a flat stretch, all of them positive.
inline ImageRgb rampImage(Size size) {
  ImageRgb pixels(size.width, size.height);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto i = static_cast<float>(pixels.index(x, y));
      pixels.at(x, y) =
          x >= 20 && x < 280 ? Rgb(0.25f, 0.5f, 4.0f) : Rgb(0.01f + i, 0.3f * i, 1.0f / (1.0f + i));
    }
  }
  return pixels;
}

inline LayeredImage rampPicture(Size size) {
  LayeredImage image;
  image.width = size.width;
  image.height = size.height;
  image.setRgb("", rampImage(size));
  image.metadata = {{"seed", "7"}, {"scene", "Küche = \"a\\nb\"\n# x=y\r\nend\\"}, {"empty", ""}};
  return image;
}

inline void expectSameBits(const ImageFloat& actual, const ImageFloat& expected, const std::string& name) {
  ASSERT_EQ(actual.size(), expected.size()) << name;
  for (std::size_t i = 0; i < actual.size(); ++i) {
    ASSERT_EQ(std::bit_cast<std::uint32_t>(actual[i]), std::bit_cast<std::uint32_t>(expected[i]))
        << name << " at index " << i << ": read " << actual[i] << ", wrote " << expected[i];
  }
}

/// What a float format must be able to hold: quiet NaN with a payload, a signalling one, infinities, negative
/// zero, denormals and the extremes.
inline ImageFloat oddFloats() {
  const std::vector<std::uint32_t> bits = {0x7fc01234U, 0xffc00000U, 0x7f812345U, 0x7f800000U, 0xff800000U,
                                           0x80000000U, 0x00000001U, 0x7f7fffffU, 0x00800000U, 0xc2280000U};
  ImageFloat image(static_cast<int>(bits.size()), 1);
  for (std::size_t i = 0; i < bits.size(); ++i) image[i] = std::bit_cast<float>(bits[i]);
  return image;
}

/// Whatever a decoder makes of `bytes`, it must be an error in one line or a whole picture.
inline void expectErrorOrPicture(const Expected<LayeredImage>& image, const std::string& what) {
  if (!image) {
    EXPECT_FALSE(image.error().what.empty()) << what;
    EXPECT_EQ(image.error().what.find('\n'), std::string::npos) << what << ": " << image.error().what;
    return;
  }
  EXPECT_GT(image->width, 0) << what;
  EXPECT_GT(image->height, 0) << what;
  const auto pixels = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height);
  for (const auto& [name, channel] : image->channels)
    EXPECT_EQ(channel.size(), pixels) << what << ", " << name;
  for (const auto& [name, channel] : image->uintChannels)
    EXPECT_EQ(channel.size(), pixels) << what << ", " << name;
}

}  // namespace lightvane
