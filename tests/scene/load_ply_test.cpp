// PLY files: what is read, what is said of the rest, and that nothing malformed becomes a mesh.

#include "core/scene/load_ply.h"

#include <bit>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/load_scene.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LoadPly : public testing::Test {
 protected:
  MeshFile load(const std::string& bytes) {
    Expected<MeshFile> mesh = loadPly(folder_.write("mesh.ply", bytes));
    EXPECT_TRUE(mesh) << mesh.error().message();
    return mesh ? *std::move(mesh) : MeshFile{};
  }
  std::string refusal(const std::string& bytes) {
    const Expected<MeshFile> mesh = loadPly(folder_.write("mesh.ply", bytes));
    return mesh ? std::string() : mesh.error().message();
  }
  TemporaryFolder folder_;
};

const std::string kVertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPlySquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
const std::string kAscii = "ply\nformat ascii 1.0\ncomment made by hand\n" + kVertex + kFace;

TEST_F(LoadPly, ReadsAscii) {
  const MeshFile mesh = load(kAscii + kPlySquare);
  EXPECT_THAT(mesh.geometry.positions,
              ElementsAre(Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0)));
  EXPECT_EQ(mesh.geometry.triangles.size(), 2U);
  EXPECT_THAT(mesh.geometry.triangleMaterials, ElementsAre(0U, 0U));
  EXPECT_THAT(mesh.geometry.normals, IsEmpty());
  EXPECT_THAT(mesh.warnings, IsEmpty());
  ASSERT_EQ(mesh.materials.size(), 1U);
  EXPECT_EQ(mesh.materials[0].diffuse, Rgb(kDefaultReflectance));
}

// Of the four strips, one after the other with -1 between them, the last is too short.
TEST_F(LoadPly, ReadsStripsOfTriangles) {
  const std::string start = "ply\nformat ascii 1.0\n" + kVertex +
                            "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
  const std::string corners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const MeshFile mesh = load(start + corners + "15 0 1 3 2 -1 0 1 2 -1 0 0 1 2 -1 0\n");
  const auto& triangles = mesh.geometry.triangles;
  EXPECT_THAT(triangles, ElementsAre(glm::uvec3(0, 1, 3), glm::uvec3(3, 1, 2), glm::uvec3(0, 1, 2),
                                     glm::uvec3(1, 0, 2)));
  EXPECT_EQ(mesh.geometry.triangleMaterials.size(), triangles.size());
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("faces of fewer than 3 corners are left out")));
  EXPECT_THAT(load(start + corners + "4 0 1 3 2\n").warnings, IsEmpty());
  EXPECT_THAT(refusal(start + corners + "3 0 1 4\n"), HasSubstr("strip 0 names vertex 4, and there are 4"));
  EXPECT_THAT(refusal(start + corners + "3 0 1 -2\n"), HasSubstr("strip 0 names vertex -2"));
  EXPECT_THAT(refusal(start + corners + "2 -1 -1\n"), HasSubstr("no faces or strips of triangles"));
}

/// A number's bytes, the least significant first or last.
template <class T, class Bits>
std::string bytesOf(T value, bool littleEndian) {
  const auto bits = std::bit_cast<Bits>(value);
  std::string bytes;
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    const std::size_t place = littleEndian ? i : sizeof(T) - 1 - i;
    bytes += static_cast<char>((bits >> (8 * place)) & 0xffU);
  }
  return bytes;
}

