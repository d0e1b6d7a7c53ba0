#include <algorithm>
#include <thread>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/base/tasks.h"

namespace lightvane {

class TaskPool::Backend {
 public:
  explicit Backend(int threads) : arena_(threads) {
    // oneTBB starts no more workers than there are cores unless it is told that it may, and of several who
    // tell it the one that asks for fewest is heard: one word for all pools, whose arenas take what they were
    // made for.
    static const tbb::global_control mayBeMany(tbb::global_control::max_allowed_parallelism, kMostThreads);
  }

  int threadCount() const { return arena_.max_concurrency(); }

  void forEach(std::size_t count, const std::function<void(std::size_t, int)>& body) {
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, count, 1),
          [&](const tbb::blocked_range<std::size_t>& range) {
            const FlushDenormals flush;
            for (std::size_t i = range.begin(); i != range.end(); ++i) {
              body(i, tbb::this_task_arena::current_thread_index());
            }
          },
          tbb::simple_partitioner{});
    });
  }

 private:
  tbb::task_arena arena_;
};

const bool kLibrariesMayUseThreads = true;

TaskPool::TaskPool(int threads)
    : backend_(std::make_unique<Backend>(
          threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency())))) {}
TaskPool::~TaskPool() = default;
int TaskPool::threadCount() const { return backend_->threadCount(); }
void TaskPool::forEach(std::size_t count, const std::function<void(std::size_t, int)>& body) {
  backend_->forEach(count, body);
}

}  // namespace lightvane
