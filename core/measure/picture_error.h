#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace lightvane {

/// How far a picture is from what it should be, and how sure that is.
struct PictureError {
  double relative = 0.0;       ///< 0.02: 2 %
  double standardError = 0.0;  ///< of `relative`, from how much its pixels and tiles scatter
};

/// The root of the mean squared relative difference of a picture from a reference, over all pixels and
/// colours. A difference is relative to the mean of the reference in the 5 x 5 pixels around, and to 1 % of
/// the mean of all where that is dark. What the reference's own noise adds is taken off: `variance` is that
/// of its pixels, empty where it has none. Pixels that are not finite in one of them are left out.
///
/// The metric "relative" of metric.h. The pictures must be of one size and in one unit.
PictureError pictureError(const ImageRgb& picture, const ImageRgb& reference, const ImageRgb& variance);

/// The noise of a picture whose pixels have this variance: the error that a perfect picture would have
/// against it, were that not taken off. 0 where nothing is known.
double pictureNoise(const ImageRgb& picture, const ImageRgb& variance);

/// The seed of references: other than pictures' own, as what both have in common would be no error.
inline constexpr std::uint64_t kReferenceSeed = 1'000'003;
/// Passes of a path traced reference, of fewer than which the noise is not to be looked at: rare bright paths
/// may be missing altogether. 32 paths a pixel.
inline constexpr int kLeastReferencePasses = 6;

}  // namespace lightvane
