// What the vectors of a picture say of its error, held against a path traced reference, and how more of them
// bring it down.

#include "core/measure/target_error.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/measure/picture_error.h"
#include "tests/pictures/pictures.h"

namespace lightvane {
namespace {

using render_test::finish;
using render_test::isFast;
using render_test::parametersWith;
using render_test::shippedScene;
using render_test::Stage;

// The picture's direct light is as good as exact: what is off is indirect.
const render_test::Settings kVectors = {{"dlv.mode", "never"}, {"light.samples", "64"}, {"ilv.n_max", "256"}};

struct Rendering {
  RenderContext context;
  std::unique_ptr<Renderer> renderer;

  Rendering(const Stage& stage, const render_test::Settings& settings)
      : context(stage.context(parametersWith(settings))), renderer(makeRenderer(context)) {
    finish(*renderer);
  }
  RenderFrame frame() const { return makeFrame(context, *renderer); }
  ErrorEstimate estimate() const {
    const StopFlag goOn = false;
    return estimateError(frame(), *context.pool, goOn);
  }
  TargetError against(double target, std::uint32_t round = 0) const {
    return targetErrorOf(frame(), estimate(), target, round);
  }
  /// Rounds until the target is met; how many there were.
  std::uint32_t refineTo(double target) {
    for (std::uint32_t round = 0;; ++round) {
      const TargetError found = against(target, round);
      if (round == 40 || !renderer->askMore(found.pixels)) return round;
      finish(*renderer);
    }
  }
};

/// What the vectors say over what is true, for each of some pictures. Budget: a factor of 2 for each, and 1.5
/// for their geometric mean.
void expectCalibrated(const std::vector<double>& ratios, const std::string& what) {
  double logarithms = 0.0;
  for (const double ratio : ratios) {
    EXPECT_GT(ratio, 0.5) << what;
    EXPECT_LT(ratio, 2.0) << what;
    logarithms += std::log(ratio);
  }
  const double mean = std::exp(logarithms / static_cast<double>(ratios.size()));
  EXPECT_GT(mean, 1.0 / 1.5) << what;
  EXPECT_LT(mean, 1.5) << what;
}

TEST(ErrorEstimateOfVectors, IsWithinAFactorOfTwoOfTheTruth) {
  if (!isFast()) GTEST_SKIP() << "statistical";
  for (const char* scene : {"cornell.toml", "two-rooms.toml"}) {
    const Stage stage(shippedScene(scene, 48, 48));
    const Film reference =
        render_test::picture(stage, parametersWith({{"method.name", "path"}, {"path.samples", "2048"}})).film;
    std::vector<double> asRendered, refined;
    for (int seed = 1; seed <= 4; ++seed) {
      render_test::Settings settings = kVectors;
      settings.emplace_back("seed", std::to_string(seed));
      Rendering rendering(stage, settings);
      const auto ratio = [&] {
        const PictureError off =
            pictureError(rendering.renderer->film().beauty(), reference.beauty(), reference.variance);
        return rendering.against(1.0).error / off.relative;
      };
      asRendered.push_back(ratio());
      rendering.refineTo(0.03);
      refined.push_back(ratio());
    }
    expectCalibrated(asRendered, scene);
    expectCalibrated(refined, std::string(scene) + ", where a target is met");
  }
}

// Two pictures with other numbers differ by the root of 2 of what either says of its sampled light. Budget:
// 25 %, as one pixel in nine is looked at, and the noise is all in penumbras.
TEST(SamplingNoiseOfAPicture, IsWhatTwoPicturesDifferBy) {
  for (const char* scene : {"cornell.toml", "cornell-mirror.toml", "two-rooms.toml"}) {
    const Stage stage(shippedScene(scene, 96, 96));
    const render_test::Settings settings = {
        {"preset", "draft"}, {"dlv.mode", "never"}, {"light.samples", "9"}};
    const Rendering first(stage, settings);
    render_test::Settings others = settings;
    others.emplace_back("seed", "2");
    const Rendering second(stage, others);
    const RenderFrame frame = first.frame();
    const ImageRgb picture = frame.film->beauty();
    ImageRgb other = picture;
    const Film film = second.renderer->film();
    for (std::size_t i = 0; i < other.size(); ++i) other[i] += film.direct[i] - frame.film->direct[i];
    const double apart = pictureError(other, picture, {}).relative;
    const StopFlag goOn = false;
    SamplingNoise noise = estimateSamplingNoise(frame, *first.context.pool, goOn);
    // Of direct light alone, as the difference is.
    const double said = samplingErrorOf(frame, noise);
    EXPECT_GT(said, 0.75 * apart / std::sqrt(2.0)) << scene;
    if (std::string_view(scene) != "cornell-mirror.toml") {
      EXPECT_LT(said, 1.25 * apart / std::sqrt(2.0)) << scene;
    }
  }
}

TEST(ErrorEstimateOfVectors, KnowsNothingWithoutVectors) {
  const Stage stage(shippedScene("cornell.toml", 16, 16));
  const Rendering direct(stage, {{"method.name", "direct"}});
  EXPECT_TRUE(direct.estimate().variance.empty());
  EXPECT_EQ(direct.estimate().guessed, 1.0);
  EXPECT_TRUE(std::isnan(direct.against(0.1).error));
  EXPECT_TRUE(direct.against(0.1).pixels.empty());
}

TEST(TargetErrorOfAPicture, AsksWhereItIsAboveTheTarget) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  const Rendering rendering(stage, kVectors);
  const TargetError found = rendering.against(0.01);
  EXPECT_GT(found.error, 0.01);
  EXPECT_FALSE(found.pixels.empty());
  EXPECT_TRUE(std::is_sorted(found.pixels.begin(), found.pixels.end()));
  const auto half = static_cast<double>(rendering.renderer->statistics().ilvRecords) / 2.0;
  EXPECT_NEAR(static_cast<double>(found.pixels.size()), half, 0.25 * half);
  EXPECT_NE(rendering.against(0.01, 1).pixels, found.pixels) << "each round has its own lot";
  EXPECT_TRUE(rendering.against(2.0 * found.error).pixels.empty()) << "it is met";
}

TEST(TargetErrorOfAPicture, IsMetByVectorsThatAreAdded) {
  const Stage stage(shippedScene("cornell.toml", 48, 48));
  Rendering rendering(stage, kVectors);
  const double before = rendering.against(1.0).error;
  const std::size_t records = rendering.renderer->snapshot()->indirect.size();
  const auto first = rendering.renderer->snapshot()->indirect[0];
  const double target = 0.6 * before;
  EXPECT_GT(rendering.refineTo(target), 0U);
  EXPECT_LE(rendering.against(1.0).error, target);
  const RecordSet<IndirectLightVector>& all = rendering.renderer->snapshot()->indirect;
  EXPECT_GT(all.size(), records) << "what was computed stays";
  EXPECT_EQ(all[0].energy, first.energy);
  EXPECT_EQ(rendering.renderer->statistics().ilvRecords, all.size());
  EXPECT_EQ(render_test::badPixel(rendering.renderer->film()), "");
}

TEST(TargetErrorOfAPicture, GivesTheSameBytesForAnyThreads) {
  const SceneDescription scene = shippedScene("two-rooms.toml", 48, 48);
  const Stage one(scene, 1), two(scene, 2);
  Rendering first(one, kVectors), second(two, kVectors);
  EXPECT_EQ(first.refineTo(0.04), second.refineTo(0.04));
  EXPECT_EQ(render_test::difference(first.renderer->film(), second.renderer->film()), "");
}

TEST(TargetErrorOfAPicture, AsksOnlyARenderingThatIsDone) {
  const Stage stage(shippedScene("cornell.toml", 16, 16));
  const RenderContext context = stage.context(parametersWith(kVectors));
  const std::unique_ptr<Renderer> renderer = makeRenderer(context);
  const std::vector<std::uint32_t> pixels = {100, 101};
  EXPECT_FALSE(renderer->askMore(pixels));
  finish(*renderer);
  EXPECT_FALSE(renderer->askMore({})) << "of nothing";
  const std::size_t before = renderer->snapshot()->indirect.size();
  // The same places twice: other vectors beside their own.
  for (std::size_t round = 1; round <= 2; ++round) {
    ASSERT_TRUE(renderer->askMore(pixels));
    EXPECT_FALSE(renderer->done());
    finish(*renderer);
    EXPECT_EQ(renderer->snapshot()->indirect.size(), before + 2 * round);
  }
  const auto& records = renderer->snapshot()->indirect;
  EXPECT_EQ(records[before].point.position, records[before + 2].point.position);
  EXPECT_NE(records[before].energy, records[before + 2].energy);
  EXPECT_NE(records[before].birth.identity, records[before + 2].birth.identity);
  CacheInput locked;
  locked.warm = std::make_shared<const Snapshot>(*renderer->snapshot());
  locked.locked = true;
  const std::unique_ptr<Renderer> taken = makeRenderer(context, locked);
  finish(*taken);
  EXPECT_FALSE(taken->askMore(pixels)) << "a locked cache takes no more";
}

}  // namespace
}  // namespace lightvane
