#include "core/image/image_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <system_error>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/image/image_format.h"

namespace lightvane {
namespace fs = std::filesystem;
namespace {

constexpr std::array<const ImageFormat*, 6> kFormats = {&kExrFormat, &kHdrFormat, &kPfmFormat,
                                                        &kPngFormat, &kJpgFormat, &kJpegFormat};

std::vector<std::string> extensionsOf(bool onlyWritten) {
  std::vector<std::string> list;
  for (const ImageFormat* format : kFormats) {
    if (format->encode != nullptr || !onlyWritten) list.emplace_back(format->extension);
  }
  return list;
}

// Room for the largest picture, uncompressed, and as much again for what else its file may carry.
constexpr std::uintmax_t kMaxFileBytes = 2 * static_cast<std::uintmax_t>(kMaxPixelBytes);

// OpenEXR cuts longer names off, so that two channels might become one.
constexpr std::size_t kMaxChannelName = 255;

Expected<const ImageFormat*> formatOf(const fs::path& path, bool isToBeWritten) {
  const std::string extension = fileEnding(path);
  const std::vector<std::string> extensions = extensionsOf(isToBeWritten);
  const std::string known = listWords(extensions);
  for (const ImageFormat* format : kFormats) {
    if (format->extension != extension) continue;
    if (format->encode != nullptr || !isToBeWritten) return format;
    return makeError(path.string(), fmt::format("{} pictures are read, not written", format->name),
                     "use " + known);
  }
  if (extension.empty())
    return makeError(path.string(), "has no extension to choose a format by", "use " + known);
  const std::string meant = suggestion(extension, extensions);
  return makeError(path.string(), fmt::format("unknown image format {}: known are {}", extension, known),
                   meant);
}

Error at(const fs::path& path, Error error) {
  error.where = path.string();
  return error;
}

tl::unexpected<Error> takesTooMuch(const std::string& where) {
  return makeError(where, "takes more memory than there is");
}

void checkInvariants(const LayeredImage& image) {
  LV_CHECK(image.width > 0 && image.height > 0, "the picture is {}x{}", image.width, image.height);
  LV_CHECK(!image.channels.empty() || !image.uintChannels.empty(), "the picture has no channels");
  const auto checkChannel = [&](const std::string& name, int width, int height) {
    LV_CHECK(!name.empty() && name.size() <= kMaxChannelName && name.find('\0') == std::string::npos,
             "channel '{}'", name);
    LV_CHECK(width == image.width && height == image.height, "channel '{}' is {}x{}, the picture is {}x{}",
             name, width, height, image.width, image.height);
  };
  for (const auto& [name, channel] : image.channels) checkChannel(name, channel.width(), channel.height());
  for (const auto& [name, channel] : image.uintChannels) {
    checkChannel(name, channel.width(), channel.height());
    LV_CHECK(!image.channels.contains(name), "channel '{}' is there as floats and as integers", name);
  }
  for (const auto& [key, value] : image.metadata) {
    LV_CHECK(isMetadataKey(key), "metadata key '{}'", key);
    LV_CHECK(value.find('\0') == std::string::npos, "metadata '{}' has a zero byte", key);
  }
}

}  // namespace

const std::vector<std::string>& imageExtensions() {
  static const std::vector<std::string> extensions = extensionsOf(true);
  return extensions;
}

bool isForScreens(std::string_view ending) { return ending == kPngFormat.extension; }

Expected<void> checkWritableImage(const fs::path& path) {
  if (const auto format = formatOf(path, true); !format) return tl::unexpected(format.error());
  // The write itself, stopped before the rename: whatever would fail after hours of rendering (permission, a
  // full or read-only disk, a name too long) fails now. The error at its end makes replaceFileAtomically
  // leave `path` alone and remove the temporary file.
  bool created = false;
  Expected<void> stopped = replaceFileAtomically(path, [&](const fs::path& temporary) -> Expected<void> {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out << "probe";
    out.close();
    if (!out) return makeError("", fmt::format("cannot be written: {}", std::strerror(errno)));
    created = true;
    return makeError("", "was only a probe");
  });
  if (!created) return stopped;
  return {};
}

Expected<std::string> imageBytes(const std::string& extension, const LayeredImage& image) {
  const auto format = formatOf("picture" + extension, true);
  if (!format) return tl::unexpected(format.error());
  checkInvariants(image);
  return (*format)->encode(image);
}

Expected<void> writeImage(const fs::path& path, const LayeredImage& image) {
  if (const auto format = formatOf(path, true); !format) return tl::unexpected(format.error());
  const Expected<std::string> bytes = imageBytes(fileEnding(path), image);
  if (!bytes) return tl::unexpected(at(path, bytes.error()));
  return writeFileAtomically(path, *bytes);
}

Expected<LayeredImage> readImage(const fs::path& path, LoadWatch& watch) {
  const auto format = formatOf(path, false);
  if (!format) return tl::unexpected(format.error());
  // readFile tells what is wrong with a missing file or a folder; a pipe or device would keep it waiting.
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_other(status)) return makeError(path.string(), "is not a regular file");
  if (fs::is_regular_file(status) && fs::file_size(path, error) > kMaxFileBytes) {
    return makeError(path.string(), fmt::format("is too large: more than {} MiB", kMaxFileBytes >> 20));
  }
  try {
    watch.part(0.0, 0.1);
    const Expected<std::string> bytes = readFile(path, watch);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!(*format)->recognises(*bytes)) {
      std::string hint;
      for (const ImageFormat* other : kFormats) {
        if (hint.empty() && other->recognises(*bytes))
          hint = fmt::format("it is {}: rename it to {}", other->name, other->extension);
      }
      return makeError(path.string(), fmt::format("is no {} file", (*format)->name), hint);
    }
    watch.part(0.1, 1.0);
    Expected<LayeredImage> image = (*format)->decode(*bytes, watch);
    if (!image) return tl::unexpected(at(path, image.error()));
    return image;
  } catch (const std::bad_alloc&) {
    return takesTooMuch(path.string());
  }
}

Expected<LayeredImage> readImageBytes(std::string_view bytes, const std::string& where, LoadWatch& watch) {
  for (const ImageFormat* format : {&kPngFormat, &kJpegFormat}) {
    if (!format->recognises(bytes)) continue;
    try {
      Expected<LayeredImage> image = format->decode(bytes, watch);
      if (!image) return tl::unexpected(at(where, image.error()));
      return image;
    } catch (const std::bad_alloc&) {
      return takesTooMuch(where);
    }
  }
  return makeError(where, "is neither a PNG nor a JPEG picture");
}

}  // namespace lightvane
