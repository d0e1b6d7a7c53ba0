#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/tasks.h"

namespace lightvane {

/// Plain threads: for the thread sanitizer, which cannot see through oneTBB's own synchronisation.
class TaskPool::Backend {
 public:
  explicit Backend(int threads) : threads_(threads) {
    for (int worker = 1; worker < threads; ++worker) {
      helpers_.emplace_back([this, worker] { serve(worker); });
    }
  }

  ~Backend() {
    {
      const std::lock_guard lock(mutex_);
      closing_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  int threadCount() const { return threads_; }

  void forEach(std::size_t count, const std::function<void(std::size_t, int)>& body) {
    {
      const std::lock_guard lock(mutex_);
      body_ = &body;
      count_ = count;
      next_ = 0;
      busy_ = threads_ - 1;
      failure_ = nullptr;
      ++loop_;
    }
    wake_.notify_all();
    takeIndices(0);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
    body_ = nullptr;
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void serve(int worker) {
    std::size_t seen = 0;
    for (;;) {
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [&] { return closing_ || loop_ != seen; });
        if (closing_) return;
        seen = loop_;
      }
      takeIndices(worker);
      const std::lock_guard lock(mutex_);
      if (--busy_ == 0) done_.notify_one();
    }
  }

  void takeIndices(int worker) {
    const FlushDenormals flush;
    for (;;) {
      std::size_t index = 0;
      {
        const std::lock_guard lock(mutex_);
        if (next_ >= count_) return;
        index = next_++;
      }
      try {
        (*body_)(index, worker);
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        next_ = count_;
      }
    }
  }

  int threads_;
  std::vector<std::thread> helpers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(std::size_t, int)>* body_ = nullptr;
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  std::size_t loop_ = 0;
  int busy_ = 0;
  bool closing_ = false;
  std::exception_ptr failure_;
};

const bool kLibrariesMayUseThreads = false;

TaskPool::TaskPool(int threads)
    : backend_(std::make_unique<Backend>(
          threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency())))) {}
TaskPool::~TaskPool() = default;
int TaskPool::threadCount() const { return backend_->threadCount(); }
void TaskPool::forEach(std::size_t count, const std::function<void(std::size_t, int)>& body) {
  backend_->forEach(count, body);
}

}  // namespace lightvane
