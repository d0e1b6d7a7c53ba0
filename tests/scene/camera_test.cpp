// Cameras as words and as numbers.

#include <cmath>
#include <ostream>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/scene/scene.h"

namespace lightvane {
namespace {

enum class Kind { Pinhole, Lens, Orthographic };
void PrintTo(Kind kind, std::ostream* out) {
  *out << (kind == Kind::Pinhole ? "pinhole" : kind == Kind::Lens ? "lens" : "orthographic");
}

CameraDescription someCamera(Kind kind, std::uint32_t i) {
  const RandomKey key = randomKey(11);
  const auto number = [&](std::uint32_t dimension) {
    return static_cast<double>(uniform(key, i, dimension));
  };
  const auto point = [&](std::uint32_t dimension) {
    return Vec3d(number(dimension), number(dimension + 1), number(dimension + 2));
  };
  CameraDescription d;
  d.position = 20.0 * point(0) - 10.0;
  d.target = 20.0 * point(3) - 10.0;
  d.up = point(6) - 0.5;
  d.width = 320;
  d.height = 200;
  if (kind == Kind::Orthographic) {
    d.projection = Projection::Orthographic;
    d.orthographicHeight = 0.1 + 30.0 * number(9);
    return d;
  }
  d.fovYDegrees = 5.0 + 100.0 * number(9);
  if (kind == Kind::Lens) {
    d.lensRadius = 0.01 + number(10);
    if (number(11) < 0.5) d.focusDistance = 0.1 + 10.0 * number(12);
  }
  return d;
}

class Cameras : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Cameras, testing::Values(Kind::Pinhole, Kind::Lens, Kind::Orthographic),
                         [](const testing::TestParamInfo<Kind>& kind) {
                           return testing::PrintToString(kind.param);
                         });

TEST_P(Cameras, DescriptionsMeanTheSameView) {
  const Normalisation normalisation{{3.0, -2.0, 100.0}, 5, 0};
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Camera camera = compileCamera(normalisation, someCamera(GetParam(), i), "test").value();
    const Camera again = compileCamera(normalisation, describeCamera(normalisation, camera), "test").value();
    for (const auto& [a, b] :
         {std::pair(camera.position, again.position), std::pair(camera.right, again.right),
          std::pair(camera.up, again.up), std::pair(camera.forward, again.forward)}) {
      EXPECT_NEAR(glm::length(a - b), 0.0f, 3e-7f) << i;
    }
    EXPECT_EQ(again.projection, camera.projection);
    for (const auto& [a, b] :
         {std::pair(again.tanHalfFovY, camera.tanHalfFovY), std::pair(again.halfHeight, camera.halfHeight),
          std::pair(again.lensRadius, camera.lensRadius),
          std::pair(again.focusDistance, camera.focusDistance)}) {
      EXPECT_NEAR(a, b, 1e-6f * b);
    }
    const CameraDescription words = describeCamera(normalisation, camera);
    EXPECT_EQ(words.lensRadius > 0.0, GetParam() == Kind::Lens);
    EXPECT_EQ(words.focusDistance.has_value(), GetParam() == Kind::Lens);
  }
}

TEST_P(Cameras, ProjectionIsTheInverseOfTheirRays) {
  const Normalisation normalisation{{0.0, 0.0, 0.0}, 4, 0};
  const Camera camera = compileCamera(normalisation, someCamera(GetParam(), 5), "test").value();
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec2 pixel = uniform2(randomKey(3), i, 0) * Vec2(320.0f, 200.0f);
    const float distance = 0.1f + uniform(randomKey(3), i, 2);
    const Sight sight = camera.sight(pixel.x, pixel.y);
    const Vec3 point = sight.origin + distance * sight.direction;
    const auto seen = camera.project(point);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(seen->x, pixel.x, 2e-3f);
    EXPECT_NEAR(seen->y, pixel.y, 2e-3f);
    EXPECT_NEAR(seen->z, glm::dot(point - camera.position, camera.forward), 1e-6f);
    EXPECT_NEAR(camera.distanceTo(point), distance, 1e-6f);
    EXPECT_NEAR(glm::length(camera.eyeOf(point) - sight.origin), 0.0f, 1e-6f);
  }
  EXPECT_FALSE(camera.project(camera.position - camera.forward)) << "behind the camera";
}

// A length across the view is as many pixels as the width of a pixel says.
TEST_P(Cameras, PixelsAreAsWideAsTheySay) {
  const Normalisation normalisation{{0.0, 0.0, 0.0}, 4, 0};
  const Camera camera = compileCamera(normalisation, someCamera(GetParam(), 7), "test").value();
  for (const float depth : {0.1f, 1.0f, 3.0f}) {
    const Vec3 point = camera.position + depth * camera.forward;
    const Vec3 beside = point + 10.0f * camera.pixelWidth(depth) * camera.up;
    EXPECT_NEAR(camera.project(point)->y - camera.project(beside)->y, 10.0f, 1e-3f);
  }
}

