#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace lightvane {

/// Where the XDG Base Directory Specification has a program's files.
struct UserFolders {
  std::filesystem::path config;  ///< keys.conf and settings.toml; empty where there is no home
  std::filesystem::path state;   ///< recent files; likewise

  /// By $XDG_CONFIG_HOME, $XDG_STATE_HOME and $HOME.
  static UserFolders ofEnvironment();
  std::filesystem::path keys() const { return config.empty() ? config : config / "keys.conf"; }
  std::filesystem::path settings() const { return config.empty() ? config : config / "settings.toml"; }
  std::filesystem::path recent() const { return state.empty() ? state : state / "recent-files"; }
};

/// Scenes that were opened, the last one first. At most ten; those that are gone are left out when it is
/// read.
class RecentFiles {
 public:
  explicit RecentFiles(std::filesystem::path file) : file_(std::move(file)) { read(); }

  std::span<const std::filesystem::path> paths() const { return paths_; }
  /// Puts it first, and writes the list. That it cannot be written is not worth a word: nothing of the user's
  /// is lost.
  void add(const std::filesystem::path& scene);

 private:
  void read();

  std::filesystem::path file_;
  std::vector<std::filesystem::path> paths_;
};

}  // namespace lightvane
