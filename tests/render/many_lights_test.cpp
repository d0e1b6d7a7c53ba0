// Of many lights with vectors, only those that matter at a point are asked for them there.

#include <numeric>
#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

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

TEST(ManyLightsWithVectors, KeepTheseWhereTheyMatter) {
  const Stage stage(corridor(60));
  const Picture vectors = picture(stage, withVectors("always"));
  ASSERT_TRUE(vectors.snapshot);
  const auto lights = static_cast<std::uint32_t>(stage.scene->lights.size());
  ASSERT_EQ(lights, 60U);
  std::vector<std::uint32_t> all(lights);
  std::iota(all.begin(), all.end(), 0U);
  LightShares shares;
  std::size_t records = 0;
  std::set<std::uint32_t> with;
  for (const std::uint32_t light : all) {
    const auto& set = vectors.snapshot->direct[light];
    for (std::size_t i = 0; i < set.size(); ++i) {
      shares.weigh(*stage.scene, set[i].point.position, set[i].point.normal, all);
      EXPECT_FALSE(shares.isFaint(light)) << "light " << light << ", vector " << i;
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
