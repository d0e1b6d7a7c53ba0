#include "app/panels/path_completion.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "core/base/file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

bool endsInOneOf(const std::string& name, std::span<const std::string_view> endings) {
  return std::find(endings.begin(), endings.end(), fileEnding(name)) != endings.end();
}

std::string commonBeginning(const std::vector<std::string>& words) {
  std::string common = words.front();
  for (const std::string& word : words) {
    const auto ends = std::mismatch(common.begin(), common.end(), word.begin(), word.end());
    common.erase(ends.first, common.end());
  }
  return common;
}

}  // namespace

std::string withoutTilde(const std::string& path) {
  const char* home = std::getenv("HOME");
  return home != nullptr && path.starts_with("~/") ? std::string(home) + path.substr(1) : path;
}

PathCompletion completePath(const std::string& typed, std::span<const std::string_view> endings,
                            std::size_t limit) {
  PathCompletion completion;
  completion.common = typed;
  const std::size_t slash = typed.rfind('/');
  const std::string folder = slash == std::string::npos ? std::string() : typed.substr(0, slash + 1);
  const std::string beginning = typed.substr(folder.size());

  // Folders that cannot be read, or are none, have nothing to offer: no error while one types.
  std::error_code error;
  completion.isFile = fs::is_regular_file(withoutTilde(typed), error);
  const fs::path real(folder.empty() ? "." : withoutTilde(folder));
  std::vector<std::string> folders;
  std::vector<std::string> files;
  for (fs::directory_iterator entry(real, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(beginning) || (name.front() == '.' && !beginning.starts_with('.'))) continue;
    std::error_code unreadable;
    if (entry->is_directory(unreadable)) {
      folders.push_back(folder + name + "/");
    } else if (endsInOneOf(name, endings)) {
      files.push_back(folder + name);
    }
  }
  std::sort(folders.begin(), folders.end());
  std::sort(files.begin(), files.end());
  folders.insert(folders.end(), files.begin(), files.end());
  if (!folders.empty()) completion.common = commonBeginning(folders);
  if (folders.size() > limit) folders.resize(limit);
  completion.paths = std::move(folders);
  return completion;
}

}  // namespace lightvane
