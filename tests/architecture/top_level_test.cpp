#include <cstdio>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

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
  std::FILE* git = popen("git -C '" LIGHTVANE_SOURCE_DIR "' -c safe.directory='*' ls-files 2>/dev/null", "r");
  ASSERT_NE(git, nullptr);
  std::set<std::string> names;
  std::string path;
  for (int c = std::fgetc(git); c != EOF; c = std::fgetc(git)) {
    if (c != '\n') {
      path += static_cast<char>(c);
      continue;
    }
    if (path.front() != '.') names.insert(path.substr(0, path.find('/')));
    path.clear();
  }
  if (WEXITSTATUS(pclose(git)) != 0)
    GTEST_SKIP() << "not a git work tree: nothing tells what belongs to the project";
  EXPECT_THAT(kTopLevel, testing::IsSupersetOf(names));
  EXPECT_TRUE(names.contains("CMakeLists.txt") && names.contains("core")) << "git lists another tree";
}

}  // namespace
