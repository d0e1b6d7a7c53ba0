#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/base/color.h"
#include "core/base/load_watch.h"
#include "core/base/math.h"
#include "core/image/image.h"

namespace lightvane {

/// A picture of all directions, latitude by longitude, to be looked up and sampled by brightness. Immutable;
/// any thread.
///
/// Local directions: y is up, the picture's top row; its middle column is towards -z, and +x is to the right
/// of that, three quarters across. Between the middles of its pixels the picture is interpolated bilinearly,
/// round the horizon too.
class EnvironmentMap {
 public:
  /// `picture` has pixels, all of them finite and not negative. Cost: linear in them. Throws
  /// LoadStopped as `watch` says.
  explicit EnvironmentMap(ImageRgb picture, LoadWatch& watch = LoadWatch::none());

  /// In the picture's own units.
  Rgb radiance(const Vec3& local) const;
  /// A direction with density pdf(); `u` in [0, 1)^2. Strata of u stay together on the sphere. Any direction
  /// where the picture is black, whose pdf is 0.
  Vec3 sample(const Vec2& u) const;
  /// sr^-1: in proportion to the interpolated brightness, but for how the solid angle of a square between the
  /// middles of four pixels changes within it.
  float pdf(const Vec3& local) const;

  /// The integral of the radiance over all directions, for each colour: about, and at most.
  const Rgb& total() const { return total_; }
  const Rgb& totalBound() const { return totalBound_; }
  float brightest() const { return brightest_; }

 private:
  /// In pixels from the upper left corner of the picture.
  Vec2 placeOf(const Vec3& local) const;
  /// Cells lie between the middles of four pixels: cell `column` between that and the next, cell `row`
  /// between the row above and this. Those at the poles are half as high, and have the nearest row on both
  /// sides. Upper left and right, lower left and right.
  std::array<Rgb, 4> cornersOf(int column, int row) const;
  int cellRows() const { return picture_.height() + 1; }
  double cellSolidAngle(std::size_t row) const;
  /// The cell that a direction is in, and how far to the right and down in it, in parts of its angles.
  struct Cell {
    int column, row;
    float right, down;
  };
  Cell cellOf(const Vec3& local) const;

  ImageRgb picture_;
  std::vector<double> cosines_;  ///< of the polar angles at which rows of cells begin and the last one ends
  // Both end at 1 and are what sampling and pdf() take alike, rounding included.
  std::vector<float> rowCdf_;     ///< of cells
  std::vector<float> columnCdf_;  ///< [row * width + column]
  Rgb total_{0.0f};
  Rgb totalBound_{0.0f};
  float brightest_ = 0.0f;
};

/// The sky: light from all around, from infinitely far away.
struct EnvironmentLight {
  Rgb radiance{1.0f};                         ///< from everywhere, or what the map is multiplied by
  std::shared_ptr<const EnvironmentMap> map;  ///< null: the same light from all directions
  Frame frame;                                ///< the map's axes in the world

  Rgb radianceFrom(const Vec3& direction) const;
  /// Chooses a direction, world, for a surface of this unit normal; where that is zero, no surface is
  /// assumed. By the cosine with the normal, by the map, or, where there are both, by the one for half of the
  /// samples and by the other for the rest, weighed together (Veach 1997, balance heuristic).
  Vec3 sample(const Vec2& u, const Vec3& normal) const;
  /// The density of sample(), sr^-1.
  float pdf(const Vec3& direction, const Vec3& normal) const;
  /// The integral of the radiance over all directions, W m^-2.
  Rgb total() const;
  /// The irradiance on a surface of any orientation, at most, for each colour.
  Rgb irradianceBound() const;
};

/// The axes of an environment whose up is `up` (not zero, any length), turned about it by this angle,
/// counter-clockwise seen from above. Up along y and no angle are the world's own axes.
Frame environmentFrame(const Vec3d& up, double rotateDegrees);

}  // namespace lightvane
