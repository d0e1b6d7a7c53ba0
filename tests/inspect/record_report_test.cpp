#include "core/inspect/record_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/pixel_report.h"
#include "core/inspect/record_names.h"
#include "tests/inspect/frames.h"

namespace lightvane::inspect_test {
namespace {

using testing::HasSubstr;

class RecordReports : public testing::TestWithParam<Way> {
 protected:
  static const RenderFrame& frame() {
    static std::map<std::string, RenderFrame> frames;
    const auto [known, isNew] = frames.try_emplace(GetParam().name);
    if (isNew)
      known->second = renderShipped(GetParam().scene, 32, GetParam().settings, -1, GetParam().lights);
    return known->second;
  }

  static std::vector<RecordRef> records() {
    std::vector<RecordRef> all;
    for (std::uint32_t n = 0; n < frame().snapshot->indirect.size(); ++n) all.push_back({kNone, n});
    for (std::uint32_t l = 0; l < frame().snapshot->direct.size(); ++l) {
      for (std::uint32_t n = 0; n < frame().snapshot->direct[l].size(); ++n) all.push_back({l, n});
    }
    return all;
  }
};

// Vectors are pure: computed again, on this thread and alone, each is the same to the bit.
TEST_P(RecordReports, ComputeEveryVectorAgain) {
  int same = 0;
  for (const RecordRef& record : records()) {
    const RecordReport report = recordReport(frame(), record);
    EXPECT_EQ(report.recomputation, Recomputation::Same) << report.title << ": " << report.note;
    same += report.recomputation == Recomputation::Same;
    for (const ReportRow& row : report.rows) {
      EXPECT_FALSE(row.text.empty()) << row.label;
      EXPECT_THAT(row.text, testing::Not(HasSubstr("not a number"))) << row.label;
    }
    if (!record.isIndirect()) continue;
    const IndirectLightVector& vector = frame().snapshot->indirect[record.number];
    if (report.hemisphere.cells.empty()) {
      EXPECT_GT(vector.lobeWidth, 0.0f);
      continue;
    }
    // The hemisphere is in the scene's units: so is what it adds up to.
    const Rgb irradiance = hemisphereIrradiance(report.hemisphere);
    const float scale = frame().scene->normalisation.radianceScale();
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(irradiance[c], scale * vector.irradiance[c],
                  1e-5f * (scale * vector.irradiance[c] + 1e-20f));
  }
  EXPECT_GT(same, 100);
}

// Pixels that a vector serves are those whose report gives it a share.
TEST_P(RecordReports, ServedPixelsAreThoseWithAShare) {
  const int width = frame().film->width;
  const int height = frame().film->height;
  std::vector<PixelReport> reports;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) reports.push_back(pixelReport(frame(), x, y));
  }
  const std::vector<RecordRef> all = records();
  std::size_t served = 0;
  for (std::size_t i = 0; i < all.size(); i += 7) {
    const Image<std::uint8_t> mask = servedPixels(frame(), all[i]);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        bool hasShare = false;
        for (const PointReport& point : reports[frame().film->depth().index(x, y)].points) {
          for (const auto* answers : {&point.lights, &point.indirect}) {
            for (const AnswerReport& answer : *answers) {
              for (const CandidateReport& candidate : answer.candidates)
                hasShare = hasShare || (candidate.used && candidate.record == all[i]);
            }
          }
        }
        ASSERT_EQ(mask.at(x, y) != 0, hasShare)
            << recordName(*frame().scene, all[i]) << " at " << x << ", " << y;
        served += hasShare;
      }
    }
  }
  EXPECT_GT(served, 100u);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, RecordReports,
    testing::Values(
        Way{"refined", "cornell.toml", {{"preset", "draft"}, {"ilv.seed", "30"}}},
        Way{"mirror", "cornell-mirror.toml", {{"preset", "draft"}}},
        Way{"glossy", "cornell-glossy.toml", {{"preset", "draft"}}},
        Way{"paper", "cornell-glossy.toml", {{"preset", "draft"}, {"method.rules", "paper"}}},
        Way{"dlv",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}, {"dlv.r_max", "5%"}}},
        Way{"dlv_paper",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"method.rules", "paper"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}}},
        Way{"dimmed",
            "cornell-glossy.toml",
            {{"preset", "draft"}, {"dlv.mode", "always"}, {"dlv.seed", "200"}},
            dimmedLight()}),
    [](const testing::TestParamInfo<Way>& way) { return std::string(way.param.name); });

