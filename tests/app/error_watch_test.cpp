// How far off the window's picture is: what is worked out beside it, and when.

#include "app/error_watch.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/inspect/units.h"
#include "core/measure/picture_error.h"
#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

using testing::HasSubstr;
using testing::Not;

class ErrorWatchTest : public testing::Test {
 protected:
  std::shared_ptr<const RenderFrame> frameOf(const render_test::Settings& settings, bool whole = true) const {
    return std::make_shared<const RenderFrame>(
        inspect_test::renderFrame(stage_, render_test::parametersWith(settings), whole ? -1 : 1));
  }
  /// Until something new is there to be shown; false where that does not come.
  bool waitForWake() {
    for (int i = 0; i < 1000 && wakes_ == seen_; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const bool came = wakes_ != seen_;
    seen_ = wakes_;
    return came;
  }

  const render_test::Stage stage_{render_test::shippedScene("cornell.toml", 24, 24)};
  std::atomic<int> wakes_ = 0;
  int seen_ = 0;
  ErrorWatch watch_{[this] { ++wakes_; }};
};

TEST_F(ErrorWatchTest, TellsWhatTheVectorsSayAndWhatTheReferenceDoes) {
  const auto frame = frameOf({{"preset", "draft"}});
  watch_.update(frame, {}, true);
  EXPECT_EQ(watch_.textOf(frame.get()), "") << "not yet";
  ASSERT_TRUE(waitForWake());
  watch_.update(frame, {}, true);
  ASSERT_NE(watch_.estimateOf(frame.get()), nullptr);
  EXPECT_FALSE(watch_.estimateOf(frame.get())->variance.empty());
  EXPECT_THAT(watch_.textOf(frame.get()), HasSubstr("its indirect light is off by about"));
  EXPECT_THAT(watch_.textOf(frame.get()), Not(HasSubstr("reference")));
  // What the vectors say is kept when a reference comes.
  const auto estimate = watch_.estimateOf(frame.get());
  const auto same = std::make_shared<const ImageRgb>(frame->film->sceneBeauty(*frame->scene));
  watch_.update(frame, {same, nullptr}, true);
  ASSERT_TRUE(waitForWake());
  watch_.update(frame, {same, nullptr}, true);
  EXPECT_EQ(watch_.estimateOf(frame.get()), estimate);
  EXPECT_THAT(watch_.textOf(frame.get()), HasSubstr("From the reference it is off by 0 ± 0 %."));
  // Of another frame nothing is known.
  const auto other = frameOf({{"preset", "draft"}, {"seed", "2"}});
  EXPECT_EQ(watch_.estimateOf(other.get()), nullptr);
  EXPECT_EQ(watch_.textOf(other.get()), "");
}

// A path traced reference of few paths is off by far more than the picture is.
TEST_F(ErrorWatchTest, TakesTheReferencesNoiseOff) {
  const auto frame = frameOf({{"preset", "fine"}});
  const auto paths = frameOf({{"method.name", "path"}, {"path.samples", "64"}, {"seed", "1000003"}});
  const Film& traced = *paths->film;
  const auto beauty = std::make_shared<const ImageRgb>(traced.sceneBeauty(*paths->scene));
  const auto variance = std::make_shared<const ImageRgb>(traced.sceneVariance(*paths->scene));
  watch_.update(frame, {beauty, variance}, true);
  ASSERT_TRUE(waitForWake());
  watch_.update(frame, {beauty, variance}, true);
  const double noise = pictureNoise(*beauty, *variance);
  const PictureError without = pictureError(frame->film->sceneBeauty(*frame->scene), *beauty, *variance);
  ASSERT_LT(without.relative, 0.7 * noise);
  EXPECT_THAT(
      watch_.textOf(frame.get()),
      HasSubstr(fmt::format("it is off by {} ± {} %, whose noise ({} %) is taken off.",
                            numberText(100.0 * without.relative),
                            numberText(100.0 * without.standardError, 2), numberText(100.0 * noise, 2))));
}

TEST_F(ErrorWatchTest, WaitsForAPictureThatRests) {
  const auto half = frameOf({{"preset", "draft"}}, false);
  const auto whole = frameOf({{"preset", "draft"}});
  watch_.update(nullptr, {}, true);
  watch_.update(half, {}, true);
  watch_.update(whole, {}, false);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(wakes_, 0);
  watch_.update(whole, {}, true);
  EXPECT_TRUE(waitForWake());
}

TEST_F(ErrorWatchTest, LeavesPicturesWithoutVectorsAlone) {
  watch_.update(frameOf({{"method.name", "direct"}}), {}, true);
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(wakes_, 0);
}

}  // namespace
}  // namespace lightvane
