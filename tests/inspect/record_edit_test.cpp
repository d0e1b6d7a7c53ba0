// Vectors that are taken out of the cache.

#include "core/inspect/record_edit.h"

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane {
namespace {

using namespace render_test;

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

}  // namespace
}  // namespace lightvane
