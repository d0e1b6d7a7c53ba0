#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace lightvane {

/// Two pictures of one size and in one unit, and what is known beside them. All must outlive the input.
///
/// Pixels that the mask leaves out, or that are not finite in one picture, do not count: they have no part in
/// a value, nor by way of filters in that of the pixels around.
struct MetricInput {
  const ImageRgb& picture;    ///< linear
  const ImageRgb& reference;  ///< linear
  /// Of the means that the reference's pixels are, per colour; null or empty where the reference's noise is
  /// not known. What is not a positive number in it stands for no noise.
  const ImageRgb* variance = nullptr;
  const ImageFloat* mask = nullptr;  ///< pixels of 0 do not count; null or empty: all do
  /// What a screen shows is linear * 2^exposureStops, clipped to [0, 1] and, where values and not light are
  /// compared, encoded by sRGB. Pictures from files for screens take 0.
  double exposureStops = 0.0;
};

struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;
};

struct MetricResult {
  double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN where too little counts
  /// Of `value`, as the scatter of its pixels tells; none where that tells nothing.
  std::optional<double> standardError;
  /// What `value` would be of a picture without any error, for the reference's noise alone: had it not been
  /// subtracted (MetricInfo::subtractsNoise), or as it is. For means of signed numbers its standard
  /// deviation. None where the noise is not known.
  std::optional<double> ofReference;
  /// Per pixel, never negative, more is worse, the reference's noise included; 0 where a pixel does not
  /// count.
  ImageFloat map;
  std::size_t counted = 0;    ///< pixels
  std::size_t notFinite = 0;  ///< pixels that the mask lets count, but which are not finite in one picture
  std::optional<PixelArea> area;  ///< where `value` is, of metrics that look for a place
};

enum class MetricUnit {
  Fraction,  ///< 0.02: shown as 2 %
  Radiance,  ///< that of the pictures
  Decibel,
  None,
};

enum class BetterValue { Lower, Higher, NearZero };

struct MetricInfo {
  std::string_view name;   ///< "relmse": as it is typed
  std::string_view label;  ///< "relMSE": as it is read
  MetricUnit unit = MetricUnit::None;
  BetterValue better = BetterValue::Lower;
  bool subtractsNoise = false;   ///< the reference's, from `value`, where it is known; else it is only stated
  std::string_view description;  ///< a sentence or two, with the constants
  std::string_view map;          ///< what the map shows
  /// Pure; any thread; the same bytes of the same input. Pictures without pixels or of different sizes are
  /// broken invariants. A million pixels take 0.1 s or less of a core, FLIP 0.2 s, HDR-FLIP 0.1 s an exposure
  /// (some ten); where the noise is known, those that only state it take twice that.
  MetricResult (*compute)(const MetricInput&);
};

/// All metrics, in the order in which they are shown.
std::span<const MetricInfo> metrics();

/// All of them, as comparisons ask for them.
std::vector<const MetricInfo*> allMetrics();

/// Null where there is none of that name.
const MetricInfo* findMetric(std::string_view name);

}  // namespace lightvane
