#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/scene/brdf_reference.h"

namespace lightvane {
namespace {

using reference::direction;

struct SampledMaterial {
  const char* name;
  MaterialDescription material;
};

std::vector<SampledMaterial> sampledMaterials() {
  const auto material = [](const Rgb& diffuse, const std::vector<LayerDescription>& layers) {
    MaterialDescription description = reference::layered(layers);
    description.diffuse = diffuse;
    return description;
  };
  return {
      {"glossy", material(Rgb(0.0f), {{Rgb(0.5f), 0.05, 1.0}})},
      {"half rough", material(Rgb(0.0f), {{Rgb(0.5f), 0.5, 1.0}})},
      {"rough, with a cosine part", material(Rgb(0.0f), {{Rgb(0.3f), 0.8, 1.0}})},
      {"brushed", material(Rgb(0.0f), {{Rgb(0.9f), 0.2, 0.2}})},
      {"varnished", material(Rgb(0.0f), {{Rgb(0.04f), 0.05, 1.0}, {Rgb(0.45f, 0.3f, 0.18f), 0.9, 0.5}})},
      {"coated", material(Rgb(0.4f), {{Rgb(0.04f), 0.1, 1.0}})},
      {"facets", material(Rgb(0.0f), {reference::ggx(Rgb(0.5f), 0.4)})},
      {"rough facets", material(Rgb(0.0f), {reference::ggx(Rgb(0.9f), 1.0)})},
      {"facets over a base", material(Rgb(0.8f), {reference::ggx(Rgb(0.04f), 0.3)})},
      {"facets over wood",
       material(Rgb(0.0f), {reference::ggx(Rgb(0.04f), 0.3), {Rgb(0.45f, 0.3f, 0.18f), 0.9, 1.0}})},
      {"varnished facets", material(Rgb(0.0f), {{Rgb(0.04f), 0.1, 1.0}, reference::ggx(Rgb(0.9f), 0.6)})},
      {"plain", material(Rgb(0.4f), {})},
  };
}

// Chi-square of `count` samples against the density's integral over the cells of a grid in cosine and
// azimuth, lost samples being one more cell, as a number of standard deviations from its mean.
template <class Sample, class Pdf>
double chiSquareSigmas(Sample sample, Pdf pdf, int count) {
  constexpr int kCosines = 16;
  constexpr int kAzimuths = 32;
  constexpr int kPerCell = 16;  // points along each side of a cell, for its integral
  std::vector<int> counts(kCosines * kAzimuths + 1);
  for (int i = 0; i < count; ++i) {
    const Vec3 w = sample(uniform2(randomKey(17), static_cast<std::uint32_t>(i), 0));
    std::size_t cell = kCosines * kAzimuths;
    if (w.z > 0.0f) {
      const double turn = std::atan2(double{w.y}, double{w.x}) / (2.0 * kPiD) + 0.5;
      const int column = std::min(static_cast<int>(turn * kAzimuths), kAzimuths - 1);
      const int row = std::min(static_cast<int>(double{w.z} * kCosines), kCosines - 1);
      cell = static_cast<std::size_t>(row * kAzimuths + column);
    }
    ++counts[cell];
  }
  std::vector<double> expected(counts.size());
  double kept = 0.0;
  for (int row = 0; row < kCosines; ++row) {
    for (int column = 0; column < kAzimuths; ++column) {
      double sum = 0.0;
      for (int i = 0; i < kPerCell * kPerCell; ++i) {
        const double cosine = (row + (i / kPerCell + 0.5) / kPerCell) / kCosines;
        const double turn = (column + (i % kPerCell + 0.5) / kPerCell) / kAzimuths;
        sum += double{pdf(Vec3(direction(cosine, 2.0 * kPiD * (turn - 0.5))))};
      }
      const double probability = sum * 2.0 * kPiD / (kCosines * kAzimuths * kPerCell * kPerCell);
      expected[static_cast<std::size_t>(row * kAzimuths + column)] = probability * count;
      kept += probability;
    }
  }
  expected.back() = std::max(0.0, 1.0 - kept) * count;

  // Cells that expect fewer than 10 samples are pooled: chi-square is for normal counts.
  double chiSquare = 0.0;
  double freedom = -1.0;
  double pooledExpected = 0.0;
  double pooledCount = 0.0;
  const auto add = [&](double seen, double wanted) {
    chiSquare += (seen - wanted) * (seen - wanted) / wanted;
    freedom += 1.0;
  };
  for (std::size_t cell = 0; cell < counts.size(); ++cell) {
    if (expected[cell] >= 10.0) {
      add(counts[cell], expected[cell]);
    } else {
      pooledExpected += expected[cell];
      pooledCount += counts[cell];
    }
  }
  if (pooledExpected >= 10.0) add(pooledCount, pooledExpected);
  return (chiSquare - freedom) / std::sqrt(2.0 * freedom);
}

// Five sigma: with up to 500 degrees of freedom the statistic is close enough to normal that a right sampler
// fails once in about 1e6 runs, and the random numbers are fixed anyway.
constexpr double kSigmas = 5.0;
constexpr int kLobeSamples = 60000;
constexpr std::array kViews = {0.95, 0.5, 0.1};

TEST(BrdfSampling, LobeFollowsItsDensity) {
  for (const auto& [name, material] : sampledMaterials()) {
    if (material.layers.empty()) continue;
    const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
    for (const double cosine : kViews) {
      const Vec3 outgoing(direction(cosine, 0.6));
      const double sigmas =
          chiSquareSigmas([&](const Vec2& u) { return brdf.sampleLobe(outgoing, u); },
                          [&](const Vec3& w) { return brdf.lobePdf(w, outgoing); }, kLobeSamples);
      EXPECT_LT(std::abs(sigmas), kSigmas) << name << " at cos " << cosine;
    }
  }
}

TEST(BrdfSampling, WholeFollowsItsDensity) {
  for (const auto& [name, material] : sampledMaterials()) {
    if (isBlack(material.diffuse)) continue;
    const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
    for (const double cosine : kViews) {
      const Vec3 outgoing(direction(cosine, 0.6));
      const double sigmas =
          chiSquareSigmas([&](const Vec2& u) { return brdf.sample(outgoing, u); },
                          [&](const Vec3& w) { return brdf.pdf(w, outgoing); }, kLobeSamples);
      EXPECT_LT(std::abs(sigmas), kSigmas) << name << " at cos " << cosine;
    }
  }
}

TEST(BrdfSampling, DensityIntegratesToOneLessTheLostSamples) {
  for (const auto& [name, material] : sampledMaterials()) {
    const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
    for (const double cosine : kViews) {
      const Vec3d outgoing = direction(cosine, 0.6);
      constexpr int kGrid = 200;
      int lost = 0;
      for (int i = 0; i < kGrid * kGrid; ++i) {
        const Vec2 u = (Vec2(i / kGrid, i % kGrid) + 0.5f) / static_cast<float>(kGrid);
        lost += brdf.sample(Vec3(outgoing), u).z <= 0.0f;
      }
      const double lostFraction = static_cast<double>(lost) / (kGrid * kGrid);
      const double integral = reference::integrate(material.layers, outgoing, 96, [&](const Vec3d& incoming) {
        return double{brdf.pdf(Vec3(incoming), Vec3(outgoing))};
      });
      // The border of the lost samples on the grid, and the quadrature's step at the horizon: each below 1 /
      // 200.
      EXPECT_NEAR(integral, 1.0 - lostFraction, 5e-3) << name << " at cos " << cosine;
      EXPECT_LE(integral, 1.0 + 5e-3) << name << " at cos " << cosine;
    }
  }
}

TEST(BrdfSampling, EstimatesTheAlbedo) {
  for (const auto& [name, material] : sampledMaterials()) {
    const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
    for (const double cosine : {0.95, 0.5, 0.1, 0.01}) {
      const Vec3d outgoing = direction(cosine, 0.6);
      double sum = 0.0;
      double squares = 0.0;
      constexpr int kCount = 40000;
      for (std::uint32_t i = 0; i < kCount; ++i) {
        const Vec3 incoming = brdf.sample(Vec3(outgoing), uniform2(randomKey(23), i, 0));
        if (incoming.z <= 0.0f) continue;
        const float f = brdf.evaluate(incoming, Vec3(outgoing)).x * incoming.z;
        const double weight = double{f} / double{brdf.pdf(incoming, Vec3(outgoing))};
        sum += weight;
        squares += weight * weight;
      }
      const double mean = sum / kCount;
      const double deviation = std::sqrt(std::max(0.0, squares / kCount - mean * mean) / kCount);
      const double expected =
          double{brdf.diffuse().x} + reference::lobeAlbedo(brdf, material.layers, outgoing, 0, 96);
      // Five standard deviations of the mean, and the quadrature's 1e-3.
      EXPECT_NEAR(mean, expected, 5.0 * deviation + 1e-3) << name << " at cos " << cosine;
    }
  }
}

TEST(BrdfSampling, DensityIsPositiveWhereTheLobeIs) {
  for (const double r : {1e-6, 0.3, 0.9, 1.0}) {
    for (const double p : {1.0, 0.0}) {
      const std::vector<LayerDescription> layers = {{Rgb(1.0f, 0.0f, 0.0f), r, p},
                                                    {Rgb(0.0f, 1.0f, 0.0f), 0.6, p}};
      const Brdf one = Brdf::compile(reference::layered({layers[0]}), EnergyRule::Refined);
      const Brdf two = Brdf::compile(reference::layered(layers), EnergyRule::Refined);
      for (std::uint32_t i = 0; i < 300; ++i) {
        const RandomKey key = randomKey(29);
        // Cosines from 1e-6 to 1, evenly in their logarithm.
        const double vi = std::pow(10.0, -6.0 * double{uniform(key, i, 0)});
        const double vo = std::pow(10.0, -6.0 * double{uniform(key, i, 1)});
        const Vec3 incoming(direction(vi, 2.0 * kPiD * double{uniform(key, i, 2)}));
        const Vec3 outgoing(direction(vo, 0.3));
        for (const Brdf* brdf : {&one, &two}) {
          if (isBlack(brdf->lobeRgb(incoming, outgoing))) continue;
          EXPECT_GT(brdf->lobePdf(incoming, outgoing), 0.0f)
              << "r " << r << " p " << p << " cos " << vi << ", " << vo;
        }
      }
    }
  }
}

TEST(BrdfSampling, AnisotropicWeightsStayBounded) {
  // A / ((1 + A^2) / 2) <= 1: a narrow azimuth may lose samples' weight, never make fireflies.
  for (const double p : {1.0, 0.1, 0.01, 0.0}) {
    const Brdf brdf = reference::compileLayer(Rgb(1.0f), 0.2, p, EnergyRule::Refined);
    const Vec3 outgoing(direction(0.7, 0.6));
    float highest = 0.0f;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const Vec3 incoming = brdf.sampleLobe(outgoing, uniform2(randomKey(31), i, 0));
      if (incoming.z <= 0.0f) continue;
      const float f = brdf.lobeRgb(incoming, outgoing).x * incoming.z;
      highest = std::max(highest, f / brdf.lobePdf(incoming, outgoing));
    }
    // b u/t G(v') / (r + (1 - r) v) with u <= 1, G <= 1, and t no lower than v / 2 where the mirror direction
    // is above the horizon: 0.64 * 2 / 0.7 / 0.76.
    EXPECT_LT(highest, 2.41f) << "p " << p;
  }
}

TEST(BrdfSampling, WithoutANonSpecularPartEverySampleIsLost) {
  MaterialDescription material;
  material.mirror = Rgb(1.0f);
  const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
  const Vec3 outgoing(direction(0.5, 0.0));
  EXPECT_LE(brdf.sample(outgoing, Vec2(0.3f)).z, 0.0f);
  EXPECT_LE(brdf.sampleLobe(outgoing, Vec2(0.3f)).z, 0.0f);
  EXPECT_EQ(brdf.pdf(outgoing, outgoing), 0.0f);
}

}  // namespace
}  // namespace lightvane
