#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "core/render/renderer.h"

namespace lightvane {

/// Makes Ctrl+C (SIGINT), SIGTERM and SIGHUP set the flag that it returns; the second of them ends the
/// process at once with exit code 130. For the whole process, once. A SIGHUP that is ignored (nohup) stays
/// so.
const StopFlag& stopOnSignals();

/// Whether one of these signals came.
bool stopSignalled();

/// Sets the flag of stopOnSignals when the time has come, unless it is destroyed before.
class TimeLimit {
 public:
  explicit TimeLimit(std::chrono::steady_clock::time_point end);

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread waiting_;  // last: it uses the others
};

/// Begins the limit where so many seconds are allowed from `start` on.
void limitTime(std::optional<TimeLimit>& limit, std::chrono::steady_clock::time_point start,
               std::optional<double> seconds);

}  // namespace lightvane
