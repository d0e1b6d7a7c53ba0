#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "core/base/tasks.h"

namespace lightvane {

/// A value that is computed while the window goes on. All methods on one thread.
template <class Result>
class BackgroundJob {
 public:
  /// `done` is called on the job's own thread when the value is there.
  explicit BackgroundJob(std::function<void()> done) : done_(std::move(done)) {}
  ~BackgroundJob() { cancel(); }
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;

  bool isBusy() const { return thread_.joinable(); }

  /// Stops what is under way and begins this. `work` must not throw, and end within milliseconds when its
  /// flag is set.
  void start(std::function<Result(const StopFlag&)> work) {
    cancel();
    shared_ = std::make_shared<Shared>();
    thread_ = std::thread([shared = shared_, work = std::move(work), done = done_] {
      const FlushDenormals flush;
      shared->result = work(shared->stop);
      shared->ready = true;
      if (done) done();
    });
  }
  /// Waits for the milliseconds that stopping takes.
  void cancel() {
    if (!thread_.joinable()) return;
    shared_->stop = true;
    thread_.join();
  }
  /// The value, once, when it is there.
  std::optional<Result> take() {
    if (!thread_.joinable() || !shared_->ready) return std::nullopt;
    thread_.join();
    return std::move(shared_->result);
  }

 private:
  struct Shared {
    StopFlag stop{false};
    std::atomic<bool> ready = false;
    std::optional<Result> result;
  };

  std::function<void()> done_;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace lightvane
