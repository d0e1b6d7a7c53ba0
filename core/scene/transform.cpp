#include "core/scene/transform.h"

#include <cmath>

namespace lightvane {

namespace {

glm::dmat3 rotationAbout(int axis, double degrees) {
  // Exact for multiples of 90 degrees: boxes that were meant to be aligned stay so.
  const double quarter = degrees / 90.0;
  double s = std::sin(degrees * kPiD / 180.0);
  double c = std::cos(degrees * kPiD / 180.0);
  if (quarter == std::floor(quarter)) {
    const int q = static_cast<int>(std::fmod(std::fmod(quarter, 4.0) + 4.0, 4.0));
    s = q == 1 ? 1.0 : q == 3 ? -1.0 : 0.0;
    c = q == 0 ? 1.0 : q == 2 ? -1.0 : 0.0;
  }
  glm::dmat3 m(1.0);
  const int a = (axis + 1) % 3;
  const int b = (axis + 2) % 3;
  m[a][a] = c;
  m[a][b] = s;
  m[b][a] = -s;
  m[b][b] = c;
  return m;
}

Vec3d unitOrZero(const Vec3d& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : Vec3d(0.0);
}

}  // namespace

glm::dmat3 normalMatrix(const glm::dmat3& linear) {
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  return glm::determinant(linear) < 0.0 ? -cofactors : cofactors;
}

Transform::Transform(const TransformDescription& d)
    : translate_(d.translate),
      scale_(d.scale),
      rotate_(rotationAbout(2, d.rotateDegrees.z) * rotationAbout(1, d.rotateDegrees.y) *
              rotationAbout(0, d.rotateDegrees.x)),
      flips_(scale_.x * scale_.y * scale_.z < 0.0) {}

Transform::Transform(const TransformDescription& d, const glm::dmat4& placement) : Transform(d) {
  if (placement == glm::dmat4(1.0)) return;
  const glm::dmat3 linear(placement);
  placement_ = Placement{linear, Vec3d(placement[3]), normalMatrix(linear)};
  if (glm::determinant(linear) < 0.0) flips_ = !flips_;
}

Vec3d Transform::point(const Vec3d& p) const {
  const Vec3d placed = placement_ ? placement_->linear * p + placement_->translate : p;
  return translate_ + rotate_ * (scale_ * placed);
}

Vec3d Transform::normal(const Vec3d& n) const {
  const Vec3d placed = placement_ ? unitOrZero(placement_->ofNormals * n) : n;
  return unitOrZero(rotate_ * (placed / scale_));
}

}  // namespace lightvane
