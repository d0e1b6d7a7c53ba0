#include <functional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/load_support.h"

namespace lightvane {
namespace {

/// A scene that has one of everything.
SceneDescription fullScene() {
  SceneDescription scene;
  scene.path = "a.toml";
  scene.name = "a";
  scene.cameras.resize(2);
  scene.materials.resize(2);
  scene.materials[0].layers.resize(1);
  scene.materials[0].tangent = Vec3d(1, 0, 0);
  MeshGeometry triangles;
  triangles.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangles.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  triangles.colors = {Rgb(1.0f), Rgb(0.5f), Rgb(0.0f)};
  triangles.uvs = {{0, 0}, {1, 0}, {0, 1}};
  triangles.triangles = {{0, 1, 2}};
  triangles.triangleMaterials = {0};
  const MeshDescription mesh{"a.obj", std::make_shared<const MeshGeometry>(triangles), {0}};
  const PolygonDescription polygon{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  scene.shapes = {{"polygon", 0, "lamp", {}, polygon},
                  {"sphere", 0, "lamp", {}, SphereDescription{}},
                  {"box", 0, "", {}, BoxDescription{}},
                  {"disc", 0, "other", {}, DiscDescription{}},
                  {"mesh", 0, "", {}, mesh}};
  scene.lights = {
      {"point", PointLightDescription{}},
      {"spot", SpotLightDescription{}},
      {"sun", DirectionalLightDescription{}},
      {"cloud", VolumicSphereLightDescription{}},
      {"sky", EnvironmentLightDescription{.radiance = Rgb(1.0f),
                                          .image = "sky.hdr",
                                          .pixels = std::make_shared<ImageRgb>(2, 1, Rgb(1.0f))}}};
  scene.render = {{"seed", "1", "a.toml:1:1"}};
  scene.warnings = {"a"};
  return scene;
}

struct Mutation {
  const char* name;
  std::function<void(SceneDescription&)> apply;
};
void PrintTo(const Mutation& mutation, std::ostream* out) { *out << mutation.name; }

template <class T>
T& shapeOf(SceneDescription& scene) {
  for (ShapeDescription& shape : scene.shapes) {
    if (T* geometry = std::get_if<T>(&shape.geometry)) return *geometry;
  }
  throw std::logic_error("no such shape");
}
/// Of the scene alone: other copies of it keep the triangles that they have.
MeshGeometry& trianglesOf(SceneDescription& scene) {
  auto& mesh = shapeOf<MeshDescription>(scene);
  auto own = std::make_shared<MeshGeometry>(*mesh.geometry);
  mesh.geometry = own;
  return *own;
}
template <class T>
T& lightOf(SceneDescription& scene) {
  for (LightDescription& light : scene.lights) {
    if (T* geometry = std::get_if<T>(&light.geometry)) return *geometry;
  }
  throw std::logic_error("no such light");
}

using S = SceneDescription;

const std::vector<Mutation> kChangesOfThePicture = {
    {"Opacity", [](S& s) { s.materials[0].opacity.value = 0.5; }},
    {"OpacityTexture",
     [](S& s) {
       s.materials[0].opacity.texture = TextureUse{0, 1.0};
     }},
    {"OpacityCutoff",
     [](S& s) {
       s.materials[0].opacity = {0.5, {}, 0.25};
     }},
    {"Units", [](S& s) { s.units = "inch"; }},
    {"CameraCount", [](S& s) { s.cameras.pop_back(); }},
    {"CameraPosition", [](S& s) { s.cameras[0].position.x = 1; }},
    {"CameraTarget", [](S& s) { s.cameras[0].target.x = 1; }},
    {"CameraUp", [](S& s) { s.cameras[0].up.x = 1; }},
    {"CameraFieldOfView", [](S& s) { s.cameras[0].fovYDegrees = 46; }},
    {"CameraWidth", [](S& s) { s.cameras[0].width = 511; }},
    {"CameraHeight", [](S& s) { s.cameras[0].height = 511; }},
    {"CameraExposure", [](S& s) { s.cameras[0].exposureStops = 1; }},
    {"CameraProjection", [](S& s) { s.cameras[0].projection = Projection::Orthographic; }},
    {"CameraLens", [](S& s) { s.cameras[0].lensRadius = 0.1; }},
    {"SecondCameraLens", [](S& s) { s.cameras[1].lensRadius = 0.1; }},
    {"SecondCamera", [](S& s) { s.cameras[1].position.x = 1; }},
    {"CameraOrder",
     [](S& s) {
       s.cameras[1].position.x = 1;
       std::swap(s.cameras[0], s.cameras[1]);
     }},
    {"MaterialCount", [](S& s) { s.materials.pop_back(); }},
    {"Diffuse", [](S& s) { s.materials[0].diffuse.g = 0.5f; }},
    {"Mirror", [](S& s) { s.materials[0].mirror.g = 0.5f; }},
    {"Transmission", [](S& s) { s.materials[0].transmission.g = 0.5f; }},
    {"Ior", [](S& s) { s.materials[0].ior = 1.4; }},
    {"LayerCount", [](S& s) { s.materials[0].layers.emplace_back(); }},
    {"LayerColor", [](S& s) { s.materials[0].layers[0].color.b = 0.5f; }},
    {"LayerRoughness", [](S& s) { s.materials[0].layers[0].roughness = 0.5; }},
    {"LayerIsotropy", [](S& s) { s.materials[0].layers[0].isotropy = 0.5; }},
    {"LayerModel", [](S& s) { s.materials[0].layers[0].model = LayerModel::Ggx; }},
    {"Emission", [](S& s) { s.materials[0].emission.r = 0.5f; }},
    {"EmissionTexture",
     [](S& s) {
       s.materials[0].textures.emission = TextureUse{0, 1.0};
     }},
    {"TwoSided", [](S& s) { s.materials[0].twoSided = true; }},
    {"Tangent", [](S& s) { s.materials[0].tangent->z = 1; }},
    {"NoTangent", [](S& s) { s.materials[0].tangent.reset(); }},
    {"SecondMaterial", [](S& s) { s.materials[1].diffuse.r = 0.5f; }},
    {"ShapeCount", [](S& s) { s.shapes.pop_back(); }},
    {"ShapeOrder", [](S& s) { std::swap(s.shapes[0], s.shapes[1]); }},
    {"ShapeMaterial", [](S& s) { s.shapes[0].material = 1; }},
    {"ShapeLightRemoved", [](S& s) { s.shapes[0].light.clear(); }},
    {"ShapeLightsJoined", [](S& s) { s.shapes[3].light = "lamp"; }},
    {"ShapeLightsParted", [](S& s) { s.shapes[1].light = "third"; }},
    {"Translate", [](S& s) { s.shapes[0].transform.translate.x = 1; }},
    {"Rotate", [](S& s) { s.shapes[0].transform.rotateDegrees.x = 1; }},
    {"Scale", [](S& s) { s.shapes[0].transform.scale.x = 2; }},
    {"PolygonVertex", [](S& s) { shapeOf<PolygonDescription>(s).vertices[1].z = 1e-9; }},
    {"PolygonVertexCount", [](S& s) { shapeOf<PolygonDescription>(s).vertices.emplace_back(-1, 1, 0); }},
    {"SphereCenter", [](S& s) { shapeOf<SphereDescription>(s).center.x = 1; }},
    {"SphereRadius", [](S& s) { shapeOf<SphereDescription>(s).radius = 2; }},
    {"BoxMin", [](S& s) { shapeOf<BoxDescription>(s).min.x = -1; }},
    {"BoxMax", [](S& s) { shapeOf<BoxDescription>(s).max.x = 2; }},
    {"DiscCenter", [](S& s) { shapeOf<DiscDescription>(s).center.x = 1; }},
    {"DiscNormal", [](S& s) { shapeOf<DiscDescription>(s).normal.x = 1; }},
    {"DiscRadius", [](S& s) { shapeOf<DiscDescription>(s).radius = 2; }},
    {"MeshPosition", [](S& s) { trianglesOf(s).positions[2].z = 1; }},
    {"MeshNormal", [](S& s) { trianglesOf(s).normals[2].x = 1; }},
    {"MeshNoNormals", [](S& s) { trianglesOf(s).normals.clear(); }},
    {"MeshUv", [](S& s) { trianglesOf(s).uvs[2].x = 1; }},
    {"MeshTriangle",
     [](S& s) {
       trianglesOf(s).triangles[0] = {0, 2, 1};
     }},
    {"MeshTriangleCount", [](S& s) { trianglesOf(s).triangles.emplace_back(0, 2, 1); }},
    {"MeshTriangleMaterial", [](S& s) { trianglesOf(s).triangleMaterials[0] = 1; }},
    {"MeshMaterial", [](S& s) { shapeOf<MeshDescription>(s).materials[0] = 1; }},
    {"MeshOwnMaterial", [](S& s) { shapeOf<MeshDescription>(s).materials.clear(); }},
    {"MeshPlacement", [](S& s) { shapeOf<MeshDescription>(s).placement[3][0] = 1; }},
    {"MeshColor", [](S& s) { trianglesOf(s).colors[1].r = 1; }},
    {"LightCount", [](S& s) { s.lights.pop_back(); }},
    {"LightOrder", [](S& s) { std::swap(s.lights[0], s.lights[1]); }},
    {"PointPosition", [](S& s) { lightOf<PointLightDescription>(s).position.x = 1; }},
    {"PointIntensity", [](S& s) { lightOf<PointLightDescription>(s).intensity.r = 2; }},
    {"SpotPosition", [](S& s) { lightOf<SpotLightDescription>(s).position.x = 1; }},
    {"SpotDirection", [](S& s) { lightOf<SpotLightDescription>(s).direction.x = 1; }},
    {"SpotIntensity", [](S& s) { lightOf<SpotLightDescription>(s).intensity.r = 2; }},
    {"SpotInner", [](S& s) { lightOf<SpotLightDescription>(s).innerDegrees = 21; }},
    {"SpotOuter", [](S& s) { lightOf<SpotLightDescription>(s).outerDegrees = 31; }},
    {"SunDirection", [](S& s) { lightOf<DirectionalLightDescription>(s).direction.x = 1; }},
    {"SunIrradiance", [](S& s) { lightOf<DirectionalLightDescription>(s).irradiance.r = 2; }},
    {"SunAngle", [](S& s) { lightOf<DirectionalLightDescription>(s).angleDegrees = 1; }},
    {"CloudCenter", [](S& s) { lightOf<VolumicSphereLightDescription>(s).center.x = 1; }},
    {"CloudRadius", [](S& s) { lightOf<VolumicSphereLightDescription>(s).radius = 1; }},
    {"CloudIntensity", [](S& s) { lightOf<VolumicSphereLightDescription>(s).intensity.r = 2; }},
    {"SkyRadiance", [](S& s) { lightOf<EnvironmentLightDescription>(s).radiance.r = 2; }},
    {"SkyPixel",
     [](S& s) {
       auto pixels = std::make_shared<ImageRgb>(2, 1, Rgb(1.0f));
       pixels->at(1, 0).g = 2;
       lightOf<EnvironmentLightDescription>(s).pixels = pixels;
     }},
    {"SkySize",
     [](S& s) {
       lightOf<EnvironmentLightDescription>(s).pixels = std::make_shared<ImageRgb>(1, 2, Rgb(1.0f));
     }},
    {"SkyWithoutImage", [](S& s) { lightOf<EnvironmentLightDescription>(s).pixels = nullptr; }},
    {"SkyRotation", [](S& s) { lightOf<EnvironmentLightDescription>(s).rotateDegrees = 1; }},
    {"SkyUp", [](S& s) { lightOf<EnvironmentLightDescription>(s).up.x = 1; }},
    {"CloudPoints", [](S& s) { lightOf<VolumicSphereLightDescription>(s).points = 33; }},
};

class SceneHashChanges : public testing::TestWithParam<Mutation> {};

TEST_P(SceneHashChanges, WithAnythingThatChangesThePicture) {
  SceneDescription scene = fullScene();
  GetParam().apply(scene);
  EXPECT_NE(sceneHash(scene), sceneHash(fullScene()));
}

INSTANTIATE_TEST_SUITE_P(Fields, SceneHashChanges, testing::ValuesIn(kChangesOfThePicture),
                         [](const testing::TestParamInfo<Mutation>& m) { return m.param.name; });

const std::vector<Mutation> kChangesOfNothing = {
    {"Path", [](S& s) { s.path = "b.toml"; }},
    {"Name", [](S& s) { s.name = "b"; }},
    {"Render", [](S& s) { s.render.clear(); }},
    {"Warnings", [](S& s) { s.warnings.clear(); }},
    {"CameraName", [](S& s) { s.cameras[0].name = "b"; }},
    {"FocusWithoutALens", [](S& s) { s.cameras[0].focusDistance = 3; }},
    {"OrthographicHeightInPerspective", [](S& s) { s.cameras[0].orthographicHeight = 3; }},
    {"MaterialName", [](S& s) { s.materials[0].name = "b"; }},
    {"ShapeName", [](S& s) { s.shapes[0].name = "b"; }},
    {"LightName", [](S& s) { s.lights[0].name = "b"; }},
    {"LightGroupName", [](S& s) { s.shapes[0].light = s.shapes[1].light = "b"; }},
    {"MeshFile", [](S& s) { shapeOf<MeshDescription>(s).file = "b.obj"; }},
    {"SignOfZero", [](S& s) { s.cameras[0].position.x = -0.0; }},
};

class SceneHashKeeps : public testing::TestWithParam<Mutation> {};

TEST_P(SceneHashKeeps, WithWhatDoesNot) {
  SceneDescription scene = fullScene();
  GetParam().apply(scene);
  EXPECT_EQ(sceneHash(scene), sceneHash(fullScene()));
}

INSTANTIATE_TEST_SUITE_P(Fields, SceneHashKeeps, testing::ValuesIn(kChangesOfNothing),
                         [](const testing::TestParamInfo<Mutation>& m) { return m.param.name; });

TEST(SceneHash, TellsTexturesOfEmissionApart) {
  std::set<std::string> hashes;
  for (const TextureUse use : {TextureUse{0, 1.0}, TextureUse{1, 1.0}, TextureUse{0, 2.0}}) {
    for (const bool reflects : {false, true}) {
      SceneDescription scene = fullScene();
      MaterialTextures& textures = scene.materials[0].textures;
      textures.emission = use;
      if (reflects) textures.diffuse = TextureUse{0, 1.0};
      hashes.insert(sceneHash(scene));
      std::swap(textures.emission, textures.diffuse);
      hashes.insert(sceneHash(scene));
    }
  }
  // Three alone in either place, and pairs in either order, of which one is the same turned.
  EXPECT_EQ(hashes.size(), 6U + 5U);
}

TEST(SceneHash, TellsLensesAndOrthographicCamerasApart) {
  std::set<std::string> hashes;
  const auto add = [&](const std::function<void(CameraDescription&)>& change) {
    SceneDescription scene = fullScene();
    change(scene.cameras[0]);
    hashes.insert(sceneHash(scene));
  };
  for (const double height : {1.0, 2.0}) {
    add([&](CameraDescription& camera) {
      camera.projection = Projection::Orthographic;
      camera.orthographicHeight = height;
    });
  }
  for (const double radius : {1.0, 2.0}) {
    for (const double focus : {2.0, 3.0}) {
      add([&](CameraDescription& camera) {
        camera.lensRadius = radius;
        camera.focusDistance = focus;
      });
    }
  }
  EXPECT_EQ(hashes.size(), 6U);
  // A distance that is said and one that follows from the target are the same picture.
  add([](CameraDescription& camera) {
    camera.target = {0, 0, -2};
    camera.lensRadius = 1.0;
  });
  const std::size_t withFocusOnTarget = hashes.size();
  add([](CameraDescription& camera) {
    camera.target = {0, 0, -2};
    camera.lensRadius = 1.0;
    camera.focusDistance = 2.0;
  });
  EXPECT_EQ(hashes.size(), withFocusOnTarget);
}

TEST(SceneHash, StaysAsItIsUntilCachesAreToBeInvalidated) {
  EXPECT_EQ(sceneHash(SceneDescription{}), "cc12cd986edf1b3e");
}

TEST(SceneHash, IgnoresCommentsAndTheOrderOfKeysAndMaterials) {
  const auto hashOf = [](const char* text) {
    const Expected<SceneDescription> scene = parseSceneToml(text, "scene.toml");
    return scene ? sceneHash(*scene) : scene.error().message();
  };
  const std::string one = hashOf(R"(version = 1
[camera]
fov_y = 30
position = [0, 0, 5]
[material.a]
diffuse = [0.5, 0.5, 0.5]
[material.b]
mirror = [1, 1, 1]
[[shape]]
type = "sphere"
material = "b"
radius = 2
)");
  const std::string other = hashOf(R"(# the same
version = 1
render.seed = 3
[material]
b = { mirror = [1.0, 1.0, 1.0] }
a = { diffuse = [0.5, 0.5, 0.5] }
[[shape]]
radius = 2e0
material = "b"
type = "sphere"
[camera]
position = [-0.0, 0.0, 5.0]
fov_y = 30.0
)");
  EXPECT_EQ(one, other);
  EXPECT_EQ(one.size(), 16U) << one;
}

TEST(SceneHash, SeesWhatAMeshFileHolds) {
  const TemporaryFolder folder;
  const std::filesystem::path scene = folder.write("scene.toml",
                                                   "version = 1\n[camera]\n[material.a]\n[[shape]]\ntype = "
                                                   "\"mesh\"\nmaterial = \"a\"\nfile = \"a.obj\"\n");
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string before = sceneHash(loadScene(scene).value());
  folder.write("a.obj", "# moved\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(sceneHash(loadScene(scene).value()), before) << "a comment in the mesh file changed the hash";
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0.001\nf 1 2 3\n");
  EXPECT_NE(sceneHash(loadScene(scene).value()), before) << "a moved vertex did not change the hash";
}

}  // namespace
}  // namespace lightvane
