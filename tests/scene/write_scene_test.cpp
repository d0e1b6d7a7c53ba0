#include "core/scene/write_scene.h"

#include <algorithm>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "core/scene/load_scene.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Each kind of table, each key at another value than its default, and names that keys must be quoted for.
constexpr const char* kEverything = R"(version = 1
name = "Q \"x\" \\ \u00e9"
units = "inch"

[[cameras]]
name = "lens"
position = [0.1, 0.2, 3.0]
target = [0.0, 0.3, 0.0]
up = [0.1, 1.0, 0.0]
fov_y = 33.3
resolution = [64, 48]
exposure = -1.5
lens_radius = 0.01
focus_distance = 2.9

[[cameras]]
name = "plan"
position = [0.0, 5.0, 0.0]
target = [0.0, 0.0, 0.0]
up = [0.0, 0.0, -1.0]
projection = "orthographic"
height = 4.5

[texture."a b"]
type = "checker"
even = [0.1, 0.2, 0.3]
odd = [0.4, 0.5, 0.6]
[texture.marble]
type = "marble"
base = [0.9, 0.8, 0.7]
vein = [0.1, 0.1, 0.2]
axis = [0.0, 1.0, 1.0]
spacing = 0.3
distortion = 0.7
sharpness = 3.0
octaves = 4
[texture.picture]
type = "image"
file = "p.png"
wrap = "clamp"
filter = "nearest"
[texture.holes]
type = "image"
file = "p.png"
channel = "alpha"
[material.veil]
diffuse = [0.5, 0.5, 0.5]
opacity = 0.25
[material.leaves]
diffuse = [0.1, 0.4, 0.1]
opacity = { texture = "holes", scale = 2.0, value = 0.75, cutoff = 0.5 }
[texture.wood]
type = "wood"
light = [0.6, 0.5, 0.4]
dark = [0.3, 0.2, 0.1]
axis = [1.0, 0.0, 0.0]
ring = 0.1
distortion = 0.2
grain = 0.1

[material."first one"]
diffuse = { texture = "a b", scale = 0.25, color = [0.5, 0.6, 0.7] }
mirror = { texture = "picture" }
emission = [1e-6, 2.5, 3.0]
two_sided = true
[material.screen]
emission = { texture = "picture", scale = 0.5, color = [10.0, 20.0, 30.0] }
[material.glass]
transmission = [0.9, 1.0, 0.95]
ior = 1.33
thin = true
[material.plastic]
diffuse = [0.1, 0.7, 0.3]
layers = [{ color = [0.04, 0.04, 0.04], model = "ggx", roughness = 0.3 }]
[material.varnish]
layers = [{ color = { texture = "marble", scale = 2.0 }, roughness = 0.05, isotropy = 0.25 }, { color = [0.45, 0.3, 0.18] }]
tangent = [0.0, 0.5, 1.0]

[[shape]]
name = "floor"
type = "polygon"
vertices = [[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]]
material = "varnish"
[[shape]]
type = "sphere"
center = [0.0, 0.5, 0.1]
radius = 0.25
material = "glass"
transform = { translate = [0.1, 0.0, 0.0], rotate = [0.0, 30.0, 5.0], scale = [2.0, 2.0, 2.0] }
[[shape]]
type = "box"
min = [-0.5, 0.0, -0.5]
max = [-0.25, 0.25, 0.5]
material = "plastic"
[[shape]]
type = "disc"
center = [0.0, 2.0, 0.0]
normal = [0.0, -1.0, 0.0]
radius = 0.3
material = "first one"
light = "lamp"
[[shape]]
type = "mesh"
file = "m.obj"
[[shape]]
type = "mesh"
file = "m.obj"
material = "plastic"
transform = { translate = [1.0, 0.0, 0.0] }

[[light]]
name = "bulb"
type = "point"
position = [1.0, 2.0, 0.0]
intensity = [1.0, 2.0, 3.0]
[[light]]
type = "spot"
position = [0.0, 2.0, 1.0]
direction = [0.0, -1.0, -0.1]
intensity = [3.0, 2.0, 1.0]
inner = 10.0
outer = 40.0
[[light]]
type = "directional"
direction = [1.0, -2.0, 0.0]
irradiance = [0.1, 0.2, 0.3]
angle = 0.53
[[light]]
type = "sphere"
center = [0.5, 1.5, 0.0]
radius = 0.05
intensity = [0.5, 0.5, 0.4]
points = 7
[[light]]
type = "environment"
radiance = [0.5, 0.5, 0.6]
image = "p.png"
rotate = 30.0
up = [0.0, 0.0, 1.0]

[render]
preset = "draft"
seed = 7
ilv.n_min = 5
ilv.radius_scale = 0.45
dlv.mode = "always"
)";

