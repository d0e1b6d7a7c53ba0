#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace lightvane {

/// Threads that end by themselves, so that nobody has to wait for them before the program ends. All methods
/// on one thread.
class BackgroundThreads {
 public:
  BackgroundThreads() = default;
  ~BackgroundThreads() { wait(); }
  BackgroundThreads(const BackgroundThreads&) = delete;
  BackgroundThreads& operator=(const BackgroundThreads&) = delete;

  /// `work` must not throw; what it holds is let go on its thread.
  void run(std::function<void()> work) {
    forgetEnded();
    auto ended = std::make_shared<std::atomic<bool>>(false);
    running_.push_back({std::thread([ended, work = std::move(work)]() mutable {
                          work();
                          work = nullptr;
                          *ended = true;
                        }),
                        ended});
  }
  /// Until all have ended.
  void wait() {
    for (Running& each : running_) each.thread.join();
    running_.clear();
  }

 private:
  struct Running {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> ended;
  };

  void forgetEnded() {
    std::erase_if(running_, [](Running& each) {
      if (!*each.ended) return false;
      each.thread.join();
      return true;
    });
  }

  std::vector<Running> running_;
};

}  // namespace lightvane
