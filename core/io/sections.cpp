#include "core/io/sections.h"

#include <algorithm>

#include <fmt/format.h>
#include <xxhash.h>

#include "core/base/check.h"
#include "core/base/file.h"

namespace lightvane {
namespace {

constexpr std::size_t kTagSize = 4;
constexpr std::size_t kLengthSize = 8;
constexpr std::size_t kChecksumSize = 8;
constexpr const char* kMend = "copy it again, or have it computed anew";

void appendLetters(ByteWriter& writer, std::string_view letters) {
  for (char letter : letters) writer(letter);
}

}  // namespace

std::uint64_t checksum(std::string_view bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

SectionWriter::SectionWriter(const FileKind& kind) {
  appendLetters(writer_, kind.magic);
  writer_.number(kFileVersion);
}

std::size_t SectionWriter::begin(const SectionKind& kind) {
  LV_CHECK(kind.tag.size() == kTagSize, "the tag {}", kind.tag);
  const std::size_t start = writer_.bytes().size();
  appendLetters(writer_, kind.tag);
  writer_.number(std::uint64_t{0});
  return start;
}

void SectionWriter::end(std::size_t start) {
  writer_.overwrite(start + kTagSize, std::uint64_t{writer_.bytes().size() - start - kTagSize - kLengthSize});
  writer_.number(checksum(std::string_view(writer_.bytes()).substr(start)));
}

Expected<SectionReader> SectionReader::open(const std::filesystem::path& path, const FileKind& kind) {
  Expected<std::string> bytes = readFile(path);
  if (!bytes) return tl::unexpected(bytes.error());
  SectionReader file(path.string(), std::move(*bytes));
  const std::size_t begun = std::min(file.bytes_.size(), kind.magic.size());
  if (file.rest().substr(0, begun) != kind.magic.substr(0, begun)) {
    return file.error(fmt::format("is not {}", kind.name), "");
  }
  file.position_ = kind.magic.size() + sizeof(kFileVersion);
  if (file.bytes_.size() < file.position_) {
    return file.error(fmt::format("is cut short: it ends after {} bytes", file.bytes_.size()), kMend);
  }
  std::uint32_t version = 0;
  ByteReader(std::string_view(file.bytes_).substr(kind.magic.size())).number(version);
  if (version > kFileVersion) {
    return file.error(
        fmt::format("is of version {}, and this Lightvane reads version {}", version, kFileVersion),
        "use a newer Lightvane, or have it computed anew");
  }
  if (version < kFileVersion) {
    return file.error(fmt::format("is of version {}, which this Lightvane does not read", version),
                      "have it computed anew");
  }
  return file;
}

tl::unexpected<Error> SectionReader::error(std::string what, std::string hint) const {
  return makeError(where_, std::move(what), std::move(hint));
}

tl::unexpected<Error> SectionReader::damaged(const std::string& how) const {
  return error("is damaged: " + how, kMend);
}

Expected<std::string_view> SectionReader::next(const SectionKind& kind) {
  constexpr std::size_t kHeaderSize = kTagSize + kLengthSize;
  std::uint64_t length = 0;
  const bool hasFrame = rest().size() >= kHeaderSize + kChecksumSize;
  if (hasFrame) ByteReader(rest().substr(kTagSize)).number(length);
  if (!hasFrame || length > rest().size() - kHeaderSize - kChecksumSize) {
    return error(fmt::format("is cut short or damaged: it ends before its {} do", kind.name), kMend);
  }
  const std::size_t summed = kHeaderSize + static_cast<std::size_t>(length);
  std::uint64_t stored = 0;
  ByteReader(rest().substr(summed)).number(stored);
  if (checksum(rest().substr(0, summed)) != stored) {
    return damaged(fmt::format("the checksum of its {} does not fit", kind.name));
  }
  if (rest().substr(0, kTagSize) != kind.tag) {
    return damaged(fmt::format("its {} are not in their place", kind.name));
  }
  const std::string_view content = rest().substr(kHeaderSize, static_cast<std::size_t>(length));
  position_ += summed + kChecksumSize;
  return content;
}

Expected<void> SectionReader::end() const {
  if (!rest().empty()) return damaged(fmt::format("{} bytes follow its end", rest().size()));
  return {};
}

}  // namespace lightvane
