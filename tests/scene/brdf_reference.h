#pragma once

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/scene/brdf.h"

namespace lightvane::reference {

// Schlick's formulas and those of GGX as printed, in double, and a quadrature over incoming directions:
// written apart from core/scene, for the tests to compare with.

/// A unit direction by its cosine with the normal and its azimuth from the tangent.
inline Vec3d direction(double cosine, double azimuth) {
  const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

inline MaterialDescription layered(const std::vector<LayerDescription>& layers) {
  MaterialDescription material;
  material.name = "layered";
  material.layers = layers;
  return material;
}
inline Brdf compileLayer(const Rgb& color, double roughness, double isotropy, EnergyRule rule) {
  return Brdf::compile(layered({{color, roughness, isotropy}}), rule);
}

inline LayerDescription ggx(const Rgb& color, double roughness) {
  return {color, roughness, 1.0, LayerModel::Ggx};
}

inline double diracShare(double r) { return r < 0.5 ? 1.0 - 4.0 * r * (1.0 - r) : 0.0; }
inline double lambertShare(double r) { return r < 0.5 ? 0.0 : 1.0 - 4.0 * r * (1.0 - r); }

/// S(u) of one colour component.
inline double colorFactor(double color, double u) { return color + (1.0 - color) * std::pow(1.0 - u, 5.0); }

/// One layer's lobe without S: a/pi + b G G' Z A / (4 pi v v').
inline double layerLobe(double r, double p, const Vec3d& incoming, const Vec3d& outgoing) {
  const Vec3d half = glm::normalize(incoming + outgoing);
  const double t = half.z;
  const double v = outgoing.z;
  const double vi = incoming.z;
  const double w = half.x / std::hypot(half.x, half.y);
  const double z = r / square(1.0 + r * t * t - t * t);
  const double a = p == 1.0 ? 1.0 : std::sqrt(p / (p * p - p * p * w * w + w * w));
  const auto g = [r](double cosine) { return cosine / (r - r * cosine + cosine); };
  const double b = 4.0 * r * (1.0 - r);
  return lambertShare(r) / kPiD + b * g(v) * g(vi) * z * a / (4.0 * kPiD * v * vi);
}

/// Walter et al. 2007, eq. 33, of a half vector of this cosine.
inline double ggxDistribution(double alpha, double cosine) {
  const double tangent2 = (1.0 - cosine) * (1.0 + cosine) / square(cosine);
  return square(alpha) / (kPiD * square(square(cosine)) * square(square(alpha) + tangent2));
}
/// Smith's Lambda, Heitz 2014, eq. 72: G1 = 1 / (1 + Lambda), G2 = 1 / (1 + Lambda + Lambda').
inline double ggxLambda(double alpha, double cosine) {
  const double tangent2 = (1.0 - cosine) * (1.0 + cosine) / square(cosine);
  return 0.5 * (std::sqrt(1.0 + square(alpha) * tangent2) - 1.0);
}
inline double ggxMasking(double alpha, double cosine) { return 1.0 / (1.0 + ggxLambda(alpha, cosine)); }
/// One GGX layer without S: D G2 / (4 v v').
inline double ggxLobe(double alpha, const Vec3d& incoming, const Vec3d& outgoing) {
  const double v = outgoing.z;
  const double vi = incoming.z;
  const double both = 1.0 / (1.0 + ggxLambda(alpha, v) + ggxLambda(alpha, vi));
  return ggxDistribution(alpha, glm::normalize(incoming + outgoing).z) * both / (4.0 * v * vi);
}

/// Directions may be swapped, but for the rounding of the same numbers multiplied in another order: a few
/// units in the last place.
inline void expectReciprocalLobe(const Brdf& brdf, const Vec3& a, const Vec3& b, const std::string& what) {
  const Rgb forward = brdf.lobeRgb(a, b);
  const Rgb backward = brdf.lobeRgb(b, a);
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(forward[channel], backward[channel], 1e-6f * forward[channel]) << what;
}

inline void expectNoLobeBelowTheHorizon(const Brdf& brdf) {
  const Vec3 up(direction(0.5, 0.3));
  const Vec3 down(0.6f, 0.0f, -0.8f);
  EXPECT_EQ(brdf.lobeRgb(down, up), Rgb(0.0f));
  EXPECT_EQ(brdf.lobeRgb(up, down), Rgb(0.0f));
  EXPECT_EQ(brdf.lobePdf(down, up), 0.0f);
  EXPECT_EQ(brdf.lobePdf(up, down), 0.0f);
}

/// A density proportional to which half vectors are laid out, per solid angle of the incoming direction.
inline double halfVectorDensity(double r, double p, const Vec3d& incoming, const Vec3d& outgoing) {
  const Vec3d sum = incoming + outgoing;
  const double length2 = glm::dot(sum, sum);
  const double x2 = sum.x * sum.x;
  const double y2 = sum.y * sum.y;
  const double z = r / square((x2 + y2 + r * sum.z * sum.z) / length2);
  const double a2 = x2 + y2 > 0.0 ? p * (x2 + y2) / (p * p * y2 + x2) : 1.0;
  return z * 0.5 * (1.0 + a2) / kPiD * sum.z / (2.0 * length2);
}

/// The integral of value(incoming) over the upper hemisphere, on grids of n x n points laid out by the cosine
/// and by each layer's half vectors, joined by the balance heuristic: follows peaks of any width.
template <class F>
double integrate(const std::vector<LayerDescription>& layers, const Vec3d& outgoing, int n, F value) {
  // What is so smooth or so narrow that the formulas have no such point is left to the cosine grid.
  std::vector<LayerDescription> peaks;
  for (const LayerDescription& layer : layers) {
    if (!(layer.roughness > 0.0 && layer.roughness < 1.0)) continue;
    peaks.push_back(layer);
    // The same peak under another name: r is alpha^2.
    if (layer.model == LayerModel::Ggx) peaks.back().roughness = square(square(layer.roughness));
  }
  for (LayerDescription& peak : peaks) peak.isotropy = std::max(peak.isotropy, 1e-4);
  const auto density = [&](const Vec3d& incoming) {
    double sum = incoming.z / kPiD;
    for (const LayerDescription& peak : peaks) {
      sum += halfVectorDensity(peak.roughness, peak.isotropy, incoming, outgoing);
    }
    return sum;
  };
  double sum = 0.0;
  const auto add = [&](const Vec3d& incoming, double weight) {
    if (incoming.z > 0.0) sum += weight * value(incoming) / density(incoming);
  };
  const double perPoint = 1.0 / (static_cast<double>(n) * n);
  for (int j = 0; j < n; ++j) {
    const double angle = 2.0 * kPiD * (j + 0.5) / n;
    for (int i = 0; i < n; ++i) {
      // Denser at both ends, where roots have their poles.
      const double x = (i + 0.5) / n;
      const double random = x * x * (3.0 - 2.0 * x);
      const double rest = (1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x);
      const double weight = perPoint * 6.0 * x * (1.0 - x);
      add({std::sqrt(random) * std::cos(angle), std::sqrt(random) * std::sin(angle), std::sqrt(rest)},
          weight);
      for (const LayerDescription& peak : peaks) {
        const double tangent = std::sqrt(peak.roughness * random / rest);
        const double t = 1.0 / std::sqrt(1.0 + tangent * tangent);
        const bool anisotropic = peak.isotropy < 1.0;
        for (const double squeeze : {1.0, peak.isotropy}) {
          const double hx = std::sin(angle) * squeeze;
          const double hy = std::cos(angle);
          const Vec3d half = Vec3d(tangent * Vec3d(hx, hy, 0.0) / std::hypot(hx, hy) + Vec3d(0, 0, 1)) * t;
          const double u = glm::dot(half, outgoing);
          if (u > 0.0) add(2.0 * u * half - outgoing, anisotropic ? 0.5 * weight : weight);
          if (!anisotropic) break;
        }
      }
    }
  }
  return sum;
}

/// The albedo of `brdf`'s lobe in one channel, by the quadrature above.
inline double lobeAlbedo(const Brdf& brdf, const std::vector<LayerDescription>& layers, const Vec3d& outgoing,
                         int channel, int n = 48) {
  return integrate(layers, outgoing, n, [&](const Vec3d& incoming) {
    return static_cast<double>(brdf.lobeRgb(Vec3(incoming), Vec3(outgoing))[channel]) * incoming.z;
  });
}

/// The weight of the reflected specular branch; 0 where there is none.
inline Rgb reflectedWeight(const Brdf& brdf, const Vec3d& outgoing, bool entering = true) {
  std::array<SpecularBranch, 2> branches;
  const int count = brdf.specularBranches(Vec3(outgoing), entering, {}, branches);
  return count > 0 && !branches[0].transmitted ? branches[0].weight : Rgb(0.0f);
}

}  // namespace lightvane::reference
