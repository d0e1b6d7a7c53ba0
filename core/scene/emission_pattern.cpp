#include "core/scene/emission_pattern.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Steps of a brightness from 0 to 1. With 2^16 of them the sums of 2^48 pixels are below 2^64.
constexpr double kBrightnessSteps = 65535.0;

/// Place number `i` of a sequence that covers the unit square evenly (M. Roberts, The Unreasonable
/// Effectiveness of Quasirandom Sequences, 2018: the plastic number's R2).
Vec2d evenPlace(std::size_t i) {
  const auto n = static_cast<double>(i) + 0.5;
  const double x = n * 0.7548776662466927;
  const double y = n * 0.5698402909980532;
  return {x - std::floor(x), y - std::floor(y)};
}

/// A place on the piece for one in the unit square, equal areas for equal areas.
Vec3d placeOn(const EmitterTriangle& t, Vec2d u) {
  if (u.x + u.y > 1.0) u = 1.0 - u;
  return Vec3d(t.a) + u.x * (Vec3d(t.b) - Vec3d(t.a)) + u.y * (Vec3d(t.c) - Vec3d(t.a));
}
Vec3d placeOn(const EmitterSphere& s, const Vec2d& u) {
  const double z = 1.0 - 2.0 * u.x;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double phi = 2.0 * kPiD * u.y;
  return Vec3d(s.center) + static_cast<double>(s.radius) * Vec3d(r * std::cos(phi), r * std::sin(phi), z);
}
Vec3d placeOn(const EmitterDisc& d, const Vec2d& u) {
  const Frame frame = Frame::aboutNormal(d.normal);
  const double r = static_cast<double>(d.radius) * std::sqrt(u.x);
  const double phi = 2.0 * kPiD * u.y;
  return Vec3d(d.center) + r * (std::cos(phi) * Vec3d(frame.x) + std::sin(phi) * Vec3d(frame.y));
}

}  // namespace

PictureBrightness::PictureBrightness(const ImageTextureDescription& image)
    : width_(image.pixels->width()),
      height_(image.pixels->height()),
      wrap_(image.wrap),
      filter_(image.filter),
      sums_((static_cast<std::size_t>(width_) + 1) * (static_cast<std::size_t>(height_) + 1)) {
  for (int y = 0; y < height_; ++y) {
    std::uint64_t row = 0;
    for (int x = 0; x < width_; ++x) {
      const double brightness = maxComponent(image.pixels->at(x, y));
      row += static_cast<std::uint64_t>(std::ceil(brightness * kBrightnessSteps));
      sums_[index(x + 1, y + 1)] = sums_[index(x + 1, y)] + row;
    }
  }
}

std::size_t PictureBrightness::index(int column, int row) const {
  return static_cast<std::size_t>(row) * (static_cast<std::size_t>(width_) + 1) +
         static_cast<std::size_t>(column);
}

PictureBrightness::Parts PictureBrightness::partsOf(double least, double greatest, int count) const {
  const bool isLinear = filter_ == TextureFilter::Linear;
  const double first = std::floor(isLinear ? least - 0.5 : least);
  const double last = std::floor(isLinear ? greatest - 0.5 : greatest) + (isLinear ? 1.0 : 0.0);
  // Also where a coordinate is no number.
  if (!(first <= last && last - first < count - 1)) return {Part{0, count}, Part{}};
  if (wrap_ == TextureWrap::Clamp) {
    const double end = count - 1;
    return {
        Part{static_cast<int>(std::clamp(first, 0.0, end)), static_cast<int>(std::clamp(last, 0.0, end)) + 1},
        Part{}};
  }
  const auto begin = static_cast<int>(first - count * std::floor(first / count));
  const int end = begin + static_cast<int>(last - first) + 1;
  return {Part{begin, std::min(end, count)}, Part{0, std::max(0, end - count)}};
}

std::uint64_t PictureBrightness::sumOf(const Part& columns, const Part& rows) const {
  const auto sum = [&](int column, int row) { return sums_[index(column, row)]; };
  return (sum(columns.end, rows.end) - sum(columns.begin, rows.end)) -
         (sum(columns.end, rows.begin) - sum(columns.begin, rows.begin));
}

double PictureBrightness::meanWithin(std::span<const Vec2> corners) const {
  Vec2d least(kInfinity);
  Vec2d greatest(-kInfinity);
  double farthest = 1.0;
  for (const Vec2& corner : corners) {
    const Vec2 uv = Texture::withinReach(corner);
    least = glm::min(least, Vec2d(uv));
    greatest = glm::max(greatest, Vec2d(uv));
    farthest = std::max({farthest, std::abs(static_cast<double>(uv.x)), std::abs(static_cast<double>(uv.y))});
  }
  // A hit's coordinates are sums of three products in float, and divided by the scale: some 2^-23 each.
  const double rounding = farthest * 0x1p-20;
  const Parts columns = partsOf((least.x - rounding) * width_, (greatest.x + rounding) * width_, width_);
  const Parts rows =
      partsOf((1.0 - greatest.y - rounding) * height_, (1.0 - least.y + rounding) * height_, height_);
  std::uint64_t sum = 0;
  double pixels = 0.0;
  for (const Part& c : columns) {
    for (const Part& r : rows) {
      sum += sumOf(c, r);
      pixels += static_cast<double>(c.end - c.begin) * static_cast<double>(r.end - r.begin);
    }
  }
  return static_cast<double>(sum) / (pixels * kBrightnessSteps);
}

