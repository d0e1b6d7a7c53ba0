// Surfaces that are there in part: veils and cut-outs, which camera rays, paths and shadow rays pass alike.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// A floor [-4, 4]² at y = 0 below a camera at y = 5, a point light at y = 2, and what else the test puts
/// there.
std::string veiledFloor(const std::string& rest) {
  return R"(
version = 1
name = "Veils"
[camera]
position = [0.3, 5.0, -0.2]
target = [0.3, 0.0, 0.0]
fov_y = 60.0
resolution = [32, 32]
[texture.squares]
type = "checker"
even = [0.0, 0.0, 0.0]
odd = [1.0, 1.0, 1.0]
[material.floor]
diffuse = [0.5, 0.5, 0.5]
[material.veil]
diffuse = [0.0, 0.0, 0.0]
opacity = 0.25
[material.holes]
diffuse = [0.0, 0.0, 0.0]
opacity = { texture = "squares", scale = 0.0625, cutoff = 0.5 }
[material.linen]
diffuse = [0.8, 0.8, 0.8]
opacity = { texture = "squares", scale = 0.125, value = 0.6 }
[material.lamp]
emission = [10.0, 10.0, 10.0]
[[shape]]
type = "polygon"
material = "floor"
vertices = [[-4.0, 0.0, -4.0], [-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0]]
)" + rest;
}

/// With texture coordinates from 0 to 1, as a polygon of four corners has them.
std::string sheetAt(double y, const char* material) {
  return fmt::format(R"(
[[shape]]
type = "polygon"
material = "{0}"
vertices = [[-4.0, {1}, -4.0], [4.0, {1}, -4.0], [4.0, {1}, 4.0], [-4.0, {1}, 4.0]]
)",
                     material, y);
}

constexpr const char* kBulb = R"(
[[light]]
type = "point"
position = [0.5, 2.0, 0.3]
intensity = [40.0, 40.0, 40.0]
)";
constexpr const char* kLampAbove = R"(
[[shape]]
type = "polygon"
material = "lamp"
vertices = [[-2.0, 6.0, -2.0], [2.0, 6.0, -2.0], [2.0, 6.0, 2.0], [-2.0, 6.0, 2.0]]
)";

class Veils : public testing::TestWithParam<const char*> {
 protected:
  static Film film(const std::string& scene, const char* pathSamples = "1") {
    const Settings settings = {{"method.name", GetParam()}, {"dlv.mode", "never"},
                               {"direct.ambient", "0"},     {"naive.samples", "8"},
                               {"ilv.n_min", "1"},          {"path.samples", pathSamples}};
    return picture(Stage(sceneFromText(scene)), parametersWith(settings)).film;
  }
  /// Paths choose by chance whether they see a veil or what is behind it.
  static bool isByChance() { return std::string(GetParam()) == "path"; }
};

// The bulb is below or above two veils: the light that passes them is known, and no other light is there.
TEST_P(Veils, LetShadowRaysPassByTheirGaps) {
  const Film open = film(veiledFloor(kBulb));
  const Film veiled = film(veiledFloor(kBulb + sheetAt(0.5, "veil") + sheetAt(1.0, "veil")), "256");
  double sum = 0.0, expectedSum = 0.0;
  for (std::size_t i = 0; i < open.direct.size(); ++i) {
    // Once on the light's way, and once on that to the eye.
    const float expected = open.direct[i].x * std::pow(0.75f, 4.0f);
    sum += static_cast<double>(veiled.direct[i].x);
    expectedSum += static_cast<double>(expected);
    if (!isByChance()) {
      ASSERT_NEAR(veiled.direct[i].x, expected, 1e-4f * expected) << i;
    }
    EXPECT_EQ(veiled.specular[i], Rgb(0.0f)) << "no mirror";
  }
  EXPECT_GT(expectedSum, 0.0);
  EXPECT_NEAR(sum, expectedSum, (isByChance() ? 0.01 : 1e-4) * expectedSum);
}

TEST_P(Veils, WithHolesAreThereOrNot) {
  const Film open = film(veiledFloor(kBulb));
  const Film cut = film(veiledFloor(kBulb + sheetAt(3.0, "holes")));
  int seen = 0, hidden = 0;
  for (std::size_t i = 0; i < open.direct.size(); ++i) {
    if (isBlack(cut.direct[i])) {
      ++hidden;
      EXPECT_LT(cut.depth()[i], 0.6f * open.depth()[i]) << "the sheet's";
    } else {
      ++seen;
      ASSERT_NEAR(cut.direct[i].x, open.direct[i].x, 1e-4f * open.direct[i].x);
      EXPECT_NEAR(cut.depth()[i], open.depth()[i], 1e-4f * open.depth()[i]) << "what is behind the hole";
      EXPECT_EQ(cut.albedo()[i], Rgb(0.5f));
    }
  }
  EXPECT_GT(seen, 300);
  EXPECT_GT(hidden, 300);
}

INSTANTIATE_TEST_SUITE_P(Methods, Veils, testing::Values("vectors", "path", "naive", "direct"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

// Paths choose between the threads and the gaps, the others take both: with a lamp that is also met by
// chance.
TEST(Veil, IsTheSameToAllMethods) {
  if (!isFast()) GTEST_SKIP() << "takes its samples";
  const std::string scene = veiledFloor(kLampAbove + sheetAt(1.0, "linen") + R"(
[[shape]]
type = "polygon"
material = "floor"
vertices = [[-4.0, 0.0, 3.0], [-4.0, 3.0, 3.0], [4.0, 3.0, 3.0], [4.0, 0.0, 3.0]]
)");
  const auto meanOf = [&](const Settings& settings) {
    return mean(beauty(picture(Stage(sceneFromText(scene)), parametersWith(settings)).film));
  };
  const double paths = meanOf({{"method.name", "path"}, {"path.samples", "2048"}});
  EXPECT_NEAR(meanOf({{"method.name", "naive"},
                      {"naive.samples", "256"},
                      {"light.samples", "64"},
                      {"film.samples", "4"}}),
              paths, 0.01 * paths);
  EXPECT_NEAR(meanOf({{"preset", "fine"}, {"light.samples", "64"}, {"film.samples", "4"}}), paths,
              0.015 * paths);
}

}  // namespace
}  // namespace lightvane::render_test
