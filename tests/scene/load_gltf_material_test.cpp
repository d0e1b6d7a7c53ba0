// glTF files: materials and their pictures.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/image/image_file.h"
#include "core/scene/scene.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/load_support.h"

namespace lightvane {
namespace {

using test::GltfFolder;
using test::GltfText;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

MATCHER_P2(IsNear, color, tolerance, "") {
  return glm::length(arg - Rgb(color)) <= static_cast<float>(tolerance);
}

class LoadGltfMaterial : public testing::Test, protected GltfFolder {
 protected:
  /// Reads a triangle of this material; what else there is stays in `read_`.
  MaterialDescription materialOf(const std::string& json, GltfText text = {}) {
    text.triangle("", R"(,"material":0)").set("materials", "[" + json + "]");
    read_ = scene(text);
    return read_.materials.empty() ? MaterialDescription{} : read_.materials.front();
  }
  /// The file of a picture whose upper half is of one colour and its lower half of another; linear.
  std::string png(const Rgb& above, const Rgb& below) const {
    LayeredImage image;
    image.width = image.height = 2;
    ImageRgb pixels(2, 2, above);
    pixels.at(0, 1) = pixels.at(1, 1) = below;
    image.setRgb("", pixels);
    const Expected<void> written = writeImage(folder / "a.png", image);
    EXPECT_TRUE(written) << written.error().message();
    return readFile(folder / "a.png").value();
  }
  /// What a texture of the scene's is; without pixels where there is none.
  ImageTextureDescription pictureOf(const std::optional<TextureUse>& use) const {
    if (!use) return {};
    return std::get<ImageTextureDescription>(read_.textures.at(use->texture).pattern);
  }
  /// What a colour and its texture are in the given row.
  Rgb at(const Rgb& color, const std::optional<TextureUse>& use, int row) const {
    const ImageTextureDescription image = pictureOf(use);
    return image.pixels ? color * image.pixels->at(0, row) : color;
  }
  /// A file with one texture, of the picture a.png.
  static GltfText withTexture(const std::string& more = "") {
    GltfText text;
    text.set("images", R"([{"uri":"a.png"}])").set("textures", R"([{"source":0)" + more + "}]");
    return text;
  }

  SceneDescription read_;
};

TEST_F(LoadGltfMaterial, IsDiffuseBelowALayerUnlessItIsMetal) {
  const std::string color = R"("baseColorFactor":[0.8,0.4,0.2,1],"roughnessFactor":0.3)";
  const MaterialDescription plastic =
      materialOf(R"({"name":"p","pbrMetallicRoughness":{"metallicFactor":0,)" + color + "}}");
  EXPECT_EQ(plastic.name, "a.gltf: p");
  EXPECT_EQ(plastic.diffuse, Rgb(0.8f, 0.4f, 0.2f));
  ASSERT_EQ(plastic.layers.size(), 1U);
  EXPECT_THAT(plastic.layers[0].color, IsNear(0.04f, 1e-7)) << "((1.5 - 1) / (1.5 + 1))^2";
  EXPECT_EQ(plastic.layers[0].roughness, 0.3);
  EXPECT_EQ(plastic.layers[0].model, LayerModel::Ggx);

  const MaterialDescription metal = materialOf(R"({"pbrMetallicRoughness":{)" + color + "}}");
  EXPECT_EQ(metal.diffuse, Rgb(0.0f));
  EXPECT_EQ(metal.layers,
            (std::vector<LayerDescription>{{Rgb(0.8f, 0.4f, 0.2f), 0.3, 1.0, LayerModel::Ggx}}));

  const MaterialDescription half =
      materialOf(R"({"pbrMetallicRoughness":{"metallicFactor":0.25,)" + color + "}}");
  EXPECT_THAT(half.diffuse, IsNear(Rgb(0.6f, 0.3f, 0.15f), 1e-6));
  EXPECT_THAT(half.layers.at(0).color, IsNear(Rgb(0.23f, 0.13f, 0.08f), 1e-6));
  EXPECT_THAT(materialOf("{}").layers, (std::vector<LayerDescription>{{Rgb(1), 1.0, 1.0, LayerModel::Ggx}}));
}

TEST_F(LoadGltfMaterial, GoesByIorAndSpecular) {
  const auto layerBy = [this](const std::string& extensions) {
    return materialOf(R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{)" + extensions + "}}")
        .layers.at(0)
        .color;
  };
  EXPECT_THAT(layerBy(R"("KHR_materials_ior":{"ior":2})"), IsNear(1.0f / 9.0f, 1e-7));
  EXPECT_THAT(layerBy(R"("KHR_materials_specular":{"specularFactor":0.5,"specularColorFactor":[1,0,40]})"),
              IsNear(Rgb(0.02f, 0.0f, 0.5f), 1e-7));
  EXPECT_THAT(materialOf(R"({"pbrMetallicRoughness":{"metallicFactor":0},
                            "extensions":{"KHR_materials_specular":{"specularFactor":0}}})")
                  .layers,
              IsEmpty());
}

