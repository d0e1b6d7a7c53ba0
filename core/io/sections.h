#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/io/archive.h"

namespace lightvane {

// The container of cache files and checkpoints: 8 bytes that name the kind, the format's version (4 bytes),
// then sections: a tag (4 bytes), the length of what it holds (8), that, and the XXH64 of the three (8). All
// little endian. Every kind says which sections follow each other.

/// The version of everything that these files hold. Rises with every change of it.
inline constexpr std::uint32_t kFileVersion = 3;

/// The XXH64 of bytes.
std::uint64_t checksum(std::string_view bytes);

struct FileKind {
  /// As PNG's (its specification, section 5.2): not text, and it shows line ends that were converted.
  std::string_view magic;
  const char* name;  ///< as a message says it, with its article
};

struct SectionKind {
  std::string_view tag;  ///< 4 letters
  const char* name;      ///< as a message says it
};

/// Makes the bytes of a file.
class SectionWriter {
 public:
  explicit SectionWriter(const FileKind& kind);

  /// `fill(ByteWriter&)` writes what the section holds.
  template <class Fill>
  void section(const SectionKind& kind, Fill&& fill) {
    const std::size_t start = begin(kind);
    fill(writer_);
    end(start);
  }

  const std::string& bytes() const { return writer_.bytes(); }

 private:
  std::size_t begin(const SectionKind& kind);
  void end(std::size_t start);

  ByteWriter writer_;
};

/// Takes a file apart, section by section. Every error names the file.
class SectionReader {
 public:
  /// Reads the file, and refuses one of another kind or version.
  static Expected<SectionReader> open(const std::filesystem::path& path, const FileKind& kind);

  /// `parse(ByteReader&)` reads the next section, which must be of this kind and hold exactly what is read.
  /// It is called only once the checksum is known to fit.
  template <class Parse>
  Expected<void> section(const SectionKind& kind, Parse&& parse) {
    const Expected<std::string_view> content = next(kind);
    if (!content) return tl::unexpected(content.error());
    ByteReader reader(*content);
    parse(reader);
    if (!reader.endedWell()) return damaged(std::string("its ") + kind.name + " cannot be read");
    return {};
  }

  /// Refuses a file that goes on after its last section.
  Expected<void> end() const;

  /// An error that names the file.
  tl::unexpected<Error> error(std::string what, std::string hint) const;
  /// The error of a file that does not hold what it should.
  tl::unexpected<Error> damaged(const std::string& how) const;

 private:
  SectionReader(std::string where, std::string bytes) : where_(std::move(where)), bytes_(std::move(bytes)) {}
  std::string_view rest() const { return std::string_view(bytes_).substr(position_); }
  Expected<std::string_view> next(const SectionKind& kind);

  std::string where_;
  std::string bytes_;
  std::size_t position_ = 0;
};

}  // namespace lightvane
