#include "core/image/image_file.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/check.h"
#include "core/base/file.h"
#include "tests/image/test_images.h"

namespace lightvane {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class EveryFormat : public testing::TestWithParam<const ImageFormat*> {
 protected:
  std::filesystem::path path(const std::string& stem = "picture") const {
    return folder_ / (stem + std::string(GetParam()->extension));
  }

  TemporaryFolder folder_;
};

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         testing::Values(&kExrFormat, &kHdrFormat, &kPfmFormat, &kPngFormat),
                         [](const auto& format) { return std::string(format.param->extension.substr(1)); });

TEST_P(EveryFormat, KeepsSizeAndMetadata) {
  for (const Size size : kSizes) {
    const LayeredImage written = rampPicture(size);
    ASSERT_TRUE(writeImage(path(), written));
    const Expected<LayeredImage> read = readImage(path());
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->width, size.width);
    EXPECT_EQ(read->height, size.height);
    EXPECT_TRUE(read->hasRgb());
    EXPECT_EQ(read->metadata, written.metadata);
  }
}

TEST_P(EveryFormat, WritesTheSameBytesTwice) {
  const LayeredImage image = rampPicture({300, 40});
  ASSERT_TRUE(writeImage(path("a"), image));
  ASSERT_TRUE(writeImage(path("b"), image));
  EXPECT_TRUE(*readFile(path("a")) == *readFile(path("b")));
}

TEST_P(EveryFormat, ReplacesAFileAndLeavesNothingElse) {
  writeBytes(path(), "old");
  ASSERT_TRUE(checkWritableImage(path()));
  EXPECT_EQ(*readFile(path()), "old");
  ASSERT_TRUE(writeImage(path(), rampPicture({7, 5})));
  EXPECT_TRUE(readImage(path()));
  EXPECT_THAT(folder_.files(), testing::ElementsAre(path().filename().string()));
}

TEST_P(EveryFormat, ProbesWithoutLeavingAFile) {
  ASSERT_TRUE(checkWritableImage(path()));
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_P(EveryFormat, RefusesAMissingFolder) {
  const std::filesystem::path missing = folder_ / ("no/such/picture" + std::string(GetParam()->extension));
  for (const Expected<void>& result :
       {checkWritableImage(missing), writeImage(missing, rampPicture({7, 5}))}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, missing.string());
    EXPECT_THAT(result.error().what, HasSubstr("does not exist"));
  }
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_P(EveryFormat, RefusesAFolderInPlaceOfAFile) {
  std::filesystem::create_directory(path());
  EXPECT_FALSE(checkWritableImage(path()));
  EXPECT_FALSE(writeImage(path(), rampPicture({7, 5})));
  const Expected<LayeredImage> read = readImage(path());
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("is a folder"));
  EXPECT_EQ(folder_.files().size(), 1u);
}

TEST_P(EveryFormat, RefusesAFolderWithoutPermission) {
  // Nobody may create files in /proc, not even root, whom permissions do not stop.
  const std::filesystem::path locked = "/proc/picture" + std::string(GetParam()->extension);
  for (const Expected<void>& result : {checkWritableImage(locked), writeImage(locked, rampPicture({7, 5}))}) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().where, locked.string());
    EXPECT_THAT(result.error().what, HasSubstr("cannot be written"));
  }
}

TEST_P(EveryFormat, RefusesANameTooLongBeforeTheWork) {
  // 250 bytes fit in a name, but not with the temporary file's additions.
  const std::filesystem::path longName = path(std::string(246, 'x'));
  const Expected<void> probed = checkWritableImage(longName);
  const Expected<void> written = writeImage(longName, rampPicture({7, 5}));
  ASSERT_FALSE(probed);
  ASSERT_FALSE(written);
  EXPECT_EQ(probed.error().message(), written.error().message());
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST_P(EveryFormat, RefusesMissingEmptyAndForeignFiles) {
  const Expected<LayeredImage> missing = readImage(path());
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().message(), path().string() + ": no such file");

  for (const std::string_view bytes : {"", "P", "GIF89a and no picture of ours", "BM\xff\xe0"}) {
    writeBytes(path(), bytes);
    const Expected<LayeredImage> read = readImage(path());
    ASSERT_FALSE(read) << bytes;
    EXPECT_EQ(read.error().message(), path().string() + ": is no " + std::string(GetParam()->name) + " file");
  }
}

TEST_P(EveryFormat, TellsWhatAFileWithAWrongExtensionIs) {
  const ImageFormat* other = GetParam() == &kPngFormat ? &kExrFormat : &kPngFormat;
  writeBytes(path(), *other->encode(rampPicture({7, 5})));
  const Expected<LayeredImage> read = readImage(path());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().hint,
            "it is " + std::string(other->name) + ": rename it to " + std::string(other->extension));
}

TEST_P(EveryFormat, RefusesAPipeWithoutWaiting) {
  ASSERT_EQ(mkfifo(path().c_str(), 0600), 0);
  const Expected<LayeredImage> read = readImage(path());
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("not a regular file"));
}

TEST_P(EveryFormat, TakesExtensionsInCapitals) {
  std::string extension(GetParam()->extension);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  const std::filesystem::path capital = folder_ / ("picture" + extension);
  ASSERT_TRUE(writeImage(capital, rampPicture({7, 5})));
  EXPECT_TRUE(readImage(capital));
}

