// JPEG pictures by way of libjpeg, read only: what a renderer writes deserves better.

#include <array>
#include <csetjmp>
#include <cstdio>
#include <memory>
#include <vector>

#include <jpeglib.h>

#include "core/base/color.h"
#include "core/image/image_format.h"

// libjpeg reports errors by a call that must not return, from which we jump. A function here that calls
// setjmp has no variable with a destructor; what must outlive a jump is owned by the caller.

namespace lightvane {
namespace {

/// Cleared by the system as rows are read.
using JpegBytes = std::vector<unsigned char, ZeroedAllocator<unsigned char>>;

struct JpegErrors {
  jpeg_error_mgr manager{};
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> text{};
};

[[noreturn]] void reportJpegError(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  info->err->format_message(info, errors->text.data());
  std::longjmp(errors->jump, 1);
}

void ignoreJpegMessage(j_common_ptr) {}

/// What libjpeg calls for every row of blocks of every scan: of a progressive picture, all are read before
/// the first row of pixels is there.
struct JpegProgress {
  jpeg_progress_mgr manager{};
  LoadWatch* watch = nullptr;
};

void tellJpegProgress(j_common_ptr info) {
  auto& progress = *reinterpret_cast<JpegProgress*>(info->progress);
  if (progress.watch->isStopped()) std::longjmp(reinterpret_cast<JpegErrors*>(info->err)->jump, 1);
}

struct JpegReader {
  JpegErrors errors;
  JpegProgress progress;
  jpeg_decompress_struct info{};

  explicit JpegReader(LoadWatch& watch) {
    progress.watch = &watch;
    progress.manager.progress_monitor = tellJpegProgress;
    info.err = jpeg_std_error(&errors.manager);
    errors.manager.error_exit = reportJpegError;
    errors.manager.output_message = ignoreJpegMessage;
  }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;
  ~JpegReader() { jpeg_destroy_decompress(&info); }
};

/// False where the bytes are no picture that libjpeg turns into RGB; errors.text then says why.
bool readJpegHeader(JpegReader& reader, std::string_view bytes) {
  if (setjmp(reader.errors.jump) != 0) return false;
  jpeg_create_decompress(&reader.info);
  reader.info.progress = &reader.progress.manager;
  jpeg_mem_src(&reader.info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&reader.info, TRUE);
  reader.info.out_color_space = JCS_RGB;
  jpeg_calc_output_dimensions(&reader.info);
  return true;
}

/// False, too, where the watch says stop.
bool readJpegRows(JpegReader& reader, JpegBytes& pixels) {
  if (setjmp(reader.errors.jump) != 0) return false;
  jpeg_start_decompress(&reader.info);
  const std::size_t row = std::size_t{3} * reader.info.output_width;
  while (reader.info.output_scanline < reader.info.output_height) {
    if (reader.progress.watch->isStopped()) return false;
    reader.progress.watch->tellFraction(static_cast<double>(reader.info.output_scanline) /
                                        reader.info.output_height);
    JSAMPROW at = pixels.data() + row * reader.info.output_scanline;
    jpeg_read_scanlines(&reader.info, &at, 1);
  }
  jpeg_finish_decompress(&reader.info);
  return true;
}

bool recognisesJpeg(std::string_view bytes) { return bytes.starts_with("\xff\xd8\xff"); }

Expected<LayeredImage> decodeJpeg(std::string_view bytes, LoadWatch& watch) {
  const auto reader = std::make_unique<JpegReader>(watch);
  const auto damaged = [&] {
    return makeError("", "cannot be read: " + printable(reader->errors.text.data()));
  };
  if (!readJpegHeader(*reader, bytes)) return damaged();
  if (auto fits = checkPictureSize(reader->info.output_width, reader->info.output_height, 3); !fits)
    return tl::unexpected(fits.error());
  LayeredImage image;
  image.width = static_cast<int>(reader->info.output_width);
  image.height = static_cast<int>(reader->info.output_height);
  JpegBytes pixels(std::size_t{3} * reader->info.output_width * reader->info.output_height);
  watch.part(0.1, 0.6);
  const bool isWhole = readJpegRows(*reader, pixels);
  watch.look();
  if (!isWhole) return damaged();
  // libjpeg fills what a damaged or truncated file does not have with grey, and calls that a warning.
  if (reader->errors.manager.num_warnings > 0) {
    reader->errors.manager.format_message(reinterpret_cast<j_common_ptr>(&reader->info),
                                          reader->errors.text.data());
    return damaged();
  }
  const std::array<float*, 3> planes = addRgbChannels(image);
  watch.part(0.6, 1.0);
  for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
    watch.piece(i, pixels.size() / 3);
    for (std::size_t c = 0; c < 3; ++c)
      planes[c][i] = decodeSrgb(static_cast<float>(pixels[3 * i + c]) / 255.0f);
  }
  return image;
}

}  // namespace

const ImageFormat kJpgFormat = {".jpg", "JPEG", recognisesJpeg, nullptr, decodeJpeg};
const ImageFormat kJpegFormat = {".jpeg", "JPEG", recognisesJpeg, nullptr, decodeJpeg};

}  // namespace lightvane
