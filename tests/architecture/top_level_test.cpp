#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/architecture/command.h"

namespace {

// Fixed (docs/architecture.md, Layout). Names with a dot in front are free: they are other tools' to choose.
const std::set<std::string> kTopLevel = {"CMakeLists.txt",
                                         "CMakePresets.json",
                                         "LICENSE",
                                         "README.md",
                                         "app",
                                         "assets",
                                         "check",
                                         "cmake",
                                         "core",
                                         "docs",
                                         "run",
                                         "shaders",
                                         "tests"};

TEST(TopLevel, HoldsOnlyWhatTheLayoutNames) {
  // What is committed, not what lies about: builds and pictures are nobody's business.
  // safe.directory: the tree may belong to another user than the one who tests.
  const CommandOutcome git =
      runCommand("git -C '" LIGHTVANE_SOURCE_DIR "' -c safe.directory='*' ls-files 2>/dev/null");
  std::set<std::string> names;
  std::istringstream paths(git.output);
  for (std::string path; std::getline(paths, path);) names.insert(path.substr(0, path.find('/')));
  if (!names.contains("CMakeLists.txt"))
    GTEST_SKIP() << "not a git work tree: nothing tells what belongs to it";
  std::erase_if(names,
                [](const std::string& name) { return name.front() == '.' || kTopLevel.contains(name); });
  EXPECT_THAT(names, testing::IsEmpty());
}

}  // namespace
