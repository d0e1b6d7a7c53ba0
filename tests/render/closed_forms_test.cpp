// Pictures whose pixels are known on paper.

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"
#include "tests/support/polygon_scene.h"
#include "tests/support/statistics.h"

namespace lightvane::render_test {
namespace {

constexpr double kFloorReflectance = 0.5;

/// A floor [-4, 4]² at y = 0 seen from above, and what else the test puts there.
std::string overAFloor(const std::string& rest) {
  return R"(
version = 1
name = "Floor"
[camera]
position = [0.3, 5.0, -6.0]
target = [0.3, 0.0, 0.0]
fov_y = 30.0
resolution = [48, 48]
[material.floor]
diffuse = [0.5, 0.5, 0.5]
[material.lamp]
emission = [10.0, 10.0, 10.0]
[material.mirror]
mirror = [0.8, 0.8, 0.8]
[[shape]]
type = "polygon"
name = "floor"
material = "floor"
vertices = [[-4.0, 0.0, -4.0], [-4.0, 0.0, 4.0], [4.0, 0.0, 4.0], [4.0, 0.0, -4.0]]
)" + rest;
}

struct FloorPixel {
  std::size_t pixel;
  Vec3d position;  ///< scene units
};

std::vector<FloorPixel> floorPixels(const Stage& stage, const Film& film) {
  std::vector<FloorPixel> pixels;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    if (!(film.depth()[i] < kInfinity) || film.albedo()[i] != Rgb(0.5f)) continue;
    pixels.push_back({i, stage.scene->normalisation.scenePoint(film.position()[i])});
  }
  return pixels;
}

/// One colour of `layer` in scene units against radiance(position), relative, pixel by pixel.
void expectOnFloor(const Stage& stage, const Film& film, const ImageRgb& layer, double relativeTolerance,
                   const std::function<double(const Vec3d&)>& irradiance) {
  const std::vector<FloorPixel> pixels = floorPixels(stage, film);
  ASSERT_GT(pixels.size(), 1000u);
  for (const FloorPixel& p : pixels) {
    const double expected = kFloorReflectance / kPiD * irradiance(p.position);
    const double found = layer[p.pixel].g * static_cast<double>(stage.scene->normalisation.radianceScale());
    ASSERT_NEAR(found, expected, relativeTolerance * expected)
        << fmt::format("floor at ({}, {}, {})", p.position.x, p.position.y, p.position.z);
  }
}

class ClosedForm : public testing::TestWithParam<const char*> {
 protected:
  static Film render(const Stage& stage, const Settings& more = {}) {
    Parameters parameters = parametersWith({{"method.name", GetParam()},
                                            {"dlv.mode", "never"},
                                            {"direct.ambient", "0"},
                                            {"naive.samples", "8"},
                                            {"path.samples", "1"}});
    setParameters(parameters, more);
    return picture(stage, parameters).film;
  }
};

