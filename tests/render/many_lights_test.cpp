// Of many lights with vectors, only those that matter at a point are asked for them there.

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/render/learn_sight.h"
#include "core/trace/direct_light.h"
#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

/// A corridor, 40 long, with small lamps along both of its upper edges.
SceneDescription corridor(int lamps) {
  std::string text = R"(
version = 1
[camera]
position = [0, 1.5, 19]
target = [0, 1.2, 0]
fov_y = 60
resolution = [48, 36]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.lamp]
emission = [40, 36, 30]
[[shape]]
type = "box"
material = "white"
min = [-1.5, 0, -20]
max = [1.5, 3, 20]
)";
  for (int i = 0; i < lamps; ++i) {
    text += fmt::format(
        "[[shape]]\ntype = \"disc\"\nmaterial = \"lamp\"\ncenter = [{}, 2.9, {}]\nnormal = [0, -1, "
        "0]\nradius = "
        "0.05\n",
        i % 2 == 0 ? -1.2 : 1.2, -19.5 + 39.0 * i / lamps);
  }
  return sceneFromText(text);
}

Parameters withVectors(const char* mode) {
  return parametersWith({{"preset", "draft"}, {"dlv.mode", mode}, {"ilv.seed", "20"}, {"dlv.seed", "50"}});
}

LightSight sightOf(const Stage& stage) {
  RayCounts counts;
  const StopFlag goOn = false;
  return learnSight(*stage.tracer, stage.camera, *stage.pool, goOn, counts);
}

/// A closed room with a lamp, and so many small lamps beyond its walls that give `brightness` times as much.
SceneDescription closedRoom(int outside, double brightness = 1.0) {
  std::string text = fmt::format(R"(
version = 1
[camera]
position = [0, 1, 1.9]
target = [0, 1, 0]
fov_y = 70
resolution = [48, 36]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.lamp]
emission = [20, 20, 20]
[material.outside]
emission = [{0}, {0}, {0}]
[[shape]]
type = "box"
material = "white"
min = [-1.5, 0, -2]
max = [1.5, 2, 2]
[[shape]]
type = "disc"
material = "lamp"
center = [0, 1.9, -0.5]
normal = [0, -1, 0]
radius = 0.15
)",
                                 20.0 * brightness);
  for (int i = 0; i < outside; ++i) {
    const double angle = 6.283185307179586 * i / outside;
    text += fmt::format(
        "[[shape]]\ntype = \"sphere\"\nmaterial = \"outside\"\ncenter = [{}, {}, {}]\nradius = 0.1\n",
        4.0 * std::cos(angle), 1.0 + 1.5 * std::sin(5.0 * angle), 4.0 * std::sin(angle));
  }
  return sceneFromText(text);
}

