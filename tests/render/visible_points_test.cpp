// What the camera sees, straight and by way of mirrors.

#include "core/render/visible_points.h"

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

struct Seen {
  VisiblePoints points;
  SeenSurfaces surfaces;
};

Seen seenBy(const Stage& stage, const Settings& settings = {}) {
  const RenderContext context = stage.context(parametersWith(settings));
  Seen seen{{}, SeenSurfaces(context.region.width, context.region.height)};
  RayCounts counts;
  EXPECT_TRUE(traceVisiblePoints(*stage.tracer, stage.camera, context.region, context.parameters, *stage.pool,
                                 StopFlag(false), seen.points, seen.surfaces, counts));
  return seen;
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
  for (const VisibleTile& tile : seenBy(stage).points.tiles) {
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

/// Shapes at several distances, none of them in focus, and what the camera has beside its place.
SceneDescription steps(const std::string& camera) {
  return sceneFromText("version = 1\n[camera]\nposition = [0.5, 2, 6]\ntarget = [0, 1, 0]\n" + camera + R"(
resolution = [64, 48]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.mirror]
mirror = [0.9, 0.9, 0.9]
[[light]]
type = "point"
position = [0, 4, 3]
[[shape]]
type = "box"
material = "white"
min = [-4, -1, -4]
max = [4, 0, 4]
[[shape]]
type = "sphere"
material = "white"
center = [-1, 1, 0]
radius = 0.8
[[shape]]
type = "polygon"
material = "mirror"
vertices = [[0.2, 0, -2], [2.5, 0, -1], [2.5, 2, -1], [0.2, 2, -2]]
)");
}

// A pixel of an orthographic picture is as wide everywhere, in a plane mirror too.
TEST(VisiblePoints, OfAnOrthographicCameraHaveOneWidth) {
  const Stage stage(steps("projection = \"orthographic\"\nheight = 3"));
  const float width = stage.scene->normalisation.length(3.0) / 256.0f;
  int straight = 0, mirrored = 0;
  for (const VisibleTile& tile : seenBy(stage).points.tiles) {
    for (const VisiblePoint& point : tile.points) {
      ASSERT_NEAR(point.footprint, width, 1e-6f * width);
      ASSERT_NEAR(point.vectorFootprint, width, 1e-6f * width);
      ++(point.throughSpecular ? mirrored : straight);
      if (!point.throughSpecular) {
        ASSERT_EQ(point.outgoing, -stage.camera.forward);
      }
    }
  }
  EXPECT_GT(straight, 1000);
  EXPECT_GT(mirrored, 50);
}

// By way of each place on the lens, a pixel is as wide as its cone there.
TEST(VisiblePoints, OfALensAreAsWideAsOfAPinhole) {
  const Stage stage(steps("lens_radius = 0.3\nfocus_distance = 4"));
  const float spread = 2.0f * stage.camera.tanHalfFovY / 256.0f;
  for (const VisibleTile& tile : seenBy(stage, {{"film.samples", "4"}}).points.tiles) {
    for (const VisiblePoint& point : tile.points) {
      if (point.throughSpecular) continue;
      // From a place on the lens instead of its centre.
      const float distance = glm::length(point.position - stage.camera.position);
      ASSERT_NEAR(point.footprint, spread * distance, 1.001f * spread * stage.camera.lensRadius);
    }
  }
}

// What the window picks from these layers is where Camera::project has it, however blurred the picture is.
TEST(VisiblePoints, SurfacesOfALensAreThoseThatItsCentreSees) {
  const Stage lens(steps("lens_radius = 0.3\nfocus_distance = 4"));
  const Stage pinhole(steps(""));
  const Seen blurred = seenBy(lens, {{"film.samples", "4"}});
  const Seen sharp = seenBy(pinhole, {{"film.samples", "4"}});
  for (std::size_t i = 0; i < sharp.surfaces.depth.size(); ++i) {
    const bool isMet = sharp.surfaces.depth[i] < kInfinity;
    ASSERT_EQ(blurred.surfaces.depth[i] < kInfinity, isMet) << i;
    if (!isMet) continue;
    ASSERT_NEAR(blurred.surfaces.depth[i], sharp.surfaces.depth[i], 1e-5f) << i;
    ASSERT_NEAR(glm::length(blurred.surfaces.position[i] - sharp.surfaces.position[i]), 0.0f, 1e-5f) << i;
    ASSERT_NEAR(glm::length(blurred.surfaces.normal[i] - sharp.surfaces.normal[i]), 0.0f, 1e-4f) << i;
  }
}

TEST(CameraRay, PlacesOnALensAreSpreadEvenly) {
  const Stage stage(steps("lens_radius = 0.3\nfocus_distance = 4"));
  const auto place = [&](int x, int y, int s, int samples) {
    const Vec3 aside = cameraRay(stage.camera, x, y, s, samples).origin - stage.camera.position;
    return Vec2(glm::dot(aside, stage.camera.right), glm::dot(aside, stage.camera.up)) /
           stage.camera.lensRadius;
  };
  // Of the 64 samples of a pixel as many lie in each quarter, which is a cell of the sequence, and nearly as
  // many in each of four rings of equal area, which are not.
  for (int pixel = 0; pixel < 20; ++pixel) {
    int rings[4] = {}, quarters[4] = {};
    for (int s = 0; s < 64; ++s) {
      const Vec2 p = place(3 * pixel, 2 * pixel, s, 64);
      ASSERT_LE(glm::length(p), 1.0f + 1e-5f);
      ++rings[std::min(3, static_cast<int>(4.0f * glm::dot(p, p)))];
      ++quarters[(p.x >= 0.0f ? 1 : 0) + (p.y >= 0.0f ? 2 : 0)];
    }
    for (const int count : quarters) EXPECT_EQ(count, 16);
    for (const int count : rings) EXPECT_NEAR(count, 16, 4);
  }
  // One sample a pixel is another place in each, all over the lens.
  Vec2 sum(0.0f);
  float squares = 0.0f;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec2 p = place(x, y, 0, 1);
      sum += p;
      squares += glm::dot(p, p);
    }
  }
  // 3072 places: the mean of a coordinate has a standard error of 0.5 / sqrt(3072), that of the squared
  // distance, even in [0, 1], 0.29 / sqrt(3072). Five of them.
  EXPECT_NEAR(sum.x / 3072.0f, 0.0f, 0.045f);
  EXPECT_NEAR(sum.y / 3072.0f, 0.0f, 0.045f);
  EXPECT_NEAR(squares / 3072.0f, 0.5f, 0.026f);
}

}  // namespace
}  // namespace lightvane::render_test
