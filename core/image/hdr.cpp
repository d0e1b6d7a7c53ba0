// Radiance pictures: a text header, then scanlines of RGBE, run-length encoded.
// Ward, "Real Pixels", Graphics Gems II, 1991. The file: "Radiance File Formats" (filefmts.pdf of the
// Radiance distribution) and its src/common/color.c.

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/image/image_format.h"

namespace lightvane {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// RGBE is m * 2^(e - 136) with m and e in bytes; e = 0 stands for black.
constexpr int kExponentBias = 136;

// Only scanlines of these widths are run-length encoded a component at a time: the width is stored in 15
// bits.
constexpr int kMinRleWidth = 8;
constexpr int kMaxRleWidth = 32767;

constexpr std::size_t kMaxRun = 127;
constexpr std::size_t kMaxLiteral = 128;
constexpr std::size_t kMinRun = 4;  // a shorter run may cost more than it saves, as it ends a literal

bool recognisesHdr(std::string_view bytes) { return bytes.starts_with("#?"); }

// Rounds to the nearest mantissa, for readers that take m for m (all that we know but Radiance's own, which
// takes it for m + 1/2). Negative values and NaN become 0, what is too large (and infinity) the largest
// number.
Rgbe encodeRgbe(float red, float green, float blue) {
  const float kLargest = std::ldexp(255.0f, 255 - kExponentBias);
  const auto clamped = [&](float value) { return value > 0.0f ? std::min(value, kLargest) : 0.0f; };
  const std::array<float, 3> rgb = {clamped(red), clamped(green), clamped(blue)};
  const float largest = std::max({rgb[0], rgb[1], rgb[2]});
  if (largest == 0.0f) return {};
  int exponent = 0;
  std::frexp(largest, &exponent);
  if (std::lround(std::ldexp(largest, 8 - exponent)) == 256) ++exponent;
  const int storedExponent = exponent - 8 + kExponentBias;
  if (storedExponent < 1) return {};
  Rgbe rgbe{};
  for (std::size_t i = 0; i < rgb.size(); ++i) {
    rgbe[i] = static_cast<std::uint8_t>(std::lround(std::ldexp(rgb[i], 8 - exponent)));
  }
  rgbe[3] = static_cast<std::uint8_t>(storedExponent);
  return rgbe;
}

void appendRunLengths(std::string& out, const std::vector<std::uint8_t>& bytes) {
  std::size_t next = 0;
  while (next < bytes.size()) {
    std::size_t runStart = next;
    std::size_t runLength = 0;
    while (runStart < bytes.size()) {
      runLength = 1;
      while (runStart + runLength < bytes.size() && runLength < kMaxRun &&
             bytes[runStart + runLength] == bytes[runStart]) {
        ++runLength;
      }
      if (runLength >= kMinRun) break;
      runStart += runLength;
    }
    while (next < runStart) {
      const std::size_t count = std::min(kMaxLiteral, runStart - next);
      out += static_cast<char>(count);
      for (std::size_t i = 0; i < count; ++i) out += static_cast<char>(bytes[next + i]);
      next += count;
    }
    if (runStart < bytes.size()) {
      out += static_cast<char>(128 + runLength);
      out += static_cast<char>(bytes[runStart]);
      next += runLength;
    }
  }
}

Expected<std::string> encodeHdr(const LayeredImage& image) {
  const auto rgb = findRgbChannels(image, kHdrFormat);
  if (!rgb) return tl::unexpected(rgb.error());
  std::string out = "#?RADIANCE\n" + metadataLines(image.metadata) + "FORMAT=32-bit_rle_rgbe\n\n" +
                    fmt::format("-Y {} +X {}\n", image.height, image.width);
  const auto width = static_cast<std::size_t>(image.width);
  const bool runLengths = image.width >= kMinRleWidth && image.width <= kMaxRleWidth;
  std::vector<Rgbe> row(width);
  std::vector<std::uint8_t> component(width);
  for (int y = 0; y < image.height; ++y) {
    const std::size_t start = static_cast<std::size_t>(y) * width;
    for (std::size_t x = 0; x < width; ++x) {
      row[x] = encodeRgbe((*rgb)[0][start + x], (*rgb)[1][start + x], (*rgb)[2][start + x]);
    }
    if (!runLengths) {
      // A flat pixel cannot be taken for a code: those begin with 1, 1, 1 or with 2, 2 and less than 128, and
      // here the largest mantissa is at least 128.
      for (const Rgbe& pixel : row) out.append(pixel.begin(), pixel.end());
      continue;
    }
    out += {2, 2, static_cast<char>(image.width >> 8), static_cast<char>(image.width & 0xff)};
    for (std::size_t i = 0; i < row.front().size(); ++i) {
      for (std::size_t x = 0; x < width; ++x) component[x] = row[x][i];
      appendRunLengths(out, component);
    }
  }
  return out;
}

struct HdrHeader {
  bool leftToRight = true;
  bool topToBottom = true;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::array<float, 3> exposure = {1.0f, 1.0f, 1.0f};  // what the pixels were multiplied by
  std::map<std::string, std::string> metadata;
};

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> list;
  for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
    const std::size_t length = std::min(text.find(' '), text.size());
    list.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
  return list;
}

