// Vectors that are taken out of the cache, computed anew, and pinned.

#include "core/inspect/record_edit.h"

#include <chrono>
#include <ctime>
#include <thread>

#include <gtest/gtest.h>

#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

using namespace render_test;
using inspect_test::renderFrame;
using inspect_test::renderShipped;

TEST(WithoutRecords, TakesOutTheseAndNoOthers) {
  const Stage stage(shippedScene("cornell-mirror.toml", 32, 32));
  const RenderContext context = stage.context(parametersWith({{"dlv.mode", "always"}, {"dlv.seed", "40"}}));
  const std::unique_ptr<Renderer> renderer = makeRenderer(context);
  finish(*renderer);
  const RenderFrame frame = makeFrame(context, *renderer);
  const std::vector<RecordRef> gone = {{kNone, 0}, {kNone, 7}, {0, 3}};
  const auto rest = withoutRecords(frame, gone);
  ASSERT_TRUE(rest);
  ASSERT_EQ(rest->indirect.size() + 2, frame.snapshot->indirect.size());
  EXPECT_EQ(rest->directCount() + 1, frame.snapshot->directCount());
  std::size_t number = 0;
  for (std::size_t i = 0; i < frame.snapshot->indirect.size(); ++i) {
    if (i == 0 || i == 7) continue;
    EXPECT_EQ(rest->indirect[number++].birth.identity, frame.snapshot->indirect[i].birth.identity);
  }
  // Each is found again where it is valid.
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < rest->indirect.size(); ++i) {
    const VectorPoint& point = rest->indirect[i].point;
    rest->indirect.query(point.key, point.position, 0.0f, found);
    EXPECT_TRUE(std::find(found.begin(), found.end(), i) != found.end()) << i;
  }
}

TEST(WithoutRecords, ALockedPictureDoesWithoutThem) {
  const Stage stage(shippedScene("cornell.toml", 32, 32));
  const RenderContext context = stage.context({});
  const std::unique_ptr<Renderer> renderer = makeRenderer(context);
  finish(*renderer);
  const RenderFrame frame = makeFrame(context, *renderer);
  std::vector<RecordRef> all;
  for (std::uint32_t i = 0; i < frame.snapshot->indirect.size(); ++i) all.push_back({kNone, i});
  const CacheInput none{withoutRecords(frame, all), true};
  const std::unique_ptr<Renderer> locked = makeRenderer(context, none);
  finish(*locked);
  EXPECT_EQ(mean(locked->film().indirect), 0.0);
  EXPECT_GT(locked->statistics().unanswered, 0U);
}

/// With vectors of both kinds.
RenderFrame frameWithBoth() {
  return renderShipped("cornell-glossy.toml", 32, {{"dlv.mode", "always"}, {"dlv.seed", "40"}});
}

std::shared_ptr<const Snapshot> recompute(const RenderFrame& frame, std::span<const RecordRef> records,
                                          int threads = 2) {
  TaskPool pool(threads);
  const StopFlag never{false};
  return recomputed(frame, records, pool, never);
}

TEST(Recomputed, TheseHaveOtherNumbersAndAllElseStays) {
  const RenderFrame frame = frameWithBoth();
  const std::vector<RecordRef> chosen = {{kNone, 5}, {0, 3}, {kNone, 5}, {kNone, 1000000}};
  const auto anew = recompute(frame, chosen);
  ASSERT_TRUE(anew);
  ASSERT_EQ(anew->indirect.size(), frame.snapshot->indirect.size());
  ASSERT_EQ(anew->direct[0].size(), frame.snapshot->direct[0].size());
  for (std::size_t i = 0; i < anew->indirect.size(); ++i) {
    const IndirectLightVector& before = frame.snapshot->indirect[i];
    const IndirectLightVector& after = anew->indirect[i];
    EXPECT_EQ(placeKey(after), placeKey(before));
    EXPECT_EQ(after.birth.pass, before.birth.pass);
    EXPECT_EQ(after.birth.order, before.birth.order);
    EXPECT_EQ(after.birth.pixel, before.birth.pixel);
    EXPECT_EQ(after.energy != before.energy, i == 5) << i;
    EXPECT_EQ(after.birth.identity == before.birth.identity, i != 5) << i;
  }
  for (std::size_t i = 0; i < anew->direct[0].size(); ++i) {
    const DirectLightVector& before = frame.snapshot->direct[0][i];
    EXPECT_EQ(anew->direct[0][i].birth.identity == before.birth.identity, i != 3) << i;
  }
  // Its light is what it was, but for noise.
  const float before = paperBrightness(frame.snapshot->indirect[5].irradiance);
  EXPECT_NEAR(paperBrightness(anew->indirect[5].irradiance), before, 0.3f * before);
}

