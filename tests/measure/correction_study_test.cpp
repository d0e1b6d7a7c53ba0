#include "core/measure/correction_study.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/measure/comparison.h"
#include "core/measure/metric.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Errors that fall as a power law: error = 0.3 t^-0.5.
double powerLaw(double seconds) { return 0.3 / std::sqrt(seconds); }

TEST(ErrorAtTime, IsThatOfAPowerLaw) {
  const TimedError measured[] = {{0.5, powerLaw(0.5)}, {1.1, powerLaw(1.1)}, {4.0, powerLaw(4.0)}};
  for (const double seconds : {0.5, 0.9, 2.0, 4.0}) {
    const auto found = errorAtTime(measured, seconds);
    ASSERT_TRUE(found) << seconds;
    EXPECT_NEAR(found->error, powerLaw(seconds), 1e-12) << seconds;
    EXPECT_FALSE(found->isBeyond) << seconds;
  }
  for (const double seconds : {0.3, 7.0}) {
    const auto found = errorAtTime(measured, seconds);
    ASSERT_TRUE(found) << seconds;
    EXPECT_NEAR(found->error, powerLaw(seconds), 1e-12) << seconds;
    EXPECT_TRUE(found->isBeyond) << seconds;
  }
}

// Times 1, 2, 4 and errors 8, 1, 2: in logarithms of 2 the points (0, 3), (1, 0), (2, 1), whose line is
// 7/3 - x.
TEST(ErrorAtTime, IsOfTheLineOfLeastSquares) {
  const TimedError measured[] = {{1.0, 8.0}, {2.0, 1.0}, {4.0, 2.0}};
  EXPECT_NEAR(errorAtTime(measured, 1.0)->error, std::exp2(7.0 / 3.0), 1e-12);
  EXPECT_NEAR(errorAtTime(measured, 2.0)->error, std::exp2(4.0 / 3.0), 1e-12);
}

TEST(ErrorAtTime, IsNotMadeUp) {
  const TimedError good[] = {{1.0, 0.2}, {2.0, 0.1}};
  EXPECT_TRUE(errorAtTime(good, 4.0));
  EXPECT_FALSE(errorAtTime(good, 4.1)) << "beyond what was measured by more than a factor of 2";
  EXPECT_FALSE(errorAtTime(good, 0.49));
  EXPECT_FALSE(errorAtTime(std::span(good).first(1), 1.0));
  EXPECT_FALSE(errorAtTime({}, 1.0));
  EXPECT_FALSE(errorAtTime(good, 0.0));
  const TimedError bad[][2] = {{{1.0, 0.2}, {1.0, 0.1}},
                               {{1.0, 0.2}, {2.0, 0.0}},
                               {{1.0, std::nan("")}, {2.0, 0.1}},
                               {{1.0, std::numeric_limits<double>::infinity()}, {2.0, 0.1}},
                               {{0.0, 0.2}, {2.0, 0.1}}};
  for (const auto& measured : bad) EXPECT_FALSE(errorAtTime(measured, 1.5));
}

SweepPoint point(const StudyPoint& of, double seconds, double error) {
  SweepPoint made;
  made.method = "vectors";
  made.label = of.label();
  SweepRun run;
  run.cpuSeconds = seconds;
  for (const char* layer : {"beauty", "direct", "indirect"}) {
    run.metrics[std::string(layer) + ".relative"] = error;
    run.metrics[std::string(layer) + ".relmse"] = error * error;
  }
  made.runs = {run};
  return made;
}

/// A scene in which a role's error is `factor` times as large as that of all at any time, and its time
/// `slower` times as long at equal settings.
StudiedScene sceneWith(const Correction& correction, double factor, double slower) {
  StudiedScene scene{"room", {}};
  const auto add = [&](StudyRole role, const Correction* of, double errorFactor, double timeFactor) {
    for (const auto& [effort, seconds] :
         {std::pair(StudyEffort::Coarse, 0.5), {StudyEffort::Usual, 1.0}, {StudyEffort::Fine, 4.0}}) {
      const double time = timeFactor * seconds;
      scene.sweep.points.push_back(point({role, of, effort}, time, errorFactor * powerLaw(time)));
    }
  };
  add(StudyRole::All, nullptr, 1.0, 1.0);
  add(StudyRole::None, nullptr, 8.0, 0.5);
  add(StudyRole::Without, &correction, factor, slower);
  add(StudyRole::Alone, &correction, 8.0 / factor, 0.5);
  return scene;
}

