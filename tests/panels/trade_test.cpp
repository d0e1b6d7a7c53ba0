// The Trade panel: a measurement is asked for, points come, one is clicked, its parameters are taken.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/history.h"
#include "app/panels/trade_panel.h"
#include "app/panels/trade_plot.h"
#include "tests/panels/panel_driver.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class TradePanelTest : public testing::Test {
 protected:
  TradePanelTest() {
    driver_.input.scene = richScene();
    driver_.workspace.setup.camera.width = 512;
    driver_.workspace.setup.camera.height = 400;
    driver_.action(ActionId::TabTrade);
    driver_.frames(2);
  }
  void giveMeasured() {
    driver_.input.trade = someTrade();
    driver_.state.trade.setupOpen = false;
    driver_.frames(2);
  }
  static std::string textOf(std::string_view name) {
    const auto place = Widgets::find(name);
    return place ? place->text : "";
  }

  PanelDriver driver_;
};

TEST_F(TradePanelTest, AsksForWhatWasTyped) {
  driver_.state.trade.varied = {"ilv.n_min=2,4,8", "", "ilv.rows=6:12:2"};
  driver_.state.trade.seeds = 2.0f;
  driver_.click("trade.start");
  ASSERT_TRUE(driver_.asked.measureTrade);
  const TradePlan& plan = *driver_.asked.measureTrade;
  ASSERT_EQ(plan.varied.size(), 2U);
  EXPECT_EQ(plan.varied[0].key, "ilv.n_min");
  EXPECT_THAT(plan.varied[1].values, ElementsAre("6", "12"));
  EXPECT_EQ(plan.seeds, 2);
  EXPECT_EQ(plan.reduction, 4);
  EXPECT_TRUE(plan.reference.empty());
  EXPECT_FLOAT_EQ(static_cast<float>(plan.referenceNoise), kTradeNoise);
  EXPECT_FALSE(driver_.state.trade.setupOpen) << "the plot takes its place";
}

TEST_F(TradePanelTest, SaysWhatIsWrongBeforeItAsks) {
  const auto refused = [&](const std::string& text, const std::string& expected) {
    driver_.state.trade.varied = {text, "", ""};
    driver_.click("trade.start");
    EXPECT_FALSE(driver_.asked.measureTrade) << text;
    EXPECT_THAT(textOf("trade.error"), HasSubstr(expected));
  };
  refused("ilv.n_min", "expected KEY=A,B,C");
  refused("ilv.n_mn=1,2", "ilv.n_min");
  refused("ilv.n_min=1,x", "a whole number");
  refused("ilv.radius_scale=0.1:1:500", "more than 400");
  driver_.state.trade.varied = {"ilv.n_min=1,2", "", ""};
  driver_.state.trade.fromFile = true;
  driver_.frames();
  driver_.click("trade.start");
  EXPECT_THAT(textOf("trade.error"), HasSubstr("type its path"));
}

TEST_F(TradePanelTest, TheUsualPlanCanBeMeasured) {
  const auto plan = tradePlan(TradePanelState{}, Parameters{});
  ASSERT_TRUE(plan) << plan.error().message();
  EXPECT_EQ(sweepGrid(plan->varied).size(), 12U);
  EXPECT_EQ(plan->seeds, 3);
}

TEST_F(TradePanelTest, StopAndClearAreAskedForWhereThereIsSomething) {
  driver_.click("trade.stop");
  driver_.click("trade.clear");
  EXPECT_FALSE(driver_.asked.stopTrade || driver_.asked.clearTrade);
  driver_.input.trade = someTrade();
  driver_.input.trade.isRunning = true;
  driver_.input.trade.secondsLeft = 12.0;
  driver_.frames(2);
  EXPECT_THAT(textOf("trade.stage"), HasSubstr("About 12.0 s left"));
  driver_.click("trade.start");
  EXPECT_FALSE(driver_.asked.measureTrade) << "one at a time";
  driver_.click("trade.stop");
  EXPECT_TRUE(driver_.asked.stopTrade);
  driver_.click("trade.clear");
  EXPECT_TRUE(driver_.asked.clearTrade);
  driver_.input.trade.isTracing = true;
  driver_.frames(2);
  driver_.click("trade.use_reference");
  EXPECT_TRUE(driver_.asked.useTradeReference);
  driver_.input.trade.isWaiting = true;
  driver_.frames(2);
  EXPECT_THAT(textOf("trade.stage"), HasSubstr("Waits until the picture rests"));
}

TEST_F(TradePanelTest, AClickShowsAPointAndItsParametersAreTaken) {
  giveMeasured();
  driver_.click("trade.point.2");
  EXPECT_EQ(driver_.state.trade.selected, 2U);
  EXPECT_EQ(driver_.asked.showTradePoint, 2U);
  EXPECT_EQ(driver_.workspace.setup.parameters, Parameters{}) << "a look changes nothing";

  const lightvane::Setup before = driver_.workspace.setup;
  driver_.click("trade.take");
  EXPECT_EQ(driver_.workspace.setup.parameters, driver_.input.trade.parameters[2]);
  EXPECT_EQ(driver_.workspace.setup.parameters.vectors.ilv.nMin, 3);
  EXPECT_EQ(describeChange(before, driver_.workspace.setup), "ilv.n_min 4 -> 3");
}

