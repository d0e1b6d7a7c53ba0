// glTF files: triangles, nodes, cameras and lights.

#include "core/scene/load_gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/load_scene.h"
#include "core/scene/scene.h"
#include "tests/scene/gltf_text.h"

namespace lightvane {
namespace {

using test::GltfFolder;
using test::GltfText;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LoadGltf : public testing::Test, protected GltfFolder {};

/// Of the triangles, corner by corner.
std::vector<Vec3d> gltfCorners(const MeshGeometry& mesh) {
  std::vector<Vec3d> points;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) points.push_back(mesh.positions.at(t[i]));
  }
  return points;
}

const std::vector<Vec3d> kGltfTriangle = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};

// ---- triangles

TEST_F(LoadGltf, AddsWhatATriangleAloneLacks) {
  const SceneDescription read = scene(GltfText().triangle());
  EXPECT_EQ(gltfCorners(meshOf(read)), kGltfTriangle);
  EXPECT_THAT(meshOf(read).normals, IsEmpty()) << "flat-shaded";
  EXPECT_EQ(read.materials.at(0).diffuse, Rgb(kDefaultReflectance));
  EXPECT_EQ(read.name, "a");
  ASSERT_EQ(read.cameras.size(), 1U);
  EXPECT_EQ(read.cameras[0].target, Vec3d(0.5, 0.5, 0));
  ASSERT_EQ(read.lights.size(), 1U);
  EXPECT_EQ(std::get<EnvironmentLightDescription>(read.lights[0].geometry).radiance, Rgb(1.0f));
  EXPECT_THAT(read.warnings, ElementsAre(HasSubstr("a diffuse grey of 0.7"), HasSubstr("has no camera"),
                                         HasSubstr("a sky was added")));
  EXPECT_TRUE(Scene::compile(read));
}

/// A box from -1 to 1 about a camera at y = -0.5, whose faces have normals outwards; of fewer triangles it
/// has a hole.
GltfText boxedCamera(std::size_t triangles, const std::string& material,
                     const std::string& camera = "0,-0.5,0") {
  GltfText text;
  const int positions =
      text.positions({-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1, -1, -1, 1, 1, -1, 1, -1, 1, 1, 1, 1, 1});
  std::string corners =
      test::littleEndian<std::uint8_t>({0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                        0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 2, 6, 7, 2, 7, 3});
  corners.resize(3 * triangles);
  const int indices = text.accessor(text.view(corners), test::kUbyte, 3 * triangles, "SCALAR");
  text.set("meshes",
           fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{},"material":0}}]}}])",
                       positions, indices));
  text.set("materials", "[" + material + "]");
  text.set("cameras", R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])");
  return text.set("nodes", R"([{"mesh":0},{"camera":0,"translation":[)" + camera + "]}]");
}

