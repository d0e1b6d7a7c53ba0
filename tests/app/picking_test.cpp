#include "app/picking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/overlays.h"
#include "core/inspect/record_names.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

/// 32 x 32 pixels, each 10 of the screen wide, from (100, 50).
const Placement kPicture{100, 50, 320, 320, Vec2(0.0f), 10.0f};

const RenderFrame& roomFrame() {
  static const RenderFrame frame = inspect_test::renderShipped("cornell.toml", 32, {{"ilv.seed", "20"}});
  return frame;
}

Vec2 onScreen(const RenderFrame& frame, const RecordRef& record) {
  const Vec3 seen = frame.camera.project(findIndirect(frame, record)->point.position).value();
  return kPicture.toFramebuffer({seen.x, seen.y});
}

TEST(PixelAt, IsWithinThePictureOrNothing) {
  EXPECT_EQ(pixelAt(kPicture, {100, 50}, 32, 32), (PixelRef{0, 0}));
  EXPECT_EQ(pixelAt(kPicture, {419.9f, 369.9f}, 32, 32), (PixelRef{31, 31}));
  EXPECT_EQ(pixelAt(kPicture, {235, 55}, 32, 32), (PixelRef{13, 0}));
  for (const Vec2 beside : {Vec2(99, 60), Vec2(110, 49), Vec2(420, 60), Vec2(110, 371)})
    EXPECT_FALSE(pixelAt(kPicture, beside, 32, 32));
}

TEST(SurfaceAt, IsWhatThePixelSees) {
  const RenderFrame& frame = roomFrame();
  const auto point = surfaceAt(frame, {16, 16});
  ASSERT_TRUE(point);
  EXPECT_EQ(*point, frame.film->position().at(16, 16));
  RenderFrame coarse = frame;
  coarse.reduction = 4;
  EXPECT_EQ(surfaceAt(coarse, {67, 65}), frame.film->position().at(16, 16)) << "a pixel of the whole picture";
  EXPECT_FALSE(surfaceAt(frame, {40, 3}));
}

TEST(Clicks, SelectAVectorOrElseThePixel) {
  const RenderFrame& frame = roomFrame();
  const OverlayBatch overlay = buildOverlay(frame, {});
  ASSERT_FALSE(overlay.markers.empty());
  const RecordRef record = overlay.markers.back().record;
  const Vec2 at = onScreen(frame, record);
  EXPECT_EQ(recordAt(frame, &overlay, kPicture, at), record);
  EXPECT_TRUE(recordAt(frame, nullptr, kPicture, at).isNone());
  const Selection one = selectionAfterClick({}, frame, &overlay, kPicture, at, false);
  ASSERT_EQ(one.records.size(), 1u);
  const Selection none = selectionAfterClick(one, frame, nullptr, kPicture, at, false);
  EXPECT_TRUE(none.records.empty()) << "without an overlay there is nothing to be hit";
  EXPECT_TRUE(none.pixel);
  const Selection out = selectionAfterClick(one, frame, &overlay, kPicture, at, true);
  EXPECT_TRUE(out.records.empty()) << "a second click that adds takes it out";
  EXPECT_FALSE(selectionAfterClick(none, frame, nullptr, kPicture, {0, 0}, false).pixel);
}

TEST(Drags, SelectWhatLiesInTheRectangle) {
  const RenderFrame& frame = roomFrame();
  const Selection all = selectionAfterDrag({}, frame, {}, kPicture, {420, 370}, {100, 50}, false);
  EXPECT_GT(all.records.size(), 20u) << "from any corner to any";
  const Selection half =
      selectionAfterDrag({}, frame, {.direct = false}, kPicture, {100, 50}, {260, 370}, false);
  EXPECT_LT(half.records.size(), all.records.size());
  for (const RecordRef& record : half.records) EXPECT_LE(onScreen(frame, record).x, 260.0f);
  const Selection both =
      selectionAfterDrag(half, frame, {.direct = false}, kPicture, {260, 50}, {420, 370}, true);
  const Selection indirect =
      selectionAfterDrag({}, frame, {.direct = false}, kPicture, {100, 50}, {420, 370}, false);
  EXPECT_THAT(both.records, testing::UnorderedElementsAreArray(indirect.records)) << "each once";
}

TEST(BallAround, HoldsAllThatIsSelected) {
  const RenderFrame& frame = roomFrame();
  EXPECT_FALSE(ballAround(frame, {}));
  Selection selection;
  selection.records = {{kNone, 0}, {kNone, 5}};
  selection.pixel = PixelRef{3, 28};
  const auto ball = ballAround(frame, selection);
  ASSERT_TRUE(ball);
  for (const Vec3& point : {frame.snapshot->indirect[0].point.position,
                            frame.snapshot->indirect[5].point.position, frame.film->position().at(3, 28)})
    EXPECT_LE(glm::length(point - ball->centre), 1.0001f * ball->radius);
}

}  // namespace
}  // namespace lightvane