TEST(LightsBehindWalls, KeepNoVectorsAndHardlyCostRays) {
  for (const char* mode : {"always", "never"}) {
    const Picture alone = picture(Stage(closedRoom(0)), withVectors(mode));
    const Stage stage(closedRoom(300));
    const Picture among = picture(stage, withVectors(mode));
    ASSERT_EQ(stage.scene->lights.size(), 301U);
    // The lamp's, and those of some of which too little is known.
    EXPECT_GE(10 * among.statistics.dlvRecords, 9 * alone.statistics.dlvRecords) << mode;
    EXPECT_LE(among.statistics.dlvRecords, 2 * alone.statistics.dlvRecords) << mode;
    // Those by which what can be seen is learned are some 100,000, more than so small a picture has.
    EXPECT_LT(among.statistics.rays.shadow, 2 * alone.statistics.rays.shadow + 150'000) << mode;
    for (const Picture* one : {&alone, &among}) EXPECT_EQ(badPixel(one->film), "");
    const double expected = mean(alone.film.direct);
    EXPECT_NEAR(mean(among.film.direct), expected, 0.03 * expected) << mode;
    EXPECT_NEAR(mean(among.film.indirect), mean(alone.film.indirect), 0.1 * mean(alone.film.indirect))
        << mode;
  }
}

TEST(LightsBehindWalls, LeaveTheLampInTheRoomItsRays) {
  // Though together they would give a thousand times as much.
  const Stage stage(closedRoom(300, 100.0));
  const LightSight sight = sightOf(stage);
  const Scene& scene = *stage.scene;
  const Vec3 floor = scene.normalisation.point(Vec3d(0.2, 0.0, -0.4));
  const auto probability = [&](LightTree::Sight seen) {
    return scene.lightTree.probability(scene.lights, 0, floor, Vec3(0, 1, 0), seen);
  };
  EXPECT_LT(probability({}), 0.002f);
  EXPECT_GT(probability(sight.at(floor)), 0.05f);
}

TEST(LightsBehindWalls, AreFoundWhereADoorStandsOpen) {
  // All lamps are seen in the corridor.
  const Stage stage(corridor(60));
  const LightSight sight = sightOf(stage);
  for (const double z : {-10.0, 0.0, 10.0}) {
    const LightTree::Sight seen = sight.at(stage.scene->normalisation.point(Vec3d(0, 0, z)));
    ASSERT_FALSE(seen.empty());
    EXPECT_GT(seen.front(), 0.8f) << z;
  }
}

TEST(LightsBehindWalls, AreLearnedAlikeByAnyThreads) {
  const SceneDescription scene = closedRoom(100);
  const LightSight one = sightOf(Stage(scene, 1)), two = sightOf(Stage(scene, 2));
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 place(uniform(randomKey(3), i, 0), uniform(randomKey(3), i, 1), uniform(randomKey(3), i, 2));
    EXPECT_TRUE(std::ranges::equal(one.at(place - Vec3(0.5f)), two.at(place - Vec3(0.5f))));
  }
}

TEST(LightsBehindWalls, AreNotLearnedWhereTheyAreFew) {
  EXPECT_TRUE(sightOf(Stage(closedRoom(kMostLightsInFull - 1))).at(Vec3(0.0f)).empty());
  EXPECT_FALSE(sightOf(Stage(closedRoom(kMostLightsInFull))).at(Vec3(0.0f)).empty());
}

TEST(ManyLightsWithVectors, KeepTheseWhereTheyMatter) {
  const Stage stage(corridor(60));
  const Picture vectors = picture(stage, withVectors("always"));
  ASSERT_TRUE(vectors.snapshot);
  const auto lights = static_cast<std::uint32_t>(stage.scene->lights.size());
  ASSERT_EQ(lights, 60U);
  const LightSight sight = sightOf(stage);
  LightShares shares;
  std::size_t records = 0;
  std::set<std::uint32_t> with;
  for (std::uint32_t light = 0; light < lights; ++light) {
    const auto& set = vectors.snapshot->direct[light];
    for (std::size_t i = 0; i < set.size(); ++i) {
      shares.weigh(*stage.scene, set[i].point.position, set[i].point.normal, &sight);
      EXPECT_TRUE(shares.areWorthVectorsOf(light)) << "light " << light << ", vector " << i;
      with.insert(light);
      ++records;
    }
  }
  EXPECT_GT(records, 500U);
  EXPECT_GT(with.size(), 20U) << "most lights matter somewhere";

  // The light is the same as where each point is sampled.
  const Picture sampled = picture(stage, withVectors("never"));
  const double expected = mean(sampled.film.direct);
  EXPECT_NEAR(mean(vectors.film.direct), expected, 0.03 * expected);
  EXPECT_EQ(badPixel(vectors.film), "");
}

TEST(ManyLightsWithVectors, GiveTheSamePictureForAnyThreadsAndOfAWarmCache) {
  const SceneDescription scene = corridor(40);
  const Stage one(scene, 1), two(scene, 2);
  const Picture first = picture(one, withVectors("always"));
  EXPECT_EQ(difference(first.film, picture(two, withVectors("always")).film), "");
  CacheInput warm;
  warm.warm = first.snapshot;
  const Picture again = picture(one, withVectors("always"), warm);
  EXPECT_EQ(again.statistics.dlvRecords, first.statistics.dlvRecords) << "nothing is missing";
  EXPECT_NEAR(mean(again.film.direct), mean(first.film.direct), 1e-3 * mean(first.film.direct));
}

}  // namespace
}  // namespace lightvane::render_test
