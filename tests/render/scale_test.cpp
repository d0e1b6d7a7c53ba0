// Geometry and radiance are normalised by powers of two: scaling a scene by one changes no bit of what is
// computed.

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

// Every kind of shape, of light and of material, in decimetres.
constexpr std::string_view kEverything = R"(
version = 1
name = "Everything"
units = "decimetre"
[camera]
position = [1.3, 6.1, -17.0]
target = [0.4, 3.0, 2.0]
fov_y = 45.0
resolution = [40, 40]
[material.wall]
diffuse = [0.7, 0.5, 0.3]
[material.brass]
layers = [{ color = [0.8, 0.6, 0.3], roughness = 0.3 }]
[material.mirror]
mirror = [0.9, 0.9, 0.9]
[material.glass]
transmission = [1.0, 1.0, 1.0]
ior = 1.5
[material.lamp]
emission = [3.0, 2.5, 2.0]
[material.neon]
emission = [0.3, 0.1, 0.6]
two_sided = true
[[shape]]
type = "polygon"
material = "wall"
vertices = [[-9.3, 0.0, -6.1], [-9.3, 0.0, 9.7], [9.1, 0.0, 9.7], [9.1, 0.0, -6.1]]
[[shape]]
type = "polygon"
material = "wall"
vertices = [[-9.3, 0.0, 9.7], [-9.3, 11.0, 9.7], [9.1, 11.0, 9.7], [9.1, 0.0, 9.7]]
[[shape]]
type = "polygon"
material = "mirror"
vertices = [[-9.0, 0.1, -5.0], [-9.0, 8.0, -5.0], [-9.0, 8.0, 8.0], [-9.0, 0.1, 8.0]]
[[shape]]
type = "polygon"
material = "lamp"
vertices = [[-2.0, 9.0, 1.0], [1.0, 9.0, 1.0], [1.0, 9.0, 4.0], [-2.0, 9.0, 4.0]]
[[shape]]
type = "sphere"
material = "brass"
center = [4.0, 2.1, 4.0]
radius = 2.0
[[shape]]
type = "sphere"
material = "glass"
center = [-1.0, 2.1, -1.0]
radius = 1.7
[[shape]]
type = "sphere"
material = "neon"
center = [-5.0, 6.5, 6.0]
radius = 0.4
[[shape]]
type = "box"
material = "wall"
min = [-6.0, 0.0, 2.0]
max = [-3.1, 3.3, 5.0]
transform = { rotate = [0.0, 20.0, 0.0] }
[[shape]]
type = "disc"
material = "neon"
center = [6.5, 5.0, 7.0]
normal = [-0.3, 0.1, -1.0]
radius = 0.8
[[light]]
type = "point"
position = [5.0, 7.0, -3.0]
intensity = [20.0, 30.0, 40.0]
[[light]]
type = "spot"
position = [-4.0, 8.0, -4.0]
direction = [4.0, -8.0, 6.0]
intensity = [90.0, 60.0, 30.0]
inner = 10.0
outer = 25.0
[[light]]
type = "sphere"
center = [2.0, 6.0, 0.0]
radius = 0.5
intensity = [10.0, 10.0, 20.0]
points = 8
)";

SceneDescription sceneOf(const std::string& name) {
  return name == "everything" ? sceneFromText(kEverything) : shippedScene(name, 40, 40);
}

/// All lengths times 2^exponent; the intensity of lights without an extent goes with its square, so that
/// they give the same irradiance.
SceneDescription scaled(SceneDescription scene, int exponent) {
  const auto length = [&](double& v) { v = std::ldexp(v, exponent); };
  const auto vector = [&](Vec3d& v) {
    for (int axis = 0; axis < 3; ++axis) length(v[axis]);
  };
  const auto intensity = [&](Rgb& v) {
    for (int c = 0; c < 3; ++c) v[c] = std::ldexp(v[c], 2 * exponent);
  };
  for (CameraDescription& camera : scene.cameras) {
    vector(camera.position);
    vector(camera.target);
  }
  for (ShapeDescription& shape : scene.shapes) {
    vector(shape.transform.translate);
    if (auto* polygon = std::get_if<PolygonDescription>(&shape.geometry)) {
      for (Vec3d& v : polygon->vertices) vector(v);
    } else if (auto* sphere = std::get_if<SphereDescription>(&shape.geometry)) {
      vector(sphere->center);
      length(sphere->radius);
    } else if (auto* box = std::get_if<BoxDescription>(&shape.geometry)) {
      vector(box->min);
      vector(box->max);
    } else if (auto* disc = std::get_if<DiscDescription>(&shape.geometry)) {
      vector(disc->center);
      length(disc->radius);
    } else {
      auto& mesh = std::get<MeshDescription>(shape.geometry);
      MeshGeometry scaled = *mesh.geometry;
      for (Vec3d& v : scaled.positions) vector(v);
      mesh.geometry = std::make_shared<const MeshGeometry>(std::move(scaled));
    }
  }
  for (LightDescription& light : scene.lights) {
    if (auto* point = std::get_if<PointLightDescription>(&light.geometry)) {
      vector(point->position);
      intensity(point->intensity);
    } else if (auto* spot = std::get_if<SpotLightDescription>(&light.geometry)) {
      vector(spot->position);
      intensity(spot->intensity);
    } else if (auto* volumic = std::get_if<VolumicSphereLightDescription>(&light.geometry)) {
      vector(volumic->center);
      length(volumic->radius);
      intensity(volumic->intensity);
    }
  }
  return scene;
}