TEST_F(LoadPly, ReadsBothByteOrdersAlike) {
  for (const bool little : {true, false}) {
    std::string bytes = std::string("ply\nformat binary_") + (little ? "little" : "big") + "_endian 1.0\n" +
                        "element vertex 3\nproperty double x\nproperty float y\nproperty short z\n" +
                        "property uchar quality\nproperty float nx\nproperty float ny\nproperty float nz\n" +
                        "property float s\nproperty float t\nelement face 1\n" +
                        "property list uint ushort vertex_index\nend_header\n";
    for (int i = 0; i < 3; ++i) {
      bytes += bytesOf<double, std::uint64_t>(0.1 + i, little);
      bytes += bytesOf<float, std::uint32_t>(i == 2 ? -2.5f : 0.0f, little);
      bytes += bytesOf<std::int16_t, std::uint16_t>(static_cast<std::int16_t>(-300 * i), little);
      bytes += '\x07';
      for (const float n : {0.0f, 2.0f, 0.0f, 0.25f, 0.75f})
        bytes += bytesOf<float, std::uint32_t>(n, little);
    }
    bytes += bytesOf<std::uint32_t, std::uint32_t>(3, little);
    for (const unsigned corner : {2U, 0U, 1U})
      bytes += bytesOf<std::uint16_t, std::uint16_t>(static_cast<std::uint16_t>(corner), little);
    const MeshFile mesh = load(bytes);
    EXPECT_THAT(mesh.geometry.positions,
                ElementsAre(Vec3d(0.1, 0, 0), Vec3d(1.1, 0, -300), Vec3d(2.1, -2.5, -600)));
    EXPECT_THAT(mesh.geometry.triangles, ElementsAre(glm::uvec3(2, 0, 1)));
    EXPECT_THAT(mesh.geometry.normals, testing::Each(Vec3d(0, 2, 0)));
    EXPECT_THAT(mesh.geometry.uvs, testing::Each(Vec2(0.25f, 0.75f)));
    EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("not used: quality of vertex")));
  }
}

TEST_F(LoadPly, ReadsColoursOfVertices) {
  const auto loadWith = [this](const char* type, const std::string& colors) {
    const std::string types = fmt::format("property {0} red\nproperty {0} green\nproperty {0} blue\n", type);
    return load(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
        types + "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 " + colors +
        "\n1 0 0 " + colors + "\n0 1 0 " + colors + "\n3 0 1 2\n");
  };
  const MeshFile bytes = loadWith("uchar", "255 188 0");
  ASSERT_EQ(bytes.geometry.colors.size(), 3U);
  EXPECT_EQ(bytes.geometry.colors[1].r, 1.0f);
  EXPECT_NEAR(bytes.geometry.colors[1].g, 0.5f, 0.005f) << "sRGB";
  EXPECT_EQ(bytes.geometry.colors[1].b, 0.0f);
  EXPECT_EQ(bytes.materials.at(0).diffuse, Rgb(1.0f));
  EXPECT_THAT(bytes.warnings, IsEmpty());
  EXPECT_THAT(bytes.materialWarnings, IsEmpty());
  EXPECT_THAT(loadWith("float", "0.25 -3 nan").geometry.colors, testing::Each(Rgb(0.25f, 0.0f, 0.0f)));
  EXPECT_EQ(loadWith("int", "255 188 0").geometry.colors, bytes.geometry.colors);
  EXPECT_EQ(loadWith("ushort", "65535 48316 0").geometry.colors, bytes.geometry.colors);
  EXPECT_THAT(loadWith("float", "0.5 200 1").warnings, ElementsAre(HasSubstr("colours beyond 1")));
}

TEST_F(LoadPly, ReadsFacesThatStandBeforeTheirVertices) {
  const std::string face = "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n";
  const MeshFile mesh = load("ply \nformat ascii 1.0\n" + face + kVertex +
                             "end_header\n4 0 1 2 3 9\n2 0 1 9\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n");
  EXPECT_EQ(mesh.geometry.triangles.size(), 2U);
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("not used: red of face"),
                                         HasSubstr("faces of fewer than 3 corners are left out")));
}

TEST_F(LoadPly, IsFlatWhereAFaceHasNoNormal) {
  const auto loadWith = [this](const std::string& last, int corner) {
    return load(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty float nx\nproperty float ny\nproperty float nz\n" +
        kFace + "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 " + last + fmt::format("\n3 0 1 {}\n", corner));
  };
  const MeshFile smooth = loadWith("nan 0 0", 2);
  EXPECT_EQ(smooth.geometry.normals.size(), 4U) << "no face uses the vertex without one";
  EXPECT_THAT(smooth.warnings, IsEmpty());
  const MeshFile flat = loadWith("0 0 0", 3);
  EXPECT_THAT(flat.geometry.normals, IsEmpty());
  EXPECT_THAT(flat.warnings, ElementsAre(HasSubstr("flat-shaded")));
}

