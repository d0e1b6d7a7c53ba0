#pragma once

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/measure/metric.h"

namespace lightvane {

/// How two pictures are compared.
struct ComparisonRequest {
  std::vector<const MetricInfo*> metrics;
  /// Of those of a picture file (docs/lightvane.md): "beauty", "direct". Empty: beauty, and direct and
  /// indirect where both have them.
  std::vector<std::string> layers;
  bool withoutEdges = false;   ///< of the geometry: pixels that see two surfaces do not count
  bool withoutLights = false;  ///< nor do those that see a light
  double exposureStops = 0.0;  ///< of metrics on what a screen shows
};

/// What each metric says of one layer, in the order of the request's.
struct LayerComparison {
  std::string layer;
  bool knowsNoise = false;  ///< that of the reference's pixels
  std::vector<MetricResult> results;
};

struct PictureComparison {
  int width = 0, height = 0;
  std::vector<LayerComparison> layers;

  const MetricResult& first() const { return layers.front().results.front(); }
};

/// The variance of the means that a path traced picture's pixels are, in this layer; empty where the picture
/// does not say. Files say it of the beauty picture, meanOfHalves of more.
ImageRgb varianceOf(const LayeredImage& image, const std::string& layer = "beauty");

/// The mean of two path traced pictures with different seeds. How much they differ tells the noise of
/// "beauty", "direct" and "indirect": half their difference is the standard error of their mean. Against such
/// a reference a metric's squared difference, less the noise, is the product of the differences from either
/// half, whose noise is independent, so that its mean is that of a perfect reference. All else is the
/// first's. The pictures must be of one size.
LayeredImage meanOfHalves(const LayeredImage& first, const LayeredImage& second);

/// Compares two pictures from files. Errors, with the files' names: sizes that differ, a layer that one of
/// them has not, a mask for which neither knows enough, no pixel that counts. The mask is made of the
/// reference's layers or, where it has none, of the picture's. Pure; the cost is that of the metrics for each
/// layer.
Expected<PictureComparison> compareImages(const LayeredImage& picture, const std::string& pictureName,
                                          const LayeredImage& reference, const std::string& referenceName,
                                          const ComparisonRequest& request);

}  // namespace lightvane
