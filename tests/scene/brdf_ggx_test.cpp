#include <cmath>

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/base/random.h"
#include "tests/scene/brdf_reference.h"

namespace lightvane {
namespace {

using reference::direction;
using reference::ggx;

constexpr std::array kFacetRoughness = {0.02, 0.1, 0.3, 0.5, 0.8, 1.0};
constexpr std::array kAllCosines = {1e-6, 1e-4, 1e-3, 0.004, 0.01, 0.03, 0.09, 0.2, 0.5, 0.8, 1.0};
// What Brdf promises of EnergyRule::Refined.
constexpr double kMostReflected = 1.0 + 1e-3;

Brdf facets(const Rgb& color, double roughness, EnergyRule rule = EnergyRule::Refined) {
  return Brdf::compile(reference::layered({ggx(color, roughness)}), rule);
}
Brdf coated(const Rgb& base, const LayerDescription& layer, EnergyRule rule) {
  MaterialDescription material = reference::layered({layer});
  material.diffuse = base;
  return Brdf::compile(material, rule);
}

/// Cosines from 1e-2 to 1.
Vec3d anyDirection(std::uint32_t i, std::uint32_t dimension) {
  const RandomKey key = randomKey(5);
  return direction(0.01 + 0.99 * uniform(key, i, dimension), 2.0 * kPiD * uniform(key, i, dimension + 1));
}
/// Cosines from 1e-6 to 1, evenly in their logarithm.
Vec3d grazingDirection(std::uint32_t i, std::uint32_t dimension) {
  const RandomKey key = randomKey(7);
  return direction(std::pow(10.0, -6.0 * uniform(key, i, dimension)),
                   2.0 * kPiD * uniform(key, i, dimension + 1));
}

TEST(GgxLobe, IsTheFormulaUnderBothRules) {
  const Rgb color(0.0f, 0.3f, 1.0f);
  for (const double roughness : kFacetRoughness) {
    for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
      const Brdf brdf = facets(color, roughness, rule);
      EXPECT_FALSE(brdf.isAnisotropic());
      EXPECT_EQ(brdf.lobeColor(), color);
      for (std::uint32_t i = 0; i < 400; ++i) {
        const Vec3d incoming = i % 2 == 0 ? anyDirection(i, 0) : grazingDirection(i, 0);
        const Vec3d outgoing = anyDirection(i, 2);
        const double u = glm::dot(glm::normalize(incoming + outgoing), outgoing);
        const double shape = reference::ggxLobe(square(roughness), incoming, outgoing);
        const Rgb f = brdf.lobeRgb(Vec3(incoming), Vec3(outgoing));
        for (int channel = 0; channel < 3; ++channel) {
          const double expected = reference::colorFactor(double{color[channel]}, u) * shape;
          // Directions are rounded to 6e-8; a peak of width alpha, 4e-4 at least, to the power 2 of D makes
          // up to 6e-4 of that; u is about as exact, to the power 5 at grazing pairs.
          EXPECT_NEAR(f[channel], expected, 1e-3 * expected + 1e-6 * shape)
              << "roughness " << roughness << " channel " << channel << " pair " << i;
        }
      }
    }
  }
}

TEST(GgxLobe, IsReciprocalUnderBothRules) {
  const LayerDescription varnish = ggx(Rgb(0.04f), 0.2);
  std::vector<MaterialDescription> materials = {
      reference::layered({ggx(Rgb(0.5f), 0.2)}),
      reference::layered({varnish, {Rgb(0.9f, 0.5f, 0.1f), 0.9, 1.0}}),
      reference::layered({varnish, ggx(Rgb(1.0f), 0.6)}),
      reference::layered({{Rgb(0.04f), 0.05, 1.0}, ggx(Rgb(1.0f), 0.6)}),
      reference::layered({varnish}),
  };
  materials.back().diffuse = Rgb(0.9f, 0.5f, 0.1f);
  for (const MaterialDescription& material : materials) {
    for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
      const Brdf brdf = Brdf::compile(material, rule);
      for (std::uint32_t i = 0; i < 200; ++i) {
        const Vec3 a(i % 2 == 0 ? anyDirection(i, 0) : grazingDirection(i, 0));
        reference::expectReciprocalLobe(brdf, a, Vec3(anyDirection(i, 2)), fmt::format("pair {}", i));
      }
    }
  }
}

