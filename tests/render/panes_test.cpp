// Thin panes: glass without thickness, which shadow rays pass.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// A floor [-4, 4]² at y = 0, seen from above, and what else the test puts there.
std::string floorWith(const std::string& rest) {
  return R"(
version = 1
name = "Panes"
[camera]
position = [0.3, 3.0, -6.0]
target = [0.3, 0.0, 0.0]
fov_y = 30.0
resolution = [32, 32]
[material.floor]
diffuse = [0.5, 0.5, 0.5]
[material.lamp]
emission = [10.0, 10.0, 10.0]
[material.pane]
transmission = [0.9, 0.8, 0.7]
ior = 1.5
thin = true
[material.slab]
transmission = [1.0, 1.0, 1.0]
ior = 1.5
[material.clear]
transmission = [1.0, 1.0, 1.0]
ior = 1.5
thin = true
[[shape]]
type = "polygon"
material = "floor"
vertices = [[-4.0, 0.0, -4.0], [-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0]]
)" + rest;
}

/// Between the camera's height and the lamps'.
std::string paneAt(double y, const char* material = "pane") {
  return fmt::format(R"(
[[shape]]
type = "polygon"
material = "{0}"
vertices = [[-30.0, {1}, -30.0], [-30.0, {1}, 30.0], [30.0, {1}, 30.0], [30.0, {1}, -30.0]]
)",
                     material, y);
}

constexpr const char* kPoint = R"(
[[light]]
type = "point"
position = [0.5, 6.0, 0.3]
intensity = [40.0, 40.0, 40.0]
)";
constexpr const char* kLamp = R"(
[[shape]]
type = "polygon"
material = "lamp"
vertices = [[-3.0, 6.0, -3.0], [3.0, 6.0, -3.0], [3.0, 6.0, 3.0], [-3.0, 6.0, 3.0]]
)";

/// What a pane of index 1.5 reflects: both faces, and all that goes to and fro between them, as a sum.
double reflectanceOfPane(double cosine) {
  const double sinInside = std::sqrt(1.0 - cosine * cosine) / 1.5;
  const double cosInside = std::sqrt(1.0 - sinInside * sinInside);
  const double parallel = (1.5 * cosine - cosInside) / (1.5 * cosine + cosInside);
  const double perpendicular = (cosine - 1.5 * cosInside) / (cosine + 1.5 * cosInside);
  const double face = 0.5 * (parallel * parallel + perpendicular * perpendicular);
  double reflected = face, inside = (1.0 - face) * face;
  for (int i = 0; i < 100; ++i) {
    reflected += inside * (1.0 - face);
    inside *= face * face;
  }
  return reflected;
}

class Panes : public testing::TestWithParam<const char*> {
 protected:
  static Settings settings() {
    return {{"method.name", GetParam()},
            {"dlv.mode", "never"},
            {"direct.ambient", "0"},
            {"naive.samples", "8"},
            {"path.samples", "1"}};
  }
};

TEST_P(Panes, LetShadowRaysPassByFresnelsFormula) {
  const Stage stage(sceneFromText(floorWith(kPoint + paneAt(4.0) + paneAt(5.0))));
  const Film film = picture(stage, parametersWith(settings())).film;
  int compared = 0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    if (film.albedo()[i] != Rgb(0.5f)) continue;
    const Vec3d p = stage.scene->normalisation.scenePoint(film.position()[i]);
    const Vec3d toLight = Vec3d(0.5, 6.0, 0.3) - p;
    const double distance = glm::length(toLight);
    const double cosine = toLight.y / distance;
    const double passed = 1.0 - reflectanceOfPane(cosine);
    const glm::dvec3 color(0.9, 0.8, 0.7);
    for (int c = 0; c < 3; ++c) {
      const double expected =
          0.5 / kPiD * 40.0 * cosine / (distance * distance) * std::pow(passed * color[c], 2.0);
      const double found = static_cast<double>(film.direct[i][c]) *
                           static_cast<double>(stage.scene->normalisation.radianceScale());
      ASSERT_NEAR(found, expected, 2e-5 * expected) << p.x << " " << p.z << " colour " << c;
    }
    ++compared;
  }
  EXPECT_GT(compared, 500);
}

INSTANTIATE_TEST_SUITE_P(Methods, Panes, testing::Values("vectors", "path", "naive", "direct"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

double meanOfBeauty(const std::string& scene, const Settings& settings) {
  return mean(beauty(picture(Stage(sceneFromText(scene)), parametersWith(settings)).film));
}

// Paths meet the lamp behind the pane by shadow rays and by chance, with the weights of both: it would count
// twice, or in part, if one of the two did not know of the pane.
TEST(ThinPane, PathsAndGathersSeeTheSameLampThroughIt) {
  if (!isFast()) GTEST_SKIP() << "takes its samples";
  const std::string scene = floorWith(kLamp + paneAt(4.0, "clear"));
  const double paths = meanOfBeauty(scene, {{"method.name", "path"}, {"path.samples", "1024"}});
  const double shadowRays = meanOfBeauty(
      scene,
      {{"method.name", "naive"}, {"naive.samples", "256"}, {"light.samples", "256"}, {"film.samples", "4"}});
  EXPECT_NEAR(paths, shadowRays, 0.005 * shadowRays);
  const double open = meanOfBeauty(floorWith(kLamp), {{"method.name", "path"}, {"path.samples", "256"}});
  EXPECT_LT(paths, 0.95 * open);
}

// A real slab of glass, a millimetre thick, through which light is found by chance alone.
TEST(ThinPane, IsASlabOfNoThickness) {
  if (!isFast()) GTEST_SKIP() << "takes its samples";
  const Settings settings = {{"method.name", "path"}, {"path.samples", "2048"}, {"specular.depth", "32"}};
  const double thin = meanOfBeauty(floorWith(kLamp + paneAt(4.0, "clear")), settings);
  const double slab = meanOfBeauty(floorWith(std::string(kLamp) + R"(
[[shape]]
type = "box"
material = "slab"
min = [-30.0, 4.0, -30.0]
max = [30.0, 4.001, 30.0]
)"),
                                   settings);
  EXPECT_NEAR(thin, slab, 0.01 * slab);
}

TEST(ThinPane, LetsVectorsSeeTheLightBehindIt) {
  if (!isFast()) GTEST_SKIP() << "takes its samples";
  // A wall that the lamp reaches through the pane lights the floor in front of it.
  const std::string scene = floorWith(kLamp + paneAt(4.0, "clear") + R"(
[[shape]]
type = "polygon"
material = "floor"
vertices = [[-4.0, 0.0, 3.0], [-4.0, 3.0, 3.0], [4.0, 3.0, 3.0], [4.0, 0.0, 3.0]]
)");
  const double paths = meanOfBeauty(scene, {{"method.name", "path"}, {"path.samples", "1024"}});
  for (const char* mode : {"never", "always"}) {
    const double vectors =
        meanOfBeauty(scene, {{"preset", "fine"}, {"dlv.mode", mode}, {"light.samples", "64"}});
    EXPECT_NEAR(vectors, paths, 0.015 * paths) << mode;
  }
}

}  // namespace
}  // namespace lightvane::render_test