TEST_F(LoadGltf, HangsALampInAClosedRoomWithoutLight) {
  const std::string grey = R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.5,0.5,1],"metallicFactor":0},
    "extensions":{"KHR_materials_specular":{"specularFactor":0}}})";
  const SceneDescription closed = scene(boxedCamera(12, grey));
  ASSERT_EQ(closed.lights.size(), 1U);
  const auto* lamp = std::get_if<PointLightDescription>(&closed.lights[0].geometry);
  ASSERT_NE(lamp, nullptr);
  EXPECT_LT(glm::length(lamp->position - Vec3d(0.0, 0.25, 0.0)), 1e-6) << "half way up";
  EXPECT_EQ(lamp->intensity, Rgb(lamp->intensity.r));
  // As in a ball of the same walls, 4 pi r^2 = 24: 0.4 pi r^2 (1 - rho) / rho, by 64 rays.
  EXPECT_NEAR(lamp->intensity.r, 2.4f, 0.3f);
  EXPECT_THAT(closed.warnings, Contains(HasSubstr("the camera is in a closed room: a lamp was added there")));
  EXPECT_TRUE(Scene::compile(closed));

  const auto hasSky = [](const SceneDescription& read) {
    return read.lights.size() == 1 &&
           std::holds_alternative<EnvironmentLightDescription>(read.lights[0].geometry);
  };
  EXPECT_TRUE(hasSky(scene(boxedCamera(10, grey)))) << "without its roof";
  EXPECT_TRUE(hasSky(scene(boxedCamera(11, grey)))) << "with half of it";
  EXPECT_TRUE(hasSky(scene(boxedCamera(12, grey, "0,-0.5,4")))) << "seen from outside";
  EXPECT_TRUE(hasSky(scene(boxedCamera(12, R"({"pbrMetallicRoughness":{"metallicFactor":0},
    "extensions":{"KHR_materials_transmission":{"transmissionFactor":1}}})"))))
      << "of glass";
  EXPECT_TRUE(hasSky(scene(boxedCamera(12, R"({"alphaMode":"BLEND",
    "pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}})"))))
      << "a veil";
}

TEST_F(LoadGltf, ReadsBuffersFromAllPlaces) {
  const GltfText text = GltfText().triangle();
  for (const char* uri : {"my%20data+1.bin", "sub%2fdata.bin", "sub\\\\data.bin", "./sub/../data.bin"}) {
    std::filesystem::create_directory(folder / "sub");
    for (const char* name : {"my data+1.bin", "sub/data.bin", "data.bin"})
      folder.write(name, text.buffer + "more than it says");
    EXPECT_EQ(gltfCorners(meshOf(scene(text.json(uri)))), kGltfTriangle) << uri;
  }
  const Expected<SceneDescription> glb = loadScene(folder.write("a.GLB", text.glb()));
  ASSERT_TRUE(glb) << glb.error().message();
  EXPECT_EQ(gltfCorners(meshOf(*glb)), kGltfTriangle);
  // Within the JSON, with and without slashes that are escaped, which they may be. So many that what is left
  // of the URI would be one, were they not counted.
  GltfText slashes = GltfText().triangle();
  slashes.view(std::string(300, '\xff'));
  std::string uri = "data:application/gltf-buffer;base64," + test::base64(slashes.buffer);
  EXPECT_EQ(gltfCorners(meshOf(scene(slashes.json(uri)))), kGltfTriangle);
  for (std::size_t at = 0; (at = uri.find('/', at)) != std::string::npos; at += 2) uri.insert(at, 1, '\\');
  EXPECT_EQ(gltfCorners(meshOf(scene(slashes.json(uri)))), kGltfTriangle) << "escaped";
}

TEST_F(LoadGltf, ReadsIndicesOfAllTypes) {
  const auto cornersBy = [this](int type, const std::string& bytes) {
    GltfText text;
    text.accessor(text.view(bytes), type, 3, "SCALAR");
    text.triangle("", R"(,"indices":0)");
    return gltfCorners(meshOf(scene(text)));
  };
  const std::vector<Vec3d> turned = {kGltfTriangle[2], kGltfTriangle[0], kGltfTriangle[1]};
  EXPECT_EQ(cornersBy(test::kUbyte, test::littleEndian<std::uint8_t>({2, 0, 1})), turned);
  EXPECT_EQ(cornersBy(test::kUshort, test::littleEndian<std::uint16_t>({2, 0, 1})), turned);
  EXPECT_EQ(cornersBy(test::kUint, test::littleEndian<std::uint32_t>({2, 0, 1})), turned);
}

TEST_F(LoadGltf, ReadsStripsAndFansWithTheirFrontSides) {
  const auto trianglesBy = [this](int mode, int points) {
    GltfText text;
    // Around the square, or zigzag, so that either has all its front towards +z.
    const int positions = mode == 6 ? text.positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})
                                    : text.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
    text.set("meshes", fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{0}}},"mode":{1}}},
                                   {{"attributes":{{"POSITION":{0}}},"mode":{2}}}]}}])",
                                   positions, mode, points));
    return scene(text);
  };
  for (const int mode : {5, 6}) {
    const SceneDescription read = trianglesBy(mode, mode == 5 ? 0 : 3);
    const MeshGeometry mesh = meshOf(read);
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.positions.size(), 4U);
    for (const glm::uvec3& t : mesh.triangles) {
      const Vec3d& a = mesh.positions[t.x];
      EXPECT_EQ(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a), Vec3d(0, 0, 1)) << mode;
    }
    EXPECT_THAT(read.warnings, Contains(HasSubstr(mode == 5 ? "not used: points" : "not used: lines")));
  }
}

