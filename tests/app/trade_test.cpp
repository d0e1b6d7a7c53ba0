// What the window measures in the background of what parameters cost and bring.

#include "app/trade.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/sweep_files.h"
#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int kSide = 24;

class TradeTest : public testing::Test {
 protected:
  static TradeSubject subject(const char* scene = "cornell") {
    auto document = loadDocument(shippedScene(scene));
    EXPECT_TRUE(document) << document.error().message();
    TradeSubject subject;
    subject.document = std::make_shared<const Document>(*std::move(document));
    subject.camera = subject.document->scene->cameras.front();
    subject.camera.width = subject.camera.height = kSide;
    subject.parameters = subject.document->start;
    return subject;
  }
  static TradePlan plan(std::vector<std::string> values, int seeds = 1) {
    TradePlan plan;
    plan.varied = {{"ilv.n_min", std::move(values)}};
    plan.seeds = seeds;
    plan.referenceNoise = 0.5;
    return plan;
  }
  /// Until the condition holds; false after five minutes: the thread gives way to all others of the machine.
  template <class Condition>
  static bool waitUntil(const Condition& holds) {
    for (int i = 0; i < 30'000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  TradeStatus status() const { return trade_.status(std::nullopt); }
  TradeStatus finished() {
    EXPECT_TRUE(waitUntil([&] { return !status().isRunning; }));
    return status();
  }

  Program program_;
  TradeMeasurement trade_{{}};
};

// The window's thread and the command line measure the same pictures.
TEST_F(TradeTest, AgreesWithASweepToTheByte) {
  const std::string scene = shippedScene("cornell");
  ASSERT_EQ(
      program_.run({"reference", scene, "-o", "truth.exr", "--size", "24x24", "--spp", "256", "-q"}).exitCode,
      0);
  const Outcome swept =
      program_.run({"sweep", scene, "--vary", "ilv.n_min=2,6", "--seeds", "2", "--rivals", "none",
                    "--reference", "truth.exr", "--size", "24x24", "-o", "out", "-q"});
  ASSERT_EQ(swept.exitCode, 0) << swept.err;
  const auto log = RunLog::open(program_.path("out/runs.jsonl"));
  ASSERT_TRUE(log && log->runs().size() == 4U);

  TradePlan asked = plan({"2", "6"}, 2);
  asked.reference = program_.path("truth.exr");
  trade_.start(asked, subject());
  const TradeStatus done = finished();
  ASSERT_EQ(done.error, "");
  ASSERT_TRUE(done.sweep && done.sweep->points.size() == 2U);
  EXPECT_EQ(done.stage, "4 of 4 runs measured.");
  EXPECT_EQ(done.reference, "truth.exr");
  ASSERT_EQ(done.parameters.size(), 2U);
  EXPECT_EQ(done.parameters[1].vectors.ilv.nMin, 6);
  for (std::size_t p = 0; p < 2; ++p) {
    const SweepPoint& point = done.sweep->points[p];
    ASSERT_EQ(point.runs.size(), 2U);
    for (const SweepRun& run : point.runs) {
      const auto same = std::find_if(log->runs().begin(), log->runs().end(), [&](const KeptRun& kept) {
        return kept.settings == point.settings && kept.run.seed == run.seed;
      });
      ASSERT_NE(same, log->runs().end());
      EXPECT_EQ(run.ilvRecords, same->run.ilvRecords);
      EXPECT_EQ(run.rays.total(), same->run.rays.total());
      EXPECT_GT(run.metrics.size(), 10U);
      for (const auto& [metric, value] : run.metrics)
        EXPECT_EQ(value, same->run.metrics.at(metric)) << metric;
    }
    const std::string n = point.settings.front().second;
    ASSERT_EQ(
        program_.run({"render", scene, "--size", "24x24", "--set", "ilv.n_min=" + n, "-o", "p.exr", "-q"})
            .exitCode,
        0);
    const auto rendered = readImage(program_.path("p.exr"));
    ASSERT_TRUE(rendered && trade_.picture(p));
    EXPECT_TRUE(rendered->rgb() == *trade_.picture(p)) << "ilv.n_min=" << n;
  }
}

TEST_F(TradeTest, TracesItsOwnReferenceOnceAndKeepsIt) {
  TradeSubject of = subject();
  of.camera.width = of.camera.height = 2 * kSide;
  TradePlan asked = plan({"4"});
  asked.reduction = 2;
  trade_.start(asked, of);
  const TradeStatus first = finished();
  ASSERT_EQ(first.error, "");
  EXPECT_THAT(first.reference, HasSubstr("paths a pixel, noise"));
  ASSERT_TRUE(first.sweep);
  EXPECT_EQ(first.sweep->width, kSide);
  EXPECT_LE(*first.sweep->referenceNoise, 0.5);
  ASSERT_TRUE(trade_.picture(0));
  EXPECT_EQ(trade_.picture(0)->width(), kSide);
  EXPECT_EQ(trade_.reduction(), 2);

  trade_.clear();
  EXPECT_FALSE(status().sweep || status().isRunning);
  EXPECT_FALSE(trade_.picture(0));
  trade_.start(asked, of);
  EXPECT_EQ(finished().reference, first.reference);
}

TEST_F(TradeTest, MeasuresAgainstAReferenceAsItIs) {
  TradePlan asked = plan({"4"});
  asked.referenceNoise = 1e-6;  // nobody waits for that
  trade_.start(asked, subject());
  ASSERT_TRUE(waitUntil([&] { return status().isTracing; }));
  trade_.useReference();
  const TradeStatus done = finished();
  ASSERT_TRUE(done.sweep) << done.error;
  EXPECT_FALSE(done.isTracing);
  EXPECT_GT(*done.sweep->referenceNoise, 1e-6);
}

// Time is of the thread that measures, whatever the others of the process do.
TEST_F(TradeTest, TimesAreOfItsOwnThread) {
  std::atomic<bool> ends = false;
  std::thread other([&] {
    while (!ends) {
      // With rests, or the measurement, which gives way to everybody, would take long.
      const auto until = std::chrono::steady_clock::now() + 2ms;
      while (std::chrono::steady_clock::now() < until) {
      }
      std::this_thread::sleep_for(2ms);
    }
  });
  trade_.start(plan({"4"}, 2), subject());
  const TradeStatus done = finished();
  ends = true;
  other.join();
  ASSERT_TRUE(done.sweep) << done.error;
  for (const SweepRun& run : done.sweep->points.front().runs) {
    EXPECT_GT(run.cpuSeconds, 0.0);
    EXPECT_LE(run.cpuSeconds, 1.01 * run.wallSeconds + 0.001) << "one thread";
  }
}

TEST_F(TradeTest, WaitsForThePictureOfTheWindow) {
  trade_.setYields(true);
  trade_.start(plan({"2", "4"}), subject());
  ASSERT_TRUE(waitUntil([&] { return status().isWaiting; }));
  std::this_thread::sleep_for(100ms);
  EXPECT_TRUE(status().isRunning && status().isWaiting);
  EXPECT_FALSE(status().sweep);
  trade_.setYields(false);
  const TradeStatus done = finished();
  ASSERT_TRUE(done.sweep) << done.error;
  EXPECT_EQ(done.sweep->points.size(), 2U);
}

TEST_F(TradeTest, StopsSoonAndKeepsWhatItHas) {
  // Hours of it.
  trade_.start(plan({"1", "2", "3", "4", "5", "6", "7", "8"}, 10'000), subject());
  ASSERT_TRUE(waitUntil([&] { return status().sweep != nullptr; }));
  const auto begun = std::chrono::steady_clock::now();
  trade_.stop();
  EXPECT_FALSE(status().isRunning);
  const auto kept = status().sweep;
  ASSERT_TRUE(waitUntil([&] { return status().stage.starts_with("Stopped"); }));
  // Far more than it takes, and far less than what was left: machines are busy.
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 10s);
  EXPECT_EQ(status().sweep, kept) << "and no other";
  EXPECT_TRUE(trade_.picture(0));
}

TEST_F(TradeTest, StopsWhileItWaits) {
  trade_.setYields(true);
  trade_.start(plan({"2"}), subject());
  ASSERT_TRUE(waitUntil([&] { return status().isWaiting; }));
  trade_.stop();
  EXPECT_FALSE(status().isRunning);  // and the destructor ends it
}

TEST_F(TradeTest, SaysWhatThePointsAreNotOf) {
  const TradeSubject of = subject();
  trade_.start(plan({"2", "4"}), of);
  ASSERT_TRUE(finished().sweep);
  const auto stale = [&](const auto& change) {
    TradeSubject now = of;
    change(now);
    return trade_.status(now).stale;
  };
  EXPECT_EQ(stale([](TradeSubject&) {}), "");
  EXPECT_EQ(stale([](TradeSubject& s) { s.camera.exposureStops = 1.0f; }), "") << "only the screen's";
  EXPECT_EQ(stale([](TradeSubject& s) { s.parameters.vectors.ilv.nMin = 9; }), "") << "it is varied";
  EXPECT_EQ(stale([](TradeSubject& s) { s.parameters.picture.seed = 9; }), "");
  EXPECT_THAT(stale([](TradeSubject& s) { s.parameters.vectors.ilv.rows = 9; }),
              HasSubstr("other parameters"));
  EXPECT_THAT(stale([](TradeSubject& s) { s.camera.position.x += 0.1f; }), HasSubstr("another camera"));
  EXPECT_THAT(stale([](TradeSubject& s) { s.lights.direct = {Rgb(2.0f)}; }), HasSubstr("other lights"));
  EXPECT_THAT(stale([](TradeSubject& s) { s.document = subject("cornell-mirror").document; }),
              HasSubstr("another scene"));
}

TEST_F(TradeTest, SaysWhyThereIsNothingToMeasure) {
  TradePlan asked = plan({"2"});
  asked.reference = program_.path("none.exr");
  trade_.start(asked, subject());
  EXPECT_THAT(finished().error, HasSubstr("none.exr"));

  LayeredImage odd;
  odd.width = 7;
  odd.height = 24;
  odd.setRgb("", ImageRgb(7, 24));
  ASSERT_TRUE(writeImage(program_.path("odd.exr"), odd));
  asked.reference = program_.path("odd.exr");
  trade_.start(asked, subject());
  EXPECT_THAT(finished().error, HasSubstr("7 x 24"));
  EXPECT_FALSE(status().sweep);
}

}  // namespace
}  // namespace lightvane