TEST_P(ClosedForm, FloorUnderAPointLight) {
  const Stage stage(sceneFromText(overAFloor(R"(
[[light]]
type = "point"
position = [0.5, 2.0, 0.3]
intensity = [7.0, 7.0, 7.0]
)")));
  const Film film = render(stage);
  // I cos / d². The tolerance is float's: ten roundings of positions of size 1 at distances of 0.3.
  expectOnFloor(stage, film, film.direct, 1e-5, [](const Vec3d& p) {
    const Vec3d toLight = Vec3d(0.5, 2.0, 0.3) - p;
    const double squared = glm::dot(toLight, toLight);
    return 7.0 * toLight.y / (squared * std::sqrt(squared));
  });
  EXPECT_EQ(mean(film.indirect), 0.0);
  EXPECT_EQ(mean(film.specular), 0.0);
}

TEST_P(ClosedForm, FloorUnderASkyOfOneColour) {
  const Stage stage(sceneFromText(overAFloor(R"(
[[light]]
type = "environment"
radiance = [2.0, 2.0, 2.0]
)")));
  // Of the one path of a pixel, roulette would take or double the part that BRDF samples have.
  const Film film = render(stage, {{"path.roulette", "false"}});
  // E = pi L. Nothing hides the sky, and every sample of it by the cosine is the irradiance itself.
  expectOnFloor(stage, film, film.direct, 1e-4, [](const Vec3d&) { return 2.0 * kPiD; });
  EXPECT_EQ(mean(film.indirect), 0.0);
}

TEST_P(ClosedForm, FloorUnderASphere) {
  const Stage stage(sceneFromText(overAFloor(R"(
[[shape]]
type = "sphere"
material = "lamp"
center = [0.5, 2.5, 0.8]
radius = 0.6
)")));
  // With `path`, four paths of a light sample each would leave 5 % noise in a pixel.
  const bool isPath = std::string(GetParam()) == "path";
  const Film film = render(
      stage,
      {{"light.samples", "256"}, {"path.samples", "64"}, {"light.bounce_samples", isPath ? "16" : "1"}});
  // The whole sphere is above the floor's horizon: E = pi L (R/d)² cos. Its solid angle is sampled evenly,
  // so that only the cosine varies, by the sphere's half angle of 0.24 around 1 rad: a standard deviation of
  // 0.2 a sample, less than 0.2 / sqrt(256) = 1.3 % a pixel, far less for strata.
  expectOnFloor(stage, film, film.direct, isPath ? 0.06 : 0.01, [](const Vec3d& p) {
    const Vec3d toLight = Vec3d(0.5, 2.5, 0.8) - p;
    const double squared = glm::dot(toLight, toLight);
    return kPiD * 10.0 * 0.36 / squared * toLight.y / std::sqrt(squared);
  });
}

/// A lamp 1.5 above the floor, from x = 0.2 on, facing down.
DiffusePolygon lamp(double size) {
  const double z = 0.5 * size;
  return {"lamp",
          {{0.2, 1.5, -z}, {0.2 + size, 1.5, -z}, {0.2 + size, 1.5, z}, {0.2, 1.5, z}},
          Vec3d(0.0),
          Vec3d(10.0)};
}
constexpr double kLampSize = 0.8;

std::string shapeText(const DiffusePolygon& polygon, const char* material) {
  std::string text = fmt::format("[[shape]]\ntype = \"polygon\"\nmaterial = \"{}\"\nvertices = [", material);
  for (const Vec3d& v : polygon.vertices) text += fmt::format("[{:.17g}, {:.17g}, {:.17g}], ", v.x, v.y, v.z);
  return text + "]\n";
}

TEST_P(ClosedForm, FloorUnderARectangle) {
  const Stage stage(sceneFromText(overAFloor(shapeText(lamp(kLampSize), "lamp"))));
  const bool isPath = std::string(GetParam()) == "path";
  const Film film = render(
      stage,
      {{"light.samples", "256"}, {"path.samples", "64"}, {"light.bounce_samples", isPath ? "16" : "1"}});
  const PolygonScene oracle({lamp(kLampSize)});
  // Lambert's formula. Noise as for the sphere: only the cosine varies.
  expectOnFloor(stage, film, film.direct, isPath ? 0.06 : 0.01, [&](const Vec3d& p) {
    return oracle.directIrradiance(p, {0.0, 1.0, 0.0}).x;
  });
}

// Interpolated from Direct Light Vectors the same floor is the same within the dispersion they may have, and
// on the average within a tenth of it.
TEST(ClosedFormByVectors, FloorUnderAPointLight) {
  const Stage stage(sceneFromText(overAFloor(R"(
[[light]]
type = "point"
position = [0.5, 6.0, 0.3]
intensity = [7.0, 7.0, 7.0]
)")));
  const Picture p =
      picture(stage, parametersWith({{"dlv.mode", "always"}, {"dlv.seed", "500"}, {"dlv.r_max", "4%"}}));
  EXPECT_GT(p.statistics.interpolatedDirect, 1000u);
  const auto irradiance = [](const Vec3d& at) {
    const Vec3d toLight = Vec3d(0.5, 6.0, 0.3) - at;
    const double squared = glm::dot(toLight, toLight);
    return 7.0 * toLight.y / (squared * std::sqrt(squared));
  };
  const double dispersion = Parameters().vectors.dlv.dispersion;
  expectOnFloor(stage, p.film, p.film.direct, dispersion, irradiance);
  double sum = 0.0, expected = 0.0;
  for (const FloorPixel& pixel : floorPixels(stage, p.film)) {
    sum += p.film.direct[pixel.pixel].g * static_cast<double>(stage.scene->normalisation.radianceScale());
    expected += kFloorReflectance / kPiD * irradiance(pixel.position);
  }
  EXPECT_NEAR(sum / expected, 1.0, 0.1 * dispersion);
}

INSTANTIATE_TEST_SUITE_P(Methods, ClosedForm, testing::Values("vectors", "path", "naive", "direct"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

/// A lamp beside a mirror in the plane x = -0.5, which shows it to all of the floor that can be seen in
/// front: the image's light is the indirect layer, and nothing else is.
SceneDescription mirrorScene(double lampSize) {
  return sceneFromText(overAFloor(shapeText(lamp(lampSize), "lamp") + R"(
[[shape]]
type = "polygon"
material = "mirror"
vertices = [[-0.5, 0.0, -40.0], [-0.5, 40.0, -40.0], [-0.5, 40.0, 40.0], [-0.5, 0.0, 40.0]]
)"));
}
constexpr double kMirror = 0.8;

Vec3d mirrored(const Vec3d& p) { return {-1.0 - p.x, p.y, p.z}; }

PolygonScene mirroredLamp(double size) {
  DiffusePolygon image = lamp(size);
  std::reverse(image.vertices.begin(), image.vertices.end());
  for (Vec3d& v : image.vertices) v = mirrored(v);
  return PolygonScene({image});
}

class MirrorForm : public testing::TestWithParam<const char*> {};

TEST_P(MirrorForm, DoublesTheLight) {
  const Stage stage(mirrorScene(kLampSize));
  const Film film = picture(stage, parametersWith({{"method.name", GetParam()},
                                                   {"dlv.mode", "never"},
                                                   {"light.samples", "256"},
                                                   {"ilv.rows", "4"},
                                                   {"ilv.columns", "8"},
                                                   {"naive.samples", "8"}}))
                        .film;
  const PolygonScene straight({lamp(kLampSize)});
  const PolygonScene image = mirroredLamp(kLampSize);
  const Vec3d up(0.0, 1.0, 0.0);
  const auto direct = [&](const Vec3d& p) { return straight.directIrradiance(p, up).x; };
  const auto indirect = [&](const Vec3d& p) { return kMirror * image.directIrradiance(p, up).x; };
  expectOnFloor(stage, film, film.direct, 0.01, direct);
  expectOnFloor(stage, film, film.indirect, 0.01, indirect);

  // The floor behind the looking glass: what is seen there is the floor's light at the mirrored place.
  const Normalisation& normalisation = stage.scene->normalisation;
  const Vec3d eye = normalisation.scenePoint(stage.camera.position);
  int seen = 0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    if (film.albedo()[i] != Rgb(static_cast<float>(kMirror))) continue;
    const Vec3d onMirror = normalisation.scenePoint(film.position()[i]);
    const Vec3d behind = eye + (onMirror - eye) * (eye.y / (eye.y - onMirror.y));
    const Vec3d onFloor = mirrored(behind);
    if (!(std::abs(onFloor.x) < 3.9 && std::abs(onFloor.z) < 3.9)) continue;
    // The lamp hangs in the way of some.
    const double atLamp = (eye.y - 1.5) / eye.y;
    const Vec3d passing = mirrored(eye + (behind - eye) * atLamp);
    if (passing.x > 0.15 && passing.x < 1.05 && std::abs(passing.z) < 0.45) continue;
    const double expected = kMirror * kFloorReflectance / kPiD * (direct(onFloor) + indirect(onFloor));
    const double found = film.specular[i].g * static_cast<double>(normalisation.radianceScale());
    EXPECT_NEAR(found, expected, 0.01 * expected) << "pixel " << i;
    ++seen;
  }
  EXPECT_GT(seen, 100);
}

INSTANTIATE_TEST_SUITE_P(Methods, MirrorForm, testing::Values("vectors", "naive"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

// Path tracing meets the mirrored lamp by chance only: its picture says the same on the average. The lamp is
// larger, so that chance finds it often enough.
TEST(MirrorFormByChance, HasTheSameMean) {
  constexpr double kLargeLamp = 2.4;
  const Stage stage(mirrorScene(kLargeLamp));
  const PolygonScene image = mirroredLamp(kLargeLamp);
  std::vector<double> blocks;
  double expected = 0.0;
  for (int seed = 1; seed <= 8; ++seed) {
    // One reflection is all there is; roulette would only add noise.
    const Film film = picture(stage, parametersWith({{"method.name", "path"},
                                                     {"path.samples", std::to_string(budget(128, 16))},
                                                     {"path.max_bounces", "1"},
                                                     {"path.roulette", "false"},
                                                     {"seed", std::to_string(seed)}}))
                          .film;
    double sum = 0.0;
    expected = 0.0;
    for (const FloorPixel& p : floorPixels(stage, film)) {
      sum += film.indirect[p.pixel].g * static_cast<double>(stage.scene->normalisation.radianceScale());
      expected += kFloorReflectance / kPiD * kMirror * image.directIrradiance(p.position, {0, 1, 0}).x;
    }
    blocks.push_back(sum);
  }
  const BiasTest test{.tolerance = isFast() ? 0.03 : 0.2, .confidence = 0.99};
  const BiasTest::Result result = test.againstValue(blocks, expected);
  EXPECT_TRUE(result.passes()) << result.explanation;
}

// ---- glass ----

constexpr double kIor = 1.5;

/// Fresnel's reflectance for unpolarised light from outside, by the angles (Born & Wolf, section 1.5.2).
double fresnel(double cosIncident, double ior) {
  const double sinTransmitted = std::sqrt(1.0 - cosIncident * cosIncident) / ior;
  const double cosTransmitted = std::sqrt(1.0 - sinTransmitted * sinTransmitted);
  const double parallel = (ior * cosIncident - cosTransmitted) / (ior * cosIncident + cosTransmitted);
  const double perpendicular = (cosIncident - ior * cosTransmitted) / (cosIncident + ior * cosTransmitted);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// Snell's law: the direction behind a surface with unit `normal` against `direction`; eta is the index in
/// front over that behind.
std::optional<Vec3d> refracted(const Vec3d& direction, const Vec3d& normal, double eta) {
  const double cosine = -glm::dot(direction, normal);
  const double squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
  if (squared < 0.0) return std::nullopt;
  return glm::normalize(eta * direction + (eta * cosine - std::sqrt(squared)) * normal);
}

/// The centre of a pixel's ray, in double from the description itself.
Vec3d pixelDirection(const CameraDescription& camera, int x, int y) {
  const Vec3d forward = glm::normalize(camera.target - camera.position);
  const Vec3d right = glm::normalize(glm::cross(forward, camera.up));
  const Vec3d up = glm::cross(right, forward);
  const double tangent = std::tan(camera.fovYDegrees * kPiD / 360.0);
  const double aspect = static_cast<double>(camera.width) / camera.height;
  const double u = (2.0 * (x + 0.5) / camera.width - 1.0) * tangent * aspect;
  const double v = (1.0 - 2.0 * (y + 0.5) / camera.height) * tangent;
  return glm::normalize(forward + u * right + v * up);
}

/// In the plane z = 6 everything at x > 0.35 shines with radiance 1: an edge to look at.
std::string beforeAnEdge(const std::string& glass) {
  return R"(
version = 1
name = "Edge"
[camera]
position = [0.1, 0.05, 0.0]
target = [0.2, 0.1, 6.0]
fov_y = 22.0
resolution = [64, 48]
[material.glass]
transmission = [1.0, 1.0, 1.0]
ior = 1.5
[material.lamp]
emission = [1.0, 1.0, 1.0]
two_sided = true
[[shape]]
type = "polygon"
material = "lamp"
vertices = [[0.35, -30.0, 6.0], [0.35, 30.0, 6.0], [60.0, 30.0, 6.0], [60.0, -30.0, 6.0]]
)" + glass;
}

/// Where a ray goes through glass: it leaves from `origin` in `direction`, having lost what was reflected.
struct Through {
  Vec3d origin, direction;
  double transmitted;
};

/// Compares the picture with where straight rays, bent by `throughGlass`, meet the edge's plane.
void expectEdge(const std::string& text, const char* method,
                const std::function<std::optional<Through>(const Vec3d&, const Vec3d&)>& throughGlass) {
  const SceneDescription description = sceneFromText(text);
  const Stage stage(description);
  const Film film =
      picture(stage,
              parametersWith({{"method.name", method}, {"path.samples", "256"}, {"specular.cutoff", "0"}}))
          .film;
  const CameraDescription& camera = description.cameras.front();
  int compared = 0, bent = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vec3d direction = pixelDirection(camera, x, y);
      const std::optional<Through> out = throughGlass(camera.position, direction);
      if (!out || out->direction.z <= 0.0) continue;
      const double atPlane = out->origin.x + out->direction.x * (6.0 - out->origin.z) / out->direction.z;
      const double straight = camera.position.x + direction.x * 6.0 / direction.z;
      // Float may put a ray on the other side of the edge within some of its roundings.
      if (std::abs(atPlane - 0.35) < 1e-4) continue;
      const bool shines = atPlane > 0.35;
      const double found =
          film.specular.at(x, y).g * static_cast<double>(stage.scene->normalisation.radianceScale());
      // What is reflected within the glass adds a little where the main ray misses the lamp, and a dark
      // branch takes nothing away: bright and dark are far apart.
      EXPECT_EQ(found > 0.5 * out->transmitted, shines)
          << fmt::format("pixel ({}, {}): radiance {}, meets the plane at x = {}", x, y, found, atPlane);
      ++compared;
      bent += shines != (straight > 0.35);
    }
  }
  EXPECT_GT(compared, 200);
  // Unbent rays would be told from bent ones.
  EXPECT_GT(bent, 20);
}

class Glass : public testing::TestWithParam<const char*> {};

// A slab 1.5 thick, turned by 40 degrees: it moves rays sideways and leaves their direction.
TEST_P(Glass, SlabMovesTheEdge) {
  const double angle = 40.0 * kPiD / 180.0;
  const Vec3d normal = -Vec3d(std::sin(angle), 0.0, std::cos(angle));
  expectEdge(beforeAnEdge(R"(
[[shape]]
type = "box"
material = "glass"
min = [-20.0, -20.0, -0.75]
max = [20.0, 20.0, 0.75]
[shape.transform]
rotate = [0.0, 40.0, 0.0]
translate = [0.0, 0.0, 3.0]
)"),
             GetParam(), [&](const Vec3d& eye, const Vec3d& direction) -> std::optional<Through> {
               const Vec3d front = Vec3d(0.0, 0.0, 3.0) + 0.75 * normal;
               const double t = glm::dot(front - eye, normal) / glm::dot(direction, normal);
               const Vec3d entry = eye + t * direction;
               const std::optional<Vec3d> inside = refracted(direction, normal, 1.0 / kIor);
               const Vec3d exit = entry + *inside * (1.5 / -glm::dot(*inside, normal));
               const double f = fresnel(-glm::dot(direction, normal), kIor);
               return Through{exit, direction, square(1.0 - f)};
             });
}

TEST_P(Glass, BallBendsAsSnellSays) {
  const Vec3d center(0.3, 0.0, 3.0);
  constexpr double kRadius = 0.5;
  expectEdge(beforeAnEdge(R"(
[[shape]]
type = "sphere"
material = "glass"
center = [0.3, 0.0, 3.0]
radius = 0.5
)"),
             GetParam(), [&](const Vec3d& eye, const Vec3d& direction) -> std::optional<Through> {
               const Vec3d toCenter = center - eye;
               const double middle = glm::dot(toCenter, direction);
               const double missSquared = glm::dot(toCenter, toCenter) - middle * middle;
               // Grazing rays lose most of their light by reflection: left to the slab.
               if (missSquared > square(0.85 * kRadius)) return std::nullopt;
               const Vec3d entry = eye + direction * (middle - std::sqrt(square(kRadius) - missSquared));
               const Vec3d normal = (entry - center) / kRadius;
               const std::optional<Vec3d> inside = refracted(direction, normal, 1.0 / kIor);
               const Vec3d exit = entry - *inside * (2.0 * glm::dot(entry - center, *inside));
               const std::optional<Vec3d> out = refracted(*inside, (center - exit) / kRadius, kIor);
               if (!out) return std::nullopt;
               const double f = fresnel(-glm::dot(direction, normal), kIor);
               return Through{exit, *out, square(1.0 - f)};
             });
}

// One surface of glass with nothing behind: what it shows of a lamp all around above is Fresnel's part.
TEST_P(Glass, ReflectsFresnelsPart) {
  const SceneDescription description = sceneFromText(R"(
version = 1
name = "Fresnel"
[camera]
position = [0.0, 1.0, 0.0]
target = [0.0, 0.0, 2.0]
fov_y = 50.0
resolution = [32, 32]
[material.glass]
transmission = [1.0, 1.0, 1.0]
ior = 1.5
[material.lamp]
emission = [1.0, 1.0, 1.0]
[[shape]]
type = "polygon"
material = "glass"
vertices = [[-50.0, 0.0, -1.0], [-50.0, 0.0, 99.0], [50.0, 0.0, 99.0], [50.0, 0.0, -1.0]]
[[shape]]
type = "polygon"
material = "lamp"
vertices = [[-5000.0, 8.0, -5000.0], [5000.0, 8.0, -5000.0], [5000.0, 8.0, 5000.0], [-5000.0, 8.0, 5000.0]]
)");
  const Stage stage(description);
  constexpr int kPaths = 256;
  const Film film = picture(stage, parametersWith({{"method.name", GetParam()},
                                                   {"path.samples", std::to_string(kPaths)},
                                                   {"specular.cutoff", "0"}}))
                        .film;
  const CameraDescription& camera = description.cameras.front();
  const bool isPath = std::string(GetParam()) == "path";
  double sum = 0.0, expectedSum = 0.0, variance = 0.0;
  int compared = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vec3d direction = pixelDirection(camera, x, y);
      if (!(direction.y < -0.02)) continue;
      const double expected = fresnel(-direction.y, kIor);
      const double found =
          film.specular.at(x, y).g * static_cast<double>(stage.scene->normalisation.radianceScale());
      // Paths choose between reflection and refraction by F itself: binomial. All others follow both.
      if (!isPath) {
        EXPECT_NEAR(found, expected, 1e-4 * expected) << "cos = " << -direction.y;
      }
      sum += found;
      expectedSum += expected;
      variance += expected * (1.0 - expected) / kPaths;
      ++compared;
    }
  }
  EXPECT_GT(compared, 500);
  EXPECT_NEAR(sum, expectedSum, isPath ? 4.0 * std::sqrt(variance) : 1e-5 * expectedSum)
      << "four standard deviations of a binomial choice, or rounding";
}

INSTANTIATE_TEST_SUITE_P(Methods, Glass, testing::Values("vectors", "path", "naive", "direct"),
                         [](const testing::TestParamInfo<const char*>& method) {
                           return std::string(method.param);
                         });

}  // namespace
}  // namespace lightvane::render_test
