#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/image/test_images.h"

namespace lightvane {
namespace {

TEST(Pfm, KeepsEveryBit) {
  for (const Size size : kSizes) {
    const LayeredImage written = rampPicture(size);
    const Expected<LayeredImage> read = kPfmFormat.decode(*kPfmFormat.encode(written));
    ASSERT_TRUE(read) << read.error().message();
    for (const auto& [name, channel] : written.channels)
      expectSameBits(read->channels.at(name), channel, name);
  }
}

TEST(Pfm, KeepsNanAndInfinity) {
  const ImageFloat odd = oddFloats();
  LayeredImage written;
  written.width = odd.width();
  written.height = odd.height();
  for (const char* name : {"R", "G", "B"}) written.channels[name] = odd;
  const Expected<LayeredImage> read = kPfmFormat.decode(*kPfmFormat.encode(written));
  ASSERT_TRUE(read) << read.error().message();
  expectSameBits(read->channels.at("R"), odd, "R");
}

TEST(Pfm, IsLittleEndianFromTheBottomUp) {
  LayeredImage image;
  image.width = 1;
  image.height = 2;
  image.setRgb("", ImageRgb(1, 2));
  image.channels["R"].at(0, 0) = 1.0f;  // 0x3f800000, at the top
  image.metadata["key"] = "value";
  const std::string expected = std::string("PF\n1 2\n-1.0\n") + std::string(12, '\0') +
                               std::string("\x00\x00\x80\x3f", 4) + std::string(8, '\0') + "# key=value\n";
  EXPECT_TRUE(*kPfmFormat.encode(image) == expected);
}

TEST(Pfm, ReadsBigEndianGreyAndScale) {
  // 0x3fc00000 is 1.5; the scale doubles it.
  const std::string bytes = std::string("Pf 1 1 2.0 ") + std::string("\x3f\xc0\x00\x00", 4);
  const Expected<LayeredImage> read = kPfmFormat.decode(bytes);
  ASSERT_TRUE(read) << read.error().message();
  for (const char* name : {"R", "G", "B"}) EXPECT_EQ(read->channels.at(name).at(0, 0), 3.0f) << name;
}

TEST(Pfm, RefusesDamagedHeaders) {
  for (const char* header :
       {"PF\n", "PF\n1\n", "PF\n1 1\n", "PF\n1 x\n1.0\n", "PF\n1 1\n0\n", "PF\n1 1\nnan\n", "PF\n1 1\ninf\n",
        "PF\n-1 1\n-1.0\n", "PF\n0 0\n-1.0\n", "PF\n1.5 1\n-1.0\n", "PF\n99999999999999999999 1\n-1.0\n"}) {
    EXPECT_FALSE(kPfmFormat.decode(header + std::string(12, 'x'))) << header;
  }
}

TEST(Pfm, RefusesHugeSizesByName) {
  const Expected<LayeredImage> read = kPfmFormat.decode("PF\n2147483647 2147483647\n-1.0\n");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, testing::HasSubstr("too large"));
}

}  // namespace
}  // namespace lightvane