TEST_F(TradePanelTest, APointBehindOthersTellsItself) {
  giveMeasured();
  driver_.hover("trade.point.3");
  EXPECT_THAT(textOf("tooltip"), HasSubstr("3.00 ± 0.13 s"));
  EXPECT_THAT(textOf("tooltip"), HasSubstr("0.900 ± 0.038 %"));
  driver_.hover("trade.plot");
  EXPECT_THAT(textOf("tooltip"), HasSubstr("one thread"));
}

TEST_F(TradePanelTest, ALimitPicksAPointAndSaysHowSureItIs) {
  giveMeasured();
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("0.800 ± 0.034 %"));
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("2 of 2 seeds are within 1 %"));
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("it may be beyond")) << "two seeds make a wide interval";
  driver_.click("trade.select");
  EXPECT_EQ(driver_.state.trade.selected, 2U);

  driver_.state.trade.mostError["beauty.relative"] = 0.1f;
  driver_.frames(2);
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("No point that was measured has an error of at most 0.1 %"));
  driver_.state.trade.limitsTime = true;
  driver_.state.trade.mostSeconds = 1.5f;
  driver_.frames(2);
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("2.00 ± 0.08 %"));
  EXPECT_THAT(textOf("trade.pick"), HasSubstr("within 1.5 s"));
}

TEST_F(TradePanelTest, OnlyErrorsAreOffered) {
  giveMeasured();
  ASSERT_EQ(driver_.state.trade.metrics.size(), 4U);
  for (const ReportMetric& metric : driver_.state.trade.metrics)
    EXPECT_THAT(metric.key, Not(HasSubstr("ssim")));
}

TEST_F(TradePanelTest, PointsOfSomethingElseAreSaidToBe) {
  giveMeasured();
  EXPECT_FALSE(Widgets::find("trade.stale"));
  driver_.input.trade.stale = "These points are of another camera.";
  driver_.frames(2);
  EXPECT_EQ(textOf("trade.stale"), "These points are of another camera.");
}

TEST_F(TradePanelTest, ThePlotHasFasterPointsAtItsLeftAndExactOnesBelow) {
  giveMeasured();
  const auto plot = Widgets::find("trade.plot");
  ASSERT_TRUE(plot);
  for (int i = 0; i < 4; ++i) {
    const auto point = Widgets::find("trade.point." + std::to_string(i));
    ASSERT_TRUE(point);
    EXPECT_GT(point->min.x, plot->min.x);
    EXPECT_LT(point->max.x, plot->max.x);
    EXPECT_GT(point->min.y, plot->min.y);
    EXPECT_LT(point->max.y, plot->max.y);
  }
  const auto x = [](int i) { return Widgets::find("trade.point." + std::to_string(i))->centre().x; };
  const auto y = [](int i) { return Widgets::find("trade.point." + std::to_string(i))->centre().y; };
  EXPECT_NEAR(x(1) - x(0), x(2) - x(1), 0.5) << "a factor of two is a distance";
  EXPECT_LT(x(2), x(3));
  EXPECT_LT(y(0), y(1));
  EXPECT_LT(y(1), y(3));
  EXPECT_LT(y(3), y(2));
}

// The texts of one seed, and the words for one.
TEST(TradeTexts, SayWhatIsNotKnown) {
  SweepPick pick;
  pick.error = {0.0123, 0.0, 0.0123, 0.0123};
  pick.cpu = {1.5, 0.0, 1.5, 1.5};
  pick.runs = pick.within = 1;
  const ReportMetric metric{"beauty.relative", "beauty", findMetric("relative")};
  const std::string text = tradePickText(pick, metric, false, "2 %", std::nullopt);
  EXPECT_THAT(text, HasSubstr("1.23 %\nCPU time 1.50 s\n"));
  EXPECT_THAT(text, HasSubstr("nobody knows how sure"));
  pick.runs = 3;
  pick.errorHalfWidth = 0.002;
  pick.isSure = true;
  const std::string sure = tradePickText(pick, metric, false, "2 %", 0.01);
  EXPECT_THAT(sure,
              HasSubstr("1 of 3 seeds is within 2 %.\nThe mean is 1.23 ± 0.20 % with a certainty of 95 %: "
                        "within."));
  EXPECT_THAT(sure, Not(HasSubstr("reference"))) << "its noise is smaller";
  EXPECT_THAT(tradePickText(pick, metric, false, "2 %", 0.391), HasSubstr("whose noise of 39.1 % may shift"));
  EXPECT_THAT(tradePickText(pick, metric, true, "2 s", 0.391), Not(HasSubstr("reference")));
}

}  // namespace
}  // namespace lightvane
