#include "core/scene/load_obj.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/image/image_file.h"
#include "tests/scene/load_support.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kObjSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

class LoadObj : public testing::Test {
 protected:
  MeshFile load(const std::string& text) {
    Expected<MeshFile> mesh = loadObj(folder_.write("mesh.obj", text));
    EXPECT_TRUE(mesh) << mesh.error().message();
    return mesh ? *std::move(mesh) : MeshFile{};
  }
  /// The error without the folder's name.
  std::string errorOf(const std::string& text) {
    const Expected<MeshFile> mesh = loadObj(folder_.write("mesh.obj", text));
    if (mesh) return "none";
    const std::string message = mesh.error().message();
    return message.substr(folder_.path().string().size() + 1);
  }

  TemporaryFolder folder_;
};

/// The corners' positions, triangle by triangle.
std::vector<Vec3d> corners(const MeshGeometry& mesh) {
  std::vector<Vec3d> points;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) points.push_back(mesh.positions.at(t[i]));
  }
  return points;
}

TEST_F(LoadObj, ReadsATriangle) {
  const MeshFile mesh = load("# comment\nv 0 0 0\nv +1.5 0 0\r\nv 0 -2e-1 .5\n\nf 1 2 3\n");
  EXPECT_THAT(corners(mesh.geometry), ElementsAre(Vec3d(0), Vec3d(1.5, 0, 0), Vec3d(0, -0.2f, 0.5)));
  EXPECT_THAT(mesh.geometry.normals, IsEmpty());
  EXPECT_THAT(mesh.geometry.uvs, IsEmpty());
  EXPECT_THAT(mesh.warnings, IsEmpty());
}

TEST_F(LoadObj, CutsPolygonsIntoTrianglesAndSharesTheirVertices) {
  const MeshFile mesh = load(kObjSquare + "v 0.5 2 0\nf 1 2 3 5 4\n");
  EXPECT_EQ(mesh.geometry.triangles.size(), 3U);
  EXPECT_EQ(mesh.geometry.positions.size(), 5U);
}

TEST_F(LoadObj, CountsNegativeIndicesBackFromTheFace) {
  const MeshFile mesh = load("v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n");
  EXPECT_THAT(corners(mesh.geometry), ElementsAre(Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)));
}

TEST_F(LoadObj, ReadsFacesThatStandBeforeTheirVertices) {
  EXPECT_EQ(load("f 1 2 3\n" + kObjSquare).geometry.triangles.size(), 1U);
}

TEST_F(LoadObj, KeepsNormalsAndTextureCoordinatesOfEachCorner) {
  const MeshFile mesh = load(
      kObjSquare + "vn 0 0 1\nvn 0 1 0\nvt 0 0\nvt 0.25 0.5 9\nf 1/1/1 2/2/1 3/2/1\nf 1/1/2 3/2/2 4/1/2\n");
  // Two positions have two normals each.
  EXPECT_EQ(mesh.geometry.positions.size(), 6U);
  EXPECT_THAT(mesh.geometry.normals, ElementsAre(Vec3d(0, 0, 1), Vec3d(0, 0, 1), Vec3d(0, 0, 1),
                                                 Vec3d(0, 1, 0), Vec3d(0, 1, 0), Vec3d(0, 1, 0)));
  EXPECT_EQ(mesh.geometry.uvs.size(), 6U);
  EXPECT_EQ(mesh.geometry.uvs[1], Vec2(0.25f, 0.5f));
}

TEST_F(LoadObj, GivesCornersWithoutANormalThatOfTheirFace) {
  const MeshFile mesh =
      load(kObjSquare + "v 0 0 1\nvn 0.6 0 0.8\nvn 0 0 0\nf 1//1 2//1 3//1\nf 1 4 5\nf 1//2 2//2 3//2\n");
  EXPECT_THAT(mesh.geometry.normals,
              ElementsAre(Vec3d(0.6f, 0, 0.8f), Vec3d(0.6f, 0, 0.8f), Vec3d(0.6f, 0, 0.8f), Vec3d(1, 0, 0),
                          Vec3d(1, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 0, 1), Vec3d(0, 0, 1), Vec3d(0, 0, 1)));
}

