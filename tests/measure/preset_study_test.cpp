#include "core/measure/preset_study.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

using testing::HasSubstr;

TEST(PresetCandidates, AreDifferentAndHaveTheShippedAmongThem) {
  const std::vector<PresetCandidate> candidates = presetCandidates();
  std::set<std::string> labels;
  for (const PresetCandidate& candidate : candidates) labels.insert(candidate.label());
  EXPECT_EQ(labels.size(), candidates.size());
  for (const auto& preset : kPresetNames)
    EXPECT_EQ(std::ranges::count(candidates, shippedCandidate(preset.value)), 1) << preset.name;
}

// What a candidate sets is what the preset sets, but for light.samples: no knob is forgotten.
TEST(PresetCandidates, AreAllThatPresetsSet) {
  for (const auto& preset : kPresetNames) {
    Parameters expected;
    applyPreset(expected, preset.value);
    expected.transport.lightSamples = Parameters{}.transport.lightSamples;
    std::vector<RenderSetting> settings;
    for (const auto& [key, value] : shippedCandidate(preset.value).settings())
      settings.push_back({key, value, "test"});
    const auto made = applySettings(Parameters{}, settings);
    ASSERT_TRUE(made);
    EXPECT_EQ(*made, expected) << preset.name;
  }
}

/// A candidate with these times and errors, the same for all of three seeds but for `scatter` about them.
CandidateWorth worthWith(double time, double error, double scatter = 1.0) {
  return {{time, time, time}, {error / scatter, error, error * scatter}};
}

// draft, balanced and fine are the first three; times in parts of balanced's.
constexpr std::array<std::size_t, 3> kShippedPlaces = {0, 1, 2};
std::vector<CandidateWorth> shippedWorth() {
  return {worthWith(0.4, 2.0), worthWith(1.0, 1.0), worthWith(4.5, 0.5)};
}

TEST(PickPresets, LeavesWhatIsBest) {
  std::vector<CandidateWorth> worth = shippedWorth();
  worth.push_back(worthWith(0.45, 2.1));  // slower and worse than draft
  worth.push_back(worthWith(0.3, 2.05));  // faster than draft, but worse: there is no prize for that
  worth.push_back(worthWith(1.01, 0.9));  // too slow for balanced, not good enough for fine
  worth.push_back(worthWith(5.01, 0.1));  // too slow for fine, whatever its error
  const auto picks = pickPresets(worth, kShippedPlaces);
  ASSERT_TRUE(picks);
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ((*picks)[p].best, p);
    EXPECT_EQ((*picks)[p].picked(), p);
  }
}

TEST(PickPresets, TakesWhatIsSurelyBetter) {
  std::vector<CandidateWorth> worth = shippedWorth();
  worth.push_back(worthWith(kPresetTimes[0], 1.6, 1.02));
  worth.push_back(worthWith(0.8, 0.9, 1.02));
  worth.push_back(worthWith(kPresetTimes[2], 0.4, 1.02));
  const auto picks = pickPresets(worth, kShippedPlaces);
  ASSERT_TRUE(picks);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ((*picks)[p].picked(), 3 + p);
  EXPECT_NEAR((*picks)[0].gain.mean, 2.0 / 1.6, 1e-9);
  EXPECT_NEAR((*picks)[1].gain.mean, 1.0 / 0.9, 1e-9);
  EXPECT_NEAR((*picks)[2].gain.mean, 0.5 / 0.4, 1e-9);
  // Errors of three seeds scatter by 2 %: 4.303 of log 1.02 / sqrt(3) on either side.
  ASSERT_TRUE((*picks)[0].gain.low);
  EXPECT_NEAR(std::log(*(*picks)[0].gain.low), std::log(2.0 / 1.6) - 4.303 * std::log(1.02) / std::sqrt(3.0),
              1e-6);
}

TEST(PickPresets, IsNotMovedByChance) {
  std::vector<CandidateWorth> worth = shippedWorth();
  worth.push_back(worthWith(0.4, 1.6, 1.3));
  auto picks = pickPresets(worth, kShippedPlaces);
  ASSERT_TRUE(picks);
  EXPECT_EQ((*picks)[0].best, 3U);
  EXPECT_EQ((*picks)[0].picked(), 0U) << "it scatters by more than it gains";
  // One seed says nothing of chance.
  for (CandidateWorth& one : worth) one = {{one.times[1]}, {one.errors[1]}};
  picks = pickPresets(worth, kShippedPlaces);
  ASSERT_TRUE(picks);
  EXPECT_EQ((*picks)[0].best, 3U);
  EXPECT_FALSE((*picks)[0].gain.low);
  EXPECT_EQ((*picks)[0].picked(), 0U);
}

