#pragma once

#include "core/base/math.h"

namespace lightvane {

// Solid-angle maps: from the unit square to the directions in which a shape is seen from the origin.
//
// Each map is prepared once for a shape and a point (the shape's coordinates are relative to that point) and
// then sampled many times. Everything is double and written in differences of the shape's vertices, so that a
// shape of 1e-12 sr, or a point a millionth of its size away from its plane, loses no digits that a float
// could show. Nothing has a length of its own: scaling a shape by a power of two changes no bit of the
// directions and solid angles. A solid angle of 0 says that the shape cannot be seen (no extent, edge-on);
// such a map must not be sampled.
//
// Sources:
//   A. van Oosterom, J. Strackee: The Solid Angle of a Plane Triangle. IEEE Trans. Biomed. Eng. 30(2), 1983.
//   J. Arvo: Stratified Sampling of Spherical Triangles. SIGGRAPH 1995.
//   P. Shirley, K. Chiu: A Low Distortion Map Between Disk and Square. JGT 2(3), 1997.
//   C. Urena, M. Fajardo, A. King: An Area-Preserving Parametrization for Spherical Rectangles. EGSR 2013.
//   I. Guillen et al.: Area-Preserving Parameterizations for Spherical Ellipses. EGSR 2017.
//   C. Peters: BRDF Importance Sampling for Polygonal Lights. SIGGRAPH 2021 (Arvo's map without inverse
//   cosines).

/// A point of a shape as seen from the origin.
struct SphericalSample {
  Vec3d direction;  ///< unit
  double distance;  ///< to the shape's surface, in the shape's unit
};

/// Samples side by side, so that vector instructions work on several of them.
struct SphericalSampleBatch {
  static constexpr int kCount = 16;

  alignas(64) float u[kCount], v[kCount];  ///< in: the places in the unit square, all of them set
  alignas(64) float directionX[kCount], directionY[kCount], directionZ[kCount];  ///< out: unit
  alignas(64) float distance[kCount];  ///< out: to the shape's surface
};

/// A triangle seen from the origin. u.x sweeps the side opposite to the apex from its begin to its end, u.y
/// goes from the apex to that side: the triangles of a fan about one apex join without a jump in u.x.
class SphericalTriangle {
 public:
  /// The apex, and the edges that lead from it to the begin and to the end of the swept side: given as edges,
  /// since those of a small triangle far away cannot be had from its corners.
  SphericalTriangle(const Vec3d& apex, const Vec3d& toBegin, const Vec3d& toEnd);

  double solidAngle() const { return solidAngle_; }
  /// The origin is on the side from which apex, begin, end run counter-clockwise.
  bool seenFromFront() const { return front_; }
  SphericalSample sample(const Vec2d& u) const;

 private:
  double solidAngle_ = 0.0;
  bool front_ = false;
  Vec3d apex_, begin_;    // unit directions
  Vec3d tangent_;         // unit, at begin, along the swept side
  Vec3d beginMinusApex_;  // of the unit directions
  double onePlusCos_;     // 1 + apex . begin
  double sine_;           // det(begin, apex, tangent), positive
  double cosine_;         // apex . tangent
  Vec3d planeNormal_;     // not normalised, away from the origin
  double planeOffset_;    // planeNormal . any point of the plane, positive
  double farthest_;
};

/// What a rectangle's map takes from its sides alone, wherever it is seen from.
struct RectangleSides {
  RectangleSides() = default;
  /// They must be orthogonal.
  RectangleSides(const Vec3d& sideX, const Vec3d& sideY);

  double width = 0.0, depth = 0.0;    ///< lengths of the sides
  Vec3d x{0.0}, y{0.0}, normal{0.0};  ///< unit, where the rectangle has an extent
};

/// Points side by side, each of which sees the same shape.
struct SphericalPointBatch {
  static constexpr int kCount = SphericalSampleBatch::kCount;

  alignas(64) float x[kCount], y[kCount], z[kCount];  ///< all of them set
};

/// How large a rectangle looks from each of the points.
struct RectangleAngleBatch {
  static constexpr int kCount = SphericalSampleBatch::kCount;

  // Of one type: what differs in size is not worked on side by side.
  alignas(64) double solidAngle[kCount];       ///< SphericalRectangle::solidAngle
  alignas(64) double height[kCount];           ///< negative where seenFromFront
  alignas(64) double distanceSquared[kCount];  ///< to the corner
};

/// A rectangle seen from the origin: `corner` and the two sides that leave it.
class SphericalRectangle {
 public:
  SphericalRectangle(const Vec3d& corner, const RectangleSides& sides);

