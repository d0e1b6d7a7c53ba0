#include "app/shipped_files.h"

#include <system_error>

namespace lightvane {

namespace fs = std::filesystem;

std::optional<fs::path> shippedFile(const fs::path& name) {
  std::error_code error;
  for (fs::path folder = fs::read_symlink("/proc/self/exe", error); folder.has_relative_path();
       folder = folder.parent_path()) {
    fs::path file = folder.parent_path() / name;
    if (fs::is_regular_file(file, error)) return file;
  }
  return std::nullopt;
}

}  // namespace lightvane
