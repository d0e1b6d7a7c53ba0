#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/image/test_images.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

constexpr const char* kHeader = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";

LayeredImage onePixel(const Rgb& colour) {
  LayeredImage image;
  image.width = 1;
  image.height = 1;
  image.setRgb("", ImageRgb(1, 1, colour));
  return image;
}

Rgb throughHdr(const Rgb& colour) {
  return kHdrFormat.decode(*kHdrFormat.encode(onePixel(colour)))->rgb().at(0, 0);
}

Rgb decodePixel(const std::string& header, const char (&rgbe)[5]) {
  const Expected<LayeredImage> read = kHdrFormat.decode(header + "\n-Y 1 +X 1\n" + std::string(rgbe, 4));
  return read ? read->rgb().at(0, 0) : Rgb(-1.0f);
}

TEST(Hdr, IsExactToHalfAMantissaStep) {
  for (const Size size : kSizes) {
    const LayeredImage written = rampPicture(size);
    const Expected<LayeredImage> read = kHdrFormat.decode(*kHdrFormat.encode(written));
    ASSERT_TRUE(read) << read.error().message();
    const ImageRgb before = written.rgb();
    const ImageRgb after = read->rgb();
    for (std::size_t i = 0; i < before.size(); ++i) {
      // The largest mantissa is at least 128 steps, and rounding is wrong by half a step at most.
      const float tolerance = maxComponent(before[i]) / 256.0f;
      for (int component = 0; component < 3; ++component) {
        ASSERT_NEAR(after[i][component], before[i][component], tolerance)
            << "pixel " << i << ", " << component;
      }
    }
  }
}

TEST(Hdr, ChangesNothingTheSecondTime) {
  const std::string once = *kHdrFormat.encode(rampPicture({300, 2}));
  EXPECT_TRUE(*kHdrFormat.encode(*kHdrFormat.decode(once)) == once);
}

TEST(Hdr, ClampsWhatItCannotHold) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const float largest = std::ldexp(255.0f, 119);
  EXPECT_EQ(throughHdr({kNan, -1.0f, 2.0f}), Rgb(0.0f, 0.0f, 2.0f));
  EXPECT_EQ(throughHdr({-kInfinity, kNan, -0.0f}), Rgb(0.0f));
  EXPECT_EQ(throughHdr({kInfinity, 0.0f, std::numeric_limits<float>::max()}), Rgb(largest, 0.0f, largest));
  EXPECT_EQ(throughHdr(Rgb(std::numeric_limits<float>::denorm_min())), Rgb(0.0f));
  EXPECT_EQ(throughHdr(Rgb(std::ldexp(1.0f, -128))), Rgb(std::ldexp(1.0f, -128)));
  // Rounds up to the next power of two and its exponent.
  EXPECT_EQ(throughHdr(Rgb(std::nextafter(1.0f, 0.0f))), Rgb(1.0f));
  EXPECT_EQ(throughHdr(Rgb(std::nextafter(std::ldexp(1.0f, -128), 0.0f))), Rgb(std::ldexp(1.0f, -128)));
}

TEST(Hdr, HasTheBytesOfTheSpecification) {
  // One is 128 * 2^(129 - 136).
  LayeredImage image = onePixel(Rgb(1.0f, 0.5f, 0.0f));
  image.metadata["key"] = "value";
  EXPECT_EQ(*kHdrFormat.encode(image), "#?RADIANCE\n# key=value\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n" +
                                           std::string("\x80\x40\x00\x81", 4));
}

TEST(Hdr, EncodesRunsOnlyWhereTheWidthFitsInTheirCode) {
  for (const int width : {7, 8, 127, 128, 129, 255, 32767, 32768}) {
    LayeredImage image;
    image.width = width;
    image.height = 2;
    image.setRgb("", ImageRgb(width, 2, Rgb(1.0f, 2.0f, 4.0f)));
    const std::string bytes = *kHdrFormat.encode(image);
    const Expected<LayeredImage> read = kHdrFormat.decode(bytes);
    ASSERT_TRUE(read) << width << ": " << read.error().message();
    EXPECT_TRUE(read->rgb() == image.rgb()) << width;
    const std::size_t flatBytes = static_cast<std::size_t>(width) * 8;
    EXPECT_EQ(bytes.size() < flatBytes, width >= 127 && width <= 32767)
        << width << ": " << bytes.size() << " bytes";
  }
}

