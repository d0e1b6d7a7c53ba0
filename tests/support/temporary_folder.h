#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lightvane {

/// A new folder that goes with this object. Its name is its own: tests run side by side.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  /// Writes a file and returns its path.
  std::filesystem::path write(std::string_view name, std::string_view content) const;
  /// The names of what lies in it, sorted.
  std::vector<std::string> files() const;
  /// Leaves the folder where it is when this object goes, for someone to look into.
  void keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

}  // namespace lightvane
