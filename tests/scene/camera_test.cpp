// Cameras as words and as numbers.

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/scene/scene.h"

namespace lightvane {
namespace {

CameraDescription someCamera(std::uint32_t i) {
  const RandomKey key = randomKey(11);
  const auto point = [&](std::uint32_t dimension) {
    return Vec3d(uniform(key, i, dimension), uniform(key, i, dimension + 1), uniform(key, i, dimension + 2));
  };
  CameraDescription d;
  d.position = 20.0 * point(0) - 10.0;
  d.target = 20.0 * point(3) - 10.0;
  d.up = point(6) - 0.5;
  d.fovYDegrees = 5.0 + 100.0 * static_cast<double>(uniform(key, i, 9));
  d.width = 320;
  d.height = 200;
  return d;
}

TEST(Camera, ItsDescriptionMeansTheSameView) {
  const Normalisation normalisation{{3.0, -2.0, 100.0}, 5, 0};
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Camera camera = compileCamera(normalisation, someCamera(i), "test").value();
    const Camera again = compileCamera(normalisation, describeCamera(normalisation, camera), "test").value();
    for (const auto& [a, b] :
         {std::pair(camera.position, again.position), std::pair(camera.right, again.right),
          std::pair(camera.up, again.up), std::pair(camera.forward, again.forward)}) {
      EXPECT_NEAR(glm::length(a - b), 0.0f, 3e-7f) << i;
    }
    EXPECT_NEAR(again.tanHalfFovY, camera.tanHalfFovY, 1e-6f * camera.tanHalfFovY);
  }
}

TEST(Camera, ProjectionIsTheInverseOfItsRays) {
  const Normalisation normalisation{{0.0, 0.0, 0.0}, 4, 0};
  const Camera camera = compileCamera(normalisation, someCamera(5), "test").value();
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec2 pixel = uniform2(randomKey(3), i, 0) * Vec2(320.0f, 200.0f);
    const float distance = 0.1f + uniform(randomKey(3), i, 2);
    const auto seen = camera.project(camera.position + distance * camera.direction(pixel.x, pixel.y));
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, pixel.x, 2e-3f);
    EXPECT_NEAR(seen->y, pixel.y, 2e-3f);
  }
  EXPECT_FALSE(camera.project(camera.position - camera.forward)) << "behind the camera";
}

}  // namespace
}  // namespace lightvane
