// What panels say of numbers: scales, texts, groups, and the factors of lights.

#include <cmath>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/parameter_info.h"
#include "app/panels/theme.h"
#include "app/panels/value_scale.h"
#include "app/panels/workspace.h"
#include "core/base/number_text.h"

namespace lightvane {
namespace {

using testing::IsEmpty;
using testing::Not;

struct ScaleCase {
  double min, max, usual;
  bool whole;
  double low, high;
  bool logarithmic;
};

TEST(ValueScale, SpansWhatIsUsefulAboutTheDefault) {
  const ScaleCase cases[] = {
      {0.0, 1.0, 0.95, false, 0.0, 1.0, false},       // S_curv
      {-1.0, 1.0, 0.95, false, -1.0, 1.0, false},     // dlv.normal_cosine
      {0.0, 64.0, 16.0, true, 0.0, 64.0, false},      // specular.depth
      {1.0, 1000.0, 4.0, true, 1.0, 64.0, true},      // ilv.n_min
      {1.0, 1000.0, 12.0, true, 1.0, 192.0, true},    // ilv.rows
      {0.0, 1000.0, 0.2, false, 0.0, 3.2, true},      // ilv.S_E
      {0.0, 1.0, 0.002, false, 0.0, 0.032, true},     // specular.cutoff
      {0.0, 1000.0, 0.0, true, 0.0, 16.0, true},      // path.max_bounces
      {0.0, 1e7, 0.0, true, 0.0, 1e5, true},          // ilv.seed
      {0.01, 100.0, 1.0, false, 0.0625, 16.0, true},  // ilv.lobe_angle
  };
  for (const ScaleCase& c : cases) {
    const ValueScale scale = ValueScale::about(c.min, c.max, c.usual, c.usual, c.whole);
    const std::string what = fmt::format("{} to {}, usually {}", c.min, c.max, c.usual);
    EXPECT_DOUBLE_EQ(scale.low(), c.low) << what;
    EXPECT_DOUBLE_EQ(scale.high(), c.high) << what;
    EXPECT_EQ(scale.isLogarithmic(), c.logarithmic) << what;
    EXPECT_DOUBLE_EQ(scale.fromFraction(0.0), c.low) << what;
    EXPECT_DOUBLE_EQ(scale.fromFraction(1.0), c.high) << what;
  }
}

TEST(ValueScale, HoldsValuesBeyondItsUsualEnds) {
  const ValueScale scale = ValueScale::about(0.0, 1000.0, 0.2, 700.0, false);
  EXPECT_DOUBLE_EQ(scale.high(), 700.0);
  EXPECT_DOUBLE_EQ(scale.toFraction(700.0), 1.0);
  const ValueScale small = ValueScale::about(0.0, 1000.0, 0.2, 1e-6, false);
  EXPECT_NEAR(small.fromFraction(small.toFraction(1e-6)), 1e-6, 1e-12);
}

TEST(ValueScale, GoesThereAndBack) {
  for (const ValueScale& scale :
       {ValueScale::about(1.0, 1000.0, 4.0, 4.0, true), ValueScale::about(0.0, 64.0, 16.0, 16.0, true),
        ValueScale::about(0.0, 1000.0, 0.0, 3.0, true)}) {
    for (double value = scale.low(); value <= std::min(scale.high(), 40.0); value += 1.0) {
      EXPECT_DOUBLE_EQ(scale.fromFraction(scale.toFraction(value)), value);
    }
  }
  double last = -1.0;
  const ValueScale scale = ValueScale::about(0.0, 1000.0, 0.2, 0.2, false);
  for (int i = 0; i <= 200; ++i) {
    const double value = scale.fromFraction(i / 200.0);
    EXPECT_GE(value, last);
    EXPECT_EQ(fmt::format("{:.3g}", value), fmt::format("{:.4g}", value))
        << "more digits than can be dragged";
    last = value;
  }
}

TEST(Lights, SoloWinsOverMuteAndOthers) {
  std::vector<LightSetting> settings(3);
  settings[1].stops = 1.0f;
  settings[1].tint = Rgb(1.0f, 0.5f, 0.0f);
  EXPECT_EQ(lightFactor(settings, 0), Rgb(1.0f));
  EXPECT_EQ(lightFactor(settings, 1), Rgb(2.0f, 1.0f, 0.0f));
  EXPECT_EQ(lightFactor(settings, 7), Rgb(1.0f));
  settings[0].muted = true;
  EXPECT_EQ(lightFactor(settings, 0), Rgb(0.0f));
  settings[0].soloed = true;
  EXPECT_EQ(lightFactor(settings, 0), Rgb(1.0f));
  EXPECT_EQ(lightFactor(settings, 1), Rgb(0.0f));
}

TEST(Workspace, NoticesEveryKindOfChange) {
  lightvane::Setup a;
  a.lights.resize(1);
  for (void (*change)(lightvane::Setup&) :
       {+[](lightvane::Setup& s) { s.parameters.vectors.dlv.nMin += 1; },
        +[](lightvane::Setup& s) { s.parameters.transport.roulette = false; },
        +[](lightvane::Setup& s) { s.parameters.picture.thin = 0.5; },
        +[](lightvane::Setup& s) { s.camera.target.x = 0.1; },
        +[](lightvane::Setup& s) { s.camera.exposureStops = 1.0; },
        +[](lightvane::Setup& s) { s.brightness.exposureStops = 1.0f; },
        +[](lightvane::Setup& s) { s.lights[0].tint.g = 0.5f; },
        +[](lightvane::Setup& s) { s.threads = 1; }}) {
    lightvane::Setup b = a;
    EXPECT_EQ(a, b);
    change(b);
    EXPECT_NE(a, b);
  }
}

TEST(ParameterInfo, EveryFieldBelongsToOneGroupWithATitle) {
  std::set<std::string> groups;
  for (const ParameterGroup& group : parameterGroups()) {
    EXPECT_TRUE(groups.insert(group.prefix).second) << group.prefix;
    EXPECT_NE(group.title, group.prefix) << "a group without a title of its own";
  }
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    EXPECT_TRUE(groups.contains(std::string(groupOf(row.field.key)))) << row.field.key;
  }
}

TEST(ParameterInfo, EveryFieldHasATooltipThatSaysItAll) {
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::vector<std::string> lines = tooltipLines(
        {.field = row.field, .range = row.range, .defaultValue = row.value, .startValue = row.value});
    ASSERT_GE(lines.size(), 3U) << row.field.key;
    EXPECT_THAT(lines[0], testing::EndsWith(".")) << row.field.key;
    const std::string trade = tradeSentence(row.field.trade);
    EXPECT_EQ(trade.empty() ? "" : lines[1], trade);
    const std::size_t next = trade.empty() ? 1 : 2;
    EXPECT_THAT(lines[next],
                testing::AllOf(testing::StartsWith(row.field.key), testing::HasSubstr(row.range)));
    EXPECT_EQ(lines[next + 1], "Default " + row.value);
  }
  const FieldDescription row = describeParameters(Parameters{}).front();
  EXPECT_EQ(tooltipLines({.field = row.field, .range = "r", .defaultValue = "a", .startValue = "b"})[2],
            "Default a, this scene b");
}

