// The arrows of docs/architecture.md, read off its table, against the #include lines of core and app.

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = LIGHTVANE_SOURCE_DIR;

/// Which places each place may include directly, by the names that the table gives them.
using Arrows = std::map<std::string, std::set<std::string>>;

/// The rows "| `place` | what lives there | `other place`, ... |" of a Markdown text.
Arrows parseArrows(const std::string& markdown) {
  static const std::regex row(R"(^\| `([a-z/]+)` \|.*\|([^|]*)\|\s*$)");
  static const std::regex quoted("`([a-z/]+)`");
  Arrows arrows;
  std::istringstream lines(markdown);
  for (std::string line; std::getline(lines, line);) {
    std::smatch cells;
    if (!std::regex_match(line, cells, row)) continue;
    std::set<std::string>& targets = arrows[cells[1]];
    const std::string last = cells[2];
    for (std::sregex_iterator i(last.begin(), last.end(), quoted), end; i != end; ++i)
      targets.insert((*i)[1]);
  }
  return arrows;
}

/// `place`, and all that it may include directly or by way of another. "core" stands for every folder in it.
std::set<std::string> reachable(const Arrows& arrows, const std::string& place) {
  std::set<std::string> reached;
  std::vector<std::string> open = {place};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    if (!reached.insert(next).second) continue;
    if (const auto found = arrows.find(next); found != arrows.end()) {
      open.insert(open.end(), found->second.begin(), found->second.end());
    }
    for (const auto& [other, targets] : arrows) {
      if (next == "core" && other.starts_with("core/")) open.push_back(other);
    }
  }
  return reached;
}

struct Include {
  std::string file;  ///< relative to the root
  int line;
  std::string header;
  bool quoted;  ///< "ours", not <theirs>

  std::string place() const { return fs::path(file).parent_path(); }
};

std::vector<Include> parseIncludes(const std::string& file, const std::string& source) {
  static const std::regex include(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)re");
  std::vector<Include> includes;
  std::istringstream lines(source);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch parts;
    if (std::regex_match(line, parts, include))
      includes.push_back({file, number, parts[2], parts[1] == "\""});
  }
  return includes;
}

/// Every #include of core and app.
std::vector<Include> allIncludes() {
  std::vector<Include> includes;
  for (const char* top : {"core", "app"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / top)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      const std::vector<Include> more =
          parseIncludes(entry.path().lexically_relative(kRoot), readFile(entry.path()).value());
      includes.insert(includes.end(), more.begin(), more.end());
    }
  }
  return includes;
}

std::vector<std::string> brokenArrows(const Arrows& arrows, const std::vector<Include>& includes) {
  std::vector<std::string> broken;
  for (const Include& include : includes) {
    if (!include.quoted) continue;
    const std::string target = fs::path(include.header).parent_path();
    const std::string where = fmt::format("{}:{}: \"{}\"", include.file, include.line, include.header);
    if (!arrows.contains(include.place())) {
      broken.push_back(fmt::format("{}: {} is not in the table", where, include.place()));
    } else if (!reachable(arrows, include.place()).contains(target)) {
      broken.push_back(fmt::format("{}: {} may include {}", where, include.place(),
                                   fmt::join(reachable(arrows, include.place()), ", ")));
    }
  }
  return broken;
}

/// A library that some places alone may include: its headers, as a regular expression, and these places.
struct Fence {
  const char* headers;
  std::set<std::string> places;
};

// docs/architecture.md, "Libraries and where they end".
const std::vector<Fence> kFences = {
    {"embree[0-9]*/.*", {"core/trace"}},
    {"(oneapi/)?tbb/.*", {"core/base"}},
    {"OpenEXR/.*|Imath/.*|Imf.*\\.h|png\\.h|libpng.*|jpeglib\\.h", {"core/image"}},
    {"toml\\+\\+/.*|toml\\.hpp|tiny_obj_loader\\.h", {"core/scene"}},
    {"CLI/.*", {"app"}},
    {"(GL|GLES[23]?|EGL|epoxy)/.*", {"app", "app/gl"}},
    {"GLFW/.*", {"app"}},
    {"imgui.*|imgui/.*", {"app", "app/gl", "app/panels"}},  // app/gl: its draw lists
};

std::vector<std::string> brokenFences(const std::vector<Include>& includes) {
  std::vector<std::string> broken;
  for (const Include& include : includes) {
    for (const Fence& fence : kFences) {
      if (!std::regex_match(include.header, std::regex(fence.headers))) continue;
      if (fence.places.contains(include.place())) continue;
      broken.push_back(fmt::format("{}:{}: <{}> belongs to {}", include.file, include.line, include.header,
                                   fmt::join(fence.places, ", ")));
    }
  }
  return broken;
}

