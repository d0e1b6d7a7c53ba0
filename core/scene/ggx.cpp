#include "core/scene/ggx.h"

#include <array>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Points of the albedo's quadrature along the height of a cap and along half its azimuth, and of the mean
// over all directions. Measured from alpha = 1e-4 to 1 and cosines from 1e-6 to 1, moments are within 7e-4 of
// those of 320 x 192 points; with half the heights within 2.2e-3, for 0.8 ms a material instead of 1.4.
constexpr int kHeights = 80;
constexpr int kAzimuths = 24;
constexpr int kCosines = 32;

/// The middle of part i of n of [0, 1], and its width. Parts are narrower at both ends, where roots have
/// their poles: x runs evenly, 3x^2 - 2x^3 does not.
struct Part {
  double middle, width;
};
Part part(int i, int n) {
  const auto at = [n](double index) {
    const double x = index / n;
    return x * x * (3.0 - 2.0 * x);
  };
  return {at(i + 0.5), at(i + 1.0) - at(i)};
}

LayerMoments mirrorMoments(double cosine) {
  const double f = square(square(1.0 - cosine)) * (1.0 - cosine);
  return {1.0, f, f * f};
}

}  // namespace

GgxLayer::GgxLayer(const LayerDescription& description) {
  LV_CHECK(description.roughness >= 0.0 && description.roughness <= 1.0, "roughness {}",
           description.roughness);
  alpha_ = static_cast<float>(square(description.roughness));
  if (alpha_ < kSmallestAlpha) alpha_ = 0.0f;
  alpha2_ = alpha_ * alpha_;
}

Vec3 GgxLayer::sampleHalfVector(const Vec3& outgoing, const Vec2& u) const {
  // Stretched by 1 / alpha across the normal, facets are a hemisphere; those of it that are seen mirror the
  // view evenly into the cap above -v. The vector there and the view add up to the normal.
  const Vec3 view = glm::normalize(Vec3(alpha_ * outgoing.x, alpha_ * outgoing.y, outgoing.z));
  const float below = u.x * (1.0f + view.z);  // of the cap's vector under its top
  const float radius = std::sqrt(std::max(0.0f, below * (2.0f - below)));
  const float angle = kTwoPi * u.y;
  return glm::normalize(Vec3(alpha_ * (view.x + radius * std::cos(angle)),
                             alpha_ * (view.y + radius * std::sin(angle)), (1.0f - u.x) * (1.0f + view.z)));
}

LayerMoments GgxLayer::moments(double cosine) const {
  if (isMirror()) return mirrorMoments(cosine);
  // The mean over visible normals of G2 / G1(v) = v' (v + root(v)) / (v' root(v) + v root(v')), weighted by
  // F^k: as sampleHalfVector draws them.
  const double alpha = alpha_;
  const double alpha2 = alpha * alpha;
  const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
  const auto root = [alpha2](double c) { return std::sqrt(alpha2 + (1.0 - alpha2) * c * c); };
  const double rootOfView = root(cosine);  // also the length of the stretched view
  const double viewX = alpha * sine / rootOfView;
  const double viewZ = cosine / rootOfView;
  std::array<double, kAzimuths> along;
  for (int j = 0; j < kAzimuths; ++j)
    along[static_cast<std::size_t>(j)] = std::cos(kPiD * (j + 0.5) / kAzimuths);
  LayerMoments sum{};
  for (int i = 0; i < kHeights; ++i) {
    const auto [height, weight] = part(i, kHeights);
    const double below = height * (1.0 + viewZ);
    const double radius2 = below * (2.0 - below);
    const double radius = std::sqrt(std::max(0.0, radius2));
    const double z = (1.0 - height) * (1.0 + viewZ);
    for (const double x : along) {
      const double slopeX = alpha * (viewX + radius * x);
      const double across2 = viewX * viewX + 2.0 * viewX * radius * x + radius2;
      const double toUnit2 = 1.0 / (alpha2 * across2 + z * z);
      const double uOverUnit = sine * slopeX + cosine * z;
      const double mirrored = 2.0 * uOverUnit * z * toUnit2 - cosine;
      if (!(mirrored > 0.0)) continue;
      const double u = std::min(uOverUnit * std::sqrt(toUnit2), 1.0);
      const double f = square(square(1.0 - u)) * (1.0 - u);
      const double term =
          weight * mirrored * (cosine + rootOfView) / (mirrored * rootOfView + cosine * root(mirrored));
      sum[0] += term;
      sum[1] += term * f;
      sum[2] += term * f * f;
    }
  }
  for (double& moment : sum) moment /= kAzimuths;
  return sum;
}

LayerMoments GgxLayer::meanMoments() const {
  LayerMoments sum{};
  for (int i = 0; i < kCosines; ++i) {
    const auto [cosine, weight] = part(i, kCosines);
    const LayerMoments there = moments(cosine);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += 2.0 * cosine * weight * there[k];
  }
  return sum;
}

}  // namespace lightvane
