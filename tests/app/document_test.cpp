#include "app/document.h"

#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;

/// So many triangles with a corner in common.
std::string fanObj(int triangles) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i <= triangles; ++i) text += fmt::format("v {} {} 1\n", i, i % 7);
  for (int i = 0; i < triangles; ++i) text += fmt::format("f 1 {} {}\n", i + 2, i + 3);
  return text;
}

template <class Condition>
bool becomesTrue(const Condition& condition) {
  for (int i = 0; i < 30'000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

// Every stage that is begun is told, and the stages after reading take as long as that: an abandoned thread
// that went on would be seen in them.
TEST(DocumentLoader, TheThreadOfWhatIsCancelledEndsWithinItsStage) {
  const TemporaryFolder folder;
  const auto large = folder.write("large.obj", fanObj(200'000));
  std::atomic<int> ended = 0;
  DocumentLoader loader([&] { ++ended; });
  loader.load(large);
  ASSERT_TRUE(becomesTrue([&] { return loader.progress().fraction > 0.1; }));
  EXPECT_EQ(loader.progress().stage, "reading large.obj");
  loader.cancel();
  EXPECT_TRUE(loader.loading().empty());
  ASSERT_TRUE(becomesTrue([&] { return ended == 1; }));
  EXPECT_EQ(loader.progress().stage, "reading large.obj");
  EXPECT_LT(loader.progress().fraction, 0.9);
  EXPECT_FALSE(loader.take());
}

TEST(DocumentLoader, AnotherFileTakesThePlaceOfTheOneThatIsRead) {
  const TemporaryFolder folder;
  const auto large = folder.write("large.obj", fanObj(200'000));
  DocumentLoader loader({});
  loader.load(large);
  ASSERT_TRUE(becomesTrue([&] { return loader.progress().fraction > 0.1; }));
  loader.load(shippedScene("cornell"));
  std::optional<Expected<Document>> loaded;
  ASSERT_TRUE(becomesTrue([&] { return (loaded = loader.take()).has_value(); }));
  ASSERT_TRUE(*loaded) << loaded->error().message();
  EXPECT_EQ((*loaded)->path, shippedScene("cornell"));
}

TEST(Document, AStopIsNoFault) {
  StopFlag stop = true;
  LoadProgress progress;
  FlagWatch watch(stop, progress);
  const auto loaded = loadDocument(shippedScene("cornell"), watch);
  ASSERT_FALSE(loaded);
  EXPECT_TRUE(loaded.error().isStop);
  const auto whole = loadDocument(shippedScene("cornell"));
  ASSERT_TRUE(whole);
  const auto again = recompiled(*whole, whole->energy, watch);
  ASSERT_FALSE(again);
  EXPECT_TRUE(again.error().isStop);
}

}  // namespace
}  // namespace lightvane