// (ior - 1) / (ior + 1) has a pole at -1, and nothing refracts by less than air does.
TEST_F(LoadGltfMaterial, TakesAnIorThatIsNoneAsThatOfAir) {
  for (const char* ior : {"-1", "-2", "-1e300", "0.5", "1"}) {
    const MaterialDescription plain = materialOf(
        R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{"KHR_materials_specular":
        {"specularColorFactor":[1,0.5,0]},"KHR_materials_ior":{"ior":)" +
        std::string(ior) + "}}}");
    EXPECT_THAT(plain.layers, IsEmpty()) << ior;
    EXPECT_TRUE(Scene::compile(read_)) << ior;
    const auto isSaid = Contains(HasSubstr("an ior below 1, other than 0, is taken as 1"));
    if (ior == std::string_view("1")) {
      EXPECT_THAT(read_.warnings, Not(isSaid));
    } else {
      EXPECT_THAT(read_.warnings, isSaid) << ior;
    }
    EXPECT_EQ(materialOf(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
        "KHR_materials_ior":{"ior":)" +
                         std::string(ior) + R"(}},"pbrMetallicRoughness":{"metallicFactor":0}})")
                  .ior,
              1.0)
        << ior;
  }
  EXPECT_THAT(
      materialOf(
          R"({"pbrMetallicRoughness":{"metallicFactor":0},"extensions":{"KHR_materials_ior":{"ior":0}}})")
          .layers.at(0)
          .color,
      IsNear(Rgb(1.0f), 1e-7));
}

// Whatever is wrong with a loader: a number that is none of a material ends in a message.
TEST_F(LoadGltfMaterial, RefusesNumbersThatAreNoneOfAMaterial) {
  const auto refusal = [this](const auto& spoil) {
    materialOf(R"({"name":"cloth"})");
    spoil(read_.materials.at(0));
    const auto scene = Scene::compile(read_);
    return scene ? std::string() : scene.error().message();
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal([](MaterialDescription&) {}), "");
  EXPECT_THAT(
      refusal([](MaterialDescription& m) { m.diffuse.g = kNan; }),
      HasSubstr(
          "a.gltf: material 'a.gltf: cloth': diffuse: expected numbers from 0 to 1, found [0, nan, 0]"));
  EXPECT_THAT(refusal([](MaterialDescription& m) { m.layers.at(0).color = Rgb(1.5f); }),
              HasSubstr("color of a layer"));
  EXPECT_THAT(refusal([](MaterialDescription& m) { m.layers.at(0).roughness = std::nan(""); }),
              HasSubstr("roughness"));
  EXPECT_THAT(refusal([](MaterialDescription& m) { m.emission.r = std::numeric_limits<float>::infinity(); }),
              HasSubstr("emission: expected finite numbers, 0 or above, found [inf, 0, 0]"));
  EXPECT_THAT(refusal([](MaterialDescription& m) { m.ior = -1.0; }), HasSubstr("ior"));
  EXPECT_THAT(refusal([](MaterialDescription& m) { m.opacity.value = 2.0; }), HasSubstr("opacity"));
}

TEST_F(LoadGltfMaterial, TakesTheLargerPartOfWhatIsGlassInPart) {
  const auto glassOf = [this](const std::string& transmission, const std::string& metallic = "0") {
    return materialOf(R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],"roughnessFactor":0,
      "metallicFactor":)" +
                      metallic + R"(},"extensions":{"KHR_materials_ior":{"ior":1.33},
      "KHR_materials_transmission":{"transmissionFactor":)" +
                      transmission + "}}}");
  };
  const MaterialDescription whole = glassOf("1");
  EXPECT_EQ(whole.transmission, Rgb(1.0f, 0.5f, 0.25f));
  EXPECT_EQ(whole.ior, 1.33);
  EXPECT_TRUE(whole.thin);
  const MaterialDescription ball = materialOf(
      R"({"pbrMetallicRoughness":{"metallicFactor":0,"roughnessFactor":0},"extensions":{"KHR_materials_transmission":
      {"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":0.5}}})");
  EXPECT_TRUE(ball.isGlass() && !ball.thin) << "what has a volume bends light";
  EXPECT_TRUE(isBlack(whole.diffuse) && whole.layers.empty());
  EXPECT_THAT(read_.warnings, testing::Not(Contains(HasSubstr("glass"))));
  EXPECT_THAT(glassOf("0.75").transmission, IsNear(Rgb(0.75f, 0.375f, 0.1875f), 1e-7));
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("glass in part")));
  EXPECT_EQ(glassOf("0.25").diffuse, Rgb(0.75f, 0.375f, 0.1875f));
  EXPECT_FALSE(glassOf("1", "1").isGlass()) << "metals let nothing through";
}

