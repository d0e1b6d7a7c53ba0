#include "app/user_files.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "core/base/file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostRecent = 10;
constexpr const char* kProgram = "lightvane";

/// The folder that the variable names, or `fallback` in the home folder. Relative ones are to be ignored.
fs::path baseFolder(const char* variable, const char* fallback) {
  if (const char* value = std::getenv(variable); value != nullptr && fs::path(value).is_absolute())
    return fs::path(value) / kProgram;
  const char* home = std::getenv("HOME");
  return home != nullptr && *home != '\0' ? fs::path(home) / fallback / kProgram : fs::path();
}

}  // namespace

Expected<void> writeUserFile(const fs::path& file, std::string_view text) {
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  return writeFileAtomically(file, text);
}

UserFolders UserFolders::ofEnvironment() {
  return {baseFolder("XDG_CONFIG_HOME", ".config"), baseFolder("XDG_STATE_HOME", ".local/state")};
}

void RecentFiles::read() {
  if (file_.empty()) return;
  const auto text = readFile(file_);
  if (!text) return;
  std::istringstream lines(*text);
  std::error_code error;
  for (std::string line; std::getline(lines, line) && paths_.size() < kMostRecent;) {
    if (!line.empty() && fs::is_regular_file(line, error)) paths_.emplace_back(line);
  }
}

void RecentFiles::add(const fs::path& scene) {
  std::error_code error;
  const fs::path absolute = fs::absolute(scene, error).lexically_normal();
  std::erase(paths_, absolute);
  paths_.insert(paths_.begin(), absolute);
  paths_.resize(std::min(paths_.size(), kMostRecent));
  isBehind_ = !file_.empty();
}

std::string RecentFiles::text() const {
  std::string text;
  for (const fs::path& path : paths_) text += path.string() + "\n";
  return text;
}

void RecentFiles::update() {
  (void)job_.take();
  if (!isBehind_ || job_.isBusy()) return;
  isBehind_ = false;
  job_.start([file = file_, text = text()](const StopFlag&) { return writeUserFile(file, text); });
}

RecentFiles::~RecentFiles() {
  job_.wait();
  if (isBehind_) (void)writeUserFile(file_, text());
}

}  // namespace lightvane
