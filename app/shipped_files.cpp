#include "app/shipped_files.h"

#include <algorithm>
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
  // A program that was copied from its checkout, and is run there.
  if (fs::is_regular_file(name, error)) return fs::absolute(name, error);
  return std::nullopt;
}

std::vector<fs::path> shippedScenes() {
  std::vector<fs::path> scenes;
  const auto one = shippedFile("assets/scenes/cornell.toml");
  if (!one) return scenes;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(one->parent_path(), error)) {
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
  }
  std::ranges::sort(scenes);
  return scenes;
}

}  // namespace lightvane
