#include "core/measure/metric.h"

#include <set>

#include "core/base/check.h"
#include "tests/measure/metric_pictures.h"

namespace lightvane {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Those whose value does not depend on the pictures' unit.
const std::vector<std::string> kScaleFree{"bias", "mrae", "relmse", "relative", "worst-tile", "hdrflip"};

double bestValue(const MetricInfo& metric) {
  if (metric.name == "ssim") return 1.0;
  return metric.name == "psnr" ? std::numeric_limits<double>::infinity() : 0.0;
}

TEST(Metrics, HaveNamesOfTheirOwnAndWords) {
  std::set<std::string_view> names;
  for (const MetricInfo& metric : metrics()) {
    EXPECT_TRUE(names.insert(metric.name).second) << metric.name;
    EXPECT_EQ(findMetric(metric.name), &metric);
    EXPECT_FALSE(metric.label.empty()) << metric.name;
    EXPECT_TRUE(metric.description.ends_with('.')) << metric.name;
    EXPECT_FALSE(metric.map.empty()) << metric.name;
  }
  EXPECT_EQ(names, (std::set<std::string_view>{"bias", "mrae", "rmse", "relmse", "relative", "worst-tile",
                                               "psnr", "ssim", "flip", "hdrflip"}));
  EXPECT_EQ(findMetric("relMSE"), nullptr);
  EXPECT_EQ(findMetric(""), nullptr);
}

TEST(Metrics, OfEqualPicturesAreTheBestValue) {
  const ImageRgb picture = randomPicture(37, 29, 1);
  for (const MetricInfo& metric : metrics()) {
    const MetricResult result = metric.compute({.picture = picture, .reference = picture});
    EXPECT_EQ(result.value, bestValue(metric)) << metric.name;
    EXPECT_EQ(largestOf(result.map), 0.0) << metric.name;
    EXPECT_EQ(result.counted, picture.size()) << metric.name;
    EXPECT_FALSE(result.ofReference) << metric.name;
  }
}

TEST(Metrics, SeeADifference) {
  const ImageRgb reference = randomPicture(37, 29, 1);
  const ImageRgb picture = scaledPicture(reference, 1.25f);
  for (const MetricInfo& metric : metrics()) {
    const MetricResult result = metric.compute({.picture = picture, .reference = reference});
    EXPECT_GT(std::abs(result.value - bestValue(metric)), 0.005) << metric.name;
    EXPECT_GT(largestOf(result.map), 0.0) << metric.name;
    ASSERT_TRUE(result.standardError) << metric.name;
    EXPECT_GT(*result.standardError, 0.0) << metric.name;
    for (const float value : result.map) ASSERT_GE(value, 0.0f) << metric.name;
  }
}

TEST(Metrics, AreTheSameWhenAskedAgain) {
  const ImageRgb reference = randomPicture(40, 30, 1), picture = randomPicture(40, 30, 2);
  const ImageRgb variance(40, 30, Rgb(0.01f));
  for (const MetricInfo& metric : metrics()) {
    const MetricInput input{.picture = picture, .reference = reference, .variance = &variance};
    const MetricResult first = metric.compute(input), second = metric.compute(input);
    EXPECT_EQ(first.value, second.value) << metric.name;
    EXPECT_EQ(first.standardError, second.standardError) << metric.name;
    EXPECT_EQ(first.ofReference, second.ofReference) << metric.name;
    EXPECT_EQ(first.map, second.map) << metric.name;
  }
}

// A wrong pixel that the mask leaves out has no part in any metric, nor have the pixels beside it.
TEST(Metrics, LeaveOutWhatIsMasked) {
  const ImageRgb reference = randomPicture(40, 30, 1);
  ImageRgb picture = reference;
  ImageFloat mask(40, 30, 1.0f);
  for (int y = 10; y < 14; ++y) {
    for (int x = 20; x < 26; ++x) {
      picture.at(x, y) = Rgb(50.0f, 0.0f, 1.0f);
      mask.at(x, y) = 0.0f;
    }
  }
  for (const MetricInfo& metric : metrics()) {
    const MetricResult result = metric.compute({.picture = picture, .reference = reference, .mask = &mask});
    EXPECT_EQ(result.value, bestValue(metric)) << metric.name;
    EXPECT_EQ(result.counted, 40u * 30u - 24u) << metric.name;
    EXPECT_EQ(result.notFinite, 0u) << metric.name;
    EXPECT_EQ(largestOf(result.map), 0.0) << metric.name;
    EXPECT_NE(metric.compute({.picture = picture, .reference = reference}).value, bestValue(metric))
        << metric.name << " without the mask";
  }
}

TEST(Metrics, LeaveOutAndCountWhatIsNotFinite) {
  ImageRgb reference = randomPicture(40, 30, 1);
  ImageRgb picture = reference;
  picture.at(3, 4).g = kNan;
  picture.at(30, 20).r = kInfinity;
  reference.at(10, 10).b = -kInfinity;
  reference.at(30, 20).b = kNan;
  for (const MetricInfo& metric : metrics()) {
    const MetricResult result = metric.compute({.picture = picture, .reference = reference});
    EXPECT_EQ(result.value, bestValue(metric)) << metric.name;
    EXPECT_EQ(result.notFinite, 3u) << metric.name;
    EXPECT_EQ(result.counted, 40u * 30u - 3u) << metric.name;
    for (const float value : result.map) ASSERT_EQ(value, 0.0f) << metric.name;
  }
}

TEST(Metrics, OfNothingAreNotNumbers) {
  const ImageRgb picture = randomPicture(20, 20, 1);
  const ImageRgb broken(20, 20, Rgb(kNan));
  const ImageRgb variance(20, 20, Rgb(1.0f));
  const ImageFloat mask(20, 20, 0.0f);
  for (const MetricInfo& metric : metrics()) {
    const MetricResult masked =
        metric.compute({.picture = picture, .reference = picture, .variance = &variance, .mask = &mask});
    EXPECT_TRUE(std::isnan(masked.value)) << metric.name;
    EXPECT_EQ(masked.counted, 0u) << metric.name;
    EXPECT_FALSE(masked.standardError || masked.ofReference) << metric.name;
    const MetricResult unknown = metric.compute({.picture = picture, .reference = broken});
    EXPECT_TRUE(std::isnan(unknown.value)) << metric.name;
    EXPECT_EQ(unknown.notFinite, 400u) << metric.name;
  }
}

TEST(Metrics, RefuseOtherSizes) {
  const ImageRgb small(8, 8, Rgb(1.0f)), large(9, 8, Rgb(1.0f));
  const ImageFloat mask(8, 9, 1.0f);
  for (const MetricInfo& metric : metrics()) {
    EXPECT_THROW(metric.compute({.picture = small, .reference = large}), InvariantViolation) << metric.name;
    EXPECT_THROW(metric.compute({.picture = small, .reference = small, .variance = &large}),
                 InvariantViolation)
        << metric.name;
    EXPECT_THROW(metric.compute({.picture = small, .reference = small, .mask = &mask}), InvariantViolation)
        << metric.name;
    EXPECT_THROW(metric.compute({.picture = {}, .reference = {}}), InvariantViolation) << metric.name;
  }
}

// A power of two changes no digit; 1e10 and 1e-10 change what rounding does, which is 1e-7 of a pixel's
// value.
TEST(Metrics, OfRelativeErrorsDoNotDependOnTheUnit) {
  const ImageRgb reference = randomPicture(40, 30, 1);
  ImageRgb picture = reference;
  addNoise(picture, 0.05f, 2);
  picture = scaledPicture(picture, 1.1f);
  const ImageRgb variance(40, 30, Rgb(1e-4f));
  for (const std::string& name : kScaleFree) {
    const MetricResult one =
        measure(name, {.picture = picture, .reference = reference, .variance = &variance});
    for (const float factor : {0x1p20f, 0x1p-30f, 1e10f, 1e-10f}) {
      const ImageRgb a = scaledPicture(picture, factor), b = scaledPicture(reference, factor);
      const ImageRgb v = scaledPicture(variance, factor * factor);
      const MetricResult other = measure(name, {.picture = a, .reference = b, .variance = &v});
      const bool isPowerOfTwo = factor == 0x1p20f || factor == 0x1p-30f;
      EXPECT_NEAR(other.value, one.value, (isPowerOfTwo ? 1e-12 : 1e-5) * one.value) << name << " " << factor;
      EXPECT_NEAR(*other.standardError, *one.standardError, 1e-5 * *one.standardError)
          << name << " " << factor;
      // A number of noise at a clipped value may fall to either side.
      EXPECT_NEAR(*other.ofReference, *one.ofReference, 1e-4 * *one.ofReference + 1e-9)
          << name << " " << factor;
    }
  }
}

// Of those that look at what a screen shows, a factor of 2^k is an exposure of -k stops.
TEST(Metrics, OfScreensDoNotDependOnTheUnitWithItsExposure) {
  const ImageRgb reference = randomPicture(40, 30, 1), picture = randomPicture(40, 30, 2);
  const ImageRgb darkReference = scaledPicture(reference, 0x1p-40f),
                 darkPicture = scaledPicture(picture, 0x1p-40f);
  for (const std::string name : {"psnr", "ssim", "flip"}) {
    const double one = valueOf(name, picture, reference);
    const double dark =
        measure(name, {.picture = darkPicture, .reference = darkReference, .exposureStops = 40.0}).value;
    EXPECT_EQ(dark, one) << name;
    EXPECT_NE(measure(name, {.picture = picture, .reference = reference, .exposureStops = -1.0}).value, one)
        << name;
  }
}

TEST(Metrics, OfABlackReferenceAreFiniteButForTheBias) {
  const ImageRgb black(20, 20, Rgb(0.0f)), grey(20, 20, Rgb(0.5f));
  for (const MetricInfo& metric : metrics()) {
    EXPECT_EQ(valueOf(metric.name, black, black), bestValue(metric)) << metric.name;
    const MetricResult result = metric.compute({.picture = grey, .reference = black});
    EXPECT_EQ(std::isfinite(result.value), metric.name != "bias") << metric.name;
    for (const float value : result.map) ASSERT_TRUE(std::isfinite(value)) << metric.name;
  }
  EXPECT_EQ(valueOf("bias", grey, black), std::numeric_limits<double>::infinity());
  for (const std::string name : {"mrae", "relmse", "relative", "worst-tile"})
    EXPECT_EQ(valueOf(name, grey, black), 1.0) << name;
}

// Smaller than all filters' kernels, and than a tile.
TEST(Metrics, OfTinyPicturesAreFinite) {
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 7), std::pair(3, 2), std::pair(40, 1)}) {
    const ImageRgb reference(width, height, Rgb(0.5f));
    ImageRgb picture(width, height, Rgb(0.55f));
    for (const MetricInfo& metric : metrics()) {
      const MetricResult result = metric.compute({.picture = picture, .reference = reference});
      const bool isOnePixel = width * height == 1;
      // One pixel is no region.
      EXPECT_EQ(std::isfinite(result.value), !(isOnePixel && metric.name == "worst-tile"))
          << metric.name << " of " << width << "x" << height;
      EXPECT_TRUE(!isOnePixel || !result.standardError) << metric.name;
      EXPECT_EQ(result.map.size(), reference.size()) << metric.name;
    }
    for (const std::string name : {"bias", "mrae", "relative"})
      EXPECT_NEAR(valueOf(name, picture, reference), 0.1, 1e-5) << name << " of " << width << "x" << height;
  }
}

