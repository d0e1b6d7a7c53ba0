#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include <unistd.h>

#include "core/base/file.h"
#include "core/scene/load_scene.h"

namespace lightvane::test {

/// A folder that lives as long as this object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("lightvane-load-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view content) const {
    const std::filesystem::path file = path_ / name;
    const Expected<void> written = writeFileAtomically(file, content);
    if (!written) throw std::runtime_error(written.error().message());
    return file;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The error of text read as "scene.toml", or an empty string where there is none.
inline std::string parseError(std::string_view text) {
  const Expected<SceneDescription> scene = parseSceneToml(text, "scene.toml");
  return scene ? std::string() : scene.error().message();
}

}  // namespace lightvane::test
