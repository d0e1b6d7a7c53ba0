// What cameras other than a pinhole show, against what is known on paper.

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// Where the light of a layer is: its sum, its middle, and the variances about that, in pixels.
struct Spot {
  double sum = 0.0;
  glm::dvec2 middle{0.0};
  glm::dvec2 variance{0.0};
  double reach = 0.0;  ///< from the middle to the farthest pixel with light
};

Spot spotOf(const ImageRgb& layer) {
  Spot spot;
  const auto forEachPixel = [&](const auto& visit) {
    for (int y = 0; y < layer.height(); ++y) {
      for (int x = 0; x < layer.width(); ++x) {
        const auto light = static_cast<double>(layer.at(x, y).g);
        if (light > 0.0) visit(glm::dvec2(x + 0.5, y + 0.5), light);
      }
    }
  };
  forEachPixel([&](const glm::dvec2& at, double light) {
    spot.sum += light;
    spot.middle += light * at;
  });
  spot.middle /= spot.sum;
  forEachPixel([&](const glm::dvec2& at, double light) {
    spot.variance += light * (at - spot.middle) * (at - spot.middle);
    spot.reach = std::max(spot.reach, glm::length(at - spot.middle));
  });
  spot.variance /= spot.sum;
  return spot;
}

constexpr double kDistance = 4.0;    // from the camera to the lamp
constexpr double kLampRadius = 0.1;  // a disc that faces the camera
constexpr double kFovY = 30.0;
constexpr int kPixels = 64;
constexpr double kLampRadiance = 2.0;

/// A lamp, a little off the axis, before nothing; and what the camera has beside its place.
Stage lampSeenBy(const std::string& camera) {
  return Stage(sceneFromText(fmt::format(R"(
version = 1
[camera]
position = [0.0, 0.0, {}]
{}
resolution = [{}, {}]
[material.lamp]
emission = [{}, {}, {}]
[[shape]]
type = "disc"
material = "lamp"
center = [0.12, 0.07, 0.0]
normal = [0.0, 0.0, 1.0]
radius = {}
)",
                                         kDistance, camera, kPixels, kPixels, kLampRadiance, kLampRadiance,
                                         kLampRadiance, kLampRadius)));
}

/// Pixels for a length across the view, at a distance.
double pixelsAt(double distance) { return kPixels / (2.0 * std::tan(kFovY * kPiD / 360.0) * distance); }

struct Focus {
  double lensRadius;
  double distance;
};
void PrintTo(const Focus& focus, std::ostream* out) {
  *out << "a lens of " << focus.lensRadius << " focused at " << focus.distance;
}

class LensBlur : public testing::TestWithParam<Focus> {};

// The rays from a point at distance d by way of a lens of radius r cross the plane of focus, at distance f,
// within r |d - f| / d: as many pixels as that is wide there. The lamp's picture is its sharp picture, a
// disc, convolved with the disc of a point: their second moments add.
TEST_P(LensBlur, IsTheCircleOfConfusion) {
  if (!isFast()) GTEST_SKIP() << "needs its samples";
  const Focus focus = GetParam();
  constexpr int kSamples = 512;
  const Stage stage = lampSeenBy(fmt::format("fov_y = {}\nlens_radius = {}\nfocus_distance = {}", kFovY,
                                             focus.lensRadius, focus.distance));
  const Film film =
      picture(stage, parametersWith({{"method.name", "direct"}, {"film.samples", std::to_string(kSamples)}}))
          .film;
  const Spot spot = spotOf(film.emission);
  const double confusion =
      focus.lensRadius * std::abs(kDistance - focus.distance) / kDistance * pixelsAt(focus.distance);
  const double lamp = kLampRadius * pixelsAt(kDistance);
  // An even disc of radius R has a variance of R² / 4 along each axis. A pixel adds that of its square.
  const double expected = 0.25 * (square(confusion) + square(lamp)) + 1.0 / 12.0;
  // n rays meet the lamp. Were they independent, the variance of such a spot, whose fourth moment is
  // below 2.4 of its squared second, would have a relative standard error of sqrt(1.4 / n); three of them.
  // Samples are spread more evenly, but a spot of some pixels is not even over each of them.
  const double n = kPiD * square(lamp) * kSamples;
  const double tolerance = 3.0 * std::sqrt(1.4 / n);
  ASSERT_LT(tolerance, 0.04);
  EXPECT_NEAR(spot.variance.x, expected, tolerance * expected);
  EXPECT_NEAR(spot.variance.y, expected, tolerance * expected);
  EXPECT_LT(spot.reach, confusion + lamp + 1.5);
  EXPECT_GT(spot.reach, confusion + lamp - 1.5);
  const glm::dvec2 middle(0.5 * kPixels + 0.12 * pixelsAt(kDistance),
                          0.5 * kPixels - 0.07 * pixelsAt(kDistance));
  EXPECT_NEAR(spot.middle.x, middle.x, 3.0 * std::sqrt(expected / n));
  EXPECT_NEAR(spot.middle.y, middle.y, 3.0 * std::sqrt(expected / n));
  // A blur takes no light away and brings none.
  const double light = kPiD * square(lamp) * kLampRadiance;
  const double unit = static_cast<double>(stage.scene->normalisation.radianceScale());
  EXPECT_NEAR(unit * spot.sum, light, 3.0 / std::sqrt(n) * light);
}

