// Loading a scene can be stopped at any moment, and tells how far it is.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/image/image_file.h"
#include "core/scene/polygon.h"
#include "core/scene/scene.h"
#include "tests/scene/gltf_text.h"
#include "tests/scene/load_support.h"
#include "tests/support/counting_watch.h"

namespace lightvane {
namespace {

using test::CountingWatch;
using testing::ElementsAre;

constexpr int kSide = 40;  ///< of a grid, in squares: pieces enough for several looks
constexpr int kStopCorners = (kSide + 1) * (kSide + 1);
constexpr int kStopTriangles = 2 * kSide * kSide;

std::vector<glm::vec3> gridCorners() {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < kStopCorners; ++i) {
    const int x = i % (kSide + 1);
    const int z = i / (kSide + 1);
    corners.emplace_back(static_cast<float>(x), static_cast<float>((x * z) % 5), static_cast<float>(z));
  }
  return corners;
}

std::vector<glm::uvec3> gridTriangles() {
  std::vector<glm::uvec3> triangles;
  for (unsigned z = 0; z < kSide; ++z) {
    for (unsigned x = 0; x < kSide; ++x) {
      const unsigned a = z * (kSide + 1) + x;
      triangles.emplace_back(a, a + kSide + 1, a + 1);
      triangles.emplace_back(a + 1, a + kSide + 1, a + kSide + 2);
    }
  }
  return triangles;
}

std::string bytesOf(std::uint32_t number) { return test::littleEndian<std::uint32_t>({number}); }

void writeGridPicture(const TemporaryFolder& folder, const std::string& name) {
  LayeredImage image;
  image.width = image.height = 64;
  ImageRgb pixels(64, 64);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = Rgb(static_cast<float>(i % 64) / 64.0f);
  image.setRgb("", pixels);
  ASSERT_TRUE(writeImage(folder / name, image));
}

std::string gridObj() {
  std::string text = "mtllib grid.mtl\nusemtl wall\n";
  for (const glm::vec3& c : gridCorners())
    text += fmt::format("v {} {} {}\nvt {} {}\n", c.x, c.y, c.z, c.x, c.z);
  for (const glm::uvec3& t : gridTriangles())
    text += fmt::format("f {0}/{0} {1}/{1} {2}/{2}\n", t.x + 1, t.y + 1, t.z + 1);
  return text;
}

std::string gridPly(bool isBinary) {
  std::string text = fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\nelement "
      "face {}\nproperty list uchar int vertex_indices\nend_header\n",
      isBinary ? "binary_little_endian" : "ascii", kStopCorners, kStopTriangles);
  for (const glm::vec3& c : gridCorners())
    text += isBinary ? test::floats({c.x, c.y, c.z}) : fmt::format("{} {} {}\n", c.x, c.y, c.z);
  for (const glm::uvec3& t : gridTriangles())
    text += isBinary ? std::string("\3") + bytesOf(t.x) + bytesOf(t.y) + bytesOf(t.z)
                     : fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
  return text;
}

test::GltfText gridGltf() {
  test::GltfText text;
  std::string corners;
  std::string uvs;
  std::string indices;
  for (const glm::vec3& c : gridCorners()) {
    corners += test::floats({c.x, c.y, c.z});
    uvs += test::floats({c.x, c.z});
  }
  for (const glm::uvec3& t : gridTriangles()) indices += bytesOf(t.x) + bytesOf(t.y) + bytesOf(t.z);
  const int position = text.accessor(text.view(corners), test::kFloat, kStopCorners, "VEC3");
  const int uv = text.accessor(text.view(uvs), test::kFloat, kStopCorners, "VEC2");
  const int index = text.accessor(text.view(indices), test::kUint, 3 * kStopTriangles, "SCALAR");
  text.set("meshes",
           fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{0},"NORMAL":{0},"TEXCOORD_0":{1}}},)"
                       R"("indices":{2},"material":0}}]}}])",
                       position, uv, index));
  text.set("materials", R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])");
  text.set("textures", R"([{"source":0}])").set("images", R"([{"uri":"wall.png"}])");
  return text;
}

constexpr const char* kRoomToml = R"(
version = 1
camera = {position = [0, 1, 5], target = [0, 1, 0], fov_y = 40}
[texture.halves]
type = "image"
file = "halves.jpg"
[texture.wall]
type = "image"
file = "wall.exr"
[material.painted]
diffuse = {texture = "wall"}
[material.plain]
diffuse = {texture = "halves"}
[[shape]]
type = "mesh"
file = "grid.ply"
material = "painted"
[[shape]]
type = "mesh"
file = "grid.obj"
[[shape]]
type = "mesh"
file = "grid.gltf"
material = "plain"
[[light]]
type = "environment"
image = "sky.hdr"
[[light]]
type = "environment"
image = "sky.pfm"
)";

