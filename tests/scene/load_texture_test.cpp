// Textures in scene files: what is read, and what is refused with which words.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/image/image_file.h"
#include "core/scene/scene.h"
#include "tests/scene/load_support.h"

namespace lightvane::test {
namespace {

using testing::HasSubstr;

std::string sceneWith(std::string_view tables) {
  return fmt::format(R"(version = 1
[camera]
position = [0, 0, 4]
target = [0, 0, 0]
{}
[[shape]]
type = "polygon"
material = "wall"
vertices = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]
)",
                     tables);
}

MaterialDescription wallOf(std::string_view tables) {
  const Expected<SceneDescription> scene = parseSceneToml(sceneWith(tables), "scene.toml");
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? scene->materials.front() : MaterialDescription{};
}

void expectRefused(std::string_view tables, const std::string& words) {
  EXPECT_THAT(parseError(sceneWith(tables)), HasSubstr(words));
}

TEST(LoadTexture, StandsWhereAColourMay) {
  const MaterialDescription wall = wallOf(R"(
[texture.b-checker]
type = "checker"
[texture.a-wood]
type = "wood"
[material.wall]
diffuse = {texture = "b-checker", scale = 0.25, color = [0.5, 0.6, 0.7]}
mirror = {texture = "a-wood"}
)");
  EXPECT_EQ(wall.diffuse, Rgb(0.5f, 0.6f, 0.7f));
  EXPECT_EQ(wall.textures.diffuse, (TextureUse{1, 0.25}));
  EXPECT_EQ(wall.mirror, Rgb(1.0f));
  EXPECT_EQ(wall.textures.mirror, (TextureUse{0, 1.0}));
  EXPECT_FALSE(wall.textures.transmission);
}

TEST(LoadTexture, ReadsItsParameters) {
  const Expected<SceneDescription> scene = parseSceneToml(sceneWith(R"(
[texture.wood]
type = "wood"
light = [0.5, 0.4, 0.3]
dark = [0.2, 0.1, 0]
axis = [1, 0, 0]
ring = 0.02
distortion = 0.5
grain = 0
[texture.stone]
type = "marble"
base = [0.9, 0.9, 0.9]
vein = [0.1, 0.1, 0.1]
axis = [0, 0, 1]
spacing = 0.2
distortion = 2
sharpness = 3
octaves = 4
[material.wall]
diffuse = {texture = "wood"}
)"),
                                                          "scene.toml");
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->textures.size(), 2U);
  const auto& marble = std::get<MarbleDescription>(scene->textures[0].pattern);
  EXPECT_EQ(marble.base, Rgb(0.9f));
  EXPECT_EQ(marble.vein, Rgb(0.1f));
  EXPECT_EQ(marble.axis, Vec3d(0.0, 0.0, 1.0));
  EXPECT_EQ(marble.spacing, 0.2);
  EXPECT_EQ(marble.distortion, 2.0);
  EXPECT_EQ(marble.sharpness, 3.0);
  EXPECT_EQ(marble.octaves, 4);
  const auto& wood = std::get<WoodDescription>(scene->textures[1].pattern);
  EXPECT_EQ(wood.light, Rgb(0.5f, 0.4f, 0.3f));
  EXPECT_EQ(wood.dark, Rgb(0.2f, 0.1f, 0.0f));
  EXPECT_EQ(wood.axis, Vec3d(1.0, 0.0, 0.0));
  EXPECT_EQ(wood.ring, 0.02);
  EXPECT_EQ(wood.distortion, 0.5);
  EXPECT_EQ(wood.grain, 0.0);
}

TEST(LoadTexture, RefusesWhatItCannotUse) {
  const std::string material = "[material.wall]\ndiffuse = {texture = \"t\"}\n";
  expectRefused("[texture.tiles]\ntype = \"checker\"\n[material.wall]\ndiffuse = {texture = \"tile\"}\n",
                "there is no texture \"tile\"");
  expectRefused("[texture.tiles]\ntype = \"checker\"\n[material.wall]\ndiffuse = {texture = \"tile\"}\n",
                "tiles");
  expectRefused(material, "the file has no [texture.NAME]");
  expectRefused("[material.wall]\ndiffuse = {scale = 2}\n", "texture");
  expectRefused("[texture.t]\ntype = \"stripes\"\n" + material, "stripes");
  expectRefused("[texture.t]\ntype = \"wood\"\nrings = 3\n" + material, "rings");
  expectRefused("[texture.t]\ntype = \"wood\"\nring = 0\n" + material, "above 0");
  expectRefused("[texture.t]\ntype = \"marble\"\noctaves = 40\n" + material, "from 1 to 16");
  expectRefused("[texture.t]\ntype = \"checker\"\n[material.wall]\ndiffuse = {texture = \"t\", scale = -1}\n",
                "above 0");
}

