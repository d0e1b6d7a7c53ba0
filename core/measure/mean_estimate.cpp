#include "core/measure/mean_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/math.h"

namespace lightvane {
namespace {

constexpr int kClusterSize = 16;

constexpr int clustersAlong(int pixels) { return (pixels + kClusterSize - 1) / kClusterSize; }

}  // namespace

double MeanEstimate::root() const { return std::sqrt(std::max(mean, 0.0)); }

double MeanEstimate::rootError() const {
  return mean > standardError ? standardError / (2.0 * root()) : std::sqrt(standardError);
}

MeanOfPixels::MeanOfPixels(int width, int height)
    : columns_(clustersAlong(width)), tiles_(static_cast<std::size_t>(columns_ * clustersAlong(height))) {}

void MeanOfPixels::add(int x, int y, double value) {
  const int place = (y / kClusterSize) * columns_ + x / kClusterSize;
  Tile& tile = tiles_[static_cast<std::size_t>(place)];
  tile.sum += value;
  tile.count += 1.0;
  sum_ += value;
  sumOfSquares_ += square(value);
  ++count_;
}

MeanEstimate MeanOfPixels::estimate() const {
  if (count_ == 0) return {0.0, std::numeric_limits<double>::infinity()};
  const auto n = static_cast<double>(count_);
  const double mean = sum_ / n;
  if (count_ == 1) return {mean, std::numeric_limits<double>::infinity()};
  const double ofPixels = std::max(sumOfSquares_ / n - square(mean), 0.0) / n;
  double ofTiles = 0.0;
  for (const Tile& tile : tiles_) ofTiles += square(tile.sum - mean * tile.count);
  return {mean, std::sqrt(std::max(ofPixels, ofTiles / square(n)))};
}

std::optional<double> ifFinite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace lightvane
