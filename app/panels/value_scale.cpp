#include "app/panels/value_scale.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

// A control reaches this many times above and below the default: four doublings each way.
constexpr double kReach = 16.0;
// A range that ends beyond so many times the default is not shown whole.
constexpr double kWideRatio = 32.0;
// The part of a logarithmic scale that stands for `low` itself where the logarithm does not reach it.
constexpr double kLowPart = 0.04;

double roundedTo(double value, double step) { return std::round(value / step) * step; }

/// Without the digits beyond the third: a control of 200 pixels cannot tell them apart.
double withThreeDigits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double exponent = std::floor(std::log10(std::abs(value))) - 2.0;
  // Dividing by a whole power of ten gives the double nearest to the decimal; multiplying by 0.01 does not.
  return exponent < 0.0 ? std::round(value * std::pow(10.0, -exponent)) / std::pow(10.0, -exponent)
                        : roundedTo(value, std::pow(10.0, exponent));
}

}  // namespace

ValueScale ValueScale::about(double min, double max, double usual, double value, bool whole) {
  const bool isWide = min >= 0.0 && (usual > 0.0 ? usual * kWideRatio < max : max > kWideRatio);
  if (!isWide) return {min, max, min, false, whole};

  double high = usual > 0.0 ? usual * kReach : std::clamp(max / 100.0, kReach, 1e5);
  double floor = usual > 0.0 ? usual / kReach : high / (kReach * kReach * kReach);
  if (whole) {
    high = std::max(std::round(high), kReach);
    floor = std::max(std::floor(floor), 1.0);
  }
  high = std::min(std::max(high, value), max);
  floor = std::max(floor, min);
  if (value > min) floor = std::min(floor, value);
  const double low = min == 0.0 ? min : floor;
  return {low, high, floor, true, whole};
}

double ValueScale::toFraction(double value) const {
  if (high_ <= low_) return 0.0;
  if (!logarithmic_) return std::clamp((value - low_) / (high_ - low_), 0.0, 1.0);
  const double lowPart = floor_ > low_ ? kLowPart : 0.0;
  if (value < floor_) return 0.0;
  const double along = std::log(value / floor_) / std::log(high_ / floor_);
  return std::clamp(lowPart + along * (1.0 - lowPart), 0.0, 1.0);
}

double ValueScale::fromFraction(double fraction) const {
  const double t = std::clamp(fraction, 0.0, 1.0);
  if (!logarithmic_) {
    const double value = low_ + t * (high_ - low_);
    if (whole_) return std::round(value);
    // A thousandth of the range, as a power of ten.
    const double steps = std::pow(10.0, 3.0 - std::ceil(std::log10(high_ - low_)));
    return std::clamp(std::round(value * steps) / steps, low_, high_);
  }
  const double lowPart = floor_ > low_ ? kLowPart : 0.0;
  if (t < 0.5 * lowPart) return low_;
  const double along = std::max(0.0, (t - lowPart) / (1.0 - lowPart));
  const double value = floor_ * std::pow(high_ / floor_, along);
  return std::clamp(whole_ ? std::round(value) : withThreeDigits(value), floor_, high_);
}

}  // namespace lightvane
