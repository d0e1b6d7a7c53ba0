// A picture with instances in it, which packets of all kinds cross, ends and is that of copies.

#include <cmath>
#include <memory>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"
#include "tests/support/grid_mesh.h"

namespace lightvane::render_test {
namespace {

/// A ball of radius 0.5 with smooth normals.
MeshGeometry smoothBall(std::uint32_t rows, std::uint32_t columns) {
  MeshGeometry mesh;
  for (std::uint32_t i = 0; i <= rows; ++i) {
    for (std::uint32_t j = 0; j <= columns; ++j) {
      const double theta = kPiD * i / rows, phi = 2.0 * kPiD * j / columns;
      mesh.normals.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                                std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(0.5 * mesh.normals.back());
    }
  }
  mesh.triangles = test::gridTriangles(rows, columns);
  return mesh;
}

/// Two such balls over a floor, one of them squashed and mirrored, under lights of three kinds.
SceneDescription twoBalls(bool areShared) {
  SceneDescription scene = sceneFromText(R"(
version = 1
[camera]
position = [0, 0.5, 5]
target = [0, 0.5, 0]
fov_y = 45.8
resolution = [150, 100]
[material.grey]
diffuse = [0.7, 0.7, 0.7]
[[shape]]
type = "polygon"
material = "grey"
vertices = [[-5, -0.8, 5], [5, -0.8, 5], [5, -0.8, -5], [-5, -0.8, -5]]
[[light]]
type = "point"
position = [1, 3, 4]
intensity = [20, 20, 20]
[[light]]
type = "spot"
position = [2.3, 0, 4]
direction = [0, 0, -1]
intensity = [40, 12, 12]
inner = 5.73
outer = 11.46
[[light]]
type = "directional"
direction = [0, -0.7, -0.71]
irradiance = [0.15, 0.15, 0.5]
)");
  const auto ball = std::make_shared<const MeshGeometry>(smoothBall(24, 48));
  for (const Vec3d& scale : {Vec3d(1.0), Vec3d(-1.0, 0.5, 1.0)}) {
    const glm::dmat4 to = glm::translate(glm::dmat4(1.0), Vec3d(scale.x > 0.0 ? 0.8 : 2.0, 0.0, 0.0));
    ShapeDescription shape;
    shape.geometry = MeshDescription{
        "", areShared ? ball : std::make_shared<const MeshGeometry>(*ball), {}, glm::scale(to, scale)};
    scene.shapes.push_back(std::move(shape));
  }
  return scene;
}

TEST(PictureWithInstances, IsThatOfCopies) {
  const Stage shared(twoBalls(true)), copied(twoBalls(false));
  ASSERT_EQ(shared.scene->instances.size(), 2U);
  ASSERT_TRUE(copied.scene->instances.empty());
  const Parameters parameters = parametersWith({{"preset", "balanced"}});
  const Picture one = picture(shared, parameters), other = picture(copied, parameters);
  EXPECT_EQ(badPixel(one.film), "");
  EXPECT_NEAR(mean(one.film.direct), mean(other.film.direct), 0.005 * mean(other.film.direct));
  EXPECT_NEAR(mean(one.film.indirect), mean(other.film.indirect), 0.03 * mean(other.film.indirect));
}

}  // namespace
}  // namespace lightvane::render_test
