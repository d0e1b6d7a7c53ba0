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

std::string describeShownChange(const Shown& before, const Shown& after) {
  if (before.overlays != after.overlays) return "Overlays";
  if (before.compareMode != after.compareMode || before.compareWith != after.compareWith) return "Comparing";
  if (before.scale != after.scale) return "Colour scale";
  if (before.smooth != after.smooth) return "Smoothing";
  return "View";
}

}  // namespace

Undoable undoableOf(const Workspace& workspace) {
  const Display& display = workspace.display;
  Shown shown{.view = display.view,
              .smooth = display.smooth,
              .scale = display.scale,
              .overlays = display.overlays,
              .compareMode = display.comparison.mode,
              .compareWith = display.comparison.with};
  shown.overlays.growth = {};
  return {workspace.setup, shown};
}

void restore(const Undoable& state, Workspace& workspace) {
  workspace.setup = state.setup;
  Display& display = workspace.display;
  const Shown& shown = state.shown;
  display.view = shown.view;
  display.smooth = shown.smooth;
  display.scale = shown.scale;
  const GrowthTime growth = display.overlays.growth;
  display.overlays = shown.overlays;
  display.overlays.growth = growth;
  display.comparison.mode = shown.compareMode;
  display.comparison.with = shown.compareWith;
}

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

std::string describeChange(const Undoable& before, const Undoable& after) {
  if (before.setup != after.setup) return describeChange(before.setup, after.setup);
  return before.shown != after.shown ? describeShownChange(before.shown, after.shown) : "";
}

bool History::Step::isLook() const {
  Undoable turned = before;
  turned.shown.view = after.shown.view;
  return turned == after;
}

History::History(Undoable start, std::size_t limit)
    : limit_(std::max<std::size_t>(limit, 1)), current_(std::move(start)) {}

void History::update(const Undoable& now, bool gesture, std::string_view label) {
  if (!(now == current_)) {
    if (!open_) open_ = Step{.before = current_, .after = now, .label = {}};
    if (open_->label.empty()) open_->label = label;
    open_->after = now;
    current_ = now;
  }
  if (!gesture) close();
}

void History::reset(Undoable start) {
  open_.reset();
  steps_.clear();
  undone_.clear();
  current_ = std::move(start);
}

std::optional<Undoable> History::undo() {
  close();
  if (steps_.empty()) return std::nullopt;
  undone_.push_back(std::move(steps_.back()));
  steps_.pop_back();
  take(undone_.back(), undone_.back().before);
  return current_;
}

std::optional<Undoable> History::redo() {
  close();
  if (undone_.empty()) return std::nullopt;
  steps_.push_back(std::move(undone_.back()));
  undone_.pop_back();
  take(steps_.back(), steps_.back().after);
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
  if (!steps_.empty() && step.isLook() && steps_.back().isLook()) {
    step.before.shown = steps_.back().before.shown;
    steps_.pop_back();
  }
  // What would be set again over what was set now.
  if (step.ofSetup())
    undone_.clear();
  else
    std::erase_if(undone_, [](const Step& other) { return other.ofShown(); });
  if (!step.ofSetup() && !step.ofShown()) return;  // looked there and back
  steps_.push_back(std::move(step));
  if (steps_.size() > limit_) steps_.pop_front();
}

void History::take(const Step& step, const Undoable& state) {
  if (step.ofSetup()) current_.setup = state.setup;
  if (step.ofShown()) current_.shown = state.shown;
}

}  // namespace lightvane