  /// Whether a side is below 1e-7 of the corner's distance. The map subtracts angles from the foot of the
  /// perpendicular, to 1e-16 over the width that is seen: the triangles of a fan keep all digits there, where
  /// nobody sees strata.
  static bool isSmall(double distanceSquared, const RectangleSides& sides);

  double solidAngle() const { return view_.solidAngle; }
  /// The origin is on the side of cross(sideX, sideY).
  bool seenFromFront() const { return view_.height < 0.0; }
  SphericalSample sample(const Vec2d& u) const;
  /// The same for many at once, to the bit, rounded to float. Cost: a third of one by one.
  void sample(SphericalSampleBatch& batch) const;
  /// Each sample as seen from its own point, to the bit what the map for that point gives, rounded to float.
  /// `corner` and `points` are relative to the same origin. Cost: a fifth of one by one.
  static void sampleFromEach(const SphericalPointBatch& points, const Vec3d& corner,
                             const RectangleSides& sides, SphericalSampleBatch& batch,
                             RectangleAngleBatch& angles);

 private:
  /// The rectangle in coordinates along its sides, with the origin at the foot of the perpendicular.
  struct View {
    double x0, x1, y0, y1;
    double height;      ///< signed: negative where the origin is in front
    double solidAngle;  ///< 0 where it cannot be seen
    double begin;       ///< the solid angle between the planes x = 0 and x = x0, negative to the left
    double sinSquaredDifference, cosSquaredSum;  ///< of half the angles between, and of the sum of, y0 and y1
  };
  struct Place {
    double x, y, distance;
  };
  static View view(const Vec3d& corner, const RectangleSides& sides);
  static Place place(const View& view, double u, double v);

  View view_;
  Vec3d x_, y_, normal_;  // along the sides, and across
};

/// A sphere seen from the origin, which may be inside; or a cone of directions to a light at infinity.
class SphericalCap {
 public:
  SphericalCap(const Vec3d& center, double radius);
  /// Directions within `oneMinusCos` = 1 - cos(half-angle) of the unit vector `axis`; samples are at distance
  /// infinity.
  static SphericalCap atInfinity(const Vec3d& axis, double oneMinusCos);

  double solidAngle() const { return 2.0 * kPiD * oneMinusCos_; }
  /// The origin is outside of the sphere.
  bool seenFromFront() const { return !inside_; }
  SphericalSample sample(const Vec2d& u) const;

 private:
  SphericalCap() = default;
  Vec3d x_, y_, z_;  // frame about the direction to the centre
  double oneMinusCos_ = 0.0;
  double centerDistance_ = 0.0;
  double radiusSquared_ = 0.0;
  double powerOfPoint_ = 0.0;  // squared distance to the centre minus squared radius
  bool inside_ = false;
};

/// A disc seen from the origin: a spherical ellipse with half-angles alpha >= beta.
///
/// Guillen's radial map needs the inverse of an elliptic integral for the azimuth. Here the azimuth is drawn
/// instead from a density that has a closed inverse, (cos, sin) ~ (sin alpha cos psi, sin beta sin psi) with
/// psi uniform; the radius stays uniform in solid angle. The density is then (1 + cos theta) / (2 pi sin
/// alpha sin beta) with theta the ellipse's angular radius at that azimuth: within a factor of 2 of uniform
/// for every disc and point, and exactly uniform on the disc's axis and for small discs.
class SphericalDisc {
 public:
  /// `normal` is unit.
  SphericalDisc(const Vec3d& center, const Vec3d& normal, double radius);

  /// By quadrature, to a relative 1e-3 in the worst case: a point near the rim's plane.
  double solidAngle() const;
  bool visible() const { return sinBeta_ > 0.0; }
  /// The origin is on the side to which the normal points.
  bool seenFromFront() const { return front_; }
  SphericalSample sample(const Vec2d& u) const;
  /// The density of sample(), sr^-1, at a unit direction towards the disc.
  double pdf(const Vec3d& direction) const;

 private:
  bool front_ = false;
  double sinAlpha_ = 0.0, cosAlpha_ = 0.0, sinBeta_ = 0.0, cosBeta_ = 0.0;
  Vec3d major_, minor_, axis_;  // orthonormal; axis is the centre of the ellipse, not of the disc
  Vec3d towardsPlane_;          // unit
  double height_ = 0.0;
  double farthest_ = 0.0;
};

}  // namespace lightvane
