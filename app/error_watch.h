#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "app/background_job.h"
#include "core/image/image.h"
#include "core/measure/picture_error.h"
#include "core/render/error_estimate.h"

namespace lightvane {

/// What a picture is held against, in the scene's units.
struct ReferencePixels {
  std::shared_ptr<const ImageRgb> beauty;    ///< null where there is none
  std::shared_ptr<const ImageRgb> variance;  ///< of its pixels; null or empty where it is not known

  bool operator==(const ReferencePixels&) const = default;
};

/// How far off the picture is: what its own vectors say, and what a reference says where there is one. Worked
/// out in the background once the picture is complete. On one thread.
class ErrorWatch {
 public:
  explicit ErrorWatch(std::function<void()> wake) : job_(std::move(wake)) {}

  /// Takes what has become known, and begins with a picture that is complete and not known yet. `rests`:
  /// nothing else is being made.
  void update(const std::shared_ptr<const RenderFrame>& frame, const ReferencePixels& reference, bool rests);

  /// Of that frame; null where it is not known.
  std::shared_ptr<const ErrorEstimate> estimateOf(const RenderFrame* frame) const;
  /// "The picture's vectors say that its indirect light is off by about 1.9 %; direct light, as it is
  /// sampled, by about 1.2 %. From the reference it is off by 2.3 ± 0.2 %, whose noise (5 %) is taken off."
  /// Empty where nothing is known of the frame.
  std::string textOf(const RenderFrame* frame) const;

 private:
  struct Known {
    std::shared_ptr<const RenderFrame> frame;
    ReferencePixels reference;
    std::shared_ptr<const ErrorEstimate> estimate;
    double said = std::numeric_limits<double>::quiet_NaN();        ///< TargetError::error
    double ofSampling = std::numeric_limits<double>::quiet_NaN();  ///< samplingErrorOf
    std::optional<PictureError> measured;  ///< of all of the picture, from the reference
    double noise = 0.0;                    ///< the reference's, which `measured` is without
  };

  /// Fills in what is not known yet of the frame, and of its reference.
  static Known find(Known known, const StopFlag& stop);

  std::optional<Known> known_;
  Known wanted_;  ///< what the job is about
  BackgroundJob<Known> job_;
};

}  // namespace lightvane