// EXPOSURE has one factor, COLORCORR one a component; both may stand repeatedly and multiply up.
bool multiplyExposure(std::string_view values, std::size_t count, std::array<float, 3>& exposure) {
  const std::vector<std::string_view> factors = words(values);
  if (factors.size() != count) return false;
  for (std::size_t i = 0; i < exposure.size(); ++i) {
    const auto factor = parseNumber<float>(factors[count == 1 ? 0 : i]);
    if (!factor) return false;
    exposure[i] *= *factor;
    if (!std::isnormal(exposure[i]) || exposure[i] < 0.0f) return false;
  }
  return true;
}

Expected<HdrHeader> takeHeader(std::string_view& bytes) {
  HdrHeader header;
  for (;;) {
    const auto line = takeLine(bytes);
    if (!line) return endsEarly();
    const std::string_view text = trimmed(*line);
    if (text.empty()) break;
    if (text.starts_with('#')) {
      readMetadataLine(*line, header.metadata);
    } else if (text.starts_with("FORMAT=")) {
      const std::string_view format = trimmed(text.substr(7));
      if (format != "32-bit_rle_rgbe") {
        return makeError(
            "", fmt::format("has pixels of format '{}', expected 32-bit_rle_rgbe", printable(format)),
            "convert it with Radiance's ra_xyze -r");
      }
    } else if (text.starts_with("EXPOSURE=")) {
      if (!multiplyExposure(text.substr(9), 1, header.exposure))
        return makeError("", "has a damaged EXPOSURE");
    } else if (text.starts_with("COLORCORR=")) {
      if (!multiplyExposure(text.substr(10), 3, header.exposure))
        return makeError("", "has a damaged COLORCORR");
    }
  }
  const auto line = takeLine(bytes);
  if (!line) return endsEarly();
  const std::vector<std::string_view> size = words(*line);
  const bool rowsFirst =
      size.size() == 4 && (size[0] == "-Y" || size[0] == "+Y") && (size[2] == "-X" || size[2] == "+X");
  const auto height = rowsFirst ? parseNumber<std::int64_t>(size[1]) : std::nullopt;
  const auto width = rowsFirst ? parseNumber<std::int64_t>(size[3]) : std::nullopt;
  if (!height || !width) {
    return makeError(
        "",
        fmt::format("has the size line '{}', expected '-Y height +X width'", printable(line->substr(0, 40))),
        "turn it with Radiance's protate if its columns come first");
  }
  header.topToBottom = size[0] == "-Y";
  header.leftToRight = size[2] == "+X";
  header.width = *width;
  header.height = *height;
  return header;
}

std::uint8_t takeByte(std::string_view& bytes) {
  const auto byte = static_cast<std::uint8_t>(bytes.front());
  bytes.remove_prefix(1);
  return byte;
}

