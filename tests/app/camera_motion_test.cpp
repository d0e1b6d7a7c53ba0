// A camera under the hand: what stays in place, and what never breaks.

#include "app/camera_motion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace lightvane {
namespace {

const Vec3 kUp(0, 1, 0);

Camera someCamera() {
  Camera camera;
  camera.position = {0.1f, 0.4f, 1.5f};
  camera.forward = glm::normalize(Vec3(0.1f, -0.3f, -1.0f));
  camera.right = glm::normalize(glm::cross(camera.forward, kUp));
  camera.up = glm::cross(camera.right, camera.forward);
  camera.tanHalfFovY = 0.4f;
  camera.width = 640;
  camera.height = 480;
  return camera;
}

void expectLevelAndOrthonormal(const Camera& camera) {
  EXPECT_NEAR(glm::length(camera.forward), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::length(camera.right), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::length(camera.up), 1.0f, 1e-5f);
  EXPECT_NEAR(glm::dot(camera.right, camera.forward), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::dot(camera.up, camera.forward), 0.0f, 1e-5f);
  EXPECT_NEAR(glm::dot(camera.right, kUp), 0.0f, 1e-5f) << "the horizon is tilted";
}

TEST(CameraMotion, OrbitKeepsThePivotInItsPlace) {
  Camera camera = someCamera();
  const Vec3 pivot(0.2f, 0.1f, -0.3f);
  const Vec3 before = camera.project(pivot).value();
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Vec2 u = uniform2(randomKey(1), i, 0);
    camera = orbited(camera, pivot, kUp, 0.3f * (u.x - 0.5f), 0.3f * (u.y - 0.5f));
  }
  const Vec3 after = camera.project(pivot).value();
  EXPECT_NEAR(after.x, before.x, 0.1f);
  EXPECT_NEAR(after.y, before.y, 0.1f);
  EXPECT_NEAR(after.z, before.z, 1e-3f);
  expectLevelAndOrthonormal(camera);
}

TEST(CameraMotion, PolesStopPitch) {
  for (const float pitch : {10.0f, -10.0f, 100.0f, -100.0f}) {
    const Camera camera = turned(someCamera(), kUp, 0.7f, pitch);
    expectLevelAndOrthonormal(camera);
    EXPECT_GT(camera.up.y, 0.0f) << "upside down after a pitch of " << pitch;
  }
}

TEST(CameraMotion, PanFollowsTheDrag) {
  const Camera camera = someCamera();
  const Vec3 point = camera.position + 1.7f * camera.forward + 0.1f * camera.right;
  const Vec3 before = camera.project(point).value();
  const Vec3 after = panned(camera, {31.0f, -12.0f}, before.z).project(point).value();
  EXPECT_NEAR(after.x - before.x, 31.0f, 0.01f);
  EXPECT_NEAR(after.y - before.y, -12.0f, 0.01f);
}

TEST(CameraMotion, DollyNeverReachesThePivot) {
  Camera camera = someCamera();
  const Vec3 pivot(0.0f);
  for (int i = 0; i < 20; ++i) camera = dollied(camera, pivot, 0.0f);
  EXPECT_GT(glm::length(camera.position - pivot), 0.0f);
  EXPECT_TRUE(std::isfinite(camera.position.x));
}

TEST(CameraMotion, FramedBallFillsThePictureAndNoMore) {
  for (const int width : {200, 480, 900}) {
    Camera camera = someCamera();
    camera.width = width;
    const Vec3 centre(3.0f, -1.0f, 2.0f);
    const float radius = 0.25f;
    camera = framing(camera, centre, radius);
    const float distance = glm::length(centre - camera.position);
    // The ball's outline is the cone of this half angle.
    const float seen = std::tan(std::asin(radius / distance)) / camera.tanHalfFovY * 240.0f;
    EXPECT_NEAR(seen, 0.5f * static_cast<float>(std::min(width, 480)), 0.5f) << width;
    const Vec3 middle = camera.project(centre).value();
    EXPECT_NEAR(middle.x, 0.5f * static_cast<float>(width), 0.01f);
  }
}

// ---- orthographic ----

Camera orthographicCamera() {
  Camera camera = someCamera();
  camera.projection = Projection::Orthographic;
  camera.tanHalfFovY = 1.0f;
  camera.halfHeight = 0.7f;
  return camera;
}