TEST_F(LoadGltfMaterial, SaysThatVolumesAreClear) {
  const auto warningsBy = [this](const std::string& volume) {
    GltfText text;
    text.set("extensionsUsed", R"(["KHR_materials_transmission","KHR_materials_volume"])");
    materialOf(R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":1},
      "KHR_materials_volume":{"thicknessFactor":0.5)" +
                   volume + "}}}",
               text);
    return read_.warnings;
  };
  EXPECT_THAT(warningsBy(""), testing::Not(Contains(HasSubstr("not used"))));
  EXPECT_THAT(warningsBy(R"(,"attenuationDistance":0.1)"),
              Contains(HasSubstr("not used: attenuation within glass")));
}

TEST_F(LoadGltfMaterial, Emits) {
  const MaterialDescription lamp = materialOf(R"({"emissiveFactor":[1,0.5,0.25],"doubleSided":true,
    "extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":12}}})");
  EXPECT_EQ(lamp.emission, Rgb(12, 6, 3));
  EXPECT_TRUE(lamp.twoSided);
  EXPECT_THAT(read_.lights, IsEmpty()) << "no sky beside a lamp";
  EXPECT_FALSE(materialOf(R"({"emissiveFactor":[1,1,1]})").twoSided);
  EXPECT_FALSE(materialOf(R"({"doubleSided":true})").twoSided) << "it is about emission";
}

TEST_F(LoadGltfMaterial, ReadsPicturesFromFilesViewsAndUris) {
  const std::string picture = png(Rgb(0.25f), Rgb(1.0f, 0.0f, 0.0f));
  const std::string jpeg =
      readFile(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "tests/image/data/halves.jpg").value();
  GltfText text;
  const int pngView = text.view(picture);
  const int jpegView = text.view(jpeg);
  const std::vector<std::string> images = {
      R"({"uri":"a%2Epng"})", fmt::format(R"({{"bufferView":{},"mimeType":"image/png"}})", pngView),
      R"({"uri":"data:image/png;base64,)" + test::base64(picture) + "\"}",
      fmt::format(R"({{"bufferView":{},"mimeType":"image/jpeg"}})", jpegView)};
  for (std::size_t i = 0; i < images.size(); ++i) {
    text.set("images", "[" + images[i] + "]").set("textures", R"([{"source":0}])");
    const MaterialDescription material = materialOf(
        R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":{"index":0},
            "baseColorFactor":[0.5,1,1,1]}})",
        text);
    EXPECT_EQ(material.diffuse, Rgb(0.5f, 1.0f, 1.0f)) << "what the picture is multiplied by";
    EXPECT_FALSE(material.textures.ofLayers());
    const ImageTextureDescription image = pictureOf(material.textures.diffuse);
    ASSERT_TRUE(image.pixels) << i;
    // 8 bits of sRGB are 0.004 apart there.
    EXPECT_THAT(image.pixels->at(0, 0), IsNear(i < 3 ? 0.25f : 1.0f, 0.006f)) << i;
    EXPECT_EQ(image.pixels->at(1, 1), i < 3 ? Rgb(1.0f, 0.0f, 0.0f) : Rgb(1.0f)) << i;
    EXPECT_EQ(image.wrap, TextureWrap::Repeat);
    EXPECT_EQ(image.filter, TextureFilter::Linear);
  }
}

