#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/base/load_watch.h"
#include "core/render/renderer.h"

namespace lightvane {

/// All that a line about a rendering says.
struct ProgressState {
  RenderProgress progress;  ///< after the last whole pass
  int passes = 0;
  std::uint64_t records = 0;
  double raysPerSecond = 0.0;   ///< of the passes of this run
  double fractionBefore = 0.0;  ///< `progress.fraction` with which this run began
};

/// "pass 4, stride 4: 42 %, 2.31 k vectors, 93 % interpolated, 4.20 M rays/s, 12.3 s, about 15.0 s left";
/// what is not known yet is left out.
std::string progressLine(const ProgressState& state, double elapsedSeconds);

/// How a line that tells of work under way is shown on stderr: on a terminal it is written over and over.
enum class ProgressStyle { Silent, Lines, Terminal };
/// Terminal where stderr is one.
ProgressStyle progressStyle(bool quiet);

/// Shows on stderr how far a loading is, as ProgressDisplay does for a rendering; nothing of one that takes
/// less than half a second, or elsewhere than on a terminal some seconds.
class LoadDisplay {
 public:
  /// `progress` must outlive it.
  LoadDisplay(ProgressStyle style, const LoadProgress& progress);
  /// Removes the terminal's line.
  ~LoadDisplay();
  LoadDisplay(const LoadDisplay&) = delete;
  LoadDisplay& operator=(const LoadDisplay&) = delete;

 private:
  void tick(const std::stop_token& cancelled);

  const ProgressStyle style_;
  const LoadProgress& progress_;
  bool isShown_ = false;  // of ticking_, until that has ended
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread ticking_;  // last: it uses the others
};

/// Shows on stderr how far a rendering is: on a terminal one line that is written over and over, elsewhere a
/// line a pass and every few seconds. The renderer is looked at between its passes only, on the caller's
/// thread.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(ProgressStyle style);
  /// Removes the terminal's line.
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// To be called before the first pass and after each. `progress` in place of the renderer's own where
  /// something else tells how far it is.
  void update(const Renderer& renderer) { update(renderer, renderer.progress()); }
  void update(const Renderer& renderer, const RenderProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed() const;
  void tick(const std::stop_token& cancelled);
  void show(const ProgressState& state);  // with mutex_ held

  const ProgressStyle style_;
  const Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<ProgressState> state_;
  std::optional<Clock::time_point> shown_;
  std::jthread ticking_;  // last: it uses the others
};

}  // namespace lightvane
