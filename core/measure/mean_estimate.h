#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lightvane {

/// A mean and how sure it is.
struct MeanEstimate {
  double mean = 0.0;
  double standardError = 0.0;  ///< infinite of fewer than two values

  /// Of the mean's root. Of a root whose square is no larger than its own error that error's root is all that
  /// is known.
  double root() const;
  double rootError() const;
};

/// The mean of a number of each pixel of a picture.
///
/// Errors of pixels are seldom independent: neighbours are answered by the same records, and windows of
/// filters overlap. So the scatter of tiles of 16 x 16 pixels is looked at, too (clusters, as in Cameron &
/// Miller, "A Practitioner's Guide to Cluster-Robust Inference", 2015), and the larger of the two counts.
class MeanOfPixels {
 public:
  MeanOfPixels(int width, int height);

  void add(int x, int y, double value);
  std::size_t count() const { return count_; }
  MeanEstimate estimate() const;

 private:
  struct Tile {
    double sum = 0.0;
    double count = 0.0;
  };

  int columns_;
  std::vector<Tile> tiles_;
  double sum_ = 0.0, sumOfSquares_ = 0.0;
  std::size_t count_ = 0;
};

/// None where it is not finite.
std::optional<double> ifFinite(double value);

}  // namespace lightvane