class WriteScene : public testing::Test {
 protected:
  void SetUp() override {
    folder_.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n");
    folder_.write("m.mtl", "newmtl a\nKd 0.5 0.4 0.3\nmap_Kd p.png\nnewmtl b\nKd 0.2 0.2 0.2\n");
    LayeredImage picture;
    picture.width = picture.height = 2;
    picture.setRgb("", ImageRgb(2, 2, Rgb(0.25f)));
    ASSERT_TRUE(writeImage(folder_ / "p.png", picture));
  }

  SceneDescription read(const std::string& text) {
    Expected<SceneDescription> scene = parseSceneToml(text, folder_ / "s.toml");
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? *std::move(scene) : SceneDescription{};
  }

  TemporaryFolder folder_;
};

TEST_F(WriteScene, GivesEveryKeyBack) {
  const SceneDescription scene = read(kEverything);
  const std::string text = sceneToml(scene).value();
  const SceneDescription again = read(text);
  EXPECT_EQ(sceneHash(again), sceneHash(scene));
  EXPECT_EQ(sceneToml(again).value(), text);
  EXPECT_THAT(text,
              HasSubstr("\nemission = { texture = \"picture\", scale = 0.5, color = [10.0, 20.0, 30.0] }"));
  // What the hash leaves out.
  EXPECT_EQ(again.name, scene.name);
  ASSERT_EQ(again.materials.size(), scene.materials.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    EXPECT_EQ(again.materials[i].name, scene.materials[i].name);
  ASSERT_EQ(again.shapes.size(), scene.shapes.size());
  EXPECT_EQ(again.shapes[0].name, "floor");
  EXPECT_EQ(again.shapes[3].light, "lamp");
  EXPECT_EQ(again.lights[0].name, "bulb");
  ASSERT_EQ(again.render.size(), scene.render.size());
  for (std::size_t i = 0; i < scene.render.size(); ++i) {
    EXPECT_EQ(again.render[i].key, scene.render[i].key);
    EXPECT_EQ(again.render[i].value, scene.render[i].value);
  }
}

// The test above would pass with a key that neither the text nor the hash has.
TEST_F(WriteScene, EveryKeyOfTheTextIsThere) {
  const std::string text = "\n" + sceneToml(read(kEverything)).value();
  std::string_view rest = kEverything;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    const std::size_t equals = line.find(" = ");
    if (equals == std::string_view::npos) continue;
    EXPECT_THAT(text, HasSubstr("\n" + std::string(line.substr(0, equals)) + " = ")) << line;
  }
}

TEST_F(WriteScene, LeavesDefaultsAndWhatFilesBringOut) {
  const std::string text = sceneToml(read("version = 1\n[camera]\nposition = [0, 0, 4]\n[material.a]\n"
                                          "diffuse = [0.5, 0.5, 0.5]\n[[shape]]\ntype = \"sphere\"\n"
                                          "material = \"a\"\n[[shape]]\ntype = \"mesh\"\nfile = \"m.obj\"\n"))
                               .value();
  EXPECT_EQ(text,
            "version = 1\n\n[camera]\nposition = [0.0, 0.0, 4.0]\ntarget = [0.0, 0.0, -1.0]\n"
            "up = [0.0, 1.0, 0.0]\nfov_y = 45.0\nresolution = [512, 512]\nexposure = 0.0\n\n[material.a]\n"
            "diffuse = [0.5, 0.5, 0.5]\n\n[[shape]]\ntype = \"sphere\"\nmaterial = \"a\"\n\n[[shape]]\n"
            "type = \"mesh\"\nfile = \"m.obj\"\n");
}

TEST_F(WriteScene, OfAMeshFileIsAStartForAScene) {
  const Expected<SceneDescription> scene = loadScene(folder_ / "m.obj");
  ASSERT_TRUE(scene) << scene.error().message();
  const std::string text = sceneToml(*scene).value();
  EXPECT_EQ(sceneHash(read(text)), sceneHash(*scene));
  EXPECT_THAT(text, HasSubstr("file = \"m.obj\""));
  EXPECT_THAT(text, HasSubstr("type = \"directional\""));
  EXPECT_THAT(text, Not(HasSubstr("[material")));
}

TEST_F(WriteScene, RefusesWhatHasNoFile) {
  SceneDescription scene = read(kEverything);
  scene.path = folder_ / "s.glb";
  const Expected<std::string> text = sceneToml(scene);
  ASSERT_FALSE(text);
  EXPECT_THAT(text.error().message(), HasSubstr("type = \"mesh\", file = \"s.glb\""));
}

}  // namespace
}  // namespace lightvane
