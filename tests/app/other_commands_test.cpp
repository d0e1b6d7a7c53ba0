// `lightvane scene`, `lightvane parameters`, --help and --version as a user runs them, and the pages of docs
// that they keep honest.

#include <regex>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/settings.h"
#include "app/studies.h"
#include "app/version.h"
#include "core/base/file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string document(const std::string& name) {
  return readFile(std::string(LIGHTVANE_SOURCE_DIR) + "/" + name).value();
}

std::string answerTo(const std::vector<std::string>& words) {
  Program program;
  const Outcome outcome = program.run(words);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(program.files(), testing::IsEmpty());
  return outcome.out;
}

std::set<std::string> longOptions(const std::string& text) {
  static const std::regex option("--[a-z][a-z-]*");
  std::set<std::string> options;
  for (std::sregex_iterator i(text.begin(), text.end(), option), end; i != end; ++i) options.insert(i->str());
  return options;
}

const std::vector<std::string> kRenderOptions = {
    "--output",     "--camera",     "--size",    "--crop",       "--method",      "--preset", "--set",
    "--spp",        "--seed",       "--threads", "--passes",     "--resume",      "--stats",  "--cache",
    "--lock-cache", "--save-cache", "--quiet",   "--time-limit", "--target-error"};

TEST(Help, NamesEveryCommandAndOption) {
  const std::string help = answerTo({"--help"});
  for (const char* word : {"render", "scene", "parameters", "--version", "Examples:"})
    EXPECT_THAT(help, HasSubstr(word));
  const std::string render = answerTo({"render", "--help"});
  for (const std::string& option : kRenderOptions)
    EXPECT_THAT(longOptions(render), testing::Contains(option));
  EXPECT_THAT(render, HasSubstr("Examples:"));
  EXPECT_THAT(answerTo({"scene", "--help"}), testing::AllOf(HasSubstr("--json"), HasSubstr("Examples:")));
  const std::string sweep = answerTo({"sweep", "--help"});
  for (const char* option : {"--vary", "--study", "--seeds", "--reference", "--spp", "--markdown"})
    EXPECT_THAT(longOptions(sweep), testing::Contains(option));
  for (const Study& study : studies()) EXPECT_THAT(sweep, HasSubstr(study.name));
  EXPECT_THAT(answerTo({"parameters", "--help"}),
              testing::AllOf(HasSubstr("--markdown"), HasSubstr("Examples:")));
}

TEST(Help, IsWhatTheReferenceSays) {
  const std::set<std::string> documented = longOptions(document("docs/lightvane.md"));
  std::set<std::string> helped;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                {"render", "--help"},
                                                {"scene", "--help"},
                                                {"parameters", "--help"},
                                                {"paper", "--help"},
                                                {"compare", "--help"},
                                                {"reference", "--help"},
                                                {"sweep", "--help"}}) {
    helped.merge(longOptions(answerTo(words)));
  }
  EXPECT_EQ(documented, helped);
}

TEST(Version, IsTheProjects) {
  EXPECT_EQ(answerTo({"--version"}), fmt::format("lightvane {}\n", versionText()));
  EXPECT_THAT(document("CMakeLists.txt"), HasSubstr(fmt::format("VERSION {} ", versionText())));
}

TEST(Parameters, ListEveryFieldWithDefaultRangeAndHelp) {
  const std::string text = answerTo({"parameters"});
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::size_t line = text.find(std::string("\n") + row.field.key + " ");
    ASSERT_NE(line, std::string::npos) << row.field.key;
    const std::string entry =
        text.substr(line + 1, text.find('\n', text.find('\n', line + 1) + 1) - line - 1);
    for (const std::string& part :
         {row.value, row.range, std::string(row.field.unit), std::string(row.field.paper),
          std::string(changeCostName(row.field.cost)), std::string(row.field.help)}) {
      EXPECT_THAT(entry, HasSubstr(part)) << row.field.key;
    }
  }
}

TEST(Parameters, AreChosenByKeyOrGroup) {
  const std::string one = answerTo({"parameters", "ilv.n_min"});
  EXPECT_THAT(one, HasSubstr("\nilv.n_min "));
  EXPECT_THAT(one, testing::Not(HasSubstr("ilv.n_min_last")));
  const std::string group = answerTo({"parameters", "dlv", "seed"});
  EXPECT_THAT(group, HasSubstr("\ndlv.n_max "));
  EXPECT_THAT(group, HasSubstr("\nseed "));
  EXPECT_THAT(group, testing::Not(HasSubstr("\nilv")));
  Program program;
  const Outcome outcome = program.run({"parameters", "ivl"});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.err, "lightvane: error: parameters: there is no parameter 'ivl' (did you mean ilv?)\n");
}

