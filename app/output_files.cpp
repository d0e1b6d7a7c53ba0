#include "app/output_files.h"

#include <system_error>

#include <fmt/format.h>

#include "core/base/file.h"
#include "core/io/sections.h"

namespace lightvane {
namespace fs = std::filesystem;
namespace {

bool isSameFile(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  // Files that do not exist yet. A relative path stays so unless a part of it exists.
  return fs::weakly_canonical(fs::absolute(a, error), error) ==
         fs::weakly_canonical(fs::absolute(b, error), error);
}

}  // namespace

Expected<void> checkWritable(const fs::path& path) {
  // The write itself, stopped before the rename by the error at its end; see checkWritableImage.
  bool created = false;
  Expected<void> stopped = replaceFileAtomically(path, [&](const fs::path& temporary) -> Expected<void> {
    if (auto written = writeFileAtomically(temporary, "probe"); !written) {
      return makeError("", written.error().what, written.error().hint);
    }
    created = true;
    return makeError("", "was only a probe");
  });
  if (!created) return stopped;
  return {};
}

std::string plainFileName(const std::string& text) {
  constexpr std::size_t kLongest = 100;
  std::string name;
  for (const char c : text) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         c == '.' || c == '=' || c == '-' || c == '_';
    name += isPlain ? c : '_';
  }
  if (name.size() <= kLongest) return name;
  // What is cut off is told apart by a number.
  return fmt::format("{}-{:08x}", name.substr(0, kLongest), static_cast<std::uint32_t>(checksum(text)));
}

Expected<void> makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (std::filesystem::is_directory(folder, error)) return {};
  return makeError(folder.string(), "is no folder, and cannot be made one");
}

Expected<void> checkDistinct(std::span<const NamedFile> written, std::span<const NamedFile> kept) {
  for (std::size_t i = 0; i < written.size(); ++i) {
    const auto refuse = [&](const NamedFile& other) {
      return makeError(written[i].option,
                       fmt::format("{} is also {}", written[i].path.string(), other.option),
                       "name another file");
    };
    for (std::size_t j = 0; j < i; ++j) {
      if (isSameFile(written[i].path, written[j].path)) return refuse(written[j]);
    }
    for (const NamedFile& other : kept) {
      if (isSameFile(written[i].path, other.path)) return refuse(other);
    }
  }
  return {};
}

}  // namespace lightvane
