#include "app/error_explanation.h"

#include <fmt/format.h>

#include "core/base/number_text.h"

namespace lightvane {
namespace {

// Each step looks at four times as many pixels as the one before.
constexpr int kFirstStride = 16;

}  // namespace

void ErrorExplanation::update(const std::shared_ptr<const RenderFrame>& frame, bool isAsked, bool rests) {
  if (auto taken = job_.take(); taken && taken->sources) known_ = std::move(taken);
  if (known_ && known_->frame != frame) known_.reset();
  waitsFor_.clear();
  if (!isAsked || !frame) return job_.cancel();
  if (job_.isBusy() && wanted_ != frame) job_.cancel();
  waitsFor_ = errorSourceObstacle(*frame);
  if (!rests && waitsFor_.empty()) waitsFor_ = "begins when the rendering rests";
  if (!waitsFor_.empty() || job_.isBusy()) return;
  const int stride = known_ ? known_->sources->stride / 2 : kFirstStride;
  if (stride == 0) return;
  wanted_ = frame;
  done_ = std::make_shared<std::atomic<double>>(0.0);
  job_.start([frame, stride, done = done_](const StopFlag& stop) {
    // One thread: whoever turns a knob meanwhile has the others.
    TaskPool pool(1);
    auto sources = errorSources(*frame, {.stride = stride}, pool, stop,
                                [&](double part) { done->store(part, std::memory_order_relaxed); });
    Known known{frame, nullptr};
    if (sources) known.sources = std::make_shared<const ErrorSources>(*std::move(sources));
    return known;
  });
}

std::shared_ptr<const ErrorSources> ErrorExplanation::sourcesOf(const RenderFrame* frame) const {
  return known_ && known_->frame.get() == frame ? known_->sources : nullptr;
}

std::string ErrorExplanation::textOf(const RenderFrame* frame) const {
  std::string text;
  if (const auto sources = sourcesOf(frame)) {
    text = fmt::format("{} of {} pixels, {} samples each", countText(sources->pixels.size()),
                       countText(sources->truth.size()), sources->samples);
  }
  if (job_.isBusy()) {
    text += fmt::format("{}: {:.0f} %", text.empty() ? "finding out" : "; finer",
                        100.0 * done_->load(std::memory_order_relaxed));
  }
  return text.empty() ? waitsFor_ : text;
}

}  // namespace lightvane