TEST(GgxLobe, IsZeroBelowTheHorizon) { reference::expectNoLobeBelowTheHorizon(facets(Rgb(0.5f), 0.5)); }

// Unless a base below makes it darker: that goes by both colours (TexturedLayers).
TEST(GgxLobe, IsLinearInItsTint) {
  const Brdf brdf = facets(Rgb(0.8f, 0.4f, 0.04f), 0.2);
  const Tint black{.layers = {Rgb(0.0f), Rgb(1.0f)}};
  const Tint tint{.layers = {Rgb(0.2f, 0.5f, 0.7f), Rgb(1.0f)}};
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 incoming(grazingDirection(i, 0));
    const Vec3 outgoing(anyDirection(i, 2));
    const Rgb f0 = brdf.lobeRgb(incoming, outgoing, black);
    const Rgb f1 = brdf.lobeRgb(incoming, outgoing);
    const Rgb f = brdf.lobeRgb(incoming, outgoing, tint);
    for (int channel = 0; channel < 3; ++channel) {
      const float expected = f0[channel] + tint.layers[0][channel] * (f1[channel] - f0[channel]);
      EXPECT_NEAR(f[channel], expected, 4e-7f * f1[channel]) << "pair " << i;
    }
  }
}

TEST(GgxLobe, HalvesAtItsHalfWidth) {
  for (const double roughness : {0.02, 0.2, 0.6}) {
    // Seen from above with H turned by half the width.
    const double t = std::cos(0.5 * double{facets(Rgb(1.0f), roughness).lobeHalfWidth()});
    const double alpha = square(roughness);
    EXPECT_NEAR(reference::ggxDistribution(alpha, t) / reference::ggxDistribution(alpha, 1.0), 0.5, 1e-3)
        << "roughness " << roughness;
  }
  EXPECT_EQ(facets(Rgb(1.0f), 1.0).lobeHalfWidth(), 0.5f * kPi);
  EXPECT_EQ(facets(Rgb(1.0f), 0.0).lobeHalfWidth(), 0.5f * kPi);
  const Brdf two =
      Brdf::compile(reference::layered({ggx(Rgb(0.04f), 0.2), {Rgb(0.5f), 0.9, 1.0}}), EnergyRule::Refined);
  EXPECT_EQ(two.lobeHalfWidth(), facets(Rgb(1.0f), 0.2).lobeHalfWidth());
}

// ---- mirrors

TEST(GgxMirror, IsWhatLobesTurnInto) {
  const Rgb color(0.04f, 0.5f, 1.0f);
  const Brdf mirror = facets(color, 0.0099);
  EXPECT_FALSE(mirror.hasNonSpecular());
  EXPECT_TRUE(mirror.hasSpecular());
  const Brdf lobe = facets(color, 0.0101);
  EXPECT_TRUE(lobe.hasLobe());
  EXPECT_FALSE(lobe.hasSpecular());
  const Brdf mirrorOverBase = coated(Rgb(0.8f), ggx(color, 0.0), EnergyRule::Refined);
  const Brdf lobeOverBase = coated(Rgb(0.8f), ggx(color, 0.0101), EnergyRule::Refined);
  EXPECT_TRUE(mirrorOverBase.hasSpecular());
  EXPECT_FALSE(mirrorOverBase.hasLobe());
  for (const double cosine : {0.05, 0.2, 0.5, 1.0}) {
    const Vec3d outgoing = direction(cosine, 0.4);
    const Rgb weight = reference::reflectedWeight(mirror, outgoing);
    const Rgb weightOverBase = reference::reflectedWeight(mirrorOverBase, outgoing);
    for (int channel = 0; channel < 3; ++channel) {
      const double expected = reference::colorFactor(double{color[channel]}, cosine);
      EXPECT_NEAR(double{weight[channel]}, expected, 1e-6) << "cos " << cosine;
      // The peak is 1e-4 wide: the same up to the change of S and G2 over that.
      const std::vector<LayerDescription> layers = {ggx(color, 0.0101)};
      EXPECT_NEAR(reference::lobeAlbedo(lobe, layers, outgoing, channel, 96), expected, 1e-3)
          << "cos " << cosine;
      // Over a base it is scaled by a table's albedo, between whose nodes a mirror's is exact.
      EXPECT_NEAR(reference::lobeAlbedo(lobeOverBase, layers, outgoing, channel, 96),
                  double{weightOverBase[channel]}, 2e-3)
          << "cos " << cosine;
    }
  }
  for (int channel = 0; channel < 3; ++channel) {
    // The mean of S over a cosine-weighted hemisphere is C + (1 - C) / 21.
    const double c = double{color[channel]};
    EXPECT_NEAR(double{mirrorOverBase.diffuse()[channel]}, 0.8 * (1.0 - c) * 20.0 / 21.0, 1e-4);
    EXPECT_NEAR(lobeOverBase.diffuse()[channel], mirrorOverBase.diffuse()[channel], 1e-4f);
  }
}

