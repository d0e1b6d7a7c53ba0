#include "core/scene/spherical.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/trigonometry.h"

namespace lightvane {
namespace {

// Distance along `cosine` (of a direction with the plane's normal) to a plane `height` away. Rounding can
// turn a direction at grazing incidence past the plane; the shape's farthest point is then the answer.
double planeDistance(double height, double cosine, double farthest) {
  return height < cosine * farthest ? height / cosine : farthest;
}

// y1 * hypot(y0, d) - y0 * hypot(y1, d) for y0 <= y1, given the two hypotenuses and dSquared.
// Choices by value, as below.
[[gnu::always_inline]] inline double crossDifference(double y0, double y1, double width, double hypotenuse0,
                                                     double hypotenuse1, double dSquared) {
  const double product1 = y1 * hypotenuse0;
  const double product0 = y0 * hypotenuse1;
  const double ofOneSide = dSquared * width * (y1 + y0) / (product1 + product0);
  return y0 * y1 <= 0.0 ? product1 - product0 : ofOneSide;
}

// std::clamp by value: a choice between references is a branch.
double clamped(double value, double low, double high) {
  const double raised = value < low ? low : value;
  return high < raised ? high : raised;
}

// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
void basisAbout(const Vec3d& z, Vec3d& x, Vec3d& y) {
  const double sign = std::copysign(1.0, z.z);
  const double a = -1.0 / (sign + z.z);
  const double b = z.x * z.y * a;
  x = {1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x};
  y = {b, sign + z.y * z.y * a, -z.y};
}

}  // namespace

SphericalTriangle::SphericalTriangle(const Vec3d& apex, const Vec3d& toBegin, const Vec3d& toEnd) {
  const Vec3d begin = apex + toBegin;
  const Vec3d end = apex + toEnd;
  Vec3d normal = glm::cross(toBegin, toEnd);
  // det(apex, begin, end); by the edges it keeps its digits however small the triangle is.
  double determinant = glm::dot(apex, normal);
  front_ = determinant < 0.0;
  if (front_) {
    determinant = -determinant;
    normal = -normal;
  }
  const double apexLength = glm::length(apex);
  const double beginLength = glm::length(begin);
  const double endLength = glm::length(end);
  if (!(determinant > 0.0) || apexLength == 0.0 || beginLength == 0.0 || endLength == 0.0) return;

  planeNormal_ = normal;
  planeOffset_ = determinant;
  farthest_ = std::max(apexLength, std::max(beginLength, endLength));

  apex_ = apex / apexLength;
  begin_ = begin / beginLength;
  beginMinusApex_ = begin_ - apex_;

  const Vec3d side = toEnd - toBegin;
  const Vec3d across = side - begin_ * glm::dot(begin_, side);
  const double acrossLength = glm::length(across);
  if (!(acrossLength > 0.0)) return;
  tangent_ = across / acrossLength;

  const double cosApexBegin = glm::dot(apex_, begin_);
  const Vec3d sum = apex_ + begin_;
  onePlusCos_ = cosApexBegin > 0.0 ? 1.0 + cosApexBegin : 0.5 * glm::dot(sum, sum);
  sine_ = determinant / (apexLength * beginLength * acrossLength);
  cosine_ = -glm::dot(beginMinusApex_, tangent_);

  const double denominator = apexLength * beginLength * endLength + glm::dot(apex, begin) * endLength +
                             glm::dot(begin, end) * apexLength + glm::dot(end, apex) * beginLength;
  solidAngle_ = 2.0 * angleOf(determinant, denominator);
}

SphericalSample SphericalTriangle::sample(const Vec2d& u) const {
  // Where on the swept side the part between apex, begin and there has u.x of the solid angle. With t the arc
  // from begin, van Oosterom and Strackee's tan(omega / 2) is sine tan(t / 2) / (onePlusCos + cosine tan(t /
  // 2)).
  const double half = 0.5 * u.x * solidAngle_;
  const double sinHalf = std::sin(half);
  const double numerator = sinHalf * onePlusCos_;
  const double denominator = std::max(0.0, std::cos(half) * sine_ - sinHalf * cosine_);
  const double squares = numerator * numerator + denominator * denominator;
  const double scale = squares > 0.0 ? 2.0 * numerator / squares : 0.0;
  const Vec3d chord = beginMinusApex_ + scale * (denominator * tangent_ - numerator * begin_);

  // From the apex along that arc, uniform in its 1 - cos.
  const double oneMinusCosArc = 0.5 * glm::dot(chord, chord);
  const double oneMinusCos = u.y * oneMinusCosArc;
  const double remaining = std::max(2.0 - oneMinusCosArc, std::numeric_limits<double>::min());
  const double along = std::sqrt(u.y * (2.0 - oneMinusCos) / remaining);
  const Vec3d direction = (1.0 - oneMinusCos + along * oneMinusCosArc) * apex_ + along * chord;
  const Vec3d unit = direction / glm::length(direction);
  return {unit, planeDistance(planeOffset_, glm::dot(unit, planeNormal_), farthest_)};
}

RectangleSides::RectangleSides(const Vec3d& sideX, const Vec3d& sideY)
    : width(glm::length(sideX)), depth(glm::length(sideY)) {
  if (!(width > 0.0) || !(depth > 0.0)) return;
  x = sideX / width;
  y = sideY / depth;
  normal = glm::cross(x, y);
  normal /= glm::length(normal);
}

bool SphericalRectangle::isSmall(double distanceSquared, const RectangleSides& sides) {
  const double leastSquared = 1e-14 * distanceSquared;
  return !(square(sides.width) > leastSquared && square(sides.depth) > leastSquared);
}

// This and place() are inlined into loops over a batch, which are vectorised: the choices are written as
// values, not as ways to go.
[[gnu::always_inline]] inline SphericalRectangle::View SphericalRectangle::view(const Vec3d& corner,
                                                                                const RectangleSides& sides) {
  View view;
  view.height = glm::dot(corner, sides.normal);
  view.x0 = glm::dot(corner, sides.x);
  view.y0 = glm::dot(corner, sides.y);
  view.x1 = view.x0 + sides.width;
  view.y1 = view.y0 + sides.depth;
  const double height = std::abs(view.height);
  const double y0 = view.y0;
  const double y1 = view.y1;

  // The solid angle between the planes x = 0 and x, negative to the left. As the integral of the slices
  // through the y axis it is asin(m1 c) - asin(m0 c), with m = y / hypot(y, height) and c = x / hypot(x,
  // height).
  const double heightSquared = height * height;
  const auto sliceAngle = [&](double x) {
    const double dSquared = x * x + heightSquared;
    const double rho0 = std::sqrt(dSquared + y0 * y0);
    const double rho1 = std::sqrt(dSquared + y1 * y1);
    const double sine = x * height * crossDifference(y0, y1, sides.depth, rho0, rho1, dSquared);
    return angleOf(sine, heightSquared * rho0 * rho1 + x * x * y0 * y1);
  };
  view.begin = sliceAngle(view.x0);
  const double between = sliceAngle(view.x1) - view.begin;
  const bool hasAngle = (height > 0.0) & (sides.width > 0.0) & (sides.depth > 0.0) & (between > 0.0);
  view.solidAngle = hasAngle ? between : 0.0;

  // With mu = atan(y / height): sin^2 of half mu1 - mu0, and cos^2 of half mu1 + mu0.
  const double r0 = std::sqrt(y0 * y0 + heightSquared);
  const double r1 = std::sqrt(y1 * y1 + heightSquared);
  const double scale = 1.0 / (r0 * r1);
  const double cosDifference = (heightSquared + y0 * y1) * scale;
  const double sinDifference = height * sides.depth * scale;
  const double acute = square(sinDifference) / (2.0 * (1.0 + cosDifference));
  view.sinSquaredDifference = cosDifference > 0.0 ? acute : 0.5 * (1.0 - cosDifference);
  const double cosSum = (heightSquared - y0 * y1) * scale;
  const double sinSum = height * (y0 + y1) * scale;
  const double obtuse = square(sinSum) / (2.0 * (1.0 - cosSum));
  view.cosSquaredSum = cosSum > 0.0 ? 0.5 * (1.0 + cosSum) : obtuse;
  return view;
}

[[gnu::always_inline]] inline SphericalRectangle::Place SphericalRectangle::place(const View& view, double u,
                                                                                  double v) {
  // asin(m1 c) - asin(m0 c) = T, solved for the tangent c / sqrt(1 - c^2). Urena et al. solve the same
  // equation by the rectangle's corner angles, whose differences drown in rounding for small rectangles.
  const double height = std::abs(view.height);
  const double halfT = 0.5 * (view.begin + u * view.solidAngle);
  double sinHalf = 0.0;
  double cosHalf = 0.0;
  sinCosUpToRightAngle(halfT, sinHalf, cosHalf);
  const double sinSquared = sinHalf * sinHalf;
  const double denominator = (view.sinSquaredDifference - sinSquared) * (view.cosSquaredSum - sinSquared);
  const double numerator = height * sinHalf * cosHalf;
  const double tangent = numerator / std::sqrt(denominator);
  const double unclamped = denominator > 0.0 ? tangent : (halfT < 0.0 ? view.x0 : view.x1);
  const double x = clamped(unclamped, view.x0, view.x1);

  // In the slice at x, uniform in the sine of the elevation.
  const double dSquared = x * x + height * height;
  const double h0 = view.y0 / std::sqrt(dSquared + view.y0 * view.y0);
  const double h1 = view.y1 / std::sqrt(dSquared + view.y1 * view.y1);
  const double h = h0 + v * (h1 - h0);
  const double cosSquared = 1.0 - h * h;
  const double risen = h * std::sqrt(dSquared / cosSquared);
  const double y = cosSquared > 0.0 ? clamped(risen, view.y0, view.y1) : (h < 0.0 ? view.y0 : view.y1);
  return {x, y, std::sqrt(dSquared + y * y)};
}

SphericalRectangle::SphericalRectangle(const Vec3d& corner, const RectangleSides& sides)
    : view_(view(corner, sides)), x_(sides.x), y_(sides.y), normal_(sides.normal) {}

SphericalSample SphericalRectangle::sample(const Vec2d& u) const {
  const Place at = place(view_, u.x, u.y);
  return {(at.x * x_ + at.y * y_ + view_.height * normal_) * (1.0 / at.distance), at.distance};
}

void SphericalRectangle::sample(SphericalSampleBatch& batch) const {
  const Vec3d across = view_.height * normal_;
  for (int i = 0; i < SphericalSampleBatch::kCount; ++i) {
    const Place at = place(view_, batch.u[i], batch.v[i]);
    const double scale = 1.0 / at.distance;
    batch.directionX[i] = static_cast<float>((at.x * x_.x + at.y * y_.x + across.x) * scale);
    batch.directionY[i] = static_cast<float>((at.x * x_.y + at.y * y_.y + across.y) * scale);
    batch.directionZ[i] = static_cast<float>((at.x * x_.z + at.y * y_.z + across.z) * scale);
    batch.distance[i] = static_cast<float>(at.distance);
  }
}

void SphericalRectangle::sampleFromEach(const SphericalPointBatch& points, const Vec3d& corner,
                                        const RectangleSides& sides, SphericalSampleBatch& batch,
                                        RectangleAngleBatch& angles) {
  const Vec3d x = sides.x;
  const Vec3d y = sides.y;
  const Vec3d normal = sides.normal;
  for (int i = 0; i < SphericalSampleBatch::kCount; ++i) {
    const Vec3d seen(corner.x - static_cast<double>(points.x[i]), corner.y - static_cast<double>(points.y[i]),
                     corner.z - static_cast<double>(points.z[i]));
    const View view = SphericalRectangle::view(seen, sides);
    const Place at = place(view, batch.u[i], batch.v[i]);
    const double scale = 1.0 / at.distance;
    const double height = view.height;
    batch.directionX[i] = static_cast<float>((at.x * x.x + at.y * y.x + height * normal.x) * scale);
    batch.directionY[i] = static_cast<float>((at.x * x.y + at.y * y.y + height * normal.y) * scale);
    batch.directionZ[i] = static_cast<float>((at.x * x.z + at.y * y.z + height * normal.z) * scale);
    batch.distance[i] = static_cast<float>(at.distance);
    angles.solidAngle[i] = view.solidAngle;
    angles.height[i] = view.height;
    angles.distanceSquared[i] = glm::dot(seen, seen);
  }
}

SphericalCap::SphericalCap(const Vec3d& center, double radius) {
  centerDistance_ = glm::length(center);
  z_ = centerDistance_ > 0.0 ? center / centerDistance_ : Vec3d(0.0, 0.0, 1.0);
  basisAbout(z_, x_, y_);
  radiusSquared_ = radius * radius;
  powerOfPoint_ = (centerDistance_ - radius) * (centerDistance_ + radius);
  inside_ = centerDistance_ <= radius;
  if (inside_) {
    oneMinusCos_ = radius > 0.0 ? 2.0 : 0.0;
  } else {
    const double distanceSquared = centerDistance_ * centerDistance_;
    oneMinusCos_ = radiusSquared_ / distanceSquared / (1.0 + std::sqrt(powerOfPoint_ / distanceSquared));
  }
}

SphericalCap SphericalCap::atInfinity(const Vec3d& axis, double oneMinusCos) {
  SphericalCap cap;
  cap.z_ = axis;
  basisAbout(cap.z_, cap.x_, cap.y_);
  cap.oneMinusCos_ = oneMinusCos;
  cap.centerDistance_ = std::numeric_limits<double>::infinity();
  return cap;
}

SphericalSample SphericalCap::sample(const Vec2d& u) const {
  const DiscPoint disc = concentricDisc(u);
  const double oneMinusCos = disc.radiusSquared * oneMinusCos_;
  const double sinSquared = oneMinusCos * (2.0 - oneMinusCos);
  const double sine = std::sqrt(sinSquared);
  const double cosine = 1.0 - oneMinusCos;
  const Vec3d direction = cosine * z_ + sine * (disc.cosine * x_ + disc.sine * y_);
  if (std::isinf(centerDistance_)) return {direction, centerDistance_};

  const double closest = centerDistance_ * cosine;
  const double halfChord =
      std::sqrt(std::max(0.0, radiusSquared_ - centerDistance_ * centerDistance_ * sinSquared));
  // The nearer root outside, the farther inside; as a quotient where the difference would cancel.
  return {direction, inside_ ? std::max(0.0, closest + halfChord) : powerOfPoint_ / (closest + halfChord)};
}

SphericalDisc::SphericalDisc(const Vec3d& center, const Vec3d& normal, double radius) {
  const double signedHeight = -glm::dot(center, normal);
  front_ = signedHeight > 0.0;
  height_ = std::abs(signedHeight);
  if (!(height_ > 0.0) || !(radius > 0.0)) return;
  towardsPlane_ = front_ ? -normal : normal;

  // In the plane of symmetry, with x along the disc and z towards it, the disc is the segment from v0 to v1.
  const Vec3d lateralVector = center + signedHeight * normal;
  const double lateral = glm::length(lateralVector);
  Vec3d x;
  if (lateral > 0.0) {
    x = lateralVector / lateral;
    major_ = glm::cross(towardsPlane_, x);
  } else {
    basisAbout(towardsPlane_, x, major_);
  }
  const Vec2d v0(lateral - radius, height_);
  const Vec2d v1(lateral + radius, height_);
  const double length0 = glm::length(v0);
  const double length1 = glm::length(v1);
  farthest_ = length1;

  // The ellipse's axis halves the angle 2 beta between v0 and v1; half of that angle from the better
  // conditioned of its sine and cosine. alpha follows from the chord at the bisector's foot (intersecting
  // chords theorem).
  const Vec2d unit0 = v0 / length0;
  const Vec2d unit1 = v1 / length1;
  const double lengths = length0 * length1;
  const double sinDouble = 2.0 * radius * height_ / lengths;
  const double cosDouble = (height_ * height_ + v0.x * v1.x) / lengths;
  Vec2d bisector;
  if (cosDouble > 0.0) {
    cosBeta_ = std::sqrt(0.5 * (1.0 + cosDouble));
    sinBeta_ = 0.5 * sinDouble / cosBeta_;
    bisector = glm::normalize(unit0 + unit1);
  } else {
    sinBeta_ = std::sqrt(0.5 * (1.0 - cosDouble));
    cosBeta_ = 0.5 * sinDouble / sinBeta_;
    const Vec2d difference = glm::normalize(unit1 - unit0);
    bisector = Vec2d(-difference.y, difference.x);
  }
  const double lengthSum = length0 + length1;
  sinAlpha_ = std::min(1.0, 2.0 * radius / lengthSum);
  cosAlpha_ = 2.0 * std::sqrt(lengths) * cosBeta_ / lengthSum;
  axis_ = bisector.x * x + bisector.y * towardsPlane_;
  minor_ = bisector.y * x - bisector.x * towardsPlane_;
}

double SphericalDisc::solidAngle() const {
  if (!visible()) return 0.0;
  // The mean of 1 / density over psi: smooth and periodic, so that the midpoint rule converges geometrically.
  constexpr int kNodes = 16;
  static const std::array<double, kNodes> kSinSquared = [] {
    std::array<double, kNodes> values{};
    for (int i = 0; i < kNodes; ++i)
      values[static_cast<std::size_t>(i)] = square(std::sin((i + 0.5) * 0.5 * kPiD / kNodes));
    return values;
  }();
  double sum = 0.0;
  const double cosAlphaSquared = square(cosAlpha_);
  const double cosBetaSquared = square(cosBeta_);
  for (const double sinSquared : kSinSquared) {
    sum += 1.0 / (1.0 + std::sqrt(cosAlphaSquared * (1.0 - sinSquared) + cosBetaSquared * sinSquared));
  }
  return 2.0 * kPiD * sinAlpha_ * sinBeta_ * sum / kNodes;
}

SphericalSample SphericalDisc::sample(const Vec2d& u) const {
  const DiscPoint disc = concentricDisc(u);
  const double alongMajor = sinAlpha_ * disc.cosine;
  const double alongMinor = sinBeta_ * disc.sine;
  const double sinSquaredRim = square(alongMajor) + square(alongMinor);
  const double cosRim = std::sqrt(square(cosAlpha_ * disc.cosine) + square(cosBeta_ * disc.sine));
  const double oneMinusCos = disc.radiusSquared * sinSquaredRim / (1.0 + cosRim);
  // Of the sine of the polar angle over that of the rim; the azimuth's vector has the rim's sine as its
  // length.
  const double scale = std::sqrt(disc.radiusSquared * (2.0 - oneMinusCos) / (1.0 + cosRim));
  const Vec3d direction = (1.0 - oneMinusCos) * axis_ + scale * (alongMajor * major_ + alongMinor * minor_);
  return {direction, planeDistance(height_, glm::dot(direction, towardsPlane_), farthest_)};
}

double SphericalDisc::pdf(const Vec3d& direction) const {
  const double c = glm::dot(direction, major_) / sinAlpha_;
  const double s = glm::dot(direction, minor_) / sinBeta_;
  const double squares = c * c + s * s;
  const double cosRim =
      squares > 0.0 ? std::sqrt((square(cosAlpha_ * c) + square(cosBeta_ * s)) / squares) : cosAlpha_;
  return (1.0 + cosRim) / (2.0 * kPiD * sinAlpha_ * sinBeta_);
}

}  // namespace lightvane
