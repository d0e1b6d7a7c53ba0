#include <cmath>

#include <gtest/gtest.h>

#include "tests/scene/brdf_reference.h"

namespace lightvane {
namespace {

using reference::direction;

Brdf glass(double ior, const Rgb& transmission = Rgb(1.0f)) {
  MaterialDescription material;
  material.transmission = transmission;
  material.ior = ior;
  return Brdf::compile(material, EnergyRule::Refined);
}

TEST(ThinGlass, SendsOnAllThatItDoesNotReflectAndStraight) {
  MaterialDescription material;
  material.transmission = Rgb(1.0f, 0.5f, 0.25f);
  material.thin = true;
  const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
  EXPECT_TRUE(brdf.isThin() && brdf.isGlass() && brdf.hasSpecular());
  for (const bool entering : {true, false}) {
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
      const Vec3 outgoing(direction(std::cos(degrees * kPiD / 180.0), 1.0));
      std::array<SpecularBranch, 2> branches;
      ASSERT_EQ(brdf.specularBranches(outgoing, entering, {}, branches), 2);
      EXPECT_EQ(branches[1].direction, -outgoing);
      EXPECT_TRUE(branches[1].transmitted && !branches[0].transmitted);
      EXPECT_NEAR(branches[0].weight.r + branches[1].weight.r, 1.0f, 1e-6f) << degrees;
      EXPECT_NEAR(branches[1].weight.g, 0.5f * branches[1].weight.r, 1e-6f);
      float ignored = 0.0f;
      const float face = fresnelDielectric(outgoing.z, 1.5f, ignored);
      EXPECT_NEAR(branches[0].weight.r, 2.0f * face / (1.0f + face), 1e-6f) << degrees;
    }
  }
}

TEST(Fresnel, AtNormalIncidenceIsTheSquareOfTheIndexRatio) {
  for (const float n : {1.0f, 1.33f, 1.5f, 2.42f, 1.0f / 1.5f}) {
    float cosTransmitted = 0.0f;
    const double expected = square((double{n} - 1.0) / (double{n} + 1.0));
    EXPECT_NEAR(fresnelDielectric(1.0f, n, cosTransmitted), expected, 1e-7) << "n " << n;
    EXPECT_EQ(cosTransmitted, 1.0f);
  }
}

TEST(Fresnel, AtBrewstersAngleReflectsOnePolarisationOnly) {
  const double n = 1.5;
  const double angle = std::atan(n);
  // The perpendicular one reflects sin^2(i - t) with i + t = 90 degrees; unpolarised light half of that.
  const double expected = 0.5 * square(std::sin(2.0 * angle - 0.5 * kPiD));
  float cosTransmitted = 0.0f;
  EXPECT_NEAR(fresnelDielectric(static_cast<float>(std::cos(angle)), 1.5f, cosTransmitted), expected, 1e-6);
}

TEST(Fresnel, AtGrazingIncidenceReflectsEverything) {
  float cosTransmitted = 0.0f;
  for (const float eta : {1.5f, 1.0f / 1.5f, 1.0f + 1e-6f}) {
    EXPECT_EQ(fresnelDielectric(0.0f, eta, cosTransmitted), 1.0f) << "eta " << eta;
  }
}

TEST(Fresnel, OfEqualIndicesIsNothingAtAnyAngle) {
  for (const float cosine : {0.0f, 1e-6f, 0.3f, 1.0f}) {
    float cosTransmitted = -1.0f;
    EXPECT_EQ(fresnelDielectric(cosine, 1.0f, cosTransmitted), 0.0f);
    EXPECT_EQ(cosTransmitted, cosine);
  }
}

TEST(Fresnel, BeyondTheCriticalAngleReflectsEverything) {
  const double critical = std::asin(1.0 / 1.5);
  float cosTransmitted = -1.0f;
  const float beyond = static_cast<float>(std::cos(critical + 1e-3));
  EXPECT_EQ(fresnelDielectric(beyond, 1.0f / 1.5f, cosTransmitted), 1.0f);
  EXPECT_EQ(cosTransmitted, 0.0f);
  const float within = static_cast<float>(std::cos(critical - 1e-3));
  EXPECT_LT(fresnelDielectric(within, 1.0f / 1.5f, cosTransmitted), 1.0f);
  EXPECT_GT(cosTransmitted, 0.0f);
}

TEST(Glass, RefractsBySnellsLaw) {
  const Brdf brdf = glass(1.5);
  EXPECT_TRUE(brdf.isGlass());
  EXPECT_TRUE(brdf.hasSpecular());
  EXPECT_FALSE(brdf.hasNonSpecular());
  for (const double degrees : {0.0, 10.0, 40.0, 80.0}) {
    const double incident = degrees * kPiD / 180.0;
    const Vec3d outgoing = direction(std::cos(incident), 0.7);
    std::array<SpecularBranch, 2> branches;
    ASSERT_EQ(brdf.specularBranches(Vec3(outgoing), true, {}, branches), 2);
    ASSERT_TRUE(branches[1].transmitted);
    const double refracted = std::asin(std::sin(incident) / 1.5);
    // On the other side of the normal and of the surface, in the plane of incidence.
    const Vec3d expected = -direction(std::cos(refracted), 0.7);
    EXPECT_LT(glm::length(Vec3d(branches[1].direction) - expected), 1e-6) << degrees << " degrees";
    EXPECT_NEAR(glm::length(branches[1].direction), 1.0f, 1e-6f);
    EXPECT_LT(glm::length(Vec3d(branches[0].direction) - Vec3d(-outgoing.x, -outgoing.y, outgoing.z)), 1e-6);
  }
}

TEST(Glass, KeepsAllLightAndAUniformSurroundingUniform) {
  // Basic radiance: the branches' weights add up to 1 on either side, so that light of 1 from everywhere
  // gives 1 everywhere, inside too; with the factor n^2 on the transmitted branch it would not.
  const Brdf brdf = glass(1.5);
  for (const bool entering : {true, false}) {
    for (const double cosine : {1e-6, 1e-3, 0.1, 0.5, 0.745, 0.746, 0.9, 1.0}) {
      std::array<SpecularBranch, 2> branches;
      const int count = brdf.specularBranches(Vec3(direction(cosine, 0.2)), entering, {}, branches);
      double sum = 0.0;
      for (int i = 0; i < count; ++i) sum += double{branches[static_cast<std::size_t>(i)].weight.x};
      EXPECT_NEAR(sum, 1.0, 1e-6) << "cos " << cosine << (entering ? " entering" : " leaving");
    }
  }
}

TEST(Glass, PassesTheSameInBothDirections) {
  const Brdf brdf = glass(1.5, Rgb(0.9f, 0.5f, 0.2f));
  for (const double cosine : {0.05, 0.3, 0.8}) {
    std::array<SpecularBranch, 2> in;
    ASSERT_EQ(brdf.specularBranches(Vec3(direction(cosine, 0.2)), true, {}, in), 2);
    // From inside, the viewer stands where the refracted ray went: its normal is turned over.
    const Vec3 inside = in[1].direction * Vec3(1.0f, 1.0f, -1.0f);
    std::array<SpecularBranch, 2> out;
    ASSERT_EQ(brdf.specularBranches(inside, false, {}, out), 2);
    for (int channel = 0; channel < 3; ++channel) {
      // 1 - F loses digits near the critical angle: cos 0.05 outside is 0.0014 short of it inside.
      EXPECT_NEAR(out[1].weight[channel], in[1].weight[channel], 2e-5f) << "cos " << cosine;
    }
  }
}

TEST(Glass, HasOneBranchUnderTotalInternalReflection) {
  const Brdf brdf = glass(1.5);
  std::array<SpecularBranch, 2> branches;
  ASSERT_EQ(brdf.specularBranches(Vec3(direction(0.5, 0.2)), false, {}, branches), 1);
  EXPECT_FALSE(branches[0].transmitted);
  EXPECT_EQ(branches[0].weight, Rgb(1.0f));
}

TEST(Glass, OfIndexOneIsNotThere) {
  const Brdf brdf = glass(1.0);
  const Vec3 outgoing(direction(0.3, 0.2));
  std::array<SpecularBranch, 2> branches;
  ASSERT_EQ(brdf.specularBranches(outgoing, true, {}, branches), 1);
  EXPECT_TRUE(branches[0].transmitted);
  EXPECT_EQ(branches[0].weight, Rgb(1.0f));
  EXPECT_LT(glm::length(branches[0].direction + outgoing), 1e-6f);
}

TEST(Glass, ColoursWhatItPassesNotWhatItReflects) {
  const Rgb color(0.2f, 0.5f, 1.0f);
  const Brdf brdf = glass(1.5, color);
  std::array<SpecularBranch, 2> branches;
  ASSERT_EQ(brdf.specularBranches(Vec3(0.0f, 0.0f, 1.0f), true, {}, branches), 2);
  EXPECT_NEAR(branches[0].weight.x, 0.04f, 1e-6f);
  EXPECT_EQ(branches[0].weight.x, branches[0].weight.z);
  for (int channel = 0; channel < 3; ++channel) {
    EXPECT_NEAR(branches[1].weight[channel], 0.96f * color[channel], 1e-6f);
  }
}

TEST(Mirror, ReflectsItsColourAtEveryAngle) {
  MaterialDescription material;
  material.mirror = Rgb(0.9f, 0.5f, 0.25f);
  const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
  EXPECT_TRUE(brdf.hasSpecular());
  EXPECT_FALSE(brdf.hasNonSpecular());
  EXPECT_FALSE(brdf.isGlass());
  for (const double cosine : {1e-6, 0.3, 1.0}) {
    const Vec3 outgoing(direction(cosine, 2.0));
    std::array<SpecularBranch, 2> branches;
    ASSERT_EQ(brdf.specularBranches(outgoing, true, {}, branches), 1);
    EXPECT_EQ(branches[0].weight, material.mirror);
    EXPECT_EQ(branches[0].direction, Vec3(-outgoing.x, -outgoing.y, outgoing.z));
  }
}

TEST(Lambert, IsNeitherSpecularNorALobe) {
  MaterialDescription material;
  material.diffuse = Rgb(0.5f, 0.25f, 0.0f);
  const Brdf brdf = Brdf::compile(material, EnergyRule::Refined);
  EXPECT_TRUE(brdf.hasDiffuse());
  EXPECT_FALSE(brdf.hasLobe());
  EXPECT_FALSE(brdf.hasSpecular());
  const Vec3 a(direction(0.3, 0.0));
  const Vec3 b(direction(0.8, 2.0));
  EXPECT_EQ(brdf.evaluate(a, b), material.diffuse * kInvPi);
  EXPECT_EQ(brdf.evaluate(-a, b), Rgb(0.0f));
  std::array<SpecularBranch, 2> branches;
  EXPECT_EQ(brdf.specularBranches(a, true, {}, branches), 0);
}

}  // namespace
}  // namespace lightvane
