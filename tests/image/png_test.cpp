#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "tests/image/test_images.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LayeredImage greyPixels(const std::vector<float>& values) {
  LayeredImage image;
  image.width = static_cast<int>(values.size());
  image.height = 1;
  ImageRgb pixels(image.width, 1);
  for (std::size_t i = 0; i < values.size(); ++i) pixels[i] = Rgb(values[i]);
  image.setRgb("", pixels);
  return image;
}

struct Chunk {
  std::string type;
  std::string data;
};

std::vector<Chunk> chunksOf(const std::string& bytes) {
  std::vector<Chunk> chunks;
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size = size << 8 | static_cast<unsigned char>(bytes[at + i]);
    chunks.push_back({bytes.substr(at + 4, 4), bytes.substr(at + 8, size)});
    at += 12 + size;
  }
  return chunks;
}

// The 8-bit codes in the file, by libpng's simplified interface.
std::vector<int> codesOf(const std::string& bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_TRUE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()));
  image.format = PNG_FORMAT_RGB;
  std::vector<png_byte> codes(PNG_IMAGE_SIZE(image));
  EXPECT_TRUE(png_image_finish_read(&image, nullptr, codes.data(), 0, nullptr));
  return {codes.begin(), codes.end()};
}

std::vector<int> greyCodesOf(const std::string& bytes) {
  const std::vector<int> all = codesOf(bytes);
  std::vector<int> grey;
  for (std::size_t i = 0; i < all.size(); i += 3) {
    EXPECT_TRUE(all[i] == all[i + 1] && all[i] == all[i + 2]) << "pixel " << i / 3;
    grey.push_back(all[i]);
  }
  return grey;
}

TEST(Png, EncodesTheCodesOfSrgb) {
  // IEC 61966-2-1: linear 0.18 is 117.6 of 255, 0.5 is 187.5 and a bit, 0.0031308 (where the line ends)
  // is 10.3.
  const LayeredImage image = greyPixels({0.0f, 0.0031308f, 0.18f, 0.5f, 1.0f, 7.0f});
  EXPECT_THAT(greyCodesOf(*kPngFormat.encode(image)), ElementsAre(0, 10, 118, 188, 255, 255));
}

TEST(Png, EncodesNanNegativeAndInfinite) {
  const LayeredImage image = greyPixels({kNan, -1.0f, -kInfinity, kInfinity, -0.0f});
  EXPECT_THAT(greyCodesOf(*kPngFormat.encode(image)), ElementsAre(0, 0, 0, 255, 0));
}

TEST(Png, KeepsEveryCode) {
  std::vector<float> values;
  for (int code = 0; code < 256; ++code) values.push_back(decodeSrgb(static_cast<float>(code) / 255.0f));
  const Expected<LayeredImage> read = kPngFormat.decode(*kPngFormat.encode(greyPixels(values)));
  ASSERT_TRUE(read) << read.error().message();
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(read->channels.at("G")[i], values[i]) << i;
}

TEST(Png, KeepsPixelsInPlace) {
  for (const Size size : kSizes) {
    const LayeredImage written = rampPicture(size);
    const Expected<LayeredImage> read = kPngFormat.decode(*kPngFormat.encode(written));
    ASSERT_TRUE(read) << read.error().message();
    for (const auto& [name, channel] : written.channels) {
      for (std::size_t i = 0; i < channel.size(); ++i) {
        // Half a code, in encoded values.
        ASSERT_NEAR(encodeSrgb(read->channels.at(name)[i]), encodeSrgb(channel[i]), 0.501f / 255.0f)
            << name << " at index " << i;
      }
    }
  }
}

TEST(Png, SaysThatItIsSrgbAndCarriesTexts) {
  LayeredImage image = rampPicture({7, 5});
  image.metadata = {{"ascii", "7"}, {"utf8", "Küche"}};
  const std::vector<Chunk> chunks = chunksOf(*kPngFormat.encode(image));
  std::vector<std::string> types;
  for (const Chunk& chunk : chunks) types.push_back(chunk.type);
  EXPECT_THAT(types, ElementsAre("IHDR", "gAMA", "sRGB", "cHRM", "tEXt", "iTXt", "IDAT", "IEND"));
  EXPECT_EQ(chunks[4].data, std::string("ascii\0007", 7));
  EXPECT_THAT(chunks[5].data, HasSubstr("Küche"));
}

