// The previewer without a window: what it does with keys, files and frames.

#include "app/previewer.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A previewer on a screen that nobody sees.
class PreviewerTest : public testing::Test {
 protected:
  PreviewerTest() {
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {1280, 800};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    previewer_ = std::make_unique<Previewer>(
        UserFolders{program_.folder() / "config", program_.folder() / "state"}, [] {});
  }
  ~PreviewerTest() override {
    previewer_ = nullptr;
    ImGui::DestroyContext();
  }

  PreviewerOutput frame(PreviewerInput input = {}) {
    time_ += 1.0 / 60.0;
    input.timeSeconds = time_;
    ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
    ImGui::NewFrame();
    PreviewerOutput output = previewer_->update(input);
    ImGui::Render();
    return output;
  }
  PreviewerOutput press(const KeyChord& chord) {
    PreviewerInput input;
    input.keys = {chord};
    return frame(input);
  }
  /// Frames until the condition holds; false after a minute.
  template <class Condition>
  bool runUntil(const Condition& holds) {
    for (int i = 0; i < 6000; ++i) {
      frame();
      if (holds()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  bool isComplete() const { return previewer_->frame() && previewer_->frame()->complete; }
  /// A small room, so that nobody waits.
  std::filesystem::path openRoom() {
    std::string scene = program_.read(shippedScene("cornell-mirror"));
    const std::size_t at = scene.find("resolution");
    scene.replace(at, scene.find('\n', at) - at, "resolution = [40, 40]");
    program_.write("room.toml", scene);
    previewer_->open(program_.path("room.toml"));
    EXPECT_TRUE(runUntil([&] { return isComplete(); }));
    return program_.path("room.toml");
  }

  Program program_;
  std::unique_ptr<Previewer> previewer_;
  double time_ = 0.0;
};

TEST_F(PreviewerTest, WithoutASceneEverythingStillDraws) {
  frame();
  for (char key = '0'; key <= '9'; ++key) press({keyOf(key)});
  press({keyOf('F')});
  press({Key::Delete});
  press({Key::Escape});
  EXPECT_FALSE(previewer_->frame());
}

TEST_F(PreviewerTest, OpensASceneAndShowsItsPicture) {
  openRoom();
  const CanvasContent content = previewer_->content();
  ASSERT_TRUE(content.picture);
  EXPECT_EQ(content.picture->view->width, 40);
  ASSERT_TRUE(content.overlay) << "the default scene shows its vectors at once";
  const OverlayBatch& batch = *content.overlay->batches.back();
  bool ilv = false, dlv = false;
  for (const OverlayMarker& marker : batch.markers) (marker.record.isIndirect() ? ilv : dlv) = true;
  EXPECT_TRUE(ilv && dlv && !batch.zones.empty() && !batch.lines.empty())
      << "ILVs, DLVs, zones and gradients at first start";
}

TEST_F(PreviewerTest, EveryViewCanBeShown) {
  openRoom();
  for (const char key : std::string("1234567890")) {
    press({keyOf(key)});
    frame();
    EXPECT_TRUE(previewer_->content().picture || key == '8') << key;
  }
}

TEST_F(PreviewerTest, ABadFileLeavesThePictureAlone) {
  openRoom();
  const auto before = previewer_->frame();
  program_.write("bad.toml", "version = 1\n[camera\n");
  PreviewerInput input;
  input.dropped = {program_.path("bad.toml")};
  frame(input);
  EXPECT_TRUE(runUntil([&] { return !previewer_->isLoading(); }));
  frame();
  EXPECT_EQ(previewer_->frame(), before);
}

TEST_F(PreviewerTest, UndoTakesCameraMovesBack) {
  openRoom();
  const CameraDescription home = previewer_->workspace().setup.camera;
  for (int i = 0; i < 5; ++i) {
    PreviewerInput input;
    input.flight = {1, 0, 0};
    frame(input);
  }
  frame();
  EXPECT_NE(previewer_->workspace().setup.camera.position, home.position);
  press({keyOf('Z'), true});
  EXPECT_EQ(previewer_->workspace().setup.camera.position, home.position) << "one flight is one step";
  press({keyOf('Z'), true, true});
  EXPECT_NE(previewer_->workspace().setup.camera.position, home.position);
}

TEST_F(PreviewerTest, TheCommandLineGivesTheSamePicture) {
  openRoom();
  PreviewerInput input;
  input.flight = {1, 0, 0};
  frame(input);
  // From nothing: what is warm depends on what was looked at before.
  const auto before = previewer_->frame();
  press({keyOf('R'), true, true});
  ASSERT_TRUE(runUntil([&] {
    return isComplete() && !previewer_->frame()->warm && previewer_->frame()->camera != before->camera;
  }));
  const PreviewerOutput copied = press({keyOf('C'), true, true});
  ASSERT_TRUE(copied.clipboard);
  EXPECT_THAT(*copied.clipboard, HasSubstr("--from="));
  // The command's words but for the program's name and the file's.
  std::string command = *copied.clipboard;
  command.replace(command.find("picture.png"), std::string("picture.png").size(), "again.exr");
  const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                            command.substr(std::string("lightvane").size()) + " --quiet";
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  const ImageRgb again = readImage(program_.path("again.exr"))->rgb();
  const RenderFrame& frame = *previewer_->frame();
  EXPECT_EQ(again, frame.film->toLayers(*frame.scene).rgb());
}

TEST_F(PreviewerTest, ClosesWhileItRenders) {
  previewer_->open(shippedScene("cornell-mirror"));
  for (int i = 0; i < 5; ++i) frame();
  PreviewerInput input;
  input.wantsClose = true;
  EXPECT_TRUE(frame(input).quits);
}

TEST_F(PreviewerTest, RemembersWhatWasOpened) {
  const std::filesystem::path room = openRoom();
  EXPECT_THAT(program_.read("state/recent-files"), HasSubstr("room.toml"));
  RecentFiles again(program_.folder() / "state" / "recent-files");
  ASSERT_EQ(again.paths().size(), 1U);
  EXPECT_EQ(again.paths().front(), room);
}

TEST_F(PreviewerTest, EscNeverQuits) {
  openRoom();
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(press({Key::Escape}).quits);
  EXPECT_TRUE(press({keyOf('Q'), true}).quits);
}

}  // namespace
}  // namespace lightvane
