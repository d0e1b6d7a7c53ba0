// Portable float map. Debevec, "PFM Portable FloatMap Image Format",
// https://www.pauldebevec.com/Research/HDR/PFM/: "PF" (colour) or "Pf" (grey), width, height and scale in
// words; the sign of the scale gives the byte order (negative: little endian); rows from the bottom up.

#include <bit>
#include <cmath>

#include "core/image/image_format.h"

namespace lightvane {
namespace {

constexpr std::size_t kFloatBytes = 4;

bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

bool recognisesPfm(std::string_view bytes) {
  return bytes.size() > 2 && (bytes.starts_with("PF") || bytes.starts_with("Pf")) && isSpace(bytes[2]);
}

void appendFloat(std::string& out, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((bits >> shift) & 0xffU);
}

float floatAt(const char* bytes, bool littleEndian) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < kFloatBytes; ++i) {
    bits = bits << 8 | static_cast<unsigned char>(bytes[littleEndian ? kFloatBytes - 1 - i : i]);
  }
  return std::bit_cast<float>(bits);
}

Expected<std::string> encodePfm(const LayeredImage& image) {
  const auto rgb = findRgbChannels(image, kPfmFormat);
  if (!rgb) return tl::unexpected(rgb.error());
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::string out = "PF\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  out.reserve(out.size() + width * height * 3 * kFloatBytes);
  for (std::size_t y = height; y-- > 0;) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) {
      for (const float* channel : *rgb) appendFloat(out, channel[i]);
    }
  }
  return out + metadataLines(image.metadata);
}

// The next word and the one white space that ends it; empty where there is none.
std::string_view takeWord(std::string_view& bytes) {
  while (!bytes.empty() && isSpace(bytes.front())) bytes.remove_prefix(1);
  std::size_t length = 0;
  while (length < bytes.size() && !isSpace(bytes[length])) ++length;
  if (length == bytes.size()) return {};
  const std::string_view word = bytes.substr(0, length);
  bytes.remove_prefix(length + 1);
  return word;
}

Expected<LayeredImage> decodePfm(std::string_view bytes, LoadWatch& watch) {
  const std::size_t components = takeWord(bytes) == "PF" ? 3 : 1;
  const auto width = parseNumber<std::int64_t>(takeWord(bytes));
  const auto height = parseNumber<std::int64_t>(takeWord(bytes));
  const auto scale = parseNumber<float>(takeWord(bytes));
  if (!width || !height || !scale || !std::isfinite(*scale) || *scale == 0.0f) {
    return makeError("", "has a damaged header: expected width, height and a scale");
  }
  if (const auto size = checkPictureSize(*width, *height, 3); !size) return tl::unexpected(size.error());
  LayeredImage image;
  image.width = static_cast<int>(*width);
  image.height = static_cast<int>(*height);
  const std::size_t rowBytes = static_cast<std::size_t>(*width) * components * kFloatBytes;
  const std::size_t pixelBytes = rowBytes * static_cast<std::size_t>(*height);
  if (bytes.size() < pixelBytes) return endsEarly();

  const bool littleEndian = *scale < 0.0f;
  const float unit = std::abs(*scale);
  const std::array<float*, 3> rgb = addRgbChannels(image);
  for (int y = 0; y < image.height; ++y) {
    watch.look(static_cast<double>(y) / image.height);
    const char* next = bytes.data() + static_cast<std::size_t>(image.height - 1 - y) * rowBytes;
    for (int x = 0; x < image.width; ++x, next += components * kFloatBytes) {
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(*width) + static_cast<std::size_t>(x);
      for (std::size_t component = 0; component < rgb.size(); ++component) {
        const float value = floatAt(components == 3 ? next + component * kFloatBytes : next, littleEndian);
        // No multiplication by one: it would change the bits of a signalling NaN.
        rgb[component][pixel] = unit == 1.0f ? value : value * unit;
      }
    }
  }
  bytes.remove_prefix(pixelBytes);
  while (true) {
    const auto line = takeLine(bytes);
    if (!line) break;
    readMetadataLine(*line, image.metadata);
  }
  return image;
}

}  // namespace

constinit const ImageFormat kPfmFormat = {".pfm", "PFM", recognisesPfm, encodePfm, decodePfm};

}  // namespace lightvane
