#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/base/math.h"
#include "core/scene/description.h"

namespace lightvane {

/// The matrix that moves normals: that of the cofactors, which is the inverse transposed times the
/// determinant and exists where there is no inverse, with the determinant's sign taken out.
glm::dmat3 normalMatrix(const glm::dmat3& linear);

/// How a shape is put into the scene, in double: scaled, rotated and translated, and meshes moved by their
/// own placement before that.
class Transform {
 public:
  explicit Transform(const TransformDescription& d);
  Transform(const TransformDescription& d, const glm::dmat4& placement);

  Vec3d point(const Vec3d& p) const;
  /// Of length 1, or 0 where the transform leaves no normal.
  Vec3d normal(const Vec3d& n) const;
  /// Of the scale alone: a placement, which only meshes have, does not count.
  bool isUniform() const { return scale_.x == scale_.y && scale_.y == scale_.z; }
  double uniformScale() const { return std::abs(scale_.x); }
  /// Turns every surface inside out: an odd number of axes is mirrored.
  bool flips() const { return flips_; }

 private:
  struct Placement {
    glm::dmat3 linear;
    Vec3d translate;
    glm::dmat3 ofNormals;
  };

  std::optional<Placement> placement_;  ///< none where it changes nothing
  Vec3d translate_;
  Vec3d scale_;
  glm::dmat3 rotate_;
  bool flips_ = false;
};

template <class Vector>
BoundsOf<Vector> boundsOf(std::span<const Vector> points) {
  BoundsOf<Vector> bounds;
  for (const Vector& point : points) bounds.add(point);
  return bounds;
}

/// Adds points that `place`, an affine map, moves to `bounds`, exactly. `box` holds the points as they are:
/// where its image is within the bounds already, the points are not looked at, so that what is placed many
/// times costs little. False where a point is not finite.
template <class Vector, class Place>
bool addPlaced(std::span<const Vector> points, const BoundsOf<Vector>& box, const Place& place,
               BoundsOf<Vector>& bounds) {
  BoundsOf<Vector> image;
  for (int corner = 0; corner < 8; ++corner) {
    image.add(place(Vector(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                           corner & 4 ? box.upper.z : box.lower.z)));
  }
  const auto holds = [&bounds](const Vector& p) {
    return glm::all(glm::lessThanEqual(bounds.lower, p)) && glm::all(glm::lessThanEqual(p, bounds.upper));
  };
  if (holds(image.lower) && holds(image.upper)) return true;
  bool areFinite = true;
  for (const Vector& point : points) {
    const Vector placed = place(point);
    areFinite = areFinite && isFinite(placed);
    bounds.add(placed);
  }
  return areFinite;
}

}  // namespace lightvane