TEST(CorrectionTables, TellWhatACorrectionIsWorth) {
  const Correction& correction = corrections().back();
  const StudiedScene scenes[] = {sceneWith(correction, 2.0, 4.0), sceneWith(correction, 8.0, 1.0)};
  const std::vector<StudyTable> tables = correctionTables(scenes);
  const std::string markdown = studyMarkdown(tables);
  EXPECT_THAT(markdown, HasSubstr("## Each correction taken back\n"));
  // At equal settings the first scene's error is 2 / sqrt(4) = 1 of that with all in 4 times the time; at
  // equal time 2, read beyond its fastest picture, which took twice as long. Of 1 and 8 the middle is
  // sqrt(8), of 2 and 8 it is 4.
  const auto& back = tables[2].rows;
  ASSERT_EQ(back.size(), 2U) << "corrections that no scene has are left out";
  EXPECT_THAT(back[1], ElementsAre("`" + correction.key + "`", correction.printed, correction.refined,
                                   "2.00 (1.00 to 4.00)", "2.83 (1.00 to 8.00)", "8.00 (1.00 to 64.0)",
                                   "2.83 (1.00 to 8.00)", "8.00 (1.00 to 64.0)", "~4.00 (2.00 to 8.00)",
                                   "~4.00 (2.00 to 8.00)"));
  const auto& alone = tables[3].rows;
  ASSERT_EQ(alone.size(), 2U);
  EXPECT_EQ(alone[1][8], "0.25 (0.13 to 0.50)");
  EXPECT_THAT(tables[4].rows[1], ElementsAre("`" + correction.key + "`", "~2.00", "8.00"));
  // The first table lists all, the second has two rows a scene.
  EXPECT_EQ(tables[0].rows.size(), 1 + corrections().size());
  EXPECT_EQ(tables[1].rows.size(), 5U);
}

TEST(CorrectionTables, OfWhatIsNotDoneSaySo) {
  const Correction& correction = corrections().back();
  StudiedScene scene = sceneWith(correction, 2.0, 1.0);
  // Stopped before the fine pictures of the point without it.
  std::erase_if(scene.sweep.points, [&](const SweepPoint& made) {
    return made.label == StudyPoint{StudyRole::Without, &correction, StudyEffort::Fine}.label();
  });
  const std::vector<StudyTable> tables = correctionTables(std::span(&scene, 1));
  EXPECT_EQ(tables[2].rows[1][4], "2.00");
  EXPECT_EQ(tables[2].rows[1][8], "–");
  EXPECT_FALSE(studyMarkdown(correctionTables({})).empty());
}

LayeredImage constantLayers(float value) {
  LayeredImage image;
  image.width = image.height = 8;
  ImageRgb pixels(8, 8);
  for (Rgb& pixel : pixels) pixel = Rgb(value);
  for (const char* layer : {"", "direct", "indirect"}) image.setRgb(layer, pixels);
  return image;
}

// Halves 1.2 and 0.8 of a truth of 1: against their mean a perfect picture has the squared error 0, less the
// noise 0.04; one of 1.5 has (0.5)^2 - 0.04 = 0.3 * 0.7, the product of its differences from both.
TEST(MeanOfHalves, KnowsItsNoise) {
  const LayeredImage mean = meanOfHalves(constantLayers(1.2f), constantLayers(0.8f));
  for (const char* layer : {"beauty", "direct", "indirect"}) {
    const ImageRgb variance = varianceOf(mean, layer);
    ASSERT_FALSE(variance.empty()) << layer;
    EXPECT_NEAR(variance[0].r, 0.04, 1e-6) << layer;
  }
  EXPECT_NEAR(mean.rgb("indirect")[5].g, 1.0, 1e-6);
  const MetricInfo* relative[] = {findMetric("relative")};
  const auto compared = compareImages(constantLayers(1.5f), "picture", mean, "reference",
                                      {.metrics = {relative[0]}, .layers = {}});
  ASSERT_TRUE(compared);
  ASSERT_EQ(compared->layers.size(), 3U);
  for (const LayerComparison& layer : compared->layers) {
    EXPECT_TRUE(layer.knowsNoise) << layer.layer;
    // Relative to the mean around, 1, and 1 % of the mean of all.
    EXPECT_NEAR(layer.results.front().value, std::sqrt(0.21 / 1.0001), 1e-5) << layer.layer;
  }
}

}  // namespace
}  // namespace lightvane