// Vectors of another camera have no visible point here; the surface beneath them gives most of them back.
TEST(RecordReport, FindsPointsOfAnotherView) {
  SceneDescription scene = shippedScene("cornell.toml", 32, 32);
  const Parameters parameters = parametersWith({{"preset", "draft"}});
  const RenderFrame first = renderFrame(Stage(scene), parameters);
  scene.cameras.front().position.x += 0.1;
  const RenderFrame second = renderFrame(Stage(scene), parameters, -1, {first.snapshot, false});
  int same = 0;
  const auto count = static_cast<std::uint32_t>(first.snapshot->indirect.size());
  for (std::uint32_t n = 0; n < count; ++n) {
    const RecordReport report = recordReport(second, {kNone, n});
    EXPECT_NE(report.recomputation, Recomputation::Impossible);
    if (report.recomputation == Recomputation::Same) {
      ++same;
    } else {
      EXPECT_THAT(report.note, HasSubstr("surface beneath"));
    }
  }
  EXPECT_GT(same, static_cast<int>(count) * 9 / 10) << "of " << count;
}

TEST(RecordReport, SaysWhyAVectorIsAnother) {
  RenderFrame frame = renderShipped("cornell.toml", 24, {{"preset", "draft"}});
  frame.parameters.picture.seed = 77;
  EXPECT_THAT(recordReport(frame, {kNone, 3}).note, HasSubstr("another seed"));
  EXPECT_TRUE(recordReport(frame, {kNone, 3}).hemisphere.cells.empty());
  frame.parameters.picture.seed = 1;
  frame.parameters.vectors.ilv.rows += 1;
  EXPECT_THAT(recordReport(frame, {kNone, 3}).note, HasSubstr("other parameters"));
  EXPECT_THAT(recordReport(frame, {kNone, 1'000'000}).title, HasSubstr("no such vector"));
  EXPECT_THAT(recordReport(frame, {99, 0}).title, HasSubstr("no such vector"));
  // In mid-air.
  auto snapshot = std::make_shared<Snapshot>(*frame.snapshot);
  IndirectLightVector lost = snapshot->indirect[0];
  lost.point.position = frame.scene->bounds.centre() + Vec3(0.0f, 0.2f, 0.0f) * frame.scene->diagonal;
  snapshot->indirect = snapshot->indirect.with({lost}, [](const auto&) { return 0.1f; });
  frame.snapshot = snapshot;
  const RecordReport report =
      recordReport(frame, {kNone, static_cast<std::uint32_t>(snapshot->indirect.size() - 1)});
  EXPECT_EQ(report.recomputation, Recomputation::Impossible);
  EXPECT_THAT(report.note, HasSubstr("no surface"));
  EXPECT_FALSE(report.rows.empty());
}

TEST(RecordReport, ServesNothingWithoutVectors) {
  const RenderFrame naive =
      renderShipped("cornell.toml", 16, {{"method.name", "naive"}, {"naive.samples", "8"}});
  const Image<std::uint8_t> mask = servedPixels(naive, {kNone, 0});
  EXPECT_EQ(std::count(mask.begin(), mask.end(), 0), 256);
  EXPECT_EQ(recordReport(naive, {kNone, 0}).title, "no such vector");
}

}  // namespace
}  // namespace lightvane::inspect_test
