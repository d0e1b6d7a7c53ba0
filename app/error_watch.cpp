#include "app/error_watch.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/inspect/units.h"
#include "core/measure/target_error.h"

namespace lightvane {

ErrorWatch::Known ErrorWatch::find(const std::shared_ptr<const RenderFrame>& frame,
                                   const ReferencePixels& reference,
                                   std::shared_ptr<const ErrorEstimate> estimate, const StopFlag& stop) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Known known{frame, reference, std::move(estimate), kUnknown, kUnknown, {}, 0.0};
  // One thread: whoever turns a knob meanwhile has the others.
  TaskPool pool(1);
  if (!known.estimate) {
    known.estimate = std::make_shared<const ErrorEstimate>(estimateError(*frame, pool, stop));
  }
  if (stop) return known;
  known.said = targetErrorOf(*frame, *known.estimate, std::numeric_limits<double>::infinity(), 0).error;
  known.ofSampling = samplingErrorOf(*frame, estimateSamplingNoise(*frame, pool, stop));
  if (reference.beauty && !stop) {
    const ImageRgb picture = frame->film->sceneBeauty(*frame->scene);
    const ImageRgb& truth = *reference.beauty;
    const ImageRgb variance = reference.variance ? *reference.variance : ImageRgb();
    if (picture.width() == truth.width() && picture.height() == truth.height()) {
      known.measured = pictureError(picture, truth, variance);
      known.noise = pictureNoise(truth, variance);
    }
  }
  return known;
}

void ErrorWatch::update(const std::shared_ptr<const RenderFrame>& frame, const ReferencePixels& reference,
                        bool rests) {
  if (auto taken = job_.take()) known_ = std::move(taken);
  const bool isOfUse = frame && frame->complete && frame->reduction == 1 && frame->points;
  const auto isAbout = [&](const Known& one) { return one.frame == frame && one.reference == reference; };
  if (!isOfUse || !rests) return;
  if ((known_ && isAbout(*known_)) || (job_.isBusy() && isAbout(wanted_))) return;
  wanted_ = {frame, reference, nullptr, 0.0, 0.0, {}, 0.0};
  job_.start([frame, reference, estimate = estimateOf(frame.get())](const StopFlag& stop) {
    return find(frame, reference, estimate, stop);
  });
}

std::shared_ptr<const ErrorEstimate> ErrorWatch::estimateOf(const RenderFrame* frame) const {
  return known_ && known_->frame.get() == frame ? known_->estimate : nullptr;
}

std::string ErrorWatch::textOf(const RenderFrame* frame) const {
  if (frame == nullptr || !known_ || known_->frame.get() != frame) return {};
  std::string text;
  if (std::isfinite(known_->said))
    text = fmt::format("The picture's vectors say that its indirect light is off by about {} %",
                       numberText(100.0 * known_->said));
  if (std::isfinite(known_->ofSampling) && known_->ofSampling > 0.0) {
    text +=
        fmt::format("{} direct light, as it is sampled, by about {} %",
                    text.empty() ? "The picture is off in its" : ";", numberText(100.0 * known_->ofSampling));
  }
  if (!text.empty()) text += ".";
  if (known_->measured) {
    text += fmt::format("{}From the reference it is off by {} ± {} %", text.empty() ? "" : " ",
                        numberText(100.0 * known_->measured->relative),
                        numberText(100.0 * known_->measured->standardError, 2));
    text += known_->noise > 0.0
                ? fmt::format(", whose noise ({} %) is taken off.", numberText(100.0 * known_->noise, 2))
                : std::string(".");
  }
  return text;
}

}  // namespace lightvane
