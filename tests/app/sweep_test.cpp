// `lightvane sweep`, as a user runs it.

#include <csignal>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class SweepCommand : public testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome = program_.run(
        {"reference", shippedScene("cornell"), "-o", "truth.exr", "--size", "16x16", "--spp", "256", "-q"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  }
  static std::vector<std::string> words(const std::vector<std::string>& more) {
    std::vector<std::string> all = {"sweep",       shippedScene("cornell"),
                                    "--reference", "truth.exr",
                                    "-o",          "trade",
                                    "--size",      "16x16",
                                    "--preset",    "draft"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  json sweep() const { return json::parse(program_.read("trade/sweep.json")); }
  std::vector<std::string> linesOf(const std::string& file) const {
    std::vector<std::string> lines;
    std::string text = program_.read(file);
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      lines.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    return lines;
  }
  std::string errorOf(const std::vector<std::string>& all) {
    const Outcome outcome = program_.run(all);
    EXPECT_EQ(outcome.exitCode, 2);
    return outcome.err;
  }

  Program program_;
};

const std::vector<std::string> kVaried = {"--vary", "ilv.n_min=2,8", "--vary", "ilv.radius_scale=0.3:0.9:2"};

TEST_F(SweepCommand, MeasuresEveryPointAndItsRivals) {
  std::vector<std::string> all = words(kVaried);
  all.insert(all.end(), {"--seeds", "2", "--rivals", "direct,path"});
  const Outcome outcome = program_.run(all);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("No point is both faster and nearer to the reference"));
  EXPECT_THAT(outcome.err, HasSubstr("18 of 18: path.samples=256, seed 2"));
  const json done = sweep();
  ASSERT_EQ(done["points"].size(), 4U + 1U + 4U);
  for (const json& point : done["points"]) {
    ASSERT_EQ(point["runs"].size(), 2U);
    EXPECT_EQ(point["runs"][0]["seed"], 1);
    EXPECT_EQ(point["runs"][1]["seed"], 2);
    for (const json& run : point["runs"]) {
      EXPECT_GT(run["cpu_seconds"].get<double>(), 0.0);
      EXPECT_GT(run["rays"]["shadow"].get<int>(), 0);
      EXPECT_EQ(run["ilv_records"].get<int>() > 0, point["method"] == "vectors");
      for (const char* metric : {"beauty.relative", "direct.bias", "indirect.flip"})
        EXPECT_TRUE(run["metrics"].contains(metric)) << metric;
    }
    EXPECT_TRUE(readImage(program_.path("trade/" + point["picture"].get<std::string>())));
    EXPECT_TRUE(readImage(program_.path("trade/" + point["error_map"].get<std::string>())));
  }
  EXPECT_EQ(done["points"][1]["settings"], (json{{"ilv.n_min", "2"}, {"ilv.radius_scale", "0.9"}}));
  EXPECT_GT(done["reference_noise"].get<double>(), 0.0);
  const std::vector<std::string> csv = linesOf("trade/runs.csv");
  EXPECT_EQ(csv.size(), 1U + 18U);
  EXPECT_THAT(csv[0],
              testing::StartsWith("method,ilv.n_min,ilv.radius_scale,path.samples,seed,cpu_seconds,"));
  EXPECT_THAT(program_.read("trade/index.html"), HasSubstr("ilv.radius_scale"));

  // The command that a point names renders its very picture.
  const json& point = done["points"][3];
  const std::string command = point["command"];
  EXPECT_THAT(command, testing::AllOf(HasSubstr("ilv.n_min=8"), HasSubstr("ilv.radius_scale=0.9")));
  ASSERT_EQ(program_
                .run({"render", shippedScene("cornell"), "-o", "again.png", "--size", "16x16", "--preset",
                      "draft", "--set", "ilv.n_min=8", "--set", "ilv.radius_scale=0.9", "-q"})
                .exitCode,
            0);
  EXPECT_EQ(readImage(program_.path("again.png"))->rgb(),
            readImage(program_.path("trade/" + point["picture"].get<std::string>()))->rgb());
}

