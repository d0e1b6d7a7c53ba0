// PNG pictures by way of libpng. "Portable Network Graphics (PNG) Specification (Third Edition)", W3C.

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "core/image/image_format.h"

// libpng reports errors by longjmp. A function here that calls setjmp has no variable with a destructor, and
// neither have the callbacks; what must outlive a jump is owned by the caller.

namespace lightvane {
namespace {

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";

struct ErrorText {
  std::array<char, 128> text{};
};

[[noreturn]] void reportError(png_structp png, png_const_charp message) {
  auto* error = static_cast<ErrorText*>(png_get_error_ptr(png));
  std::strncpy(error->text.data(), message, error->text.size() - 1);
  png_longjmp(png, 1);
}

// Warnings are about what a picture can do without.
void ignoreWarning(png_structp, png_const_charp) {}

bool recognisesPng(std::string_view bytes) { return bytes.starts_with(kSignature); }

// --- Writing
// ---------------------------------------------------------------------------------------------------

struct Writer {
  ErrorText error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;

  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, reportError, ignoreWarning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_write_struct(&png, &info);
      throw std::bad_alloc();
    }
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

void appendBytes(png_structp png, png_bytep data, png_size_t size) {
  bool appended = true;
  try {
    static_cast<Writer*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<const char*>(data), size);
  } catch (const std::bad_alloc&) {
    appended = false;
  }
  if (!appended) png_error(png, "takes more memory than there is");
}

void flushNothing(png_structp) {}

bool writePng(Writer& writer, png_uint_32 width, png_uint_32 height, const std::vector<png_text>& texts,
              std::vector<png_bytep>& rows) {
  png_structp png = writer.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &writer, appendBytes, flushNothing);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // libpng's own limit is a million
  png_set_IHDR(png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (!texts.empty()) png_set_text(png, writer.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, writer.info);
  png_write_image(png, rows.data());
  png_write_end(png, writer.info);
  return true;
}

png_byte displayCode(float radiance) {
  return static_cast<png_byte>(std::lround(255.0f * encodeSrgb(radiance)));
}

bool isAscii(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

Expected<std::string> encodePng(const LayeredImage& image) {
  const auto rgb = findRgbChannels(image, kPngFormat);
  if (!rgb) return tl::unexpected(rgb.error());
  const auto width = static_cast<std::size_t>(image.width);
  const auto height = static_cast<std::size_t>(image.height);
  std::vector<png_byte> codes(width * height * 3);
  for (std::size_t i = 0; i < width * height; ++i) {
    for (std::size_t component = 0; component < 3; ++component) {
      codes[3 * i + component] = displayCode((*rgb)[component][i]);
    }
  }
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = codes.data() + y * width * 3;

  // tEXt is Latin-1, iTXt UTF-8. libpng's struct has no const, but png_set_text copies.
  std::vector<png_text> texts;
  for (const auto& [key, value] : image.metadata) {
    png_text text{};
    text.compression = isAscii(value) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    text.key = const_cast<char*>(key.c_str());
    text.text = const_cast<char*>(value.c_str());
    texts.push_back(text);
  }
  Writer writer;
  if (!writePng(writer, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), texts, rows)) {
    return makeError("", fmt::format("cannot be written as PNG: {}", writer.error.text.data()));
  }
  return std::move(writer.bytes);
}

// --- Reading
// ---------------------------------------------------------------------------------------------------

struct Reader {
  ErrorText error;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view rest;

  explicit Reader(std::string_view bytes) : rest(bytes) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, reportError, ignoreWarning);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) {
      png_destroy_read_struct(&png, &info, nullptr);
      throw std::bad_alloc();
    }
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void takeBytes(png_structp png, png_bytep out, png_size_t size) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (size > reader->rest.size()) png_error(png, "unexpected end of file");
  std::memcpy(out, reader->rest.data(), size);
  reader->rest.remove_prefix(size);
}

// Walks over the chunks: length, type, data, check sum. libpng takes and clears as much memory as a chunk
// claims to be long before it finds out that the file ends.
Expected<void> checkChunksFit(std::string_view bytes) {
  constexpr std::size_t kFrameBytes = 12;
  for (bytes.remove_prefix(kSignature.size()); bytes.size() >= kFrameBytes;) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<unsigned char>(bytes[i]);
    if (length > bytes.size() - kFrameBytes) break;
    if (bytes.substr(4, 4) == "IEND") return {};
    bytes.remove_prefix(length + kFrameBytes);
  }
  return endsEarly();
}

// What the file says about its pixels.
struct PngHeader {
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  std::size_t rowBytes = 0;  // before compression
  bool hasAlpha = false;
};

