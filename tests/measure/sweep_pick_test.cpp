// Which point of a sweep keeps within a limit, and how sure that is.

#include "core/measure/sweep_pick.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/sweep_run.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

constexpr const char* kMetric = "beauty.relative";

SweepPoint measuredPoint(const std::vector<std::pair<double, double>>& runs) {
  SweepPoint point;
  for (const auto& [seconds, error] : runs) {
    SweepRun run;
    run.cpuSeconds = seconds;
    run.metrics[kMetric] = error;
    point.runs.push_back(run);
  }
  return point;
}

Sweep pickedSweep(std::vector<SweepPoint> points) {
  Sweep sweep;
  sweep.points = std::move(points);
  return sweep;
}

// Fast and coarse, slow and exact, one between them, and one that is beaten in both.
Sweep fourPoints() {
  return pickedSweep({measuredPoint({{1.0, 0.04}, {1.0, 0.04}}), measuredPoint({{4.0, 0.005}, {4.0, 0.005}}),
                      measuredPoint({{2.0, 0.009}, {2.2, 0.011}}),
                      measuredPoint({{3.0, 0.009}, {5.0, 0.0105}})});
}

TEST(SweepPick, IsTheFastestWithinAnError) {
  const Sweep sweep = fourPoints();
  const auto pick = fastestWithin(sweep, kMetric, 0.01);
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->point, 2U) << "its mean is 0.01: at most is not less than";
  EXPECT_EQ(pick->runs, 2);
  EXPECT_EQ(pick->within, 1) << "of 0.009 and 0.011";
  EXPECT_FALSE(pick->isSure);
  EXPECT_EQ(fastestWithin(sweep, kMetric, 0.5)->point, 0U);
  EXPECT_EQ(fastestWithin(sweep, kMetric, 0.006)->point, 1U);
  EXPECT_TRUE(fastestWithin(sweep, kMetric, 0.006)->isSure) << "its seeds agree";
  EXPECT_FALSE(fastestWithin(sweep, kMetric, 0.001));
}

TEST(SweepPick, IsTheMostExactWithinATime) {
  const Sweep sweep = fourPoints();
  EXPECT_FALSE(bestWithin(sweep, kMetric, 0.9));
  EXPECT_EQ(bestWithin(sweep, kMetric, 1.0)->point, 0U);
  const auto pick = bestWithin(sweep, kMetric, 3.9);
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->point, 2U);
  EXPECT_EQ(pick->within, 2);
  EXPECT_TRUE(pick->isSure) << "2.1 s, and 1.27 s more or less: " << *pick->cpuHalfWidth;
  EXPECT_EQ(bestWithin(sweep, kMetric, 100.0)->point, 1U);
}

// Student's t for 1 and 4 degrees of freedom, from tables: 12.706 and 2.776.
TEST(SweepPick, KnowsHowSureAMeanIs) {
  const Spread spread{10.0, 3.0, 0.0, 0.0};
  EXPECT_NEAR(*meanHalfWidth(spread, 2), 12.706 * 3.0 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(*meanHalfWidth(spread, 5), 2.776 * 3.0 / std::sqrt(5.0), 1e-9);
  EXPECT_NEAR(*meanHalfWidth(spread, 10'000), 1.96 * 3.0 / 100.0, 1e-9);
  EXPECT_FALSE(meanHalfWidth(spread, 1)) << "one value tells nothing of others";
  EXPECT_FALSE(meanHalfWidth({std::numeric_limits<double>::infinity(), 0.0, 0.0, 0.0}, 3));
}

TEST(SweepPick, OfOneSeedIsNeverSure) {
  const auto pick = fastestWithin(pickedSweep({measuredPoint({{1.0, 0.001}})}), kMetric, 0.01);
  ASSERT_TRUE(pick);
  EXPECT_EQ(pick->within, 1);
  EXPECT_FALSE(pick->isSure);
  EXPECT_FALSE(pick->errorHalfWidth);
}

TEST(SweepPick, IsOfNoPointWithoutTheMetric) {
  EXPECT_FALSE(fastestWithin(Sweep{}, kMetric, 1.0));
  EXPECT_FALSE(fastestWithin(fourPoints(), "beauty.flip", 1.0));
  EXPECT_FALSE(fastestWithin(pickedSweep({measuredPoint({{1.0, std::numeric_limits<double>::quiet_NaN()}})}),
                             kMetric, 1.0));
}

TEST(SweepRuns, SettingsMakeParametersOfOthers) {
  Parameters base;
  base.vectors.ilv.nMin = 7;
  const auto changed = withSettings(base, {{"ilv.rows", "5"}, {"preset", "fine"}, {"method.rules", "paper"}});
  ASSERT_TRUE(changed) << changed.error().message();
  EXPECT_EQ(changed->vectors.rules, Rules::Paper);
  EXPECT_EQ(changed->vectors.ilv.rows, 5) << "rules and presets act first";
  EXPECT_EQ(*withSettings(base, {}), base);

  for (const SweepSettings& wrong :
       {SweepSettings{{"ilv.rws", "5"}}, SweepSettings{{"ilv.rows", "x"}}, SweepSettings{{"preset", "fin"}},
        SweepSettings{{"method.rules", "b"}}}) {
    const auto refused = withSettings(base, wrong);
    ASSERT_FALSE(refused) << wrong.front().first;
    EXPECT_THAT(refused.error().message(), HasSubstr(wrong.front().first + "=" + wrong.front().second));
    EXPECT_FALSE(withEachSettings(base, {{}, wrong}));
  }
}

}  // namespace
}  // namespace lightvane