TEST_F(LoadObj, MapsMaterialsOfTheMtlFile) {
  folder_.write(
      "colors.mtl",
      "newmtl unused\nKd 1 1 1\nnewmtl red\nKd 0.5 0.25 0\nKa 1 1 1\nbump a.png\nd 1\nnewmtl lamp\nKd 0 0 "
      "0\nKe 5 4 3\n");
  const MeshFile mesh = load("mtllib colors.mtl\n" + kObjSquare +
                             "f 1 2 3\nusemtl lamp\nf 1 2 3 4\nusemtl red\nf 1 2 3\nusemtl lamp\nf 1 2 4\n");
  ASSERT_EQ(mesh.materials.size(), 3U);  // in the order of their first use
  EXPECT_THAT(mesh.geometry.triangleMaterials, ElementsAre(0U, 1U, 1U, 2U, 1U));
  EXPECT_EQ(mesh.materials[0].diffuse, Rgb(0.7f));
  EXPECT_EQ(mesh.materials[1].name, "mesh.obj: lamp");
  EXPECT_EQ(mesh.materials[1].emission, Rgb(5, 4, 3));
  EXPECT_EQ(mesh.materials[1].diffuse, Rgb(0));
  EXPECT_EQ(mesh.materials[2].diffuse, Rgb(0.5, 0.25, 0));
  EXPECT_FALSE(mesh.materials[2].emits());
  EXPECT_THAT(
      mesh.materialWarnings,
      ElementsAre(
          HasSubstr(
              "colors.mtl: not used: Ka, bump (Kd, Ks, Ns, Ke, Ni, Tf, d, Tr, illum, map_Kd and map_Ke are)"),
          HasSubstr("triangles without a material get a diffuse grey of 0.7")));
}

/// The material `a` of this MTL text, with the file's textures and warnings.
class LoadMtl : public LoadObj {
 protected:
  MaterialDescription materialOf(const std::string& text) {
    folder_.write("a.mtl", "newmtl a\n" + text);
    mesh_ = load("mtllib a.mtl\n" + kObjSquare + "usemtl a\nf 1 2 3\n");
    return mesh_.materials.empty() ? MaterialDescription{} : mesh_.materials.front();
  }
  void writeGrey(const std::string& name) {
    LayeredImage image;
    image.width = image.height = 2;
    image.setRgb("", ImageRgb(2, 2, Rgb(0.5f)));
    const Expected<void> written = writeImage(folder_ / name, image);
    ASSERT_TRUE(written) << written.error().message();
  }

  MeshFile mesh_;
};

TEST_F(LoadMtl, LaysHighlightsOverTheDiffuseColour) {
  const MaterialDescription material = materialOf("Kd 0.5 0.25 0\nKs 0.04 0.04 0.04\nNs 198\nillum 2\n");
  ASSERT_EQ(material.layers.size(), 2U);
  EXPECT_EQ(material.layers[0], (LayerDescription{Rgb(0.04f), 0.01, 1.0}));
  EXPECT_EQ(material.layers[1], (LayerDescription{Rgb(0.5f, 0.25f, 0.0f), 1.0, 1.0}));
  EXPECT_EQ(material.diffuse, Rgb(0.0f));
  EXPECT_THAT(mesh_.materialWarnings, IsEmpty());
  EXPECT_EQ(materialOf("Kd 0 0 0\nKs 0.9 0.8 0.7\nNs 0\n").layers,
            (std::vector<LayerDescription>{{Rgb(0.9f, 0.8f, 0.7f), 1.0, 1.0}}));
}

TEST_F(LoadMtl, GoesByTheIlluminationModel) {
  const std::string colors = "Kd 0.5 0.5 0.5\nKs 0.9 0.9 0.9\nNs 20\nNi 1.33\nTf 0.5 0.75 1\n";
  EXPECT_EQ(materialOf(colors + "illum 1\n").diffuse, Rgb(0.5f));
  EXPECT_TRUE(materialOf(colors + "illum 1\n").layers.empty());
  EXPECT_EQ(materialOf(colors + "illum 3\n").layers.front().roughness, 0.0);
  const MaterialDescription glass = materialOf(colors + "illum 7\n");
  EXPECT_EQ(glass.transmission, Rgb(0.5f, 0.75f, 1.0f));
  EXPECT_FLOAT_EQ(static_cast<float>(glass.ior), 1.33f);
  EXPECT_TRUE(isBlack(glass.diffuse) && glass.layers.empty());
}

