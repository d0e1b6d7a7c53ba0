#pragma once

namespace lightvane {

/// How a control's length, 0 to 1, stands for a number. Ranges of parameters are wide, because anything that
/// works may be typed; a control spans what is useful about the value that the parameter has by default.
class ValueScale {
 public:
  /// What one drags over for a range, a default and a value as it stands: all of the range where it is
  /// narrow, and otherwise a part of it, on a logarithmic scale, that holds the default and the value.
  /// `whole`: of whole numbers.
  static ValueScale about(double min, double max, double usual, double value, bool whole);
  static constexpr ValueScale linear(double low, double high) { return {low, high, low, false, false}; }

  double low() const { return low_; }
  double high() const { return high_; }
  bool isLogarithmic() const { return logarithmic_; }

  /// Clamped to [0, 1].
  double toFraction(double value) const;
  /// The number at a fraction in [0, 1], with no more digits than a control can tell apart.
  double fromFraction(double fraction) const;

  bool operator==(const ValueScale&) const = default;

 private:
  constexpr ValueScale(double low, double high, double floor, bool logarithmic, bool whole)
      : low_(low), high_(high), floor_(floor), logarithmic_(logarithmic), whole_(whole) {}

  double low_;
  double high_;
  double floor_;  ///< where the logarithmic part begins; left of it is `low` alone, which may be 0
  bool logarithmic_;
  bool whole_;
};

}  // namespace lightvane