TEST_F(LoadPly, SkipsElementsThatItDoesNotKnow) {
  const std::string edges = "element edge 2\nproperty int vertex1\nproperty list uchar float weights\n";
  const MeshFile mesh =
      load("ply\r\nformat ascii 1.0\r\n" + edges + kVertex + kFace + "7 2 .5 1\n8 0\n" + kPlySquare);
  EXPECT_EQ(mesh.geometry.triangles.size(), 2U);
  EXPECT_THAT(mesh.warnings, ElementsAre(HasSubstr("element edge")));
}

TEST_F(LoadPly, EveryCutIsRefused) {
  const std::string whole = kAscii + kPlySquare;
  // Without its last line break, or the last digit of a corner, it is whole still or another square.
  for (std::size_t length = 0; length + 2 < whole.size(); ++length)
    EXPECT_THAT(refusal(whole.substr(0, length)), HasSubstr("mesh.ply")) << length << " bytes";
}

TEST_F(LoadPly, SaysWhatIsWrong) {
  EXPECT_THAT(refusal("solid teapot\n"), HasSubstr("mesh.ply:1: is not a PLY file"));
  EXPECT_THAT(refusal("ply\nformat ascii 2.0\n"), HasSubstr("mesh.ply:2: expected format ascii"));
  EXPECT_THAT(refusal("ply\nelement vertex many\n"), HasSubstr("expected element, its name and how many"));
  EXPECT_THAT(refusal("ply\nproperty float x\n"), HasSubstr("a property before the first element"));
  EXPECT_THAT(refusal("ply\nelement vertex 1\nproperty real x\n"), HasSubstr("unknown type \"real\""));
  EXPECT_THAT(refusal(kAscii + "0 0 0\n1 0 zero\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
              HasSubstr("mesh.ply:12: expected a number, found \"zero\""));
  EXPECT_THAT(refusal(kAscii + "0 0 0\n1 0 nan\n1 1 0\n0 1 0\n4 0 1 2 3\n"), HasSubstr("vertex 1 is at"));
  EXPECT_THAT(refusal(kAscii + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 4\n"), HasSubstr("names vertex 4"));
  EXPECT_THAT(refusal(kAscii + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 -1\n"), HasSubstr("names vertex -1"));
  EXPECT_THAT(refusal(kAscii + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n"), HasSubstr("has no faces"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\n" + kVertex + kVertex), HasSubstr("a second element vertex"));
  EXPECT_THAT(
      refusal("ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\n" + kFace),
      HasSubstr("no room for 18446744073709551615 elements"));
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\n" + kVertex + "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"),
              HasSubstr("has no faces"));
}

TEST_F(LoadPly, OpensAsAScene) {
  const Expected<SceneDescription> scene = loadScene(folder_.write("square.ply", kAscii + kPlySquare));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->shapes.size(), 1U);
  EXPECT_EQ(scene->lights.size(), 1U) << "nothing emits";
  EXPECT_THAT(scene->warnings, testing::Contains(HasSubstr("a PLY file has no camera")));
}

TEST_F(LoadPly, IsAMeshOfASceneFile) {
  folder_.write("square.ply", kAscii + kPlySquare);
  const Expected<SceneDescription> scene = loadScene(folder_.write("scene.toml", R"(version = 1
[camera]
[material.red]
diffuse = [0.5, 0, 0]
[[shape]]
type = "mesh"
file = "square.ply"
material = "red"
)"));
  ASSERT_TRUE(scene) << scene.error().message();
  const auto& mesh = std::get<MeshDescription>(scene->shapes.at(0).geometry);
  EXPECT_EQ(mesh.geometry->triangles.size(), 2U);
  EXPECT_THAT(mesh.materials, IsEmpty()) << "the shape's own material";
}

}  // namespace
}  // namespace lightvane
