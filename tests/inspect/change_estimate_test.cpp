// What a change costs, told before it is made, against what it costs when it is made.

#include "core/inspect/change_estimate.h"

#include <cstdlib>
#include <ctime>
#include <set>

#include <gtest/gtest.h>

#include "core/render/change.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

using namespace inspect_test;
using render_test::isFast;
using render_test::setParameters;

struct Cost {
  std::size_t indirect = 0;
  std::size_t direct = 0;
};

/// Makes the change, as the session does, and counts.
Cost costOf(const Stage& stage, const RenderFrame& frame, const Parameters& after) {
  const StillTrue still = stillTrue(*frame.scene, frame.parameters, after);
  CacheInput cache{stillTrueVectors(frame.snapshot, still, *frame.scene, after), false};
  if (cache.warm && cache.warm->indirect.empty() && cache.warm->directCount() == 0) cache.warm = nullptr;
  const RenderFrame changed = renderFrame(stage, after, -1, cache);
  const std::size_t before = cache.warm ? cache.warm->directCount() : 0;
  return {changed.statistics.fullIndirect, changed.snapshot->directCount() - before};
}

Parameters changedBy(const RenderFrame& frame, const Settings& change) {
  Parameters after = frame.parameters;
  setParameters(after, change);
  return after;
}

/// Within the factor, or so few that it does not matter: one point in a sample stands for some dozens.
void expectAbout(std::size_t estimated, std::size_t counted, double factor) {
  const double few = 0.002 * 128.0 * 128.0;
  const auto e = static_cast<double>(estimated);
  const auto c = static_cast<double>(counted);
  EXPECT_LE(e, factor * c + few) << "estimated " << estimated << ", computed " << counted;
  EXPECT_GE(e, c / factor - few) << "estimated " << estimated << ", computed " << counted;
}

struct Change {
  Settings settings;
  double factor = 2.0;
};

void checkChanges(const Stage& stage, const Settings& before, const std::vector<Change>& changes) {
  const RenderFrame frame = renderFrame(stage, parametersWith(before));
  for (const Change& change : changes) {
    const Parameters after = changedBy(frame, change.settings);
    const auto& [key, value] = change.settings.front();
    SCOPED_TRACE(fmt::format("{} = {}", key, value));
    const auto start = std::clock();
    const std::optional<ChangeEstimate> told = estimateChange(frame, after, {});
    const double milliseconds = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    ASSERT_TRUE(told);
    const ChangeEstimate estimate = told.value_or(ChangeEstimate{});
    const Cost cost = costOf(stage, frame, after);
    if (std::getenv("LIGHTVANE_PRINT_ESTIMATES") != nullptr) {
      fmt::print("{:>20} = {:<10} ILVs {:6} of {:6}, DLVs {:6} of {:6}, {:.1f} ms\n", key, value,
                 estimate.newIndirect, cost.indirect, estimate.newDirect, cost.direct, milliseconds);
    }
    expectAbout(estimate.newIndirect, cost.indirect, change.factor);
    expectAbout(estimate.newDirect, cost.direct, change.factor);
  }
}

int pictureSize() {
  const char* size = std::getenv("LIGHTVANE_PRINT_ESTIMATES");
  return size != nullptr ? std::max(std::atoi(size), 128) : 128;
}

// Thresholds that tighten and loosen, radii, presets and rules; and changes that make every vector stale.
TEST(ChangeEstimate, TellsHowManyIndirectVectorsWillBeComputed) {
  if (!isFast()) GTEST_SKIP() << "takes long";
  const std::vector<Change> changes = {{{{"ilv.n_min", "5"}}},
                                       {{{"ilv.n_min", "16"}}},
                                       {{{"ilv.radius_scale", "0.35"}}},
                                       {{{"ilv.radius_scale", "0.2"}}},
                                       {{{"ilv.radius_max", "20"}}},
                                       {{{"ilv.S_curv", "0.999"}}},
                                       {{{"ilv.gradient_test", "absolute"}}},
                                       {{{"ilv.n_min_last", "4"}}},
                                       {{{"ilv.rows", "8"}}},
                                       {{{"ilv.store", "vector"}}},
                                       {{{"preset", "draft"}}},
                                       {{{"method.rules", "paper"}}}};
  for (const char* scene : {"cornell-glossy.toml", "two-rooms.toml"}) {
    SCOPED_TRACE(scene);
    checkChanges(Stage(shippedScene(scene, pictureSize(), pictureSize())), {}, changes);
  }
}

