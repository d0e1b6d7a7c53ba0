#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "tests/scene/load_support.h"

namespace lightvane {
namespace {

using test::parseError;
using testing::ElementsAre;
using testing::HasSubstr;

// Lines 1 and 2 of every file below; what a case adds starts on line 3.
const std::string kHead = "version = 1\n[camera]\n";

SceneDescription parse(const std::string& added) {
  Expected<SceneDescription> scene = parseSceneToml(kHead + added, "scene.toml");
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? *std::move(scene) : SceneDescription{};
}

template <class T>
const T& geometryOf(const SceneDescription& scene, std::size_t shape = 0) {
  return std::get<T>(scene.shapes.at(shape).geometry);
}

TEST(LoadToml, LeavesDefaultsWhereAKeyIsAbsent) {
  const SceneDescription scene = parse("");
  ASSERT_EQ(scene.cameras.size(), 1U);
  const CameraDescription defaults;
  EXPECT_EQ(scene.cameras[0].position, defaults.position);
  EXPECT_EQ(scene.cameras[0].fovYDegrees, defaults.fovYDegrees);
  EXPECT_EQ(scene.cameras[0].width, defaults.width);
  EXPECT_EQ(scene.units, "metre");
  EXPECT_EQ(scene.path, "scene.toml");
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(LoadToml, ReadsCamerasInTheirOrder) {
  const Expected<SceneDescription> scene = parseSceneToml(R"(
version = 1
name = "two views"
units = "inch"
[[cameras]]
name = "front"
position = [1, 2.5, -3]
target = [0, 1, 0]
up = [0, 0, 2]
fov_y = 30
resolution = [640, 480]
exposure = -1.5
[[cameras]]
name = "back"
)",
                                                          "scene.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->cameras.size(), 2U);
  const CameraDescription& front = scene->cameras[0];
  EXPECT_EQ(front.name, "front");
  EXPECT_EQ(front.position, Vec3d(1.0, 2.5, -3.0));
  EXPECT_EQ(front.target, Vec3d(0.0, 1.0, 0.0));
  EXPECT_EQ(front.up, Vec3d(0.0, 0.0, 2.0));
  EXPECT_EQ(front.fovYDegrees, 30.0);
  EXPECT_EQ(front.width, 640);
  EXPECT_EQ(front.height, 480);
  EXPECT_EQ(front.exposureStops, -1.5);
  EXPECT_EQ(scene->cameras[1].name, "back");
  EXPECT_EQ(scene->name, "two views");
  EXPECT_EQ(scene->metresPerUnit(), 0.0254);
}

TEST(LoadToml, ReadsLenses) {
  const CameraDescription camera = parse("lens_radius = 0.25\nfocus_distance = 3").cameras.at(0);
  EXPECT_EQ(camera.lensRadius, 0.25);
  EXPECT_EQ(camera.focusDistance, 3.0);
  EXPECT_EQ(camera.resolvedFocusDistance(), 3.0);
  EXPECT_EQ(camera.projection, Projection::Perspective);
  const CameraDescription onTarget = parse("lens_radius = 0.25\ntarget = [3, 0, -4]").cameras.at(0);
  EXPECT_FALSE(onTarget.focusDistance);
  EXPECT_EQ(onTarget.resolvedFocusDistance(), 5.0);
  EXPECT_EQ(parse("lens_radius = 0\nfocus_distance = 3").cameras.at(0).lensRadius, 0.0);
}

TEST(LoadToml, ReadsOrthographicCameras) {
  const CameraDescription camera = parse("projection = \"orthographic\"\nheight = 2.5").cameras.at(0);
  EXPECT_EQ(camera.projection, Projection::Orthographic);
  EXPECT_EQ(camera.orthographicHeight, 2.5);
  EXPECT_EQ(camera.height, CameraDescription{}.height) << "of the picture, in pixels";
  EXPECT_EQ(parse("projection = \"perspective\"\nfov_y = 30").cameras.at(0).fovYDegrees, 30.0);
}

TEST(LoadToml, ReadsMaterials) {
  const SceneDescription scene = parse(R"(
[material.a]
diffuse = [0.1, 0.2, 0.3]
mirror = [0, 0.5, 1]
emission = [17, 12, 4]
two_sided = true
tangent = [0, 0, 2]
[material.glass]
transmission = [1, 1, 0.5]
ior = 1.33
thin = true
[material.varnish]
layers = [{ color = [0.04, 0.05, 0.06], roughness = 0.05, isotropy = 0.5 }, { color = [0.4, 0.3, 0.2] }]
[material.waxed]
layers = [{ color = [0.04, 0.05, 0.06], roughness = 0.3, model = "ggx" },
          { color = [0.4, 0.3, 0.2], model = "schlick", isotropy = 0.5 }]
[material.worn]
diffuse = [0.5, 0.4, 0.3]
layers = [{ color = [0.04, 0.04, 0.04], roughness = 0.2, model = "ggx" }]
)");
  ASSERT_EQ(scene.materials.size(), 5U);
  const MaterialDescription& a = scene.materials[0];
  EXPECT_EQ(a.name, "a");
  EXPECT_EQ(a.diffuse, Rgb(0.1, 0.2, 0.3));
  EXPECT_EQ(a.mirror, Rgb(0.0, 0.5, 1.0));
  EXPECT_EQ(a.emission, Rgb(17.0, 12.0, 4.0));
  EXPECT_TRUE(a.twoSided);
  EXPECT_EQ(a.tangent, Vec3d(0.0, 0.0, 2.0));
  EXPECT_EQ(scene.materials[1].transmission, Rgb(1.0, 1.0, 0.5));
  EXPECT_TRUE(scene.materials[1].thin);
  EXPECT_EQ(scene.materials[1].ior, 1.33);
  EXPECT_FALSE(scene.materials[1].tangent.has_value());
  EXPECT_THAT(scene.materials[2].layers, ElementsAre(LayerDescription{Rgb(0.04, 0.05, 0.06), 0.05, 0.5},
                                                     LayerDescription{Rgb(0.4, 0.3, 0.2), 1.0, 1.0}));
  EXPECT_THAT(scene.materials[3].layers,
              ElementsAre(LayerDescription{Rgb(0.04, 0.05, 0.06), 0.3, 1.0, LayerModel::Ggx},
                          LayerDescription{Rgb(0.4, 0.3, 0.2), 1.0, 0.5, LayerModel::Schlick}));
  EXPECT_EQ(scene.materials[4].diffuse, Rgb(0.5, 0.4, 0.3));
  EXPECT_EQ(scene.materials[4].layers.size(), 1U);
}

TEST(LoadToml, ReadsShapes) {
  const SceneDescription scene = parse(R"(
[material.a]
[material.b]
emission = [1, 1, 1]
[[shape]]
type = "polygon"
name = "floor"
material = "b"
light = "panel"
vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
[[shape]]
type = "sphere"
material = "a"
center = [1, 2, 3]
radius = 0.25
transform = { translate = [1, 0, 0], rotate = [0, 18, 0], scale = 2 }
[[shape]]
type = "box"
material = "a"
min = [-1, -2, -3]
max = [1, 2, 3]
transform = { scale = [1, 2, 3] }
[[shape]]
type = "disc"
material = "a"
center = [3, 2, 1]
normal = [0, 0, 5]
radius = 0.5
)");
  ASSERT_EQ(scene.shapes.size(), 4U);
  EXPECT_EQ(scene.shapes[0].name, "floor");
  EXPECT_EQ(scene.shapes[0].light, "panel");
  EXPECT_EQ(scene.materials[scene.shapes[0].material].name, "b");
  EXPECT_THAT(geometryOf<PolygonDescription>(scene, 0).vertices,
              ElementsAre(Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0)));
  EXPECT_EQ(scene.materials[scene.shapes[1].material].name, "a");
  EXPECT_EQ(geometryOf<SphereDescription>(scene, 1).center, Vec3d(1, 2, 3));
  EXPECT_EQ(geometryOf<SphereDescription>(scene, 1).radius, 0.25);
  EXPECT_EQ(scene.shapes[1].transform,
            (TransformDescription{Vec3d(1, 0, 0), Vec3d(0, 18, 0), Vec3d(2, 2, 2)}));
  EXPECT_EQ(geometryOf<BoxDescription>(scene, 2).min, Vec3d(-1, -2, -3));
  EXPECT_EQ(geometryOf<BoxDescription>(scene, 2).max, Vec3d(1, 2, 3));
  EXPECT_EQ(scene.shapes[2].transform.scale, Vec3d(1, 2, 3));
  EXPECT_EQ(geometryOf<DiscDescription>(scene, 3).center, Vec3d(3, 2, 1));
  EXPECT_EQ(geometryOf<DiscDescription>(scene, 3).normal, Vec3d(0, 0, 5));
  EXPECT_EQ(geometryOf<DiscDescription>(scene, 3).radius, 0.5);
}

TEST(LoadToml, ReadsLights) {
  const SceneDescription scene = parse(R"(
[[light]]
type = "point"
name = "bulb"
position = [0, 2, 0]
intensity = [10, 9, 8]
[[light]]
type = "spot"
position = [0, 3, 0]
direction = [0, -2, 1]
intensity = [1, 2, 3]
inner = 10
outer = 15.5
[[light]]
type = "directional"
direction = [-0.3, -1, 0.2]
irradiance = [3, 2.9, 2.7]
angle = 0.53
[[light]]
type = "sphere"
center = [1, 1, 1]
radius = 0.2
intensity = [5, 5, 5]
points = 64
)");
  ASSERT_EQ(scene.lights.size(), 4U);
  EXPECT_EQ(scene.lights[0].name, "bulb");
  const auto& point = std::get<PointLightDescription>(scene.lights[0].geometry);
  EXPECT_EQ(point.position, Vec3d(0, 2, 0));
  EXPECT_EQ(point.intensity, Rgb(10, 9, 8));
  const auto& spot = std::get<SpotLightDescription>(scene.lights[1].geometry);
  EXPECT_EQ(spot.position, Vec3d(0, 3, 0));
  EXPECT_EQ(spot.direction, Vec3d(0, -2, 1));
  EXPECT_EQ(spot.intensity, Rgb(1, 2, 3));
  EXPECT_EQ(spot.innerDegrees, 10.0);
  EXPECT_EQ(spot.outerDegrees, 15.5);
  const auto& sun = std::get<DirectionalLightDescription>(scene.lights[2].geometry);
  EXPECT_EQ(sun.direction, Vec3d(-0.3, -1.0, 0.2));
  EXPECT_EQ(sun.irradiance, Rgb(3.0, 2.9, 2.7));
  EXPECT_EQ(sun.angleDegrees, 0.53);
  const auto& cloud = std::get<VolumicSphereLightDescription>(scene.lights[3].geometry);
  EXPECT_EQ(cloud.center, Vec3d(1, 1, 1));
  EXPECT_EQ(cloud.radius, 0.2);
  EXPECT_EQ(cloud.intensity, Rgb(5, 5, 5));
  EXPECT_EQ(cloud.points, 64);
}

TEST(LoadToml, ReadsAnEnvironmentAndItsPicture) {
  const TemporaryFolder folder;
  LayeredImage picture{4, 2, {}, {}, {}};
  ImageRgb pixels(4, 2);
  pixels.at(3, 1) = Rgb(1, 2, 3);
  picture.setRgb("", pixels);
  ASSERT_TRUE(writeImage(folder / "sky.pfm", picture));
  const auto load = [&](const std::string& lights) {
    return parseSceneToml("version = 1\ncamera = {}\n" + lights, folder / "scene.toml");
  };
  const Expected<SceneDescription> scene = load(R"([[light]]
type = "environment"
[[light]]
type = "environment"
name = "dome"
radiance = [2, 3, 4]
image = "sky.pfm"
rotate = -30
up = [0, 0, 1]
)");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->lights.size(), 2u);
  const auto& plain = std::get<EnvironmentLightDescription>(scene->lights[0].geometry);
  EXPECT_EQ(plain.radiance, Rgb(1.0f));
  EXPECT_EQ(plain.pixels, nullptr);
  EXPECT_EQ(plain.up, Vec3d(0, 1, 0));
  const auto& dome = std::get<EnvironmentLightDescription>(scene->lights[1].geometry);
  EXPECT_EQ(scene->lights[1].name, "dome");
  EXPECT_EQ(dome.radiance, Rgb(2, 3, 4));
  EXPECT_EQ(dome.image, "sky.pfm");
  ASSERT_NE(dome.pixels, nullptr);
  EXPECT_EQ(*dome.pixels, pixels);
  EXPECT_EQ(dome.rotateDegrees, -30.0);
  EXPECT_EQ(dome.up, Vec3d(0, 0, 1));

  pixels.at(2, 0).g = -1.0f;
  picture.setRgb("", pixels);
  ASSERT_TRUE(writeImage(folder / "negative.pfm", picture));
  for (const auto& [file, fragment] : {std::pair{"negative.pfm", "negative.pfm: pixel (2, 0) is [0, -1, 0]"},
                                       std::pair{"missing.hdr", "missing.hdr: no such file"}}) {
    const auto refused = load(fmt::format("[[light]]\ntype = \"environment\"\nimage = \"{}\"\n", file));
    ASSERT_FALSE(refused) << file;
    EXPECT_THAT(refused.error().message(), HasSubstr("scene.toml:5:9: image of [[light]] 1"));
    EXPECT_THAT(refused.error().message(), HasSubstr(fragment));
  }
  pixels.at(2, 0).g = 2e38f;
  picture.setRgb("", pixels);
  ASSERT_TRUE(writeImage(folder / "bright.pfm", picture));
  const std::string bright = "[[light]]\ntype = \"environment\"\nimage = \"bright.pfm\"\n";
  EXPECT_TRUE(load(bright));
  const auto infinite = load(bright + "radiance = [1, 2, 1]\n");
  ASSERT_FALSE(infinite);
  EXPECT_THAT(infinite.error().message(), HasSubstr("and so is its product with radiance"));
}

TEST(LoadToml, KeepsRenderSettingsAsTextInTheOrderOfTheFile) {
  const SceneDescription scene = parse(R"([render]
seed = 7
dlv.mode = "always"
ilv = { s_e = 0.25, gradient = true }
[render.antialiasing]
samples = 4
threshold = 1e-3
)");
  std::vector<std::string> lines;
  for (const RenderSetting& s : scene.render) lines.push_back(s.where + " " + s.key + "=" + s.value);
  EXPECT_THAT(lines, ElementsAre("scene.toml:4:1 seed=7", "scene.toml:5:5 dlv.mode=always",
                                 "scene.toml:6:9 ilv.s_e=0.25", "scene.toml:6:21 ilv.gradient=true",
                                 "scene.toml:8:1 antialiasing.samples=4",
                                 "scene.toml:9:1 antialiasing.threshold=0.001"));
}

TEST(LoadToml, WarnsWhereAMaterialReflectsMoreThanArrives) {
  const SceneDescription scene = parse("[material.a]\ndiffuse = [0.6, 0, 0]\nmirror = [0.6, 0, 0]\n");
  EXPECT_THAT(scene.warnings,
              ElementsAre("scene.toml:3:1: [material.a]: diffuse and mirror together reflect more "
                          "than arrives (1.2)"));
}

TEST(LoadToml, SaysNothingAboutAnUnusedMaterial) {
  EXPECT_TRUE(parse("[material.a]\ndiffuse = [0.6, 0, 0]\n").warnings.empty());
}

TEST(LoadToml, ReadsLengthsFarFromOne) {
  for (const char* radius : {"1e-90", "1e-20", "1e20", "1e90"}) {
    const SceneDescription scene = parse(
        "[material.a]\n[[shape]]\ntype = \"sphere\"\nmaterial = \"a\"\nradius = " + std::string(radius));
    ASSERT_EQ(scene.shapes.size(), 1U) << radius;
    EXPECT_EQ(geometryOf<SphereDescription>(scene).radius, std::stod(radius));
  }
}

TEST(LoadToml, ShowsACameraThatWorksWhereThereIsNone) {
  const Expected<SceneDescription> scene = parseSceneToml("version = 1\n", "scene.toml");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().where, "scene.toml:1:1");
  const std::string& hint = scene.error().hint;
  const std::size_t example = hint.find("camera = ");
  ASSERT_NE(example, std::string::npos) << hint;
  EXPECT_EQ(parseError("version = 1\n" + hint.substr(example)), "");
}

TEST(LoadToml, ReadsTheFirstErrorInsteadOfWhatFollowsFromIt) {
  // The misspelt key, and not that the vertices are missing.
  EXPECT_THAT(
      parseError(kHead + "[material.a]\n[[shape]]\ntype = \"polygon\"\nmaterial = \"a\"\nvertexes = []\n"),
      HasSubstr("vertexes of [[shape]] 1: unknown key (did you mean vertices?)"));
  // The misspelt table, and not that its material is missing.
  EXPECT_THAT(parseError(kHead + "[materal.a]\n[[shape]]\ntype = \"sphere\"\nmaterial = \"a\"\n"),
              HasSubstr("materal of the file: unknown key (did you mean material?)"));
}

// ---- every error with its place and what it says

struct BadFile {
  const char* name;
  std::string added;  ///< after kHead; shapes and materials of the cases come from the helpers below
  std::vector<std::string> fragments;
};

void PrintTo(const BadFile& file, std::ostream* out) { *out << file.name; }

class LoadTomlRefuses : public testing::TestWithParam<BadFile> {};

TEST_P(LoadTomlRefuses, WithPlaceKeyExpectedAndFound) {
  const std::string message = parseError(kHead + GetParam().added);
  for (const std::string& fragment : GetParam().fragments) EXPECT_THAT(message, HasSubstr(fragment));
}

/// A shape with the material "a" on lines 3 to 6; `keys` start on line 7.
std::string shape(const std::string& type, const std::string& keys) {
  return "[material.a]\n[[shape]]\nmaterial = \"a\"\ntype = \"" + type + "\"\n" + keys;
}
/// A material on line 3; `keys` start on line 4.
std::string material(const std::string& keys) { return "[material.a]\n" + keys; }
/// A light on lines 3 and 4; `keys` start on line 5.
std::string light(const std::string& type, const std::string& keys) {
  return "[[light]]\ntype = \"" + type + "\"\n" + keys;
}

const std::vector<BadFile> kBadFiles = {
    // syntax
    {"Syntax", "fov_y = = 3", {"scene.toml:3:9: ", "parsing"}},
    {"InvalidUtf8", "name = \"\xff\"", {"scene.toml:3:", "utf-8"}},
    {"KeyTwice", "fov_y = 30\nfov_y = 40", {"scene.toml:4:", "fov_y"}},
    {"NumberBeyondDouble", "fov_y = 1e400", {"scene.toml:3:", "1e400"}},
    {"UnendedString", "name = \"abc", {"scene.toml:3:"}},

    // the file
    {"UnknownTable", "[shapes]", {"scene.toml:3:2: shapes of the file: unknown key", "did you mean shape?"}},
    {"FarFromAnyKey",
     "[quaternions]",
     {"quaternions of the file: unknown key",
      "known here: version, name, units, camera, cameras, texture, material"}},
    {"ShapeTable",
     "[shape]\ntype = \"box\"",
     {"scene.toml:3:1: shape of the file: expected an array of tables", "write [[shape]]"}},
    {"MaterialArray",
     "[[material]]",
     {"scene.toml:3:1: material of the file: expected one table", "[material.NAME]"}},
    {"BothKindsOfCameras",
     "[[cameras]]\nname = \"b\"",
     {"scene.toml:2:1: ", "either [camera] or [[cameras]]"}},

    // camera
    {"UnknownCameraKey",
     "fovy = 30",
     {"scene.toml:3:1: fovy of [camera]: unknown key", "did you mean fov_y?"}},
    {"WrongType", "fov_y = \"30\"", {"scene.toml:3:9: fov_y of [camera]: expected a number", "found \"30\""}},
    {"FieldOfViewTooWide", "fov_y = 180", {"scene.toml:3:9: fov_y", "from 0.001 to 179.999, found 180"}},
    {"FieldOfViewZero", "fov_y = 0", {"scene.toml:3:9: fov_y", "found 0"}},
    {"NotANumber",
     "exposure = nan",
     {"scene.toml:3:12: exposure of [camera]: expected a number", "found nan"}},
    {"Infinity",
     "position = [0, -inf, 0]",
     {"scene.toml:3:16: position", "three finite numbers", "found -inf"}},
    {"TooFewNumbers", "up = [0, 1]", {"scene.toml:3:6: up", "[a, b, c], three", "found an array of 2"}},
    {"TooManyNumbers", "up = [0, 1, 0, 0]", {"scene.toml:3:6: up", "found an array of 4"}},
    {"StringAmongNumbers", "up = [0, \"1\", 0]", {"scene.toml:3:10: up", "found \"1\""}},
    {"ZeroUp", "up = [0, 0, 0]", {"scene.toml:3:6: up", "expected a direction, found [0, 0, 0]"}},
    {"UpAlongView", "up = [0, 0, 3]", {"scene.toml:3:6: up of [camera]: up is parallel to the direction"}},
    {"TargetAtPosition", "target = [0, 0, 0]", {"scene.toml:3:10: target", "the same point"}},
    {"ResolutionNotWhole", "resolution = [512, 51.5]", {"scene.toml:3:20: resolution", "two whole", "51.5"}},
    {"ResolutionZero",
     "resolution = [0, 512]",
     {"scene.toml:3:15: resolution", "from 1 to 65536", "found 0"}},
    {"ResolutionHuge", "resolution = [512, 65537]", {"scene.toml:3:20: resolution", "found 65537"}},

    {"UnknownProjection",
     "projection = \"ortographic\"",
     {"scene.toml:3:14: projection of [camera]: expected perspective or orthographic",
      "did you mean orthographic?"}},
    {"OrthographicWithoutHeight",
     "projection = \"orthographic\"",
     {"height of [camera]: missing, expected the height of what the picture shows"}},
    {"OrthographicHeightZero",
     "projection = \"orthographic\"\nheight = 0",
     {"scene.toml:4:10: height of [camera]: expected a number above 0", "found 0"}},
    {"OrthographicWithAngle",
     "projection = \"orthographic\"\nheight = 2\nfov_y = 30",
     {"scene.toml:5:9: fov_y of [camera]: cannot stand beside an orthographic projection"}},
    {"OrthographicWithLens",
     "projection = \"orthographic\"\nheight = 2\nlens_radius = 0.1",
     {"scene.toml:5:15: lens_radius of [camera]: cannot stand beside an orthographic projection"}},
    {"OrthographicWithFocus",
     "projection = \"orthographic\"\nheight = 2\nfocus_distance = 1",
     {"scene.toml:5:18: focus_distance of [camera]: cannot stand beside an orthographic projection"}},
    {"HeightOfNoProjection",
     "height = 2",
     {"scene.toml:3:10: height of [camera]: cannot stand beside a perspective projection"}},
    {"HeightOfPerspective",
     "projection = \"perspective\"\nheight = 2",
     {"scene.toml:4:10: height", "add projection = \"orthographic\""}},
    {"NegativeLensRadius",
     "lens_radius = -0.1",
     {"scene.toml:3:15: lens_radius of [camera]: expected a number from 0 to 1e100, found -0.1"}},
    {"FocusZero",
     "lens_radius = 0.1\nfocus_distance = 0",
     {"scene.toml:4:18: focus_distance", "a number above 0", "found 0"}},
    {"FocusWithoutLens",
     "focus_distance = 2",
     {"scene.toml:3:18: focus_distance of [camera]", "without lens_radius"}},

    // materials
    {"MaterialNotATable",
     "[material]\na = 3",
     {"scene.toml:4:5: a of [material]: expected one table, found 3"}},
    {"UnknownMaterialKey",
     material("difuse = [0, 0, 0]"),
     {"scene.toml:4:1: difuse of [material.a]: unknown key", "did you mean diffuse?"}},
    {"ReflectanceAboveOne",
     material("diffuse = [0, 1.5, 0]"),
     {"scene.toml:4:15: diffuse of [material.a]: ", "three numbers in [0, 1], found 1.5"}},
    {"ReflectanceNegative", material("mirror = [0, 0, -0.1]"), {"scene.toml:4:17: mirror", "found -0.1"}},
    {"TransmissionAboveOne",
     material("transmission = [2, 0, 0]"),
     {"scene.toml:4:17: transmission", "found 2"}},
    {"ColorAsNumber", material("diffuse = 0.5"), {"scene.toml:4:11: diffuse", "three numbers", "found 0.5"}},
    {"EmissionNegative", material("emission = [-1, 0, 0]"), {"scene.toml:4:13: emission", "found -1"}},
    {"EmissionBeyondFloat",
     material("emission = [1e39, 0, 0]"),
     {"scene.toml:4:13: emission", "3.4e38", "1e+39"}},
    {"EmissionLostInFloat",
     material("emission = [0, 1e-60, 0]"),
     {"scene.toml:4:16: emission", "told from 0"}},
    {"ZeroTangent", material("tangent = [0, 0, 0]"), {"scene.toml:4:11: tangent", "expected a direction"}},
    {"GlassWithDiffuse",
     material("diffuse = [0, 0, 0]\ntransmission = [1, 1, 1]"),
     {"scene.toml:5:16: transmission of [material.a]: cannot stand beside diffuse"}},
    {"GlassWithMirror",
     material("mirror = [0, 0, 0]\ntransmission = [1, 1, 1]"),
     {"transmission of [material.a]: cannot stand beside mirror"}},
    {"GlassWithLayers",
     material("transmission = [1, 1, 1]\nlayers = [{ color = [0, 0, 0] }]"),
     {"transmission of [material.a]: cannot stand beside layers"}},
    {"LayersWithDiffuse",
     material("diffuse = [0, 0, 0]\nlayers = [{ color = [0, 0, 0] }]"),
     {"scene.toml:5:10: layers of [material.a]: cannot stand beside diffuse"}},
    {"LayersWithMirror",
     material("mirror = [0, 0, 0]\nlayers = [{ color = [0, 0, 0] }]"),
     {"layers of [material.a]: cannot stand beside mirror"}},
    {"IorWithoutGlass", material("ior = 1.5"), {"scene.toml:4:7: ior", "without transmission"}},
    {"ThinWithoutTransmission",
     material("diffuse = [0.5, 0.5, 0.5]\nthin = true"),
     {"scene.toml:5:8: thin", "no transmission", "add transmission"}},
    {"IorZero", material("transmission = [1, 1, 1]\nior = 0"), {"scene.toml:5:7: ior", "above 0", "found 0"}},
    {"TwoSidedWithoutEmission",
     material("two_sided = true"),
     {"scene.toml:4:13: two_sided", "emits nothing"}},
    {"TwoSidedNotBoolean",
     material("emission = [1, 1, 1]\ntwo_sided = 1"),
     {"scene.toml:5:13: two_sided", "expected true or false, found 1"}},
    {"TwoLayersOnDiffuse",
     material(
         "diffuse = [0, 0, 0]\nlayers = [{ color = [0, 0, 0], model = \"ggx\" }, { color = [0, 0, 0] }]"),
     {"layers of [material.a]: cannot stand beside diffuse"}},
    {"NoLayers", material("layers = []"), {"scene.toml:4:10: layers", "one or two layers, found 0"}},
    {"ThreeLayers",
     material("layers = [{ color = [0, 0, 0] }, { color = [0, 0, 0] }, { color = [0, 0, 0] }]"),
     {"scene.toml:4:10: layers", "one or two layers, found 3"}},
    {"LayerNotATable", material("layers = [1]"), {"scene.toml:4:11: layers", "expected a table, found 1"}},
    {"UnknownLayerKey",
     material("layers = [{ color = [0, 0, 0], roughnes = 1 }]"),
     {"scene.toml:4:32: roughnes of layer 1 of [material.a]: unknown key", "did you mean roughness?"}},
    {"LayerWithoutColor",
     material("layers = [{ roughness = 1 }]"),
     {"scene.toml:4:11: color of layer 1 of [material.a]: missing"}},
    {"RoughnessAboveOne",
     material("layers = [{ color = [0, 0, 0], roughness = 1.1 }]"),
     {"scene.toml:4:44: roughness of layer 1", "in [0, 1], found 1.1"}},
    {"IsotropyNegative",
     material("layers = [{ color = [0, 0, 0], isotropy = -0.1 }]"),
     {"scene.toml:4:43: isotropy of layer 1", "in [0, 1], found -0.1"}},

    {"UnknownLayerModel",
     material("layers = [{ color = [0, 0, 0], model = \"gxx\" }]"),
     {"scene.toml:4:40: model of layer 1 of [material.a]: expected schlick or ggx", "found \"gxx\""}},
    {"IsotropyOfFacets",
     material("layers = [{ color = [0, 0, 0], isotropy = 0.5, model = \"ggx\" }]"),
     {"scene.toml:4:43: isotropy of layer 1 of [material.a]: cannot stand beside model = \"ggx\"",
      "leave it out"}},

    // shapes
    {"NoType",
     "[[shape]]\nname = \"ball\"",
     {"scene.toml:3:1: type of [[shape]] 1 (ball): missing, expected polygon, sphere, box, disc or mesh"}},
    {"UnknownType",
     shape("shpere", ""),
     {"scene.toml:6:8: type of [[shape]] 1", "found \"shpere\"", "did you mean sphere?"}},
    {"UnknownShapeKey",
     shape("sphere", "radus = 1"),
     {"scene.toml:7:1: radus of [[shape]] 1", "mean radius?"}},
    {"KeyOfAnotherType", shape("box", "radius = 1"), {"scene.toml:7:1: radius of [[shape]] 1: unknown key"}},
    {"NoMaterial",
     "[[shape]]\ntype = \"sphere\"",
     {"scene.toml:3:1: material of [[shape]] 1: missing, expected the name of a [material.NAME]"}},
    {"UnknownMaterial",
     "[material.white]\n[[shape]]\ntype = \"sphere\"\nmaterial = \"wite\"",
     {"scene.toml:6:12: material of [[shape]] 1: there is no material \"wite\"", "did you mean white?"}},
    {"UnknownMaterialFarFromAny",
     "[material.white]\n[[shape]]\ntype = \"sphere\"\nmaterial = \"copper\"",
     {"there is no material \"copper\"", "there are white"}},
    {"NegativeRadius",
     shape("sphere", "radius = -1"),
     {"scene.toml:7:10: radius", "a number above 0", "found -1"}},
    {"ZeroRadius", shape("disc", "radius = 0"), {"scene.toml:7:10: radius", "a number above 0", "found 0"}},
    {"ZeroNormal", shape("disc", "normal = [0, 0, 0]"), {"scene.toml:7:10: normal", "expected a direction"}},
    {"BoxInsideOut",
     shape("box", "min = [0, 2, 0]"),
     {"scene.toml:7:7: min", "max above min on every axis, found 2 to 1 on y", "swap them"}},
    {"FlatBox",
     shape("box", "max = [1, 1, 0]"),
     {"scene.toml:7:7: max", "found 0 to 0 on z", "use a polygon"}},
    {"NoVertices", shape("polygon", ""), {"scene.toml:4:1: vertices of [[shape]] 1: missing"}},
    {"TwoVertices",
     shape("polygon", "vertices = [[0, 0, 0], [1, 0, 0]]"),
     {"scene.toml:7:13: vertices", "expected at least 3 vertices, found 2"}},
    {"EmptyVertices", shape("polygon", "vertices = []"), {"scene.toml:7:12: vertices", "found 0"}},
    {"VertexOfTwoNumbers",
     shape("polygon", "vertices = [[0, 0, 0], [1, 0], [1, 1, 0]]"),
     {"scene.toml:7:24: vertices", "three finite numbers", "found an array of 2"}},
    {"VertexNotFinite",
     shape("polygon", "vertices = [[0, 0, 0], [1, 0, 0],\n[1, nan, 0]]"),
     {"scene.toml:8:5: vertices", "found nan"}},
    {"VertexBeyondReason",
     shape("polygon", "vertices = [[0, 0, 0], [1, 0, 0],\n[1, 1e101, 0]]"),
     {"scene.toml:8:5: vertices", "up to 1e100, found 1e+101"}},
    {"NotPlanar",
     shape("polygon", "vertices = [[0, 0, 0], [4, 0, 0], [4, 4, 0.04], [0, 4, 0]]"),
     {"scene.toml:7:13: vertices", "not planar: vertex 1 is 0.01 off the plane, 0.0025 of the polygon's size",
      "split it into triangles"}},
    {"NotConvex",
     shape("polygon", "vertices = [[0, 0, 0], [1, 0, 0], [0.1, 0.1, 0], [0, 1, 0]]"),
     {"scene.toml:7:35: vertices", "not convex at vertex 3", "split it into convex polygons"}},
    {"TransformNotATable",
     shape("box", "transform = 2"),
     {"scene.toml:7:13: transform", "one table, found 2"}},
    {"UnknownTransformKey",
     shape("box", "transform = { rotat = [0, 0, 0] }"),
     {"scene.toml:7:15: rotat of transform of [[shape]] 1: unknown key", "did you mean rotate?"}},
    {"ScaleZero",
     shape("box", "transform = { scale = 0 }"),
     {"scene.toml:7:23: scale of transform", "above 0", "found 0"}},
    {"ScaleNegative",
     shape("box", "transform = { scale = [1, -1, 1] }"),
     {"scene.toml:7:27: scale", "found -1"}},
    {"SphereScaledUnevenly",
     shape("sphere", "transform = { scale = [1, 2, 1] }"),
     {"scene.toml:7:13: transform", "the same scale on all axes, found [1, 2, 1]"}},
    {"DiscScaledUnevenly",
     shape("disc", "transform = { scale = [1, 2, 1] }"),
     {"the same scale on all axes"}},
    {"LightThatDoesNotEmit",
     shape("sphere", "light = \"lamp\""),
     {"scene.toml:7:9: light of [[shape]] 1", "part of the light \"lamp\", but does not emit"}},
    {"LightOfTwoEmissions",
     "[material.a]\nemission = [1, 1, 1]\n[material.b]\nemission = [2, 2, 2]\n"
     "[[shape]]\ntype = \"sphere\"\nmaterial = \"a\"\nlight = \"lamp\"\n"
     "[[shape]]\ntype = \"sphere\"\nmaterial = \"b\"\nlight = \"lamp\"\n",
     {"scene.toml:14:9: light of [[shape]] 2",
      "the material b emits otherwise than the rest of the light \"lamp\""}},

    // meshes
    {"MeshWithoutFile", shape("mesh", ""), {"scene.toml:4:1: file of [[shape]] 1: missing"}},
    {"MeshFileMissing",
     shape("mesh", "file = \"nowhere.obj\""),
     {"scene.toml:7:8: file of [[shape]] 1: nowhere.obj: no such file"}},
    {"MeshOfUnknownKind",
     shape("mesh", "file = \"a.stl\""),
     {"scene.toml:7:8: file", "an .obj, .ply, .gltf or .glb file, found \"a.stl\""}},

    // lights
    {"UnknownLightType",
     light("ponit", ""),
     {"scene.toml:4:8: type of [[light]] 1", "point, spot, directional, sphere or environment",
      "did you mean point?"}},
    {"UnknownLightKey",
     light("point", "intensty = [1, 1, 1]"),
     {"scene.toml:5:1: intensty", "mean intensity?"}},
    {"NegativeIntensity",
     light("point", "intensity = [1, -1, 1]"),
     {"scene.toml:5:17: intensity", "found -1"}},
    {"ZeroDirection", light("directional", "direction = [0, 0, 0]"), {"scene.toml:5:13: direction"}},
    {"NegativeAngle",
     light("directional", "angle = -1"),
     {"scene.toml:5:9: angle", "from 0 to 180, found -1"}},
    {"InnerAboveOuter",
     light("spot", "inner = 40\nouter = 30"),
     {"scene.toml:5:9: inner of [[light]] 1", "found inner 40 and outer 30"}},
    {"NoPoints",
     light("sphere", "points = 0"),
     {"scene.toml:5:10: points", "a whole number from 1", "found 0"}},
    {"HalfAPoint",
     light("sphere", "points = 1.5"),
     {"scene.toml:5:10: points", "a whole number", "found 1.5"}},

    // [render]
    {"RenderArray",
     "[render]\nilv.n_min = [3]",
     {"scene.toml:4:13: ilv.n_min of [render]: expected a number, true, false or a string",
      "found an array of 1"}},
    {"RenderDate",
     "[render]\nseed = 2020-01-01",
     {"scene.toml:4:8: seed of [render]", "found a date or time"}},
    {"RenderTwice",
     "[render]\nilv.n_min = 3\n\"ilv.n_min\" = 4",
     {"scene.toml:5:1: ilv.n_min", "given twice"}},

    {"EnvironmentTurnedTooFar",
     light("environment", "rotate = 4000"),
     {"scene.toml:5:10: rotate of [[light]] 1", "from -3600 to 3600, found 4000"}},
    {"EnvironmentUpNowhere", light("environment", "up = [0, 0, 0]"), {"scene.toml:5:6: up of [[light]] 1"}},

    // textures in place of colours
    {"UnknownTextureOfEmission",
     material("emission = { texture = \"wood\" }"),
     {"scene.toml:4:", "there is no texture \"wood\""}},
    {"TexturedIntensity",
     light("point", "intensity = { texture = \"wood\" }"),
     {"scene.toml:5:13: intensity of [[light]] 1: no texture may stand in place of this colour"}},
    {"PlyMesh", shape("mesh", "file = \"a.ply\""), {"scene.toml:7:8: file", "a.ply: no such file"}},
    {"GltfMesh", shape("mesh", "file = \"a.gltf\""), {"scene.toml:7:8: file", "a.gltf: no such file"}},
    {"GlbMesh", shape("mesh", "file = \"a.GLB\""), {"scene.toml:7:8: file", "a.GLB: no such file"}},
};

INSTANTIATE_TEST_SUITE_P(BadFiles, LoadTomlRefuses, testing::ValuesIn(kBadFiles),
                         [](const testing::TestParamInfo<BadFile>& file) { return file.param.name; });

struct BadStart {
  const char* name;
  std::string text;  ///< the whole file
  std::vector<std::string> fragments;
};

void PrintTo(const BadStart& file, std::ostream* out) { *out << file.name; }

class LoadTomlRefusesStart : public testing::TestWithParam<BadStart> {};

TEST_P(LoadTomlRefusesStart, WithPlaceKeyExpectedAndFound) {
  const std::string message = parseError(GetParam().text);
  for (const std::string& fragment : GetParam().fragments) EXPECT_THAT(message, HasSubstr(fragment));
}

/// A key of this many parts.
std::string keyOf(int parts, const std::string& part = "a") {
  std::string key = part;
  for (int i = 1; i < parts; ++i) key += "." + part;
  return key;
}

TEST(LoadToml, CountsThePartsOfKeysAlone) {
  EXPECT_TRUE(parseSceneToml(kHead + "# " + keyOf(200) + "\n[material.\"" + keyOf(200) + "\"]\ndiffuse = [" +
                                 "0.1, 0.2, 0.3]\n[material.'a\"b']\nopacity = 0.5 # it's \"half\n",
                             "scene.toml"));
}

const std::vector<BadStart> kBadStarts = {
    // Freeing 50000 tables within each other takes more stack than there is.
    {"DeepHeader", "version = 1\n[" + keyOf(50000) + "]\n", {"scene.toml:2:201: a key of too many parts"}},
    {"DeepKey", "version = 1\n" + keyOf(50000) + " = 1\n", {"scene.toml:2:200: a key of too many parts"}},
    {"DeepKeyInQuotes",
     "version = 1\n\n" + keyOf(50000, "\"a,\\\"]\" ") + "= 1\n",
     {"scene.toml:3:", "a key of too many parts"}},
    {"Empty", "", {"scene.toml:1:1: the file says nothing"}},
    {"OnlyAComment", "# nothing\n", {"scene.toml:1:1: the file says nothing"}},
    {"NoVersion", "[camera]\n", {"scene.toml:1:1: version of the file: missing, expected version = 1"}},
    {"LaterVersion", "version = 2\nanything = 3\n", {"scene.toml:1:11: version", "found 2"}},
    {"VersionZero", "version = 0\n", {"scene.toml:1:11: version", "found 0"}},
    {"VersionAsString", "version = \"1\"\n", {"scene.toml:1:11: version", "found \"1\""}},
    {"UnknownUnits",
     "version = 1\nunits = \"meter\"\n[camera]\n",
     {"scene.toml:2:9: units of the file: expected metre, decimetre", "found \"meter\"",
      "did you mean metre?"}},
    {"NameNotAString", "version = 1\nname = 3\n", {"scene.toml:2:8: name", "a string in quotes, found 3"}},
    {"CameraNotATable",
     "version = 1\ncamera = 3\n",
     {"scene.toml:2:10: camera", "expected one table, found 3"}},
    {"ArrayOfCamera", "version = 1\n[[camera]]\n", {"scene.toml:2:1: camera", "one table", "[[cameras]]"}},
    {"CamerasNotAnArray",
     "version = 1\n[cameras]\n",
     {"scene.toml:2:1: cameras", "expected an array of tables"}},
    {"CameraWithoutAName",
     "version = 1\n[[cameras]]\nname = \"a\"\n[[cameras]]\n",
     {"scene.toml:4:1: name of [[cameras]] 2: missing"}},
    {"CameraNameTwice",
     "version = 1\n[[cameras]]\nname = \"a\"\n[[cameras]]\nname = \"a\"\n",
     {"scene.toml:5:8: name of [[cameras]] 2 (a): there is a camera \"a\" already"}},
};

INSTANTIATE_TEST_SUITE_P(BadFiles, LoadTomlRefusesStart, testing::ValuesIn(kBadStarts),
                         [](const testing::TestParamInfo<BadStart>& file) { return file.param.name; });

}  // namespace
}  // namespace lightvane