TEST_F(SweepCommand, ComputesNothingTwice) {
  const auto run = [this](std::vector<std::string> more) {
    more.insert(more.end(), {"--rivals", "none"});
    const Outcome outcome = program_.run(words(more));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.err;
  };
  run({"--vary", "ilv.n_min=2,4"});
  const std::string before = program_.read("trade/runs.jsonl");
  EXPECT_THAT(run({"--vary", "ilv.n_min=2,4"}), Not(HasSubstr(" of 2: ")));
  EXPECT_EQ(program_.read("trade/runs.jsonl"), before);
  // A larger sweep takes over what it has in common with the smaller.
  const std::string err = run({"--vary", "ilv.n_min=2,3,4"});
  EXPECT_THAT(err, HasSubstr("2 of 3: ilv.n_min=3"));
  EXPECT_THAT(err, Not(HasSubstr("1 of 3")));
  EXPECT_THAT(program_.read("trade/runs.jsonl"), testing::StartsWith(before));
  EXPECT_EQ(sweep()["points"].size(), 3U);
  // Another reference makes other runs.
  ASSERT_EQ(program_
                .run({"reference", shippedScene("cornell"), "-o", "truth.exr", "--size", "16x16", "--spp",
                      "300", "-q"})
                .exitCode,
            0);
  EXPECT_THAT(run({"--vary", "ilv.n_min=2,4"}), HasSubstr("1 of 2: ilv.n_min=2"));
}

// Whatever a crash leaves of the last line, the runs before it count, and the one that was cut is done again.
// What is not varied is in no picture's name, but in its place.
TEST_F(SweepCommand, KeepsThePicturesOfSweepsThatDifferApart) {
  const auto run = [this](std::vector<std::string> more) {
    more.insert(more.end(), {"--rivals", "none", "--vary", "ilv.n_min=2,2"});
    EXPECT_EQ(program_.run(words(more)).exitCode, 0);
    const json points = sweep()["points"];
    EXPECT_EQ(points.size(), 1U) << "a value that is said twice";
    return points[0]["picture"].get<std::string>();
  };
  const std::string first = run({});
  const std::string bytes = program_.read("trade/" + first);
  const std::string second = run({"--light", "light=0.1"});
  EXPECT_NE(first, second);
  EXPECT_EQ(run({}), first);
  EXPECT_EQ(program_.read("trade/" + first), bytes);
  EXPECT_THAT(program_.read("trade/index.html"), HasSubstr("src=\"data:image/png;base64,"));
  // One that was removed is missed, and no broken link.
  std::filesystem::remove(program_.path("trade/" + first));
  run({});
  EXPECT_THAT(program_.read("trade/index.html"), HasSubstr("picture: none"));
}

TEST_F(SweepCommand, WarnsOfAReferenceThatIsNoTruth) {
  const auto warningsOf = [this](const std::string& reference, const std::vector<std::string>& more) {
    std::vector<std::string> all = words(more);
    all.insert(all.end(), {"--rivals", "none", "--vary", "ilv.n_min=4", "-q"});
    std::ranges::replace(all, std::string("truth.exr"), reference);
    return program_.run(all).err;
  };
  EXPECT_EQ(warningsOf("truth.exr", {}), "");
  EXPECT_THAT(warningsOf("truth.exr", {"--light", "light=2"}), HasSubstr("has lights of other brightness"));
  EXPECT_THAT(warningsOf("truth.exr", {"--fov-y", "20"}), HasSubstr("is seen by another camera"));
  EXPECT_THAT(warningsOf("truth.exr", {"--set", "film.samples=4"}),
              HasSubstr("was not rendered with the sweep's film.samples=4"));
  ASSERT_EQ(
      program_.run({"render", shippedScene("cornell"), "-o", "own.exr", "--size", "16x16", "-q"}).exitCode,
      0);
  EXPECT_THAT(warningsOf("own.exr", {}), HasSubstr("was not path traced"));
}

TEST_F(SweepCommand, GoesOnFromAListThatWasCut) {
  const std::vector<std::string> all = words({"--vary", "ilv.n_min=2,4", "--rivals", "none"});
  ASSERT_EQ(program_.run(all).exitCode, 0);
  const std::vector<std::string> lines = linesOf("trade/runs.jsonl");
  ASSERT_EQ(lines.size(), 2U);
  for (const std::size_t length :
       {std::size_t{0}, std::size_t{1}, lines[1].size() / 2, lines[1].size() - 1}) {
    program_.write("trade/runs.jsonl", lines[0] + "\n" + lines[1].substr(0, length));
    const Outcome outcome = program_.run(all);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("2 of 2: ilv.n_min=4"));
    EXPECT_THAT(outcome.err, Not(HasSubstr("1 of 2")));
    EXPECT_EQ(sweep()["points"].size(), 2U);
    EXPECT_THAT(program_.run(all).err, Not(HasSubstr("2 of 2"))) << "what was added is a line of its own";
  }
}

