// OpenEXR pictures by way of the OpenEXR library, from and to memory.
// The file: https://openexr.com/en/latest/OpenEXRFileLayout.html

#include <algorithm>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <thread>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfTileDescription.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include "core/base/tasks.h"
#include "core/image/image_format.h"

namespace lightvane {
namespace {

// Our metadata keys share the header with OpenEXR's own attributes ("type", "name", "view" mean something
// there).
constexpr std::string_view kMetadataPrefix = "lightvane:";

constexpr std::size_t kMagicAndVersionBytes = 8;

// The name under which OpenEXR's messages mention the stream; the path is told by our own message.
constexpr const char* kStreamName = "picture";

class MemoryReader final : public Imf::IStream {
 public:
  explicit MemoryReader(std::string_view bytes) : IStream(kStreamName), bytes_(bytes) {}

  bool read(char* out, int count) override {
    const auto wanted = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || wanted > bytes_.size() - position_) {
      throw std::runtime_error("unexpected end of file");
    }
    std::memcpy(out, bytes_.data() + position_, wanted);
    position_ += wanted;
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::uint64_t position_ = 0;
};

class MemoryWriter final : public Imf::OStream {
 public:
  MemoryWriter() : OStream(kStreamName) {}

  void write(const char* in, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (position_ + size > bytes_.size()) bytes_.resize(position_ + size);
    std::memcpy(bytes_.data() + position_, in, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string takeBytes() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::uint64_t position_ = 0;
};

/// Threads of OpenEXR's global pool, for writing: compressing takes longer than all else, and the bytes do
/// not depend on how many there are. Files are read by the calling thread, in order.
int poolThreads() {
  static const int threads = [] {
    const int count = kLibrariesMayUseThreads ? static_cast<int>(std::thread::hardware_concurrency()) : 0;
    Imf::setGlobalThreadCount(count);
    return count;
  }();
  return threads;
}

bool recognisesExr(std::string_view bytes) { return bytes.starts_with("\x76\x2f\x31\x01"); }

Expected<std::string> encodeExr(const LayeredImage& image) {
  try {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [key, value] : image.metadata) {
      header.insert(std::string(kMetadataPrefix) + key, Imf::StringAttribute(value));
    }
    Imf::FrameBuffer pixels;
    const auto addChannel = [&](const std::string& name, Imf::PixelType type, const void* data) {
      header.channels().insert(name, Imf::Channel(type));
      // OpenEXR has one kind of slice for reading and writing; OutputFile only reads it.
      char* base = const_cast<char*>(static_cast<const char*>(data));
      pixels.insert(name, Imf::Slice(type, base, 4, 4 * static_cast<std::size_t>(image.width)));
    };
    for (const auto& [name, channel] : image.channels) addChannel(name, Imf::FLOAT, channel.data());
    for (const auto& [name, channel] : image.uintChannels) addChannel(name, Imf::UINT, channel.data());

    MemoryWriter stream;
    {
      Imf::OutputFile file(stream, header, poolThreads());
      file.setFrameBuffer(pixels);
      file.writePixels(image.height);
    }  // the destructor writes the table of offsets
    return stream.takeBytes();
  } catch (const std::exception& error) {
    return makeError("", fmt::format("cannot be written as OpenEXR: {}", error.what()));
  }
}

// Walks over the header's attributes. OpenEXR takes memory for an attribute before it finds out that the file
// ends.
Expected<void> checkAttributesFit(std::string_view bytes) {
  bytes.remove_prefix(std::min(kMagicAndVersionBytes, bytes.size()));
  for (;;) {
    const std::size_t nameLength = bytes.find('\0');
    if (nameLength == std::string_view::npos) return endsEarly();
    bytes.remove_prefix(nameLength + 1);
    if (nameLength == 0) return {};
    const std::size_t typeLength = bytes.find('\0');
    if (typeLength == std::string_view::npos || bytes.size() - typeLength - 1 < 4) return endsEarly();
    bytes.remove_prefix(typeLength + 1);
    std::size_t size = 0;
    for (std::size_t i = 0; i < 4; ++i) size |= std::size_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    bytes.remove_prefix(4);
    if (size > bytes.size()) return endsEarly();
    bytes.remove_prefix(size);
  }
}

// The scanlines that OpenEXR compresses together.
std::int64_t rowsPerChunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION:
    case Imf::RLE_COMPRESSION:
    case Imf::ZIPS_COMPRESSION:
      return 1;
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION:
      return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
      return 32;
    case Imf::DWAB_COMPRESSION:
      return 256;
    default:
      throw std::runtime_error("unknown compression");
  }
}

Expected<void> checkHeader(const Imf::Header& header, bool tiled, std::size_t fileBytes) {
  std::int64_t channels = 0;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    ++channels;
    if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) {
      return makeError("", fmt::format("has a subsampled channel '{}'", printable(channel.name())),
                       "save it with all channels at full size");
    }
  }
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (auto size = checkPictureSize(width, height, channels); !size) return size;

  // OpenEXR takes memory for a whole chunk and for a table of all chunks before it reads the first. A chunk
  // occupies at least its 8 bytes in the table, and 8 more before its pixels.
  std::int64_t chunkWidth = width;
  std::int64_t chunkHeight = rowsPerChunk(header.compression());
  if (tiled) {
    chunkWidth = header.tileDescription().xSize;
    chunkHeight = header.tileDescription().ySize;
    if (auto size = checkPictureSize(chunkWidth, chunkHeight, channels); !size) return size;
  }
  // Tiles are read by rows of them.
  if (auto size = checkPictureSize(width, chunkHeight, channels); !size) return size;
  const std::int64_t chunks =
      ((width + chunkWidth - 1) / chunkWidth) * ((height + chunkHeight - 1) / chunkHeight);
  if (chunks > static_cast<std::int64_t>(fileBytes / 16)) return endsEarly();
  return {};
}

