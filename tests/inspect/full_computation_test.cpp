#include "core/inspect/full_computation.h"

#include <cmath>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/frame_points.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

using testing::HasSubstr;

const StopFlag kNever = false;
constexpr int kSize = 24;

// ---- the parts, as arithmetic ----

TEST(InterpolationParts, AddUpAndGoWhereTheyBelong) {
  // Irradiance 10 % too high, nothing else: all interpolation.
  const DifferenceParts wide = interpolationParts({Vec3d(1.1), Vec3d(2.2)}, {Vec3d(1.0), Vec3d(2.0)}, true);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(wide.interpolation[c], 0.1, 1e-15);
    EXPECT_NEAR(wide.singleDirection[c], 0.0, 1e-15);
  }
  // The irradiance is right, and the lobe's light is not.
  const DifferenceParts bent = interpolationParts({Vec3d(1.3), Vec3d(2.0)}, {Vec3d(1.0), Vec3d(2.0)}, true);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(bent.interpolation[c], 0.0, 1e-15);
    EXPECT_NEAR(bent.singleDirection[c], 0.3, 1e-15);
    EXPECT_NEAR(bent.sum()[c], 0.3, 1e-15);
  }
  // The same of light without a direction.
  EXPECT_NEAR(interpolationParts({Vec3d(1.3), Vec3d(2.0)}, {Vec3d(1.0), Vec3d(2.0)}, false).interpolation.x,
              0.3, 1e-15);
  // Nothing was seen: no ratio, no NaN.
  const DifferenceParts dark = interpolationParts({Vec3d(1.0), Vec3d(0.0)}, {Vec3d(2.0), Vec3d(0.0)}, true);
  EXPECT_EQ(dark.interpolation, Vec3d(-1.0));
  EXPECT_EQ(dark.singleDirection, Vec3d(0.0));
}

// ---- pictures ----

class FullComputations : public testing::TestWithParam<Way> {
 protected:
  static RenderFrame frame() {
    return renderShipped(GetParam().scene, kSize, GetParam().settings, -1, GetParam().lights);
  }
};