TEST_F(LoadGltf, ReadsInterleavedAndNormalisedAttributes) {
  GltfText text;
  std::string vertices;
  for (const float x : {0.0f, 1.0f, 2.0f}) {
    vertices += test::floats({x, x * x, 0});
    vertices += test::littleEndian<std::uint8_t>({0, 127, 0, 9});   // a normal, and what fills it up
    vertices += test::littleEndian<std::uint16_t>({65535, 13107});  // u = 1, v = 0.2
  }
  const int view = text.view(vertices, R"(,"byteStride":20)");
  text.accessor(view, test::kFloat, 3, "VEC3");
  text.accessor(view, test::kByte, 3, "VEC3", R"(,"byteOffset":12,"normalized":true)");
  text.accessor(view, test::kUshort, 3, "VEC2", R"(,"byteOffset":16,"normalized":true)");
  text.set("meshes", R"([{"primitives":[{"attributes":{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}}]}])");
  const SceneDescription read = scene(text);
  EXPECT_THAT(gltfCorners(meshOf(read)), ElementsAre(Vec3d(0), Vec3d(1, 1, 0), Vec3d(2, 4, 0)));
  EXPECT_THAT(meshOf(read).normals, testing::Each(Vec3d(0, 1, 0)));
  EXPECT_THAT(meshOf(read).uvs, testing::Each(Vec2(1.0f, 0.8f))) << "v runs down in the file";
}

TEST_F(LoadGltf, ReadsSparseAccessors) {
  GltfText text;
  const int base = text.view(test::floats({0, 0, 0, 1, 0, 0, 0, 1, 0}));
  const int places = text.view(test::littleEndian<std::uint16_t>({2}));
  const int values = text.view(test::floats({0, 5, 0}));
  text.accessor(base, test::kFloat, 3, "VEC3",
                fmt::format(R"(,"sparse":{{"count":1,"indices":{{"bufferView":{},"componentType":5123}},
                            "values":{{"bufferView":{}}}}})",
                            places, values));
  text.set("meshes", R"([{"primitives":[{"attributes":{"POSITION":0}}]}])");
  EXPECT_THAT(gltfCorners(meshOf(scene(text))), ElementsAre(Vec3d(0), Vec3d(1, 0, 0), Vec3d(0, 5, 0)));
}

TEST_F(LoadGltf, KeepsTheVerticesThatTrianglesUse) {
  GltfText text;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const int positions = text.positions({9, 9, 9, nan, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int indices =
      text.accessor(text.view(test::littleEndian<std::uint8_t>({2, 3, 4, 3})), test::kUbyte, 4, "SCALAR");
  text.set("meshes", fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{}}},"indices":{}}}]}}])",
                                 positions, indices));
  const SceneDescription read = scene(text);
  EXPECT_EQ(meshOf(read).positions, kGltfTriangle);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("after the last whole triangle")));
}

TEST_F(LoadGltf, LeavesOutNormalsWithoutLength) {
  GltfText text;
  const int normals =
      text.accessor(text.view(test::floats({0, 0, 1, 0, 0, 0, 0, 0, 1})), test::kFloat, 3, "VEC3");
  text.triangle(fmt::format(R"(,"NORMAL":{})", normals));
  const SceneDescription read = scene(text);
  EXPECT_THAT(meshOf(read).normals, IsEmpty());
  EXPECT_THAT(read.warnings, Contains(HasSubstr("flat-shaded")));
}