// ---- densities

// The facets that are seen along a direction fill its solid angle (Heitz 2014's weak white furnace): D G1 /
// (4 v), by which half vectors are drawn, integrates to 1 over the sphere, whose lower half the lobe has
// nothing of.
TEST(GgxSampling, DensityPassesTheWeakWhiteFurnace) {
  for (const double roughness : {0.1, 0.3, 0.6, 0.9}) {
    const double alpha = square(roughness);
    const Brdf brdf = facets(Rgb(1.0f), roughness);
    for (const double cosine : {1.0, 0.6, 0.2, 0.05}) {
      const Vec3d outgoing = direction(cosine, 0.6);
      const double masking = reference::ggxMasking(alpha, cosine);
      double sum = 0.0;
      double farthest = 0.0;  // of densities from the formula, relatively
      constexpr int kGrid = 200;
      for (int j = 0; j < kGrid; ++j) {
        for (int i = 0; i < kGrid; ++i) {
          // Half vectors with the density D t, denser at both ends, where roots have their poles.
          const double x = (i + 0.5) / kGrid;
          const double weight = 6.0 * x * (1.0 - x);
          const double tangent =
              alpha * std::sqrt(x * x * (3.0 - 2.0 * x) / (square(1.0 - x) * (1.0 + 2.0 * x)));
          const double t = 1.0 / std::sqrt(1.0 + tangent * tangent);
          const Vec3d half = direction(t, 2.0 * kPiD * (j + 0.5) / kGrid);
          const double u = glm::dot(half, outgoing);
          if (u <= 0.0) continue;
          const Vec3d incoming = 2.0 * u * half - outgoing;
          const double printed = reference::ggxDistribution(alpha, t) * masking / (4.0 * cosine);
          double density = printed;
          if (incoming.z > 1e-3) {
            density = double{brdf.lobePdf(Vec3(incoming), Vec3(outgoing))};
            farthest = std::max(farthest, std::abs(density / printed - 1.0));
          }
          sum += weight * density * 4.0 * u / (reference::ggxDistribution(alpha, t) * t);
        }
      }
      EXPECT_LT(farthest, 1e-3) << "roughness " << roughness << " cos " << cosine;
      // A midpoint rule, with a kink where facets turn away.
      EXPECT_NEAR(sum / (kGrid * kGrid), 1.0, 5e-4) << "roughness " << roughness << " cos " << cosine;
    }
  }
}