TEST_F(LoadGltfMaterial, TexturesMetalsAndGlass) {
  png(Rgb(0.5f), Rgb(0.5f));
  const std::string base = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0})";
  const MaterialDescription metal = materialOf("{" + base + "}}", withTexture());
  EXPECT_TRUE(metal.textures.layers[0] && !metal.textures.diffuse);
  EXPECT_EQ(metal.layers.at(0).color, Rgb(1.0f));
  const MaterialDescription glass = materialOf(
      "{" + base +
          R"(,"metallicFactor":0},"extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})",
      withTexture());
  EXPECT_TRUE(glass.textures.transmission && !glass.textures.diffuse);
}

TEST_F(LoadGltfMaterial, MixesWhatIsMetalInPart) {
  png(Rgb(0.5f), Rgb(1.0f, 0.0f, 0.0f));
  const MaterialDescription mixed = materialOf(
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"baseColorFactor":[0.8,1,1,1],
          "metallicFactor":0.25}})",
      withTexture());
  EXPECT_THAT(at(mixed.diffuse, mixed.textures.diffuse, 0), IsNear(0.75f * Rgb(0.4f, 0.5f, 0.5f), 0.004));
  EXPECT_THAT(at(mixed.diffuse, mixed.textures.diffuse, 1), IsNear(0.75f * Rgb(0.8f, 0.0f, 0.0f), 0.004));
  // 0.75 0.04 + 0.25 of the base.
  ASSERT_EQ(mixed.layers.size(), 1U);
  const Rgb layer = mixed.layers[0].color;
  EXPECT_THAT(at(layer, mixed.textures.layers[0], 0), IsNear(Rgb(0.13f, 0.155f, 0.155f), 0.004));
  EXPECT_THAT(at(layer, mixed.textures.layers[0], 1), IsNear(Rgb(0.23f, 0.03f, 0.03f), 0.004));
}

// A plate half of which is painted, and a finer picture of its colour.
TEST_F(LoadGltfMaterial, IsMetalWhereItsPictureSaysSo) {
  png(Rgb(0, 1, 1), Rgb(0, 1, 0));
  LayeredImage fine;
  fine.width = fine.height = 4;
  ImageRgb colors(4, 4, Rgb(1.0f));
  colors.at(3, 3) = Rgb(0, 0, 1);
  fine.setRgb("", colors);
  ASSERT_TRUE(writeImage(folder / "b.png", fine));
  GltfText text;
  text.set("images", R"([{"uri":"a.png"},{"uri":"b.png"}])");
  text.set("textures", R"([{"source":0},{"source":1}])");
  const std::string factors = R"("baseColorFactor":[0.8,0.6,0.4,1],"roughnessFactor":0.5,)";
  const MaterialDescription plate =
      materialOf(R"({"pbrMetallicRoughness":{)" + factors +
                     R"("baseColorTexture":{"index":1},"metallicRoughnessTexture":{"index":0}}})",
                 text);
  const ImageTextureDescription diffuse = pictureOf(plate.textures.diffuse);
  const ImageTextureDescription layer = pictureOf(plate.textures.layers[0]);
  ASSERT_TRUE(diffuse.pixels && layer.pixels);
  ASSERT_EQ(layer.pixels->width(), 4) << "as fine as the finer one";
  // The coarse picture, which repeats, has 3/4 of its metal in the upper half and 1/4 in the lower.
  const Rgb base(0.8f, 0.6f, 0.4f);
  EXPECT_THAT(plate.diffuse * diffuse.pixels->at(1, 1), IsNear(0.25f * base, 1e-5));
  EXPECT_THAT(plate.diffuse * diffuse.pixels->at(1, 2), IsNear(0.75f * base, 1e-5));
  EXPECT_THAT(plate.diffuse * diffuse.pixels->at(3, 3), IsNear(Rgb(0.0f, 0.0f, 0.3f), 1e-5));
  const Rgb color = plate.layers.at(0).color;
  EXPECT_THAT(color * layer.pixels->at(0, 0), IsNear(0.75f * base + 0.01f, 1e-5));
  EXPECT_THAT(color * layer.pixels->at(3, 3), IsNear(Rgb(0.03f, 0.03f, 0.13f), 1e-5));
  EXPECT_EQ(plate.layers[0].roughness, 0.5);
  EXPECT_EQ(read_.textures.size(), 2U) << "the base's own is not used";
  EXPECT_THAT(read_.warnings, testing::Not(Contains(HasSubstr("the mean is taken"))));
}

