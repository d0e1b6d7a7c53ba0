#include "app/error_watch.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/inspect/units.h"
#include "core/measure/target_error.h"

namespace lightvane {

ErrorWatch::Known ErrorWatch::find(Known known, const StopFlag& stop) {
  const RenderFrame& frame = *known.frame;
  if (!known.estimate) {
    // One thread: whoever turns a knob meanwhile has the others.
    TaskPool pool(1);
    known.estimate = std::make_shared<const ErrorEstimate>(estimateError(frame, pool, stop));
    known.ofSampling = samplingErrorOf(frame, estimateSamplingNoise(frame, pool, stop));
  }
  if (stop) return known;
  known.said = targetErrorOf(frame, *known.estimate, std::numeric_limits<double>::infinity(), 0).error;
  if (!known.reference.beauty) return known;
  const ImageRgb picture = frame.film->sceneBeauty(*frame.scene);
  const ImageRgb& truth = *known.reference.beauty;
  const ImageRgb variance = known.reference.variance ? *known.reference.variance : ImageRgb();
  if (picture.width() == truth.width() && picture.height() == truth.height()) {
    known.measured = pictureError(picture, truth, variance);
    known.noise = pictureNoise(truth, variance);
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
  // What the frame says of itself is the same for every reference.
  wanted_ = known_ && known_->frame == frame ? *known_ : Known{};
  wanted_.frame = frame;
  wanted_.reference = reference;
  wanted_.measured.reset();
  job_.start([wanted = wanted_](const StopFlag& stop) { return find(wanted, stop); });
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
