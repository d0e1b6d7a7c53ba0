#include "app/progress.h"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "app/picture_metadata.h"

namespace lightvane {
namespace {

TEST(Progress, LineSaysWhatIsKnown) {
  ProgressState state;
  state.progress = {"stride 4", 0.5, 0.93};
  state.passes = 3;
  state.records = 2310;
  state.raysPerSecond = 4.2e6;
  EXPECT_EQ(
      progressLine(state, 12.0),
      "pass 4, stride 4: 50 %, 2.31 k vectors, 93 % interpolated, 4.20 M rays/s, 12.0 s, about 12.0 s left");
  EXPECT_EQ(progressLine(ProgressState{{"visible points", 0.0, 0.0}, 0, 0, 0.0, 0.0}, 1.0),
            "pass 1, visible points: 0 %, 1.0 s");
}

TEST(Progress, TimeLeftCountsOnlyWhatThisRunDid) {
  // Half of the work was done before: 10 s for a tenth of it leaves four tenths, 40 s.
  ProgressState state;
  state.progress = {"", 0.6, 0.0};
  state.fractionBefore = 0.5;
  EXPECT_EQ(progressLine(state, 10.0), "pass 1: 60 %, 10.0 s, about 40.0 s left");
}

TEST(LoadDisplay, AQuickLoadingShowsNothing) {
  LoadProgress progress;
  progress.set("reading rock.obj", 0.42);
  testing::internal::CaptureStderr();
  for (const ProgressStyle style : {ProgressStyle::Silent, ProgressStyle::Lines, ProgressStyle::Terminal}) {
    const LoadDisplay display(style, progress);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(LoadDisplay, ATerminalsLineIsWrittenOverAndRemoved) {
  using namespace std::chrono_literals;
  LoadProgress progress;
  progress.set("reading rock.obj", 0.42);
  testing::internal::CaptureStderr();
  {
    const LoadDisplay display(ProgressStyle::Terminal, progress);
    std::this_thread::sleep_for(1500ms);
    progress.set("preparing the scene", std::nullopt);
    std::this_thread::sleep_for(1500ms);
  }
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_NE(shown.find("\r\x1b[?7lreading rock.obj, 42 %\x1b[K"), std::string::npos) << shown;
  EXPECT_NE(shown.find("\r\x1b[?7lpreparing the scene\x1b[K"), std::string::npos) << shown;
  EXPECT_EQ(shown.find('\n'), std::string::npos) << "one line";
  EXPECT_TRUE(shown.ends_with("\r\x1b[K")) << "which is gone at the end";
}

TEST(PictureMetadata, WordsComeBackFromAShell) {
  EXPECT_EQ(shellQuoted("scenes/room-1.toml"), "scenes/room-1.toml");
  EXPECT_EQ(shellQuoted("dlv.r_max=1.5%"), "dlv.r_max=1.5%");
  EXPECT_EQ(shellQuoted("my room.toml"), "'my room.toml'");
  EXPECT_EQ(shellQuoted("it's"), "'it'\\''s'");
  EXPECT_EQ(shellQuoted("$(rm)"), "'$(rm)'");
  EXPECT_EQ(shellQuoted(""), "''");
}

}  // namespace
}  // namespace lightvane