// What a perfect picture shows for the reference's noise is foretold from the noise alone: within 10 %, of
// 120 000 numbers whose distribution is even where the normal one is assumed.
TEST(Metrics, TellWhatTheReferencesNoiseAloneMakes) {
  constexpr float kNoise = 0.02f;
  const ImageRgb truth(200, 200, Rgb(0.4f));
  ImageRgb reference = truth;
  addNoise(reference, kNoise, 3);
  const ImageRgb variance(200, 200, Rgb(kNoise * kNoise));
  for (const std::string name : {"mrae", "psnr", "ssim", "flip", "hdrflip"}) {
    const MetricResult result =
        measure(name, {.picture = truth, .reference = reference, .variance = &variance});
    ASSERT_FALSE(metricNamed(name).subtractsNoise) << name;
    const double stated = *result.ofReference;
    // PSNR is logarithmic. SSIM is told from a reference whose own noise is structure that both pictures
    // have.
    const double tolerance = name == "psnr" ? 0.2 : name == "ssim" ? 0.05 : 0.1 * stated;
    EXPECT_NEAR(result.value, stated, tolerance) << name;
  }
  for (const std::string name : {"rmse", "relmse", "relative"}) {
    const MetricResult result =
        measure(name, {.picture = truth, .reference = reference, .variance = &variance});
    ASSERT_TRUE(metricNamed(name).subtractsNoise) << name;
    const double unsubtracted = valueOf(name, truth, reference);
    EXPECT_NEAR(*result.ofReference, unsubtracted, 0.05 * unsubtracted) << name;
    EXPECT_LT(result.value, 0.4 * unsubtracted) << name;
  }
  // The picture is right, and its bias as far from 0 as the noise allows: twice its deviation or less, of a
  // seed that is no outlier.
  const MetricResult bias =
      measure("bias", {.picture = truth, .reference = reference, .variance = &variance});
  EXPECT_NEAR(*bias.ofReference, 0.05 / 200.0, 1e-6);
  EXPECT_LT(std::abs(bias.value), 2.0 * *bias.ofReference);
}

TEST(Metrics, TakeNoNoiseFromWhatIsNoVariance) {
  const ImageRgb reference = randomPicture(20, 20, 1), picture = randomPicture(20, 20, 2);
  const ImageRgb variance(20, 20, Rgb(kNan, -1.0f, kInfinity));
  for (const std::string name : {"rmse", "relmse", "relative"}) {
    const MetricResult result =
        measure(name, {.picture = picture, .reference = reference, .variance = &variance});
    EXPECT_EQ(result.value, valueOf(name, picture, reference)) << name;
    EXPECT_EQ(result.ofReference, 0.0) << name;
  }
}

}  // namespace
}  // namespace lightvane
