#include "core/inspect/error_sources.h"

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/inspect/record_edit.h"
#include "core/measure/picture_error.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

const StopFlag kGoesOn = false;

const SourceError& errorOf(const SourceErrors& errors, ErrorSource source) {
  return errors.ofSource[static_cast<std::size_t>(source)];
}

ErrorSources sourcesOf(const RenderFrame& frame, int samples, int stride = 1) {
  TaskPool pool(2);
  auto sources = errorSources(frame, {samples, stride}, pool, kGoesOn);
  if (!sources) throw std::runtime_error("stopped though nobody asked to");
  return *std::move(sources);
}

TEST(ErrorSources, MapsAddUpToThePicturesDifference) {
  const RenderFrame frame = renderShipped("cornell-glossy.toml", 24, {{"preset", "draft"}});
  const ErrorSources sources = sourcesOf(frame, 64);
  const ImageRgb shown = frame.film->sceneBeauty(*frame.scene);
  EXPECT_EQ(sources.pixels.size(), shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      float sum = sources.truth[i][c];
      for (const ImageRgb& map : sources.maps) sum += map[i][c];
      ASSERT_NEAR(sum, shown[i][c], 1e-5f * (1.0f + shown[i][c])) << i;
    }
  }
}

// What is left when all sources are taken off is what paths find: in per cent of the light, from halves that
// share nothing. The reference's noise and that of the full computation are in both.
TEST(ErrorSources, TruthIsWhatPathsFind) {
  if (!render_test::isFast()) GTEST_SKIP();
  const RenderFrame frame = renderShipped("cornell.toml", 24, {{"method.rules", "paper"}});
  const RenderFrame path = renderShipped(
      "cornell.toml", 24,
      {{"method.name", "path"}, {"path.samples", "1024"}, {"seed", std::to_string(kReferenceSeed)}});
  const ErrorSources sources = sourcesOf(frame, 256);
  const ImageRgb reference = path.film->sceneBeauty(*path.scene);
  Vec3d truth(0.0), expected(0.0), shown(0.0);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    truth += Vec3d(sources.truth[i]);
    expected += Vec3d(reference[i]);
    shown += Vec3d(frame.film->sceneBeauty(*frame.scene)[i]);
  }
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(truth[c] / expected[c], 1.0, 0.006) << c;
  RecordProperty("told", fmt::format("truth {:+.2f} %, shown {:+.2f} %", 100.0 * (truth.y / expected.y - 1.0),
                                     100.0 * (shown.y / expected.y - 1.0)));
}

// Independent of the ladder: the same vectors computed anew in the same places, so that pictures differ by
// nothing but the vectors' noise, whose variance is theirs.
TEST(ErrorSources, NoiseIsWhatPicturesOfOtherNumbersScatterBy) {
  if (!render_test::isFast()) GTEST_SKIP();
  const Stage stage(shippedScene("cornell.toml", 32, 32));
  // Direct light without noise worth its name: it is sampled, and not in what is computed anew.
  const Parameters parameters =
      parametersWith({{"preset", "draft"},
                      {"dlv.mode", "never"},
                      {"light.samples", "256"},
                      // Whatever their gathers meet, vectors reach equally far: on the ladder weights stay.
                      {"ilv.radius_min", "24"},
                      {"ilv.radius_max", "24"},
                      {"ilv.radius_min_hit", "0"},
                      {"ilv.visibility", "false"}});
  const RenderFrame frame = renderFrame(stage, parameters);
  TaskPool pool(2);
  std::vector<RecordRef> all;
  for (std::uint32_t n = 0; n < frame.snapshot->indirect.size(); ++n) all.push_back({kNone, n});
  constexpr int kPictures = 6;
  std::vector<RenderFrame> anew;
  double told = 0.0;
  for (int k = 0; k < kPictures; ++k) {
    const RenderFrame& before = k == 0 ? frame : anew.back();
    CacheInput cache;
    cache.warm = recomputed(before, all, pool, kGoesOn);
    cache.locked = true;
    anew.push_back(renderFrame(stage, parameters, -1, cache));
    const ErrorSources sources = sourcesOf(anew.back(), 32);
    told += square(errorOf(sources.indirect, ErrorSource::Noise).relative) / kPictures;
  }
  // The scatter, by the same measure: relative to the picture around.
  double scatter = 0.0;
  for (int k = 0; k < kPictures; ++k) {
    for (int l = 0; l < k; ++l) {
      const ImageRgb one = anew[static_cast<std::size_t>(k)].film->beauty();
      const ImageRgb other = anew[static_cast<std::size_t>(l)].film->beauty();
      scatter += 0.5 * square(pictureError(one, other, {}).relative) / (kPictures * (kPictures - 1) / 2);
    }
  }
  EXPECT_NEAR(told / scatter, 1.0, 0.2);
  RecordProperty("told",
                 fmt::format("{:.4f} % of {:.4f} %", 100.0 * std::sqrt(told), 100.0 * std::sqrt(scatter)));
}

