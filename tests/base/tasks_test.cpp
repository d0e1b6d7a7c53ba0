#include "core/base/tasks.h"

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace lightvane {
namespace {

class TaskPoolThreads : public testing::TestWithParam<int> {};

TEST_P(TaskPoolThreads, CallsEachIndexOnce) {
  TaskPool pool(GetParam());
  std::vector<std::atomic<int>> calls(1000);
  pool.forEach(calls.size(), [&](std::size_t i, int) { ++calls[i]; });
  for (const std::atomic<int>& count : calls) EXPECT_EQ(count, 1);
}

TEST_P(TaskPoolThreads, HasThatManyDistinctWorkers) {
  const int threads = GetParam();
  const TaskPool another(1);  // does not hold this one back
  TaskPool pool(threads);
  ASSERT_EQ(pool.threadCount(), threads);
  // Every body waits until all workers hold one: this ends only if there are as many as asked for.
  std::atomic<int> arrived = 0;
  std::mutex mutex;
  std::set<std::thread::id> threadIds;
  std::set<int> workers;
  pool.forEach(static_cast<std::size_t>(threads), [&](std::size_t, int worker) {
    {
      const std::lock_guard lock(mutex);
      threadIds.insert(std::this_thread::get_id());
      workers.insert(worker);
    }
    ++arrived;
    while (arrived < threads) std::this_thread::yield();
  });
  EXPECT_EQ(threadIds.size(), static_cast<std::size_t>(threads));
  EXPECT_EQ(workers.size(), static_cast<std::size_t>(threads));
  EXPECT_GE(*workers.begin(), 0);
  EXPECT_LT(*workers.rbegin(), threads);
}

TEST_P(TaskPoolThreads, ThrowsWhatABodyThrewAndWorksOn) {
  TaskPool pool(GetParam());
  EXPECT_THROW(pool.forEach(100,
                            [](std::size_t i, int) {
                              if (i == 37) throw std::runtime_error("37");
                            }),
               std::runtime_error);
  std::atomic<int> calls = 0;
  pool.forEach(10, [&](std::size_t, int) { ++calls; });
  EXPECT_EQ(calls, 10);
}

INSTANTIATE_TEST_SUITE_P(Counts, TaskPoolThreads, testing::Values(1, 2, 3, 8));

}  // namespace
}  // namespace lightvane