TEST_F(LoadGltf, SaysOnceWhatItDoesNotUse) {
  GltfText text;
  const int more = text.positions({0, 0, 1, 0, 0, 1, 0, 0, 1});
  text.triangle(fmt::format(R"(,"TANGENT":{0},"_OWN":{0},"JOINTS_0":{0})", more),
                fmt::format(R"(,"targets":[{{"POSITION":{}}}])", more));
  text.set("nodes", R"([{"mesh":0,"skin":0},{"mesh":0,"skin":0}])").set("skins", R"([{"joints":[0]}])");
  text.set("animations", R"([{"channels":[{"sampler":0,"target":{"path":"translation"}}],
                            "samplers":[{"input":0,"output":0}]}])");
  text.set("extensionsUsed", R"(["KHR_materials_sheen","KHR_mesh_quantization"])");
  text.set("scenes", R"([{"nodes":[0]},{"nodes":[1]}])");
  EXPECT_THAT(scene(text).warnings,
              Contains(testing::EndsWith("a.gltf: not used: the extension KHR_materials_sheen, scenes beside "
                                         "scene 0, skins, the attribute TANGENT, the attribute _OWN, morph "
                                         "targets, animations")));
}

TEST_F(LoadGltf, SaysWhatMaterialsHaveAndFilesDoNotDeclare) {
  GltfText text = GltfText().triangle();
  text.set("materials", R"([{"extensions":{"KHR_materials_clearcoat":{"clearcoatFactor":1}}}])");
  EXPECT_THAT(scene(text).warnings,
              Contains(testing::HasSubstr("not used: the extension KHR_materials_clearcoat")));
}

// ---- nodes

TEST_F(LoadGltf, PlacesInstancesByAllTheirParents) {
  GltfText text = GltfText().triangle();
  // Scaled by 2, turned by 90 degrees about z, moved; below a node that moves along x, and once by a matrix.
  text.set("nodes", R"([{"children":[1,2],"translation":[10,0,0]},
    {"mesh":0,"name":"turned","scale":[2,2,2],"rotation":[0,0,0.7071067811865476,0.7071067811865476],
     "translation":[0,0,1]},
    {"mesh":0,"matrix":[1,0,0,0, 0,0,1,0, 0,-1,0,0, 1,2,3,1]}])");
  text.set("scenes", R"([{"nodes":[2]},{"nodes":[0]}])").set("scene", "1");
  const SceneDescription read = scene(text);
  ASSERT_EQ(read.shapes.size(), 2U);
  EXPECT_EQ(read.shapes[0].name, "turned");
  EXPECT_EQ(read.shapes[1].name, "mesh 0");
  const std::vector<Vec3d> expected = {Vec3d(10, 0, 1), Vec3d(10, 2, 1), Vec3d(8, 0, 1)};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(glm::length(gltfCorners(meshOf(read, 0))[i] - expected[i]), 1e-14) << i;
  EXPECT_THAT(gltfCorners(meshOf(read, 1)), ElementsAre(Vec3d(11, 2, 3), Vec3d(12, 2, 3), Vec3d(11, 2, 4)));
}

TEST_F(LoadGltf, KeepsFrontSidesWhereNodesMirror) {
  GltfText text;
  const int normals =
      text.accessor(text.view(test::floats({0, 0, 2, 3, 0, 4, 0, 0, 2})), test::kFloat, 3, "VEC3");
  text.triangle(fmt::format(R"(,"NORMAL":{})", normals)).set("nodes", R"([{"mesh":0,"scale":[-2,1,1]}])");
  const SceneDescription read = scene(text);
  const MeshGeometry mesh = meshOf(read);
  EXPECT_THAT(gltfCorners(mesh), ElementsAre(Vec3d(0), Vec3d(0, 1, 0), Vec3d(-2, 0, 0)))
      << "front to +z still";
  EXPECT_EQ(mesh.normals[0], Vec3d(0, 0, 1));
  // Normals go by the inverse transposed: (3, 0, 4) becomes (-1.5, 0, 4).
  EXPECT_LT(glm::length(mesh.normals[1] - glm::normalize(Vec3d(-1.5, 0, 4))), 1e-15);
}