TEST(LoadTexture, StandsForWhatIsEmitted) {
  const std::string checker = "[texture.t]\ntype = \"checker\"\n";
  const MaterialDescription wall = wallOf(checker + R"(
[material.wall]
diffuse = [0.1, 0.1, 0.1]
emission = {texture = "t", scale = 0.5, color = [10, 0, 1e6]}
two_sided = true
)");
  EXPECT_EQ(wall.emission, Rgb(10.0f, 0.0f, 1e6f));
  EXPECT_EQ(wall.textures.emission, (TextureUse{0, 0.5}));
  EXPECT_TRUE(wall.twoSided);
  EXPECT_TRUE(wall.textures.any() && !wall.textures.ofReflection());
  EXPECT_EQ(wallOf(checker + "[material.wall]\nemission = {texture = \"t\"}\n").emission, Rgb(1.0f));

  const std::string material = checker + "[material.wall]\n";
  expectRefused(material + "emission = {texture = \"t\", color = [-1, 0, 0]}\n", "color");
  expectRefused(material + "emission = {texture = \"t\", scale = 0}\n", "above 0");
  expectRefused(material + "emission = {color = [1, 1, 1]}\n", "texture");
  expectRefused(material + "emission = {texture = \"t\", value = 2}\n", "value");
  expectRefused(material + "emission = {texture = \"t\"}\nopacity = 0.5\n", "cannot stand beside emission");
  expectRefused(material + "emission = {texture = \"t\", color = [0, 0, 0]}\ntwo_sided = true\n",
                "this material emits nothing");
}

// Shapes that are one light need the same texture, and the same scale of it.
TEST(LoadTexture, OfALightIsThatOfAllItsShapes) {
  const auto withSecond = [](const std::string& emission) {
    return sceneWith("[texture.t]\ntype = \"checker\"\n[material.wall]\nemission = {texture = \"t\"}\n" +
                     ("[material.other]\nemission = " + emission) + "\n") +
           "light = \"lamp\"\n[[shape]]\ntype = \"sphere\"\nmaterial = \"other\"\nlight = \"lamp\"\n";
  };
  EXPECT_EQ(parseError(withSecond("{texture = \"t\"}")), "");
  for (const char* other : {"{texture = \"t\", scale = 2}", "[1, 1, 1]"}) {
    EXPECT_THAT(parseError(withSecond(other)),
                HasSubstr("the material other emits otherwise than the rest of the light \"lamp\""));
  }
}

class LoadImageTexture : public testing::Test {
 protected:
  void write(const std::string& name, const Rgb& color) {
    LayeredImage image;
    image.width = 3;
    image.height = 2;
    image.setRgb("", ImageRgb(3, 2, color));
    const Expected<void> written = writeImage(folder_ / name, image);
    ASSERT_TRUE(written) << written.error().message();
  }
  Expected<SceneDescription> load(const std::string& lines) const {
    return parseSceneToml(sceneWith("[texture.t]\ntype = \"image\"\n" + lines +
                                    "\n[material.wall]\ndiffuse = {texture = \"t\"}\n"),
                          folder_ / "scene.toml");
  }
  void expectRefused(const std::string& lines, const std::string& words) const {
    const Expected<SceneDescription> scene = load(lines);
    ASSERT_FALSE(scene);
    EXPECT_THAT(scene.error().message(), HasSubstr(words));
  }

  TemporaryFolder folder_;
};

TEST_F(LoadImageTexture, IsLinearLight) {
  write("grey.png", Rgb(0.5f));
  const Expected<SceneDescription> scene =
      load("file = \"grey.png\"\nwrap = \"clamp\"\nfilter = \"nearest\"");
  ASSERT_TRUE(scene) << scene.error().message();
  const auto& image = std::get<ImageTextureDescription>(scene->textures.front().pattern);
  EXPECT_EQ(image.wrap, TextureWrap::Clamp);
  EXPECT_EQ(image.filter, TextureFilter::Nearest);
  ASSERT_TRUE(image.pixels);
  EXPECT_EQ(image.pixels->width(), 3);
  // Eight bits of sRGB.
  for (const Rgb& pixel : *image.pixels) EXPECT_NEAR(pixel.g, 0.5f, 0.005f);
}

