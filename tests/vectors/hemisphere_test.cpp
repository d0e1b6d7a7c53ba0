#include "tests/vectors/hemispheres.h"

// What a sampled hemisphere says by itself: cells, means, irradiance, direction. Sections 5.2.1 to 5.2.3.

namespace lightvane {
namespace {

using namespace vectors_test;

TEST(Hemisphere, IrradianceOfConstantRadianceIsPiTimesIt) {
  const Rgb radiance(0.25f, 1.0f, 3.0f);
  for (const auto& [rows, columns] : {std::pair(1, 1), {4, 8}, {12, 24}, {100, 7}}) {
    const Hemisphere constant = centredHemisphere(rows, columns, [&](const Vec3&) {
      return GatherCell{{}, radiance, 1.0f};
    });
    const Rgb irradiance = hemisphereIrradiance(constant);
    // The mean cosine of equal cells' middles is exactly 1/2; rounding of some hundred sums is left.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c], kPi * radiance[c], 2e-6f * kPi * radiance[c]);
  }
}

// L = cos^n gives 2 pi / (n + 2).
TEST(Hemisphere, IrradianceOfCosinePowers) {
  for (const int n : {1, 4, 9}) {
    const Hemisphere lobe = centredHemisphere(64, 128, [&](const Vec3& d) {
      return GatherCell{{}, Rgb(std::pow(d.z, static_cast<float>(n))), 1.0f};
    });
    // The midpoint rule's error is 2 pi (n + 1) / (24 M^2) to leading order; 5 % of it for the rest.
    const float error = kTwoPi * static_cast<float>(n + 1) / (24.0f * 64.0f * 64.0f);
    EXPECT_NEAR(hemisphereIrradiance(lobe).x, kTwoPi / static_cast<float>(n + 2) - error, 0.05f * error)
        << "cos^" << n;
  }
}

TEST(Hemisphere, DirectionIsTheMeanOfLightTimesCosine) {
  // All light in one direction; none at all; and symmetric light.
  const Vec3 toLight = glm::normalize(Vec3(0.5f, -0.3f, 0.6f));
  const Hemisphere spot = centredHemisphere(32, 64, [&](const Vec3& d) {
    return GatherCell{{}, glm::dot(d, toLight) > 0.99f ? Rgb(2.0f) : Rgb(0.0f), 1.0f};
  });
  EXPECT_GT(glm::dot(hemisphereDirection(spot), toLight), 0.9995f);
  EXPECT_NEAR(glm::length(hemisphereDirection(spot)), 1.0f, 1e-6f);
  const Hemisphere dark = centredHemisphere(4, 8, [](const Vec3&) {
    return GatherCell{{}, Rgb(0.0f), 1.0f};
  });
  EXPECT_EQ(hemisphereDirection(dark), Vec3(0, 0, 1));
  const Hemisphere even = centredHemisphere(8, 16, [](const Vec3&) {
    return GatherCell{{}, Rgb(1.0f), 1.0f};
  });
  EXPECT_LT(glm::length(hemisphereDirection(even) - Vec3(0, 0, 1)), 1e-6f);
  // Half bright, x > 0: the integral of omega cos is (2/3, 0, pi/3).
  const Hemisphere half = centredHemisphere(64, 128, [](const Vec3& d) {
    return GatherCell{{}, d.x > 0.0f ? Rgb(1.0f) : Rgb(0.0f), 1.0f};
  });
  const Vec3 direction = hemisphereDirection(half);
  EXPECT_NEAR(direction.x / direction.z, 2.0f / kPi, 1e-3f);
  EXPECT_NEAR(direction.y, 0.0f, 1e-5f);
}

TEST(Hemisphere, MeansOfDistances) {
  Hemisphere h;
  h.cells = {{{}, {}, 1.0f}, {{}, {}, 2.0f}, {{}, {}, 4.0f}};
  const MeanDistances three = meanDistances(h);
  EXPECT_FLOAT_EQ(three.arithmetic, 7.0f / 3.0f);
  EXPECT_FLOAT_EQ(three.harmonic, 3.0f / 1.75f);
  EXPECT_EQ(three.least, 1.0f);
  // Misses are skipped, not counted as far.
  h.cells.push_back({{}, {}, kInfinity});
  const MeanDistances withMiss = meanDistances(h);
  EXPECT_EQ(withMiss.arithmetic, three.arithmetic);
  EXPECT_EQ(withMiss.harmonic, three.harmonic);
  EXPECT_EQ(withMiss.least, 1.0f);
  for (const std::size_t misses : {0u, 5u}) {
    Hemisphere open;
    open.cells.assign(misses, GatherCell{});
    const MeanDistances none = meanDistances(open);
    EXPECT_EQ(none.arithmetic, kInfinity);
    EXPECT_EQ(none.harmonic, kInfinity);
    EXPECT_EQ(none.least, kInfinity);
  }
  // A hit at no distance pulls the harmonic mean to it and makes no NaN.
  h.cells.front().distance = 0.0f;
  const MeanDistances touching = meanDistances(h);
  EXPECT_GE(touching.harmonic, 0.0f);
  EXPECT_LT(touching.harmonic, 1e-20f);
  EXPECT_EQ(touching.least, 0.0f);
  EXPECT_FLOAT_EQ(touching.arithmetic, 2.0f);
}

}  // namespace
}  // namespace lightvane