TEST_F(LoadGltf, ReadsChainsOfAnyDepth) {
  GltfText text = GltfText().triangle();
  constexpr int kNodes = 100'000;
  std::string nodes = "[";
  for (int i = 0; i + 1 < kNodes; ++i) nodes += fmt::format(R"({{"children":[{}]}},)", i + 1);
  text.set("nodes", nodes + R"({"mesh":0}])");
  EXPECT_EQ(gltfCorners(meshOf(scene(text))), kGltfTriangle);
}

// ---- cameras and lights

TEST_F(LoadGltf, ReadsCameras) {
  GltfText text = GltfText().triangle();
  text.set("cameras", R"([{"type":"perspective","name":"lens",
      "perspective":{"yfov":1.0471975511965976,"znear":0.1,"aspectRatio":1.5}},
    {"type":"orthographic","orthographic":{"xmag":1,"ymag":2,"znear":0,"zfar":9}}])");
  text.set("nodes", R"([{"mesh":0},{"camera":0,"translation":[0.5,0.5,4]},{"camera":0,"name":"lens"},
    {"camera":1,"rotation":[0,0.7071067811865476,0,0.7071067811865476]}])");
  const SceneDescription read = scene(text);
  ASSERT_EQ(read.cameras.size(), 3U);
  EXPECT_EQ(read.cameras[0].name, "lens");
  EXPECT_NEAR(read.cameras[0].fovYDegrees, 60.0, 1e-12);
  EXPECT_EQ(read.cameras[0].width, 768);
  EXPECT_EQ(read.cameras[0].height, 512);
  EXPECT_EQ(read.cameras[0].position, Vec3d(0.5, 0.5, 4));
  EXPECT_EQ(read.cameras[0].target, Vec3d(0.5, 0.5, 0)) << "as far as the middle of what there is";
  EXPECT_EQ(read.cameras[1].name, "lens 2");
  EXPECT_EQ(read.cameras[2].name, "camera 1");
  EXPECT_EQ(read.cameras[2].projection, Projection::Orthographic);
  EXPECT_EQ(read.cameras[2].orthographicHeight, 4.0);
  EXPECT_EQ(read.cameras[2].width, 256);
  EXPECT_LT(glm::length(read.cameras[2].target - Vec3d(-1, 0, 0)), 1e-15) << "turned to the left";
  EXPECT_THAT(read.warnings, testing::Not(Contains(HasSubstr("camera"))));
}

TEST_F(LoadGltf, ReadsLights) {
  GltfText text = GltfText().triangle();
  text.set("extensionsUsed", R"(["KHR_lights_punctual"])")
      .set("extensions", R"({"KHR_lights_punctual":{"lights":[
    {"type":"point","intensity":3,"color":[1,0.5,0],"range":7},
    {"type":"spot","name":"beam","spot":{"innerConeAngle":0.5235987755982988}},
    {"type":"directional","intensity":2}]}})");
  text.set("nodes", R"([{"mesh":0},
    {"extensions":{"KHR_lights_punctual":{"light":0}},"translation":[1,2,3],"name":"bulb"},
    {"extensions":{"KHR_lights_punctual":{"light":1}}},
    {"extensions":{"KHR_lights_punctual":{"light":2}},
     "rotation":[-0.7071067811865476,0,0,0.7071067811865476]}])");
  const SceneDescription read = scene(text);
  ASSERT_EQ(read.lights.size(), 3U);
  EXPECT_EQ(read.lights[0].name, "bulb");
  const auto& point = std::get<PointLightDescription>(read.lights[0].geometry);
  EXPECT_EQ(point.position, Vec3d(1, 2, 3));
  EXPECT_EQ(point.intensity, Rgb(3, 1.5, 0));
  EXPECT_EQ(read.lights[1].name, "beam");
  const auto& spot = std::get<SpotLightDescription>(read.lights[1].geometry);
  EXPECT_EQ(spot.direction, Vec3d(0, 0, -1));
  EXPECT_NEAR(spot.innerDegrees, 30.0, 1e-12);
  EXPECT_NEAR(spot.outerDegrees, 45.0, 1e-7) << "the default";
  const auto& sun = std::get<DirectionalLightDescription>(read.lights[2].geometry);
  EXPECT_LT(glm::length(sun.direction - Vec3d(0, -1, 0)), 1e-15);
  EXPECT_EQ(sun.irradiance, Rgb(2.0f));
  EXPECT_THAT(read.warnings, Contains(HasSubstr("not used: the range of lights")));
  EXPECT_THAT(read.warnings, testing::Not(Contains(HasSubstr("sky"))));
}