// In a closed room of one albedo whose walls all glow, of all light albedo^n is reflected n times or more. A
// gather's paths go on n times; one reflection comes before, and one after the last.
TEST(ErrorSources, BouncesThatAreMissingAreThoseOfTheFurnace) {
  if (!render_test::isFast()) GTEST_SKIP();
  for (const int bounces : {1, 2, 3}) {
    const ErrorSources sources =
        sourcesOf(renderShipped("furnace.toml", 16, {{"path.max_bounces", std::to_string(bounces)}}), 256);
    const double missing = std::pow(0.5, bounces + 2);
    EXPECT_NEAR(errorOf(sources.indirect, ErrorSource::MissingBounces).bias, -missing / (1.0 - missing),
                0.03 * missing)
        << bounces;
    EXPECT_NEAR(errorOf(sources.indirect, ErrorSource::MissingBounces).relative, missing / (1.0 - missing),
                0.05 * missing)
        << bounces;
  }
  const ErrorSources whole = sourcesOf(renderShipped("furnace.toml", 16), 32);
  EXPECT_EQ(errorOf(whole.picture, ErrorSource::MissingBounces).relative, 0.0);
}

TEST(ErrorSources, LeaksGoWithTheRulesThatStopThem) {
  if (!render_test::isFast()) GTEST_SKIP();
  const Settings loose = {{"preset", "draft"}, {"ilv.visibility", "false"}, {"ilv.clearance", "0"}};
  const ErrorSources leaking = sourcesOf(renderShipped("two-rooms.toml", 32, loose), 64);
  EXPECT_GT(errorOf(leaking.indirect, ErrorSource::Leaks).relative, 0.0);
  const Settings strict = {{"preset", "draft"},
                           {"ilv.visibility", "true"},
                           {"ilv.visibility_distance", "0"},
                           {"ilv.clearance", "0"}};
  const ErrorSources tight = sourcesOf(renderShipped("two-rooms.toml", 32, strict), 64);
  EXPECT_NEAR(errorOf(tight.indirect, ErrorSource::Leaks).relative, 0.0, 1e-3);
  RecordProperty("told", fmt::format("{:.4f}, {:.4f}", errorOf(leaking.indirect, ErrorSource::Leaks).relative,
                                     errorOf(tight.indirect, ErrorSource::Leaks).relative));
}

TEST(ErrorSources, OneDirectionIsToBlameOnlyWhereItStandsForALobe) {
  if (!render_test::isFast()) GTEST_SKIP();
  const ErrorSources split = sourcesOf(renderShipped("cornell-glossy.toml", 24, {{"preset", "draft"}}), 64);
  EXPECT_EQ(errorOf(split.picture, ErrorSource::SingleDirection).relative, 0.0);
  const ErrorSources paper = sourcesOf(
      renderShipped("cornell-glossy.toml", 24, {{"preset", "draft"}, {"method.rules", "paper"}}), 64);
  EXPECT_GT(errorOf(paper.picture, ErrorSource::SingleDirection).relative, 0.0);
}

TEST(ErrorSources, DoNotDependOnThreads) {
  const RenderFrame frame = renderShipped("cornell-mirror.toml", 24, {{"preset", "draft"}});
  TaskPool one(1), three(3);
  const auto a = errorSources(frame, {32, 3}, one, kGoesOn);
  const auto b = errorSources(frame, {32, 3}, three, kGoesOn);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->pixels.size(), 64u);
  EXPECT_EQ(a->picture.total.relative, b->picture.total.relative);
  for (std::size_t s = 0; s < kErrorSources; ++s) {
    EXPECT_EQ(a->picture.ofSource[s].relative, b->picture.ofSource[s].relative);
    EXPECT_EQ(a->picture.ofSource[s].bias, b->picture.ofSource[s].bias);
  }
}

TEST(ErrorSources, StopAndSayWhyThereAreNone) {
  const RenderFrame frame = renderShipped("cornell.toml", 16, {{"preset", "draft"}});
  const StopFlag now = true;
  TaskPool pool(1);
  EXPECT_FALSE(errorSources(frame, {32, 1}, pool, now));
  EXPECT_EQ(errorSourceObstacle(frame), "");
  EXPECT_NE(errorSourceObstacle(renderShipped("cornell.toml", 16, {}, 1)), "");
  EXPECT_NE(errorSourceObstacle(renderShipped("cornell.toml", 16, {{"method.name", "direct"}})), "");
}

}  // namespace
}  // namespace lightvane::inspect_test