SceneDescription brightened(SceneDescription scene, int exponent) {
  const auto scale = [&](Rgb& v) {
    for (int c = 0; c < 3; ++c) v[c] = std::ldexp(v[c], exponent);
  };
  for (MaterialDescription& material : scene.materials) scale(material.emission);
  for (LightDescription& light : scene.lights) {
    if (auto* point = std::get_if<PointLightDescription>(&light.geometry)) scale(point->intensity);
    if (auto* spot = std::get_if<SpotLightDescription>(&light.geometry)) scale(spot->intensity);
    if (auto* volumic = std::get_if<VolumicSphereLightDescription>(&light.geometry))
      scale(volumic->intensity);
    if (auto* sun = std::get_if<DirectionalLightDescription>(&light.geometry)) scale(sun->irradiance);
    if (auto* sky = std::get_if<EnvironmentLightDescription>(&light.geometry)) scale(sky->radiance);
  }
  return scene;
}

LayeredImage imageOf(const SceneDescription& scene, const Settings& settings) {
  const Stage stage(scene);
  return picture(stage, parametersWith(settings)).film.toLayers(*stage.scene);
}

bool isLength(const std::string& channel) { return channel == "Z" || channel.starts_with("P."); }
bool isRadiance(const std::string& channel) {
  return channel.size() == 1 ? channel == "R" || channel == "G" || channel == "B"
                             : channel.starts_with("emission.") || channel.starts_with("direct.") ||
                                   channel.starts_with("indirect.") || channel.starts_with("specular.") ||
                                   channel.starts_with("standard_error.");
}

/// Every channel of `b` is that of `a`, times 2^lengths or 2^radiances where it is a length or a radiance.
void expectScaled(const LayeredImage& a, const LayeredImage& b, int lengths, int radiances) {
  for (const auto& [name, channel] : a.channels) {
    const int exponent = isLength(name) ? lengths : isRadiance(name) ? radiances : 0;
    const ImageFloat& other = b.channels.at(name);
    for (std::size_t i = 0; i < channel.size(); ++i) {
      ASSERT_EQ(std::ldexp(channel[i], exponent), other[i])
          << name << " at pixel (" << i % static_cast<std::size_t>(a.width) << ", "
          << i / static_cast<std::size_t>(a.width) << "), times 2^" << exponent;
    }
  }
  EXPECT_EQ(a.uintChannels, b.uintChannels);
}

class Scale : public testing::TestWithParam<Way> {};

TEST_P(Scale, OfLengthsChangesLengthsOnly) {
  const SceneDescription scene = sceneOf(GetParam().scene);
  const LayeredImage one = imageOf(scene, GetParam().settings);
  for (const int exponent : {-20, -10, 10, 20}) {
    SCOPED_TRACE(fmt::format("lengths times 2^{}", exponent));
    expectScaled(one, imageOf(scaled(scene, exponent), GetParam().settings), exponent, 0);
  }
}

TEST_P(Scale, OfRadianceChangesRadianceOnly) {
  const SceneDescription scene = sceneOf(GetParam().scene);
  const LayeredImage one = imageOf(scene, GetParam().settings);
  for (const int exponent : {-40, 40}) {
    SCOPED_TRACE(fmt::format("radiance times 2^{}", exponent));
    expectScaled(one, imageOf(brightened(scene, exponent), GetParam().settings), 0, exponent);
  }
}

const Settings kDraft = {{"preset", "draft"}};
const Settings kDraftWithDlvs = {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}};

INSTANTIATE_TEST_SUITE_P(
    Ways, Scale,
    testing::Values(
        Way{"cornell_mirror", "cornell-mirror.toml", kDraft},
        Way{"cornell_glossy_dlv", "cornell-glossy.toml", kDraftWithDlvs},
        Way{"everything", "everything", kDraftWithDlvs},
        Way{"everything_path", "everything", {{"method.name", "path"}, {"path.samples", "8"}}},
        Way{"everything_naive", "everything", {{"method.name", "naive"}, {"naive.samples", "16"}}},
        Way{"everything_direct", "everything", {{"method.name", "direct"}}}),
    [](const testing::TestParamInfo<Way>& way) { return way.param.name; });

// The paper's r_max is in metres: it has to be scaled like the scene.
TEST(ScaleOfPaperRules, ChangesNothingWhereTheRadiusGoesWithIt) {
  const SceneDescription scene = sceneOf("cornell-mirror.toml");
  const auto settings = [](int exponent) {
    return Settings{{"preset", "draft"},
                    {"method.rules", "paper"},
                    {"dlv.mode", "always"},
                    {"dlv.seed", "300"},
                    {"dlv.r_max", fmt::format("{:.17g}m", std::ldexp(0.08, exponent))}};
  };
  const LayeredImage one = imageOf(scene, settings(0));
  for (const int exponent : {-10, 10}) {
    SCOPED_TRACE(fmt::format("lengths times 2^{}", exponent));
    expectScaled(one, imageOf(scaled(scene, exponent), settings(exponent)), exponent, 0);
  }
}

}  // namespace
}  // namespace lightvane::render_test
