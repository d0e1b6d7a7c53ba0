// Whatever the thresholds say, a rendering ends, every pixel is a finite, non-negative number, and no point
// is computed more than once.

#include <set>

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"

namespace lightvane::render_test {
namespace {

struct Extreme {
  const char* name;
  Settings settings;
};

void PrintTo(const Extreme& extreme, std::ostream* out) { *out << extreme.name; }

std::size_t visiblePoints(const Stage& stage, const Parameters& parameters) {
  const StopFlag never = false;
  VisiblePoints points;
  SeenSurfaces seen(stage.camera.width, stage.camera.height);
  RayCounts counts;
  traceVisiblePoints(*stage.tracer, stage.camera, stage.context(parameters).region, parameters, *stage.pool,
                     never, points, seen, counts);
  return points.pointCount();
}

class EveryPointEnds : public testing::TestWithParam<std::tuple<const char*, Extreme>> {};

TEST_P(EveryPointEnds, AndIsComputedOnceAtMost) {
  const auto& [scene, extreme] = GetParam();
  const Stage stage(shippedScene(scene, 24, 24));
  Parameters parameters = parametersWith({{"ilv.rows", "4"}, {"ilv.columns", "8"}, {"light.samples", "4"}});
  setParameters(parameters, extreme.settings);
  const Picture p = picture(stage, parameters);
  EXPECT_EQ(badPixel(p.film), "");
  EXPECT_EQ(p.statistics.faults.count, 0u);
  EXPECT_EQ(p.statistics.unanswered, 0u);
  const std::size_t points = visiblePoints(stage, parameters);
  constexpr std::size_t kKeysOfABrdf = 2;
  EXPECT_LE(p.statistics.ilvRecords, kKeysOfABrdf * points);
  EXPECT_LE(p.statistics.dlvRecords, stage.scene->lights.size() * points);
  // A record is one point's own: none is there twice.
  if (p.snapshot == nullptr) return;
  std::set<std::pair<std::uint32_t, std::uint32_t>> identities;
  for (std::size_t i = 0; i < p.snapshot->indirect.size(); ++i) {
    const RandomKey identity = p.snapshot->indirect[i].birth.identity;
    EXPECT_TRUE(identities.emplace(identity.high, identity.low).second) << "record " << i << " is a double";
  }
}

const Extreme kExtremes[] = {
    {"n_min_1000", {{"ilv.n_min", "1000"}}},
    {"n_min_last_1000", {{"ilv.n_min", "1000"}, {"ilv.n_min_last", "1000"}, {"passes.last_stride", "1"}}},
    {"n_min_beyond_n_max", {{"ilv.n_min", "9"}, {"ilv.n_max", "2"}, {"ilv.n_min_last", "5"}}},
    {"n_max_1", {{"ilv.n_max", "1"}, {"ilv.n_min", "1"}}},
    {"s_curv_1", {{"ilv.S_curv", "1"}}},
    {"s_curv_1_paper", {{"method.rules", "paper"}, {"ilv.S_curv", "1"}}},
    {"s_curv_0", {{"ilv.S_curv", "0"}}},
    {"radius_0", {{"ilv.radius_scale", "0"}, {"ilv.radius_min", "0"}}},
    {"radius_0_wide_thinning", {{"ilv.radius_scale", "0"}, {"ilv.radius_min", "0"}, {"passes.thin", "20"}}},
    {"radius_unbounded", {{"ilv.radius_scale", "100"}, {"ilv.radius_max", "0"}, {"ilv.radius_min_hit", "0"}}},
    {"s_e_0", {{"ilv.S_E", "0"}, {"ilv.gradient_test", "absolute"}}},
    {"s_e_0_paper", {{"method.rules", "paper"}, {"ilv.S_E", "0"}}},
    {"dlv_r_max_0", {{"dlv.mode", "always"}, {"dlv.r_max", "0%"}, {"dlv.seed", "100"}}},
    {"dlv_r_max_all", {{"dlv.mode", "always"}, {"dlv.r_max", "100%"}, {"dlv.seed", "100"}}},
    {"dlv_n_min_1000", {{"dlv.mode", "always"}, {"dlv.n_min", "1000"}, {"dlv.seed", "100"}}},
    {"dlv_n_min_beyond_n_max",
     {{"dlv.mode", "always"}, {"dlv.n_min", "9"}, {"dlv.n_max", "2"}, {"dlv.seed", "100"}}},
    {"dlv_dispersion_0", {{"dlv.mode", "always"}, {"dlv.dispersion", "0"}, {"dlv.seed", "100"}}},
    {"gather_of_one_ray", {{"ilv.rows", "1"}, {"ilv.columns", "1"}, {"ilv.seed", "50"}}},
    {"one_pass", {{"passes.first_stride", "1"}, {"passes.last_stride", "1"}}},
    {"strides_crossed", {{"passes.first_stride", "2"}, {"passes.last_stride", "8"}}},
    {"seeded_densely", {{"ilv.seed", "3000"}}},
    {"lobe_angle_least", {{"ilv.lobe_angle", "0.01"}}},
};

INSTANTIATE_TEST_SUITE_P(Extremes, EveryPointEnds,
                         testing::Combine(testing::Values("cornell-mirror.toml", "cornell-glossy.toml"),
                                          testing::ValuesIn(kExtremes)),
                         [](const testing::TestParamInfo<EveryPointEnds::ParamType>& named) {
                           const std::string scene = std::get<0>(named.param);
                           return scene.substr(8, scene.find('.') - 8) + "_" + std::get<1>(named.param).name;
                         });

// Nothing to gather from: no light at all, and nothing but background.
TEST(EveryRenderingEnds, InADarkScene) {
  SceneDescription dark = shippedScene("cornell.toml", 24, 24);
  for (MaterialDescription& material : dark.materials) material.emission = Rgb(0.0f);
  const Stage stage(dark);
  for (const char* method : {"vectors", "path", "naive", "direct"}) {
    const Picture p = picture(stage, parametersWith({{"method.name", method}, {"naive.samples", "8"}}));
    EXPECT_EQ(badPixel(p.film), "") << method;
    EXPECT_EQ(mean(beauty(p.film)), 0.0) << method;
    EXPECT_LE(p.statistics.ilvRecords, visiblePoints(stage, {})) << method;
  }
}

TEST(EveryRenderingEnds, InASceneThatTheCameraDoesNotSee) {
  SceneDescription away = shippedScene("cornell.toml", 24, 24);
  away.cameras.front().target = away.cameras.front().position - Vec3d(0.0, 0.0, 1.0);
  const Stage stage(away);
  for (const char* method : {"vectors", "path", "naive", "direct"}) {
    const Picture p = picture(stage, parametersWith({{"method.name", method}}));
    EXPECT_EQ(badPixel(p.film), "") << method;
    EXPECT_EQ(p.statistics.ilvRecords, 0u) << method;
  }
}

}  // namespace
}  // namespace lightvane::render_test