TEST(Recomputed, IsTheSameForAnyThreadsAndOtherEachTime) {
  RenderFrame frame = frameWithBoth();
  const std::vector<RecordRef> chosen = {{kNone, 2}, {kNone, 3}, {kNone, 9}, {0, 1}};
  const auto once = recompute(frame, chosen, 1);
  const auto again = recompute(frame, chosen, 3);
  for (const std::uint32_t number : {2U, 3U, 9U})
    EXPECT_EQ(once->indirect[number].energy, again->indirect[number].energy);
  EXPECT_EQ(once->direct[0][1].energy, again->direct[0][1].energy);
  frame.snapshot = once;
  const auto twice = recompute(frame, chosen, 2);
  EXPECT_NE(twice->indirect[2].energy, once->indirect[2].energy);
  EXPECT_NE(twice->indirect[2].birth.identity, once->indirect[2].birth.identity);
}

TEST(Recomputed, HoldsForTheLightsOfTheFrame) {
  const RenderFrame frame = renderShipped("cornell.toml", 24, {}, -1, {{}, {Rgb(0.0f)}});
  const std::vector<RecordRef> chosen = {{kNone, 4}};
  EXPECT_EQ(recompute(frame, chosen)->indirect[4].irradiance, Rgb(0.0f));
}

// A point whose own vector was computed anew is answered by that: nobody computes it once more.
TEST(Recomputed, StandsForTheVectorThatItReplaces) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  const RenderFrame frame = renderFrame(stage, {});
  std::vector<RecordRef> all;
  for (std::uint32_t i = 0; i < frame.snapshot->indirect.size(); ++i) all.push_back({kNone, i});
  const CacheInput same{frame.snapshot, false};
  const CacheInput anew{recompute(frame, all), false};
  // Radii differ by their noise, and a few points with them.
  const auto before = renderFrame(stage, {}, -1, same).statistics.fullIndirect;
  const auto after = renderFrame(stage, {}, -1, anew).statistics.fullIndirect;
  EXPECT_LE(after, before + all.size() / 5);
}

TEST(Recomputed, EndsSoonAndWithNothingWhereItIsStopped) {
  const RenderFrame frame = renderShipped("cornell.toml", 48, {{"ilv.rows", "60"}, {"ilv.columns", "120"}});
  std::vector<RecordRef> all;
  for (std::uint32_t i = 0; i < frame.snapshot->indirect.size(); ++i) all.push_back({kNone, i});
  TaskPool pool(2);
  StopFlag stop{true};
  EXPECT_FALSE(recomputed(frame, all, pool, stop));
  stop = false;
  std::shared_ptr<const Snapshot> result;
  std::thread work([&] { result = recomputed(frame, all, pool, stop); });
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const auto start = std::chrono::steady_clock::now();
  stop = true;
  work.join();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  if (isFast()) {
    EXPECT_FALSE(result) << "20 ms are too few for all";
  }
  EXPECT_LT(took.count(), isFast() ? 0.5 : 5.0);
}

bool isPinned(const std::shared_ptr<const PinnedVectors>& pinned, const RenderFrame& frame,
              const RecordRef& record) {
  return arePinned(pinned.get(), frame, {&record, 1});
}

TEST(Pinned, AreAddedFoundAndLetGo) {
  const RenderFrame frame = frameWithBoth();
  const std::vector<RecordRef> first = {{kNone, 1}, {0, 2}};
  const std::vector<RecordRef> second = {{kNone, 1}, {kNone, 7}};
  std::shared_ptr<const PinnedVectors> pinned = pin(nullptr, frame, first);
  ASSERT_TRUE(pinned);
  EXPECT_EQ(pinned->count(), 2U);
  pinned = pin(pinned, frame, second);
  EXPECT_EQ(pinned->count(), 3U) << "twice pinned is pinned once";
  EXPECT_TRUE(isPinned(pinned, frame, {kNone, 7}));
  EXPECT_TRUE(isPinned(pinned, frame, {0, 2}));
  EXPECT_FALSE(isPinned(pinned, frame, {0, 1}));
  EXPECT_FALSE(isPinned(nullptr, frame, {kNone, 7}));
  EXPECT_TRUE(arePinned(pinned.get(), frame, second));
  EXPECT_FALSE(arePinned(pinned.get(), frame, std::vector<RecordRef>{{kNone, 7}, {0, 1}}));
  EXPECT_FALSE(arePinned(pinned.get(), frame, {}));
  EXPECT_EQ(pinnedRecords(pinned.get(), frame), (std::vector<RecordRef>{{kNone, 1}, {kNone, 7}, {0, 2}}));
  pinned = unpin(pinned, frame, first);
  ASSERT_TRUE(pinned);
  EXPECT_EQ(pinnedRecords(pinned.get(), frame), (std::vector<RecordRef>{{kNone, 7}}));
  EXPECT_FALSE(unpin(pinned, frame, second));
  const std::vector<RecordRef> none = {{kNone, 1000000}};
  EXPECT_EQ(pin(pinned, frame, none), pinned);
}