TEST(ParameterInfo, SaysWhatHasNoEffect) {
  SceneSummary scene;
  scene.lights.resize(1);
  Parameters p;
  EXPECT_THAT(whyGroupIsIdle("dlv", p, &scene), testing::StartsWith("No light of this scene"));
  EXPECT_THAT(whyFieldIsIdle("dlv.n_min", p, &scene), Not(IsEmpty()));
  EXPECT_THAT(whyFieldIsIdle("dlv.mode", p, &scene), IsEmpty()) << "the switch itself works";
  scene.lights[0].hasVectors = true;
  EXPECT_THAT(whyGroupIsIdle("dlv", p, &scene), IsEmpty());

  EXPECT_THAT(whyGroupIsIdle("specular", p, &scene), Not(IsEmpty()));
  scene.needs.specular = true;
  EXPECT_THAT(whyGroupIsIdle("specular", p, &scene), IsEmpty());

  EXPECT_EQ(whyFieldIsIdle("ilv.S_E", p, &scene), "ilv.gradient_test is off.");
  p.vectors.ilv.gradientTest = IlvGradientTest::Absolute;
  EXPECT_THAT(whyFieldIsIdle("ilv.S_E", p, &scene), IsEmpty());

  EXPECT_THAT(whyFieldIsIdle("path.samples", p, &scene), Not(IsEmpty()));
  p.picture.method = Method::Path;
  EXPECT_THAT(whyFieldIsIdle("path.samples", p, &scene), IsEmpty());
  EXPECT_THAT(whyGroupIsIdle("ilv", p, &scene), Not(IsEmpty()));
  EXPECT_THAT(whyFieldIsIdle("dlv.mode", p, &scene), Not(IsEmpty()));
}

