#include "core/measure/light_study.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/render/vectors_of_lights.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDarkSeconds = 0.5;  // of a picture without light

/// What a light takes beside that, and how far off it is: each with both modes.
struct Costs {
  double never = 1.0, always = 1.0;
};

SweepPoint lightPoint(const LightStudyPoint& of, const std::vector<double>& seconds,
                      const std::vector<double>& errors) {
  SweepPoint point;
  point.method = "vectors";
  point.settings = of.settings();
  point.label = of.label();
  for (std::size_t seed = 0; seed < seconds.size(); ++seed) {
    SweepRun run;
    run.seed = seed + 1;
    run.cpuSeconds = kDarkSeconds + seconds[seed];
    run.metrics["direct.relative"] = errors[seed];
    run.metrics["direct.relmse"] = errors[seed] * errors[seed];
    point.runs.push_back(run);
  }
  return point;
}

StudiedScene darkScene() {
  StudiedScene dark{"room", {}, StudiedLight{}};
  dark.sweep.points = {lightPoint(lightStudyDarkPoint(), {0.0}, {0.0})};
  return dark;
}

/// One seed for each of the costs, at these samples.
void addCase(StudiedScene& light, int samples, const std::vector<Costs>& seconds,
             const std::vector<Costs>& errors) {
  for (const DlvMode mode : {DlvMode::Never, DlvMode::Always}) {
    std::vector<double> its, off;
    for (const Costs& cost : seconds) its.push_back(mode == DlvMode::Never ? cost.never : cost.always);
    for (const Costs& cost : errors) off.push_back(mode == DlvMode::Never ? cost.never : cost.always);
    light.sweep.points.push_back(lightPoint({mode, samples}, its, off));
  }
}

StudiedScene litScene(int samples, const std::vector<Costs>& seconds, const std::vector<Costs>& errors) {
  StudiedScene light{"room", {}, StudiedLight{"lamp", "area"}};
  light.sweep.layerNoise["direct"] = 0.001;
  addCase(light, samples, seconds, errors);
  return light;
}

ModeJudgement judgementOf(const StudiedScene& light) {
  const std::vector<ModeJudgement> judged = judgeModes(light, darkScene());
  EXPECT_EQ(judged.size(), 1U);
  return judged.empty() ? ModeJudgement{} : judged.front();
}

constexpr int kFew = 4, kMany = 128;

TEST(LightStudy, HasNoMoreSamplesThanTheLightHasPlaces) {
  EXPECT_THAT(lightStudySamples(Light(AreaLight{}), 16), ElementsAre(1, 4, 16, 32, 64, 128, 256, 512));
  EXPECT_THAT(lightStudySamples(Light(AreaLight{}), 9), ElementsAre(1, 4, 9, 16, 32, 64, 128, 256, 512));
  EXPECT_THAT(lightStudySamples(PointLight{Vec3(0.0f), Rgb(1.0f)}, 16), ElementsAre(1));
  VolumicSphereLight volume{};
  volume.points.resize(20);
  EXPECT_THAT(lightStudySamples(volume, 64), ElementsAre(1, 4, 16, 20));
  EXPECT_EQ(lightStudyPoints(volume, 64).size(), 8U);
  EXPECT_FALSE(autoKeepsVectors(kFew));
  EXPECT_TRUE(autoKeepsVectors(kMany));
  EXPECT_FALSE(isBeyondVectors(kMany));
  EXPECT_FALSE(autoKeepsVectors(8 * kMany));
  EXPECT_TRUE(isBeyondVectors(8 * kMany));
}

TEST(LightStudy, TakesTheStrongestLightsInTheirOrder) {
  Scene scene;
  for (const float power : {1.0f, 5.0f, 2.0f, 5.0f, 3.0f})
    scene.lights.emplace_back(PointLight{Vec3(0.0f), Rgb(power)});
  EXPECT_THAT(strongestLights(scene, 3), ElementsAre(1, 3, 4));
  EXPECT_THAT(strongestLights(scene, 8), ElementsAre(0, 1, 2, 3, 4));
}

// Twice the time for half the error: a squared error of a quarter in 2 is worth 2.
TEST(LightStudy, ComparesSquaredErrorTimesTimeBesideThatWithoutLight) {
  const ModeJudgement judged =
      judgementOf(litScene(kMany, {{2.0, 1.0}, {2.0, 1.0}}, {{0.1, 0.2}, {0.2, 0.4}}));
  ASSERT_TRUE(judged.relative && judged.relmse);
  EXPECT_NEAR(judged.relative->factor, 0.5, 1e-12);
  EXPECT_NEAR(judged.relmse->factor, 0.5, 1e-12);
  EXPECT_TRUE(judged.autoKeepsVectors);
  EXPECT_EQ(judged.verdict, ModeVerdict::Wrong);
  EXPECT_NEAR(judged.lossOf(true), 2.0, 1e-12);
  EXPECT_EQ(judged.lossOf(false), 1.0);
  EXPECT_EQ(judgementOf(litScene(kFew, {{2.0, 1.0}}, {{0.1, 0.2}})).verdict, ModeVerdict::Right);
  EXPECT_EQ(judgementOf(litScene(kMany, {{3.0, 1.0}}, {{0.2, 0.2}})).verdict, ModeVerdict::Right);
  EXPECT_EQ(judgementOf(litScene(kFew, {{3.0, 1.0}}, {{0.2, 0.2}})).verdict, ModeVerdict::Wrong);
}

