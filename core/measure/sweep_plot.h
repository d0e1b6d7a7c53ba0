#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lightvane {

// The geometry of plots, in pixels of an SVG's own grid.

enum class PlotScale { Linear, Log };

/// Where values are along an axis. What has no place on it (nothing and below on a logarithmic one, and
/// infinity) gets one of its own at the end, apart from the others.
struct PlotAxis {
  PlotScale scale = PlotScale::Log;
  double low = 0.0, high = 1.0;             ///< at the ends; of the decimal logarithms where it is one
  double from = 0.0, to = 1.0;              ///< pixels of low and high
  std::optional<double> nothing, infinity;  ///< pixels, where a value is so
  bool isSignedNothing = false;             ///< what is at `nothing` is partly below 0

  /// Bars may reach beyond the ends, and end there. Never NaN but of NaN.
  double at(double value) const;
};

/// An axis for these values, with some space about them. `bars` are to be seen as well where they are finite
/// and can be. Equal values, or none, get a range too.
PlotAxis plotAxis(std::span<const double> values, std::span<const double> bars, PlotScale scale, double from,
                  double to);

struct AxisTick {
  double at = 0.0;    ///< pixels
  std::string label;  ///< empty for a mark between others
};

/// Round numbers, at least `distance` pixels from label to label.
std::vector<AxisTick> axisTicks(const PlotAxis& axis, double distance);

struct PlotBox {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;

  bool overlaps(const PlotBox& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

enum class TextAnchor { Start, Middle, End };

/// A text's line begins (or has its middle, or ends) here, on its base line.
struct PlacedLabel {
  double x = 0.0, y = 0.0;
  TextAnchor anchor = TextAnchor::Start;
};

/// Finds places for labels that overlap neither each other nor what was there before.
class LabelPlaces {
 public:
  explicit LabelPlaces(const PlotBox& area) : area_(area) {}

  void occupy(const PlotBox& box) { taken_.push_back(box); }
  /// Beside a point; nothing where every place is taken.
  std::optional<PlacedLabel> place(double x, double y, std::string_view text);

 private:
  PlotBox area_;
  std::vector<PlotBox> taken_;
};

/// Of labels. No font is known here: wide enough for DejaVu Sans, the widest of the usual ones.
double labelWidth(std::string_view text);

}  // namespace lightvane