TEST(ParameterInfo, TheFilterFindsKeysLabelsAndHelp) {
  const Field field{.key = "ilv.n_min", .label = "Fewest vectors", .help = "More smooth the picture."};
  for (const char* filter : {"", "ilv", "N_MIN", "fewest", "smooth vectors", " ilv  few "}) {
    EXPECT_TRUE(matchesFilter(field, filter)) << filter;
  }
  EXPECT_FALSE(matchesFilter(field, "dlv"));
  EXPECT_FALSE(matchesFilter(field, "ilv dlv"));
}

TEST(ParameterInfo, LengthsAreShownInTheUnitsOfTheScene) {
  SceneSummary scene;
  scene.unit = "cm";
  scene.metresPerUnit = 0.01;
  scene.diagonalMetres = 4.0;
  const Length length = Length::relative(0.015);
  EXPECT_DOUBLE_EQ(lengthIn(LengthUnit::Percent, length, &scene), 1.5);
  EXPECT_DOUBLE_EQ(lengthIn(LengthUnit::Metre, length, &scene), 0.06);
  EXPECT_DOUBLE_EQ(lengthIn(LengthUnit::Scene, length, &scene), 6.0);
  EXPECT_EQ(lengthUnitText(LengthUnit::Scene, &scene), "cm");
  EXPECT_DOUBLE_EQ(lengthOf(8.0, LengthUnit::Scene, &scene).value(), 0.08);
  EXPECT_FALSE(lengthOf(8.0, LengthUnit::Scene, &scene).isRelative());
  EXPECT_TRUE(lengthOf(8.0, LengthUnit::Percent, &scene).isRelative());

  EXPECT_EQ(canonicalLength("8", LengthUnit::Scene, &scene), "0.08m");
  EXPECT_EQ(canonicalLength("8 cm", LengthUnit::Percent, &scene), "0.08m");
  EXPECT_EQ(canonicalLength("1.5", LengthUnit::Percent, &scene), "1.5%");
  EXPECT_EQ(canonicalLength("0.1m", LengthUnit::Percent, &scene), "0.1m");
  EXPECT_EQ(canonicalLength("much", LengthUnit::Metre, &scene), "much");
}

TEST(ParameterInfo, TheRivalsTellTheirOwnWork) {
  const std::optional<ChangeEstimate> noVector = ChangeEstimate{};
  Parameters p;
  EXPECT_EQ(changeText("method.name", p, noVector), "no new vector");
  EXPECT_THAT(changeText("method.name", p, std::nullopt), testing::HasSubstr("light vectors"));
  p.picture.method = Method::Naive;
  p.picture.naiveSamples = 1280;
  EXPECT_EQ(changeText("method.name", p, noVector),
            "a full gather at every visible point, of 1,280 rays each");
  EXPECT_EQ(changeText("naive.samples", p, noVector), changeText("method.name", p, noVector));
  p.picture.method = Method::Path;
  p.picture.pathSamples = 1;
  EXPECT_EQ(changeText("method.name", p, noVector), "1 path for each pixel");
  p.picture.method = Method::Direct;
  EXPECT_THAT(changeText("method.name", p, noVector), testing::HasSubstr("16 shadow rays to each light"));
  EXPECT_EQ(changeText("ilv.n_min", p, std::nullopt), "");
}

TEST(ParameterInfo, NoCostSpeaksOfVectorsThatAreNotComputed) {
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string key = row.field.key;
    const std::string text = costText(row.field);
    EXPECT_THAT(text, testing::EndsWith(".")) << key;
    if (key == "method.name" || key == "path.samples" || key == "naive.samples")
      EXPECT_THAT(text, Not(testing::HasSubstr("vectors anew"))) << key;
    else
      EXPECT_EQ(text, costSentence(row.field.cost)) << key;
  }
}

TEST(ParameterInfo, SaysHowManyVectors) {
  EXPECT_EQ(estimateText(std::nullopt), "");
  EXPECT_EQ(estimateText(ChangeEstimate{}), "no new vector");
  EXPECT_EQ(estimateText(ChangeEstimate{.newIndirect = 1188, .newDirect = 40}),
            "about 1,200 new ILVs and 40 new DLVs");
  EXPECT_EQ(estimateText(ChangeEstimate{2550, 21690, 2551, 0}),
            "about 2,600 new ILVs; 2,550 ILVs and 21,690 DLVs become stale");
  EXPECT_EQ(estimateText(ChangeEstimate{.newDirect = 1}), "about 1 new DLV");
  EXPECT_EQ(estimateText(ChangeEstimate{.staleIndirect = 7}), "no new vector; 7 ILVs become stale");
}

}  // namespace
}  // namespace lightvane