// A file of another kind than ours, from rows of samples as libpng takes them.
struct Foreign {
  int width;
  int height;
  int colourType;
  int bitDepth;
  std::vector<png_byte> samples;
  int interlace = PNG_INTERLACE_NONE;
  double gamma = 0.0;
  std::vector<png_color> palette = {};
  std::vector<png_byte> paletteAlpha = {};
  const char* latin1Text = nullptr;
};

std::string encodeForeign(Foreign foreign) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
      },
      [](png_structp) {});
  png_set_IHDR(png, info, static_cast<png_uint_32>(foreign.width), static_cast<png_uint_32>(foreign.height),
               foreign.bitDepth, foreign.colourType, foreign.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (foreign.gamma > 0.0) png_set_gAMA(png, info, foreign.gamma);
  if (!foreign.palette.empty()) {
    png_set_PLTE(png, info, foreign.palette.data(), static_cast<int>(foreign.palette.size()));
  }
  if (!foreign.paletteAlpha.empty()) {
    png_set_tRNS(png, info, foreign.paletteAlpha.data(), static_cast<int>(foreign.paletteAlpha.size()),
                 nullptr);
  }
  std::string key = "author";
  std::string value = foreign.latin1Text == nullptr ? "" : foreign.latin1Text;
  if (!value.empty()) {
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data();
    text.text = value.data();
    png_set_text(png, info, &text, 1);
  }
  std::vector<png_bytep> rows;
  const std::size_t rowBytes = foreign.samples.size() / static_cast<std::size_t>(foreign.height);
  for (int y = 0; y < foreign.height; ++y) {
    rows.push_back(foreign.samples.data() + static_cast<std::size_t>(y) * rowBytes);
  }
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

LayeredImage decodeForeign(const Foreign& foreign) {
  const Expected<LayeredImage> read = kPngFormat.decode(encodeForeign(foreign));
  EXPECT_TRUE(read) << read.error().message();
  return read ? *read : LayeredImage{};
}

TEST(ForeignPng, ReadsSixteenBits) {
  const LayeredImage read =
      decodeForeign({.width = 2,
                     .height = 1,
                     .colourType = PNG_COLOR_TYPE_RGB,
                     .bitDepth = 16,
                     .samples = {0x80, 0x01, 0x00, 0x01, 0xff, 0xff, 0x00, 0x00, 0xff, 0x00, 0x12, 0x34}});
  EXPECT_EQ(read.rgb().at(0, 0), Rgb(decodeSrgb(0x8001 / 65535.0f), decodeSrgb(1 / 65535.0f), 1.0f));
  EXPECT_EQ(read.rgb().at(1, 0), Rgb(0.0f, decodeSrgb(0xff00 / 65535.0f), decodeSrgb(0x1234 / 65535.0f)));
  EXPECT_FALSE(read.channels.contains("A"));
}

TEST(ForeignPng, ReadsGreyOfEveryDepth) {
  // Two pixels, white and black, then a third at the depth's first step.
  const std::vector<std::pair<int, std::vector<png_byte>>> rows = {
      {1, {0xa0}},
      {2, {0xc4}},
      {4, {0xf0, 0x10}},
      {8, {0xff, 0x00, 0x01}},
      {16, {0xff, 0xff, 0x00, 0x00, 0x00, 0x01}}};
  for (const auto& [depth, samples] : rows) {
    const LayeredImage read = decodeForeign(
        {.width = 3, .height = 1, .colourType = PNG_COLOR_TYPE_GRAY, .bitDepth = depth, .samples = samples});
    const float step = decodeSrgb(1.0f / static_cast<float>((1 << depth) - 1));
    EXPECT_EQ(read.rgb().at(0, 0), Rgb(1.0f)) << depth;
    EXPECT_EQ(read.rgb().at(1, 0), Rgb(0.0f)) << depth;
    EXPECT_EQ(read.rgb().at(2, 0), Rgb(step)) << depth;
  }
}

TEST(ForeignPng, ReadsAlphaApartFromColour) {
  const LayeredImage grey = decodeForeign({.width = 1,
                                           .height = 1,
                                           .colourType = PNG_COLOR_TYPE_GRAY_ALPHA,
                                           .bitDepth = 8,
                                           .samples = {0xff, 0x33}});
  EXPECT_EQ(grey.rgb().at(0, 0), Rgb(1.0f));
  EXPECT_EQ(grey.channels.at("A").at(0, 0), 0x33 / 255.0f);
  const LayeredImage colour = decodeForeign({.width = 1,
                                             .height = 1,
                                             .colourType = PNG_COLOR_TYPE_RGB_ALPHA,
                                             .bitDepth = 8,
                                             .samples = {0xff, 0x00, 0x80, 0x00}});
  EXPECT_EQ(colour.rgb().at(0, 0), Rgb(1.0f, 0.0f, decodeSrgb(0x80 / 255.0f)));
  EXPECT_EQ(colour.channels.at("A").at(0, 0), 0.0f);
}

TEST(ForeignPng, ReadsPalettes) {
  const LayeredImage read = decodeForeign({.width = 3,
                                           .height = 1,
                                           .colourType = PNG_COLOR_TYPE_PALETTE,
                                           .bitDepth = 2,
                                           .samples = {0x90},
                                           .palette = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}},
                                           .paletteAlpha = {0x33}});
  EXPECT_EQ(read.rgb().at(0, 0), Rgb(0.0f, 0.0f, 1.0f));
  EXPECT_EQ(read.rgb().at(1, 0), Rgb(0.0f, 1.0f, 0.0f));
  EXPECT_EQ(read.rgb().at(2, 0), Rgb(1.0f, 0.0f, 0.0f));
  EXPECT_EQ(read.channels.at("A").at(0, 0), 1.0f);
  EXPECT_EQ(read.channels.at("A").at(2, 0), 0x33 / 255.0f);
}