TEST(GgxSampling, WeightsAreNeverAboveTheColourFactor) {
  // G2 / G1 <= 1, at every angle: no fireflies.
  for (const double roughness : {0.011, 0.1, 0.5, 1.0}) {
    const Brdf brdf = facets(Rgb(1.0f), roughness);
    for (const double cosine : {1.0, 0.5, 0.05, 1e-3, 1e-6}) {
      const Vec3 outgoing(direction(cosine, 0.6));
      float highest = 0.0f;
      int kept = 0;
      constexpr std::uint32_t kSamples = 4000;
      for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Vec3 incoming = brdf.sampleLobe(outgoing, uniform2(randomKey(31), i, 0));
        EXPECT_NEAR(glm::length(incoming), 1.0f, 1e-5f);
        if (incoming.z <= 0.0f) continue;
        ++kept;
        const float f = brdf.lobeRgb(incoming, outgoing).x * incoming.z;
        highest = std::max(highest, f / brdf.lobePdf(incoming, outgoing));
      }
      EXPECT_LE(highest, 1.0f + 1e-5f) << "roughness " << roughness << " cos " << cosine;
      EXPECT_GT(kept, 0);
    }
  }
}

TEST(GgxSampling, DensityIsPositiveWhereTheLobeIs) {
  const std::vector<LayerDescription> lower = {{Rgb(0.0f, 1.0f, 0.0f), 0.6, 1.0}, ggx(Rgb(1.0f), 0.5)};
  for (const double roughness : {0.011, 0.3, 1.0}) {
    const LayerDescription top = ggx(Rgb(1.0f, 0.0f, 0.0f), roughness);
    for (const Brdf& brdf : {Brdf::compile(reference::layered({top}), EnergyRule::Refined),
                             Brdf::compile(reference::layered({top, lower[0]}), EnergyRule::Refined),
                             Brdf::compile(reference::layered({top, lower[1]}), EnergyRule::Refined)}) {
      for (std::uint32_t i = 0; i < 300; ++i) {
        const Vec3 incoming(grazingDirection(i, 0));
        const Vec3 outgoing(grazingDirection(i, 2));
        if (isBlack(brdf.lobeRgb(incoming, outgoing))) continue;
        EXPECT_GT(brdf.lobePdf(incoming, outgoing), 0.0f) << "roughness " << roughness << " pair " << i;
      }
    }
  }
}

// ---- energy

// For alpha = 1 D is 1 / pi and f = 1 / (2 pi (v + v')): the albedo is 1 - v ln(1 + 1/v), its mean 4/3 (1 -
// ln 2).
TEST(GgxEnergy, HasTheClosedFormOfTheRoughest) {
  const Brdf brdf = facets(Rgb(1.0f), 1.0);
  for (const double cosine : {1e-3, 0.01, 0.1, 0.5, 0.8, 1.0}) {
    const double expected = 1.0 - cosine * std::log1p(1.0 / cosine);
    EXPECT_NEAR(double{brdf.directionalAlbedo(Vec3(direction(cosine, 0.3))).x}, expected, 1e-3)
        << "cos " << cosine;
  }
  const Rgb base(0.8f, 0.5f, 0.1f);
  for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
    const Brdf over = coated(base, ggx(Rgb(1.0f), 1.0), rule);
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(double{over.diffuse()[channel]},
                  double{base[channel]} * (1.0 - 4.0 / 3.0 * (1.0 - std::log(2.0))), 1e-4);
    }
  }
}

TEST(GgxEnergy, OneLayerReflectsAtMostItsColourFactor) {
  for (const double roughness : {0.011, 0.05, 0.2, 0.5, 0.8, 1.0}) {
    const std::vector<LayerDescription> layers = {ggx(Rgb(1.0f, 0.0f, 0.5f), roughness)};
    const Brdf brdf = Brdf::compile(reference::layered(layers), EnergyRule::Printed);
    for (const double cosine : kAllCosines) {
      const Vec3d outgoing = direction(cosine, 0.03);
      const Rgb albedo = brdf.directionalAlbedo(Vec3(outgoing));
      EXPECT_LE(maxComponent(albedo), kMostReflected) << "roughness " << roughness << " cos " << cosine;
      for (int channel = 0; channel < 3; ++channel) {
        // The bound's own margin is 2 %.
        EXPECT_LE(albedo[channel], brdf.nonSpecularAlbedoBound()[channel]);
        if (cosine < 0.01) continue;
        const double expected = reference::lobeAlbedo(brdf, layers, outgoing, channel, 128);
        EXPECT_NEAR(double{albedo[channel]}, expected, 2e-3)
            << "roughness " << roughness << " cos " << cosine;
      }
    }
  }
}

