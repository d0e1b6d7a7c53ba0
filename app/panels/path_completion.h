#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lightvane {

/// What a path that is being typed could become.
struct PathCompletion {
  std::vector<std::string> paths;  ///< folders end in "/"; sorted, folders first
  std::string common;              ///< as far as all of them agree; what was typed where there is none
  bool isFile = false;             ///< what was typed names a file that is there
};

/// Looks up files with one of the endings, and folders, that begin with what was typed ("~/" is the home
/// folder). Hidden ones only where their dot was typed. At most `limit` of them.
PathCompletion completePath(const std::string& typed, std::span<const std::string_view> endings,
                            std::size_t limit = 200);

/// "~/x" with the home folder in place of "~".
std::string withoutTilde(const std::string& path);

}  // namespace lightvane
