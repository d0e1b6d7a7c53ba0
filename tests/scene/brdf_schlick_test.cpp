#include <cmath>

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "core/base/random.h"
#include "tests/scene/brdf_reference.h"

namespace lightvane {
namespace {

using reference::compileLayer;
using reference::direction;

constexpr std::array kRoughness = {0.02, 0.1, 0.3, 0.4999, 0.5, 0.7, 0.95, 1.0};
constexpr std::array kIsotropy = {1.0, 0.4, 0.05};

// A direction above the horizon, cosines from 1e-2 to 1.
Vec3d someDirection(std::uint32_t i, std::uint32_t dimension) {
  const RandomKey key = randomKey(3);
  return direction(0.01 + 0.99 * uniform(key, i, dimension), 2.0 * kPiD * uniform(key, i, dimension + 1));
}

TEST(SchlickLobe, IsTheFormulaAsPrinted) {
  for (const double r : kRoughness) {
    for (const double p : kIsotropy) {
      const Brdf brdf = compileLayer({0.0f, 0.3f, 1.0f}, r, p, EnergyRule::Printed);
      for (std::uint32_t i = 0; i < 200; ++i) {
        const Vec3d incoming = someDirection(i, 0);
        const Vec3d outgoing = someDirection(i, 2);
        const double u = glm::dot(glm::normalize(incoming + outgoing), outgoing);
        const double shape = reference::layerLobe(r, p, incoming, outgoing);
        const Rgb f = brdf.lobeRgb(Vec3(incoming), Vec3(outgoing));
        for (int channel = 0; channel < 3; ++channel) {
          const double expected = reference::colorFactor(channel == 0   ? 0.0
                                                         : channel == 1 ? double{0.3f}
                                                                        : 1.0,
                                                         u) *
                                  shape;
          // Directions are rounded to 6e-8; a peak of width r (or p across) turns that into 6e-8 / (r p),
          // 6e-5 here, times the power 2 of Z; u is about as exact, to the power 5 at grazing pairs.
          EXPECT_NEAR(f[channel], expected, 5e-4 * expected + 1e-6 * shape)
              << "r " << r << " p " << p << " channel " << channel << " pair " << i;
        }
      }
    }
  }
}

TEST(SchlickLobe, IsReciprocalUnderBothRules) {
  const std::vector<std::vector<LayerDescription>> materials = {
      {{Rgb(0.5f), 0.05, 1.0}},
      {{Rgb(0.5f), 0.1, 0.2}},
      {{Rgb(0.04f), 0.05, 1.0}, {Rgb(0.9f, 0.5f, 0.1f), 0.9, 1.0}},
      {{Rgb(0.3f), 0.0, 1.0}, {Rgb(1.0f), 0.2, 0.1}},
  };
  for (const auto& layers : materials) {
    for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
      const Brdf brdf = Brdf::compile(reference::layered(layers), rule);
      for (std::uint32_t i = 0; i < 200; ++i) {
        // Every other pair grazes the surface, where the refined rule divides.
        const Vec3 a(i % 2 == 0 ? someDirection(i, 0) : direction(0.003, 0.1 * i));
        reference::expectReciprocalLobe(brdf, a, Vec3(someDirection(i, 2)), fmt::format("pair {}", i));
      }
    }
  }
}

TEST(SchlickLobe, IsZeroBelowTheHorizon) {
  reference::expectNoLobeBelowTheHorizon(compileLayer(Rgb(0.5f), 0.3, 1.0, EnergyRule::Refined));
}

TEST(SchlickLobe, AtRoughnessOneIsLambertTimesTheColourFactor) {
  const Rgb color(0.1f, 0.5f, 0.9f);
  const Brdf brdf = compileLayer(color, 1.0, 1.0, EnergyRule::Refined);
  EXPECT_TRUE(brdf.hasLobe());
  EXPECT_FALSE(brdf.hasDiffuse());
  EXPECT_FALSE(brdf.hasSpecular());
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3d incoming = someDirection(i, 0);
    const Vec3d outgoing = someDirection(i, 2);
    const double u = glm::dot(glm::normalize(incoming + outgoing), outgoing);
    const Rgb f = brdf.lobeRgb(Vec3(incoming), Vec3(outgoing));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(f[channel], reference::colorFactor(double{color[channel]}, u) / kPiD, 1e-6) << "pair " << i;
    }
  }
}