INSTANTIATE_TEST_SUITE_P(Lenses, LensBlur,
                         testing::Values(Focus{0.3, 2.5}, Focus{0.3, 8.0}, Focus{0.6, 3.2}, Focus{0.3, 4.0}));

// One sample a pixel sees the lamp sharp where it is in focus, whatever place on the lens it looks through.
TEST(Lens, IsSharpInItsFocus) {
  const Settings settings = {{"method.name", "direct"}};
  const std::string fov = fmt::format("fov_y = {}", kFovY);
  const Film sharp = picture(lampSeenBy(fov), parametersWith(settings)).film;
  const Film focused =
      picture(lampSeenBy(fov + "\nlens_radius = 0.5\nfocus_distance = 4.0"), parametersWith(settings)).film;
  EXPECT_GT(mean(sharp.emission), 0.0);
  for (std::size_t i = 0; i < sharp.emission.size(); ++i)
    EXPECT_EQ(focused.emission[i], sharp.emission[i]) << "pixel " << i;
}

TEST(Lens, FocusesOnTheTargetUnlessToldOtherwise) {
  const Settings settings = {{"method.name", "direct"}, {"film.samples", "4"}};
  const auto render = [&](const char* camera) {
    return picture(lampSeenBy(camera), parametersWith(settings)).film;
  };
  const Film onTarget = render("target = [0, 0, 1]\nlens_radius = 0.3");
  EXPECT_EQ(difference(onTarget, render("target = [0, 0, 1]\nlens_radius = 0.3\nfocus_distance = 3.0")), "");
  EXPECT_NE(difference(onTarget, render("target = [0, 0, 0]\nlens_radius = 0.3")), "");
}

// A shape is as large on the picture wherever it is.
TEST(OrthographicPicture, ShowsEverythingAtOneScale) {
  for (const char* position : {"", "target = [0.0, 0.0, 3.9]"}) {
    const Stage stage = lampSeenBy(fmt::format("projection = \"orthographic\"\nheight = 0.8\n{}", position));
    const Film film =
        picture(stage, parametersWith({{"method.name", "direct"}, {"film.samples", "64"}})).film;
    const Spot spot = spotOf(film.emission);
    const double pixels = kPixels / 0.8;
    const double expected = 0.25 * square(kLampRadius * pixels) + 1.0 / 12.0;
    EXPECT_NEAR(spot.variance.x, expected, 0.01 * expected);
    EXPECT_NEAR(spot.variance.y, expected, 0.01 * expected);
    EXPECT_NEAR(spot.middle.x, 0.5 * kPixels + 0.12 * pixels, 0.05);
    EXPECT_NEAR(spot.middle.y, 0.5 * kPixels - 0.07 * pixels, 0.05);
  }
}

// All methods see the same direct light by way of a lens and in an orthographic picture, point for point.
TEST(CameraKinds, AreTheSameForAllMethods) {
  for (const bool isOrthographic : {false, true}) {
    SceneDescription description = shippedScene("cornell.toml", 32, 32);
    CameraDescription& camera = description.cameras.front();
    if (isOrthographic) {
      camera.projection = Projection::Orthographic;
      camera.orthographicHeight = 0.6;
    } else {
      camera.lensRadius = 0.05;
    }
    const Stage stage(description);
    const auto render = [&](const Settings& settings) {
      Parameters parameters = parametersWith({{"film.samples", "4"}, {"preset", "draft"}});
      setParameters(parameters, settings);
      return picture(stage, parameters).film;
    };
    const Film path = render({{"method.name", "path"}, {"path.samples", "4"}});
    for (const Settings& settings :
         {Settings{{"method.name", "vectors"}}, Settings{{"method.name", "naive"}, {"naive.samples", "8"}},
          Settings{{"method.name", "direct"}}, Settings{{"method.rules", "printed"}}}) {
      const Film film = render(settings);
      for (std::size_t i = 0; i < film.emission.size(); ++i) {
        // Sums over the same four rays, in another order.
        ASSERT_NEAR(film.emission[i].g, path.emission[i].g, 1e-6f) << settings.front().second << " " << i;
        ASSERT_EQ(film.albedo()[i], path.albedo()[i]) << settings.front().second << " " << i;
      }
    }
  }
}

}  // namespace
}  // namespace lightvane::render_test