TEST_F(LoadMtl, TakesPicturesForTheDiffuseColour) {
  std::filesystem::create_directory(folder_ / "maps");
  writeGrey("maps/wall.png");
  MaterialDescription material = materialOf("Kd 0.5 0.6 0.7\nmap_Kd -clamp on -s 4 4 1 maps\\wall.png\n");
  EXPECT_EQ(material.diffuse, Rgb(0.5f, 0.6f, 0.7f));
  ASSERT_TRUE(material.textures.diffuse);
  EXPECT_EQ(*material.textures.diffuse, (TextureUse{0, 0.25}));
  ASSERT_EQ(mesh_.textures.size(), 1U);
  EXPECT_EQ(std::get<ImageTextureDescription>(mesh_.textures[0].pattern).wrap, TextureWrap::Clamp);
  material = materialOf("Kd 0 0 0\nKs 0.1 0.1 0.1\nmap_Kd maps/wall.png\n");
  ASSERT_EQ(material.layers.size(), 2U);
  EXPECT_EQ(material.layers[1].color, Rgb(1.0f)) << "black beside a picture is nobody's wish";
  EXPECT_TRUE(material.textures.layers[1]);
  EXPECT_THAT(mesh_.materialWarnings, IsEmpty());
}

// Where such files are written, names that differ in case are the same.
TEST_F(LoadMtl, FindsFilesWhateverTheCaseOfTheirNames) {
  std::filesystem::create_directory(folder_ / "maps");
  writeGrey("maps/wall.png");
  MaterialDescription material =
      materialOf("Kd 1 1 1\nmap_Kd maps/WALL.PNG\nKe 1 1 1\nmap_Ke maps/wall.png\n");
  EXPECT_TRUE(material.textures.diffuse && material.textures.diffuse == material.textures.emission);
  EXPECT_THAT(mesh_.materialWarnings,
              ElementsAre(HasSubstr("map_Kd of a: there is no maps/WALL.PNG: wall.png is taken")));
  writeGrey("maps/Wall.png");
  material = materialOf("Kd 1 1 1\nmap_Kd maps/WALL.PNG\n");
  EXPECT_FALSE(material.textures.diffuse) << "two could be meant";
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("map_Kd of a is not used")));
  material = materialOf("Kd 1 1 1\nmap_Kd maps/wall.png\n");
  EXPECT_TRUE(material.textures.diffuse);
  EXPECT_THAT(mesh_.materialWarnings, IsEmpty());
  folder_.write("colours.mtl", "newmtl a\nKd 1 0 0\n");
  EXPECT_EQ(load("mtllib Colours.MTL\n" + kObjSquare + "usemtl a\nf 1 2 3\n").materials.at(0).diffuse,
            Rgb(1, 0, 0));
}

TEST_F(LoadMtl, TakesNumbersIntoTheirRange) {
  const MaterialDescription material =
      materialOf("Kd 0.5 1.5 2\nKs 0.1\nNs -1\nNi 0\nTf xyz 1 1 1\nillum 11\nd -halo 0.5\n");
  ASSERT_EQ(material.layers.size(), 2U);
  EXPECT_EQ(material.layers[1].color, Rgb(0.5f, 1.0f, 1.0f));
  EXPECT_EQ(material.layers[0], (LayerDescription{Rgb(0.1f), 1.0, 1.0})) << "one number is all three";
  EXPECT_EQ(material.opacity.value, 0.5);
  EXPECT_THAT(mesh_.materialWarnings,
              ElementsAre(HasSubstr("a.mtl:2:8: Kd: expected three numbers in [0, 1], found 1.5: taken as 1"),
                          HasSubstr("a.mtl:4:4: Ns: expected a number of at least 0, found -1: taken as 0"),
                          HasSubstr("Ni: expected a number from 0.001 to 1000, found 0: left out"),
                          HasSubstr("illum: expected a number from 0 to 10, found 11: left out"),
                          HasSubstr("not used: Tf xyz, d -halo")));
}