TEST_P(FullComputations, PartsAddUpAndShownIsThePicture) {
  const RenderFrame whole = frame();
  const float scale = whole.scene->normalisation.radianceScale();
  const bool isSplit = whole.parameters.vectors.ilv.store == VectorStore::Split;
  double direction = 0.0;
  double error = 0.0;
  double bias = 0.0;
  double light = 0.0;
  int pixels = 0;
  for (int i = 0; i < kSize * kSize; i += 5) {
    const int x = i % kSize;
    const int y = i / kSize;
    const FullComputation full = computeHere(whole, x, y, 256, kNever);
    if (!full.finished) {
      EXPECT_THAT(full.note, HasSubstr("no surface")) << x << ", " << y;
      continue;
    }
    EXPECT_EQ(full.samples, 256);
    ++pixels;
    bool hasLobe = false;
    const PixelPoints points = pointsOfPixel(*whole.points, static_cast<std::uint32_t>(i));
    bool hasSpecular = false;
    for (std::uint32_t n = 0; n < points.count; ++n) {
      const VisiblePoint& p = whole.points->tiles[points.tile].points[points.first + n];
      hasLobe = hasLobe || whole.scene->materialOf(p.surface).brdf.hasLobe();
      hasSpecular = hasSpecular || p.throughSpecular;
    }
    for (int c = 0; c < 3; ++c) {
      const double difference = full.total.shown[c] - full.total.full[c];
      // Double sums of some ten terms.
      ASSERT_NEAR(full.total.parts.sum()[c], difference, 1e-13 * (std::abs(difference) + full.total.shown[c]))
          << x << ", " << y;
      if (isSplit || !hasLobe) {
        ASSERT_EQ(full.total.parts.singleDirection[c], 0.0) << x << ", " << y;
      }
      EXPECT_GE(full.standardError[c], 0.0);
      direction += std::abs(full.total.parts.singleDirection[c]);
      error += full.standardError[c];
      bias += difference;
      light += full.total.full[c];
      if (hasSpecular) continue;
      const auto pixel = static_cast<std::size_t>(i);
      const double film = scale * (whole.film->direct[pixel][c] + whole.film->indirect[pixel][c]);
      ASSERT_NEAR(full.total.shown[c], film, 1e-5 * film + 1e-12) << x << ", " << y;
    }
  }
  EXPECT_GT(pixels, 80);
  EXPECT_EQ(direction > 0.0, !isSplit && std::string(GetParam().scene) == "cornell-glossy.toml");
  RecordProperty("told",
                 fmt::format("over {} pixels: difference {:.2f} %, standard error {:.2f} %, single "
                             "direction {:.2f} % of the light",
                             pixels, 100.0 * bias / light, 100.0 * error / light, 100.0 * direction / light));
  // The method's own bias at drafts; a wrong sum would be off by whole lights.
  EXPECT_LT(std::abs(bias / light), 0.1);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, FullComputations,
    testing::Values(
        Way{"cornell", "cornell.toml", {{"preset", "draft"}}},
        Way{"mirror", "cornell-mirror.toml", {{"preset", "draft"}}},
        Way{"glossy", "cornell-glossy.toml", {{"preset", "draft"}}},
        Way{"glossy_paper", "cornell-glossy.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"cornell_paper", "cornell.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"glossy_dlv",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}, {"dlv.r_max", "5%"}}},
        Way{"dimmed", "cornell-mirror.toml", {{"preset", "draft"}, {"dlv.mode", "never"}}, dimmedLight()},
        Way{"dimmed_dlv",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}, {"dlv.r_max", "5%"}},
            dimmedLight()}),
    [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

TEST(FullComputation, IsDeterministic) {
  const RenderFrame frame = renderShipped("cornell-glossy.toml", kSize, {{"preset", "draft"}});
  const FullComputation here = computeHere(frame, 12, 16, 512, kNever);
  FullComputation there;
  std::thread([&] { there = computeHere(frame, 12, 16, 512, kNever); }).join();
  ASSERT_TRUE(here.finished);
  EXPECT_EQ(here.total.full, there.total.full);
  EXPECT_EQ(here.standardError, there.standardError);
  EXPECT_EQ(here.total.parts.noise, there.total.parts.noise);
}

// Two computations with other random numbers agree within what they say of themselves: over many pixels, the
// squared differences over their variances average 1. Each is a ratio with 15 + 15 degrees of freedom, whose
// mean is 30/28 and variance about 3; of 3 x 60 values that are alike in threes the average strays by 0.25.
TEST(FullComputation, KnowsItsError) {
  if (!render_test::isFast()) GTEST_SKIP();
  RenderFrame frame = renderShipped("cornell-glossy.toml", kSize, {{"preset", "draft"}});
  RenderFrame other = frame;
  other.parameters.picture.seed = 99;
  double sum = 0.0;
  int values = 0;
  for (int i = 30; i < kSize * kSize; i += 9) {
    const FullComputation a = computeHere(frame, i % kSize, i / kSize, 512, kNever);
    const FullComputation b = computeHere(other, i % kSize, i / kSize, 512, kNever);
    if (!a.finished) continue;
    for (int c = 0; c < 3; ++c) {
      const double variance = square(a.standardError[c]) + square(b.standardError[c]);
      if (!(variance > 0.0)) continue;
      sum += square(a.total.full[c] - b.total.full[c]) / variance;
      ++values;
    }
  }
  ASSERT_GT(values, 100);
  EXPECT_NEAR(sum / values, 30.0 / 28.0, 0.75) << values << " values";
  RecordProperty("ratio", fmt::format("{:.2f} over {}", sum / values, values));
}

// Before the last pass a point with a vector of its own shows that vector alone: what is wrong with it is its
// noise. What many samples of the vector and of the point still differ by is not larger than that.
TEST(FullComputation, OwnVectorsHaveNoInterpolation) {
  const RenderFrame frame =
      renderShipped("cornell.toml", kSize, {{"preset", "draft"}, {"ilv.seed", "40"}}, 4);
  int own = 0;
  double interpolation = 0.0, noise = 0.0;
  for (std::size_t n = 0; n < frame.snapshot->indirect.size(); ++n) {
    const std::uint32_t pixel = frame.snapshot->indirect[n].birth.pixel;
    const FullComputation full =
        computeHere(frame, static_cast<int>(pixel) % kSize, static_cast<int>(pixel) / kSize, 1024, kNever);
    if (!full.finished) continue;
    for (int c = 0; c < 3; ++c) {
      interpolation += square(full.values.indirect.parts.interpolation[c]);
      noise += square(full.values.indirect.parts.noise[c]);
    }
    ++own;
  }
  EXPECT_GT(own, 5);
  EXPECT_GT(noise, 0.0);
  EXPECT_LT(interpolation, 0.3 * noise);
  RecordProperty("told", fmt::format("{:.3f} of the noise", interpolation / noise));
}

TEST(FullComputation, Stops) {
  const RenderFrame frame = renderShipped("cornell.toml", kSize, {{"preset", "draft"}});
  const StopFlag now = true;
  const FullComputation full = computeHere(frame, 12, 20, 1 << 20, now);
  EXPECT_FALSE(full.finished);
  EXPECT_EQ(full.note, "stopped");
  EXPECT_EQ(full.total.full, Vec3d(0.0));
}

TEST(FullComputation, SaysWhyThereIsNothing) {
  const RenderFrame early = renderShipped("cornell.toml", kSize, {}, 1);
  EXPECT_THAT(computeHere(early, 13, 17, 64, kNever).note, HasSubstr("not looked at yet"));
  EXPECT_THAT(computeHere(early, kSize, 0, 64, kNever).note, HasSubstr("outside"));
  const RenderFrame naive =
      renderShipped("cornell.toml", 16, {{"method.name", "naive"}, {"naive.samples", "8"}});
  EXPECT_THAT(computeHere(naive, 3, 3, 64, kNever).note, HasSubstr("vectors"));
}

}  // namespace
}  // namespace lightvane::inspect_test