TEST(SchlickLobe, AtRoughnessZeroIsSpecularOnly) {
  const Rgb color(0.1f, 0.5f, 0.9f);
  const Brdf brdf = compileLayer(color, 0.0, 1.0, EnergyRule::Refined);
  EXPECT_FALSE(brdf.hasLobe());
  EXPECT_FALSE(brdf.hasNonSpecular());
  EXPECT_TRUE(brdf.hasSpecular());
  for (const double cosine : {1.0, 0.5, 0.1, 1e-6}) {
    const Vec3d outgoing = direction(cosine, 0.4);
    EXPECT_EQ(brdf.lobeRgb(Vec3(outgoing), Vec3(outgoing)), Rgb(0.0f));
    for (int channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR(reference::reflectedWeight(brdf, outgoing)[channel],
                  reference::colorFactor(double{color[channel]}, cosine), 1e-6);
    }
  }
}

TEST(SchlickDirac, WeighsEightyOnePercentAtRoughnessOneTwentieth) {
  const Brdf brdf = compileLayer(Rgb(1.0f), 0.05, 1.0, EnergyRule::Printed);
  // 1 - 4 * 0.05 * 0.95
  EXPECT_NEAR(reference::reflectedWeight(brdf, direction(0.7, 0.0)).x, 0.81, 1e-6);
}

TEST(SchlickDirac, OfTheLowerLayerComesThroughTheUpper) {
  const Rgb top(0.04f);
  const Rgb lower(0.9f, 0.6f, 0.2f);
  const Brdf brdf =
      Brdf::compile(reference::layered({{top, 0.1, 1.0}, {lower, 0.2, 1.0}}), EnergyRule::Refined);
  for (const double cosine : {1.0, 0.6, 0.2, 0.01}) {
    const Rgb weight = reference::reflectedWeight(brdf, direction(cosine, 1.0));
    for (int channel = 0; channel < 3; ++channel) {
      const double s1 = reference::colorFactor(double{top[channel]}, cosine);
      const double s2 = reference::colorFactor(double{lower[channel]}, cosine);
      const double expected = s1 * reference::diracShare(0.1) + (1.0 - s1) * s2 * reference::diracShare(0.2);
      EXPECT_NEAR(weight[channel], expected, 1e-6) << "cos " << cosine;
    }
  }
}

TEST(SchlickLobe, OfTwoLayersIsTheUpperPlusWhatItLetsThrough) {
  const Rgb top(0.04f, 0.3f, 0.0f);
  const Rgb lower(0.9f, 0.6f, 0.2f);
  const Brdf brdf =
      Brdf::compile(reference::layered({{top, 0.1, 1.0}, {lower, 0.8, 0.5}}), EnergyRule::Printed);
  EXPECT_EQ(brdf.lobeColor(), Rgb(0.0f));
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Vec3d incoming = someDirection(i, 0);
    const Vec3d outgoing = someDirection(i, 2);
    const double u = glm::dot(glm::normalize(incoming + outgoing), outgoing);
    const double f1 = reference::layerLobe(0.1, 1.0, incoming, outgoing);
    const double f2 = reference::layerLobe(0.8, 0.5, incoming, outgoing);
    const LobeValue value = brdf.lobe(Vec3(incoming), Vec3(outgoing));
    EXPECT_EQ(value.perColor, Rgb(0.0f));
    for (int channel = 0; channel < 3; ++channel) {
      const double s1 = reference::colorFactor(double{top[channel]}, u);
      const double s2 = reference::colorFactor(double{lower[channel]}, u);
      const double expected = s1 * f1 + (1.0 - s1) * s2 * f2;
      EXPECT_NEAR(value.constant[channel], expected, 1e-4 * expected + 1e-6 * f1) << "pair " << i;
    }
  }
}

TEST(SchlickLobe, IsContinuousAtRoughnessOneHalf) {
  const Brdf below = compileLayer(Rgb(0.5f), 0.5 - 1e-6, 1.0, EnergyRule::Refined);
  const Brdf above = compileLayer(Rgb(0.5f), 0.5 + 1e-6, 1.0, EnergyRule::Refined);
  // df/dr is of the order of f: a step of 2e-6 in r, and float rounding.
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 incoming(someDirection(i, 0));
    const Vec3 outgoing(someDirection(i, 2));
    const float f = below.lobeRgb(incoming, outgoing).x;
    EXPECT_NEAR(above.lobeRgb(incoming, outgoing).x, f, 2e-5f * f) << "pair " << i;
  }
  // The Dirac part goes out as (1 - 2r)^2.
  EXPECT_LT(reference::reflectedWeight(below, direction(0.5, 0.0)).x, 1e-11f);
}

