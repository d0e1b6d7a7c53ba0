// Where the error of the window's picture comes from: when that is found out, and how it becomes finer.

#include "app/error_explanation.h"

#include <atomic>
#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/inspect/frames.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

class ErrorExplanationTest : public testing::Test {
 protected:
  std::shared_ptr<const RenderFrame> frameOf(bool whole = true) const {
    return std::make_shared<const RenderFrame>(inspect_test::renderFrame(
        stage_, render_test::parametersWith({{"preset", "draft"}}), whole ? -1 : 1));
  }
  /// Until that many pixels are known; false where that does not come.
  bool waitForPixels(const std::shared_ptr<const RenderFrame>& frame, std::size_t pixels) {
    for (int i = 0; i < 6000; ++i) {
      explanation_.update(frame, true, true);
      const auto known = explanation_.sourcesOf(frame.get());
      if (known && known->pixels.size() >= pixels) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  const render_test::Stage stage_{render_test::shippedScene("cornell.toml", 32, 32)};
  std::atomic<int> wakes_ = 0;
  ErrorExplanation explanation_{[this] { ++wakes_; }};
};

TEST_F(ErrorExplanationTest, BecomesFinerUntilAllPixelsAreKnown) {
  const auto frame = frameOf();
  explanation_.update(frame, true, true);
  EXPECT_EQ(explanation_.sourcesOf(frame.get()), nullptr);
  EXPECT_THAT(explanation_.textOf(frame.get()), HasSubstr("finding out"));
  ASSERT_TRUE(waitForPixels(frame, 4));
  EXPECT_THAT(explanation_.textOf(frame.get()), HasSubstr("of 1,024 pixels"));
  ASSERT_TRUE(waitForPixels(frame, 1024));
  explanation_.update(frame, true, true);
  EXPECT_EQ(explanation_.textOf(frame.get()), "1,024 of 1,024 pixels, 256 samples each");
  EXPECT_GE(wakes_, 5);
  // Another picture has sources of its own.
  const auto other = frameOf();
  explanation_.update(other, false, true);
  EXPECT_EQ(explanation_.sourcesOf(frame.get()), nullptr);
  EXPECT_EQ(explanation_.sourcesOf(other.get()), nullptr);
}

TEST_F(ErrorExplanationTest, WorksOnlyWhereSomebodyLooksAtAPictureThatRests) {
  const auto frame = frameOf();
  explanation_.update(frame, false, true);
  EXPECT_EQ(explanation_.textOf(frame.get()), "");
  explanation_.update(frame, true, false);
  EXPECT_EQ(explanation_.textOf(frame.get()), "begins when the rendering rests");
  const auto early = frameOf(false);
  explanation_.update(early, true, true);
  EXPECT_EQ(explanation_.textOf(early.get()), "the picture is not complete");
  explanation_.update(nullptr, true, true);
  EXPECT_EQ(explanation_.textOf(nullptr), "");
  EXPECT_EQ(wakes_, 0);
}

TEST_F(ErrorExplanationTest, KeepsWhatIsKnownWhileNobodyLooks) {
  const auto frame = frameOf();
  ASSERT_TRUE(waitForPixels(frame, 4));
  const auto known = explanation_.sourcesOf(frame.get());
  explanation_.update(frame, false, true);
  EXPECT_EQ(explanation_.sourcesOf(frame.get()), known);
  EXPECT_THAT(explanation_.textOf(frame.get()), HasSubstr("of 1,024 pixels"));
}

}  // namespace
}  // namespace lightvane
