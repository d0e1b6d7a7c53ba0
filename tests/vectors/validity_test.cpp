#include "core/vectors/validity.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/base/random.h"

// Weights and refusals: sections 4.2 and 5.4, 5.5, as corrected and as printed.

namespace lightvane {
namespace {

// ---- Direct Light Vectors ----

TEST(DlvWeight, NormalisedIsOneAtTheVectorAndZeroAtTheRadius) {
  for (const float rMax : {1e-6f, 0.08f, 1.0f, 1e6f}) {
    EXPECT_EQ(dlvWeightNormalised(0.0f, rMax), 1.0f);
    EXPECT_EQ(dlvWeightNormalised(rMax, rMax), 0.0f);
    EXPECT_EQ(dlvWeightNormalised(2.0f * rMax, rMax), 0.0f);
    EXPECT_FLOAT_EQ(dlvWeightNormalised(0.5f * rMax, rMax), 0.25f);
    float last = 1.0f;
    for (int i = 1; i <= 1000; ++i) {
      const float w = dlvWeightNormalised(rMax * static_cast<float>(i) / 1000.0f, rMax);
      // Near 0 the polynomial is flat: steps may round away, never up by more than rounding.
      ASSERT_LE(w, last + 2e-7f) << "at " << i << " thousandths of " << rMax;
      last = w;
    }
  }
  EXPECT_EQ(dlvWeightNormalised(0.0f, 0.0f), 0.0f) << "no radius, no weight, no NaN";
}

TEST(DlvWeight, NormalisedKnowsNoUnit) {
  for (const int exponent : {-20, 20}) {
    const float scale = std::ldexp(1.0f, exponent);
    for (int i = 0; i < 50; ++i) {
      const float d = 0.02f * static_cast<float>(i);
      EXPECT_EQ(dlvWeightNormalised(d * scale, 0.9f * scale), dlvWeightNormalised(d, 0.9f));
    }
  }
}

// Pins the print, faults included: at the paper's r_max = 0.08 m it is a box that even grows with distance.
TEST(DlvWeight, PrintedIsReversed) {
  const float rMax = 0.08f;
  EXPECT_FLOAT_EQ(dlvWeightPrinted(0.0f, rMax), square(2.0f * 0.000512f - 3.0f * 0.0064f + 1.0f));
  EXPECT_FLOAT_EQ(dlvWeightPrinted(rMax, rMax), 1.0f);
  for (int i = 0; i <= 80; ++i) {
    const float d = 0.001f * static_cast<float>(i);
    EXPECT_GT(dlvWeightPrinted(d, rMax), 0.96f);
    EXPECT_LE(dlvWeightPrinted(d, rMax), 1.000001f);
    if (i > 0) {
      EXPECT_GT(dlvWeightPrinted(d, rMax), dlvWeightPrinted(d - 0.001f, rMax));
    }
  }
  EXPECT_NE(dlvWeightPrinted(0.04f, 0.08f), dlvWeightPrinted(4.0f, 8.0f)) << "it depends on the unit";
}

TEST(DlvDispersion, VariationKnowsNoUnitAndAcceptsTheDark) {
  DlvParameters p;
  p.dispersion = 0.1;
  EXPECT_TRUE(dlvDispersionAccepts(p, 0.0, 0.0)) << "all dark is alike";
  for (const double unit : {1e-30, 1.0, 1e30}) {
    EXPECT_TRUE(dlvDispersionAccepts(p, 2.0 * unit, square(0.19 * unit))) << "sigma / mean = 0.095";
    EXPECT_FALSE(dlvDispersionAccepts(p, 2.0 * unit, square(0.21 * unit))) << "sigma / mean = 0.105";
  }
}

TEST(DlvDispersion, PrintedAcceptsVariancesBeyondTheThreshold) {
  DlvParameters p;
  p.dispersion = 0.2;
  p.dispersionMeasure = DlvDispersion::VarianceAbove;
  EXPECT_FALSE(dlvDispersionAccepts(p, 1.0, 0.0)) << "what is all alike is refused: as printed";
  EXPECT_FALSE(dlvDispersionAccepts(p, 1.0, 0.2));
  EXPECT_TRUE(dlvDispersionAccepts(p, 1.0, 0.21));
  EXPECT_TRUE(dlvDispersionAccepts(p, 100.0, 0.21)) << "whatever the mean";
}

// ---- Indirect Light Vectors ----

IndirectLightVector record() {
  IndirectLightVector r;
  r.point.position = {0.1f, 0.2f, 0.3f};
  r.point.normal = {0, 0, 1};
  r.point.outgoing = {0, 0, 1};
  r.point.footprint = 0.01f;
  r.energy = r.irradiance = Rgb(2.0f, 1.0f, 0.5f);
  r.arithmeticMean = 0.8f;
  r.harmonicMean = 0.4f;
  r.leastDistance = 0.1f;
  return r;
}

/// The radius of `record` is 0.2 by these: half the harmonic mean, nothing else bounds it.
IlvParameters plainParameters() {
  IlvParameters p;
  p.radiusScale = 0.5;
  p.radiusMinPixels = 0.0;
  p.radiusMaxPixels = 0.0;
  p.radiusMinHit = 0.0;
  return p;
}

struct Weighed {
  float weight;
  Refusal refusal;
};

Weighed weigh(const IndirectLightVector& r, const IlvParameters& p, const Vec3& offset,
              const Vec3& normal = {0, 0, 1}, const Vec3& outgoing = {0, 0, 1}) {
  const IlvRules rules(p, 1.0f);
  Refusal refusal;
  const float weight =
      ilvWeight(makeCandidate(r, rules), r.point.position + offset, normal, outgoing, rules, refusal);
  return {weight, refusal};
}

Vec3 tilted(float angle) { return {std::sin(angle), 0.0f, std::cos(angle)}; }

TEST(IlvRadius, FollowsItsRules) {
  IndirectLightVector r = record();
  IlvParameters p = plainParameters();
  const auto radius = [&] { return ilvRadius(r, IlvRules(p, 1.0f)); };
  EXPECT_FLOAT_EQ(radius(), 0.2f);
  p.radius = IlvRadius::Arithmetic;
  EXPECT_FLOAT_EQ(radius(), 0.4f);
  p.radiusScale = 1.0;
  EXPECT_FLOAT_EQ(radius(), 0.8f);
  r.arithmeticMean = kInfinity;
  EXPECT_FLOAT_EQ(radius(), 1.0f) << "nothing met: the scene's diagonal";
  p = plainParameters();
  p.radiusMinHit = 1.5;
  EXPECT_FLOAT_EQ(radius(), 0.15f);
  p.radiusMaxPixels = 5.0;
  EXPECT_FLOAT_EQ(radius(), 0.05f);
  p.radiusMaxPixels = 0.0;
  p.radiusMinPixels = 30.0;
  EXPECT_FLOAT_EQ(radius(), 0.3f) << "the least radius wins over the least distance";
  p = plainParameters();
  r.lobeWidth = 0.25f;
  EXPECT_FLOAT_EQ(radius(), 0.05f) << "a narrow lobe's picture moves with the point";
}

TEST(IlvWeight, EdgeIsOneAtTheVectorAndZeroAtTheEdge) {
  const IndirectLightVector r = record();
  const IlvParameters p = plainParameters();
  EXPECT_EQ(weigh(r, p, {0, 0, 0}).weight, 1.0f);
  EXPECT_NEAR(weigh(r, p, {0.1f, 0, 0}).weight, 0.5f, 1e-6f);
  EXPECT_NEAR(weigh(r, p, {0.19999f, 0, 0}).weight, 0.0f, 1e-4f);
  EXPECT_EQ(weigh(r, p, {0.2001f, 0, 0}).refusal, Refusal::Distance);
  float last = 1.0f;
  for (int i = 1; i < 100; ++i) {
    const Weighed w = weigh(r, p, {0.002f * static_cast<float>(i), 0, 0});
    EXPECT_EQ(w.refusal, Refusal::None);
    EXPECT_LT(w.weight, last);
    last = w.weight;
  }
  // Likewise in the angle: zero where the cosine is S_curv.
  const float limit = std::acos(static_cast<float>(p.sCurv));
  EXPECT_NEAR(weigh(r, p, {0, 0, 0}, tilted(0.5f * limit)).weight, 0.5f, 2e-3f);
  EXPECT_NEAR(weigh(r, p, {0, 0, 0}, tilted(0.999f * limit)).weight, 0.0f, 2e-3f);
  EXPECT_EQ(weigh(r, p, {0, 0, 0}, tilted(1.001f * limit)).refusal, Refusal::Curvature);
  // The worse of the two counts.
  EXPECT_EQ(weigh(r, p, {0, 0.15f, 0}, tilted(0.5f * limit)).weight, weigh(r, p, {0, 0.15f, 0}).weight);
}

TEST(IlvWeight, KnowsNoUnitOfLength) {
  for (const IlvWeight kind : {IlvWeight::Edge, IlvWeight::Absolute, IlvWeight::Printed}) {
    IlvParameters p = plainParameters();
    p.weight = kind;
    p.gradientTest = IlvGradientTest::Absolute;
    p.sE = 0.5;
    // Its allowance for rounding is absolute, in units in which the scene is about 1.
    p.inFront = false;
    const RandomKey key = randomKey(71);
    int valid = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
      IndirectLightVector r = record();
      const Vec3 offset =
          0.3f * (Vec3(uniform(key, i, 0), uniform(key, i, 1), 0.0f) - Vec3(0.5f, 0.5f, 0.0f));
      for (int c = 0; c < 3; ++c) r.gradient[c] = 4.0f * Vec3(uniform(key, i, 2), uniform(key, i, 3), 0.0f);
      // The offset as floats see it, so that scaling is exact.
      const Vec3 at = r.point.position + offset;
      const IlvRules same(p, 1.0f);
      Refusal refusal;
      const float expected = ilvWeight(makeCandidate(r, same), at, tilted(0.1f), {0, 0, 1}, same, refusal);
      valid += refusal == Refusal::None ? 1 : 0;
      for (const int exponent : {-20, -10, 10, 20}) {
        const float scale = std::ldexp(1.0f, exponent);
        IndirectLightVector s = r;
        s.point.position *= scale;
        s.point.footprint *= scale;
        s.arithmeticMean *= scale;
        s.harmonicMean *= scale;
        s.leastDistance *= scale;
        for (Vec3& g : s.gradient) g /= scale;
        const IlvRules rules(p, scale);
        Refusal scaledRefusal;
        const float weight =
            ilvWeight(makeCandidate(s, rules), at * scale, tilted(0.1f), {0, 0, 1}, rules, scaledRefusal);
        ASSERT_EQ(weight, expected) << "2^" << exponent << ", point " << i;
        ASSERT_EQ(scaledRefusal, refusal);
      }
    }
    EXPECT_GT(valid, 50) << "of 300, weight " << static_cast<int>(kind);
  }
}

TEST(IlvWeight, KnowsNoHandedness) {
  const RandomKey key = randomKey(72);
  IlvParameters p = plainParameters();
  p.gradientTest = IlvGradientTest::Absolute;
  for (std::uint32_t i = 0; i < 300; ++i) {
    IndirectLightVector r = record();
    const Vec3 offset = 0.3f * (Vec3(uniform(key, i, 0), uniform(key, i, 1), uniform(key, i, 2)) - 0.5f);
    const Vec3 normal =
        glm::normalize(Vec3(0.3f * (uniform(key, i, 3) - 0.5f), 0.3f * uniform(key, i, 4), 1));
    for (int c = 0; c < 3; ++c) r.gradient[c] = {uniform(key, i, 5), uniform(key, i, 6), 0.0f};
    const Vec3 mirror(-1, 1, 1);
    IndirectLightVector m = r;
    m.point.position *= mirror;
    for (Vec3& g : m.gradient) g *= mirror;
    const Weighed a = weigh(r, p, offset, normal);
    const Weighed b = weigh(m, p, offset * mirror, normal * mirror);
    ASSERT_EQ(a.refusal, b.refusal);
    ASSERT_EQ(a.weight, b.weight);
  }
}

TEST(IlvWeight, EachRuleRefuses) {
  const IndirectLightVector r = record();
  IlvParameters p = plainParameters();
  EXPECT_EQ(weigh(r, p, {0.21f, 0, 0}).refusal, Refusal::Distance);
  EXPECT_EQ(weigh(r, p, {0.1f, 0, 0}, {1, 0, 0}).refusal, Refusal::Curvature);

  // In front (Ward 1988): the vector stands above the point's plane.
  EXPECT_EQ(weigh(r, p, {0.05f, 0, -0.05f}).refusal, Refusal::InFront);
  EXPECT_EQ(weigh(r, p, {0.05f, 0, 0.05f}).refusal, Refusal::None) << "below it is fine";
  EXPECT_EQ(weigh(r, p, {0.05f, 0, -4e-4f}).refusal, Refusal::None) << "within the slope of rounding";
  p.inFront = false;
  EXPECT_EQ(weigh(r, p, {0.05f, 0, -0.05f}).refusal, Refusal::None);

  // The gradient's prediction: brightness 1.242, change +-0.5 at 0.1.
  p = plainParameters();
  IndirectLightVector g = r;
  for (Vec3& gradient : g.gradient) gradient = {5.0f, 0, 0};
  p.gradientTest = IlvGradientTest::Off;
  EXPECT_EQ(weigh(g, p, {0.1f, 0, 0}).refusal, Refusal::None);
  p.gradientTest = IlvGradientTest::Signed;
  EXPECT_EQ(weigh(g, p, {0.1f, 0, 0}).refusal, Refusal::Gradient);
  EXPECT_EQ(weigh(g, p, {-0.1f, 0, 0}).refusal, Refusal::None) << "as printed: any fall passes";
  p.gradientTest = IlvGradientTest::Absolute;
  EXPECT_EQ(weigh(g, p, {0.1f, 0, 0}).refusal, Refusal::Gradient);
  EXPECT_EQ(weigh(g, p, {-0.1f, 0, 0}).refusal, Refusal::Gradient);
  EXPECT_EQ(weigh(g, p, {0.04f, 0, 0}).refusal, Refusal::None) << "0.2 / 1.242 is below S_E = 0.2";
  p.sE = 0.5;
  EXPECT_EQ(weigh(g, p, {0.1f, 0, 0}).refusal, Refusal::None);
  // Where there is no light there is no relative change either: accepted, not 0/0.
  IndirectLightVector dark = r;
  dark.energy = dark.irradiance = Rgb(0.0f);
  EXPECT_EQ(weigh(dark, p, {0.1f, 0, 0}).refusal, Refusal::None);

  // The view turns by more than the lobe's width; irradiance does not care.
  p = plainParameters();
  IndirectLightVector lobe = r;
  lobe.lobeWidth = 0.3f;
  EXPECT_EQ(weigh(lobe, p, {0, 0, 0}, {0, 0, 1}, tilted(0.29f)).refusal, Refusal::None);
  EXPECT_EQ(weigh(lobe, p, {0, 0, 0}, {0, 0, 1}, tilted(0.31f)).refusal, Refusal::Lobe);
  EXPECT_NEAR(weigh(lobe, p, {0, 0, 0}, {0, 0, 1}, tilted(0.15f)).weight, 0.5f, 1e-2f);
  EXPECT_EQ(weigh(r, p, {0, 0, 0}, {0, 0, 1}, tilted(3.0f)).refusal, Refusal::None);
  p.lobeAngle = 2.0;
  EXPECT_EQ(weigh(lobe, p, {0, 0, 0}, {0, 0, 1}, tilted(0.31f)).refusal, Refusal::None);
  p.lobeAngle = 100.0;
  EXPECT_EQ(weigh(lobe, p, {0, 0, 0}, {0, 0, 1}, {0, 0, -1}).refusal, Refusal::None) << "at most a half turn";

  for (const Refusal refusal : {Refusal::None, Refusal::Distance, Refusal::Curvature, Refusal::Gradient,
                                Refusal::InFront, Refusal::Lobe, Refusal::Visibility}) {
    EXPECT_STRNE(refusalName(refusal), "");
  }
}

// Eq. 7 made stable, nothing else changed.
TEST(IlvWeight, AbsoluteIsEquation7WithAbsoluteChange) {
  IndirectLightVector r = record();
  for (Vec3& gradient : r.gradient) gradient = {3.0f, 0, 0};
  VectorParameters parameters;
  applyRules(parameters, Rules::Paper);
  IlvParameters p = parameters.ilv;
  p.sE = 10.0;
  p.sCurv = 0.9;
  const float brightness = paperBrightness(r.irradiance);
  for (const float x : {-0.3f, -0.1f, 0.0f, 0.2f}) {
    for (const float angle : {0.0f, 0.2f, 0.4f}) {
      const float expected = 1.0f / (1.0f + std::abs(x) / 0.8f) / (1.0f + std::abs(3.0f * x) / brightness) *
                             (std::cos(angle) - 0.9f) / 0.1f;
      EXPECT_NEAR(weigh(r, p, {x, 0, 0}, tilted(angle)).weight, expected, 2e-6f) << x << ", " << angle;
    }
  }
  EXPECT_EQ(weigh(r, p, {0, 0, 0}).weight, 1.0f);
  EXPECT_NEAR(weigh(r, p, {0.7999f, 0, 0}).weight * (1.0f + 2.4f / brightness), 0.5f, 1e-3f)
      << "one half at the edge: the seam that the refined weight does without";
}

// Nobody is to mend these: `printed` exists to show them.
TEST(IlvWeight, PrintedHasItsPoleAndItsZeroOverZero) {
  IndirectLightVector r = record();
  const float brightness = paperBrightness(r.irradiance);
  for (Vec3& gradient : r.gradient) gradient = {4.0f, 0, 0};
  VectorParameters parameters;
  applyRules(parameters, Rules::Printed);
  IlvParameters p = parameters.ilv;
  p.sCurv = 0.5;
  // A fall passes whatever its size, weighs more than 1, infinitely near -1 and less than 0 beyond.
  const float pole = -brightness / 4.0f;
  EXPECT_EQ(weigh(r, p, {0.5f * pole, 0, 0}).refusal, Refusal::None);
  EXPECT_GT(weigh(r, p, {0.5f * pole, 0, 0}).weight, 1.0f);
  EXPECT_GT(std::abs(weigh(r, p, {0.99999f * pole, 0, 0}).weight), 1e4f);
  EXPECT_LT(weigh(r, p, {1.2f * pole, 0, 0}).weight, 0.0f);
  // S_curv = 1: 0/0 for the very same normal, and rounding away from it is a refusal.
  p.sCurv = 1.0;
  EXPECT_TRUE(std::isnan(weigh(r, p, {0.0f, 0, 0}).weight));
  EXPECT_EQ(weigh(r, p, {0.0f, 0, 0}, tilted(1e-3f)).refusal, Refusal::Curvature);
  // No light at all: 0/0 in the change, too.
  p.sCurv = 0.5;
  IndirectLightVector dark = r;
  dark.energy = dark.irradiance = Rgb(0.0f);
  for (Vec3& gradient : dark.gradient) gradient = Vec3(0.0f);
  EXPECT_TRUE(std::isnan(weigh(dark, p, {0.1f, 0, 0}).weight));
  // Otherwise it is what is printed.
  EXPECT_NEAR(weigh(r, p, {0.02f, 0, 0}, tilted(0.3f)).weight,
              1.0f / (1.0f + 0.02f / 0.8f) / (1.0f + 0.08f / brightness) * (std::cos(0.3f) - 0.5f) / 0.5f,
              2e-6f);
}

TEST(IlvWeight, ClampedCurvatureBearsOne) {
  IlvParameters p = plainParameters();
  p.sCurv = 1.0;
  const IlvRules rules(p, 1.0f);
  EXPECT_FLOAT_EQ(rules.sCurv, 0.999f);
  EXPECT_EQ(weigh(record(), p, {0.05f, 0, 0}).weight,
            weigh(record(), plainParameters(), {0.05f, 0, 0}).weight);
  // Float cosines just below 1 reject nothing.
  EXPECT_EQ(weigh(record(), p, {0.05f, 0, 0}, glm::normalize(Vec3(3e-4f, 0, 1))).refusal, Refusal::None);
}

TEST(IlvExtrapolate, FollowsItsGradientsWithinItsClamps) {
  IndirectLightVector r = record();
  r.gradient[0] = {1.0f, 0, 0};
  r.gradient[1] = {-100.0f, 0, 0};
  r.gradient[2] = {100.0f, 0, 0};
  IlvParameters p;
  const Vec3 at = r.point.position + Vec3(0.1f, 0, 0);
  const Rgb value = ilvExtrapolate(r, at, r.point.normal, p);
  EXPECT_NEAR(value.x, 2.1f, 1e-6f);
  EXPECT_FLOAT_EQ(value.y, 0.1f * 1.0f) << "at least a tenth of its own";
  EXPECT_FLOAT_EQ(value.z, 4.0f * 0.5f) << "at most four times its own";
  p.extrapolate = false;
  EXPECT_EQ(ilvExtrapolate(r, at, r.point.normal, p), r.energy);
  // Turning the normal from z towards x is a rotation about +y.
  p.extrapolate = true;
  for (Vec3& g : r.gradient) g = Vec3(0.0f);
  r.rotation[0] = {0, 0.5f, 0};
  EXPECT_NEAR(ilvExtrapolate(r, r.point.position, tilted(0.1f), p).x, 2.0f + 0.5f * std::sin(0.1f), 1e-6f);
  EXPECT_NEAR(ilvExtrapolate(r, r.point.position, tilted(-0.1f), p).x, 2.0f - 0.5f * std::sin(0.1f), 1e-6f);
}

TEST(IlvGradientLimit, ShortensWhatClaimsTooMuch) {
  IndirectLightVector r = record();
  r.energy = r.irradiance = Rgb(2.0f);
  for (Vec3& g : r.gradient) g = {100.0f, 0, 0};
  IlvParameters p = plainParameters();
  const auto scale = [&] { return makeCandidate(r, IlvRules(p, 1.0f)).gradientScale; };
  p.gradientLimit = 0.0;
  EXPECT_EQ(scale(), 1.0f) << "no limit";
  p.gradientLimit = 4.0;
  EXPECT_FLOAT_EQ(scale(), 4.0f * 2.0f / (100.0f * 0.2f)) << "4 times itself at the edge, 0.2 away";
  for (Vec3& g : r.gradient) g = {1.0f, 0, 0};
  EXPECT_EQ(scale(), 1.0f) << "a tenth of itself at the edge";
  p.radiusMinPixels = 30.0;
  EXPECT_FLOAT_EQ(scale(), 0.2f / 0.3f) << "the picture's least radius is 0.3, the gather vouches for 0.2";
  p.gradientLimit = 0.0;
  EXPECT_EQ(scale(), 1.0f) << "no limit";
}

TEST(Rules, ArePinned) {
  VectorParameters p;
  p.ilv.rows = 5;
  applyRules(p, Rules::Printed);
  EXPECT_EQ(p.dlv.dispersionMeasure, DlvDispersion::VarianceAbove);
  EXPECT_EQ(p.dlv.weight, DlvWeight::Printed);
  EXPECT_EQ(p.ilv.weight, IlvWeight::Printed);
  EXPECT_EQ(p.ilv.gradientTest, IlvGradientTest::Signed);
  EXPECT_EQ(p.ilv.gradient, IlvGradient::Printed);
  EXPECT_EQ(p.ilv.radius, IlvRadius::Arithmetic);
  EXPECT_EQ(p.ilv.nMin, 3);
  EXPECT_EQ(p.dlv.nMin, 5);
  EXPECT_EQ(p.dlv.nMax, 50);
  EXPECT_EQ(p.dlv.rMax, Length::metres(0.08));
  EXPECT_EQ(p.dlv.dispersion, 0.2);
  EXPECT_FALSE(p.ilv.curvatureClamp);
  applyRules(p, Rules::Paper);
  EXPECT_EQ(p.ilv.weight, IlvWeight::Absolute);
  EXPECT_EQ(p.ilv.gradientTest, IlvGradientTest::Absolute);
  EXPECT_EQ(p.dlv.dispersionMeasure, DlvDispersion::Variation);
  EXPECT_TRUE(p.ilv.curvatureClamp);
  EXPECT_FALSE(p.ilv.extrapolate);
  applyRules(p, Rules::Refined);
  EXPECT_EQ(p.ilv.weight, IlvWeight::Edge);
  EXPECT_EQ(p.ilv.store, VectorStore::Split);
  EXPECT_TRUE(p.ilv.extrapolate && p.ilv.visibility && p.ilv.inFront);
  EXPECT_EQ(p.ilv.rows, 5) << "sampling density is left alone";
}

}  // namespace
}  // namespace lightvane
