#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <half.h>

#include "core/base/file.h"
#include "tests/image/test_images.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

LayeredImage layeredPicture(Size size) {
  LayeredImage image = rampPicture(size);
  image.setRgb("direct", rampImage(size));
  image.channels["Z"] = ImageFloat(size.width, size.height, 3.5f);
  ImageUint& ids = image.uintChannels["cache.record_id"];
  ids = ImageUint(size.width, size.height);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = 0xffffffffU - static_cast<std::uint32_t>(i) * 65537U;
  return image;
}

TEST(Exr, KeepsEveryChannelBitByBit) {
  for (const Size size : kSizes) {
    const LayeredImage written = layeredPicture(size);
    const Expected<LayeredImage> read = kExrFormat.decode(*kExrFormat.encode(written));
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->channels.size(), written.channels.size());
    for (const auto& [name, channel] : written.channels)
      expectSameBits(read->channels.at(name), channel, name);
    EXPECT_TRUE(read->uintChannels == written.uintChannels);
    EXPECT_EQ(read->metadata, written.metadata);
  }
}

TEST(Exr, KeepsNanAndInfinity) {
  LayeredImage written;
  written.channels["variance"] = oddFloats();
  written.width = written.channels["variance"].width();
  written.height = written.channels["variance"].height();
  const Expected<LayeredImage> read = kExrFormat.decode(*kExrFormat.encode(written));
  ASSERT_TRUE(read) << read.error().message();
  expectSameBits(read->channels.at("variance"), written.channels.at("variance"), "variance");
  EXPECT_FALSE(read->hasRgb());
}

TEST(Exr, KeepsMetadataWhoseKeysMeanSomethingToOpenExr) {
  LayeredImage written = rampPicture({7, 5});
  written.metadata = {{"type", "a"},     {"name", "b"},        {"view", "c"},
                      {"channels", "d"}, {"compression", "e"}, {std::string(79, 'k'), "f"}};
  const Expected<LayeredImage> read = kExrFormat.decode(*kExrFormat.encode(written));
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->metadata, written.metadata);
}

TEST(Exr, IsReadByOpenExrAsZippedScanlines) {
  const TemporaryFolder folder;
  ASSERT_TRUE(writeImage(folder / "picture.exr", layeredPicture({300, 2})));
  const Imf::InputFile file((folder / "picture.exr").c_str());
  const Imf::Header& header = file.header();
  EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
  EXPECT_FALSE(header.hasTileDescription());
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("lightvane:seed").value(), "7");
  ASSERT_NE(header.channels().findChannel("cache.record_id"), nullptr);
  EXPECT_EQ(header.channels().findChannel("cache.record_id")->type, Imf::UINT);
  EXPECT_EQ(header.channels().findChannel("direct.G")->type, Imf::FLOAT);
}

// Files of other programs: a channel whose value at (x, y) of the data window is x + 100 y, exact in half
// floats.
class ForeignExr : public testing::Test {
 protected:
  static constexpr int kWidth = 7;
  static constexpr int kHeight = 5;

  ForeignExr() : values_(kWidth * kHeight) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        values_[static_cast<std::size_t>(y * kWidth + x)] = half(static_cast<float>(x + 100 * y));
      }
    }
  }

  Imf::FrameBuffer frame(const Imath::Box2i& window, const std::string& channel) {
    Imf::FrameBuffer buffer;
    buffer.insert(channel, Imf::Slice::Make(Imf::HALF, values_.data(), window));
    return buffer;
  }

  void expectValues(const Expected<LayeredImage>& read, const std::string& channel) {
    ASSERT_TRUE(read) << read.error().message();
    ASSERT_EQ(read->width, kWidth);
    ASSERT_EQ(read->height, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_EQ(read->channels.at(channel).at(x, y), static_cast<float>(x + 100 * y)) << x << ", " << y;
      }
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "foreign.exr";
  std::vector<half> values_;
};

TEST_F(ForeignExr, ReadsHalfFloatsOfADataWindowInEveryLosslessCompression) {
  const Imath::Box2i display({0, 0}, {99, 99});
  const Imath::Box2i window({-3, 20}, {-3 + kWidth - 1, 20 + kHeight - 1});
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION, Imf::ZIP_COMPRESSION,
        Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
    for (const Imf::LineOrder order : {Imf::INCREASING_Y, Imf::DECREASING_Y}) {
      Imf::Header header(display, window, 1.0f, {0, 0}, 1.0f, order, compression);
      header.channels().insert("R", Imf::Channel(Imf::HALF));
      {
        Imf::OutputFile file(path_.c_str(), header);
        file.setFrameBuffer(frame(window, "R"));
        file.writePixels(kHeight);
      }
      expectValues(readImage(path_), "R");
    }
  }
}