// Killed at any moment: each time it is nearer to its end, and no line is there twice.
TEST_F(SweepCommand, SurvivesBeingKilled) {
  const std::vector<std::string> all =
      words({"--vary", "ilv.n_min=1:12:12", "--vary", "ilv.n_max=12,16", "--rivals", "none"});
  for (int kills = 0; kills < 6; ++kills) {
    program_.start(all);
    std::this_thread::sleep_for(std::chrono::milliseconds(40 + 35 * kills));
    program_.signal(SIGKILL);
    program_.finish();
  }
  const Outcome outcome = program_.run(all);
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(sweep()["points"].size(), 24U);
  std::set<std::string> keys;
  std::size_t runs = 0;
  for (const std::string& line : linesOf("trade/runs.jsonl")) {
    const json run = json::parse(line, nullptr, false);
    if (run.is_discarded()) continue;  // cut
    ++runs;
    keys.insert(run["key"].get<std::string>());
  }
  EXPECT_EQ(runs, 24U);
  EXPECT_EQ(keys.size(), runs);
}

TEST_F(SweepCommand, EndsWithWhatIsDone) {
  program_.start(words({"--vary", "ilv.n_min=1:12:12", "--seeds", "100"}));
  ASSERT_TRUE(program_.waitForError("5 of "));
  program_.signal(SIGINT);
  const Outcome outcome = program_.finish();
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("stopped: "));
  EXPECT_GE(sweep()["points"].size(), 4U);
  const Outcome limited =
      program_.run(words({"--vary", "ilv.n_min=1:12:12", "--seeds", "100", "--time-limit", "0.2"}));
  EXPECT_EQ(limited.exitCode, 0);
  EXPECT_THAT(limited.err, HasSubstr("the same command goes on from here"));
}

TEST_F(SweepCommand, VariesOneAtATimeOrSome) {
  std::vector<std::string> around = words(kVaried);
  around.insert(around.end(), {"--around", "--rivals", "none", "-q"});
  ASSERT_EQ(program_.run(around).exitCode, 0);
  EXPECT_EQ(sweep()["points"].size(), 5U);
  EXPECT_EQ(sweep()["points"][0]["settings"], json::object());
  std::vector<std::string> random = words(kVaried);
  random.insert(random.end(), {"--random", "3", "--rivals", "none", "-q"});
  ASSERT_EQ(program_.run(random).exitCode, 0);
  EXPECT_EQ(sweep()["points"].size(), 3U);
}

TEST_F(SweepCommand, DrawsBySeed) {
  const auto drawnBy = [this](const std::string& seed) {
    const Outcome outcome = program_.run(
        words({"--vary", "ilv.n_min=1:12:12", "--random", "4", "--rivals", "none", "-q", "--seed", seed}));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const json done = sweep();
    std::vector<json> drawn;
    for (const json& point : done["points"]) drawn.push_back(point["settings"]);
    return drawn;
  };
  const std::vector<json> first = drawnBy("1");
  EXPECT_EQ(first.size(), 4U);
  EXPECT_NE(drawnBy("2"), first);
  EXPECT_EQ(drawnBy("1"), first);
}

TEST_F(SweepCommand, SaysWhatIsWrongBeforeItBegins) {
  EXPECT_THAT(errorOf({"sweep", "a.toml"}), HasSubstr("there is no reference"));
  EXPECT_THAT(errorOf(words({})), HasSubstr("nothing is varied"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_mim=1,2"})), HasSubstr("did you mean ilv.n_min?"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=0,2"})), HasSubstr("ilv.n_min takes a value"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min"})), HasSubstr("expected KEY=A,B,C or KEY=LOW:HIGH:N"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2", "--vary", "ilv.n_min=3"})),
              HasSubstr("varied twice"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2", "--rivals", "photon"})),
              HasSubstr("--rivals: expected"));
  EXPECT_THAT(errorOf({"sweep", shippedScene("cornell"), "--vary", "ilv.n_min=1,2", "--size", "8x8", "-o",
                       "trade", "--reference", "truth.exr"}),
              HasSubstr("truth.exr has 16x16 pixels, the picture 8x8"));
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2", "--set", "seed=2", "--without", "sky"})),
              HasSubstr("expected edges or lights"));
  program_.write("trade", "a file");
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2"})), HasSubstr("trade: is no folder"));
}

TEST_F(SweepCommand, LeavesAForeignListAlone) {
  std::filesystem::create_directories(program_.path("trade"));
  program_.write("trade/runs.jsonl", "my notes\n");
  EXPECT_THAT(errorOf(words({"--vary", "ilv.n_min=1,2"})),
              HasSubstr("runs.jsonl: is no list of a sweep's runs"));
  EXPECT_EQ(program_.read("trade/runs.jsonl"), "my notes\n");
}

}  // namespace
}  // namespace lightvane