// What ships may take longer than its limit: it stays where nothing within it is better.
TEST(PickPresets, ComparesWithWhatShipsWhateverThatTakes) {
  const std::vector<CandidateWorth> slow = {worthWith(0.6, 2.0), worthWith(1.0, 1.0), worthWith(6.0, 0.3),
                                            worthWith(0.5, 2.1), worthWith(5.0, 0.4)};
  const auto kept = pickPresets(slow, kShippedPlaces);
  ASSERT_TRUE(kept);
  for (std::size_t p = 0; p < 3; ++p) EXPECT_EQ((*kept)[p].picked(), p);
  EXPECT_EQ((*kept)[2].best, 4U);
  EXPECT_FALSE(pickPresets({}, kShippedPlaces));
  EXPECT_FALSE(pickPresets(std::vector<CandidateWorth>(3), kShippedPlaces));
}

/// Candidates in a scene: twice the cells take twice the time for an error smaller by the root of 2, and
/// nothing else matters; but the one called `lucky` has 0.7 of that error.
StudiedScene candidatesIn(const std::string& name, double slowness, const PresetCandidate& lucky) {
  StudiedScene scene{name, {}};
  for (const PresetCandidate& candidate : presetCandidates()) {
    SweepPoint point;
    point.method = "vectors";
    point.label = candidate.label();
    for (const double noise : {0.99, 1.0, 1.01}) {
      SweepRun run;
      const double cells = candidate.rows * candidate.columns;
      run.cpuSeconds = slowness * cells;
      const double error = noise * (candidate == lucky ? 0.7 : 1.0) / std::sqrt(cells);
      for (const char* layer : {"beauty", "indirect"}) run.metrics[std::string(layer) + ".relative"] = error;
      point.runs.push_back(run);
    }
    scene.sweep.points.push_back(std::move(point));
  }
  return scene;
}

TEST(PresetTables, SayWhatIsPicked) {
  PresetCandidate lucky = shippedCandidate(Preset::Balanced);
  lucky.radiusScale = 0.3;
  const std::vector<StudyTable> tables =
      presetTables(std::vector{candidatesIn("room", 1.0, lucky), candidatesIn("yard", 7.0, lucky)});
  ASSERT_EQ(tables.size(), 2U);
  const auto& picks = tables[0].rows;
  ASSERT_EQ(picks.size(), 4U);
  EXPECT_EQ(picks[2][0], "balanced");
  EXPECT_EQ(picks[2][4], lucky.label());
  EXPECT_EQ(picks[2][7], "1.43 [1.43, 1.43]") << "1 / 0.7: seeds share their noise";
  EXPECT_EQ(picks[2][8], "2 of 2");
  EXPECT_EQ(picks[2][9], lucky.label());

  const auto& rows = tables[1].rows;
  EXPECT_EQ(rows.size(), 1 + presetCandidates().size());
  const auto found = std::ranges::find_if(rows, [&](const auto& row) { return row[0] == lucky.label(); });
  ASSERT_NE(found, rows.end());
  EXPECT_EQ((*found)[2], "0.70 [0.70, 0.70]");
  EXPECT_EQ((*found)[6], "yes");
  EXPECT_EQ(std::ranges::count_if(rows, [](const auto& row) { return row.back() == "fine"; }), 1);
}

TEST(PresetTables, OfWhatIsNotDoneSaySo) {
  const PresetCandidate balanced = shippedCandidate(Preset::Balanced);
  StudiedScene room = candidatesIn("room", 1.0, balanced), yard = candidatesIn("yard", 1.0, balanced);
  // No error above 0 in one scene: the other counts alone.
  for (SweepRun& run : yard.sweep.points.back().runs) run.metrics["indirect.relative"] = 0.0;
  const std::vector<StudyTable> tables = presetTables(std::vector{room, yard});
  EXPECT_EQ(tables[0].rows[1][8].substr(1), " of 1");
  EXPECT_THAT(tables[1].text, HasSubstr("Left out, as errors there are 0"));
  EXPECT_THAT(tables[1].text, HasSubstr("yard"));
  EXPECT_THAT(presetTables(std::span(&yard, 1)).front().text, HasSubstr("References of more paths"));
  room.sweep.points.pop_back();
  EXPECT_EQ(presetTables(std::span(&room, 1)).front().rows.size(), 1U);
  EXPECT_FALSE(studyMarkdown(presetTables({})).empty());
}

}  // namespace
}  // namespace lightvane