TEST_F(LoadImageTexture, MayBeOfAlpha) {
  ASSERT_TRUE(writeFileAtomically(folder_ / "a.png", pngWithAlpha()));
  const auto pixelsOf = [&](const std::string& lines) {
    const Expected<SceneDescription> scene = load(lines);
    EXPECT_TRUE(scene) << scene.error().message();
    return std::get<ImageTextureDescription>(scene->textures.front().pattern).pixels;
  };
  EXPECT_EQ(pixelsOf("file = \"a.png\"\nchannel = \"alpha\"")->at(1, 1), Rgb(0.2f));
  EXPECT_EQ(pixelsOf("file = \"a.png\"")->at(1, 1), Rgb(1.0f));
  write("grey.png", Rgb(0.5f));
  EXPECT_EQ(pixelsOf("file = \"grey.png\"\nchannel = \"alpha\"")->at(1, 1), Rgb(1.0f)) << "it has none";
}

TEST(LoadOpacity, IsANumberOrATexture) {
  EXPECT_EQ(wallOf("[material.wall]\nopacity = 0.25\n").opacity, (OpacityDescription{0.25, {}, 0.0}));
  const OpacityDescription cut = wallOf(R"(
[texture.t]
type = "checker"
[material.wall]
opacity = { texture = "t", scale = 2.0, value = 0.5, cutoff = 0.3 }
)")
                                     .opacity;
  EXPECT_EQ(cut, (OpacityDescription{0.5, TextureUse{0, 2.0}, 0.3}));
  expectRefused("[material.wall]\nopacity = 1.5\n", "opacity of [material.wall]");
  expectRefused("[material.wall]\nopacity = {texture = \"no\"}\n", "there is no texture \"no\"");
  expectRefused("[material.wall]\nopacity = 0.5\nemission = [1, 1, 1]\n", "cannot stand beside emission");
}

TEST_F(LoadImageTexture, RefusesFilesThatAreNoReflectance) {
  expectRefused("file = \"none.png\"", "none.png");
  write("bright.exr", Rgb(1.5f));
  expectRefused("file = \"bright.exr\"", "what a surface reflects lies in [0, 1]");
  write("nan.exr", Rgb(std::numeric_limits<float>::quiet_NaN()));
  expectRefused("file = \"nan.exr\"", "what a surface reflects lies in [0, 1]");
  expectRefused("wrap = \"repeat\"", "file");
  write("grey.png", Rgb(0.5f));
  expectRefused("file = \"grey.png\"\nwrap = \"mirror\"", "repeat");
}

// The picture, not its name, is what a scene is known by; and a scene without textures is known by what it
// always was.
TEST_F(LoadImageTexture, IsPartOfTheHash) {
  write("a.png", Rgb(0.5f));
  write("b.png", Rgb(0.5f));
  write("c.png", Rgb(0.6f));
  const auto hashOf = [&](const std::string& lines) {
    const Expected<SceneDescription> scene = load(lines);
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? sceneHash(*scene) : std::string();
  };
  const std::string a = hashOf("file = \"a.png\"");
  EXPECT_EQ(a, hashOf("file = \"b.png\""));
  EXPECT_NE(a, hashOf("file = \"c.png\""));
  EXPECT_NE(a, hashOf("file = \"a.png\"\nwrap = \"clamp\""));
  EXPECT_NE(a, hashOf("file = \"a.png\"\nfilter = \"nearest\""));
}

// A texture belongs to the world: another shape far away changes the normalisation and not the wall.
TEST(CompiledTexture, StaysWhereItIs) {
  const std::string tables = R"(
[texture.stone]
type = "marble"
[material.wall]
diffuse = {texture = "stone", scale = 0.7}
)";
  const auto compiled = [&](const std::string& more) {
    const Expected<SceneDescription> description = parseSceneToml(sceneWith(tables) + more, "scene.toml");
    EXPECT_TRUE(description) << description.error().message();
    return *Scene::compile(*description);
  };
  const std::shared_ptr<const Scene> alone = compiled("");
  const std::shared_ptr<const Scene> beside =
      compiled("[[shape]]\ntype = \"sphere\"\nmaterial = \"wall\"\ncenter = [7, 5, -30]\nradius = 2\n");
  ASSERT_NE(alone->normalisation.lengthExponent, beside->normalisation.lengthExponent);
  const TextureUse use = *alone->materials.front().textures.diffuse;
  for (int i = 0; i < 200; ++i) {
    const Vec3d place(std::sin(i), std::cos(3.0 * i), 0.0);
    const Rgb a = alone->textureColor(use, alone->normalisation.point(place), Vec2(0.0f));
    const Rgb b = beside->textureColor(use, beside->normalisation.point(place), Vec2(0.0f));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-4f) << i;
    EXPECT_EQ(a,
              Texture({"", MarbleDescription{}})
                  .at(alone->normalisation.scenePoint(alone->normalisation.point(place)) / 0.7, Vec2(0.0f)));
  }
}

}  // namespace
}  // namespace lightvane::test
