#include "core/image/image_format.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace lightvane {

Expected<void> checkPictureSize(std::int64_t width, std::int64_t height, std::int64_t channels) {
  constexpr std::int64_t kMaxSide = std::numeric_limits<int>::max();
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    return makeError("", fmt::format("has an impossible size of {} x {} pixels", width, height));
  }
  // Divided step by step, because the product may not fit in 64 bits.
  constexpr std::int64_t kMaxValues = kMaxPixelBytes / static_cast<std::int64_t>(sizeof(float));
  if (channels > kMaxValues / width / height) {
    return makeError("",
                     fmt::format("is too large: {} x {} pixels of {} channels are more than {} MiB", width,
                                 height, channels, kMaxPixelBytes >> 20),
                     "scale it down or drop channels");
  }
  return {};
}

tl::unexpected<Error> endsEarly() {
  return makeError("", "ends before its picture is complete", "it may have been cut off when it was copied");
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 200;  // more than OpenEXR's and libpng's messages have
  std::string result(text.substr(0, kLongest));
  std::replace_if(
      result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return result;
}

std::array<float*, 3> addRgbChannels(LayeredImage& image) {
  std::array<float*, 3> rgb{};
  constexpr std::array<const char*, 3> kNames = {"R", "G", "B"};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    ImageFloat& channel = image.channels[kNames[i]];
    channel = ImageFloat(image.width, image.height);
    rgb[i] = channel.data();
  }
  return rgb;
}

Expected<std::array<const float*, 3>> findRgbChannels(const LayeredImage& image, const ImageFormat& format) {
  if (!image.hasRgb()) {
    return makeError(
        "", fmt::format("{} holds red, green and blue, which this picture does not have", format.name),
        "write .exr instead, which holds any channels");
  }
  return std::array<const float*, 3>{image.channels.at("R").data(), image.channels.at("G").data(),
                                     image.channels.at("B").data()};
}

bool isMetadataKey(std::string_view key) {
  // Not std::isalnum, which follows the locale.
  const auto isKeyCharacter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !key.empty() && key.size() <= 79 && std::all_of(key.begin(), key.end(), isKeyCharacter);
}

std::string metadataLines(const std::map<std::string, std::string>& metadata) {
  std::string lines;
  for (const auto& [key, value] : metadata) {
    lines += "# " + key + "=";
    for (const char c : value) {
      if (c == '\\') {
        lines += "\\\\";
      } else if (c == '\n') {
        lines += "\\n";
      } else if (c == '\r') {
        lines += "\\r";
      } else {
        lines += c;
      }
    }
    lines += '\n';
  }
  return lines;
}

void readMetadataLine(std::string_view line, std::map<std::string, std::string>& metadata) {
  const std::size_t equals = line.find('=');
  if (!line.starts_with("# ") || equals == std::string_view::npos) return;
  const std::string_view key = line.substr(2, equals - 2);
  if (!isMetadataKey(key)) return;
  std::string value;
  for (std::size_t i = equals + 1; i < line.size(); ++i) {
    if (line[i] != '\\' || i + 1 == line.size()) {
      value += line[i];
      continue;
    }
    const char escaped = line[++i];
    value += escaped == 'n' ? '\n' : escaped == 'r' ? '\r' : escaped;
  }
  metadata[std::string(key)] = std::move(value);
}

std::optional<std::string_view> takeLine(std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  return line;
}

}  // namespace lightvane
