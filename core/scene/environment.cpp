#include "core/scene/environment.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace lightvane {
namespace {

/// The part of the samples that go by the map where the normal is known.
constexpr float kMapShare = 0.5f;

// A surface's half of a sphere sees at most this much of a radiance of 1.
constexpr float kHemisphere = kPi;

/// u, which lies in [from, from + width), stretched to [0, 1).
float stretched(float u, float from, float width) {
  constexpr float kBelowOne = 0x1.fffffep-1f;
  return std::clamp((u - from) / width, 0.0f, kBelowOne);
}

/// The entry of a cumulative distribution that `u` falls into, and where in it.
std::size_t choose(const float* cdf, std::size_t count, float& u) {
  const float* found = std::upper_bound(cdf, cdf + count, u);
  const std::size_t entry = std::min(static_cast<std::size_t>(found - cdf), count - 1);
  const float below = entry > 0 ? cdf[entry - 1] : 0.0f;
  u = cdf[entry] > below ? stretched(u, below, cdf[entry] - below) : 0.5f;
  return entry;
}

void makeCumulative(const std::vector<double>& weights, float* cdf) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    cdf[i] = total > 0.0 ? static_cast<float>(sum / total)
                         : static_cast<float>(i + 1) / static_cast<float>(weights.size());
  }
  cdf[weights.size() - 1] = 1.0f;
}

std::array<float, 4> brightnessOf(const std::array<Rgb, 4>& corners) {
  return {maxComponent(corners[0]), maxComponent(corners[1]), maxComponent(corners[2]),
          maxComponent(corners[3])};
}

double meanOf(const std::array<float, 4>& corners) {
  double sum = 0.0;
  for (const float corner : corners) sum += static_cast<double>(corner);
  return 0.25 * sum;
}

/// A place in [0, 1] with a density that goes linearly from `f0` to `f1`, in any unit; by u where both are 0.
float sampleLinear(float f0, float f1, float u) {
  const float root = std::sqrt(f0 * f0 * (1.0f - u) + f1 * f1 * u);
  return f0 + root > 0.0f ? std::min(u * (f0 + f1) / (f0 + root), 1.0f) : u;
}

Vec3 uniformOnSphere(const Vec2& u) {
  const float y = 1.0f - 2.0f * u.x;
  const float s = std::sqrt(std::max(0.0f, 1.0f - y * y));
  return {s * std::cos(kTwoPi * u.y), y, s * std::sin(kTwoPi * u.y)};
}

}  // namespace

EnvironmentMap::EnvironmentMap(ImageRgb picture, LoadWatch& watch) : picture_(std::move(picture)) {
  const int width = picture_.width();
  const int height = picture_.height();
  LV_CHECK(!picture_.empty(), "an environment of {} x {} pixels", width, height);
  const auto cells = static_cast<std::size_t>(cellRows());
  cosines_.push_back(1.0);
  for (int row = 0; row < height; ++row) cosines_.push_back(std::cos(kPiD / height * (row + 0.5)));
  cosines_.push_back(-1.0);
  rowCdf_.resize(cells);
  columnCdf_.resize(cells * static_cast<std::size_t>(width));
  std::vector<double> rows(cells);
  std::vector<double> columns(static_cast<std::size_t>(width));
  glm::dvec3 total(0.0);
  glm::dvec3 totalBound(0.0);
  for (int row = 0; row < cellRows(); ++row) {
    watch.look(static_cast<double>(row) / cellRows());
    const double solidAngle = cellSolidAngle(static_cast<std::size_t>(row));
    double sum = 0.0;
    for (int column = 0; column < width; ++column) {
      const std::array<Rgb, 4> c = cornersOf(column, row);
      const Rgb most = glm::max(glm::max(c[0], c[1]), glm::max(c[2], c[3]));
      const glm::dvec3 mean =
          0.25 * (glm::dvec3(c[0]) + glm::dvec3(c[1]) + glm::dvec3(c[2]) + glm::dvec3(c[3]));
      columns[static_cast<std::size_t>(column)] = meanOf(brightnessOf(c)) * solidAngle;
      sum += columns[static_cast<std::size_t>(column)];
      total += mean * solidAngle;
      totalBound += glm::dvec3(most) * solidAngle;
      brightest_ = std::max(brightest_, maxComponent(most));
    }
    rows[static_cast<std::size_t>(row)] = sum;
    makeCumulative(columns, &columnCdf_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width)]);
  }
  makeCumulative(rows, rowCdf_.data());
  total_ = Rgb(total);
  totalBound_ = Rgb(totalBound * (1.0 + 1e-6));
}

std::array<Rgb, 4> EnvironmentMap::cornersOf(int column, int row) const {
  const int right = (column + 1) % picture_.width();
  const int above = std::max(row - 1, 0);
  const int below = std::min(row, picture_.height() - 1);
  return {picture_.at(column, above), picture_.at(right, above), picture_.at(column, below),
          picture_.at(right, below)};
}

double EnvironmentMap::cellSolidAngle(std::size_t row) const {
  return 2.0 * kPiD / picture_.width() * (cosines_[row] - cosines_[row + 1]);
}

EnvironmentMap::Cell EnvironmentMap::cellOf(const Vec3& local) const {
  const Vec2 place = placeOf(local) - 0.5f;
  const float left = std::floor(place.x);
  const float top = std::floor(place.y);
  const int width = picture_.width();
  return {(static_cast<int>(left) + width) % width, std::clamp(static_cast<int>(top) + 1, 0, cellRows() - 1),
          place.x - left, place.y - top};
}

Rgb EnvironmentMap::radiance(const Vec3& local) const {
  const auto [column, row, right, down] = cellOf(local);
  const std::array<Rgb, 4> c = cornersOf(column, row);
  return (1.0f - down) * ((1.0f - right) * c[0] + right * c[1]) +
         down * ((1.0f - right) * c[2] + right * c[3]);
}