/// The source files that do not begin with their own header, which would then be compiled alone nowhere.
std::vector<std::string> sourcesThatHideTheirHeader(const std::vector<Include>& includes) {
  std::vector<std::string> hiding;
  std::set<std::string> seen;
  for (const Include& include : includes) {
    const fs::path own = fs::path(include.file).replace_extension(".h");
    const bool isFirst = seen.insert(include.file).second;
    if (!isFirst || include.file == own || !fs::exists(kRoot / own)) continue;
    if (include.header != own)
      hiding.push_back(fmt::format("{}:{}: {}", include.file, include.line, include.header));
  }
  return hiding;
}

Arrows documentedArrows() { return parseArrows(readFile(kRoot / "docs/architecture.md").value()); }

TEST(Includes, EveryIncludeIsAnArrowOfTheTable) {
  EXPECT_THAT(brokenArrows(documentedArrows(), allIncludes()), testing::IsEmpty());
}

TEST(Includes, EverySourceBeginsWithItsOwnHeader) {
  EXPECT_THAT(sourcesThatHideTheirHeader(allIncludes()), testing::IsEmpty());
  const auto withInclude = [](const char* header) {
    return sourcesThatHideTheirHeader(
        parseIncludes("core/base/text.cpp", fmt::format("#include \"{}\"\n#include <set>\n", header)));
  };
  EXPECT_THAT(withInclude("core/base/text.h"), testing::IsEmpty());
  EXPECT_THAT(withInclude("core/base/file.h"), testing::SizeIs(1));
}

TEST(Includes, LibrariesStayWhereTheyBelong) { EXPECT_THAT(brokenFences(allIncludes()), testing::IsEmpty()); }

TEST(Includes, EveryPlaceIncludesFromTheRoot) {
  // "text.h" beside the file and "../base/text.h" would both escape the two tests above.
  for (const Include& include : allIncludes()) {
    if (!include.quoted) continue;
    EXPECT_TRUE(fs::is_regular_file(kRoot / include.header))
        << include.file << ":" << include.line << ": \"" << include.header
        << "\" is not a file under the root";
    EXPECT_THAT(include.header, testing::Not(testing::HasSubstr("..")))
        << include.file << ":" << include.line;
  }
}

TEST(Includes, NoArrowOfTheTableGoesBothWays) {
  const Arrows arrows = documentedArrows();
  for (const auto& [place, targets] : arrows) {
    for (const std::string& target : targets) {
      EXPECT_FALSE(reachable(arrows, target).contains(place)) << place << " and " << target;
    }
  }
}

// The tests above pass on an empty table and on files that were not found: the parts they are made of, on
// texts whose answer is known.

TEST(Includes, TheTableIsFoundInTheDocument) {
  const Arrows arrows = documentedArrows();
  EXPECT_EQ(arrows.at("core/base"), std::set<std::string>{});
  EXPECT_EQ(arrows.at("core/scene"), std::set<std::string>{"core/image"});
  EXPECT_THAT(reachable(arrows, "app"), testing::IsSupersetOf({"core/base", "core/scene", "core/io"}));
  EXPECT_THAT(allIncludes(), testing::Contains(testing::Field(&Include::header, "core/base/tasks.h")));
}

TEST(Includes, ArrowsReachAsFarAsTheyLead) {
  const Arrows arrows = parseArrows(
      "| place | what | may include |\n"
      "|---|---|---|\n"
      "| `core/low` | x | nothing of ours |\n"
      "| `core/mid` | `x` | `core/low` |\n"
      "| `core/side` | x | `core/low` |\n"
      "| `app` | x | `core` |\n");
  EXPECT_EQ(reachable(arrows, "core/low"), (std::set<std::string>{"core/low"}));
  EXPECT_EQ(reachable(arrows, "core/mid"), (std::set<std::string>{"core/low", "core/mid"}));
  EXPECT_EQ(reachable(arrows, "app"),
            (std::set<std::string>{"app", "core", "core/low", "core/mid", "core/side"}));

  const std::vector<Include> includes = parseIncludes("core/mid/a.cpp",
                                                      "#include <vector>\n"
                                                      "#include \"core/low/a.h\"\n"
                                                      "  #  include \"core/side/b.h\"  // not an arrow\n"
                                                      "#include <embree3/rtcore.h>\n");
  EXPECT_THAT(
      brokenArrows(arrows, includes),
      testing::ElementsAre("core/mid/a.cpp:3: \"core/side/b.h\": core/mid may include core/low, core/mid"));
  EXPECT_THAT(brokenFences(includes),
              testing::ElementsAre("core/mid/a.cpp:4: <embree3/rtcore.h> belongs to core/trace"));
}

}  // namespace
}  // namespace lightvane