TEST_F(LoadGltf, SaysWhereSpotsHaveTheirConesTheWrongWayRound) {
  const auto spotOf = [this](const std::string& cones) {
    GltfText text = GltfText().triangle();
    text.set("extensions", R"({"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{)" + cones + "}}]}}");
    text.set("nodes", R"([{"mesh":0},{"extensions":{"KHR_lights_punctual":{"light":0}}}])");
    return scene(text);
  };
  const auto isSaid = Contains(HasSubstr("of spot lights whose inner cone is wider than the outer one"));
  const SceneDescription wrong = spotOf(R"("innerConeAngle":0.5,"outerConeAngle":0.25)");
  EXPECT_THAT(wrong.warnings, isSaid);
  const auto& spot = std::get<SpotLightDescription>(wrong.lights.at(0).geometry);
  EXPECT_EQ(spot.innerDegrees, spot.outerDegrees);
  EXPECT_THAT(spotOf(R"("innerConeAngle":0.25,"outerConeAngle":0.5)").warnings, testing::Not(isSaid));
}

// ---- as a mesh

TEST_F(LoadGltf, IsOneMeshForSceneFiles) {
  GltfText text;
  const int positions = text.positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int normals = text.positions({1, 0, 0, 1, 0, 0, 1, 0, 0});
  text.set("meshes", fmt::format(R"([{{"primitives":[{{"attributes":{{"POSITION":{0}}},"material":1}},
      {{"attributes":{{"POSITION":{0},"NORMAL":{1}}},"material":0}}]}}])",
                                 positions, normals));
  text.set("materials", R"([{"pbrMetallicRoughness":{"metallicFactor":0}},{"name":"second"}])");
  text.set("nodes", R"([{"mesh":0},{"camera":0}])");
  text.set("cameras", R"([{"type":"perspective","perspective":{"yfov":1,"znear":0.1}}])");
  folder.write("a.glb", text.glb());
  const auto sceneWith = [this](const std::string& more) {
    return loadScene(folder.write("scene.toml",
                                  "version = 1\n[camera]\n[material.red]\ndiffuse = [0.5, 0, 0]\n"
                                  "[[shape]]\ntype = \"mesh\"\nfile = \"a.glb\"\n" +
                                      more));
  };
  const Expected<SceneDescription> own = sceneWith("");
  ASSERT_TRUE(own) << own.error().message();
  const MeshGeometry mesh = meshOf(*own);
  EXPECT_THAT(mesh.triangleMaterials, ElementsAre(0U, 1U));
  EXPECT_THAT(std::get<MeshDescription>(own->shapes[0].geometry).materials, ElementsAre(1U, 2U))
      << "after the scene's own";
  EXPECT_EQ(own->materials.at(1).name, "a.glb: second");
  EXPECT_EQ(mesh.normals.front(), Vec3d(0, 0, 1)) << "of its face";
  EXPECT_EQ(mesh.normals.back(), Vec3d(1, 0, 0));
  EXPECT_THAT(own->warnings, ElementsAre(HasSubstr("not used: cameras of a mesh")));
  const Expected<SceneDescription> red = sceneWith("material = \"red\"\n");
  ASSERT_TRUE(red) << red.error().message();
  EXPECT_THAT(std::get<MeshDescription>(red->shapes[0].geometry).materials, IsEmpty());
}

}  // namespace
}  // namespace lightvane
