#include "core/measure/rival_study.h"

#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/render/parameters.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(RivalPoints, AreAllMethodsWithNamesOfTheirOwn) {
  std::set<std::string> labels, methods;
  for (const RivalPoint& point : rivalPoints()) {
    labels.insert(point.label);
    methods.insert(point.method);
    EXPECT_THAT(point.label, StartsWith(point.method));
    EXPECT_TRUE(choiceNamed(kMethodNames, point.method)) << point.method;
  }
  EXPECT_EQ(labels.size(), rivalPoints().size());
  EXPECT_EQ(methods.size(), kMethodNames.size());
  EXPECT_TRUE(labels.contains("vectors, fine"));
  EXPECT_TRUE(labels.contains("naive, 128 samples")) << "the paper's";
}

/// Pictures of a Monte Carlo: 0.1 s and 0.01 s a sample; a squared error of 0.8 / samples.
std::vector<SampledError> monteCarlo() {
  std::vector<SampledError> pictures;
  for (const double samples : {8.0, 32.0, 128.0})
    pictures.push_back({samples, 0.1 + 0.01 * samples, 0.8 / samples});
  return pictures;
}

TEST(SamplesNeeded, AreThoseOfAMonteCarlo) {
  for (const double samples : {2.0, 8.0, 11.0, 32.0, 100.0, 128.0, 500.0}) {
    const auto needed = samplesNeeded(monteCarlo(), 0.8 / samples);
    ASSERT_TRUE(needed) << samples;
    EXPECT_NEAR(needed->samples, samples, 1e-9 * samples);
    EXPECT_NEAR(needed->cpuSeconds, 0.1 + 0.01 * samples, 1e-9 * samples);
    const bool isWithin = samples >= 8.0 && samples <= 128.0;
    // At the ends either is right.
    if (samples == 8.0 || samples == 128.0) continue;
    EXPECT_EQ(needed->reach, isWithin ? Reach::Measured : Reach::Beyond) << samples;
  }
  EXPECT_EQ(samplesNeeded(monteCarlo(), 1e9)->samples, 1.0);
}

// The last step of 4 in samples may fall by 2 at least: half of the law's 4, in logarithms.
TEST(SamplesNeeded, AreNotMadeUp) {
  std::vector<SampledError> slow = monteCarlo();
  slow.back().meanSquare = 0.51 * slow[1].meanSquare;
  const auto needed = samplesNeeded(slow, 0.1 * slow.back().meanSquare);
  ASSERT_TRUE(needed);
  EXPECT_EQ(needed->reach, Reach::AtLeast);
  EXPECT_EQ(needed->samples, 128.0);
  EXPECT_EQ(needed->cpuSeconds, slow.back().cpuSeconds);
  slow.back().meanSquare = 0.49 * slow[1].meanSquare;
  EXPECT_EQ(samplesNeeded(slow, 0.1 * slow.back().meanSquare)->reach, Reach::Beyond);
  EXPECT_EQ(samplesNeeded(monteCarlo(), 0.0)->reach, Reach::AtLeast) << "no Monte Carlo has no error";

  EXPECT_FALSE(samplesNeeded(std::span(slow).first(1), 0.1));
  EXPECT_FALSE(samplesNeeded({}, 0.1));
  EXPECT_FALSE(samplesNeeded(monteCarlo(), std::nan("")));
  for (const double bad : {0.0, std::nan(""), HUGE_VAL}) {
    std::vector<SampledError> pictures = monteCarlo();
    pictures[1].meanSquare = bad;
    EXPECT_FALSE(samplesNeeded(pictures, 0.1)) << bad;
    pictures = monteCarlo();
    pictures[0].cpuSeconds = bad;
    EXPECT_FALSE(samplesNeeded(pictures, 0.1)) << bad;
  }
}

// Noise: errors that rise and fall again. The first two neighbours that have the error between them count.
TEST(SamplesNeeded, AreTheFirstThatDo) {
  const SampledError measured[] = {{8.0, 1.0, 0.4}, {32.0, 2.0, 0.1}, {128.0, 5.0, 0.2}, {512.0, 17.0, 0.05}};
  const auto needed = samplesNeeded(measured, 0.2);
  ASSERT_TRUE(needed);
  EXPECT_NEAR(needed->samples, 16.0, 1e-9);
  EXPECT_NEAR(needed->cpuSeconds, 1.0 + 8.0 / 24.0, 1e-9);
}

SweepRun runWith(double seconds, double meanSquare) {
  SweepRun run;
  run.cpuSeconds = seconds;
  run.metrics["indirect.relmse"] = meanSquare;
  run.metrics["beauty.relative"] = std::sqrt(meanSquare);
  return run;
}

/// A scene with a run of each point for each of `noise`: rivals take 10 ms a sample, and their squared error
/// is noise / samples; vectors take 1 s and have the squared error of 64 samples without noise.
StudiedScene studiedScene(const std::string& name, std::initializer_list<double> noise) {
  StudiedScene scene{name, {}};
  scene.sweep.referenceNoise = 0.0123;
  for (const RivalPoint& of : rivalPoints()) {
    SweepPoint point;
    point.method = of.method;
    point.label = of.label;
    for (const double one : noise) {
      const double samples =
          of.method == "naive" || of.method == "path" ? std::stod(of.settings.front().second) : 64.0;
      point.runs.push_back(of.method == "vectors"  ? runWith(1.0, 1.0 / 64.0)
                           : of.method == "direct" ? runWith(0.25, 0.7)
                                                   : runWith(0.01 * samples, one / samples));
    }
    scene.sweep.points.push_back(std::move(point));
  }
  return scene;
}

