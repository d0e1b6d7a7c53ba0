#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <link.h>

namespace {

/// The shared libraries of this program, which is linked with every library of core: theirs, and those that
/// they need in turn.
std::vector<std::string> loadedLibraries() {
  std::vector<std::string> names;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* list) {
        const std::string_view path = info->dlpi_name;
        static_cast<std::vector<std::string>*>(list)->emplace_back(path.substr(path.rfind('/') + 1));
        return 0;
      },
      &names);
  return names;
}

TEST(LinkedLibraries, CoreBringsNoGraphicsOrWindowLibrary) {
  const std::vector<std::string> libraries = loadedLibraries();
  ASSERT_THAT(libraries, testing::Contains(testing::StartsWith("libfmt.")))
      << "core's own are not in the list";
  for (const char* windowed : {"libGL", "libEGL", "libOpenGL", "libepoxy", "libOSMesa", "libglfw", "libimgui",
                               "libX11", "libwayland", "libSDL"}) {
    EXPECT_THAT(libraries, testing::Not(testing::Contains(testing::StartsWith(windowed))));
  }
}

}  // namespace
