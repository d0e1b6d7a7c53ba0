#include "app/background_job.h"

#include <chrono>
#include <latch>
#include <thread>

#include <gtest/gtest.h>

namespace lightvane {
namespace {

using namespace std::chrono_literals;

template <class Result>
std::optional<Result> takeSoon(BackgroundJob<Result>& job) {
  for (int i = 0; i < 10'000; ++i) {
    if (auto value = job.take()) return value;
    std::this_thread::sleep_for(1ms);
  }
  return std::nullopt;
}

TEST(BackgroundJob, GivesItsValueOnce) {
  std::atomic<int> calls = 0;
  BackgroundJob<int> job([&] { ++calls; });
  EXPECT_FALSE(job.isBusy());
  EXPECT_FALSE(job.take());
  job.start([](const StopFlag&) { return 7; });
  EXPECT_TRUE(job.isBusy());
  EXPECT_EQ(takeSoon(job), 7);
  EXPECT_FALSE(job.isBusy());
  EXPECT_FALSE(job.take());
  job.wait();
  EXPECT_EQ(calls, 1);
}

// The thread of the window asks for another file while a slow disk reads this one.
TEST(BackgroundJob, NobodyWaitsForWhatIsGivenUp) {
  std::latch gate(1);
  std::atomic<bool> hasStopped = false;
  {
    BackgroundJob<int> job({});
    job.start([&](const StopFlag& stop) {
      gate.wait();
      hasStopped = stop.load();
      return 1;
    });
    job.start([](const StopFlag&) { return 2; });
    EXPECT_EQ(takeSoon(job), 2) << "while the first is still at its gate";
    job.start([&](const StopFlag&) {
      gate.wait();
      return 3;
    });
    job.cancel();
    EXPECT_FALSE(job.isBusy());
    EXPECT_FALSE(hasStopped);
    gate.count_down();
  }
  EXPECT_TRUE(hasStopped) << "the destructor waits, and the job was told to stop";
}

TEST(BackgroundThreads, LetGoOfWhatTheyHoldWhenTheyEnd) {
  const auto held = std::make_shared<int>(0);
  BackgroundThreads threads;
  for (int i = 0; i < 20; ++i) threads.run([held] { std::this_thread::sleep_for(1ms); });
  threads.wait();
  EXPECT_EQ(held.use_count(), 1);
}

}  // namespace
}  // namespace lightvane