TEST(SchlickLobe, OfOneLayerIsLinearInItsColourUnderBothRules) {
  for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
    const Brdf black = compileLayer(Rgb(0.0f), 0.1, 0.5, rule);
    const Brdf white = compileLayer(Rgb(1.0f), 0.1, 0.5, rule);
    const Rgb color(0.2f, 0.5f, 0.7f);
    const Brdf colored = compileLayer(color, 0.1, 0.5, rule);
    EXPECT_EQ(colored.lobeColor(), color);
    for (std::uint32_t i = 0; i < 100; ++i) {
      const Vec3 incoming(someDirection(i, 0));
      const Vec3 outgoing(i % 2 == 0 ? someDirection(i, 2) : direction(0.005, 0.2 * i));
      const Rgb f0 = black.lobeRgb(incoming, outgoing);
      const Rgb f1 = white.lobeRgb(incoming, outgoing);
      const Rgb f = colored.lobeRgb(incoming, outgoing);
      for (int channel = 0; channel < 3; ++channel) {
        const float expected = f0[channel] + color[channel] * (f1[channel] - f0[channel]);
        EXPECT_NEAR(f[channel], expected, 4e-7f * f1[channel]) << "pair " << i;
      }
      // The two terms do not know the layer's colour: a texture may drive it.
      EXPECT_EQ(colored.lobe(incoming, outgoing).perColor, white.lobe(incoming, outgoing).perColor);
      EXPECT_EQ(colored.lobe(incoming, outgoing).constant, white.lobe(incoming, outgoing).constant);
    }
  }
}

TEST(SchlickAnisotropy, ScattersAcrossTheTangent) {
  const double p = 0.1;
  const Brdf brdf = compileLayer(Rgb(1.0f), 0.3, p, EnergyRule::Printed);
  EXPECT_TRUE(brdf.isAnisotropic());
  // Seen from above, H lies in the plane of incidence: w is 1 along the tangent and 0 across, A sqrt(p) and
  // 1/sqrt(p).
  const Vec3 above(0.0f, 0.0f, 1.0f);
  const float along = brdf.lobeRgb(Vec3(direction(0.8, 0.0)), above).x;
  const float across = brdf.lobeRgb(Vec3(direction(0.8, 0.5 * kPiD)), above).x;
  EXPECT_NEAR(across / along, 1.0 / p, 1e-3 / p);
}

TEST(SchlickAnisotropy, HasTheMeanOfItsEllipticIntegral) {
  // Averaged over the azimuth, A is (2/pi) sqrt(p) K(sqrt(1 - p^2)): seen from above, the lobe over the
  // isotropic one.
  const Vec3 above(0.0f, 0.0f, 1.0f);
  const Brdf isotropic = compileLayer(Rgb(1.0f), 0.2, 1.0, EnergyRule::Printed);
  const float whole = isotropic.lobeRgb(Vec3(direction(0.9, 0.0)), above).x;
  for (const double p : {0.9, 0.5, 0.1, 0.02}) {
    const Brdf brdf = compileLayer(Rgb(1.0f), 0.2, p, EnergyRule::Printed);
    double mean = 0.0;
    // Points on a periodic function: exact to float once the spacing is well below p.
    constexpr int kPoints = 2000;
    for (int i = 0; i < kPoints; ++i) {
      const double azimuth = 2.0 * kPiD * (i + 0.5) / kPoints;
      mean += double{brdf.lobeRgb(Vec3(direction(0.9, azimuth)), above).x} / kPoints;
    }
    const double expected = 2.0 / kPiD * std::sqrt(p) * std::comp_ellint_1(std::sqrt(1.0 - p * p));
    EXPECT_NEAR(mean / double{whole}, expected, 1e-4) << "p " << p;
  }
}

TEST(SchlickAnisotropy, AtIsotropyZeroIsItsNeighbourhoodsLimit) {
  // From 1e-4 down nothing changes; the energy left there is the limit's up to (2/pi) sqrt(p) K = 0.067 of b.
  const Brdf zero = compileLayer(Rgb(1.0f), 0.2, 0.0, EnergyRule::Printed);
  const Brdf tiny = compileLayer(Rgb(1.0f), 0.2, 1e-5, EnergyRule::Printed);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Vec3 incoming(someDirection(i, 0));
    const Vec3 outgoing(someDirection(i, 2));
    EXPECT_EQ(zero.lobeRgb(incoming, outgoing), tiny.lobeRgb(incoming, outgoing));
  }
  const std::vector<LayerDescription> layers = {{Rgb(1.0f), 0.2, 0.0}};
  EXPECT_LT(reference::lobeAlbedo(zero, layers, direction(0.9, 0.3), 0), 0.07 * 4.0 * 0.2 * 0.8);
}