TEST_F(LoadGltfMaterial, SharesTexturesThatAreTheSame) {
  png(Rgb(0.5f), Rgb(0.5f));
  GltfText text;
  const int positions = text.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string primitives;
  for (int i = 0; i < 4; ++i)
    primitives +=
        fmt::format(R"({}{{"attributes":{{"POSITION":{}}},"material":{}}})", i ? "," : "", positions, i);
  text.set("meshes", R"([{"primitives":[)" + primitives + "]}]").set("images", R"([{"uri":"a.png"}])");
  text.set("samplers", R"([{"wrapS":33071,"wrapT":33071,"magFilter":9728},{"wrapS":33648,"wrapT":10497}])");
  text.set("textures", R"([{"source":0},{"source":0},{"source":0,"sampler":0},{"source":0,"sampler":1}])");
  std::string materials;
  for (int i = 0; i < 4; ++i)
    materials +=
        fmt::format(R"({}{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{}}}}}}})", i ? "," : "", i);
  read_ = scene(text.set("materials", "[" + materials + "]"));
  ASSERT_EQ(read_.textures.size(), 2U) << "the first two are one, and the mirrored one is taken as that";
  const auto& clamped = std::get<ImageTextureDescription>(read_.textures[1].pattern);
  EXPECT_EQ(clamped.wrap, TextureWrap::Clamp);
  EXPECT_EQ(clamped.filter, TextureFilter::Nearest);
  EXPECT_EQ(clamped.pixels, std::get<ImageTextureDescription>(read_.textures[0].pattern).pixels);
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("repeat mirrored")));
}

TEST_F(LoadGltfMaterial, MovesTextureCoordinatesAsItsTextureDoes) {
  png(Rgb(0.5f), Rgb(0.5f));
  GltfText text = withTexture();
  const int uvs = text.accessor(text.view(test::floats({0, 0, 1, 0, 0, 1})), test::kFloat, 3, "VEC2");
  text.triangle(fmt::format(R"(,"TEXCOORD_1":{})", uvs), R"(,"material":0)");
  text.set("materials", R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":{
    "KHR_texture_transform":{"texCoord":1,"offset":[0.5,0.25],"scale":[2,4],"rotation":1.5707963267948966}}}}}])");
  const SceneDescription read = scene(text);
  const std::vector<Vec2> places = meshOf(read).uvs;
  ASSERT_EQ(places.size(), 3U);
  // Turned counter-clockwise as seen where v runs down: u goes to -v, v to u. Then v is turned up.
  const std::vector<Vec2> expected = {{0.5f, 0.75f}, {0.5f, 2.75f}, {4.5f, 0.75f}};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT(glm::length(places[i] - expected[i]), 1e-6f) << i;
}

TEST_F(LoadGltfMaterial, TakesMeansOfWhatCannotVary) {
  // As stored: roughness 0 and 1, metalness 1 and 0.
  png(Rgb(0, 0, 1), Rgb(0, 1, 0));
  const auto read = [this](const std::string& where) {
    return materialOf(
        R"({"pbrMetallicRoughness":{"roughnessFactor":0.5,"metallicRoughnessTexture":{"index":0)" + where +
            R"(},"baseColorTexture":{"index":0}}})",
        withTexture());
  };
  EXPECT_DOUBLE_EQ(read("").layers.at(0).roughness, 0.25);
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("of pictures of roughness the mean is taken")));
  EXPECT_THAT(read_.warnings, testing::Not(Contains(HasSubstr("metalness"))));
  // A mesh is read with one set of texture coordinates: half a metal everywhere.
  const MaterialDescription material = read(R"(,"texCoord":1)");
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("of pictures of metalness")));
  EXPECT_THAT(at(material.diffuse, material.textures.diffuse, 0), IsNear(Rgb(0, 0, 0.5f), 1e-6));
  EXPECT_THAT(at(material.layers.at(0).color, material.textures.layers[0], 1),
              IsNear(Rgb(0.02f, 0.52f, 0.02f), 1e-6));
}