TEST(Pinned, AThousandAreAskedAboutInAMoment) {
  // The window asks in each of its frames.
  RenderFrame frame = frameWithBoth();
  std::vector<IndirectLightVector> many(4'000, frame.snapshot->indirect[0]);
  for (std::size_t i = 0; i < many.size(); ++i) many[i].point.position.x += 1e-4f * static_cast<float>(i);
  Snapshot crowded = *frame.snapshot;
  crowded.indirect = RecordSet<IndirectLightVector>().with(std::move(many), [](const auto&) { return 0.1f; });
  frame.snapshot = std::make_shared<const Snapshot>(std::move(crowded));
  std::vector<RecordRef> all;
  for (std::uint32_t number = 0; number < frame.snapshot->indirect.size(); ++number)
    all.push_back({kNone, number});

  const std::clock_t start = std::clock();
  const auto pinned = pin(nullptr, frame, all);
  EXPECT_TRUE(arePinned(pinned.get(), frame, all));
  EXPECT_EQ(pinnedRecords(pinned.get(), frame).size(), all.size());
  const auto kept =
      withPinned(withoutRecords(frame, all), pinned.get(), frame.scene, frame.parameters.vectors);
  EXPECT_EQ(kept->indirect.size(), all.size());
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  // Pair by pair they took a second.
  EXPECT_LT(seconds, isFast() ? 0.25 : 5.0);
}

TEST(Pinned, TheNewestOfAPlaceIsPinned) {
  RenderFrame frame = frameWithBoth();
  const std::vector<RecordRef> one = {{kNone, 4}};
  const auto before = pin(nullptr, frame, one);
  frame.snapshot = recompute(frame, one);
  EXPECT_TRUE(isPinned(before, frame, one[0]));
  const auto after = pin(before, frame, one);
  ASSERT_EQ(after->vectors.indirect.size(), 1U);
  EXPECT_EQ(after->vectors.indirect[0].energy, frame.snapshot->indirect[4].energy);
}

TEST(Pinned, ArePutBackWhereTheyLackAndOnlyThere) {
  const RenderFrame frame = frameWithBoth();
  const std::vector<RecordRef> chosen = {{kNone, 1}, {kNone, 8}, {0, 2}};
  const auto pinned = pin(nullptr, frame, chosen);
  const VectorParameters& vectors = frame.parameters.vectors;
  EXPECT_EQ(withPinned(frame.snapshot, pinned.get(), frame.scene, vectors), frame.snapshot);
  EXPECT_EQ(withPinned(frame.snapshot, nullptr, frame.scene, vectors), frame.snapshot);
  const std::vector<RecordRef> gone = {{kNone, 1}, {kNone, 2}};
  const auto rest = withPinned(withoutRecords(frame, gone), pinned.get(), frame.scene, vectors);
  ASSERT_EQ(rest->indirect.size() + 1, frame.snapshot->indirect.size());
  const IndirectLightVector& back = rest->indirect[rest->indirect.size() - 1];
  EXPECT_EQ(back.birth.identity, frame.snapshot->indirect[1].birth.identity);
  std::vector<std::uint32_t> found;
  rest->indirect.query(back.point.key, back.point.position, 0.0f, found);
  EXPECT_TRUE(std::find(found.begin(), found.end(), rest->indirect.size() - 1) != found.end());
  const auto alone = withPinned(nullptr, pinned.get(), frame.scene, vectors);
  EXPECT_EQ(alone->indirect.size(), 2U);
  EXPECT_EQ(alone->directCount(), 1U);
  // As something else they would be misread.
  VectorParameters other = vectors;
  other.ilv.store = VectorStore::Vector;
  EXPECT_EQ(withPinned(nullptr, pinned.get(), frame.scene, other)->indirect.size(), 0U);
  EXPECT_FALSE(withPinned(nullptr, pinned.get(), frameWithBoth().scene, vectors)) << "another scene";
}

}  // namespace
}  // namespace lightvane
