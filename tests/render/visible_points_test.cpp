// What the camera sees, straight and by way of mirrors.

#include "core/render/visible_points.h"

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

VisiblePoints pointsOf(const Stage& stage) {
  const RenderContext context = stage.context(Parameters{});
  VisiblePoints points;
  SeenSurfaces seen(context.region.width, context.region.height);
  RayCounts counts;
  EXPECT_TRUE(traceVisiblePoints(*stage.tracer, stage.camera, context.region, context.parameters, *stage.pool,
                                 StopFlag(false), points, seen, counts));
  return points;
}

// A ball shows the room small: a pixel of it is wide at the walls. Vectors that were widened by that would
// serve all of a wall that the camera sees straight.
TEST(VisiblePoints, VectorsSeenInABallAreOfThePixelsThatSeeThemStraight) {
  const Stage stage(sceneFromText(R"(
version = 1
[camera]
position = [0, 1, 4]
target = [0, 1, 0]
resolution = [64, 64]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.chrome]
mirror = [0.9, 0.9, 0.9]
[[light]]
type = "point"
position = [0, 2, 3]
[[shape]]
type = "sphere"
material = "chrome"
center = [0, 1, 0]
radius = 0.7
[[shape]]
type = "box"
material = "white"
min = [-3, 0, -3]
max = [3, 3, 5]
)"));
  const float spread = 2.0f * stage.camera.tanHalfFovY / 256.0f;
  int straight = 0, small = 0;
  for (const VisibleTile& tile : pointsOf(stage).tiles) {
    for (const VisiblePoint& point : tile.points) {
      const float asSeenStraight = spread * glm::length(point.position - stage.camera.position);
      if (point.throughSpecular) {
        EXPECT_LE(point.vectorFootprint, asSeenStraight);
        small += point.footprint > 10.0f * point.vectorFootprint;
      } else {
        EXPECT_EQ(point.vectorFootprint, point.footprint);
        EXPECT_NEAR(point.footprint, asSeenStraight, 1e-5f * asSeenStraight);
        ++straight;
      }
    }
  }
  EXPECT_GT(straight, 1000);
  EXPECT_GT(small, 100);
}

}  // namespace
}  // namespace lightvane::render_test