TEST_F(ForeignExr, ReadsEveryLossyCompressionOfAConstant) {
  values_.assign(values_.size(), half(0.5f));
  for (const Imf::Compression compression :
       {Imf::B44_COMPRESSION, Imf::B44A_COMPRESSION, Imf::DWAA_COMPRESSION, Imf::DWAB_COMPRESSION}) {
    Imf::Header header(kWidth, kHeight);
    header.compression() = compression;
    header.channels().insert("R", Imf::Channel(Imf::HALF));
    {
      Imf::OutputFile file(path_.c_str(), header);
      file.setFrameBuffer(frame(header.dataWindow(), "R"));
      file.writePixels(kHeight);
    }
    const Expected<LayeredImage> read = readImage(path_);
    ASSERT_TRUE(read) << compression << ": " << read.error().message();
    // DWA's default level of 45 stands for an error of about 45 / 100000 before its perceptual curve.
    EXPECT_NEAR(read->channels.at("R").at(3, 2), 0.5f, 0.01f) << compression;
  }
}

TEST_F(ForeignExr, ReadsTiles) {
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("R", Imf::Channel(Imf::HALF));
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
    header.setTileDescription(Imf::TileDescription(4, 3, mode));
    {
      Imf::TiledOutputFile file(path_.c_str(), header);
      for (int level = 0; level < file.numLevels(); ++level) {
        file.setFrameBuffer(frame(header.dataWindow(), "R"));
        file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
      }
    }
    expectValues(readImage(path_), "R");
    const std::string bytes = *readFile(path_);
    for (std::size_t length = 8; length < bytes.size(); ++length) {
      expectErrorOrPicture(kExrFormat.decode(std::string_view(bytes).substr(0, length)),
                           "tiled, cut to " + std::to_string(length));
    }
  }
}

TEST_F(ForeignExr, SpreadsGreyOverRedGreenAndBlue) {
  Imf::Header header(kWidth, kHeight);
  header.channels().insert("Y", Imf::Channel(Imf::HALF));
  {
    Imf::OutputFile file(path_.c_str(), header);
    file.setFrameBuffer(frame(header.dataWindow(), "Y"));
    file.writePixels(kHeight);
  }
  const Expected<LayeredImage> read = readImage(path_);
  for (const char* name : {"Y", "R", "G", "B"}) expectValues(read, name);
}

TEST_F(ForeignExr, RefusesSubsampledChannels) {
  Imf::Header header(8, 4);
  header.channels().insert("RY", Imf::Channel(Imf::HALF, 2, 2));
  {
    Imf::FrameBuffer buffer;
    buffer.insert("RY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(values_.data()), sizeof(half),
                                   4 * sizeof(half), 2, 2));
    Imf::OutputFile file(path_.c_str(), header);
    file.setFrameBuffer(buffer);
    file.writePixels(4);
  }
  const Expected<LayeredImage> read = readImage(path_);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("subsampled channel 'RY'"));
}

TEST_F(ForeignExr, RefusesSeveralParts) {
  std::vector<Imf::Header> headers(2, Imf::Header(kWidth, kHeight));
  for (std::size_t i = 0; i < headers.size(); ++i) {
    headers[i].setName("part" + std::to_string(i));
    headers[i].setType(Imf::SCANLINEIMAGE);
    headers[i].channels().insert("R", Imf::Channel(Imf::HALF));
  }
  {
    Imf::MultiPartOutputFile file(path_.c_str(), headers.data(), 2);
    for (int part = 0; part < 2; ++part) {
      Imf::OutputPart output(file, part);
      output.setFrameBuffer(frame(headers[0].dataWindow(), "R"));
      output.writePixels(kHeight);
    }
  }
  const Expected<LayeredImage> read = readImage(path_);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("several parts"));
}

// Replaces the value of an attribute of a header: name, zero, type, zero, 4 bytes of size, value.
std::string withAttribute(std::string bytes, const std::string& nameAndType, std::size_t offset,
                          const std::string& replacement) {
  const std::size_t at = bytes.find(nameAndType);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at + nameAndType.size() + offset, replacement.size(), replacement);
}

TEST(Exr, RefusesHugeSizesBeforeTakingMemory) {
  const std::string bytes = *kExrFormat.encode(rampPicture({9, 3}));
  const std::string window = std::string("dataWindow\0box2i\0", 17);
  const std::string million("\x3f\x42\x0f\x00", 4);  // 999999

  const Expected<LayeredImage> huge =
      kExrFormat.decode(withAttribute(bytes, window, 4 + 8, million + million));
  ASSERT_FALSE(huge);
  EXPECT_THAT(huge.error().what, HasSubstr("too large: 1000000 x 1000000"));

  // A million rows would fit, but not in this file: their table alone is longer.
  const Expected<LayeredImage> tall = kExrFormat.decode(withAttribute(bytes, window, 4 + 12, million));
  ASSERT_FALSE(tall);
  EXPECT_THAT(tall.error().what, HasSubstr("ends before"));

  const Expected<LayeredImage> attribute = kExrFormat.decode(withAttribute(
      bytes, std::string("lightvane:seed\0string\0", 22), 0, std::string("\xff\xff\xff\x7f", 4)));
  ASSERT_FALSE(attribute);
  EXPECT_THAT(attribute.error().what, HasSubstr("ends before"));
}

}  // namespace
}  // namespace lightvane