TEST(ChangeEstimate, TellsHowManyDirectVectorsWillBeComputed) {
  if (!isFast()) GTEST_SKIP() << "takes long";
  const std::vector<Change> changes = {{{{"dlv.n_min", "8"}}},         {{{"dlv.n_min", "3"}}},
                                       {{{"dlv.r_max", "1%"}}},        {{{"dlv.r_max", "3%"}}},
                                       {{{"dlv.dispersion", "0.05"}}}, {{{"dlv.dispersion", "0.2"}}},
                                       {{{"dlv.store", "vector"}}},    {{{"seed", "2"}}},
                                       {{{"dlv.mode", "never"}}}};
  for (const char* scene : {"cornell.toml", "cornell-mirror.toml"}) {
    SCOPED_TRACE(scene);
    checkChanges(Stage(shippedScene(scene, pictureSize(), pictureSize())),
                 {{"dlv.mode", "always"}, {"dlv.seed", "1000"}}, changes);
  }
}

TEST(ChangeEstimate, NothingNewIsExactlyNothing) {
  const RenderFrame frame = renderShipped("cornell.toml", 96);
  const std::vector<Settings> changes = {
      {},
      {{"ilv.n_min", "1"}},
      {{"ilv.n_max", "8"}},
      {{"ilv.radius_scale", "0.6"}},
      {{"ilv.S_curv", "0.5"}},
      {{"ilv.extrapolate", "false"}},
      {{"path.samples", "3"}},
      {{"dlv.mode", "always"}, {"dlv.mode", "auto"}},
      {{"method.name", "path"}},
  };
  for (const Settings& change : changes) {
    SCOPED_TRACE(change.empty() ? "no change" : change.front().first);
    const auto estimate = estimateChange(frame, changedBy(frame, change), {});
    EXPECT_EQ(estimate, std::optional(ChangeEstimate{}));
  }
}

TEST(ChangeEstimate, SaysNothingWhereNobodyCanTell) {
  RenderFrame frame = renderShipped("cornell.toml", 32);
  EXPECT_FALSE(estimateChange(frame, changedBy(frame, {{"method.rules", "printed"}}), {}));
  const RenderFrame path = renderShipped("cornell.toml", 16, {{"method.name", "direct"}});
  EXPECT_FALSE(estimateChange(path, changedBy(path, {{"method.name", "vectors"}}), {}));
  frame.reduction = 2;
  EXPECT_FALSE(estimateChange(frame, frame.parameters, {}));
}

TEST(ChangeEstimate, OnceAskedItRemembers) {
  const auto frame = std::make_shared<const RenderFrame>(renderShipped("cornell.toml", 48));
  ChangeEstimator estimator(frame);
  for (int round = 0; round < 2; ++round) {
    for (int nMin = 1; nMin < 24; ++nMin) {
      const Parameters candidate = changedBy(*frame, {{"ilv.n_min", std::to_string(nMin)}});
      EXPECT_EQ(estimator.estimate(candidate, {}), estimateChange(*frame, candidate, {})) << nMin;
    }
  }
}

TEST(StaleVectors, AreThoseThatTheSessionWouldDrop) {
  const RenderFrame frame =
      renderShipped("cornell-mirror.toml", 32, {{"dlv.mode", "always"}, {"dlv.seed", "40"}});
  const std::size_t indirect = frame.snapshot->indirect.size();
  const std::size_t direct = frame.snapshot->directCount();
  ASSERT_GT(indirect, 0U);
  ASSERT_GT(direct, 0U);
  const auto stale = [&](const Settings& change) {
    const ChangeEstimate estimate =
        estimateChange(frame, changedBy(frame, change), {}).value_or(ChangeEstimate{});
    return std::pair(estimate.staleIndirect, estimate.staleDirect);
  };
  EXPECT_EQ(stale({{"ilv.n_min", "9"}}), std::pair(0UL, 0UL));
  EXPECT_EQ(stale({{"seed", "2"}}), std::pair(indirect, direct));
  EXPECT_EQ(stale({{"ilv.rows", "9"}}), std::pair(indirect, 0UL));
  EXPECT_EQ(stale({{"dlv.store", "vector"}}), std::pair(0UL, direct));
}

TEST(StaleVectors, AreIndirectOnesWhereTheirLightsChange) {
  const RenderFrame frame =
      renderShipped("cornell-mirror.toml", 32, {{"dlv.mode", "always"}, {"dlv.seed", "40"}});
  // Light that is seen is only weighed anew; what was gathered by other lights is stale.
  LightMix lights;
  lights.direct.assign(frame.scene->lights.size(), Rgb(0.5f));
  EXPECT_EQ(estimateChange(frame, frame.parameters, lights).value_or(ChangeEstimate{}).staleIndirect, 0U);
  lights.indirect = lights.direct;
  const std::size_t indirect = frame.snapshot->indirect.size();
  const ChangeEstimate estimate = estimateChange(frame, frame.parameters, lights).value_or(ChangeEstimate{});
  EXPECT_EQ(estimate.staleIndirect, indirect);
  EXPECT_EQ(estimate.staleDirect, 0U);
  EXPECT_GT(estimate.newIndirect, indirect / 2);
}

}  // namespace
}  // namespace lightvane
