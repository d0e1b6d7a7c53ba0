// In a closed room whose walls all reflect rho and emit e, the radiance is e / (1 - rho) everywhere and in
// every direction: whatever loses or invents light, in any method, shows.

#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"
#include "tests/support/statistics.h"

namespace lightvane::render_test {
namespace {

constexpr double kEmitted = 1.0;
constexpr double kReflectance = 0.5;
constexpr double kRadiance = kEmitted / (1.0 - kReflectance);

struct FurnaceMethod {
  const char* name;
  Settings settings;
};

void PrintTo(const FurnaceMethod& method, std::ostream* out) { *out << method.name; }

class Furnace : public testing::TestWithParam<FurnaceMethod> {
 protected:
  /// Means of the beauty picture, one for each seed.
  static std::vector<double> beautyMeans(const Stage& stage, int seeds) {
    std::vector<double> means;
    const double scale = stage.scene->normalisation.radianceScale();
    for (int seed = 1; seed <= seeds; ++seed) {
      Parameters parameters = parametersWith(GetParam().settings);
      parameters.picture.seed = static_cast<std::uint64_t>(seed);
      means.push_back(scale * mean(beauty(picture(stage, parameters).film)));
    }
    return means;
  }
};

TEST_P(Furnace, ShowsTheRadianceOfTheClosedForm) {
  const Stage stage(shippedScene("furnace.toml", budget(32, 8), budget(32, 8)));
  const std::vector<double> means = beautyMeans(stage, 6);
  const BiasTest test{.tolerance = budget(5, 50) * 1e-3, .confidence = 0.99};
  const BiasTest::Result result = test.againstValue(means, kRadiance);
  EXPECT_TRUE(result.passes()) << result.explanation;
  if (!isFast()) return;
  // 1 % too bright or too dark must show.
  for (const double factor : {0.99, 1.01}) {
    std::vector<double> wrong = means;
    for (double& m : wrong) m *= factor;
    const BiasTest::Result injected = test.againstValue(wrong, kRadiance);
    EXPECT_FALSE(injected.passes()) << factor << ": " << injected.explanation;
  }
}

// Noise bounds how far single pixels may be off. The fewest rays a pixel has are 64; their values spread by
// less than the radiance itself, which rho halves: a standard deviation of 0.5 / 8 = 6 %, and six of them.
TEST_P(Furnace, HasNoPixelThatStandsOut) {
  const Stage stage(shippedScene("furnace.toml", 16, 16));
  const Picture p = picture(stage, parametersWith(GetParam().settings));
  const double scale = stage.scene->normalisation.radianceScale();
  for (std::size_t i = 0; i < p.film.depth().size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      ASSERT_NEAR(scale * p.film.beauty(i)[c], kRadiance, 0.36 * kRadiance) << "pixel " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Methods, Furnace,
    testing::Values(FurnaceMethod{"vectors", {}},
                    FurnaceMethod{"vectors_paper",
                                  {{"method.rules", "paper"}, {"ilv.rows", "32"}, {"ilv.columns", "64"}}},
                    FurnaceMethod{"vectors_dlv", {{"dlv.mode", "always"}, {"dlv.seed", "500"}}},
                    FurnaceMethod{"path", {{"method.name", "path"}, {"path.samples", "64"}}},
                    FurnaceMethod{"naive", {{"method.name", "naive"}, {"naive.samples", "72"}}}),
    [](const testing::TestParamInfo<FurnaceMethod>& method) { return method.param.name; });

/// The largest difference of a channel from e / (1 - rho), relative.
double worstOfFurnace(const Settings& settings, int size) {
  const Stage stage(shippedScene("furnace.toml", size, size));
  const Film film = picture(stage, parametersWith(settings)).film;
  const double scale = stage.scene->normalisation.radianceScale();
  double worst = 0.0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    for (int c = 0; c < 3; ++c)
      worst = std::max(worst, std::abs(scale * static_cast<double>(film.beauty(i)[c]) / kRadiance - 1.0));
  }
  return worst;
}

// In corners radii are small and gradients large: taken at their word they leave spots. A gather of 288 rays
// spreads by 0.5 / 17 = 3 %; four of those are 12 %.
TEST(FurnaceVectors, ShowNoSpotsInCorners) {
  EXPECT_LT(worstOfFurnace({}, 192), 0.12);
  if (!isFast()) return;
  EXPECT_GT(worstOfFurnace({{"ilv.gradient_limit", "0"}}, 192), 0.18) << "without the limit there are some";
}

// Without the ambient term the method `direct` has one reflection: e + rho e.
TEST(FurnaceDirect, ShowsEmissionAndOneReflection) {
  const Stage stage(shippedScene("furnace.toml", 16, 16));
  const Picture p = picture(
      stage, parametersWith({{"method.name", "direct"}, {"direct.ambient", "0"}, {"light.samples", "64"}}));
  const double scale = stage.scene->normalisation.radianceScale();
  EXPECT_NEAR(scale * mean(beauty(p.film)), kEmitted * (1.0 + kReflectance), 1e-3);
  EXPECT_EQ(mean(p.film.indirect), 0.0);
}

}  // namespace
}  // namespace lightvane::render_test
