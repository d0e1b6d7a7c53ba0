// When a full computation stays, though other frames come.

#include "app/inspection.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "core/inspect/frame_points.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;

constexpr PixelRef kAskedPixel{9, 13};  // odd: only the last pass looks at it

/// A room and what is known of one of its pixels.
class InspectionTest : public testing::Test {
 protected:
  InspectionTest() : frame_(inspect_test::renderShipped("cornell.toml", 16, {{"dlv.mode", "always"}})) {
    selection_.pixel = kAskedPixel;
  }

  void show(const RenderFrame& frame, bool rests = true) {
    inspection_.update(std::make_shared<const RenderFrame>(frame), selection_, rests);
  }
  /// Frames with nothing new until the computation is there; false after a minute.
  bool compute() {
    const auto frame = std::make_shared<const RenderFrame>(frame_);
    inspection_.update(frame, selection_, true);
    inspection_.computeHere();
    for (int i = 0; i < 6000 && inspection_.full() == nullptr; ++i) {
      std::this_thread::sleep_for(10ms);
      inspection_.update(frame, selection_, true);
    }
    return inspection_.full() != nullptr;
  }
  /// The frame with other parameters.
  RenderFrame changed(const inspect_test::Settings& settings) const {
    RenderFrame frame = frame_;
    render_test::setParameters(frame.parameters, settings);
    return frame;
  }
  /// The frame with another answer at a pixel.
  RenderFrame answeredOtherwise(const PixelRef& pixel) const {
    RenderFrame frame = frame_;
    const PixelPoints points =
        pointsOfPixel(*frame.points, static_cast<std::uint32_t>(pixel.y * frame.region.width + pixel.x));
    TileAnswers answers = *frame.answers[points.tile];
    answers.indirect[points.first] += Rgb(0.1f);
    frame.answers[points.tile] = std::make_shared<const TileAnswers>(std::move(answers));
    return frame;
  }

  RenderFrame frame_;
  Selection selection_;
  Inspection inspection_{[] {}};
};

TEST_F(InspectionTest, AFullComputationStaysWhereWhatItIsAboutDoes) {
  ASSERT_TRUE(compute());
  const Vec3d before = inspection_.full()->total.full;
  ASSERT_NE(before, Vec3d(0.0));
  RenderFrame again = frame_;
  again.number += 1;
  again.request += 1;
  RenderFrame brighter = frame_;
  brighter.camera.exposureStops += 1.0;
  RenderFrame coarse = frame_;
  coarse.reduction = 4;
  // A pause, another generation of vectors that answer the pixel alike, and what only says where they are.
  for (const RenderFrame& other : {again, brighter, coarse, answeredOtherwise({2, 3}),
                                   changed({{"passes.first_stride", "4"}}), changed({{"ilv.S_E", "0.4"}})}) {
    show(other);
    EXPECT_EQ(inspection_.full() == nullptr, other.reduction > 1) << "coarse pictures have no reports";
    show(frame_);
    ASSERT_NE(inspection_.full(), nullptr);
    EXPECT_EQ(inspection_.full()->total.full, before);
  }
  EXPECT_FALSE(inspection_.isComputing() || inspection_.isWaiting()) << "nothing was computed again";
}

TEST_F(InspectionTest, AFullComputationGoesWithWhatItIsAbout) {
  RenderFrame moved = frame_;
  moved.camera.position.x += 0.01f;
  RenderFrame dimmed = frame_;
  dimmed.lights.direct.assign(frame_.scene->lights.size(), Rgb(0.5f));
  const RenderFrame others[] = {moved,
                                dimmed,
                                answeredOtherwise(kAskedPixel),
                                changed({{"ilv.rows", "5"}}),
                                changed({{"seed", "7"}}),
                                changed({{"light.samples", "3"}})};
  for (std::size_t i = 0; i < std::size(others); ++i) {
    ASSERT_TRUE(compute()) << i;
    show(others[i]);
    EXPECT_EQ(inspection_.full(), nullptr) << "other frame " << i;
    show(frame_);
    EXPECT_EQ(inspection_.full(), nullptr) << "it was forgotten, other frame " << i;
  }
  ASSERT_TRUE(compute());
  selection_.pixel = PixelRef{3, 3};
  show(frame_);
  EXPECT_EQ(inspection_.full(), nullptr) << "of another pixel";
}

TEST_F(InspectionTest, AFullComputationComesBackWhereTheSamePictureIsRenderedAgain) {
  ASSERT_TRUE(compute());
  const RenderFrame coming = inspect_test::renderShipped("cornell.toml", 16, {{"dlv.mode", "always"}}, 1);
  RenderFrame begun = frame_;
  begun.answers = coming.answers;
  ASSERT_NE(fullSubject(begun, kAskedPixel).looked, fullSubject(frame_, kAskedPixel).looked)
      << "the first pass must not have looked at this pixel";
  show(begun, false);
  EXPECT_EQ(inspection_.full(), nullptr) << "there is nothing to compare with yet";
  show(frame_);
  EXPECT_NE(inspection_.full(), nullptr);
}

TEST_F(InspectionTest, AComputationUnderWayGoesOnWhileThePixelIsAlike) {
  show(frame_);
  inspection_.computeHere();
  show(answeredOtherwise({2, 3}), false);
  EXPECT_FALSE(inspection_.isWaiting());
  EXPECT_TRUE(inspection_.isComputing() || inspection_.full() != nullptr);
  // It takes a tenth of a second: where this thread was stopped for that long, once more.
  for (int attempt = 0; attempt < 20 && !inspection_.isWaiting(); ++attempt) {
    show(frame_);
    inspection_.computeHere();
    show(answeredOtherwise(kAskedPixel), false);
  }
  EXPECT_TRUE(inspection_.isWaiting()) << "it is of no use with this frame";
  EXPECT_FALSE(inspection_.isComputing());
  show(frame_);
  EXPECT_TRUE(inspection_.isComputing()) << "at rest it begins anew";
}

}  // namespace
}  // namespace lightvane