TEST_F(LoadGltfMaterial, BakesPicturesOnceForAllMaterialsThatShareThem) {
  png(Rgb(0, 1, 1), Rgb(0, 1, 0));
  GltfText text = withTexture();
  const int positions = text.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  std::string primitives, materials;
  for (int i = 0; i < 3; ++i) {
    primitives +=
        fmt::format(R"({}{{"attributes":{{"POSITION":{}}},"material":{}}})", i ? "," : "", positions, i);
    materials += fmt::format(
        R"({}{{"pbrMetallicRoughness":{{"metallicRoughnessTexture":{{"index":0}},"baseColorFactor":[{},1,1,1]}}}})",
        i ? "," : "", i < 2 ? 1.0 : 0.5);
  }
  text.set("meshes", R"([{"primitives":[)" + primitives + "]}]");
  read_ = scene(text.set("materials", "[" + materials + "]"));
  ASSERT_EQ(read_.materials.size(), 3U);
  EXPECT_EQ(read_.textures.size(), 4U);
  EXPECT_EQ(read_.materials[0].textures.layers[0], read_.materials[1].textures.layers[0]);
  EXPECT_NE(read_.materials[0].textures.layers[0], read_.materials[2].textures.layers[0]);
}

TEST_F(LoadGltfMaterial, SaysWhereMetalIsClampedAsTheBaseColourIs) {
  png(Rgb(0, 1, 1), Rgb(0, 1, 0));
  GltfText text;
  text.set("images", R"([{"uri":"a.png"}])").set("samplers", R"([{"wrapS":33071,"wrapT":33071}])");
  text.set("textures", R"([{"source":0},{"source":0,"sampler":0}])");
  const auto warningsBy = [&](int base, int metal) {
    materialOf(fmt::format(R"({{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":{}}},
                               "metallicRoughnessTexture":{{"index":{}}}}}}})",
                           base, metal),
               text);
    return read_.warnings;
  };
  EXPECT_THAT(warningsBy(0, 1), Contains(HasSubstr("pictures of metalness are clamped")));
  EXPECT_THAT(warningsBy(1, 1), testing::Not(Contains(HasSubstr("clamped"))));
}

// Pictures of one value are numbers, and so are those of one but for what JPEG makes of it.
TEST_F(LoadGltfMaterial, BakesNothingWhereMetalnessIsTheSameEverywhere) {
  for (const float blue : {0.0f, 1.0f}) {
    png(Rgb(0, 1, blue), Rgb(0, 1, blue > 0.0f ? 1.0f : decodeSrgb(2.0f / 255.0f)));
    const MaterialDescription material = materialOf(
        R"({"pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0},"baseColorFactor":[1,0.5,0.25,1]}})",
        withTexture());
    EXPECT_THAT(read_.textures, IsEmpty());
    EXPECT_THAT(material.diffuse, IsNear((1.0f - blue) * Rgb(1.0f, 0.5f, 0.25f), 0.01));
  }
}

TEST_F(LoadGltfMaterial, EmitsItsPicture) {
  png(Rgb(0, 0, 1), Rgb(0, 1, 0));
  const std::string emissive = R"("emissiveFactor":[2,1,1],"emissiveTexture":{"index":0)";
  const std::string moved = R"(,"extensions":{"KHR_texture_transform":{"offset":[0.5,0]}})";
  const auto emissionBy = [&](const std::string& base, const std::string& where) {
    return materialOf("{" + base + emissive + where + "}}", withTexture());
  };
  const std::string base = R"("pbrMetallicRoughness":{"baseColorTexture":{"index":0}},)";
  const std::string metal = R"("pbrMetallicRoughness":{"metallicRoughnessTexture":{"index":0}},)";
  EXPECT_TRUE(emissionBy(metal, moved).textures.emission) << "its own, where the base colour has no picture";
  for (const auto& [b, where] : {std::pair<std::string, std::string>{"", ""}, {"", moved}, {base, ""}}) {
    const MaterialDescription material = emissionBy(b, where);
    EXPECT_EQ(material.emission, Rgb(2, 1, 1)) << "what the picture is multiplied by";
    const ImageTextureDescription image = pictureOf(material.textures.emission);
    ASSERT_TRUE(image.pixels) << b << where;
    EXPECT_EQ(image.pixels->at(0, 1), Rgb(0, 1, 0));
    EXPECT_EQ(read_.textures.size(), 1U);
    EXPECT_THAT(read_.warnings, testing::Not(Contains(HasSubstr("the mean is taken"))));
  }
  // A mesh is read with one set of texture coordinates, moved in one way.
  for (const std::string& where : {moved, std::string(R"(,"texCoord":1)")}) {
    const MaterialDescription material = emissionBy(base, where);
    EXPECT_EQ(material.emission, Rgb(0.0f, 0.5f, 0.5f)) << where;
    EXPECT_FALSE(material.textures.emission);
    EXPECT_THAT(read_.warnings, Contains(HasSubstr("of pictures of what is emitted")));
  }
  png(Rgb(0.0f), Rgb(0.0f));
  const MaterialDescription dark = emissionBy("", "");
  EXPECT_FALSE(dark.emits() || dark.textures.emission) << "what is all black is no light";
}

