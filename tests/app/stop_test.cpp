// Stopping, and going on: by signals, limits and --passes, for every method.

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

Words endless(const std::string& output, const Words& more = {}) {
  Words words = {
      "render", shippedScene("cornell"), "-o", output, "--size", "8x8", "--method", "path", "--spp",
      "9999999"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Signals : public testing::TestWithParam<int> {};

TEST_P(Signals, StopAtTheLastWholePassWhichPassesMakesAgain) {
  Program program;
  program.start(endless("a.exr", {"--stats", "a.json"}));
  ASSERT_TRUE(program.waitForError("pass 2"));
  const auto asked = std::chrono::steady_clock::now();
  program.signal(GetParam());
  const Outcome outcome = program.finish();
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - asked;
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  // 50 ms to stop, then files are written; with room for sanitizers on a busy machine.
  EXPECT_LT(waited.count(), 10.0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("the same command with --resume goes on from here"));
  EXPECT_THAT(program.files(), ElementsAre("a.exr", "a.exr.resume", "a.json"));
  const auto stats = nlohmann::json::parse(program.read("a.json"));
  EXPECT_EQ(stats["stopped_early"], true);

  const auto picture = readImage(program.path("a.exr"));
  ASSERT_TRUE(picture) << picture.error().message();
  const std::string passes = picture->metadata.at("passes");
  EXPECT_EQ(picture->metadata.at("complete"), "false");
  EXPECT_THAT(outcome.err, HasSubstr("which --passes " + passes + " makes again"));
  EXPECT_EQ(program.run(endless("b.exr", {"--passes", passes})).exitCode, 0);
  EXPECT_EQ(program.read("b.exr"), program.read("a.exr"));
}

INSTANTIATE_TEST_SUITE_P(Stop, Signals, testing::Values(SIGINT, SIGTERM, SIGHUP));

// Not under the thread sanitizer, which holds signals back until the program calls the system.
#ifndef __SANITIZE_THREAD__
TEST(Stop, ASecondSignalEndsAtOnceAndWritesNothing) {
  Program program;
  program.start(endless("a.exr"));
  ASSERT_TRUE(program.waitForError("pass 2"));
  // Both wait for the process to go on, and come before its next instruction.
  program.signal(SIGSTOP);
  program.signal(SIGINT);
  program.signal(SIGTERM);
  program.signal(SIGCONT);
  EXPECT_EQ(program.finish().exitCode, 130);
  EXPECT_THAT(program.files(), testing::IsEmpty());
}
#endif

/// A scene that the program waits for: a pipe, written to once the program reads it.
class SlowScene {
 public:
  SlowScene(const Program& program, const std::string& name) : path_(program.path(name)) {
    EXPECT_EQ(mkfifo(path_.c_str(), 0600), 0);
  }
  ~SlowScene() { finish(""); }
  SlowScene(const SlowScene&) = delete;
  SlowScene& operator=(const SlowScene&) = delete;

  /// Waits until the program has opened it.
  bool isOpened() {
    for (int i = 0; i < 30'000 && writing_ < 0; ++i) {
      writing_ = open(path_.c_str(), O_WRONLY | O_NONBLOCK);
      if (writing_ < 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return writing_ >= 0;
  }
  void finish(const std::string& text) {
    if (writing_ < 0) return;
    // A program that looked before it read has closed it.
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    const ssize_t written = write(writing_, text.data(), text.size());
    EXPECT_TRUE(written == static_cast<ssize_t>(text.size()) || errno == EPIPE) << written;
    std::signal(SIGPIPE, before);
    close(std::exchange(writing_, -1));
  }

 private:
  std::filesystem::path path_;
  int writing_ = -1;
};

class StopWhileLoading : public testing::TestWithParam<Words> {};

TEST_P(StopWhileLoading, EndsWithALineAndNothingWritten) {
  for (const int number : {SIGINT, SIGTERM}) {
    Program program;
    SlowScene scene(program, "slow.toml");
    program.start(GetParam());
    ASSERT_TRUE(scene.isOpened());
    program.signal(number);
    // A whole scene, which would be rendered.
    std::ifstream shipped(shippedScene("cornell"));
    scene.finish(std::string(std::istreambuf_iterator<char>(shipped), {}));
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const bool isQuiet = GetParam().back() == "--quiet";
    EXPECT_EQ(outcome.err,
              isQuiet ? "" : "lightvane: stopped while the scene was loaded: nothing is written\n");
    EXPECT_THAT(program.files(), ElementsAre("slow.toml"));
  }
}

INSTANTIATE_TEST_SUITE_P(Stop, StopWhileLoading,
                         testing::Values(Words{"render", "slow.toml", "-o", "a.png", "--size", "8x8"},
                                         Words{"render", "slow.toml", "-o", "a.png", "--quiet"},
                                         Words{"scene", "slow.toml"},
                                         Words{"scene", "slow.toml", "--as-toml"}));

TEST(Stop, TimeLimitEndsAfterAtLeastOnePass) {
  Program program;
  const Outcome outcome = program.run(endless("a.exr", {"--time-limit", "0.001"}));
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_THAT(program.files(), ElementsAre("a.exr", "a.exr.resume"));
  EXPECT_GE(std::stoi(readImage(program.path("a.exr"))->metadata.at("passes")), 1);
}

TEST(Stop, TimeLimitDoesNotOutliveTheRendering) {
  Program program;
  const auto start = std::chrono::steady_clock::now();
  const Outcome outcome = program.run({"render", shippedScene("cornell"), "-o", "a.exr", "--size", "8x8",
                                       "--preset", "draft", "--time-limit", "1h"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 60.0);
  EXPECT_THAT(program.files(), ElementsAre("a.exr"));
}

/// Words that choose a method, and how many passes to stop after.
struct StoppedMethod {
  const char* name;
  Words words;
  const char* passes;
};

class Resume : public testing::TestWithParam<StoppedMethod> {
 protected:
  Words words(const std::string& output, const Words& more = {}) const {
    Words all = {"render", shippedScene("cornell-mirror"), "-o", output, "--size", "20x20"};
    all.insert(all.end(), GetParam().words.begin(), GetParam().words.end());
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  Program program_;
};

TEST_P(Resume, ComesToTheBytesOfNoStop) {
  ASSERT_EQ(program_.run(words("whole.exr")).exitCode, 0);
  ASSERT_EQ(program_.run(words("a.exr", {"--passes", GetParam().passes})).exitCode, 0);
  EXPECT_TRUE(program_.exists("a.exr.resume"));
  EXPECT_NE(program_.read("a.exr"), program_.read("whole.exr"));
  const Outcome resumed = program_.run(words("a.exr", {"--resume"}));
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("going on from a.exr.resume"));
  EXPECT_EQ(program_.read("a.exr"), program_.read("whole.exr"));
  EXPECT_FALSE(program_.exists("a.exr.resume"));
}

INSTANTIATE_TEST_SUITE_P(Stop, Resume,
                         testing::Values(StoppedMethod{"vectors", {"--preset", "draft"}, "3"},
                                         StoppedMethod{"path", {"--method", "path", "--spp", "40"}, "2"},
                                         StoppedMethod{
                                             "naive", {"--method", "naive", "--set", "naive.samples=4"}, "3"},
                                         StoppedMethod{"direct", {"--method", "direct"}, "2"}),
                         [](const auto& method) { return method.param.name; });

TEST(Stop, ASignalLosesNothing) {
  Program program;
  const Words words = {
      "render", shippedScene("cornell"), "-o", "a.exr", "--size", "8x8", "--method", "path", "--spp", "4000"};
  Words whole = words;
  whole[3] = "whole.exr";
  ASSERT_EQ(program.run(whole).exitCode, 0);
  program.start(words);
  ASSERT_TRUE(program.waitForError("pass 2"));
  program.signal(SIGINT);
  ASSERT_EQ(program.finish().exitCode, 130);
  Words again = words;
  again.emplace_back("--resume");
  EXPECT_EQ(program.run(again).exitCode, 0);
  EXPECT_EQ(program.read("a.exr"), program.read("whole.exr"));
}

TEST(Stop, ResumeStartsAfreshWithoutACheckpointAndSaysSo) {
  Program program;
  const Outcome outcome = program.run(
      {"render", shippedScene("cornell"), "-o", "a.exr", "--size", "8x8", "--preset", "draft", "--resume"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, HasSubstr("a.exr.resume is not there: rendering from the start"));
}

TEST(Stop, ResumeRefusesWhatBelongsToSomethingElse) {
  Program program;
  const Words words = {"render", shippedScene("cornell"), "-o", "a.exr", "--method", "path", "--size", "8x8"};
  const auto with = [&](const Words& more) {
    Words all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  // After 1, 1, 2, 4, 8 and 16 paths a pixel.
  ASSERT_EQ(program.run(with({"--spp", "64", "--passes", "6"})).exitCode, 0);
  const std::string before = program.read("a.exr.resume");
  for (const Words& more : {Words{"--spp", "64", "--seed", "2"}, Words{"--spp", "64", "--crop", "0,0,4,4"},
                            Words{"--spp", "32"}, Words{"--spp", "64", "--passes", "6"}}) {
    Words all = with(more);
    all.emplace_back("--resume");
    const Outcome outcome = program.run(all);
    EXPECT_EQ(outcome.exitCode, 2) << more[2] << outcome.err;
    EXPECT_THAT(outcome.err, testing::StartsWith("lightvane: error: a.exr.resume: "));
  }
  program.write("a.exr.resume", before.substr(0, before.size() / 2));
  EXPECT_EQ(program.run(with({"--spp", "64", "--resume"})).exitCode, 2) << "cut short";
  program.write("a.exr.resume", before);
  // Only how long it goes on may differ.
  EXPECT_EQ(program.run(with({"--spp", "48", "--resume"})).exitCode, 0);
  ASSERT_EQ(program
                .run({"render", shippedScene("cornell"), "-o", "b.exr", "--method", "path", "--size", "8x8",
                      "--spp", "48"})
                .exitCode,
            0);
  EXPECT_EQ(program.read("a.exr"), program.read("b.exr"));
}

TEST(Stop, ThePrintedRulesLeaveNothingToGoOnFrom) {
  Program program;
  const Words words = {"render", shippedScene("cornell"), "-o", "a.exr", "--size", "8x8", "--preset", "draft",
                       "--set",  "method.rules=printed"};
  Words stopped = words;
  stopped.insert(stopped.end(), {"--passes", "1"});
  const Outcome outcome = program.run(stopped);
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_THAT(outcome.err, HasSubstr("it can only begin anew"));
  EXPECT_THAT(program.files(), ElementsAre("a.exr"));
  Words warm = words;
  warm.insert(warm.end(), {"--cache", "room.lvcache"});
  EXPECT_THAT(program.run(warm).err, HasSubstr("--cache: the rules `printed` begin with an empty cache"));
}

TEST(Stop, ACheckpointThatIsNotAskedForIsMentionedAndKept) {
  Program program;
  const Words words = {"render", shippedScene("cornell"), "-o", "a.exr", "--size", "8x8", "--preset",
                       "draft"};
  Words stopped = words;
  stopped.insert(stopped.end(), {"--passes", "2"});
  ASSERT_EQ(program.run(stopped).exitCode, 0);
  const Outcome outcome = program.run(words);
  EXPECT_THAT(outcome.err, HasSubstr("a.exr.resume is not used: --resume would go on from it"));
  EXPECT_TRUE(program.exists("a.exr.resume"));
}

}  // namespace
}  // namespace lightvane