Expected<LayeredImage> decodeExr(std::string_view bytes, LoadWatch& watch) {
  if (const auto fit = checkAttributesFit(bytes); !fit) return tl::unexpected(fit.error());
  try {
    int version = 0;
    for (std::size_t i = kMagicAndVersionBytes; i-- > 4;) {
      version = static_cast<int>(static_cast<unsigned>(version) << 8 | static_cast<unsigned char>(bytes[i]));
    }
    if (Imf::isMultiPart(version) || Imf::isNonImage(version)) {
      return makeError("", "has several parts or deep pixels", "save it as a single flat part");
    }
    {
      MemoryReader stream(bytes);
      stream.seekg(kMagicAndVersionBytes);
      Imf::Header header;
      header.readFrom(stream, version);
      if (const auto sound = checkHeader(header, Imf::isTiled(version), bytes.size()); !sound) {
        return tl::unexpected(sound.error());
      }
    }

    MemoryReader stream(bytes);
    Imf::InputFile file(stream, 0);
    const Imf::Header& header = file.header();
    const Imath::Box2i window = header.dataWindow();
    LayeredImage image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    Imf::FrameBuffer pixels;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
      // Half floats widen without loss.
      const bool isUint = channel.channel().type == Imf::UINT;
      void* data = nullptr;
      if (isUint) {
        data = (image.uintChannels[channel.name()] = ImageUint(image.width, image.height)).data();
      } else {
        data = (image.channels[channel.name()] = ImageFloat(image.width, image.height)).data();
      }
      pixels.insert(channel.name(), Imf::Slice::Make(isUint ? Imf::UINT : Imf::FLOAT, data, window));
    }
    file.setFrameBuffer(pixels);
    // A few blocks of most compressions, for threads to share; of larger blocks, decoded ones are kept.
    constexpr int kRowsPerLook = 64;
    for (int row = 0; row < image.height; row += kRowsPerLook) {
      watch.look(static_cast<double>(row) / image.height);
      file.readPixels(window.min.y + row, window.min.y + std::min(row + kRowsPerLook, image.height) - 1);
    }

    for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
      const std::string_view name = attribute.name();
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute());
      if (text == nullptr || !name.starts_with(kMetadataPrefix)) continue;
      const std::string key(name.substr(kMetadataPrefix.size()));
      if (isMetadataKey(key)) image.metadata[key] = text->value();
    }
    // A grey picture ("Y" alone) is one of equal red, green and blue.
    const auto grey = image.channels.find("Y");
    if (grey != image.channels.end() && !image.channels.contains("R") && !image.channels.contains("G") &&
        !image.channels.contains("B")) {
      for (const char* name : {"R", "G", "B"}) image.channels[name] = grey->second;
    }
    return image;
  } catch (const std::bad_alloc&) {
    throw;  // says nothing about the file
  } catch (const std::exception& error) {
    return makeError("", fmt::format("is damaged or cut off: {}", printable(error.what())));
  }
}

}  // namespace

constinit const ImageFormat kExrFormat = {".exr", "OpenEXR", recognisesExr, encodeExr, decodeExr};

}  // namespace lightvane