// The texture coordinates of what emits are those of its picture where there is no other.
TEST_F(LoadGltfMaterial, LaysWhatItEmitsOnItsOwnCoordinates) {
  png(Rgb(0.5f), Rgb(1.0f));
  GltfText text = withTexture();
  const int uvs = text.accessor(text.view(test::floats({0, 0, 1, 0, 0, 1})), test::kFloat, 3, "VEC2");
  text.triangle(fmt::format(R"(,"TEXCOORD_1":{})", uvs), R"(,"material":0)");
  text.set("materials", R"([{"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0,"texCoord":1}}])");
  const SceneDescription read = scene(text);
  EXPECT_EQ(meshOf(read).uvs, (std::vector<Vec2>{{0, 1}, {1, 1}, {0, 0}}));
  EXPECT_TRUE(read.materials.front().textures.emission);
}

TEST_F(LoadGltfMaterial, MultipliesByVertexColours) {
  const auto colorBy = [this](std::initializer_list<std::uint8_t> bytes) {
    GltfText text;
    const int colors =
        text.accessor(text.view(test::littleEndian(bytes)), test::kUbyte, 3, "VEC4", R"(,"normalized":true)");
    text.triangle(fmt::format(R"(,"COLOR_0":{})", colors));
    read_ = scene(text);
    return read_.materials.at(0).diffuse;
  };
  EXPECT_THAT(colorBy({51, 255, 0, 9, 51, 255, 0, 9, 51, 255, 0, 9}), IsNear(Rgb(0.14f, 0.7f, 0.0f), 1e-6));
  EXPECT_THAT(meshOf(read_).colors, IsEmpty()) << "the material has it";
  EXPECT_EQ(colorBy({255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 255, 9}), Rgb(0.7f));
  EXPECT_THAT(meshOf(read_).colors, testing::ElementsAre(Rgb(1, 0, 0), Rgb(0, 1, 0), Rgb(0, 0, 1)));
  EXPECT_THAT(read_.warnings, testing::Not(Contains(HasSubstr("vertex colours"))));
}

TEST_F(LoadGltfMaterial, TakesTheMeanOfVertexColoursForMetals) {
  GltfText text;
  const int colors =
      text.accessor(text.view(test::floats({1, 0, 0, 0, 1, 0, 0, 0, 1})), test::kFloat, 3, "VEC3");
  text.triangle(fmt::format(R"(,"COLOR_0":{})", colors), R"(,"material":0)");
  read_ = scene(text.set("materials", R"([{"pbrMetallicRoughness":{"roughnessFactor":0.5}}])"));
  EXPECT_THAT(read_.materials.at(0).layers.at(0).color, IsNear(1.0f / 3.0f, 1e-6));
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("of vertex colours that differ within a metal mesh")));
}

TEST_F(LoadGltfMaterial, SaysThatAlphaOfVerticesIsNotUsed) {
  const auto warningsBy = [this](const std::string& mode) {
    GltfText text;
    const int colors = text.accessor(text.view(test::floats({1, 1, 1, 1, 1, 1, 1, 0.5f, 1, 1, 1, 1})),
                                     test::kFloat, 3, "VEC4");
    text.triangle(fmt::format(R"(,"COLOR_0":{})", colors), R"(,"material":0)");
    return scene(text.set("materials", R"([{"alphaMode":")" + mode + "\"}]")).warnings;
  };
  EXPECT_THAT(warningsBy("BLEND"), Contains(HasSubstr("not used: alpha of vertices")));
  EXPECT_THAT(warningsBy("OPAQUE"), testing::Not(Contains(HasSubstr("alpha"))));
}