TEST_P(EveryFormat, RefusesFilesCutOffAnywhere) {
  const LayeredImage image = rampPicture({9, 3});
  const std::string bytes = *GetParam()->encode(image);
  // PFM is complete where its pixels end: only metadata follows.
  const std::size_t complete =
      GetParam() == &kPfmFormat ? bytes.size() - metadataLines(image.metadata).size() : bytes.size();
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::string_view cut = std::string_view(bytes).substr(0, length);
    if (!GetParam()->recognises(cut)) continue;
    // A copy of just that length, so that the address sanitizer sees a read beyond it.
    const std::vector<char> exact(cut.begin(), cut.end());
    const Expected<LayeredImage> read = GetParam()->decode({exact.data(), exact.size()});
    expectErrorOrPicture(
        read, "cut to " + std::to_string(length) + " of " + std::to_string(bytes.size()) + " bytes");
    EXPECT_EQ(read.has_value(), length >= complete)
        << "cut to " << length << " of " << bytes.size() << " bytes";
  }
}

TEST_P(EveryFormat, SurvivesDamageToAnyByte) {
  const std::string bytes = *GetParam()->encode(rampPicture({9, 3}));
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    for (const int mask : {0x01, 0x80, 0xff}) {
      std::string damaged = bytes;
      damaged[i] = static_cast<char>(damaged[i] ^ mask);
      if (!GetParam()->recognises(damaged)) continue;
      expectErrorOrPicture(GetParam()->decode(damaged),
                           "byte " + std::to_string(i) + " ^ " + std::to_string(mask));
    }
  }
}

TEST_P(EveryFormat, RefusesBrokenInvariants) {
  LayeredImage wrongSize = rampPicture({7, 5});
  wrongSize.channels["R"] = ImageFloat(7, 4);
  EXPECT_THROW((void)writeImage(path(), wrongSize), InvariantViolation);
  LayeredImage wrongKey = rampPicture({7, 5});
  wrongKey.metadata["two words"] = "x";
  EXPECT_THROW((void)writeImage(path(), wrongKey), InvariantViolation);
  LayeredImage zeroByte = rampPicture({7, 5});
  zeroByte.metadata["key"] = std::string(1, '\0');
  EXPECT_THROW((void)writeImage(path(), zeroByte), InvariantViolation);
  EXPECT_THROW((void)writeImage(path(), LayeredImage{}), InvariantViolation);
  LayeredImage noChannels;
  noChannels.width = 7;
  noChannels.height = 5;
  EXPECT_THROW((void)writeImage(path(), noChannels), InvariantViolation);
  LayeredImage twice = rampPicture({7, 5});
  twice.uintChannels["R"] = ImageUint(7, 5);
  EXPECT_THROW((void)writeImage(path(), twice), InvariantViolation);
  EXPECT_THAT(folder_.files(), IsEmpty());
}

TEST(ImageFile, ListsItsExtensions) {
  EXPECT_THAT(imageExtensions(), testing::ElementsAre(".exr", ".hdr", ".pfm", ".png"));
}

TEST(ImageFile, NamesTheNearestExtension) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder / "picture.pgn";
  const auto message = [&](const std::string& known) {
    return path.string() + ": unknown image format .pgn: known are " + known + " (did you mean .png?)";
  };
  EXPECT_EQ(checkWritableImage(path).error().message(), message(".exr, .hdr, .pfm or .png"));
  EXPECT_EQ(writeImage(path, rampPicture({7, 5})).error().message(), message(".exr, .hdr, .pfm or .png"));
  EXPECT_EQ(readImage(path).error().message(), message(".exr, .hdr, .pfm, .png, .jpg or .jpeg"));
  EXPECT_THAT(folder.files(), IsEmpty());
}

TEST(ImageFile, AsksForAnExtension) {
  const TemporaryFolder folder;
  EXPECT_EQ(checkWritableImage(folder / "picture").error().message(),
            (folder / "picture").string() +
                ": has no extension to choose a format by (use .exr, .hdr, .pfm or .png)");
}

TEST(ImageFile, RefusesToDropAPictureWithoutColours) {
  const TemporaryFolder folder;
  LayeredImage depth;
  depth.width = 7;
  depth.height = 5;
  depth.channels["Z"] = ImageFloat(7, 5, 1.0f);
  EXPECT_TRUE(writeImage(folder / "depth.exr", depth));
  for (const char* name : {"depth.hdr", "depth.pfm", "depth.png"}) {
    const Expected<void> written = writeImage(folder / name, depth);
    ASSERT_FALSE(written) << name;
    EXPECT_THAT(written.error().hint, HasSubstr(".exr")) << name;
  }
  EXPECT_THAT(folder.files(), testing::ElementsAre("depth.exr"));
}

TEST(PictureSize, HasALimitThatDoesNotOverflow) {
  EXPECT_TRUE(checkPictureSize(1, 1, 1));
  EXPECT_TRUE(checkPictureSize(1 << 15, 1 << 15, 1));  // 2^30 floats: the limit
  EXPECT_FALSE(checkPictureSize(1 << 15, (1 << 15) + 1, 1));
  EXPECT_FALSE(checkPictureSize(1 << 15, 1 << 15, 2));
  EXPECT_FALSE(checkPictureSize(0x7fffffff, 0x7fffffff, 0x7fffffff));
  EXPECT_FALSE(checkPictureSize(std::int64_t{1} << 32, 1, 1));
  EXPECT_FALSE(checkPictureSize(0, 1, 1));
  EXPECT_FALSE(checkPictureSize(1, -1, 1));
}

}  // namespace
}  // namespace lightvane