TEST_F(LoadMtl, PassesOverComments) {
  writeGrey("a.png");
  writeGrey("b #2.png");
  const MaterialDescription material =
      materialOf("Kd .5 .25 1#x\nKd\nmap_Kd\nmap_Ke b #2.png\nmap_Kd a.png # the wall\nNs 5 # soft\n");
  EXPECT_EQ(material.diffuse, Rgb(0.5f, 0.25f, 1.0f));
  EXPECT_TRUE(material.textures.diffuse && material.textures.emission);
  EXPECT_THAT(mesh_.materialWarnings,
              ElementsAre(HasSubstr("a.mtl:3:1: Kd without a number"),
                          HasSubstr("a.mtl:4:1: map_Kd without the name of a picture")));
  folder_.write("a.mtl", "newmtl a\nKd 1 0 0\nnewmtl Material #25\nKd 0 1 0\n");
  const MeshFile mesh =
      load("mtllib a.mtl # mine\n" + kObjSquare + "usemtl a # red\nf 1 2 3\nusemtl Material #25\nf 1 3 4\n");
  ASSERT_EQ(mesh.materials.size(), 2U);
  EXPECT_EQ(mesh.materials[0].diffuse, Rgb(1, 0, 0));
  EXPECT_EQ(mesh.materials[1].diffuse, Rgb(0, 1, 0));
  EXPECT_THAT(mesh.materialWarnings, IsEmpty());
}

TEST_F(LoadMtl, ReadsTheOptionsOfPictures) {
  writeGrey("my wall.png");
  writeGrey("2.png");
  const auto useOf = [this](const std::string& map) {
    return materialOf("Kd 1 1 1\nmap_Kd " + map + "\n").textures.diffuse.value_or(TextureUse{99, 0.0});
  };
  EXPECT_EQ(useOf("-s 2 2 my wall.png"), (TextureUse{0, 0.5}));
  EXPECT_EQ(useOf("-s 2 2 2.png"), (TextureUse{0, 0.5}));
  EXPECT_EQ(useOf("-blendu on -cc off -bm 1.5 -s 4 4 4 \"my wall.png\""), (TextureUse{0, 0.25}));
  EXPECT_THAT(mesh_.materialWarnings, IsEmpty());
  EXPECT_EQ(useOf("-o 0.5 my wall.png"), (TextureUse{0, 1.0}));
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("-o of map_Kd is not used")));
  EXPECT_EQ(useOf("-s 2 4 1 2.png"), (TextureUse{0, 0.5}));
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("the first number is taken for both sides")));
  EXPECT_EQ(useOf("-s -1 -1 1 2.png"), (TextureUse{0, 1.0}));
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("not used where it is not above 0")));
  EXPECT_EQ(useOf("-mm 0 2 -imfchan r 2.png"), (TextureUse{0, 1.0}));
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("not used: -mm of map_Kd, -imfchan of map_Kd")));
  EXPECT_EQ(useOf("D:\\textures\\my wall.png"), (TextureUse{0, 1.0})) << "of another machine: beside";
}

TEST_F(LoadMtl, TakesPicturesForWhatIsEmitted) {
  writeGrey("glow.png");
  MaterialDescription material =
      materialOf("Kd 0.5 0.6 0.7\nKe 5 4 3\nmap_Kd glow.png\nmap_Ke -s 2 2 2 glow.png\nd 0.5\n");
  EXPECT_EQ(material.emission, Rgb(5, 4, 3));
  ASSERT_TRUE(material.textures.emission);
  EXPECT_EQ(*material.textures.emission, (TextureUse{0, 0.5}));
  EXPECT_EQ(material.textures.diffuse, (TextureUse{0, 1.0}));
  EXPECT_TRUE(material.opacity.isFull());
  EXPECT_EQ(mesh_.textures.size(), 1U) << "one picture for both";
  EXPECT_EQ(materialOf("map_Ke glow.png\n").emission, Rgb(1.0f));
  EXPECT_THAT(mesh_.materialWarnings, IsEmpty());
  material = materialOf("Kd 1 1 1\nmap_Ke none.png\n");
  EXPECT_FALSE(material.emits() || material.textures.emission);
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("map_Ke of a is not used")));
}