TEST(Parameters, DocumentIsWhatTheCommandWrites) {
  EXPECT_EQ(document("docs/parameters.md"), answerTo({"parameters", "--markdown"}))
      << "run: lightvane parameters --markdown > docs/parameters.md";
}

TEST(Scene, TellsWhatThereIs) {
  const std::string text = answerTo({"scene", shippedScene("cornell-mirror")});
  for (const char* part : {"Cornell box with a mirror block", "17 polygons (32 triangles)", "metre",
                           "mirrors: ", "with vectors: dlv.mode is always", "512x512", "for tracing rays"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(Scene, JsonHasTheNumbers) {
  const json scene = json::parse(answerTo({"scene", shippedScene("cornell-mirror"), "--json"}));
  EXPECT_EQ(scene["name"], "Cornell box with a mirror block");
  EXPECT_EQ(scene["units"], "metre");
  EXPECT_EQ(scene["shapes"], json({{"polygon", 17}}));
  EXPECT_EQ(scene["triangles"], 32);
  // The published box: 0.556 x 0.5488 x 0.5592 m.
  EXPECT_NEAR(scene["diagonal"], 0.9607, 1e-3);
  ASSERT_EQ(scene["lights"].size(), 1u);
  const json& light = scene["lights"][0];
  EXPECT_EQ(light["kind"], "area");
  EXPECT_EQ(light["vectors"], true);
  // pi A L: A = 0.13 m x 0.105 m, L = 0.2126 17 + 0.7152 12 + 0.0722 4 W m^-2 sr^-1.
  EXPECT_NEAR(light["watts"], 3.14159265 * 0.13 * 0.105 * 12.4854, 1e-4);
  EXPECT_EQ(scene["needs"]["specular"], true);
  EXPECT_EQ(scene["needs"]["glass"], false);
  EXPECT_EQ(scene["cameras"][0]["resolution"], json({512, 512}));
  EXPECT_GT(scene["memory_bytes"], 0);
  const json plain = json::parse(answerTo({"scene", shippedScene("cornell"), "--json"}));
  EXPECT_EQ(plain["lights"][0]["vectors"], false);
  EXPECT_EQ(plain["lights"][0]["shadow_rays"], 16);
  EXPECT_THAT(plain["lights"][0]["reason"].get<std::string>(), HasSubstr("16 shadow rays a point"));
}

TEST(Scene, PowerIsInWattsWhateverTheUnits) {
  Program program;
  const std::string shape =
      "[camera]\nposition = [0.0, 0.0, 200.0]\n[material.lamp]\nemission = [1.0, 1.0, 1.0]\n"
      "[[shape]]\ntype = \"disc\"\nmaterial = \"lamp\"\nradius = 100.0\nnormal = [0.0, 0.0, 1.0]\n";
  program.write("cm.toml", "version = 1\nunits = \"centimetre\"\n" + shape);
  const json scene = json::parse(program.run({"scene", "cm.toml", "--json"}).out);
  // pi A L with A = pi (1 m)^2.
  EXPECT_NEAR(scene["lights"][0]["watts"], 9.8696, 1e-3);
}

TEST(Scene, WarningsAndErrorsAreTold) {
  Program program;
  program.write(
      "caustic.toml",
      "version = 1\n[camera]\nposition = [0.0, 0.0, 3.0]\n[material.glass]\ntransmission = [1.0, 1.0, 1.0]\n"
      "[[shape]]\ntype = \"sphere\"\nmaterial = \"glass\"\n[[light]]\ntype = \"point\"\nname = \"bulb\"\n"
      "position = [2.0, 2.0, 2.0]\n");
  const Outcome outcome = program.run({"scene", "caustic.toml"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Warnings:"));
  EXPECT_THAT(outcome.out, HasSubstr("caustics"));
  EXPECT_THAT(outcome.out, testing::ContainsRegex("bulb +point +12.57 W"));  // 4 pi
  const Outcome missing = program.run({"scene", "missing.toml"});
  EXPECT_EQ(missing.exitCode, 2);
  EXPECT_EQ(missing.out, "");
  EXPECT_EQ(missing.err, "lightvane: error: missing.toml: no such file\n");
}

}  // namespace
}  // namespace lightvane
