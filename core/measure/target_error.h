#pragma once

#include <cstdint>
#include <vector>

#include "core/render/error_estimate.h"

namespace lightvane {

/// How far a picture is thought to be from what it would be with any number of vectors, and where more of
/// them are wanted (the paper's section 7).
struct TargetError {
  /// The relative RMSE, as the metric `relative` has it, that is to be expected of the indirect light; of the
  /// whole picture's light. NaN where the picture has no vectors.
  double error = 0.0;
  /// Where it is above the target; ascending.
  std::vector<std::uint32_t> pixels;
};

/// The relative RMSE, likewise, that is to be expected of light that is sampled at the points. `noise` is the
/// frame's own. NaN where it has none.
double samplingErrorOf(const RenderFrame& frame, const SamplingNoise& noise);

/// `frame` is complete, and `estimate` its own. About half as many pixels as there are vectors, drawn by lot
/// by how far they are above `target`; `round` names the lot.
TargetError targetErrorOf(const RenderFrame& frame, const ErrorEstimate& estimate, double target,
                          std::uint32_t round);

}  // namespace lightvane