bool takeComponent(std::string_view& bytes, std::vector<Rgbe>& row, std::size_t component) {
  for (std::size_t x = 0; x < row.size();) {
    if (bytes.size() < 2) return false;
    const std::size_t code = takeByte(bytes);
    const bool isRun = code > kMaxLiteral;
    const std::size_t count = isRun ? code - 128 : code;
    if (count == 0 || count > row.size() - x || (!isRun && count > bytes.size())) return false;
    const std::uint8_t repeated = isRun ? takeByte(bytes) : std::uint8_t{0};
    for (std::size_t i = 0; i < count; ++i) row[x++][component] = isRun ? repeated : takeByte(bytes);
  }
  return true;
}

// Flat pixels, among which 1, 1, 1, n repeats the last pixel n times; codes in a row are digits to base 256.
bool takeFlatScanline(std::string_view& bytes, std::vector<Rgbe>& row) {
  int shift = 0;
  for (std::size_t x = 0; x < row.size();) {
    if (bytes.size() < 4) return false;
    const Rgbe pixel = {takeByte(bytes), takeByte(bytes), takeByte(bytes), takeByte(bytes)};
    if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
      row[x++] = pixel;
      shift = 0;
      continue;
    }
    if (x == 0 || shift > 24) return false;
    const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
    if (count > row.size() - x) return false;
    std::fill_n(row.begin() + static_cast<std::ptrdiff_t>(x), count, row[x - 1]);
    x += count;
    shift += 8;
  }
  return true;
}

bool takeScanline(std::string_view& bytes, std::vector<Rgbe>& row) {
  if (bytes.size() < 4) return false;
  const auto code = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
  const bool fits = row.size() >= kMinRleWidth && row.size() <= kMaxRleWidth;
  if (!fits || code(0) != 2 || code(1) != 2 || code(2) >= 128) return takeFlatScanline(bytes, row);
  if (static_cast<std::size_t>(code(2) << 8 | code(3)) != row.size()) return false;
  bytes.remove_prefix(4);
  for (std::size_t component = 0; component < 4; ++component) {
    if (!takeComponent(bytes, row, component)) return false;
  }
  return true;
}

Expected<LayeredImage> decodeHdr(std::string_view bytes, LoadWatch& watch) {
  Expected<HdrHeader> header = takeHeader(bytes);
  if (!header) return tl::unexpected(header.error());
  if (const auto size = checkPictureSize(header->width, header->height, 3); !size)
    return tl::unexpected(size.error());
  // A scanline takes at least the four bytes of a code or a pixel.
  if (bytes.size() / 4 < static_cast<std::size_t>(header->height)) return endsEarly();

  LayeredImage image;
  image.width = static_cast<int>(header->width);
  image.height = static_cast<int>(header->height);
  image.metadata = std::move(header->metadata);
  const std::array<float*, 3> rgb = addRgbChannels(image);
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<Rgbe> row(width);
  for (int line = 0; line < image.height; ++line) {
    watch.look(static_cast<double>(line) / image.height);
    if (!takeScanline(bytes, row)) {
      return makeError("", fmt::format("is damaged or cut off in scanline {} of {}", line + 1, image.height));
    }
    const int y = header->topToBottom ? line : image.height - 1 - line;
    for (std::size_t i = 0; i < width; ++i) {
      const std::size_t x = header->leftToRight ? i : width - 1 - i;
      const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
      const float unit = row[i][3] == 0 ? 0.0f : std::ldexp(1.0f, row[i][3] - kExponentBias);
      for (std::size_t component = 0; component < rgb.size(); ++component) {
        rgb[component][pixel] = static_cast<float>(row[i][component]) * unit / header->exposure[component];
      }
    }
  }
  return image;
}

}  // namespace

constinit const ImageFormat kHdrFormat = {".hdr", "Radiance HDR", recognisesHdr, encodeHdr, decodeHdr};

}  // namespace lightvane
