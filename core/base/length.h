#pragma once

namespace lightvane {

/// A length that says what it is relative to, so that 0.08 metres and 0.08 diagonals cannot be mixed up.
class Length {
 public:
  /// A fraction of the scene's diagonal.
  static constexpr Length relative(double fraction) { return {fraction, true}; }
  /// Metres, whatever unit the scene file uses.
  static constexpr Length metres(double value) { return {value, false}; }

  bool isRelative() const { return relative_; }
  double value() const { return value_; }

  /// In the scene's normalised units, in which its diagonal is `diagonal` and one of them is `metresPerUnit`
  /// metres.
  double inNormalisedUnits(double diagonal, double metresPerUnit) const {
    return relative_ ? value_ * diagonal : value_ / metresPerUnit;
  }

  bool operator==(const Length&) const = default;

 private:
  constexpr Length(double value, bool relative) : value_(value), relative_(relative) {}
  double value_;
  bool relative_;
};

}  // namespace lightvane