TEST(GgxEnergy, RefinedOfTwoLayersReflectsAtMostEverything) {
  std::vector<LayerDescription> tops, bottoms;
  for (const double roughness : {0.0, 0.05, 0.3, 1.0}) {
    tops.push_back(ggx(Rgb(0.04f, 0.0f, 0.5f), roughness));
    bottoms.push_back(ggx(Rgb(1.0f), roughness));
  }
  for (const double r : {0.05, 1.0}) {
    tops.push_back({Rgb(0.04f, 0.0f, 0.5f), r, 1.0});
    bottoms.push_back({Rgb(1.0f), r, 1.0});
  }
  for (const LayerDescription& top : tops) {
    for (const LayerDescription& bottom : bottoms) {
      if (top.model == LayerModel::Schlick && bottom.model == LayerModel::Schlick) continue;
      const Brdf refined = Brdf::compile(reference::layered({top, bottom}), EnergyRule::Refined);
      for (const double cosine : kAllCosines) {
        const Vec3 outgoing(direction(cosine, 0.7));
        EXPECT_LE(maxComponent(refined.directionalAlbedo(outgoing)), kMostReflected)
            << "roughness " << top.roughness << " over " << bottom.roughness << " cos " << cosine;
      }
    }
  }
  // There is something to mend.
  const Brdf printed = Brdf::compile(reference::layered({tops[1], bottoms.back()}), EnergyRule::Printed);
  EXPECT_GT(maxComponent(printed.directionalAlbedo(Vec3(direction(0.09, 0.7)))), 1.2f);
}

TEST(GgxEnergy, RefinedOverABaseReflectsAtMostEverything) {
  float highestPrinted = 0.0f;
  for (const double roughness : {0.0, 0.011, 0.05, 0.2, 0.4, 0.7, 1.0}) {
    for (const Rgb& base : {Rgb(1.0f), Rgb(0.8f, 0.3f, 0.05f)}) {
      const LayerDescription layer = ggx(Rgb(0.04f, 0.0f, 0.5f), roughness);
      const Brdf refined = coated(base, layer, EnergyRule::Refined);
      const Brdf printed = coated(base, layer, EnergyRule::Printed);
      EXPECT_EQ(refined.diffuse(), printed.diffuse());
      EXPECT_LE(maxComponent(refined.nonSpecularAlbedoBound()), 1.02f);
      for (const double cosine : kAllCosines) {
        const Vec3 outgoing(direction(cosine, 0.7));
        EXPECT_LE(maxComponent(refined.directionalAlbedo(outgoing)), kMostReflected)
            << "roughness " << roughness << " cos " << cosine;
        highestPrinted = std::max(highestPrinted, maxComponent(printed.directionalAlbedo(outgoing)));
      }
    }
  }
  // A mirror-like coat over white, at grazing angles.
  EXPECT_GT(highestPrinted, 1.8f);
}

// What a white base under a layer gives back in all, averaged over directions as a white sky would: what the
// base does not get is what the layer reflects.
TEST(GgxEnergy, OverAWhiteBaseReflectsEverythingOnAverage) {
  for (const double roughness : {0.0, 0.2, 0.6, 1.0}) {
    const Brdf brdf = coated(Rgb(1.0f), ggx(Rgb(0.04f, 0.5f, 1.0f), roughness), EnergyRule::Printed);
    glm::dvec3 mean(0.0);
    constexpr int kCosines = 48;
    for (int i = 0; i < kCosines; ++i) {
      const double cosine = (i + 0.5) / kCosines;
      mean += glm::dvec3(brdf.directionalAlbedo(Vec3(direction(cosine, 0.7)))) * (2.0 * cosine / kCosines);
    }
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(mean[channel], 1.0, 2e-3) << "roughness " << roughness << " channel " << channel;
  }
}

