#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/background_job.h"
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

/// Writes a file of one of these folders, which is made where there is none.
Expected<void> writeUserFile(const std::filesystem::path& file, std::string_view text);

/// Scenes that were opened, the last one first. At most ten; those that are gone are left out when it is
/// read. Written in the background, because disks take their time. That the list cannot be written is not
/// worth a word: nothing of the user's is lost. All methods on one thread.
class RecentFiles {
 public:
  /// An empty path: nothing is read or written.
  explicit RecentFiles(std::filesystem::path file) : file_(std::move(file)), job_({}) { read(); }
  /// Writes what is left to be written.
  ~RecentFiles();
  RecentFiles(const RecentFiles&) = delete;
  RecentFiles& operator=(const RecentFiles&) = delete;

  std::span<const std::filesystem::path> paths() const { return paths_; }
  /// Puts it first.
  void add(const std::filesystem::path& scene);
  /// Begins to write what was added.
  void update();
  /// Something is still to be written.
  bool isBehind() const { return isBehind_; }

 private:
  void read();
  std::string text() const;

  std::filesystem::path file_;
  std::vector<std::filesystem::path> paths_;
  bool isBehind_ = false;
  BackgroundJob<Expected<void>> job_;
};

}  // namespace lightvane