class LoadStop : public testing::TestWithParam<const char*> {
 protected:
  LoadStop() {
    for (const char* picture : {"wall.png", "wall.exr", "sky.hdr", "sky.pfm"})
      writeGridPicture(folder_, picture);
    folder_.write(
        "halves.jpg",
        readFile(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "tests/image/data/halves.jpg").value());
    folder_.write("grid.obj", gridObj());
    folder_.write("grid.mtl", "newmtl wall\nKd 0.5 0.5 0.5\nmap_Kd wall.png\n");
    folder_.write("grid.ply", gridPly(true));
    folder_.write("ascii.ply", gridPly(false));
    folder_.write("grid.glb", gridGltf().glb());
    folder_.write("grid.bin", gridGltf().buffer);
    folder_.write("grid.gltf", gridGltf().json("grid.bin"));
    folder_.write("embedded.gltf", gridGltf().gltf());
    folder_.write("room.toml", kRoomToml);
  }

  Expected<std::shared_ptr<const Scene>> load(LoadWatch& watch) const {
    const auto description = loadScene(folder_ / GetParam(), watch);
    if (!description) return tl::unexpected(description.error());
    return Scene::compile(*description, EnergyRule::Refined, watch);
  }

  TemporaryFolder folder_;
};

TEST_P(LoadStop, ToldOrNotTheSceneIsTheSame) {
  const auto plain = load(LoadWatch::none());
  ASSERT_TRUE(plain) << plain.error().message();
  CountingWatch watch;
  const auto watched = load(watch);
  ASSERT_TRUE(watched) << watched.error().message();
  EXPECT_EQ((*watched)->hash, (*plain)->hash);
  EXPECT_EQ((*watched)->warnings, (*plain)->warnings);
  EXPECT_EQ((*watched)->triangleCount(), (*plain)->triangleCount());
  // Each corner and each triangle is gone over many times, with a look for each thousand.
  EXPECT_GT(watch.looks(), 40U);
  test::expectRisingFractions(watch);
}

TEST_P(LoadStop, AtAnyMomentLeavesAStopAndNothingElse) {
  CountingWatch whole;
  ASSERT_TRUE(load(whole));
  // All of the first moments, and then ever fewer: each is a load of its own.
  std::vector<std::size_t> moments;
  for (std::size_t n = 0; n < whole.looks(); n += 1 + n / 16) moments.push_back(n);
  moments.push_back(whole.looks() - 1);
  for (const std::size_t n : moments) {
    CountingWatch watch(n);
    const auto loaded = load(watch);
    ASSERT_FALSE(loaded) << "stopped after look " << n << " of " << whole.looks();
    EXPECT_TRUE(loaded.error().isStop) << n << ": " << loaded.error().message();
    // A library's loop looks, its caller once more, and readers of materials between them.
    EXPECT_LE(watch.looks(), n + 4) << "it went on after the stop";
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, LoadStop,
                         testing::Values("grid.obj", "grid.ply", "ascii.ply", "grid.glb", "grid.gltf",
                                         "embedded.gltf", "room.toml"),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::replace(text.begin(), text.end(), '.', '_');
                           return text;
                         });

class LoadStages : public LoadStop {};

TEST_P(LoadStages, AreToldInTheirOrder) {
  CountingWatch watch;
  ASSERT_TRUE(load(watch));
  EXPECT_THAT(
      watch.stages(),
      ElementsAre("reading room.toml", "reading halves.jpg", "reading room.toml", "reading wall.exr",
                  "reading room.toml", "reading grid.ply", "reading room.toml", "reading grid.obj",
                  "reading wall.png", "reading grid.obj", "reading room.toml", "reading grid.gltf",
                  "reading picture 0 of grid.gltf", "reading wall.png", "reading picture 0 of grid.gltf",
                  "reading grid.gltf", "reading room.toml", "reading sky.hdr", "reading room.toml",
                  "reading sky.pfm", "reading room.toml", "preparing the scene"));
}

INSTANTIATE_TEST_SUITE_P(Toml, LoadStages, testing::Values("room.toml"));

// A polygon of n corners takes a time that grows with the square of n to be cut.
TEST(LoadStopOf, APolygonOfManyCornersWhileItIsCut) {
  std::vector<Vec3d> corners;
  for (int i = 0; i < 2000; ++i)
    corners.emplace_back(std::cos(0.001 * kPiD * i), std::sin(0.001 * kPiD * i), 0.0);
  CountingWatch whole;
  EXPECT_EQ(triangulate(corners, whole).size(), 1998U);
  EXPECT_GT(whole.looks(), 1900U);
  CountingWatch watch(700);
  EXPECT_THROW(triangulate(corners, watch), LoadStopped);
  EXPECT_EQ(watch.looks(), 701U);
}

TEST(LoadStopOf, AJpegAtAnyRow) {
  const std::string bytes =
      readFile(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "tests/image/data/halves.jpg").value();
  CountingWatch whole;
  ASSERT_TRUE(readImageBytes(bytes, "halves", whole));
  for (std::size_t n = 0; n < whole.looks(); ++n) {
    CountingWatch watch(n);
    EXPECT_THROW((void)readImageBytes(bytes, "halves", watch), LoadStopped) << n;
  }
}

}  // namespace
}  // namespace lightvane
