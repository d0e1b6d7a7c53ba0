#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace lightvane {

/// A file that a command reads or writes, and the option that names it.
struct NamedFile {
  std::filesystem::path path;
  std::string option;  ///< "--stats"
};

/// Tells before any work is done whether `path` could be written, as checkWritableImage does for pictures.
Expected<void> checkWritable(const std::filesystem::path& path);

/// The folder and those above it, where they are not there.
Expected<void> makeFolder(const std::filesystem::path& folder);

/// A name for files: of the text, what a shell and a web page take as it is.
std::string plainFileName(const std::string& text);

/// Refuses where two of `written` are the same file, or one of them is `kept`, which must stay as it is.
Expected<void> checkDistinct(std::span<const NamedFile> written, std::span<const NamedFile> kept);

}  // namespace lightvane
