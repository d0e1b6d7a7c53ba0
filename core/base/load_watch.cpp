#include "core/base/load_watch.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace lightvane {
namespace {

// Less than that nobody sees.
constexpr double kLeastStep = 0.001;

class NoWatch final : public LoadWatch {
 public:
  bool isStopped() override { return false; }

 private:
  void tell(const std::string&, std::optional<double>) override {}
};

}  // namespace

LoadWatch& LoadWatch::none() {
  // A watch keeps its stage, which threads must not share.
  static thread_local NoWatch watch;
  return watch;
}

void LoadWatch::tellFraction(double fraction) {
  const double whole = stage_.from + (stage_.to - stage_.from) * std::clamp(fraction, 0.0, 1.0);
  if (stage_.fraction && whole < *stage_.fraction + kLeastStep) return;
  stage_.fraction = whole;
  tell(stage_.text, stage_.fraction);
}

void LoadWatch::part(double from, double to) {
  stage_.from = from;
  stage_.to = to;
}

LoadStage::LoadStage(LoadWatch& watch, std::string text)
    : watch_(watch), outer_(std::exchange(watch.stage_, {std::move(text), {}})) {
  watch_.tell(watch_.stage_.text, std::nullopt);
}

LoadStage::~LoadStage() {
  watch_.stage_ = std::move(outer_);
  if (!watch_.stage_.text.empty()) watch_.tell(watch_.stage_.text, watch_.stage_.fraction);
}

LoadProgress::State LoadProgress::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void LoadProgress::set(const std::string& stage, std::optional<double> fraction) {
  const std::lock_guard lock(mutex_);
  state_ = {stage, fraction};
}

std::string progressText(const LoadProgress::State& state) {
  return state.fraction ? fmt::format("{}, {:.0f} %", state.stage, 100.0 * *state.fraction) : state.stage;
}

}  // namespace lightvane
