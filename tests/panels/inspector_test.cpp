// The inspector on reports of a real picture.

#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/hemisphere_view.h"
#include "app/panels/inspector_panel.h"
#include "core/inspect/full_computation.h"
#include "core/inspect/pixel_report.h"
#include "core/inspect/record_report.h"
#include "tests/inspect/frames.h"
#include "tests/panels/panel_driver.h"

namespace lightvane {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr int kSize = 24;

/// Rendered once for all tests.
const RenderFrame& frameOfMirrors() {
  static const RenderFrame frame = inspect_test::renderShipped("cornell-mirror.toml", kSize);
  return frame;
}

/// A pixel whose first point was answered by several ILVs.
PixelReport interpolatedPixel() {
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      PixelReport report = pixelReport(frameOfMirrors(), x, y);
      if (report.points.empty() || report.points[0].indirect.empty()) continue;
      if (report.points[0].indirect[0].candidates.size() >= 3) return report;
    }
  }
  throw std::runtime_error("no pixel was interpolated from three vectors");
}

class Inspector : public testing::TestWithParam<PanelDriver::Screen> {
 protected:
  Inspector() : driver_(GetParam()), report_(interpolatedPixel()) {
    driver_.input.scene = richScene();
    driver_.input.compiledScene = frameOfMirrors().scene.get();
    driver_.input.pixel = &report_;
    driver_.workspace.selection.pixel = PixelRef{report_.x, report_.y};
    driver_.action(ActionId::TabInspector);
  }

  const CandidateReport& candidate(std::size_t i) { return report_.points[0].indirect[0].candidates[i]; }

  PanelDriver driver_;
  PixelReport report_;
};

TEST_P(Inspector, PointingAtACandidatePointsAtItsVectorAndAClickSelectsIt) {
  const RecordReport record = recordReport(frameOfMirrors(), candidate(1).record);
  driver_.input.record = &record;
  driver_.moveTo("inspector.point.0.indirect.0.1");
  EXPECT_EQ(driver_.workspace.selection.hoveredRecord, candidate(1).record);
  driver_.click("inspector.point.0.indirect.0.1");
  EXPECT_THAT(driver_.workspace.selection.records, Contains(candidate(1).record));
  EXPECT_TRUE(driver_.workspace.selection.pixel) << "the pixel is still asked about";
  // Its facts stand below its line, before the next candidate.
  const WidgetPlace next = driver_.require("inspector.point.0.indirect.0.2");
  const auto place = Widgets::find("records.delete");
  ASSERT_TRUE(place);
  EXPECT_LT(place->min.y, next.min.y);
  driver_.moveTo("menu.File");
  EXPECT_TRUE(driver_.workspace.selection.hoveredRecord.isNone());
}

TEST_P(Inspector, AVectorThatIsNoCandidateStandsFirst) {
  RecordReport record = recordReport(frameOfMirrors(), candidate(0).record);
  driver_.input.record = &record;
  driver_.input.pixel = nullptr;
  driver_.workspace.selection.pixel.reset();
  driver_.workspace.selection.records = {record.record};
  driver_.frames(3);
  EXPECT_TRUE(Widgets::find("inspector.hemisphere"));
  driver_.click("inspector.distances");
  EXPECT_TRUE(driver_.state.inspector.distances);
  driver_.hover("inspector.hemisphere");
  for (const WidgetPlace& place : Widgets::all()) EXPECT_FALSE(place.isClippedHorizontally()) << place.name;
}

TEST_P(Inspector, ComputesHereAndSaysWhereTheDifferenceComesFrom) {
  driver_.click("pixel.compute_here");
  EXPECT_THAT(driver_.asked.actions, Contains(ActionId::ComputeHere));
  const StopFlag never = false;
  const FullComputation full = computeHere(frameOfMirrors(), report_.x, report_.y, 64, never);
  ASSERT_TRUE(full.finished) << full.note;
  driver_.input.full = &full;
  driver_.input.fullProgress = "64 of 1,024 samples";
  driver_.frames(3);
  for (const WidgetPlace& place : Widgets::all()) EXPECT_FALSE(place.isClippedHorizontally()) << place.name;
}

TEST_P(Inspector, EveryPixelsReportIsDrawnUnfolded) {
  for (int i = 0; i < kSize; i += 3) {
    report_ = pixelReport(frameOfMirrors(), i, (7 * i) % kSize);
    for (std::size_t p = 0; p < report_.points.size(); ++p) {
      const std::string point = "inspector.point." + std::to_string(p);
      driver_.state.inspector.unfolded.insert({point + ".place", point + ".light.0", point + ".indirect.0"});
    }
    driver_.frames(2);
    for (const WidgetPlace& place : Widgets::all()) EXPECT_FALSE(place.isClippedHorizontally()) << place.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Screens, Inspector,
                         testing::Values(PanelDriver::Screen{1024, 640, 1.0f, Theme::Dark},
                                         PanelDriver::Screen{1024, 640, 2.0f, Theme::Bright}),
                         [](const auto& screen) { return screen.param.scale > 1.0f ? "Scaled" : "Plain"; });

TEST(InspectorTexts, SharesAreOfLuminance) {
  EXPECT_EQ(shareText(Rgb(0.25f), Rgb(1.0f)), "25.0 %");
  EXPECT_EQ(shareText(Rgb(1.0f), Rgb(0.0f)), "");
}

TEST(HemisphereView, CellsHaveEqualAreasAndLieWhereTheirDirectionsDo) {
  const RecordReport report = recordReport(frameOfMirrors(), RecordRef{.light = kNone, .number = 0});
  const Hemisphere& hemisphere = report.hemisphere;
  ASSERT_FALSE(hemisphere.cells.empty()) << report.note;
  for (int row = 0; row < hemisphere.rows; ++row) {
    for (int column = 0; column < hemisphere.columns; ++column) {
      // Lambert's projection of the direction that was traced in the cell.
      const Vec3 d = hemisphere.cell(row, column).direction;
      const float across = std::sqrt(d.x * d.x + d.y * d.y);
      const float r = std::sqrt(std::max(0.0f, 1.0f - d.z));
      const auto cell = hemisphereCellAt(hemisphere, r * d.x / across, r * d.y / across);
      ASSERT_TRUE(cell);
      EXPECT_EQ(*cell, (HemisphereCell{row, column}));
    }
  }
  EXPECT_FALSE(hemisphereCellAt(hemisphere, 0.8f, 0.8f));
}

}  // namespace
}  // namespace lightvane
