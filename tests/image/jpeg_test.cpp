#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/color.h"
#include "core/base/file.h"
#include "tests/image/test_images.h"

namespace lightvane {
namespace {

// 16 x 16: above, white and black halves; below, the grey of code 128. Blocks of 8 x 8 keep them exactly.
std::string halves() {
  return readFile(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "tests/image/data/halves.jpg").value();
}

TEST(Jpeg, IsReadAsLinearLight) {
  const TemporaryFolder folder;
  for (const char* name : {"halves.jpg", "halves.JPEG"}) {
    writeBytes(folder / name, halves());
    const Expected<LayeredImage> image = readImage(folder / name);
    ASSERT_TRUE(image) << image.error().message();
    const ImageRgb pixels = image->rgb();
    ASSERT_EQ(pixels.width(), 16);
    ASSERT_EQ(pixels.height(), 16);
    EXPECT_EQ(pixels.at(0, 0), Rgb(1.0f));
    EXPECT_EQ(pixels.at(7, 7), Rgb(1.0f));
    EXPECT_EQ(pixels.at(8, 0), Rgb(0.0f));
    EXPECT_EQ(pixels.at(3, 12), Rgb(decodeSrgb(128.0f / 255.0f)));
  }
}

TEST(Jpeg, IsNotWritten) {
  const TemporaryFolder folder;
  const Expected<void> written = writeImage(folder / "a.jpg", rampPicture({4, 4}));
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message(), testing::HasSubstr("JPEG pictures are read, not written (use .exr"));
  EXPECT_FALSE(checkWritableImage(folder / "a.jpeg"));
  EXPECT_THAT(folder.files(), testing::IsEmpty());
}

// Whatever of it is missing or wrong, there is a message and no picture.
TEST(Jpeg, RefusesDamagedFiles) {
  const std::string whole = halves();
  for (std::size_t size = 3; size + 2 < whole.size(); size += 5) {
    const Expected<LayeredImage> image = kJpgFormat.decode(std::string_view(whole).substr(0, size));
    ASSERT_FALSE(image) << size;
    EXPECT_THAT(image.error().message(), testing::HasSubstr("cannot be read: ")) << size;
  }
}

TEST(Jpeg, SurvivesAnyByteBeingAnother) {
  const std::string whole = halves();
  for (std::size_t i = 2; i < whole.size(); ++i) {
    for (const int flip : {0x01, 0x80, 0xff}) {
      std::string damaged = whole;
      damaged[i] = static_cast<char>(damaged[i] ^ flip);
      const Expected<LayeredImage> image = kJpgFormat.decode(damaged);
      EXPECT_TRUE(image ? image->hasRgb() : !image.error().message().empty()) << i;
    }
  }
}

}  // namespace
}  // namespace lightvane