TEST(Hdr, ReadsOldRuns) {
  // A pixel, repeated 2 + 1 * 256 times by codes that are digits to base 256, and another.
  const std::string bytes = std::string(kHeader) + "\n-Y 1 +X 260\n" + std::string("\x80\x40\x20\x81", 4) +
                            std::string("\x01\x01\x01\x02", 4) + std::string("\x01\x01\x01\x01", 4) +
                            std::string("\xff\xff\xff\x80", 4);
  const Expected<LayeredImage> read = kHdrFormat.decode(bytes);
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->rgb().at(258, 0), Rgb(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(read->rgb().at(259, 0), Rgb(255.0f / 256.0f));
}

TEST(Hdr, TurnsPicturesStoredFromOtherCorners) {
  const std::string pixels =
      std::string("\x80\x80\x80\x81\x80\x80\x80\x82\x80\x80\x80\x83\x80\x80\x80\x84", 16);
  const auto topLeft = [&](const std::string& size) {
    const Expected<LayeredImage> read = kHdrFormat.decode(kHeader + ("\n" + size + "\n") + pixels);
    return read ? read->rgb().at(0, 0).r : -1.0f;
  };
  EXPECT_EQ(topLeft("-Y 2 +X 2"), 1.0f);
  EXPECT_EQ(topLeft("-Y 2 -X 2"), 2.0f);
  EXPECT_EQ(topLeft("+Y 2 +X 2"), 4.0f);
  EXPECT_EQ(topLeft("+Y 2 -X 2"), 8.0f);
  EXPECT_EQ(topLeft("+X 2 -Y 2"), -1.0f);
}

TEST(Hdr, DividesByExposure) {
  EXPECT_EQ(decodePixel(kHeader, "\x80\x80\x80\x81"), Rgb(1.0f));
  EXPECT_EQ(decodePixel(std::string(kHeader) + "EXPOSURE= 4.0\nEXPOSURE=0.5\r\n", "\x80\x80\x80\x81"),
            Rgb(0.5f));
  EXPECT_EQ(decodePixel(std::string(kHeader) + "COLORCORR=1 2 4\n", "\x80\x80\x80\x81"),
            Rgb(1.0f, 0.5f, 0.25f));
  for (const char* broken :
       {"EXPOSURE=0\n", "EXPOSURE=x\n", "EXPOSURE=nan\n", "EXPOSURE=-1\n", "COLORCORR=1 2\n"}) {
    EXPECT_EQ(decodePixel(std::string(kHeader) + broken, "\x80\x80\x80\x81"), Rgb(-1.0f)) << broken;
  }
}

TEST(Hdr, RefusesDamagedScanlines) {
  const auto decode = [](const std::string& pixels) {
    return kHdrFormat.decode(std::string(kHeader) + "\n-Y 1 +X 8\n" + pixels);
  };
  const std::string start("\x02\x02\x00\x08", 4);
  std::string sound = start;
  for (int component = 0; component < 4; ++component) sound += "\x88\x80";
  ASSERT_TRUE(decode(sound)) << decode(sound).error().message();
  EXPECT_FALSE(decode(std::string("\x02\x02\x00\x09", 4) + sound.substr(4))) << "another width";
  EXPECT_FALSE(decode(start + "\x89\x80" + sound.substr(6))) << "a run beyond the end";
  EXPECT_FALSE(decode(start + std::string("\x00\x80", 2) + sound.substr(6))) << "a literal of no bytes";
  EXPECT_FALSE(decode(start + "\x7f\x80" + sound.substr(6))) << "a literal beyond the end";
  EXPECT_FALSE(decode(std::string("\x01\x01\x01\x08", 4))) << "an old run of nothing";
}

TEST(Hdr, SaysWhatItDoesNotRead) {
  const Expected<LayeredImage> xyz =
      kHdrFormat.decode("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd");
  ASSERT_FALSE(xyz);
  EXPECT_THAT(xyz.error().message(), HasSubstr("ra_xyze"));
  const Expected<LayeredImage> huge =
      kHdrFormat.decode(std::string(kHeader) + "\n-Y 2000000000 +X 2000000000\n");
  ASSERT_FALSE(huge);
  EXPECT_THAT(huge.error().what, HasSubstr("too large"));
}

}  // namespace
}  // namespace lightvane
