#include "core/measure/corrections.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

Parameters with(const SweepSettings& settings) {
  Parameters parameters;
  for (const auto& [key, value] : settings) {
    const auto set = setParameter(parameters, key, value, key);
    EXPECT_TRUE(set) << set.error().message();
  }
  return parameters;
}

TEST(Corrections, AreParametersWithTwoValues) {
  std::set<std::string> keys;
  for (const Correction& correction : corrections()) {
    EXPECT_TRUE(keys.insert(correction.key).second) << correction.key << " comes twice";
    EXPECT_NE(with({{correction.key, correction.printed}}), Parameters{}) << correction.key;
    EXPECT_EQ(with({{correction.key, correction.refined}}), Parameters{}) << correction.key;
    EXPECT_FALSE(correction.corrects.empty()) << correction.key;
  }
  EXPECT_GE(keys.size(), 20U);
}

// A rule that is added to `printed` and is no correction would be measured by nothing.
TEST(Corrections, AreTogetherTheRulesAsPrinted) {
  Parameters expected;
  applyRules(expected.vectors, Rules::Printed);
  expected.vectors.rules = Rules::Refined;  // row by row is no correction that can be taken back alone
  expected.picture.thin = 0.0;
  expected.transport.maxBounces = 4;
  expected.transport.mirroredLights = false;
  const StudyPoint none{StudyRole::None, nullptr, StudyEffort::Usual};
  EXPECT_EQ(with(none.settings()), expected);
  EXPECT_EQ(with(StudyPoint{}.settings()), Parameters{});
}

/// Keys in which two points have other values.
std::vector<std::string> differences(const StudyPoint& a, const StudyPoint& b) {
  const SweepSettings first = a.settings(), second = b.settings();
  EXPECT_EQ(first.size(), second.size());
  std::vector<std::string> keys;
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].first, second[i].first);
    if (first[i].second != second[i].second) keys.push_back(first[i].first);
  }
  return keys;
}

TEST(StudyPoints, DifferInOneCorrection) {
  const StudyPoint all, none{StudyRole::None, nullptr, StudyEffort::Usual};
  EXPECT_EQ(differences(all, none).size(), corrections().size());
  std::set<std::string> labels;
  for (const StudyPoint& point : studyPoints(true)) {
    EXPECT_TRUE(labels.insert(point.label()).second) << point.label() << " comes twice";
    const auto fromAll = differences(point, all), fromNone = differences(point, none);
    switch (point.role) {
      case StudyRole::All:
        EXPECT_THAT(fromAll, testing::IsEmpty());
        break;
      case StudyRole::None:
        EXPECT_THAT(fromNone, testing::IsEmpty());
        break;
      case StudyRole::Without:
        EXPECT_THAT(fromAll, testing::ElementsAre(point.correction->key));
        break;
      case StudyRole::Alone:
        EXPECT_THAT(fromNone, testing::ElementsAre(point.correction->key));
        break;
    }
  }
}

TEST(StudyPoints, AreAllNoneAndTwoOfEachWithThreeEfforts) {
  EXPECT_EQ(studyPoints(true).size(), 3 * (2 + 2 * corrections().size()));
  const std::vector<StudyPoint> without = studyPoints(false);
  EXPECT_LT(without.size(), studyPoints(true).size());
  for (const StudyPoint& point : without) {
    EXPECT_TRUE(point.correction == nullptr || point.correction->layer() == "indirect")
        << point.label() << " changes nothing without DLVs";
  }
  EXPECT_EQ(without.front().label(), "all, coarse");
}

// That of the presets, whatever the scene's own cells are.
TEST(StudyEfforts, AreThePresets) {
  for (const auto& [effort, preset] :
       {std::pair(StudyEffort::Coarse, Preset::Draft), {StudyEffort::Fine, Preset::Fine}}) {
    Parameters parameters, expected;
    applyEffort(parameters, effort);
    applyPreset(expected, preset);
    EXPECT_EQ(parameters.vectors.ilv.rows, expected.vectors.ilv.rows);
    EXPECT_EQ(parameters.vectors.ilv.columns, expected.vectors.ilv.columns);
    EXPECT_NEAR(parameters.vectors.ilv.radiusScale, expected.vectors.ilv.radiusScale, 1e-12);
    // Nothing else of a preset, or a correction would be undone.
    Parameters rest = parameters;
    rest.vectors.ilv.rows = Parameters{}.vectors.ilv.rows;
    rest.vectors.ilv.columns = Parameters{}.vectors.ilv.columns;
    rest.vectors.ilv.radiusScale = Parameters{}.vectors.ilv.radiusScale;
    EXPECT_EQ(rest, Parameters{});
  }
  Parameters twice;
  twice.vectors.ilv.rows = 24;
  twice.vectors.ilv.radiusScale = 1.0;
  applyEffort(twice, StudyEffort::Coarse);
  EXPECT_EQ(twice.vectors.ilv.rows, 16);
  EXPECT_NEAR(twice.vectors.ilv.radiusScale, 1.25, 1e-12);
  Parameters usual;
  applyEffort(usual, StudyEffort::Usual);
  EXPECT_EQ(usual, Parameters{});
}

}  // namespace
}  // namespace lightvane