TEST(OrthographicMotion, OrbitAndPanKeepWhatIsHeld) {
  const Camera camera = orthographicCamera();
  const Vec3 pivot(0.2f, 0.1f, -0.3f);
  const Vec3 before = camera.project(pivot).value();
  const Vec3 orbit = orbited(camera, pivot, kUp, 0.7f, -0.3f).project(pivot).value();
  EXPECT_NEAR(glm::length(orbit - before), 0.0f, 0.01f);
  const Vec3 pan = panned(camera, {31.0f, -12.0f}, before.z).project(pivot).value();
  EXPECT_NEAR(pan.x - before.x, 31.0f, 0.01f);
  EXPECT_NEAR(pan.y - before.y, -12.0f, 0.01f);
}

TEST(OrthographicMotion, DollyShowsLessAboutThePivot) {
  const Camera camera = orthographicCamera();
  const Vec3 pivot(0.2f, 0.1f, -0.3f);
  const Camera nearer = dollied(camera, pivot, 0.5f);
  EXPECT_FLOAT_EQ(nearer.halfHeight, 0.35f);
  EXPECT_NEAR(glm::length(nearer.project(pivot).value() - camera.project(pivot).value()), 0.0f, 0.01f);
  EXPECT_NEAR(glm::dot(nearer.position - camera.position, camera.forward), 0.0f, 1e-6f);
  const Vec3 beside = pivot + 0.1f * camera.right;
  const float before = camera.project(beside)->x - camera.project(pivot)->x;
  EXPECT_NEAR(nearer.project(beside)->x - nearer.project(pivot)->x, 2.0f * before, 0.01f);
  Camera nearest = camera;
  for (int i = 0; i < 20; ++i) nearest = dollied(nearest, pivot, 0.0f);
  EXPECT_GT(nearest.halfHeight, 0.0f);
  const Camera back = dollied(nearer, pivot, 2.0f);
  EXPECT_NEAR(glm::length(back.position - camera.position), 0.0f, 1e-6f) << "there and back is nothing";
}

TEST(OrthographicMotion, FlightForwardShowsLess) {
  const Camera camera = orthographicCamera();
  EXPECT_LT(flown(camera, {0, 0, 0.1f}).halfHeight, camera.halfHeight);
  EXPECT_EQ(flown(camera, {0, 0, 0.1f}).position, camera.position);
  EXPECT_GT(flown(camera, {0, 0, 100.0f}).halfHeight, 0.0f);
  EXPECT_NEAR(glm::length(flown(camera, {0.1f, 0, 0}).position - camera.position), 0.1f, 1e-6f);
}

TEST(OrthographicMotion, FramedBallFillsThePictureAndIsBeforeTheCamera) {
  for (const int width : {200, 480, 900}) {
    for (const Vec3 centre : {Vec3(3.0f, -1.0f, -2.0f), Vec3(3.0f, -1.0f, 8.0f)}) {
      Camera camera = orthographicCamera();
      camera.width = width;
      const float radius = 0.25f;
      camera = framing(camera, centre, radius);
      const Vec3 middle = camera.project(centre).value();
      const Vec3 rim = camera.project(centre + radius * camera.right).value();
      EXPECT_NEAR(rim.x - middle.x, 0.5f * static_cast<float>(std::min(width, 480)), 0.1f) << width;
      EXPECT_NEAR(middle.x, 0.5f * static_cast<float>(width), 0.01f);
      EXPECT_GT(middle.z, radius);
    }
  }
}

TEST(CameraMotion, ALensFocusesOnWhatIsFramed) {
  Camera camera = someCamera();
  camera.lensRadius = 0.02f;
  camera.focusDistance = 1.0f;
  const Camera framed = framing(camera, {3.0f, -1.0f, 2.0f}, 0.25f);
  EXPECT_NEAR(framed.focusDistance, framed.project({3.0f, -1.0f, 2.0f})->z, 1e-5f);
  EXPECT_EQ(framing(someCamera(), {3.0f, -1.0f, 2.0f}, 0.25f).focusDistance, 0.0f);
}

TEST(CameraMotion, WorldUpIsTheNearestAxis) {
  Camera camera = someCamera();
  EXPECT_EQ(worldUp(camera), kUp);
  camera.up = glm::normalize(Vec3(0.2f, -0.1f, -0.9f));
  EXPECT_EQ(worldUp(camera), Vec3(0, 0, -1));
}

}  // namespace
}  // namespace lightvane