TEST(ForeignPng, ReadsInterlaced) {
  Foreign foreign{.width = 9,
                  .height = 7,
                  .colourType = PNG_COLOR_TYPE_GRAY,
                  .bitDepth = 8,
                  .samples = {},
                  .interlace = PNG_INTERLACE_ADAM7};
  for (png_byte i = 0; i < 63; ++i) foreign.samples.push_back(i);
  const LayeredImage read = decodeForeign(foreign);
  for (std::size_t i = 0; i < 63; ++i) {
    EXPECT_EQ(read.channels.at("R")[i], decodeSrgb(static_cast<float>(i) / 255.0f)) << i;
  }
}

// glTF wants it so, and pictures of numbers are given back as they are stored by no other way.
TEST(ForeignPng, IsReadAsSrgbWhateverItsGamma) {
  for (const double gamma : {1.0, 0.5, 0.45455, 0.1}) {
    const LayeredImage read = decodeForeign({.width = 1,
                                             .height = 1,
                                             .colourType = PNG_COLOR_TYPE_GRAY,
                                             .bitDepth = 8,
                                             .samples = {0x80},
                                             .gamma = gamma});
    EXPECT_EQ(read.rgb().at(0, 0).r, decodeSrgb(0x80 / 255.0f)) << gamma;
  }
}

TEST(ForeignPng, ReadsLatin1Texts) {
  const LayeredImage read = decodeForeign({.width = 1,
                                           .height = 1,
                                           .colourType = PNG_COLOR_TYPE_GRAY,
                                           .bitDepth = 8,
                                           .samples = {0},
                                           .latin1Text = "J\xfcrgen"});
  EXPECT_EQ(read.metadata.at("author"), "Jürgen");
}

TEST(ForeignPng, RefusesHugeSizesBeforeTakingMemory) {
  // The size stands in the IHDR chunk, whose check sum is CRC-32 as of zlib; libpng's writer makes it.
  const auto headerOf = [](int width, int height) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    std::string bytes;
    png_set_write_fn(
        png, &bytes,
        [](png_structp p, png_bytep data, png_size_t size) {
          static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), size);
        },
        [](png_structp) {});
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 PNG_COLOR_TYPE_RGB, 0, 0, 0);
    png_write_info(png, info);
    png_destroy_write_struct(&png, &info);
    return bytes + std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e\0\0\0\0IEND\xae\x42\x60\x82", 24);
  };
  const Expected<LayeredImage> huge = kPngFormat.decode(headerOf(1 << 20, 1 << 20));
  ASSERT_FALSE(huge);
  EXPECT_THAT(huge.error().what, HasSubstr("too large: 1048576 x 1048576"));
  // 12 MiB of pixels cannot come out of less than 12 KiB.
  const Expected<LayeredImage> cut = kPngFormat.decode(headerOf(2048, 2048));
  ASSERT_FALSE(cut);
  EXPECT_THAT(cut.error().what, HasSubstr("ends before"));
}

TEST(Png, ReadsWhatCompressesBest) {
  LayeredImage black;
  black.width = 2000;
  black.height = 2000;
  black.setRgb("", ImageRgb(2000, 2000, Rgb(0.0f)));
  const std::string bytes = *kPngFormat.encode(black);
  const Expected<LayeredImage> read = kPngFormat.decode(bytes);
  ASSERT_TRUE(read) << bytes.size() << " bytes: " << read.error().message();
}

}  // namespace
}  // namespace lightvane
