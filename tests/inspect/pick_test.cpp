#include "core/inspect/pick.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/overlays.h"
#include "core/inspect/record_names.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

TEST(PickMarker, TakesTheNearestVisibleWithinReach) {
  const RenderFrame& frame = mirrorFrame();
  const Camera& camera = frame.camera;
  const auto at = [&](float x, float y, float distance) {
    return camera.position + distance * camera.sight(x, y).direction;
  };
  OverlayBatch batch;
  const auto add = [&](const Vec3& position, std::uint32_t number, bool inMirror = false) {
    batch.markers.push_back({position, 6.0f, {}, MarkerShape::Disc, {kNone, number}, inMirror});
  };
  const ImageFloat depth(64, 64, 2.0f);
  add(at(20, 20, 1.9f), 1);
  add(at(22, 20, 1.5f), 2);
  add(at(40, 20, 1.0f), 3);
  EXPECT_EQ(pickMarker(batch, camera, 20, 20, 3, depth).number, 2u) << "nearer to the viewer";
  EXPECT_EQ(pickMarker(batch, camera, 19, 20, 2, depth).number, 1u) << "the other is out of reach";
  EXPECT_TRUE(pickMarker(batch, camera, 30, 20, 3, depth).isNone());
  add(at(50, 50, 3.0f), 4);
  EXPECT_EQ(pickMarker(batch, camera, 50, 50, 3, depth).number, 4u) << "hidden, but alone";
  add(at(51, 50, 3.5f), 5, true);
  EXPECT_EQ(pickMarker(batch, camera, 50, 50, 3, depth).number, 5u) << "an image is behind its mirror";
  add(camera.position - camera.forward, 6);
  EXPECT_TRUE(pickMarker(batch, camera, 32, 32, 3, depth).isNone()) << "behind the viewer";
  // A preview's depth has fewer pixels.
  EXPECT_EQ(pickMarker(batch, camera, 50, 50, 3, ImageFloat(16, 16, 2.0f)).number, 5u);
  EXPECT_EQ(pickMarker(batch, camera, 50, 50, 3, ImageFloat()).number, 4u);
}

/// Asks for every vector of the frame that is seen straight where it is drawn; returns how many these are.
std::size_t expectPicked(const RenderFrame& frame) {
  const OverlayBatch batch = indirectMarkers(frame, {});
  std::size_t picked = 0;
  std::size_t asked = 0;
  for (const OverlayMarker& marker : batch.markers) {
    const IndirectLightVector* record = findIndirect(frame, marker.record);
    if (record->birth.throughSpecular) continue;
    const Vec3 seen = *frame.camera.project(marker.position);
    ++asked;
    picked += pickMarker(batch, frame.camera, seen.x, seen.y, 0.4f, frame.film->depth()) == marker.record;
  }
  // Some pixels hold a second one, of another key or nearer.
  EXPECT_GE(static_cast<double>(picked), 0.98 * static_cast<double>(asked)) << picked << " of " << asked;
  return asked;
}

TEST(PickMarker, FindsARenderingsVectorsWhereTheyAre) { EXPECT_GT(expectPicked(mirrorFrame()), 20u); }

TEST(PickMarker, FindsThoseOfAnOrthographicPicture) {
  const RenderFrame& frame = orthographicFrame();
  const std::size_t asked = expectPicked(frame);
  EXPECT_GT(asked, 20u);
  const Vec2 size(frame.camera.width, frame.camera.height);
  EXPECT_GE(recordsWithin(frame, Vec2(0.0f), size, {.direct = false}).size(), asked * 97 / 100);
}

TEST(RecordsWithin, TheWholePictureHasEveryVectorThatIsSeenStraight) {
  const RenderFrame& frame = mirrorFrame();
  const Vec2 size(frame.camera.width, frame.camera.height);
  const std::vector<RecordRef> all = recordsWithin(frame, Vec2(0.0f), size, {});
  std::size_t straight = 0, found = 0;
  const auto count = [&](const auto& records, std::uint32_t light) {
    for (std::uint32_t number = 0; number < records.size(); ++number) {
      if (records[number].birth.throughSpecular) continue;
      ++straight;
      found += std::find(all.begin(), all.end(), RecordRef{light, number}) != all.end();
    }
  };
  count(frame.snapshot->indirect, kNone);
  for (std::uint32_t light = 0; light < frame.snapshot->direct.size(); ++light)
    count(frame.snapshot->direct[light], light);
  // At an edge, a pixel's centre may see the nearer surface.
  EXPECT_GE(static_cast<double>(found), 0.97 * static_cast<double>(straight)) << found << " of " << straight;
}

TEST(RecordsWithin, HasThoseThatProjectIntoTheRectangleAndNoOther) {
  const RenderFrame& frame = mirrorFrame();
  const Vec2 low(10.0f, 20.0f), high(30.0f, 45.0f);
  const std::vector<RecordRef> found = recordsWithin(frame, low, high, {.direct = false});
  EXPECT_GT(found.size(), 5u);
  for (const RecordRef& record : found) {
    ASSERT_TRUE(record.isIndirect());
    const Vec3 seen = *frame.camera.project(findIndirect(frame, record)->point.position);
    EXPECT_TRUE(seen.x >= low.x && seen.x <= high.x && seen.y >= low.y && seen.y <= high.y);
  }
  EXPECT_LT(found.size(), recordsWithin(frame, Vec2(0.0f), Vec2(64.0f), {.direct = false}).size());
  EXPECT_TRUE(recordsWithin(frame, high, low, {}).empty()) << "nothing is within a rectangle without an area";
}

TEST(RecordsWithin, LeavesOutWhatASurfaceHides) {
  RenderFrame frame = mirrorFrame();
  Film wall = *frame.film;
  SeenSurfaces near = *wall.seen;
  for (float& depth : near.depth) depth = 0.01f;
  wall.seen = std::make_shared<const SeenSurfaces>(std::move(near));
  frame.film = std::make_shared<const Film>(std::move(wall));
  EXPECT_TRUE(recordsWithin(frame, Vec2(0.0f), Vec2(64.0f), {}).empty());
}

}  // namespace
}  // namespace lightvane::inspect_test