TEST_F(LoadMtl, TakesDForOpacity) {
  EXPECT_EQ(materialOf("Kd 1 1 1\nd 0.25\n").opacity.value, 0.25);
  EXPECT_NEAR(materialOf("Kd 1 1 1\nTr 0.25\n").opacity.value, 0.75, 1e-6);
  EXPECT_TRUE(materialOf("Kd 1 1 1\nd 1\n").opacity.isFull());
  EXPECT_TRUE(materialOf("Ke 1 1 1\nd 0.5\n").opacity.isFull()) << "a light";
  EXPECT_TRUE(materialOf("illum 4\nd 0.5\n").opacity.isFull()) << "glass";
  EXPECT_THAT(mesh_.materialWarnings, testing::IsEmpty());
}

TEST_F(LoadMtl, ReadsAPictureOnceForEachWayToWrapIt) {
  writeGrey("a.png");
  folder_.write("a.mtl",
                "newmtl a\nKd 1 1 1\nmap_Kd a.png\nnewmtl b\nKd 1 1 1\nmap_Kd -clamp on a.png\n"
                "newmtl c\nKd 1 1 1\nmap_Kd a.png\n");
  const MeshFile mesh =
      load("mtllib a.mtl\n" + kObjSquare + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\nusemtl c\nf 2 3 4\n");
  ASSERT_EQ(mesh.materials.size(), 3U);
  ASSERT_EQ(mesh.textures.size(), 2U);
  const auto wrapOf = [&](std::size_t material) {
    const std::size_t texture = mesh.materials[material].textures.diffuse.value().texture;
    return std::get<ImageTextureDescription>(mesh.textures[texture].pattern).wrap;
  };
  EXPECT_EQ(wrapOf(0), TextureWrap::Repeat);
  EXPECT_EQ(wrapOf(1), TextureWrap::Clamp);
  EXPECT_EQ(wrapOf(2), TextureWrap::Repeat);
}

TEST_F(LoadMtl, DoesWithoutPicturesThatAreNotThere) {
  const MaterialDescription material = materialOf("Kd 0.5 0.5 0.5\nmap_Kd none.png\n");
  EXPECT_EQ(material.diffuse, Rgb(0.5f));
  EXPECT_FALSE(material.textures.diffuse);
  EXPECT_THAT(mesh_.materialWarnings, ElementsAre(HasSubstr("map_Kd of a is not used")));
  EXPECT_THAT(mesh_.materialWarnings.front(), HasSubstr("none.png: no such file"));
}

TEST_F(LoadObj, WarnsOnceOfWhatItDoesNotUse) {
  const MeshFile mesh = load(
      "mtllib none.mtl\ng a b\no part\ns 1\nv 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\nl 2 3\np 1\n"
      "usemtl red\nf 1 2 3\nusemtl blue\nf 1 2 3\nusemtl red\nf 1 2 3\n");
  EXPECT_THAT(mesh.warnings,
              ElementsAre(HasSubstr("vertex weights or colours are not used"), HasSubstr("not used: l, p")));
  EXPECT_THAT(mesh.materialWarnings,
              ElementsAre(HasSubstr("none.mtl: no such file"), HasSubstr("without a material"),
                          HasSubstr("no material file has the material red"),
                          HasSubstr("no material file has the material blue")));
}

TEST_F(LoadObj, RefusesWhatIsMalformed) {
  EXPECT_EQ(errorOf(""), "mesh.obj: the file has no faces (expected lines such as f 1 2 3)");
  EXPECT_EQ(errorOf(kObjSquare), "mesh.obj: the file has no faces (expected lines such as f 1 2 3)");
  EXPECT_THAT(errorOf("v 0 0 0\n  v 1 x 0\n"),
              HasSubstr("mesh.obj:2:7: v: expected a finite number up to 3.4e38, found \"x\""));
  EXPECT_THAT(errorOf("v 0 0 nan\n"), HasSubstr("mesh.obj:1:7: v: expected a finite number"));
  EXPECT_THAT(errorOf("v 0 0 inf\n"), HasSubstr("mesh.obj:1:7: v: expected a finite number"));
  EXPECT_THAT(errorOf("v 0 0 1e39\n"), HasSubstr("mesh.obj:1:7: v: expected a finite number"));
  EXPECT_THAT(errorOf("v 0 0 1.0.0\n"), HasSubstr("found \"1.0.0\""));
  EXPECT_THAT(errorOf("\rv 0 0\r\n"), HasSubstr("mesh.obj:2:1: v: expected 3 numbers, found 2"));
  EXPECT_THAT(errorOf("vn 0 0\n"), HasSubstr("mesh.obj:1:1: vn: expected 3 numbers, found 2"));
  EXPECT_THAT(errorOf("vt\n"), HasSubstr("mesh.obj:1:1: vt: expected 1 number, found 0"));
  EXPECT_THAT(errorOf(kObjSquare + "f 1 2\nf\n"), HasSubstr("has no face of three corners or more"));
  std::string large = "f";
  for (int i = 0; i < 5000; ++i) large += " 1";
  EXPECT_THAT(errorOf(kObjSquare + large + "\n"), HasSubstr("mesh.obj:5:1: f: a face of 5000 corners"));
  EXPECT_THAT(errorOf(kObjSquare + "f 1 2 0\n"), HasSubstr("mesh.obj:5:7: f: expected v, v/vt"));
  for (const char* corner : {"a", "1/a", "/1", "1/1/1/1", "1.5", "99999999999", "1/0"}) {
    EXPECT_THAT(errorOf(kObjSquare + "f 1 2 " + corner + "\n"), HasSubstr(std::string("found \"") + corner))
        << corner;
  }
}

// What exporters and editors leave behind.
TEST_F(LoadObj, PassesOverWhatIsCommonlySloppy) {
  const std::vector<Vec3d> expected = {Vec3d(0), Vec3d(1, 0, 0), Vec3d(1, 1, 0)};
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
  for (const std::string& text : std::vector<std::string>{
           "\xef\xbb\xbf" + vertices + "f 1 2 3\n", vertices + "f 1 2 \\\n3\n",
           vertices + "f 1 \\\r\n 2 \\\r\n 3", vertices + "f 1/ 2// 3/\t\n",
           vertices + "  f 1 2 3 # the only one\n", "v 0 0 0 \t\nv 1 0 0#x\nv 1 1 0\nf 1 2 3 \n",
           vertices + "vt 0.5\nf 1/1 2/1 3/1\n", vertices + "f 1 2 \\ \t\n3\n", vertices + "f 1/ 2 \\\n3/ \\",
           vertices + "vn nan NaN -nan(ind)\nf 1//1 2//1 3//1\n", vertices + "f 1 2\nf 1 2 3\nf\n"}) {
    const MeshFile mesh = load(text);
    EXPECT_EQ(corners(mesh.geometry), expected) << text;
  }
  EXPECT_THAT(load(vertices + "f 1 2\nf 1 2 3\n").warnings,
              ElementsAre(HasSubstr("faces of fewer than 3 corners are left out")));
  // Lines keep their numbers.
  EXPECT_THAT(errorOf(kObjSquare + "f 1 2 \\\n3\n# more \\\nf 1 2 x\n"),
              HasSubstr("mesh.obj:8:7: f: expected"));
}

TEST_F(LoadObj, FindsItsMaterialFiles) {
  std::filesystem::create_directory(folder_ / "sub");
  folder_.write("my red.mtl", "\xef\xbb\xbfnewmtl red \t\nKd 1 0 0\n");
  folder_.write("a.mtl", "newmtl a\nKd 0 1 0\n");
  folder_.write("sub/b.mtl", "newmtl b b\nKd 0 0 1\n");
  const auto diffuseOf = [this](const std::string& library, const std::string& name) {
    const MeshFile mesh = load("mtllib " + library + "\n" + kObjSquare + "usemtl " + name + "\nf 1 2 3\n");
    EXPECT_THAT(mesh.materialWarnings, IsEmpty()) << library;
    return mesh.materials.at(0).diffuse;
  };
  EXPECT_EQ(diffuseOf("my red.mtl ", "red  "), Rgb(1, 0, 0));
  EXPECT_EQ(diffuseOf("a.mtl sub\\b.mtl", "b b"), Rgb(0, 0, 1));
  EXPECT_EQ(diffuseOf(".\\sub\\b.mtl", "b b"), Rgb(0, 0, 1));
  EXPECT_EQ(diffuseOf("C:\\Users\\me\\a.mtl", "a"), Rgb(0, 1, 0)) << "of another machine: beside";
  EXPECT_EQ(diffuseOf("a.mtl\nmtllib my red.mtl", "red"), Rgb(1, 0, 0));
  EXPECT_THAT(
      load("mtllib not there.mtl\nmtllib not there.mtl\n" + kObjSquare + "f 1 2 3\n").materialWarnings,
      ElementsAre(HasSubstr("not there.mtl: no such file"), HasSubstr("without a material")))
      << "once, however often it is named";
}

TEST_F(LoadObj, RefusesIndicesOfWhatTheFileDoesNotHave) {
  EXPECT_THAT(errorOf(kObjSquare + "f 1 2 3\nf 1 2 5\n"),
              HasSubstr("mesh.obj:6:1: f: names a vertex that the file does not have (it has 4 vertices"));
  EXPECT_THAT(errorOf(kObjSquare + "f 1 2 -5\n"), HasSubstr("mesh.obj:5:1: f: names a vertex"));
  EXPECT_THAT(errorOf(kObjSquare + "f 1//1 2//1 3//1\n"), HasSubstr("mesh.obj:5:1: f: names a normal"));
  EXPECT_THAT(errorOf(kObjSquare + "f 1/1 2/1 3/1\n"),
              HasSubstr("mesh.obj:5:1: f: names a texture coordinate"));
}

TEST_F(LoadObj, RefusesMaterialsThatAreMalformed) {
  const auto errorOfMtl = [&](const std::string& mtl) {
    folder_.write("a.mtl", mtl);
    return errorOf("mtllib a.mtl\n" + kObjSquare + "usemtl a\nf 1 2 3\n");
  };
  EXPECT_EQ(errorOfMtl("newmtl a\nKd 0.5 0.5\n"), "a.mtl:2:1: Kd: expected 3 numbers, found 2");
  EXPECT_THAT(errorOfMtl("newmtl a\nKd 1e39 0 0\n"), HasSubstr("a.mtl:2:4: Kd: expected a finite number"));
  EXPECT_THAT(errorOfMtl("newmtl a\nKd 0 0 b\n"), HasSubstr("a.mtl:2:8: Kd: expected a finite number"));
}

TEST_F(LoadObj, SaysThatAFileIsMissing) {
  const Expected<MeshFile> mesh = loadObj(folder_.path() / "none.obj");
  ASSERT_FALSE(mesh);
  EXPECT_THAT(mesh.error().message(), HasSubstr("none.obj: no such file"));
  // It has no end.
  std::filesystem::create_symlink("/dev/zero", folder_ / "zero.obj");
  EXPECT_THAT(loadObj(folder_ / "zero.obj").error().message(), HasSubstr("zero.obj: is not a regular file"));
}

// ---- as a scene

using LoadObjScene = LoadObj;

TEST_F(LoadObjScene, GetsACameraThatSeesAllAndALight) {
  const Expected<SceneDescription> scene =
      loadScene(folder_.write("room.OBJ", kObjSquare + "v 30 1 -7\nf 1 2 3 4\nf 1 2 5\n"));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->name, "room");
  ASSERT_EQ(scene->shapes.size(), 1U);
  ASSERT_EQ(scene->lights.size(), 1U);
  ASSERT_EQ(scene->cameras.size(), 1U);
  EXPECT_THAT(scene->warnings,
              ElementsAre(HasSubstr("grey"), HasSubstr("has no camera"), HasSubstr("no material emits")));
  const CameraDescription& camera = scene->cameras[0];
  const Vec3d view = glm::normalize(camera.target - camera.position);
  for (const Vec3d& p : std::get<MeshDescription>(scene->shapes[0].geometry).geometry->positions) {
    const double degrees = std::acos(glm::dot(view, glm::normalize(p - camera.position))) * 180.0 / kPiD;
    EXPECT_LE(degrees, 0.5 * camera.fovYDegrees)
        << "vertex outside the picture: " << p.x << " " << p.y << " " << p.z;
  }
}

