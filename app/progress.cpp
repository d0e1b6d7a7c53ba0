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
using Clock = std::chrono::steady_clock;

// A terminal's line moves on often enough to look alive.
constexpr auto kTerminalInterval = 200ms;
// Logs: a sign of life in a long pass, and no flood from short ones.
constexpr auto kLineInterval = 5s;
constexpr auto kLeastLineInterval = 500ms;
// What is over sooner needs no line.
constexpr auto kShortestLoad = 500ms;

void showLine(ProgressStyle style, const std::string& line) {
  if (style == ProgressStyle::Lines) {
    printNote(line);
  } else {
    // Back to the start, the line, and what the last one left behind it erased. A longer line than the
    // terminal is wide would wrap and stay, so that wrapping is off meanwhile (DECAWM).
    std::fputs(fmt::format("\r\x1b[?7l{}\x1b[K\x1b[?7h", line).c_str(), stderr);
    std::fflush(stderr);
  }
}

void removeLine(ProgressStyle style) {
  if (style == ProgressStyle::Terminal) std::fputs("\r\x1b[K", stderr);
}

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

ProgressStyle progressStyle(bool quiet) {
  if (quiet) return ProgressStyle::Silent;
  return isatty(STDERR_FILENO) != 0 ? ProgressStyle::Terminal : ProgressStyle::Lines;
}

LoadDisplay::LoadDisplay(ProgressStyle style, const LoadProgress& progress)
    : style_(style), progress_(progress) {
  if (style_ != ProgressStyle::Silent)
    ticking_ = std::jthread([this](const std::stop_token& token) { tick(token); });
}

LoadDisplay::~LoadDisplay() {
  ticking_.request_stop();
  if (ticking_.joinable()) ticking_.join();
  if (isShown_) removeLine(style_);
}

void LoadDisplay::tick(const std::stop_token& cancelled) {
  const bool isTerminal = style_ == ProgressStyle::Terminal;
  const auto next = isTerminal ? Clock::duration(kTerminalInterval) : Clock::duration(kLineInterval);
  auto interval = isTerminal ? Clock::duration(kShortestLoad) : next;
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, cancelled, interval, [&] { return cancelled.stop_requested(); })) {
    interval = next;
    const LoadProgress::State state = progress_.state();
    if (state.stage.empty()) continue;
    isShown_ = true;
    showLine(style_, progressText(state));
  }
}

ProgressDisplay::ProgressDisplay(ProgressStyle style) : style_(style) {
  if (style_ != ProgressStyle::Silent)
    ticking_ = std::jthread([this](const std::stop_token& token) { tick(token); });
}

ProgressDisplay::~ProgressDisplay() {
  ticking_.request_stop();
  if (ticking_.joinable()) ticking_.join();
  if (shown_) removeLine(style_);
}

double ProgressDisplay::elapsed() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

void ProgressDisplay::update(const Renderer& renderer, const RenderProgress& progress) {
  if (style_ == ProgressStyle::Silent) return;
  const RenderStatistics& statistics = renderer.statistics();
  const std::lock_guard lock(mutex_);
  const bool isFirst = !state_;
  const double before = state_ ? state_->fractionBefore : progress.fraction;
  state_ = ProgressState{progress, statistics.passes, statistics.ilvRecords + statistics.dlvRecords,
                         static_cast<double>(statistics.rays.total()) / std::max(1e-6, elapsed()), before};
  if (isFirst || renderer.done()) return;  // nothing to tell yet; the summary tells
  if (style_ == ProgressStyle::Terminal || !shown_ || Clock::now() - *shown_ >= kLeastLineInterval)
    show(*state_);
}

void ProgressDisplay::tick(const std::stop_token& cancelled) {
  const auto interval =
      style_ == ProgressStyle::Terminal ? Clock::duration(kTerminalInterval) : Clock::duration(kLineInterval);
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, cancelled, interval, [&] { return cancelled.stop_requested(); })) {
    // On a terminal every time; elsewhere only where no pass has spoken for so long.
    const bool isDue = style_ == ProgressStyle::Terminal || !shown_ || Clock::now() - *shown_ >= interval;
    if (state_ && isDue) show(*state_);
  }
}

void ProgressDisplay::show(const ProgressState& state) {
  shown_ = Clock::now();
  showLine(style_, progressLine(state, elapsed()));
}

}  // namespace lightvane
