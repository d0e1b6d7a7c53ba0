#pragma once

#include "core/base/tasks.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// What the vectors that answer a picture say of its error, without a reference.
struct ErrorEstimate {
  /// Of the indirect light of each pixel, in mirrors too, squared and by colour; in the film's units. Empty
  /// where the frame has no vectors.
  ImageRgb variance;
  /// The part of the answers that one vector gave, whose spread is taken to be that of all others, in
  /// proportion to their light. 1 where nothing is known at all.
  double guessed = 1.0;
};

/// Each point's vectors against each other (IndirectSpread): their noise, and as much of what interpolation
/// does as makes them differ. What they have in common, a shadow that none of them sees or a bounce that none
/// follows, does not show, nor does the noise of direct light. Points of one pixel are taken to err alike.
/// Cost: that of answering the picture again, without rays for direct light. Stopped, it is of no use.
ErrorEstimate estimateError(const RenderFrame& frame, TaskPool& pool, const StopFlag& stop);

/// What light that is sampled at the points, and not interpolated, adds to a picture's error.
struct SamplingNoise {
  static constexpr int kStride = 3;

  ImageFloat counted;  ///< 1 at pixels that were looked at: one of each square of kStride pixels; empty where
                       ///< the frame has no points
  ImageRgb variance;   ///< theirs, by colour; in the film's units
};

/// Samples these lights, straight and by way of planar mirrors, twice more with numbers of their own: half of
/// the squared difference is the variance of one. Lights that vectors interpolate are left out. Cost: two in
/// nine of what sampling them cost.
SamplingNoise estimateSamplingNoise(const RenderFrame& frame, TaskPool& pool, const StopFlag& stop);

}  // namespace lightvane
