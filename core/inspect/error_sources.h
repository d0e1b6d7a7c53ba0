#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "core/image/image.h"
#include "core/inspect/error_source.h"
#include "core/inspect/full_computation.h"

namespace lightvane {

// Where the error of a whole picture comes from: DifferenceParts, pixel by pixel.

const Vec3d& partOf(const DifferenceParts& parts, ErrorSource source);

/// How much of a picture's error is of one kind.
struct SourceError {
  /// The root of the mean squared difference over pixels and colours, each relative to the picture's own mean
  /// in the 5 x 5 pixels around (the metric "relative" of core/measure). Free of what the full computation's
  /// own noise would add: it is of the product of two independent halves.
  double relative = 0.0;
  double standardError = 0.0;  ///< of `relative`, from how much pixels and tiles scatter
  double bias = 0.0;  ///< the mean difference of luminance, as a part of the picture's mean luminance
};

struct SourceErrors {
  std::array<SourceError, kErrorSources> ofSource;  ///< parts, whose squares need not add up
  SourceError total;
};

struct ErrorSources {
  int samples = 0;      ///< of the full computation at each point, for each light and indirect light
  SourceErrors direct;  ///< lights in mirrors, too
  SourceErrors indirect;
  SourceErrors picture;
  /// What each source adds to each pixel, signed, scene units; NaN in pixels that were not looked at.
  std::array<ImageRgb, kErrorSources> maps;
  /// Likewise the squared difference of luminance, as the product of two halves: free of the full
  /// computation's noise on average, and below 0 where that is all there is.
  std::array<ImageFloat, kErrorSources> squares;
  ImageRgb truth;  ///< the picture without error, as far as it is known; scene units, NaN likewise
  std::vector<std::size_t> pixels;  ///< that were looked at, square by square
  RayCounts rays;

  int stride = 1;  ///< as it was asked for

  const ImageRgb& map(ErrorSource source) const { return maps[static_cast<std::size_t>(source)]; }
  /// The source of most of the squared difference about that pixel, in 3 x 3 squares of `stride`; none where
  /// there is no difference that both halves see. Cost: some 10 ns.
  std::optional<ErrorSource> largest(int x, int y) const;
  /// The pixel that was looked at in the square of that one.
  std::size_t lookedAt(int x, int y) const;
};

struct ErrorSourceRequest {
  int samples = 256;  ///< see FullComputer
  int stride = 1;     ///< one pixel in each square so wide, wherever in it
};

inline constexpr int kMostExplainSamples = 1 << 20;
inline constexpr int kMostExplainStride = 1 << 12;

/// Why there are no sources to tell of; empty where there are.
std::string errorSourceObstacle(const RenderFrame& frame);

/// Of a complete frame with vectors. `told`, which may be empty, hears now and then on the calling thread
/// which part is done. Nothing where it was stopped. The same for any number of threads. Cost: computeHere's
/// for each pixel that is looked at, but each vector once.
std::optional<ErrorSources> errorSources(const RenderFrame& frame, const ErrorSourceRequest& request,
                                         TaskPool& pool, const StopFlag& stop,
                                         const std::function<void(double)>& told = {});

}  // namespace lightvane