// Noise of 2 and 8 takes twice and eight times 64 samples: 1.28 s and 5.12 s, whose geometric mean is 2.56 s.
// Their logarithms are log 4 / 2 from the mean, which is so also their standard error, and Student's t of one
// degree of freedom is 12.706.
TEST(SpeedUpOver, IsAMeanWithAnInterval) {
  const auto found =
      speedUpOver(studiedScene("room", {2.0, 8.0}), "naive", "vectors, balanced", "indirect.relmse");
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->times, 2.56, 1e-9);
  EXPECT_NEAR(found->samples, 256.0, 1e-9);
  ASSERT_TRUE(found->low && found->high);
  const double half = 12.706 * std::log(4.0) / 2.0;
  EXPECT_NEAR(std::log(*found->high), std::log(2.56) + half, 1e-6);
  EXPECT_NEAR(std::log(*found->low), std::log(2.56) - half, 1e-6);
  EXPECT_EQ(found->reach, Reach::Measured);

  // The same errors by the other metric are the same speed-up.
  const auto picture =
      speedUpOver(studiedScene("room", {2.0, 8.0}), "naive", "vectors, balanced", "beauty.relative");
  ASSERT_TRUE(picture);
  EXPECT_NEAR(picture->times, found->times, 1e-9);

  const auto one = speedUpOver(studiedScene("room", {4.0}), "path", "vectors, fine", "indirect.relmse");
  ASSERT_TRUE(one);
  EXPECT_NEAR(one->times, 2.56, 1e-9);
  EXPECT_FALSE(one->low) << "one seed has no interval";
  EXPECT_FALSE(speedUpOver(studiedScene("room", {4.0}), "direct", "vectors, fine", "indirect.relmse"));
  EXPECT_FALSE(speedUpOver(studiedScene("room", {4.0}), "path", "vectors", "indirect.relmse"));
}

TEST(SpeedUpOver, TakesTheSeedsThatAreDone) {
  StudiedScene scene = studiedScene("room", {4.0, 4.0});
  for (SweepPoint& point : scene.sweep.points) {
    if (point.label == "naive, 512 samples") point.runs.pop_back();
  }
  const auto naive = speedUpOver(scene, "naive", "vectors, draft", "indirect.relmse");
  ASSERT_TRUE(naive);
  EXPECT_NEAR(naive->times, 2.56, 1e-9);
  EXPECT_FALSE(naive->low);
  EXPECT_TRUE(speedUpOver(scene, "path", "vectors, draft", "indirect.relmse")->low);
}

TEST(RivalTables, SayWhatIsMeasured) {
  // Of the second scene 10240 samples are needed: the law says so, not a picture.
  const StudiedScene scenes[] = {studiedScene("room", {2.0, 2.0}), studiedScene("yard", {160.0, 160.0})};
  const std::vector<StudyTable> tables = rivalTables(scenes);
  ASSERT_EQ(tables.size(), 5U);
  const auto& rows = tables[0].rows;
  ASSERT_EQ(rows.size(), 1U + 3U * 3U) << "three presets of two scenes and of both";
  EXPECT_THAT(rows[1],
              ElementsAre("room", "draft", "1 ± 0", "0.0156 ± 0", "128", "1.28 [1.28, 1.28]", "128",
                          "1.28 [1.28, 1.28]", "12.5 ± 0", "1.28 [1.28, 1.28]", "1.28 [1.28, 1.28]"));
  EXPECT_EQ(rows[2][4], "~10240");
  EXPECT_EQ(rows[2][5], "~102 [102, 102]");
  EXPECT_EQ(rows[3][0], "*all scenes*");
  EXPECT_THAT(rows[3][5], StartsWith("~11.4 ["));

  const auto& ratios = tables[1].rows;
  ASSERT_EQ(ratios.size(), 4U);
  EXPECT_THAT(ratios[1], ElementsAre("*the paper*", "18", "5", "–", "–", "–", "–"));
  EXPECT_THAT(ratios[2], ElementsAre("room", "1.28 [1.28, 1.28]", "4.00 [4.00, 4.00]", "1.28 [1.28, 1.28]",
                                     "0.0156 ± 0", "0.0156 ± 0", "0.7 ± 0"));
  EXPECT_EQ(tables[4].rows.back().front(), "*noise of the reference*");
  EXPECT_EQ(tables[4].rows.back()[1], "1.2");
  EXPECT_THAT(studyMarkdown(tables), HasSubstr("## Speed-up at equal error\n"));
}

TEST(RivalTables, OfWhatIsNotDoneSaySo) {
  StudiedScene scene = studiedScene("room", {2.0});
  std::erase_if(scene.sweep.points, [](const SweepPoint& point) { return point.method != "vectors"; });
  const std::vector<StudyTable> tables = rivalTables(std::span(&scene, 1));
  EXPECT_EQ(tables[0].rows[1][5], "–");
  EXPECT_EQ(tables[1].rows[2][1], "–");
  EXPECT_FALSE(studyMarkdown(rivalTables({})).empty());
}

}  // namespace
}  // namespace lightvane
