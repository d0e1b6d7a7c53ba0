#pragma once

#include <array>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "core/base/error.h"
#include "core/base/load_watch.h"
#include "core/image/image.h"
#include "core/image/image_file.h"

// What the formats of core/image share. Internal: everybody else reads and writes pictures by image_file.h.

namespace lightvane {

/// A format of pictures: how to know it, how to make its bytes, how to read them.
///
/// Both directions work in memory and are pure functions of their arguments, whatever thread calls them: the
/// same picture gives the same bytes. Errors leave Error::where empty; the caller knows the path.
struct ImageFormat {
  std::string_view extension;  ///< lower-case, with its dot
  std::string_view name;       ///< as a message says it: "PNG"

  /// Whether the bytes begin as a file of this format does.
  bool (*recognises)(std::string_view bytes);
  /// The whole file. The picture has been checked: at least one pixel, channels of its size, valid metadata
  /// keys. Null where pictures of this format are only read.
  Expected<std::string> (*encode)(const LayeredImage& image);
  /// As decode.
  Expected<LayeredImage> (*decodeWatched)(std::string_view bytes, LoadWatch& watch);

  /// The picture in bytes that `recognises` accepts and of which nothing else is known to be right. Throws
  /// LoadStopped as `watch` says.
  Expected<LayeredImage> decode(std::string_view bytes, LoadWatch& watch = LoadWatch::none()) const {
    return decodeWatched(bytes, watch);
  }
};

extern const ImageFormat kExrFormat;
extern const ImageFormat kHdrFormat;
extern const ImageFormat kPfmFormat;
extern const ImageFormat kPngFormat;
extern const ImageFormat kJpgFormat;   ///< the same under
extern const ImageFormat kJpegFormat;  ///< two endings

/// The most that the pixels of a picture may take when it is read, at 4 bytes a channel. One of our own
/// with 4096 x 4096 pixels and some forty channels takes 2.5 GB.
inline constexpr std::int64_t kMaxPixelBytes = std::int64_t{4} << 30;

/// Refuses a picture without pixels, and one beyond kMaxPixelBytes; to be asked before memory is taken.
Expected<void> checkPictureSize(std::int64_t width, std::int64_t height, std::int64_t channels);

/// The error of a file that stops before its picture is complete.
tl::unexpected<Error> endsEarly();

/// Text out of a file, fit for a message in one line: what is not printable ASCII is '?', what is long is
/// cut.
std::string printable(std::string_view text);

/// Adds channels R, G and B of the picture's size and returns their pixels.
std::array<float*, 3> addRgbChannels(LayeredImage& image);

/// The pixels of R, G and B, or the error of a format that holds nothing else.
Expected<std::array<const float*, 3>> findRgbChannels(const LayeredImage& image, const ImageFormat& format);

/// Letters, digits and underscores, at least one and at most 79 (PNG has room for no more).
bool isMetadataKey(std::string_view key);

/// One line "# key=value" an entry, with backslash, line feed and carriage return of the values written as
/// \\, \n, \r.
std::string metadataLines(const std::map<std::string, std::string>& metadata);

/// Adds the entry of a line (without its line feed) that metadataLines has written; passes over any other
/// line.
void readMetadataLine(std::string_view line, std::map<std::string, std::string>& metadata);

/// Takes the text up to the next line feed off the front of `bytes`; nothing where there is no line feed.
std::optional<std::string_view> takeLine(std::string_view& bytes);

/// The number that the whole of `text` is, whatever the locale.
template <class Number>
std::optional<Number> parseNumber(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return number;
}

}  // namespace lightvane