bool readHeader(Reader& reader, PngHeader& header) {
  png_structp png = reader.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &reader, takeBytes);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_read_info(png, reader.info);
  header.width = png_get_image_width(png, reader.info);
  header.height = png_get_image_height(png, reader.info);
  header.rowBytes = png_get_rowbytes(png, reader.info);
  header.hasAlpha = (png_get_color_type(png, reader.info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                    png_get_valid(png, reader.info, PNG_INFO_tRNS) != 0;
  return true;
}

// What the pixels are after libpng has unpacked palettes, small bit depths and transparent colours.
struct Layout {
  std::size_t rowBytes = 0;
  std::size_t channels = 0;  // grey or RGB, with or without alpha
  int bitDepth = 0;          // 8 or 16
  int passes = 1;            // over all rows: several where the picture is interlaced
};

// Takes memory for a row.
bool prepareUnpacking(Reader& reader, Layout& layout) {
  png_structp png = reader.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_expand(png);
  layout.passes = png_set_interlace_handling(png);
  png_read_update_info(png, reader.info);
  layout.rowBytes = png_get_rowbytes(png, reader.info);
  layout.channels = png_get_channels(png, reader.info);
  layout.bitDepth = png_get_bit_depth(png, reader.info);
  return true;
}

// False, too, where the watch says stop.
bool readPixels(Reader& reader, const Layout& layout, std::vector<png_bytep>& rows, LoadWatch& watch) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  for (int pass = 0; pass < layout.passes; ++pass) {
    for (std::size_t y = 0; y < rows.size(); ++y) {
      if (watch.isStopped()) return false;
      watch.tellFraction((pass + static_cast<double>(y) / static_cast<double>(rows.size())) / layout.passes);
      png_read_row(reader.png, rows[y], nullptr);
    }
  }
  png_read_end(reader.png, reader.info);  // the check sums and the texts that follow the pixels
  return true;
}

std::string utf8FromLatin1(std::string_view text) {
  std::string utf8;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      utf8 += c;
    } else {
      utf8 += static_cast<char>(0xc0 | code >> 6);
      utf8 += static_cast<char>(0x80 | (code & 0x3f));
    }
  }
  return utf8;
}

void readTexts(const Reader& reader, std::map<std::string, std::string>& metadata) {
  png_textp texts = nullptr;
  int count = 0;
  png_get_text(reader.png, reader.info, &texts, &count);
  for (int i = 0; i < count; ++i) {
    const png_text& text = texts[i];
    if (text.key == nullptr || text.text == nullptr || !isMetadataKey(text.key)) continue;
    const bool isLatin1 = text.compression < PNG_ITXT_COMPRESSION_NONE;
    metadata[text.key] = isLatin1 ? utf8FromLatin1(text.text) : std::string(text.text);
  }
}

// What each code stands for in linear light: sRGB's, whatever a gAMA chunk says. glTF wants it so, other
// programs do so, and what writes such chunks often does not mean them.
std::vector<float> linearOfCode(int bitDepth) {
  const std::size_t codes = std::size_t{1} << bitDepth;
  std::vector<float> linear(codes);
  for (std::size_t code = 0; code < codes; ++code)
    linear[code] = decodeSrgb(static_cast<float>(code) / static_cast<float>(codes - 1));
  return linear;
}

Expected<LayeredImage> decodePng(std::string_view bytes, LoadWatch& watch) {
  if (const auto fit = checkChunksFit(bytes); !fit) return tl::unexpected(fit.error());
  Reader reader(bytes);
  const auto damaged = [&] {
    return makeError("", fmt::format("is damaged: {}", printable(reader.error.text.data())));
  };
  PngHeader header;
  if (!readHeader(reader, header)) return damaged();
  if (const auto size = checkPictureSize(header.width, header.height, header.hasAlpha ? 4 : 3); !size) {
    return tl::unexpected(size.error());
  }
  // Deflate shrinks by 1032 at most (https://zlib.net/zlib_tech.html): a file that
  // promises more cannot be whole.
  if (header.rowBytes * header.height / 1032 > bytes.size()) return endsEarly();

  Layout layout;
  if (!prepareUnpacking(reader, layout)) return damaged();
  // Cleared by the system as rows are read.
  std::vector<png_byte, ZeroedAllocator<png_byte>> codes(layout.rowBytes * header.height);
  std::vector<png_bytep> rows(header.height);
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = codes.data() + y * layout.rowBytes;
  watch.part(0.1, 0.8);
  const bool isWhole = readPixels(reader, layout, rows, watch);
  watch.look();
  if (!isWhole) return damaged();
  watch.part(0.8, 1.0);

  LayeredImage image;
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  readTexts(reader, image.metadata);
  const std::array<float*, 3> rgb = addRgbChannels(image);
  const std::size_t colours = layout.channels < 3 ? 1 : 3;
  float* alpha = nullptr;
  if (header.hasAlpha) alpha = (image.channels["A"] = ImageFloat(image.width, image.height)).data();

  const std::vector<float> linear = linearOfCode(layout.bitDepth);
  const auto largestCode = static_cast<float>(linear.size() - 1);
  const std::size_t codeBytes = layout.bitDepth == 16 ? 2 : 1;
  for (std::size_t y = 0; y < header.height; ++y) {
    watch.look(static_cast<double>(y) / header.height);
    for (std::size_t x = 0; x < header.width; ++x) {
      const png_byte* pixel = rows[y] + x * layout.channels * codeBytes;
      const auto code = [&](std::size_t channel) -> std::size_t {
        const png_byte* first = pixel + channel * codeBytes;
        return codeBytes == 2 ? static_cast<std::size_t>(first[0]) << 8 | first[1] : first[0];
      };
      const std::size_t i = y * header.width + x;
      for (std::size_t c = 0; c < 3; ++c) rgb[c][i] = linear[code(colours == 3 ? c : 0)];
      if (alpha != nullptr) alpha[i] = static_cast<float>(code(colours)) / largestCode;
    }
  }
  return image;
}

}  // namespace

constinit const ImageFormat kPngFormat = {".png", "PNG", recognisesPng, encodePng, decodePng};

}  // namespace lightvane
