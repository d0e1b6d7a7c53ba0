// `lightvane sweep --study`, as a user runs it.

#include <csignal>
#include <set>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/shipped_files.h"
#include "core/image/image_file.h"
#include "core/measure/corrections.h"
#include "core/measure/preset_study.h"
#include "core/measure/rival_study.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class StudyCommand : public testing::Test {
 protected:
  static std::vector<std::string> words(const std::vector<std::string>& more) {
    // As small as pictures can be that need vectors at all.
    std::vector<std::string> all = {
        "sweep", "--study", "corrections", shippedScene("cornell"), "--size", "8x8",  "--preset", "draft",
        "--spp", "16",      "--set",       "light.samples=1",       "-o",     "study"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  json sweep() const { return json::parse(program_.read("study/cornell/sweep.json")); }
  std::string errorOf(const std::vector<std::string>& all) {
    const Outcome outcome = program_.run(all);
    EXPECT_EQ(outcome.exitCode, 2);
    return outcome.err;
  }

  Program program_;
};

TEST_F(StudyCommand, MeasuresEveryCorrection) {
  const Outcome outcome = program_.run(words({"--seeds", "2", "--markdown"}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::size_t count = studyPoints(false).size();
  // Of coarse and fine settings the first seed only.
  const std::size_t runs = count + count / 3;
  EXPECT_THAT(outcome.err, HasSubstr("cornell: half 2 of the reference, 16 paths a pixel"));
  EXPECT_THAT(outcome.err, HasSubstr(std::to_string(runs) + " renderings in study"));
  EXPECT_THAT(outcome.err, HasSubstr("light.mirrored alone, seed 2, about "));
  EXPECT_THAT(outcome.out, testing::StartsWith("## The corrections\n"));
  EXPECT_THAT(outcome.out, HasSubstr("| cornell | 8x8 | all |"));
  EXPECT_THAT(outcome.out, HasSubstr("| `ilv.weight` | printed | edge |"));

  const json done = sweep();
  ASSERT_EQ(done["points"].size(), count);
  EXPECT_GT(done["reference_noise"].get<double>(), 0.0);
  EXPECT_GT(done["layer_noise"]["indirect"].get<double>(), 0.0);
  std::set<std::string> labels;
  for (const json& point : done["points"]) {
    labels.insert(point["label"].get<std::string>());
    const bool isUsual = point["label"].get<std::string>().find(',') == std::string::npos;
    ASSERT_EQ(point["runs"].size(), isUsual ? 2U : 1U) << point["label"];
    EXPECT_GT(point["runs"][0]["cpu_seconds"].get<double>(), 0.0);
    EXPECT_TRUE(point["runs"][0]["metrics"].contains("indirect.relmse"));
  }
  EXPECT_EQ(labels.size(), count);
  const auto settingsOf = [&](const std::string& label) {
    for (const json& point : done["points"]) {
      if (point["label"] == label) return point["settings"];
    }
    return json();
  };
  // What the table of a point says is what it was rendered with: the draft's cells, two thirds as many rows.
  EXPECT_EQ(settingsOf("all, coarse")["ilv.rows"], "5");
  EXPECT_EQ(settingsOf("all")["ilv.rows"], "8");
  EXPECT_EQ(settingsOf("all")["ilv.weight"], "edge");
  EXPECT_EQ(settingsOf("without ilv.weight")["ilv.weight"], "printed");
  EXPECT_EQ(settingsOf("ilv.weight alone")["ilv.weight"], "edge");
  EXPECT_EQ(settingsOf("ilv.weight alone")["ilv.gradient"], "printed");
  EXPECT_THAT(program_.read("study/cornell/runs.csv"), testing::StartsWith("point,method,ilv.rows,"));
  EXPECT_THAT(program_.read("study/cornell/index.html"), HasSubstr("without ilv.weight, fine"));

  // All is done: the same command prints the same tables, and renders nothing.
  const std::string before = program_.read("study/cornell/runs.jsonl");
  const Outcome again = program_.run(words({"--seeds", "2", "--markdown"}));
  EXPECT_EQ(again.out, outcome.out);
  EXPECT_EQ(program_.read("study/cornell/runs.jsonl"), before);
  EXPECT_THAT(again.err, testing::AllOf(Not(HasSubstr("half 1")), Not(HasSubstr(", seed "))));
}

// Killed at any moment, while references are traced too: in the end every run is there once.
TEST_F(StudyCommand, SurvivesBeingKilled) {
  for (int kills = 0; kills < 6; ++kills) {
    program_.start(words({}));
    std::this_thread::sleep_for(std::chrono::milliseconds(60 + 60 * kills));
    program_.signal(SIGKILL);
    program_.finish();
  }
  const Outcome outcome = program_.run(words({}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(sweep()["points"].size(), studyPoints(false).size());
  std::set<std::string> keys;
  std::size_t runs = 0;
  const std::string text = program_.read("study/cornell/runs.jsonl");
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const json run = json::parse(text.substr(begin, end - begin), nullptr, false);
    begin = end + 1;
    if (run.is_discarded()) continue;  // cut
    ++runs;
    keys.insert(run["key"].get<std::string>());
  }
  EXPECT_EQ(runs, studyPoints(false).size());
  EXPECT_EQ(keys.size(), runs);
}

TEST_F(StudyCommand, EndsWithWhatIsDone) {
  program_.start(words({"--seeds", "50"}));
  ASSERT_TRUE(program_.waitForError("5 of "));
  program_.signal(SIGINT);
  const Outcome outcome = program_.finish();
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the same command goes on from here"));
  EXPECT_THAT(outcome.out, HasSubstr("Each correction taken back"));
  EXPECT_GE(sweep()["points"].size(), 4U);
  const Outcome limited = program_.run(words({"--seeds", "50", "--time-limit", "0.2"}));
  EXPECT_EQ(limited.exitCode, 0) << limited.err;
  EXPECT_THAT(limited.err, HasSubstr("the same command goes on from here"));
}

// A reference that was stopped leaves a part of itself, which is none; the command goes on with it.
TEST_F(StudyCommand, GoesOnWithAReferenceThatWasStopped) {
  std::vector<std::string> all = words({"--time-limit", "0.3"});
  *std::find(all.begin(), all.end(), "16") = "100000";
  ASSERT_EQ(program_.run(all).exitCode, 0);
  ASSERT_TRUE(program_.exists("study/references/cornell.exr.resume"));
  const auto part = readImage(program_.path("study/references/cornell.exr"));
  ASSERT_TRUE(part);
  EXPECT_EQ(part->metadata.at("complete"), "false");
  const Outcome again = program_.run(all);
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("half 1 of the reference"));
  EXPECT_FALSE(program_.exists("study/cornell/runs.jsonl"));
}

// The shape of a picture is the camera's: 640 x 480 in 16 x 16 pixels is 16 x 12.
TEST_F(StudyCommand, KeepsTheShapeOfPicturesAndTakesReferencesFromAFolder) {
  const Outcome outcome =
      program_.run({"sweep", "--study", "corrections", shippedScene("yard"), "--size", "16x16", "--spp", "2",
                    "--reference", "truth", "-o", "study", "--time-limit", "0.5", "-q"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const auto half = readImage(program_.path("truth/yard-2.exr"));
  ASSERT_TRUE(half);
  EXPECT_EQ(half->width, 16);
  EXPECT_EQ(half->height, 12);
  EXPECT_FALSE(program_.exists("study/references"));
  EXPECT_THAT(errorOf({"sweep", "--study", "corrections", shippedScene("yard"), "--size", "8x8",
                       "--reference", "truth", "-o", "study"}),
              HasSubstr("truth/yard.exr has 16x12 pixels, the picture 8x6"));
}

TEST_F(StudyCommand, SaysWhatIsWrongBeforeItBegins) {
  EXPECT_THAT(errorOf({"sweep", "--study", "correction", "-o", "study"}),
              HasSubstr("--study: expected corrections, rivals, presets or lights, found 'correction'"));
  EXPECT_THAT(errorOf({"sweep", "--study", "corrections"}), HasSubstr("no folder is given"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2"})),
              HasSubstr("--study: has points of its own, and --vary asks for others"));
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--around"}, {"--random", "3"}, {"--rivals", "path"}})
    EXPECT_THAT(errorOf(words(more)), HasSubstr("and " + more.front() + " asks for others"));
  EXPECT_THAT(errorOf(words({"--from", "1,2,3"})), HasSubstr("sees each scene by its first camera"));
  EXPECT_THAT(errorOf(words({"--set", "ilv.weight=edge"})),
              HasSubstr("--set ilv.weight=edge: sets ilv.weight, and so does --study corrections"));
  EXPECT_THAT(errorOf(words({"--set", "method.rules=paper"})), HasSubstr("asks for method.rules=paper"));
  EXPECT_THAT(errorOf(words({shippedScene("cornell")})), HasSubstr("is called cornell, too"));
  EXPECT_THAT(errorOf(words({"missing.toml"})), HasSubstr("missing.toml: no such file"));
  EXPECT_THAT(errorOf({"sweep", "--study", "corrections", "--spp", "0", "-o", "study"}),
              HasSubstr("--spp: expected a whole number"));
  EXPECT_THAT(errorOf({"sweep", shippedScene("cornell"), "--spp", "4", "-o", "study"}),
              HasSubstr("--spp: is of a study (--study corrections)"));
  EXPECT_THAT(errorOf({"sweep", shippedScene("cornell"), "--markdown", "-o", "study"}),
              HasSubstr("--markdown: is of a study"));
  EXPECT_THAT(errorOf({"sweep", "a.toml", "b.toml", "--vary", "ilv.n_min=1,2"}),
              HasSubstr("unexpected word 'b.toml'"));
  program_.write("study", "a file");
  EXPECT_THAT(errorOf(words({})), HasSubstr("study: is no folder"));
}

class RivalStudyCommand : public StudyCommand {
 protected:
  static std::vector<std::string> rivalWords(const std::vector<std::string>& more) {
    std::vector<std::string> all = {
        "sweep",     "--study", "rivals", shippedScene("cornell"), "--size", "8x8",
        "--spp",     "16",      "--set",  "light.samples=2",       "-o",     "study",
        "--markdown"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(RivalStudyCommand, MeasuresEveryMethod) {
  const Outcome outcome = program_.run(rivalWords({}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const json done = sweep();
  ASSERT_EQ(done["points"].size(), rivalPoints().size());
  for (const json& point : done["points"]) {
    EXPECT_EQ(point["runs"].size(), 4U) << "as many seeds without --seeds: " << point["label"];
    EXPECT_TRUE(point["runs"][0]["metrics"].contains("indirect.relmse")) << point["label"];
    const std::string command = point["command"];
    // Presets say otherwise.
    EXPECT_THAT(command, HasSubstr("light.samples=2"));
  }
  EXPECT_THAT(outcome.out, testing::StartsWith("## Speed-up at equal error\n"));
  EXPECT_THAT(outcome.out, HasSubstr("| cornell | balanced |"));
  EXPECT_THAT(outcome.out, HasSubstr("| *the paper* | 18 | 5 |"));
  EXPECT_THAT(outcome.out, HasSubstr("| direct, ambient term |"));
}

TEST_F(RivalStudyCommand, SaysWhatIsWrongBeforeItBegins) {
  EXPECT_THAT(errorOf(rivalWords({"--preset", "fine"})),
              HasSubstr("--preset: sets preset, and so does --study rivals"));
  EXPECT_THAT(errorOf(rivalWords({"--set", "naive.samples=4"})),
              HasSubstr("--set naive.samples=4: sets naive.samples, and so does --study rivals"));
}

class PresetStudyCommand : public StudyCommand {
 protected:
  static std::vector<std::string> presetWords(const std::string& scene,
                                              const std::vector<std::string>& more) {
    std::vector<std::string> all = {"sweep", "--study", "presets", scene,   "--size",    "8x8",
                                    "--spp", "4096",    "-o",      "study", "--markdown"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

TEST_F(PresetStudyCommand, MeasuresEveryCandidate) {
  const Outcome outcome = program_.run(presetWords(shippedScene("cornell"), {}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const json done = sweep();
  ASSERT_EQ(done["points"].size(), presetCandidates().size());
  for (const json& point : done["points"])
    EXPECT_EQ(point["runs"].size(), 3U) << "as many seeds without --seeds: " << point["label"];
  EXPECT_THAT(outcome.out, testing::StartsWith("## What the rule picks\n"));
  EXPECT_THAT(outcome.out, HasSubstr("| balanced | " + shippedCandidate(Preset::Balanced).label() + " |"));
  EXPECT_THAT(outcome.out, HasSubstr("## The candidates\n"));
}

// A preset is told nothing of what a scene sets, so that candidates do not differ in it.
TEST_F(PresetStudyCommand, LeavesWhatTheSceneSets) {
  program_.write("cornell.toml",
                 program_.read(shippedScene("cornell")) + "\n[render]\nilv.rows = 3\nilv.columns = 6\n");
  ASSERT_EQ(program_.run(presetWords("cornell.toml", {"--seeds", "1"})).exitCode, 0);
  const json done = sweep();
  for (const json& point : done["points"]) {
    const std::string command = point["command"];
    EXPECT_THAT(command, HasSubstr("ilv.rows=3"));
    EXPECT_THAT(command, HasSubstr("ilv.columns=6"));
  }
}

TEST_F(PresetStudyCommand, SaysWhatIsWrongBeforeItBegins) {
  EXPECT_THAT(errorOf(presetWords(shippedScene("cornell"), {"--set", "method.rules=paper"})),
              HasSubstr("measures what presets set under the refined rules, and cornell asks for "
                        "method.rules=paper"));
  EXPECT_THAT(errorOf(presetWords(shippedScene("cornell"), {"--set", "ilv.n_min=3"})),
              HasSubstr("--set ilv.n_min=3: sets ilv.n_min, and so does --study presets"));
}

class LightStudyCommand : public StudyCommand {
 protected:
  static std::vector<std::string> lightWords(const std::vector<std::string>& more) {
    std::vector<std::string> all = {
        "sweep", "--study", "lights", shippedScene("yard"), "--size", "16x16", "--spp", "64", "-o", "study"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

// A sun and a sky, each by itself, and the yard without any light.
TEST_F(LightStudyCommand, MeasuresEachLightByItself) {
  const Outcome outcome = program_.run(lightWords({"--seeds", "2", "--markdown"}));
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("half 2 of study/references/yard-2-sky.exr, 64 shadow rays a point"));
  EXPECT_THAT(outcome.out, testing::StartsWith("## Whether DLVs pay, light by light\n"));
  EXPECT_THAT(outcome.out, HasSubstr("| yard | sun | directional | 1 |"));
  EXPECT_THAT(outcome.out, HasSubstr("| yard | sky | environment | 512 |"));
  EXPECT_THAT(outcome.out, HasSubstr("## Whether DLVs pay, by shadow rays\n"));
  const json dark = json::parse(program_.read("study/yard/no-light/sweep.json"));
  ASSERT_EQ(dark["points"].size(), 1U);
  EXPECT_EQ(dark["points"][0]["runs"][0]["rays"]["shadow"], 0);
  for (const auto& [folder, light, other] : {std::tuple("1-sun", 0, "sky"), {"2-sky", 1, "sun"}}) {
    const json done = json::parse(program_.read(std::string("study/yard/") + folder + "/sweep.json"));
    ASSERT_EQ(done["points"].size(), 16U) << folder;
    EXPECT_GT(done["layer_noise"]["direct"].get<double>(), 0.0);
    for (const json& point : done["points"]) {
      EXPECT_EQ(point["runs"].size(), 2U);
      EXPECT_TRUE(point["runs"][0]["metrics"].contains("direct.relmse"));
      EXPECT_THAT(point["command"].get<std::string>(), HasSubstr(std::string("--light=") + other + "=0"));
      const bool isNever = point["label"].get<std::string>().starts_with("never");
      EXPECT_EQ(point["runs"][0]["dlv_records"] == 0, isNever) << point["label"] << " of light " << light;
    }
  }
  // All is done: the same command prints the same tables.
  const Outcome again = program_.run(lightWords({"--seeds", "2", "--markdown"}));
  EXPECT_EQ(again.out, outcome.out);
  EXPECT_THAT(again.err, testing::AllOf(Not(HasSubstr("half 1")), Not(HasSubstr(", seed "))));
}

TEST_F(LightStudyCommand, SaysWhatItCannotDoBeforeItBegins) {
  EXPECT_THAT(errorOf(lightWords({"--set", "dlv.mode=always"})),
              HasSubstr("--set dlv.mode=always: sets dlv.mode, and so does --study lights"));
  std::vector<std::string> all = lightWords({});
  *std::find(all.begin(), all.end(), "64") = "5000";
  EXPECT_THAT(errorOf(all), testing::AllOf(HasSubstr("--spp"), HasSubstr("4096")));
  EXPECT_FALSE(program_.exists("study"));
}

TEST(ShippedScenes, AreThoseOfTheSourceTree) {
  const std::vector<std::filesystem::path> scenes = shippedScenes();
  EXPECT_GE(scenes.size(), 10U);
  EXPECT_THAT(scenes, testing::Contains(std::filesystem::path(shippedScene("two-rooms"))));
}

}  // namespace
}  // namespace lightvane
