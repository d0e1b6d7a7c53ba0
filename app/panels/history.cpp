#include "app/panels/history.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace lightvane {
namespace {

std::string describeParameterChange(const Parameters& before, const Parameters& after) {
  const std::vector<FieldDescription> old = describeParameters(before);
  const std::vector<FieldDescription> now = describeParameters(after);
  std::string text;
  int count = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (old[i].value == now[i].value) continue;
    ++count;
    text = fmt::format("{} {} -> {}", now[i].field.key, old[i].value, now[i].value);
  }
  // Values may differ in digits that their text leaves out.
  if (count == 0) return "Parameters";
  return count == 1 ? text : fmt::format("{} parameters", count);
}

std::string describeLightChange(const std::vector<LightSetting>& before,
                                const std::vector<LightSetting>& after) {
  if (before.size() != after.size()) return "Lights";
  std::size_t changed = 0;
  int count = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (before[i] == after[i]) continue;
    changed = i;
    ++count;
  }
  return count == 1 ? fmt::format("Light {}", changed + 1) : fmt::format("{} lights", count);
}

}  // namespace

std::string describeChange(const Setup& before, const Setup& after) {
  if (before == after) return {};
  if (before.parameters != after.parameters) {
    return describeParameterChange(before.parameters, after.parameters);
  }
  if (before.lights != after.lights) return describeLightChange(before.lights, after.lights);
  if (before.indirectFactors != after.indirectFactors) return "Refresh indirect light";
  if (before.brightness.exposureStops != after.brightness.exposureStops) return "Exposure";
  if (before.brightness.toneMapping != after.brightness.toneMapping) return "Tone mapping";
  if (before.cacheLocked != after.cacheLocked) return after.cacheLocked ? "Lock cache" : "Unlock cache";
  if (before.threads != after.threads) return "Threads";
  if (before.memoryLimitMegabytes != after.memoryLimitMegabytes) return "Memory limit";
  if (before.recordState != after.recordState) return "Vectors";
  return "Camera";
}

History::History(Setup start, std::size_t limit)
    : limit_(std::max<std::size_t>(limit, 1)), current_(std::move(start)) {}

void History::update(const Setup& now, bool gesture, std::string_view label) {
  if (!(now == current_)) {
    if (!open_) open_ = Step{.before = current_, .after = now, .label = {}};
    if (open_->label.empty()) open_->label = label;
    open_->after = now;
    current_ = now;
  }
  if (!gesture) close();
}

void History::reset(Setup start) {
  open_.reset();
  steps_.clear();
  undone_.clear();
  current_ = std::move(start);
}

std::optional<Setup> History::undo() {
  close();
  if (steps_.empty()) return std::nullopt;
  undone_.push_back(std::move(steps_.back()));
  steps_.pop_back();
  current_ = undone_.back().before;
  return current_;
}

std::optional<Setup> History::redo() {
  close();
  if (undone_.empty()) return std::nullopt;
  steps_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  current_ = steps_.back().after;
  return current_;
}

std::string History::undoLabel() const {
  if (open_) return open_->label.empty() ? describeChange(open_->before, open_->after) : open_->label;
  return steps_.empty() ? std::string() : steps_.back().label;
}

std::string History::redoLabel() const { return undone_.empty() ? std::string() : undone_.back().label; }

void History::close() {
  if (!open_) return;
  Step step = std::move(*open_);
  open_.reset();
  if (step.before == step.after) return;  // dragged there and back
  if (step.label.empty()) step.label = describeChange(step.before, step.after);
  steps_.push_back(std::move(step));
  if (steps_.size() > limit_) steps_.pop_front();
  undone_.clear();
}

}  // namespace lightvane