TEST(GgxEnergy, OnlyASingleFacetLayerTakesFromItsBase) {
  const Rgb base(0.8f, 0.3f, 0.05f);
  const LayerDescription top = ggx(Rgb(0.04f), 0.3);
  EXPECT_LT(coated(base, top, EnergyRule::Printed).diffuse().x, 0.75f);
  EXPECT_EQ(coated(base, {Rgb(0.04f), 0.1, 1.0}, EnergyRule::Refined).diffuse(), base);
  MaterialDescription two = reference::layered({top, {Rgb(0.04f), 0.1, 1.0}});
  two.diffuse = base;
  EXPECT_EQ(Brdf::compile(two, EnergyRule::Refined).diffuse(), base);
  // A layer that lets nothing through leaves no Lambertian part.
  const Brdf metal = coated(base, ggx(Rgb(1.0f), 0.0), EnergyRule::Refined);
  EXPECT_FALSE(metal.hasDiffuse());
  EXPECT_EQ(metal.nonSpecularAlbedoBound(), Rgb(0.0f));
}

// ---- extremes

TEST(GgxLobe, IsFiniteAndNotNegativeAtEveryExtreme) {
  const std::array cosines = {1e-20, 1e-6, 1e-4, 0.5, 1.0 - 1e-7, 1.0};
  const std::array azimuths = {0.0, 1e-7, 0.5 * kPiD, 1.0, kPiD, kPiD + 1e-7};
  for (const double alpha : {0.0, 1e-9, 1e-6, 1e-4, 1.0001e-4, 1e-3, 0.1, 0.5, 1.0 - 1e-7, 1.0}) {
    const LayerDescription top = ggx(Rgb(0.0f, 0.5f, 1.0f), std::sqrt(alpha));
    for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
      for (const Brdf& brdf : {Brdf::compile(reference::layered({top}), rule), coated(Rgb(1.0f), top, rule),
                               Brdf::compile(reference::layered({top, ggx(Rgb(1.0f), 0.5)}), rule)}) {
        EXPECT_TRUE(isValidSample(brdf.nonSpecularAlbedoBound()));
        EXPECT_TRUE(isValidSample(brdf.diffuse()));
        EXPECT_GT(brdf.lobeHalfWidth(), 0.0f);
        EXPECT_LE(brdf.lobeHalfWidth(), 0.5f * kPi);
        for (const double vo : cosines) {
          const Vec3 outgoing(direction(vo, 0.0));
          EXPECT_TRUE(isValidSample(reference::reflectedWeight(brdf, direction(vo, 0.0))));
          for (const double vi : cosines) {
            for (const double azimuth : azimuths) {
              // At azimuth pi opposite to the last bit.
              Vec3 incoming(direction(vi, azimuth));
              if (azimuth == kPiD) incoming.y = 0.0f;
              const Rgb f = brdf.lobeRgb(incoming, outgoing);
              const float pdf = brdf.lobePdf(incoming, outgoing);
              const bool fine = isValidSample(f) && std::isfinite(pdf) && pdf >= 0.0f;
              ASSERT_TRUE(fine) << "alpha " << alpha << " cos " << vi << ", " << vo << " azimuth " << azimuth
                                << ": f = " << f.x << ", " << f.y << ", " << f.z << ", pdf " << pdf;
            }
          }
          constexpr float kLast = 0x1.fffffep-1f;  // the greatest random number
          for (const float u : {0.0f, 1e-7f, 0.5f, kLast}) {
            for (const float w : {0.0f, 0.25f, 0.5f, kLast}) {
              const Vec3 sampled = brdf.sample(outgoing, {u, w});
              ASSERT_TRUE(std::isfinite(sampled.x) && std::isfinite(sampled.y) && std::isfinite(sampled.z))
                  << "alpha " << alpha << " cos " << vo << " at " << u << ", " << w;
            }
          }
        }
      }
    }
  }
}

TEST(GgxLobe, RefusesWhatTheLoaderShouldHaveRefused) {
  EXPECT_THROW(facets(Rgb(0.5f), 1.5), InvariantViolation);
  EXPECT_THROW(facets(Rgb(0.5f), -0.1), InvariantViolation);
  EXPECT_THROW(facets(Rgb(1.5f), 0.5), InvariantViolation);
}

}  // namespace
}  // namespace lightvane
