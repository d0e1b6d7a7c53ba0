#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/scene/polygon.h"
#include "core/scene/write_scene.h"
#include "tests/scene/load_support.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = LIGHTVANE_SOURCE_DIR;

std::vector<std::string> shippedScenes() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "assets/scenes")) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

SceneDescription loadShipped(const std::string& name) {
  Expected<SceneDescription> scene = loadScene(kSource / "assets/scenes" / name);
  EXPECT_TRUE(scene) << scene.error().message();
  return scene ? *std::move(scene) : SceneDescription{};
}

const MaterialDescription& materialOf(const SceneDescription& scene, const std::string& shapeName) {
  for (const ShapeDescription& shape : scene.shapes) {
    if (shape.name == shapeName) return scene.materials[shape.material];
  }
  throw std::logic_error("no shape " + shapeName);
}

class ShippedScene : public testing::TestWithParam<std::string> {};

TEST_P(ShippedScene, LoadsWithoutAWarning) {
  const SceneDescription scene = loadShipped(GetParam());
  EXPECT_FALSE(scene.shapes.empty());
  EXPECT_THAT(scene.warnings, testing::IsEmpty());
}

TEST(DocumentedScenes, LoadWithoutAWarning) {
  int count = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "docs/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Expected<SceneDescription> scene = loadScene(entry.path());
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_THAT(scene->warnings, testing::IsEmpty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 10);
}

TEST_P(ShippedScene, IsTheSameWrittenAndReadAgain) {
  const SceneDescription scene = loadShipped(GetParam());
  const Expected<std::string> text = sceneToml(scene);
  ASSERT_TRUE(text) << text.error().message();
  const Expected<SceneDescription> again = parseSceneToml(*text, scene.path);
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(sceneHash(*again), sceneHash(scene));
  EXPECT_EQ(sceneToml(*again).value(), *text);
}

TEST_P(ShippedScene, HasItsSourceInTheReadme) {
  const std::string readme = readFile(kSource / "assets/README.md").value();
  EXPECT_THAT(readme, testing::HasSubstr("`scenes/" + GetParam() + "`"));
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene, testing::ValuesIn(shippedScenes()),
                         [](const testing::TestParamInfo<std::string>& name) {
                           std::string word = fs::path(name.param).stem().string();
                           std::replace(word.begin(), word.end(), '-', '_');
                           return word;
                         });

TEST(ShippedScenes, OfCornellDifferInTheirBlocksOnly) {
  const SceneDescription plain = loadShipped("cornell.toml");
  for (const char* name : {"cornell-mirror.toml", "cornell-glossy.toml"}) {
    const SceneDescription other = loadShipped(name);
    ASSERT_EQ(other.shapes.size(), plain.shapes.size()) << name;
    for (std::size_t i = 0; i < plain.shapes.size(); ++i) {
      EXPECT_EQ(other.shapes[i].name, plain.shapes[i].name) << name;
      EXPECT_EQ(std::get<PolygonDescription>(other.shapes[i].geometry).vertices,
                std::get<PolygonDescription>(plain.shapes[i].geometry).vertices)
          << name << " " << plain.shapes[i].name;
      const bool isBlock =
          plain.shapes[i].name.starts_with("short") || plain.shapes[i].name.starts_with("tall");
      if (isBlock) continue;
      EXPECT_EQ(other.materials[other.shapes[i].material].name,
                plain.materials[plain.shapes[i].material].name)
          << name << " " << plain.shapes[i].name;
    }
  }
}

TEST(ShippedScenes, CornellMirrorHasAMirrorBlockAndDlvs) {
  const SceneDescription scene = loadShipped("cornell-mirror.toml");
  EXPECT_EQ(materialOf(scene, "tall_0").mirror, Rgb(1.0f));
  EXPECT_EQ(materialOf(scene, "tall_0").diffuse, Rgb(0.0f));
  EXPECT_EQ(materialOf(scene, "short_0").diffuse, Rgb(0.725, 0.71, 0.68));
  EXPECT_EQ(materialOf(scene, "light").emission, Rgb(17.0, 12.0, 4.0));
  ASSERT_EQ(scene.render.size(), 1U);
  EXPECT_EQ(scene.render[0].key, "dlv.mode");
  EXPECT_EQ(scene.render[0].value, "always");
}

TEST(ShippedScenes, FurnaceIsClosedAndItsFrontsFaceInwards) {
  const SceneDescription scene = loadShipped("furnace.toml");
  ASSERT_EQ(scene.shapes.size(), 6U);
  const Vec3d centre(0.5);
  Vec3d sumOfNormals(0.0);
  for (const ShapeDescription& shape : scene.shapes) {
    const MaterialDescription& material = scene.materials[shape.material];
    EXPECT_EQ(material.diffuse, Rgb(0.5f));
    EXPECT_EQ(material.emission, Rgb(1.0f));
    const std::vector<Vec3d>& v = std::get<PolygonDescription>(shape.geometry).vertices;
    const Vec3d normal = polygonNormal(v);
    EXPECT_EQ(glm::dot(normal, centre - v[0]), 0.5)
        << shape.name << " is not half a unit in front of the centre";
    sumOfNormals += normal;
  }
  EXPECT_EQ(sumOfNormals, Vec3d(0.0)) << "six different sides of a cube";
}

TEST(ShippedScenes, WallsFaceTheCamera) {
  // Of an open box, every wall's front is on the side of the box's middle; the lamp's is below it.
  for (const char* name : {"cornell.toml", "two-rooms.toml"}) {
    const SceneDescription scene = loadShipped(name);
    BoundsD bounds;
    for (const ShapeDescription& shape : scene.shapes) {
      if (const auto* polygon = std::get_if<PolygonDescription>(&shape.geometry)) {
        for (const Vec3d& v : polygon->vertices) bounds.add(v);
      }
    }
    for (const ShapeDescription& shape : scene.shapes) {
      const auto* polygon = std::get_if<PolygonDescription>(&shape.geometry);
      if (!polygon || shape.name.starts_with("short") || shape.name.starts_with("tall")) continue;
      EXPECT_GT(glm::dot(polygonNormal(polygon->vertices), bounds.centre() - polygon->vertices[0]), 0.0)
          << name << " " << shape.name;
    }
  }
}

TEST(SceneFormatDocument, ShowsAnExampleThatLoads) {
  const std::string document = readFile(kSource / "docs/scene-format.md").value();
  const std::string opening = "```toml\n";
  const std::size_t begin = document.find(opening) + opening.size();
  const std::size_t end = document.find("```", begin);
  ASSERT_NE(end, std::string::npos);
  EXPECT_EQ(test::parseError(document.substr(begin, end - begin)), "");
}

// ---- files that are no scenes

TEST(LoadScene, NamesTheKindsOfFilesItReads) {
  const auto errorOf = [](const char* name) {
    const Expected<SceneDescription> scene = loadScene(name);
    return scene ? std::string("none") : scene.error().message();
  };
  EXPECT_EQ(errorOf("none.toml"), "none.toml: no such file");
  EXPECT_EQ(errorOf("none.obj"), "none.obj: no such file");
  EXPECT_EQ(errorOf("a.stl"), "a.stl: expected a .toml, .obj, .ply, .gltf or .glb file, found .stl");
  EXPECT_EQ(errorOf("a"),
            "a: expected a .toml, .obj, .ply, .gltf or .glb file, found a name without an extension");
  EXPECT_EQ(errorOf("a.gltf"), "a.gltf: no such file");
  EXPECT_EQ(errorOf("a.GLB"), "a.GLB: no such file");
}

}  // namespace
}  // namespace lightvane