TEST_F(LoadObjScene, GetsNoLightWhereAMaterialEmits) {
  folder_.write("a.mtl", "newmtl lamp\nKe 1 1 1\n");
  const Expected<SceneDescription> scene =
      loadScene(folder_.write("lamp.obj", "mtllib a.mtl\nusemtl lamp\n" + kObjSquare + "f 1 2 3 4\n"));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_THAT(scene->lights, IsEmpty());
  EXPECT_TRUE(scene->materials[scene->shapes[0].material].emits());
}

// ---- as the mesh of a scene file

class LoadMesh : public LoadObj {
 protected:
  void SetUp() override {
    folder_.write("a.mtl", "newmtl red\nKd 1 0 0\nKa 1 1 1\nnewmtl lamp\nKe 5 4 3\n");
    std::filesystem::create_directory(folder_.path() / "meshes");
    folder_.write("meshes/a.mtl", "newmtl red\nKd 1 0 0\nKa 1 1 1\nnewmtl lamp\nKe 5 4 3\n");
    folder_.write("meshes/two.obj",
                  "mtllib a.mtl\n" + kObjSquare + "usemtl red\nf 1 2 3\nusemtl lamp\nf 1 3 4\n");
  }
  Expected<SceneDescription> loadWith(const std::string& keys) {
    return loadScene(folder_.write("scene.toml", "version = 1\n[camera]\n[material.white]\n" + keys));
  }
};

