#include "app/stop.h"

#include <csignal>

#include <unistd.h>

#include "app/messages.h"

namespace lightvane {
namespace {

// What a signal handler may touch: lock-free atomics with static storage (C++20, [support.signal]).
static_assert(StopFlag::is_always_lock_free);
StopFlag stopAsked = false;
StopFlag signalled = false;

extern "C" void handleStopSignal(int) {
  if (signalled.exchange(true)) _exit(static_cast<int>(ExitCode::Stopped));
  stopAsked = true;
}

}  // namespace

const StopFlag& stopOnSignals() {
  struct sigaction action {};
  action.sa_handler = handleStopSignal;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal != SIGHUP || before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  return stopAsked;
}

bool stopSignalled() { return signalled; }

TimeLimit::TimeLimit(std::chrono::steady_clock::time_point end)
    : waiting_([this, end](const std::stop_token& cancelled) {
        std::unique_lock lock(mutex_);
        wake_.wait_until(lock, cancelled, end, [] { return false; });
        if (!cancelled.stop_requested()) stopAsked = true;
      }) {}

void limitTime(std::optional<TimeLimit>& limit, std::chrono::steady_clock::time_point start,
               std::optional<double> seconds) {
  if (!seconds) return;
  const std::chrono::duration<double> allowed(*seconds);
  limit.emplace(start + std::chrono::duration_cast<std::chrono::steady_clock::duration>(allowed));
}

}  // namespace lightvane
