#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/random.h"
#include "core/scene/lights.h"

namespace lightvane::lights_test {

inline EmitterTriangle emitterTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 cross = glm::cross(b - a, c - a);
  const float length = glm::length(cross);
  return {a, b, c, length > 0.0f ? cross / length : Vec3(0, 0, 1), 0.5f * length};
}

inline AreaLight polygonLight(const std::vector<Vec3>& corners, bool twoSided = false) {
  AreaLight light;
  light.radiance = Rgb(1.0f);
  light.twoSided = twoSided;
  light.polygon = corners;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    light.triangles.push_back(emitterTriangle(corners[0], corners[i - 1], corners[i]));
  }
  light.finish();
  return light;
}

inline AreaLight triangleLight(const std::vector<EmitterTriangle>& triangles, bool twoSided = false) {
  AreaLight light;
  light.radiance = Rgb(1.0f);
  light.twoSided = twoSided;
  light.triangles = triangles;
  light.finish();
  return light;
}

inline AreaLight sphereLight(const Vec3& center, float radius, bool twoSided = false) {
  AreaLight light;
  light.radiance = Rgb(1.0f);
  light.twoSided = twoSided;
  light.spheres.push_back({center, radius});
  light.finish();
  return light;
}

inline AreaLight discLight(const Vec3& center, const Vec3& normal, float radius, bool twoSided = false) {
  AreaLight light;
  light.radiance = Rgb(1.0f);
  light.twoSided = twoSided;
  light.discs.push_back({center, glm::normalize(normal), radius});
  light.finish();
  return light;
}

/// Facing down (0, -1, 0) at height `y`.
inline AreaLight ceilingLight(float x0, float x1, float z0, float z1, float y) {
  return polygonLight({{x0, y, z0}, {x1, y, z0}, {x1, y, z1}, {x0, y, z1}});
}

/// A regular polygon facing down at height `y` above the origin.
inline AreaLight regularCeilingLight(int corners, float circumradius, float y) {
  std::vector<Vec3> outline;
  for (int i = 0; i < corners; ++i) {
    const float angle = kTwoPi * static_cast<float>(i) / static_cast<float>(corners);
    outline.emplace_back(circumradius * std::cos(angle), y, circumradius * std::sin(angle));
  }
  return polygonLight(outline);
}

/// The icosahedron with circumradius `radius`: 20 triangles, more than LightSampler prepares.
inline std::vector<EmitterTriangle> icosahedron(const Vec3& center, float radius) {
  const float g = 0.5f * (1.0f + std::sqrt(5.0f));
  std::vector<Vec3> v = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                         {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : v) p = center + glm::normalize(p) * radius;
  constexpr int kFaces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  std::vector<EmitterTriangle> triangles;
  for (const auto& f : kFaces) {
    triangles.push_back(emitterTriangle(v[std::size_t(f[0])], v[std::size_t(f[1])], v[std::size_t(f[2])]));
  }
  return triangles;
}

struct Estimate {
  double mean = 0.0;
  double standardError =
      0.0;  ///< of independent samples; stratified ones are better, so that it is an upper bound
};

/// f over side x side jittered strata of the unit square.
template <class F>
Estimate integrate(int side, std::uint32_t seed, const F& f) {
  double sum = 0.0;
  double sumOfSquares = 0.0;
  const RandomKey key = randomKey(seed);
  for (int i = 0; i < side * side; ++i) {
    const Vec2 jitter = uniform2(key, static_cast<std::uint32_t>(i), 0);
    // Below 1 even where the sum rounds up.
    const Vec2 u =
        glm::min((Vec2(i % side, i / side) + jitter) / static_cast<float>(side), Vec2(1.0f - 0x1p-24f));
    const double value = f(u);
    sum += value;
    sumOfSquares += value * value;
  }
  const double count = side * side;
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, sumOfSquares / count - mean * mean) / count)};
}

/// Calls f with `count` independent points of the unit square: for chi-square, whose confidence strata would
/// falsify.
template <class F>
void forIndependentSamples(int count, std::uint32_t seed, const F& f) {
  const RandomKey key = randomKey(seed);
  for (int i = 0; i < count; ++i) f(uniform2(key, static_cast<std::uint32_t>(i), 0));
}

/// Irradiance (first colour component) at a surface with `normal`, nothing in between.
inline Estimate irradiance(const Light& light, const Vec3& point, const Vec3& normal, int side = 128,
                           std::uint32_t seed = 1) {
  const LightSampler sampler(light, point);
  return integrate(side, seed, [&](const Vec2& u) {
    LightSample sample;
    if (!sampler.sample(u, sample)) return 0.0;
    return double(sample.weight.x) * std::max(0.0, double(glm::dot(sample.direction, normal)));
  });
}

/// Six standard errors (a false alarm in 5e8 if samples were independent) and the rounding of float weights.
inline double tolerance(const Estimate& estimate) {
  return 6.0 * estimate.standardError + 1e-6 * std::abs(estimate.mean);
}

/// van Oosterom and Strackee's formula as printed, in long double; positive where a, b, c run clockwise as
/// seen from the origin.
inline long double referenceSolidAngle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  using V = glm::tvec3<long double>;
  const V A(a), B(b), C(c);
  const long double la = glm::length(A), lb = glm::length(B), lc = glm::length(C);
  const long double numerator = glm::dot(A, glm::cross(B, C));
  const long double denominator =
      la * lb * lc + glm::dot(A, B) * lc + glm::dot(B, C) * la + glm::dot(C, A) * lb;
  return 2.0L * std::atan2(numerator, denominator);
}

/// Irradiance of a polygon of radiance 1 that lies wholly above the horizon, J. H. Lambert, Photometria
/// (1760): half the sum of the sides' angles times the cosine between the normal and that of the plane
/// through side and point.
inline double lambertIrradiance(const std::vector<Vec3>& corners, const Vec3& point, const Vec3& normal) {
  double sum = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = Vec3d(corners[i]) - Vec3d(point);
    const Vec3d b = Vec3d(corners[(i + 1) % corners.size()]) - Vec3d(point);
    const Vec3d cross = glm::cross(a, b);
    const double length = glm::length(cross);
    if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(cross / length, Vec3d(normal));
  }
  return 0.5 * std::abs(sum);
}

/// How surprising counts are against expectations: chi-square turned into standard deviations of a normal
/// variable by Wilson and Hilferty's cube root. Cells expected fewer than 5 times are pooled.
class ChiSquare {
 public:
  void add(double count, double expected) {
    if (expected < 5.0) {
      pooledCount_ += count;
      pooledExpected_ += expected;
      return;
    }
    addCell(count, expected);
  }
  double sigmas() {
    if (pooledExpected_ >= 5.0) addCell(pooledCount_, pooledExpected_);
    const double k = cells_ - 1;
    const double spread = 2.0 / (9.0 * k);
    return (std::cbrt(sum_ / k) - (1.0 - spread)) / std::sqrt(spread);
  }
  int cells() const { return cells_; }

 private:
  void addCell(double count, double expected) {
    sum_ += (count - expected) * (count - expected) / expected;
    ++cells_;
  }
  double sum_ = 0.0, pooledCount_ = 0.0, pooledExpected_ = 0.0;
  int cells_ = 0;
};

/// A right density fails once in 3e6 seeds; the seeds are fixed, so a test that passes keeps passing.
inline constexpr double kChiSquareSigmas = 5.0;

}  // namespace lightvane::lights_test
