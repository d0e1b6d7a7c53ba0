#include "core/base/load_watch.h"

#include <chrono>
#include <fstream>
#include <istream>
#include <iterator>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "core/base/file.h"
#include "core/base/watched_text.h"
#include "tests/support/counting_watch.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

using test::CountingWatch;
using testing::ElementsAre;

TEST(LoadWatch, LooksForTheFirstOfManyPieces) {
  CountingWatch watch;
  for (std::size_t i = 0; i < 10'000; ++i) watch.piece(i);
  EXPECT_EQ(watch.looks(), 10U);
  EXPECT_THAT(watch.told(), testing::IsEmpty()) << "no stage has begun, and no fraction is known";
}

TEST(LoadWatch, StopsAtTheNextLook) {
  CountingWatch watch(2);
  watch.look();
  watch.look(0.5);
  EXPECT_THROW(watch.look(), LoadStopped);
  EXPECT_THROW(watch.piece(0, 7), LoadStopped) << "once stopped, always stopped";
}

TEST(LoadWatch, AStageGoesOnAfterTheOneWithinIt) {
  CountingWatch watch;
  {
    const LoadStage outer(watch, "room");
    watch.part(0.0, 0.5);
    watch.look(0.5);
    {
      const LoadStage inner(watch, "rock");
      watch.look(1.0);
    }
    watch.look(1.0);
    watch.part(0.5, 1.0);
    watch.look(0.5);
  }
  std::vector<std::string> told;
  for (const auto& [stage, fraction] : watch.told()) told.push_back(progressText({stage, fraction}));
  EXPECT_THAT(told, ElementsAre("room", "room, 25 %", "rock", "rock, 100 %", "room, 25 %", "room, 50 %",
                                "room, 75 %"));
}

TEST(LoadWatch, FractionsNeverFallAndSmallStepsAreNotTold) {
  CountingWatch watch;
  const LoadStage stage(watch, "room");
  for (const double fraction : {0.5, 0.2, 0.5004, 0.6, 7.0}) watch.look(fraction);
  std::vector<double> told;
  for (const auto& each : watch.told()) {
    if (each.fraction) told.push_back(*each.fraction);
  }
  EXPECT_THAT(told, ElementsAre(0.5, 0.6, 1.0));
}

TEST(LoadWatch, AFlagStopsAndAnotherThreadReads) {
  StopFlag stop = false;
  LoadProgress progress;
  FlagWatch watch(stop, progress);
  const auto result = untilStopped([&]() -> Expected<int> {
    const LoadStage stage(watch, "room");
    watch.look(0.25);
    std::thread([&] {
      EXPECT_EQ(progressText(progress.state()), "room, 25 %");
      stop = true;
    }).join();
    watch.look();
    return 1;
  });
  ASSERT_FALSE(result);
  EXPECT_TRUE(result.error().isStop);
  EXPECT_FALSE(makeError("a", "is wrong").value().isStop) << "a fault is none";
}

TEST(LoadWatch, NoneNeverStops) {
  LoadWatch& watch = LoadWatch::none();
  const LoadStage stage(watch, "room");
  for (std::size_t i = 0; i < 5000; ++i) watch.piece(i, 5000);
  EXPECT_FALSE(watch.isStopped());
}

TEST(WatchedText, GivesItsTextAndEndsEarlyWhereItIsStopped) {
  std::string text(100'000, 'a');
  text[50'000] = 'b';
  CountingWatch whole;
  WatchedText watched(text, whole);
  std::istream stream(&watched);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), text);
  EXPECT_GE(whole.looks(), 6U);

  CountingWatch stopped(3);
  WatchedText cut(text, stopped);
  std::istream early(&cut);
  const std::string begun(std::istreambuf_iterator<char>(early), {});
  EXPECT_LT(begun.size(), text.size());
  EXPECT_TRUE(text.starts_with(begun));
}

TEST(WatchedText, CanBeReadAgainFromAPlace) {
  const std::string text = "0123456789";
  WatchedText watched(text, LoadWatch::none());
  std::istream stream(&watched);
  char read[4] = {};
  stream.read(read, 3);
  EXPECT_EQ(stream.tellg(), 3);
  stream.seekg(-2, std::ios::end);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "89");
  stream.clear();
  stream.seekg(4);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "456789");
  EXPECT_EQ(watched.pubseekoff(-1, std::ios::beg), -1);
  EXPECT_EQ(watched.pubseekpos(11), -1);
}

TEST(ReadFile, CanBeStopped) {
  const TemporaryFolder folder;
  const std::string content = std::string(3'000'000, 'x') + "end";
  const auto path = folder.write("a", content);
  CountingWatch whole;
  const auto read = readFile(path, whole);
  ASSERT_TRUE(read);
  EXPECT_TRUE(*read == content);
  ASSERT_GE(whole.looks(), 3U);
  for (std::size_t n = 0; n < whole.looks(); ++n) {
    CountingWatch watch(n);
    EXPECT_THROW((void)readFile(path, watch), LoadStopped) << n;
    EXPECT_EQ(watch.looks(), n + 1);
  }
}

TEST(ReadFile, ReadsAPipeToItsEnd) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  std::thread writer([&folder] {
    std::ofstream out(folder / "pipe");
    for (const char* part : {"one, ", "two, ", "three"}) {
      out << part << std::flush;
      std::this_thread::sleep_for(std::chrono::milliseconds(30));
    }
  });
  EXPECT_EQ(readFile(folder / "pipe").value(), "one, two, three");
  writer.join();
}

TEST(ReadFile, StopsWhereAPipeBringsNothing) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  CountingWatch watch(3);
  EXPECT_THROW(static_cast<void>(readFile(folder / "pipe", watch)), LoadStopped);
}

TEST(ReadFile, RefusesWhatHasNoEnd) {
  EXPECT_EQ(readFile("/dev/zero").error().message(), "/dev/zero: is not a regular file");
}

}  // namespace
}  // namespace lightvane