TEST_F(LoadMesh, BringsItsOwnMaterialsOnceForAllItsShapes) {
  const std::string shape = "[[shape]]\ntype = \"mesh\"\nfile = \"meshes/two.obj\"\n";
  const Expected<SceneDescription> scene = loadWith(shape + shape);
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->materials.size(), 3U);
  ASSERT_EQ(scene->shapes.size(), 2U);
  for (const ShapeDescription& s : scene->shapes) {
    const auto& mesh = std::get<MeshDescription>(s.geometry);
    EXPECT_EQ(mesh.file, "meshes/two.obj");
    EXPECT_THAT(mesh.geometry->triangleMaterials, ElementsAre(0U, 1U));
    EXPECT_THAT(mesh.materials, ElementsAre(1U, 2U));
    EXPECT_EQ(mesh.geometry, std::get<MeshDescription>(scene->shapes[0].geometry).geometry);
    EXPECT_EQ(s.material, 1U);
  }
  EXPECT_EQ(scene->materials[1].diffuse, Rgb(1, 0, 0));
  EXPECT_EQ(scene->materials[2].emission, Rgb(5, 4, 3));
  EXPECT_THAT(scene->warnings, ElementsAre(HasSubstr("a.mtl: not used: Ka")));
}

TEST_F(LoadMesh, TakesTheMaterialThatTheShapeNames) {
  const Expected<SceneDescription> scene =
      loadWith("[[shape]]\ntype = \"mesh\"\nfile = \"meshes/two.obj\"\nmaterial = \"white\"\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->materials.size(), 1U);
  EXPECT_THAT(std::get<MeshDescription>(scene->shapes[0].geometry).materials, IsEmpty());
  EXPECT_THAT(scene->warnings, IsEmpty());
}

TEST_F(LoadMesh, CanBePartOfALight) {
  EXPECT_TRUE(loadWith("[[shape]]\ntype = \"mesh\"\nfile = \"meshes/two.obj\"\nlight = \"lamp\"\n"));
}

TEST_F(LoadMesh, ReportsItsErrorsAtTheKeyThatNamesIt) {
  folder_.write("bad.obj", "v 0 0 b\n");
  const Expected<SceneDescription> scene = loadWith("[[shape]]\ntype = \"mesh\"\nfile = \"bad.obj\"\n");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message(), HasSubstr("scene.toml:6:8: file of [[shape]] 1: "));
  EXPECT_THAT(scene.error().message(), HasSubstr("bad.obj:1:7: v: expected a finite number"));
}

}  // namespace
}  // namespace lightvane
