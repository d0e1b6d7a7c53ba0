#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace lightvane {

/// Rounds denormal numbers to zero on this thread while it lives, as every worker of a TaskPool does: Embree
/// asks for it, and results must not depend on which thread computed them.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned int saved_;
};

/// Whether libraries may take threads of their own from oneTBB. Not in the build for the thread sanitizer,
/// which cannot see what orders the accesses of a library that was not built with it.
extern const bool kLibrariesMayUseThreads;

/// Set by whoever wants the work to end; looked at between pieces of work of a few milliseconds at most.
using StopFlag = std::atomic<bool>;

/// More threads than any machine has; guards against a slip of the hand that would start them all.
inline constexpr int kMostThreads = 1024;

/// A fixed number of threads that share loops: the only thing the program knows of its thread library.
class TaskPool {
 public:
  /// `threads` workers, the caller of forEach among them; 0 means as many as the machine has cores,
  /// and kMostThreads is the most.
  explicit TaskPool(int threads = 0);
  ~TaskPool();
  TaskPool(const TaskPool&) = delete;
  TaskPool& operator=(const TaskPool&) = delete;

  int threadCount() const;

  /// Calls body(index, worker) once for every index in [0, count), in any order, and returns when all have
  /// ended. `worker` is in [0, threadCount) and no two calls with the same worker run at once. What a body
  /// throws is thrown here, once, after the others have ended. Not to be called from within a body.
  void forEach(std::size_t count, const std::function<void(std::size_t index, int worker)>& body);

 private:
  class Backend;
  std::unique_ptr<Backend> backend_;
};

}  // namespace lightvane
