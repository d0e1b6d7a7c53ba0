#include "core/scene/schlick.h"

#include <array>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Points along each of the two dimensions of the albedo's quadrature, and what the table is raised by so that
// neither the quadrature nor the interpolation lets the albedo pass 1 + 1e-3
// (tests/scene/brdf_energy_test.cpp measures it).
constexpr int kQuadrature = 48;
constexpr float kTableMargin = 1.001f;

}  // namespace

SchlickLayer::SchlickLayer(const LayerDescription& description) {
  LV_CHECK(description.roughness >= 0.0 && description.roughness <= 1.0, "roughness {}",
           description.roughness);
  LV_CHECK(description.isotropy >= 0.0 && description.isotropy <= 1.0, "isotropy {}", description.isotropy);
  roughness_ = static_cast<float>(description.roughness);
  if (roughness_ < kSmallestRoughness) roughness_ = 0.0f;
  isotropy_ = std::max(static_cast<float>(description.isotropy), kSmallestIsotropy);
  // 1 - b = 1 - 4r(1 - r), without the cancellation.
  const float rest = square(1.0f - 2.0f * roughness_);
  glossy_ = 4.0f * roughness_ * (1.0f - roughness_);
  lambert_ = roughness_ < 0.5f ? 0.0f : rest;
  dirac_ = roughness_ < 0.5f ? rest : 0.0f;
}

Vec3 SchlickLayer::sampleHalfVector(const Vec2& u) const {
  // Schlick's t = sqrt(x / (r - x r + x)) for x = 1 - u.x, as a tangent.
  const float tangent2 = roughness_ * u.x / (1.0f - u.x);
  const float t = 1.0f / std::sqrt(1.0f + tangent2);
  const float sine = std::sqrt(tangent2) * t;
  if (isotropy_ == 1.0f) return {sine * std::cos(kTwoPi * u.y), sine * std::sin(kTwoPi * u.y), t};
  const bool uniform = u.y < 0.5f;
  const float angle = kTwoPi * (uniform ? 2.0f * u.y : 2.0f * u.y - 1.0f);
  const float y = std::cos(angle);
  const float x = std::sin(angle) * (uniform ? 1.0f : isotropy_);
  const float toUnit = 1.0f / std::sqrt(x * x + y * y);
  return {sine * x * toUnit, sine * y * toUnit, t};
}

LayerMoments SchlickLayer::glossyMoments(const Vec3& outgoing) const {
  // In half vectors with the density of sampleHalfVector, Z cancels:
  // R = (G(v)/v) * mean of [ u/t G(v') A / ((1 + A^2)/2) ], weighted by F^k.
  // The slope's random number runs as 3x^2 - 2x^3, which takes the square-root poles at both of its ends
  // away.
  const double r = roughness_;
  const double p = isotropy_;
  const double v = outgoing.z;
  struct Slope {
    double tangent, t, weight;
  };
  std::array<Slope, kQuadrature> slopes;
  for (int i = 0; i < kQuadrature; ++i) {
    const double x = (i + 0.5) / kQuadrature;
    const double tangent2 = r * x * x * (3.0 - 2.0 * x) / ((1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x));
    slopes[static_cast<std::size_t>(i)] = {std::sqrt(tangent2), 1.0 / std::sqrt(1.0 + tangent2),
                                           6.0 * x * (1.0 - x)};
  }
  // Uniform azimuths first, then, for p < 1, those of A^2.
  const int azimuths = isotropy_ < 1.0f ? 2 * kQuadrature : kQuadrature;
  LayerMoments sum{};
  for (int j = 0; j < azimuths; ++j) {
    const double angle = 2.0 * kPiD * (j % kQuadrature + 0.5) / kQuadrature;
    const double y = std::cos(angle);
    const double x = std::sin(angle) * (j < kQuadrature ? 1.0 : p);
    const double horizontal2 = x * x + y * y;
    const double a2 = p * horizontal2 / (p * p * y * y + x * x);
    const double azimuthWeight = 2.0 * std::sqrt(a2) / (1.0 + a2);
    const double along = (outgoing.x * x + outgoing.y * y) / std::sqrt(horizontal2);
    for (const Slope& slope : slopes) {
      const double uOverT = v + along * slope.tangent;
      const double u = std::min(uOverT * slope.t, 1.0);
      const double mirrored = 2.0 * u * slope.t - v;
      if (u <= 0.0 || mirrored <= 0.0) continue;
      const double f = square(square(1.0 - u)) * (1.0 - u);
      const double term = uOverT * mirrored / (r + (1.0 - r) * mirrored) * azimuthWeight * slope.weight;
      sum[0] += term;
      sum[1] += term * f;
      sum[2] += term * f * f;
    }
  }
  const double scale = 1.0 / ((r + (1.0 - r) * v) * azimuths * kQuadrature);
  return {sum[0] * scale, sum[1] * scale, sum[2] * scale};
}

void SchlickLayer::limitEnergy() {
  if (!hasGlossy()) return;
  using Table = DirectionTable<float>;
  Table table(isAnisotropic() ? Table::kAnisotropicRows : 1);
  int lastAbove = -1;
  for (int row = 0; row < table.rows(); ++row) {
    for (int cosine = 0; cosine < Table::kCosines; ++cosine) {
      const Vec3 direction = Table::nodeDirection(table.rows(), row, cosine);
      const float albedo = kTableMargin * static_cast<float>(glossyMoments(direction)[0]);
      table.node(row, cosine) = albedo * shadow(direction.z);
      if (albedo > 1.0f) lastAbove = std::max(lastAbove, cosine);
    }
  }
  if (lastAbove < 0) return;
  excessBelow_ = Table::nodeCosine(std::min(lastAbove + 1, Table::kCosines - 1));
  excess_ = std::move(table);
}

float SchlickLayer::halfWidth() const {
  if (!hasGlossy()) return 0.5f * kPi;
  // Across the lobe, A falls to half its peak within an azimuth whose sine is sqrt(3) p / sqrt(1 - p^2).
  const float p2 = isotropy_ * isotropy_;
  const float across = 4.0f * p2 < 1.0f ? std::sqrt(3.0f * p2 / (1.0f - p2)) : 1.0f;
  return halfPeakWidth(roughness_, across);
}

}  // namespace lightvane