TEST(OrthographicCamera, LinesOfSightAreParallelAndEvenlySpaced) {
  const Normalisation normalisation{{1.0, 2.0, 3.0}, 3, 0};
  const CameraDescription description = someCamera(Kind::Orthographic, 2);
  const Camera camera = compileCamera(normalisation, description, "test").value();
  const float step = normalisation.length(description.orthographicHeight) / 200.0f;
  const Vec3 corner = camera.sight(0.5f, 0.5f).origin;
  for (int y = 0; y < 200; y += 13) {
    for (int x = 0; x < 320; x += 17) {
      const Sight sight = camera.sight(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      EXPECT_EQ(sight.direction, camera.forward);
      const Vec3 expected =
          corner + step * (static_cast<float>(x) * camera.right - static_cast<float>(y) * camera.up);
      EXPECT_NEAR(glm::length(sight.origin - expected), 0.0f, 2e-6f);
    }
  }
  EXPECT_NEAR(glm::length(camera.sight(160.0f, 100.0f).origin - camera.position), 0.0f, 1e-6f);
}

TEST(LensCamera, AllPlacesOnTheLensSeeTheSamePointInFocus) {
  const Normalisation normalisation{{0.0, 0.0, 0.0}, 4, 0};
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Camera camera = compileCamera(normalisation, someCamera(Kind::Lens, i), "test").value();
    const Vec2 pixel = uniform2(randomKey(5), i, 0) * Vec2(320.0f, 200.0f);
    const auto inFocus = [&](const Vec2& onLens) {
      const Sight sight = camera.sight(pixel.x, pixel.y, onLens);
      return sight.origin +
             sight.direction * (camera.focusDistance / glm::dot(sight.direction, camera.forward));
    };
    const Vec3 byWayOfCentre = inFocus(Vec2(0.0f));
    for (const Vec2 onLens : {Vec2(1.0f, 0.0f), Vec2(0.0f, -1.0f), Vec2(-0.6f, 0.8f), Vec2(0.3f, 0.1f)}) {
      // What single precision has of a place at this distance.
      const float rounding = 1e-6f * (1.0f + glm::length(byWayOfCentre));
      EXPECT_NEAR(glm::length(inFocus(onLens) - byWayOfCentre), 0.0f, rounding) << i;
      const Vec3 origin = camera.sight(pixel.x, pixel.y, onLens).origin - camera.position;
      EXPECT_NEAR(glm::length(origin), camera.lensRadius * glm::length(onLens), 1e-6f);
      EXPECT_NEAR(glm::dot(origin, camera.forward), 0.0f, 1e-6f);
    }
  }
}

TEST(Camera, IsRefusedWhereItCannotBe) {
  const Normalisation normalisation{{0.0, 0.0, 0.0}, 4, 0};
  const auto errorOf = [&](const CameraDescription& description) {
    const auto camera = compileCamera(normalisation, description, "test");
    return camera ? std::string() : camera.error().message();
  };
  CameraDescription lens;
  lens.lensRadius = 0.1;
  EXPECT_EQ(errorOf(lens), "");
  lens.focusDistance = 0.0;
  EXPECT_NE(errorOf(lens).find("focus_distance must be above 0"), std::string::npos) << errorOf(lens);
  lens.focusDistance = 1e30;
  EXPECT_NE(errorOf(lens).find("focus_distance"), std::string::npos);
  lens.lensRadius = -1.0;
  EXPECT_NE(errorOf(lens).find("lens_radius"), std::string::npos);
  for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
    CameraDescription far;
    far.projection = projection;
    far.position = {0.0, 1e10, 1e9};
    EXPECT_EQ(errorOf(far), "");
    far.position.z = 1e11;
    EXPECT_EQ(
        errorOf(far),
        "test: position must be no farther from the scene than 1e9 times its size, found 1.00499e+11 away "
        "from a scene of about 16");
    far.position.z = 1e60;
    EXPECT_NE(errorOf(far).find("found 1e+60 away"), std::string::npos) << "infinite in single precision";
  }
  CameraDescription flat;
  flat.projection = Projection::Orthographic;
  EXPECT_EQ(errorOf(flat), "");
  flat.fovYDegrees = 200.0;
  EXPECT_EQ(errorOf(flat), "") << "it has no angle";
  for (const double height : {0.0, -1.0, 1e-20, 1e30, std::nan("")}) {
    flat.orthographicHeight = height;
    EXPECT_NE(errorOf(flat).find("height must be above 0"), std::string::npos) << height;
  }
  flat.orthographicHeight = 1.0;
  flat.lensRadius = 0.1;
  EXPECT_NE(errorOf(flat).find("no lens"), std::string::npos);
}

}  // namespace
}  // namespace lightvane
