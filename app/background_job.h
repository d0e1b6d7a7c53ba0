#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "app/background_threads.h"
#include "core/base/tasks.h"

namespace lightvane {

/// A value that is computed while the window goes on. All methods on one thread; only wait() and the
/// destructor wait for another.
template <class Result>
class BackgroundJob {
 public:
  /// `done` is called on the job's own thread when the value is there.
  explicit BackgroundJob(std::function<void()> done) : done_(std::move(done)) {}
  ~BackgroundJob() { cancel(); }
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  bool isBusy() const { return shared_ != nullptr; }

  /// Gives up what is under way and begins this. `work` must not throw; it should end soon when its flag is
  /// set, and use only what it holds itself, because it may then go on beside the next.
  void start(std::function<Result(const StopFlag&)> work) {
    cancel();
    shared_ = std::make_shared<Shared>();
    threads_.run([shared = shared_, work = std::move(work), done = done_] {
      shared->result = work(shared->stop);
      shared->ready = true;
      if (done) done();
    });
  }
  /// What is under way is told to stop, and its value will not arrive.
  void cancel() {
    if (shared_) shared_->stop = true;
    shared_ = nullptr;
  }
  /// Until what is under way has ended, and all that was given up.
  void wait() { threads_.wait(); }
  /// The value, once, when it is there.
  std::optional<Result> take() {
    if (!shared_ || !shared_->ready) return std::nullopt;
    return std::move(std::exchange(shared_, nullptr)->result);
  }

 private:
  struct Shared {
    StopFlag stop{false};
    std::atomic<bool> ready = false;
    std::optional<Result> result;
  };

  std::function<void()> done_;
  std::shared_ptr<Shared> shared_;
  BackgroundThreads threads_;  // last: they use the others
};

}  // namespace lightvane
