#include <gtest/gtest.h>

#include "tests/support/counting_watch.h"
#include "tests/trace/scene_builder.h"

namespace lightvane {
namespace {

using test::CountingWatch;

/// Bumpy floors of 2 * side^2 triangles each; of glass where there are to be three trees. Of two, both are
/// instances of one mesh.
std::shared_ptr<const Scene> bumpyFloor(int side, bool isPane, int floors = 1) {
  SceneDescription description;
  description.cameras.emplace_back();
  MaterialDescription material;
  material.opacity.value = isPane ? 0.5 : 1.0;
  description.materials.push_back(material);
  MeshGeometry mesh;
  for (int i = 0; i < (side + 1) * (side + 1); ++i) {
    const int x = i % (side + 1);
    const int z = i / (side + 1);
    mesh.positions.emplace_back(x, (x * 7 + z * 3) % 5, z);
  }
  for (int z = 0; z < side; ++z) {
    for (int x = 0; x < side; ++x) {
      const auto a = static_cast<std::uint32_t>(z * (side + 1) + x);
      const auto b = static_cast<std::uint32_t>(a + static_cast<std::uint32_t>(side) + 1);
      mesh.triangles.emplace_back(a, b, a + 1);
      mesh.triangles.emplace_back(a + 1, b, b + 1);
    }
  }
  ShapeDescription shape;
  shape.geometry = MeshDescription{"", std::make_shared<const MeshGeometry>(std::move(mesh)), {}};
  description.shapes.assign(static_cast<std::size_t>(floors), shape);
  return Scene::compile(description).value();
}

class TracerStop : public testing::TestWithParam<bool> {};

TEST_P(TracerStop, TellsHowFarTheTreesOfInstancesAre) {
  const auto scene = bumpyFloor(100, GetParam(), 2);
  ASSERT_EQ(scene->instances.size(), 2U);
  CountingWatch whole;
  const Tracer tracer(scene, whole);
  test::expectRisingFractions(whole);
  for (std::size_t n = 0; n < whole.looks() / 2; n += 1 + n) {
    CountingWatch watch(n);
    EXPECT_THROW(Tracer(scene, watch), LoadStopped) << n;
  }
}

TEST_P(TracerStop, WhileTheTreeIsBuiltLeavesNothingBehind) {
  const auto scene = bumpyFloor(300, GetParam());
  CountingWatch whole;
  const Tracer tracer(scene, whole);
  EXPECT_EQ(whole.stages(), std::vector<std::string>{"building the tree of 180 k triangles"});
  test::expectRisingFractions(whole);
  EXPECT_GT(whole.told().size(), 20U) << "Embree tells how far it is";
  ASSERT_GT(whole.looks(), 50U);
  const long owners = scene.use_count();
  for (std::size_t n = 0; n < whole.looks() / 2; n += 1 + n) {
    CountingWatch watch(n);
    EXPECT_THROW(Tracer(scene, watch), LoadStopped) << n;
    // Other threads of Embree may look before they hear of it.
    EXPECT_LE(watch.looks(), n + 200) << "of " << whole.looks();
    EXPECT_EQ(scene.use_count(), owners) << "the tracer that was stopped holds nothing";
  }
  // What was stopped does not show in what comes after.
  const Tracer again(scene);
  EXPECT_EQ(again.memoryBytes(), tracer.memoryBytes());
  const Ray down{Vec3(0.01f, 1.0f, 0.02f), Vec3(0, -1, 0), 0.0f, kInfinity};
  EXPECT_TRUE(again.intersect(down).found());
  EXPECT_EQ(again.intersect(down).t, tracer.intersect(down).t);
}

INSTANTIATE_TEST_SUITE_P(Panes, TracerStop, testing::Values(false, true));

}  // namespace
}  // namespace lightvane