EmissionPattern::EmissionPattern(Texture texture, const TextureUse& use, const Normalisation& normalisation,
                                 std::vector<Corners> corners, const AreaLight& light,
                                 const PictureBrightness* brightness)
    : texture_(std::move(texture)), use_(use), normalisation_(normalisation), corners_(std::move(corners)) {
  LV_CHECK(corners_.size() == light.triangles.size(), "texture coordinates of {} triangles for {}",
           corners_.size(), light.triangles.size());
  for (std::size_t i = 1; i < light.triangles.size(); ++i) {
    if (light.triangles[i].area > light.triangles[widest_].area) widest_ = i;
  }
  if (!light.polygon.empty()) {
    least_ = greatest_ = corners_.front().front();
    for (const Corners& triangle : corners_) {
      for (const Vec2& uv : triangle) {
        least_ = glm::min(least_, uv);
        greatest_ = glm::max(greatest_, uv);
      }
    }
  }
  if (brightness == nullptr) return;
  const auto scale = static_cast<float>(use.scale);
  for (const Corners& c : corners_)
    brightness_.push_back(brightness->meanWithin(Corners{c[0] / scale, c[1] / scale, c[2] / scale}));
  // Round shapes show all of the coordinates from 0 to 1.
  const double ofAll = brightness->meanWithin(std::array{Vec2(0.0f), Vec2(1.0f / scale)});
  brightness_.resize(light.pieceCount(), ofAll);
}

bool EmissionPattern::isBlackWithin(const Corners& c, const TextureUse& use,
                                    const PictureBrightness& brightness) {
  const auto scale = static_cast<float>(use.scale);
  return brightness.meanWithin(Corners{c[0] / scale, c[1] / scale, c[2] / scale}) == 0.0;
}

Rgb EmissionPattern::colorAt(const AreaLight& light, std::size_t piece, const Vec3d& position) const {
  const Vec2 uv = texture_.usesUv() ? uvAt(light, piece, position) : Vec2(0.0f);
  return placedColor(texture_, use_, normalisation_, Vec3(position), uv);
}

Vec2 EmissionPattern::uvAt(const AreaLight& light, std::size_t piece, const Vec3d& position) const {
  // The coordinates of a planar polygon are one affine map, which the widest triangle tells best.
  if (!light.polygon.empty()) return glm::clamp(uvOfTriangle(light, widest_, position), least_, greatest_);
  if (piece < light.triangles.size()) return uvOfTriangle(light, piece, position);
  piece -= light.triangles.size();
  if (piece < light.spheres.size())
    return sphereUv(Vec3(glm::normalize(position - Vec3d(light.spheres[piece].center))));
  const EmitterDisc& disc = light.discs[piece - light.spheres.size()];
  return discUv(disc.center, disc.normal, disc.radius, Vec3(position));
}

Vec2 EmissionPattern::uvOfTriangle(const AreaLight& light, std::size_t triangle,
                                   const Vec3d& position) const {
  const EmitterTriangle& t = light.triangles[triangle];
  const Corners& uvs = corners_[triangle];
  const Vec3d from = position - Vec3d(t.a);
  const Vec3d toB = Vec3d(t.b) - Vec3d(t.a);
  const Vec3d toC = Vec3d(t.c) - Vec3d(t.a);
  const Vec3d normal = glm::cross(toB, toC);
  const double square = glm::dot(normal, normal);
  if (!(square > 0.0)) return uvs[0];
  double ofB = glm::dot(glm::cross(from, toC), normal) / square;
  double ofC = glm::dot(glm::cross(toB, from), normal) / square;
  if (light.polygon.empty()) {
    ofB = std::clamp(ofB, 0.0, 1.0);
    ofC = std::clamp(ofC, 0.0, 1.0 - ofB);
  }
  return {(1.0 - ofB - ofC) * Vec2d(uvs[0]) + ofB * Vec2d(uvs[1]) + ofC * Vec2d(uvs[2])};
}

Rgb EmissionPattern::meanColor(const AreaLight& light) const {
  constexpr double kPlaces = 4096.0;
  Vec3d sum(0.0);
  double total = 0.0;
  std::size_t place = 0;
  std::size_t piece = 0;
  const auto add = [&](const auto& shape, double area) {
    const double share = light.totalArea > 0.0 ? area / light.totalArea : 0.0;
    const int count = std::max(1, static_cast<int>(std::ceil(kPlaces * share)));
    for (int i = 0; i < count; ++i)
      sum += area / count * Vec3d(colorAt(light, piece, placeOn(shape, evenPlace(place++))));
    total += area;
    ++piece;
  };
  for (const EmitterTriangle& t : light.triangles) add(t, t.area);
  for (const EmitterSphere& s : light.spheres) add(s, 4.0 * kPiD * square(double(s.radius)));
  for (const EmitterDisc& d : light.discs) add(d, kPiD * square(double(d.radius)));
  return total > 0.0 ? Rgb(sum / total) : Rgb(0.0f);
}

}  // namespace lightvane