TEST(SchlickLobe, IsFiniteAndNotNegativeAtEveryExtreme) {
  const std::array cosines = {1e-20, 1e-6, 1e-4, 0.5, 1.0 - 1e-7, 1.0};
  const std::array azimuths = {0.0, 1e-7, 0.5 * kPiD, 1.0, kPiD, kPiD + 1e-7};
  for (const double r : {0.0, 1e-12, 1e-8, 1e-6, 0.5, 1.0 - 1e-7}) {
    for (const double p : {0.0, 1e-6, 1.0}) {
      for (const EnergyRule rule : {EnergyRule::Printed, EnergyRule::Refined}) {
        const Brdf brdf =
            Brdf::compile(reference::layered({{Rgb(0.0f, 0.5f, 1.0f), r, p}, {Rgb(1.0f), 0.5, p}}), rule);
        const Rgb bound = brdf.nonSpecularAlbedoBound();
        EXPECT_TRUE(isValidSample(bound));
        EXPECT_GT(brdf.lobeHalfWidth(), 0.0f);
        EXPECT_LE(brdf.lobeHalfWidth(), 0.5f * kPi);
        for (const double vi : cosines) {
          for (const double vo : cosines) {
            for (const double azimuth : azimuths) {
              const Vec3 outgoing(direction(vo, 0.0));
              // At azimuth pi opposite to the last bit.
              Vec3 incoming(direction(vi, azimuth));
              if (azimuth == kPiD) incoming.y = 0.0f;
              const Rgb f = brdf.lobeRgb(incoming, outgoing);
              const float pdf = brdf.lobePdf(incoming, outgoing);
              const bool fine = isValidSample(f) && std::isfinite(pdf) && pdf >= 0.0f;
              ASSERT_TRUE(fine) << "r " << r << " p " << p << " cos " << vi << ", " << vo << " azimuth "
                                << azimuth << ": f = " << f.x << ", " << f.y << ", " << f.z << ", pdf "
                                << pdf;
            }
          }
        }
      }
    }
  }
}

TEST(SchlickLobe, HalvesAtItsHalfWidth) {
  // In the plane of incidence, seen from above, with H turned by half the width: Z is half its peak.
  const double r = 0.02;
  const Brdf brdf = compileLayer(Rgb(1.0f), r, 1.0, EnergyRule::Printed);
  const double theta = 0.5 * double{brdf.lobeHalfWidth()};
  const double t = std::cos(theta);
  EXPECT_NEAR(r / square(1.0 + r * t * t - t * t), 0.5 / r, 1e-4 / r);
  // Across an anisotropic lobe it is narrower, a Lambertian one is as wide as can be.
  EXPECT_LT(compileLayer(Rgb(1.0f), r, 0.1, EnergyRule::Printed).lobeHalfWidth(),
            0.5f * brdf.lobeHalfWidth());
  EXPECT_EQ(compileLayer(Rgb(1.0f), 1.0, 1.0, EnergyRule::Printed).lobeHalfWidth(), 0.5f * kPi);
  // The narrower of two layers decides.
  const Brdf two =
      Brdf::compile(reference::layered({{Rgb(0.04f), r, 1.0}, {Rgb(0.5f), 0.9, 1.0}}), EnergyRule::Refined);
  EXPECT_EQ(two.lobeHalfWidth(), brdf.lobeHalfWidth());
}

TEST(Brdf, RefusesWhatTheLoaderShouldHaveRefused) {
  const LayerDescription layer{Rgb(0.5f), 0.5, 1.0};
  EXPECT_THROW(Brdf::compile(reference::layered({layer, layer, layer}), EnergyRule::Refined),
               InvariantViolation);
  EXPECT_THROW(compileLayer(Rgb(0.5f), 1.5, 1.0, EnergyRule::Refined), InvariantViolation);
  EXPECT_THROW(compileLayer(Rgb(0.5f), 0.5, -0.1, EnergyRule::Refined), InvariantViolation);
  EXPECT_THROW(compileLayer(Rgb(1.5f), 0.5, 1.0, EnergyRule::Refined), InvariantViolation);
}

}  // namespace
}  // namespace lightvane
