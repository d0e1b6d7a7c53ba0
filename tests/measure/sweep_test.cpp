#include "core/measure/sweep.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

std::vector<std::string> valuesOf(const std::string& text) {
  const auto varied = parseVaried(text, "--vary");
  EXPECT_TRUE(varied) << varied.error().message();
  return varied ? varied->values : std::vector<std::string>{};
}

TEST(SweepVaried, AreListsOrRanges) {
  const auto varied = parseVaried("ilv.n_min=2,4,8", "--vary");
  ASSERT_TRUE(varied);
  EXPECT_EQ(varied->key, "ilv.n_min");
  EXPECT_THAT(varied->values, ElementsAre("2", "4", "8"));
  EXPECT_THAT(valuesOf("dlv.mode=auto,always"), ElementsAre("auto", "always"));
  EXPECT_THAT(valuesOf("a=1.5%"), ElementsAre("1.5%"));
  EXPECT_THAT(valuesOf("a=0.1:10:3"), ElementsAre("0.1", "1", "10")) << "equal ratios";
  EXPECT_THAT(valuesOf("a=0:1:3"), ElementsAre("0", "0.5", "1")) << "equal distances where one is 0";
  EXPECT_THAT(valuesOf("a=-1:1:2"), ElementsAre("-1", "1"));
  EXPECT_THAT(valuesOf("a=4:64:5"), ElementsAre("4", "8", "16", "32", "64"));
  EXPECT_THAT(valuesOf("a=1:12:40"), testing::AllOf(testing::SizeIs(12), testing::Contains("7")))
      << "whole numbers stay whole, and none comes twice";
  EXPECT_THAT(valuesOf("a=1:12:12"), testing::SizeIs(12));
}

TEST(SweepVaried, SayWhatIsWrong) {
  for (const char* text : {"", "a", "=1", "a=", "a=1,,2", "a=1:2", "a=1:2:1", "a=2:1:3", "a=1:2:x",
                           "a=1:inf:3", "a=1:2:3:4", "a=1:2:100000"}) {
    const auto varied = parseVaried(text, "--vary");
    ASSERT_FALSE(varied) << text;
    EXPECT_EQ(varied.error().where, "--vary");
  }
}

const std::vector<VariedParameter> kTwo = {{"a", {"1", "2", "3"}}, {"b", {"x", "y"}}};

TEST(SweepPoints, OfAGridAreAllCombinations) {
  const std::vector<SweepSettings> grid = sweepGrid(kTwo);
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_THAT(grid[0], ElementsAre(Pair("a", "1"), Pair("b", "x")));
  EXPECT_THAT(grid[5], ElementsAre(Pair("a", "3"), Pair("b", "y")));
  EXPECT_THAT(sweepGrid({}), ElementsAre(SweepSettings{}));
}

TEST(SweepPoints, AroundTheDefaultsDifferInOne) {
  const std::vector<SweepSettings> around = sweepAround(kTwo);
  ASSERT_EQ(around.size(), 6U);
  EXPECT_THAT(around[0], IsEmpty());
  EXPECT_THAT(around[1], ElementsAre(Pair("a", "1")));
  EXPECT_THAT(around[5], ElementsAre(Pair("b", "y")));
}

TEST(SweepPoints, AtRandomAreOfTheGridAndNoneTwice) {
  const std::vector<SweepSettings> grid = sweepGrid(kTwo);
  const std::vector<SweepSettings> some = sweepRandom(kTwo, 4, 7);
  EXPECT_EQ(some.size(), 4U);
  for (const SweepSettings& point : some) {
    EXPECT_THAT(grid, testing::Contains(point));
    EXPECT_EQ(std::count(some.begin(), some.end(), point), 1);
  }
  EXPECT_EQ(some, sweepRandom(kTwo, 4, 7));
  EXPECT_NE(some, sweepRandom(kTwo, 4, 8));
  EXPECT_EQ(sweepRandom(kTwo, 100, 7).size(), 6U) << "there are no more";
}

SweepPoint pointOf(std::vector<double> cpu, std::vector<double> errors) {
  SweepPoint point;
  point.method = "vectors";
  for (std::size_t i = 0; i < cpu.size(); ++i) {
    SweepRun& run = point.runs.emplace_back();
    run.cpuSeconds = cpu[i];
    run.metrics["beauty.relative"] = errors[i];
  }
  return point;
}

TEST(SweepPoints, HaveASpread) {
  const SweepPoint point = pointOf({1.0, 2.0, 6.0}, {0.1, 0.2, 0.3});
  const Spread cpu = cpuSpread(point);
  EXPECT_DOUBLE_EQ(cpu.mean, 3.0);
  EXPECT_DOUBLE_EQ(cpu.standardDeviation, std::sqrt((4.0 + 1.0 + 9.0) / 2.0));
  EXPECT_EQ(cpu.least, 1.0);
  EXPECT_EQ(cpu.most, 6.0);
  EXPECT_NEAR(metricSpread(point, "beauty.relative")->mean, 0.2, 1e-12);
  EXPECT_FALSE(metricSpread(point, "beauty.psnr"));
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(metricSpread(pointOf({1.0, 2.0}, {kInfinite, 1.0}), "beauty.relative")->mean, kInfinite);
  EXPECT_FALSE(metricSpread(pointOf({1.0}, {std::nan("")}), "beauty.relative"));
  EXPECT_EQ(cpuSpread(pointOf({2.0}, {0.1})).standardDeviation, 0.0);
}

TEST(SweepPoints, HaveNames) {
  SweepPoint point;
  point.method = "path";
  EXPECT_EQ(point.name(), "path");
  point.settings = {{"path.samples", "16"}, {"seed", "2"}};
  EXPECT_EQ(point.name(), "path.samples=16 seed=2");
}

TEST(SweepFront, IsWhatNoOtherBeatsInBoth) {
  Sweep sweep;
  for (const auto& [cpu, error] :
       {std::pair{4.0, 0.1}, {1.0, 0.4}, {2.0, 0.5}, {2.0, 0.2}, {3.0, 0.2}, {9.0, 0.1}})
    sweep.points.push_back(pointOf({cpu}, {error}));
  sweep.points.push_back(pointOf({0.1}, {std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_THAT(paretoFront(sweep, "beauty.relative"), ElementsAre(1U, 3U, 0U));
  EXPECT_THAT(paretoFront(sweep, "beauty.flip"), IsEmpty());
}

}  // namespace
}  // namespace lightvane