TEST(LightStudy, IsSureOnlyOfWhatEverySeedAndBothMeasuresSay) {
  // By a factor of 2 in the mean, and of 1.05 by one seed.
  const ModeJudgement scattered =
      judgementOf(litScene(kMany, {{4.0, 1.0}, {1.05, 1.0}}, {{0.1, 0.1}, {0.1, 0.1}}));
  EXPECT_NEAR(scattered.relative->factor, std::sqrt(4.2), 1e-12);
  EXPECT_NEAR(scattered.relative->least, 1.05, 1e-12);
  EXPECT_NEAR(scattered.relative->most, 4.0, 1e-12);
  EXPECT_EQ(scattered.verdict, ModeVerdict::NoDifference);
  EXPECT_EQ(scattered.lossOf(true), 1.0);
  EXPECT_EQ(scattered.lossOf(false), 1.0);

  // One measure says 4, the other 1 / 4, or 2.
  StudiedScene light = litScene(kFew, {{4.0, 1.0}}, {{0.1, 0.1}});
  light.sweep.points.front().runs.front().metrics["direct.relmse"] /= 16.0;
  EXPECT_EQ(judgementOf(light).verdict, ModeVerdict::NoDifference);
  light.sweep.points.front().runs.front().metrics["direct.relmse"] *= 8.0;
  EXPECT_EQ(judgementOf(light).verdict, ModeVerdict::Wrong);
  EXPECT_NEAR(judgementOf(light).factor, 2.0, 1e-12) << "the lesser of what is sure";
}

TEST(LightStudy, KnowsWhatIsExactFromWhatIsLostInNoise) {
  StudiedScene light = litScene(kMany, {{9.0, 1.0}}, {{0.0, 0.1}});
  EXPECT_EQ(judgementOf(light).verdict, ModeVerdict::NotMeasured);
  light.sweep.layerNoise["direct"] = 0.0;
  EXPECT_EQ(judgementOf(light).verdict, ModeVerdict::Wrong);
  EXPECT_EQ(judgementOf(light).lossOf(true), kInfinity);
  // Both exact: the faster one.
  StudiedScene exact = litScene(kMany, {{9.0, 1.0}}, {{0.0, 0.0}});
  exact.sweep.layerNoise.clear();
  EXPECT_NEAR(judgementOf(exact).factor, 9.0, 1e-12);
  // No time beside that without light.
  EXPECT_EQ(judgementOf(litScene(kFew, {{0.0, 1.0}}, {{0.1, 0.1}})).verdict, ModeVerdict::NotMeasured);
}

TEST(LightTables, SayHowOftenAutoIsRight) {
  StudiedScene light = litScene(kFew, {{3.0, 1.0}}, {{0.1, 0.1}});  // wrong by 3
  addCase(light, kMany, {{5.0, 1.0}}, {{0.1, 0.1}});                // right
  addCase(light, 2 * kMany, {{1.02, 1.0}}, {{0.1, 0.1}});           // no difference
  const StudiedScene scenes[] = {darkScene(), light};
  const std::vector<StudyTable> tables = lightTables(scenes);
  const std::string markdown = studyMarkdown(tables);
  EXPECT_THAT(tables[0].text,
              HasSubstr("`auto` is right in 1 of 2 cases that can be told apart, of 3 in all; at "
                        "worst, squared error times time is 3.00 times as large"));
  ASSERT_EQ(tables[0].rows.size(), 4U);
  EXPECT_THAT(markdown, HasSubstr("| room | lamp | area | 4 | 0.5 | 3.5 | 1.5 |"));
  EXPECT_THAT(markdown, HasSubstr("| 3.00 | 3.00 | never | wrong by 3.00 |"));
  EXPECT_THAT(markdown, HasSubstr("| 5.00 | 5.00 | always | right |"));
  EXPECT_THAT(markdown, HasSubstr("| 1.02 | 1.02 | never | no difference |"));
  ASSERT_EQ(tables[1].rows.size(), 4U);
  EXPECT_THAT(tables[1].rows[1], ElementsAre("4", "1", "0", "0", "3.00", "never"));
  EXPECT_THAT(tables[1].rows[2], ElementsAre("128", "1", "0", "0", "5.00", "always"));
  EXPECT_THAT(tables[1].rows[3], ElementsAre("256", "0", "0", "1", "1.00", "never"));
}

// A scene of two lights counts once: sqrt(4 * 1) of it, and 1 / 8 of the other.
TEST(LightTables, CountScenesAndNotLights) {
  StudiedScene lamp = litScene(kMany, {{4.0, 1.0}}, {{0.1, 0.1}});
  StudiedScene sign = litScene(kMany, {{1.0, 1.0}}, {{0.1, 0.1}});
  StudiedScene other = litScene(kMany, {{1.0, 8.0}}, {{0.1, 0.1}});
  StudiedScene otherDark = darkScene();
  other.name = otherDark.name = "hall";
  const StudiedScene scenes[] = {darkScene(), lamp, sign, otherDark, other};
  const std::vector<StudyTable> tables = lightTables(scenes);
  ASSERT_EQ(tables[1].rows.size(), 2U);
  EXPECT_THAT(tables[1].rows[1], ElementsAre("128", "1", "1", "1", testing::StartsWith("0.50 ["), "always"));
}

TEST(LightTables, OfWhatIsNotDoneLeaveOut) {
  EXPECT_EQ(lightTables({})[0].rows.size(), 1U);
  StudiedScene light = litScene(kFew, {{3.0, 1.0}}, {{0.1, 0.1}});
  const StudiedScene withoutDark[] = {light};
  EXPECT_EQ(lightTables(withoutDark)[0].rows.size(), 1U);
  light.sweep.points.pop_back();
  const StudiedScene half[] = {darkScene(), light};
  ASSERT_EQ(lightTables(half)[0].rows.size(), 2U);
  EXPECT_EQ(lightTables(half)[0].rows[1].back(), "–");
}

}  // namespace
}  // namespace lightvane