Vec3 EnvironmentMap::sample(const Vec2& u) const {
  Vec2 v = u;
  const std::size_t row = choose(rowCdf_.data(), rowCdf_.size(), v.y);
  const auto width = static_cast<std::size_t>(picture_.width());
  const std::size_t column = choose(&columnCdf_[row * width], width, v.x);
  // Bilinear over the cell, whose height is measured by the cosine.
  const std::array<float, 4> f = brightnessOf(cornersOf(static_cast<int>(column), static_cast<int>(row)));
  const float down = sampleLinear(f[0] + f[1], f[2] + f[3], v.y);
  const float right = sampleLinear(glm::mix(f[0], f[2], down), glm::mix(f[1], f[3], down), v.x);
  const double y = cosines_[row] + (cosines_[row + 1] - cosines_[row]) * static_cast<double>(down);
  const double s = std::sqrt(std::max(0.0, 1.0 - y * y));
  const double longitude =
      2.0 * kPiD *
      ((static_cast<double>(column) + 0.5 + static_cast<double>(right)) / picture_.width() - 0.5);
  return {static_cast<float>(s * std::sin(longitude)), static_cast<float>(y),
          static_cast<float>(-s * std::cos(longitude))};
}

Vec2 EnvironmentMap::placeOf(const Vec3& local) const {
  const float u = 0.5f + std::atan2(local.x, -local.z) * (0.5f * kInvPi);
  const float v = std::acos(std::clamp(local.y, -1.0f, 1.0f)) * kInvPi;
  return {u * static_cast<float>(picture_.width()), v * static_cast<float>(picture_.height())};
}

float EnvironmentMap::pdf(const Vec3& local) const {
  if (!(brightest_ > 0.0f)) return 0.0f;
  const Cell cell = cellOf(local);
  const auto r = static_cast<std::size_t>(cell.row);
  const std::size_t c =
      r * static_cast<std::size_t>(picture_.width()) + static_cast<std::size_t>(cell.column);
  const float ofRow = rowCdf_[r] - (cell.row > 0 ? rowCdf_[r - 1] : 0.0f);
  const float ofColumn = columnCdf_[c] - (cell.column > 0 ? columnCdf_[c - 1] : 0.0f);
  const std::array<float, 4> f = brightnessOf(cornersOf(cell.column, cell.row));
  const double mean = meanOf(f);
  if (!(mean > 0.0)) return 0.0f;
  const double height = cosines_[r] - cosines_[r + 1];
  const auto down =
      static_cast<float>(std::clamp((cosines_[r] - static_cast<double>(local.y)) / height, 0.0, 1.0));
  const float value = glm::mix(glm::mix(f[0], f[2], down), glm::mix(f[1], f[3], down), cell.right);
  return static_cast<float>(static_cast<double>(ofRow) * static_cast<double>(ofColumn) / cellSolidAngle(r) *
                            static_cast<double>(value) / mean);
}

Rgb EnvironmentLight::radianceFrom(const Vec3& direction) const {
  return map ? radiance * map->radiance(frame.toLocal(direction)) : radiance;
}

Vec3 EnvironmentLight::sample(const Vec2& u, const Vec3& normal) const {
  const bool hasNormal = normal != Vec3(0.0f);
  const float mapShare = !map ? 0.0f : hasNormal ? kMapShare : 1.0f;
  if (u.x < mapShare)
    return glm::normalize(frame.toWorld(map->sample({stretched(u.x, 0.0f, mapShare), u.y})));
  const Vec2 rest(stretched(u.x, mapShare, 1.0f - mapShare), u.y);
  if (!hasNormal) return uniformOnSphere(rest);
  return glm::normalize(Frame::aboutNormal(normal).toWorld(sampleCosine(rest)));
}

float EnvironmentLight::pdf(const Vec3& direction, const Vec3& normal) const {
  const bool hasNormal = normal != Vec3(0.0f);
  const float mapShare = !map ? 0.0f : hasNormal ? kMapShare : 1.0f;
  float density = 0.0f;
  if (mapShare > 0.0f) density += mapShare * map->pdf(frame.toLocal(direction));
  if (mapShare < 1.0f)
    density += (1.0f - mapShare) *
               (hasNormal ? kInvPi * std::max(0.0f, glm::dot(direction, normal)) : 0.25f * kInvPi);
  return density;
}

Rgb EnvironmentLight::total() const { return radiance * (map ? map->total() : Rgb(4.0f * kPi)); }

Rgb EnvironmentLight::irradianceBound() const {
  const Rgb most = map ? glm::min(map->totalBound(), Rgb(kHemisphere * map->brightest())) : Rgb(kHemisphere);
  return radiance * most;
}

Frame environmentFrame(const Vec3d& up, double rotateDegrees) {
  const Vec3d y = glm::normalize(up);
  // The shortest turn takes the world's y there; straight down, the turn is about x.
  Vec3d x(1.0, 0.0, 0.0);
  if (y.y > -1.0 + 1e-12) {
    const Vec3d half = Vec3d(0.0, 1.0, 0.0) + y;
    const Vec3d h = half / glm::length(half);
    // Two reflections are a turn: in the plane across the old y, which leaves x alone, and in that across h.
    x = glm::normalize(x - 2.0 * glm::dot(x, h) * h);
  }
  const Vec3d z = glm::cross(x, y);
  const double angle = rotateDegrees * kPiD / 180.0;
  const Vec3d turnedX = std::cos(angle) * x - std::sin(angle) * z;
  return {Vec3(turnedX), Vec3(y), Vec3(glm::cross(turnedX, y))};
}

}  // namespace lightvane
