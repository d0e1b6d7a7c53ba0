#include "app/progress.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "app/messages.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;

// A terminal's line moves on often enough to look alive.
constexpr auto kTerminalInterval = 200ms;
// Logs: a sign of life in a long pass, and no flood from short ones.
constexpr auto kLineInterval = 5s;
constexpr auto kLeastLineInterval = 500ms;

}  // namespace

std::string progressLine(const ProgressState& state, double elapsedSeconds) {
  const RenderProgress& progress = state.progress;
  std::string line = fmt::format("pass {}", state.passes + 1);
  if (!progress.stage.empty()) line += ", " + progress.stage;
  line += fmt::format(": {:.0f} %", 100.0 * progress.fraction);
  if (state.records > 0) line += fmt::format(", {} vectors", shortCount(static_cast<double>(state.records)));
  if (progress.hitRate > 0.0) line += fmt::format(", {:.0f} % interpolated", 100.0 * progress.hitRate);
  if (state.raysPerSecond > 0.0) line += fmt::format(", {} rays/s", shortCount(state.raysPerSecond));
  line += ", " + durationText(elapsedSeconds);
  const double done = progress.fraction - state.fractionBefore;
  if (done > 0.0 && progress.fraction < 1.0) {
    line += fmt::format(", about {} left", durationText(elapsedSeconds / done * (1.0 - progress.fraction)));
  }
  return line;
}

ProgressDisplay::Style ProgressDisplay::styleFor(bool quiet) {
  if (quiet) return Style::Silent;
  return isatty(STDERR_FILENO) != 0 ? Style::Terminal : Style::Lines;
}

ProgressDisplay::ProgressDisplay(Style style) : style_(style) {
  if (style_ != Style::Silent) ticking_ = std::jthread([this](const std::stop_token& token) { tick(token); });
}

ProgressDisplay::~ProgressDisplay() {
  ticking_.request_stop();
  if (ticking_.joinable()) ticking_.join();
  if (style_ == Style::Terminal && shown_) std::fputs("\r\x1b[K", stderr);
}

double ProgressDisplay::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressDisplay::update(const Renderer& renderer) {
  if (style_ == Style::Silent) return;
  const RenderStatistics& statistics = renderer.statistics();
  const std::lock_guard lock(mutex_);
  const bool isFirst = !state_;
  const double before = state_ ? state_->fractionBefore : renderer.progress().fraction;
  state_ =
      ProgressState{renderer.progress(), statistics.passes, statistics.ilvRecords + statistics.dlvRecords,
                    static_cast<double>(statistics.rays.total()) / std::max(1e-6, elapsed()), before};
  if (isFirst || renderer.done()) return;  // nothing to tell yet; the summary tells
  if (style_ == Style::Terminal || !shown_ || Clock::now() - *shown_ >= kLeastLineInterval) show(*state_);
}

void ProgressDisplay::tick(const std::stop_token& cancelled) {
  const auto interval =
      style_ == Style::Terminal ? Clock::duration(kTerminalInterval) : Clock::duration(kLineInterval);
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, cancelled, interval, [&] { return cancelled.stop_requested(); })) {
    // On a terminal every time; elsewhere only where no pass has spoken for so long.
    const bool isDue = style_ == Style::Terminal || !shown_ || Clock::now() - *shown_ >= interval;
    if (state_ && isDue) show(*state_);
  }
}

void ProgressDisplay::show(const ProgressState& state) {
  shown_ = Clock::now();
  const std::string line = progressLine(state, elapsed());
  if (style_ == Style::Lines) {
    printNote(line);
  } else {
    // Back to the start, the line, and what the last one left behind it erased. A longer line than the
    // terminal is wide would wrap and stay, so that wrapping is off meanwhile (DECAWM).
    std::fputs(fmt::format("\r\x1b[?7l{}\x1b[K\x1b[?7h", line).c_str(), stderr);
    std::fflush(stderr);
  }
}

}  // namespace lightvane
