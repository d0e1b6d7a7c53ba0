#include "core/measure/picture_error.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/color.h"
#include "core/base/math.h"

namespace lightvane {
namespace {

constexpr int kReach = 2;           // of the pixels around: 5 x 5
constexpr double kDarkPart = 0.01;  // of the mean of all

double meanOf(const Rgb& colour) {
  return (static_cast<double>(colour.r) + static_cast<double>(colour.g) + static_cast<double>(colour.b)) /
         3.0;
}

/// Of the finite pixels of the square around (x, y).
double meanAround(const ImageRgb& image, int x, int y) {
  double sum = 0.0;
  int count = 0;
  for (int ny = std::max(y - kReach, 0); ny <= std::min(y + kReach, image.height() - 1); ++ny) {
    for (int nx = std::max(x - kReach, 0); nx <= std::min(x + kReach, image.width() - 1); ++nx) {
      const Rgb& colour = image.at(nx, ny);
      if (!isFinite(colour)) continue;
      sum += meanOf(colour);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

double meanOfAll(const ImageRgb& image) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const Rgb& colour : image) {
    if (!isFinite(colour)) continue;
    sum += meanOf(colour);
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0.0;
}

}  // namespace

PictureError pictureError(const ImageRgb& picture, const ImageRgb& reference, const ImageRgb& variance) {
  LV_CHECK(picture.width() == reference.width() && picture.height() == reference.height(),
           "{}x{} pixels against {}x{}", picture.width(), picture.height(), reference.width(),
           reference.height());
  LV_CHECK(variance.empty() || variance.size() == reference.size(), "{} variances of {} pixels",
           variance.size(), reference.size());
  const double dark = kDarkPart * meanOfAll(reference);
  double sum = 0.0, sumOfSquares = 0.0;
  std::size_t count = 0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const Rgb& a = picture.at(x, y);
      const Rgb& b = reference.at(x, y);
      if (!isFinite(a) || !isFinite(b)) continue;
      double squared = 0.0;
      for (int c = 0; c < 3; ++c)
        squared += square(static_cast<double>(a[c]) - static_cast<double>(b[c])) / 3.0;
      if (!variance.empty()) squared -= meanOf(variance.at(x, y));
      const double scale = square(meanAround(reference, x, y)) + square(dark);
      // A black picture of a black scene is right.
      const double relative = scale > 0.0 ? squared / scale : squared > 0.0 ? 1.0 : 0.0;
      sum += relative;
      sumOfSquares += square(relative);
      ++count;
    }
  }
  if (count == 0) return {};
  const auto n = static_cast<double>(count);
  const double mean = sum / n;
  const double ofMean = std::sqrt(std::max(sumOfSquares / n - square(mean), 0.0) / n);
  const double root = std::sqrt(std::max(mean, 0.0));
  // Of a root whose square is no larger than its own error that error's root is all that is known.
  return {root, mean > ofMean ? ofMean / (2.0 * root) : std::sqrt(ofMean)};
}

}  // namespace lightvane