TEST_F(LoadGltfMaterial, TakesAlphaForOpacity) {
  ASSERT_TRUE(writeFileAtomically(folder / "a.png", test::pngWithAlpha()));
  const std::string base =
      R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5],"baseColorTexture":{"index":0}})";
  const auto opacityBy = [&](const std::string& json, GltfText text) {
    return materialOf("{" + json + "}", std::move(text)).opacity;
  };
  EXPECT_TRUE(opacityBy(base, withTexture()).isFull()) << "opaque unless it says otherwise";

  OpacityDescription opacity = opacityBy(R"("alphaMode":"BLEND",)" + base, withTexture());
  EXPECT_EQ(opacity.value, 0.5);
  EXPECT_EQ(opacity.cutoff, 0.0);
  const ImageTextureDescription alpha = pictureOf(opacity.texture);
  EXPECT_EQ(alpha.channel, TextureChannel::Alpha);
  ASSERT_TRUE(alpha.pixels);
  EXPECT_EQ(alpha.pixels->at(0, 0), Rgb(1.0f));
  EXPECT_EQ(alpha.pixels->at(1, 0), Rgb(0.0f));
  EXPECT_EQ(alpha.pixels->at(0, 1), Rgb(0.6f));
  const ImageTextureDescription color = pictureOf(read_.materials.front().textures.diffuse);
  EXPECT_EQ(color.channel, TextureChannel::Color);

  EXPECT_EQ(opacityBy(R"("alphaMode":"MASK",)" + base, withTexture()).cutoff, 0.5);
  opacity = opacityBy(R"("alphaMode":"MASK","alphaCutoff":0.3)", {});
  EXPECT_EQ(opacity, (OpacityDescription{1.0, {}, 0.3}));
  EXPECT_TRUE(opacity.isFull());
  EXPECT_EQ(opacityBy(R"("alphaMode":"MASK","alphaCutoff":1.5)", {}).value, 0.0);
  EXPECT_TRUE(opacityBy(R"("alphaMode":"MASK","alphaCutoff":0,)" + base, withTexture()).isFull());
  EXPECT_TRUE(opacityBy(R"("alphaMode":"BLEND","emissiveFactor":[1,1,1],)" + base, withTexture()).isFull());
  EXPECT_THAT(read_.warnings, Contains(HasSubstr("not used: alpha of what shines")));
}

TEST_F(LoadGltfMaterial, NamesWhatIsNotUsed) {
  png(Rgb(0.5f), Rgb(0.5f));
  materialOf(R"({"normalTexture":{"index":0},"occlusionTexture":{"index":0},
    "extensions":{"KHR_materials_specular":{"specularTexture":{"index":0}}}})",
             withTexture());
  EXPECT_THAT(read_.warnings,
              Contains(HasSubstr("not used: normal textures, occlusion textures, specular textures")));
}

TEST_F(LoadGltfMaterial, LeavesOutPicturesThatCannotBeRead) {
  const auto warningBy = [this](const std::string& image) {
    GltfText text;
    text.view("no picture");
    text.views.push_back(R"({"buffer":0,"byteOffset":8,"byteLength":4000000000})");
    text.set("images", "[" + image + "]").set("textures", R"([{"source":0}])");
    const MaterialDescription material =
        materialOf(R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})", text);
    EXPECT_FALSE(material.textures.any()) << image;
    return read_.warnings.front();
  };
  EXPECT_THAT(warningBy(R"({"uri":"none.png","name":"wood"})"),
              testing::AllOf(HasSubstr("picture 0 (wood) is not used"), HasSubstr("none.png: no such file")));
  EXPECT_THAT(warningBy(R"({"uri":"/etc/wood.png"})"), HasSubstr("is not relative to the file"));
  EXPECT_THAT(warningBy(R"({"uri":"a/../../wood.png"})"), HasSubstr("lies outside the file's folder"));
  EXPECT_THAT(warningBy(R"({"uri":"%ff.png"})"), HasSubstr(": no such file"));
  EXPECT_THAT(warningBy(R"({"uri":"data:image/webp;base64,AAAA"})"), HasSubstr("no PNG or JPEG picture"));
  EXPECT_THAT(warningBy(R"({"bufferView":0})"), HasSubstr("is neither a PNG nor a JPEG picture"));
  EXPECT_THAT(warningBy(R"({"bufferView":1})"), HasSubstr("view 1: 4000000000 bytes from 8 on do not fit"));
  // A picture of 0 by 0 pixels: its size stands from byte 16 on.
  std::string empty = png(Rgb(0.5f), Rgb(0.5f));
  empty.replace(16, 8, 8, '\0');
  folder.write("empty.png", empty);
  EXPECT_THAT(warningBy(R"({"uri":"empty.png"})"), HasSubstr("empty.png: "));
}

}  // namespace
}  // namespace lightvane
