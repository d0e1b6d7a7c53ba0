// The previewer without a window: what it does with keys, files and frames.

#include "app/previewer.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include "app/panels/widgets.h"
#include "app/picking.h"
#include "app/view.h"
#include "core/image/image_file.h"
#include "core/inspect/record_names.h"
#include "core/scene/load_scene.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

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
    start();
  }
  ~PreviewerTest() override {
    previewer_ = nullptr;
    Widgets::setRecording(false);
    ImGui::DestroyContext();
  }

  /// Quits first, where it runs.
  void start() {
    previewer_ = nullptr;
    previewer_ = std::make_unique<Previewer>(
        UserFolders{program_.folder() / "config", program_.folder() / "state"}, [] {});
  }
  /// What is told over the picture, the newest first. Widgets are to be recorded.
  std::vector<std::string> toasts() {
    frame();
    std::vector<std::string> texts;
    for (const WidgetPlace& place : Widgets::all()) {
      if (place.name.starts_with("toast.")) texts.push_back(place.text);
    }
    return texts;
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
  bool runUntil(const Condition& holds, int frames = 6000) {
    for (int i = 0; i < frames; ++i) {
      frame();
      if (holds()) return true;
      std::this_thread::sleep_for(10ms);
    }
    return false;
  }
  bool isComplete() const { return previewer_->frame() && previewer_->frame()->complete; }
  /// What is shown of the newest frame; null where nothing is.
  std::shared_ptr<const ViewImage> shownView() const {
    const CanvasContent content = previewer_->content();
    return content.picture ? content.picture->view : nullptr;
  }
  /// Draws a rectangle over the whole picture.
  void selectAll() {
    ImGuiIO& io = ImGui::GetIO();
    io.KeyCtrl = io.KeyShift = true;
    const auto to = [&](const ImVec2& position, bool down) {
      io.MousePos = position;
      io.MouseDown[0] = down;
      frame();
    };
    to({300, 40}, false);
    to({300, 40}, true);
    to({600, 400}, true);
    to({940, 770}, true);
    to({940, 770}, false);
    io.KeyCtrl = io.KeyShift = false;
    frame();
  }
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

  /// The same room from one place by a pinhole, a lens and parallel lines.
  void openCameras() {
    openRoom();
    std::string scene = program_.read("room.toml");
    const std::string one = "[camera]\n";
    scene.replace(scene.find(one), one.size(), "[[cameras]]\nname = \"pinhole\"\n");
    const std::string place =
        "position = [0.278, 0.273, -0.8]\ntarget = [0.278, 0.273, 0.0]\nresolution = [40, 40]\n";
    scene += "\n[[cameras]]\nname = \"lens\"\nlens_radius = 0.03\n" + place +
             "[[cameras]]\nname = \"flat\"\nprojection = \"orthographic\"\nheight = 0.6\n" + place;
    program_.write("cameras.toml", scene);
    previewer_->open(program_.path("cameras.toml"));
    EXPECT_TRUE(
        runUntil([&] { return previewer_->frame() && previewer_->frame()->scene->cameras.size() == 3; }));
  }
  /// Frames until the whole picture of a camera is there for which the condition holds.
  template <class Condition>
  bool runUntilCamera(const Condition& holds) {
    return runUntil([&] { return isComplete() && holds(previewer_->frame()->camera); });
  }
  /// Flies, begins from nothing, and returns the command line of the picture, having made sure that it gives
  /// that very picture.
  std::string commandOfAFlight(const Vec3& flight) {
    PreviewerInput input;
    input.flight = flight;
    frame(input);
    // What is warm depends on what was looked at before.
    const auto before = previewer_->frame();
    press({keyOf('R'), true, true});
    EXPECT_TRUE(runUntil([&] {
      return isComplete() && !previewer_->frame()->warm && previewer_->frame()->camera != before->camera;
    }));
    const PreviewerOutput copied = press({keyOf('C'), true, true});
    EXPECT_TRUE(copied.clipboard);
    std::string command = copied.clipboard.value_or(" picture.png");
    // The command's words but for the program's name and the file's.
    command.replace(command.find("picture.png"), std::string("picture.png").size(), "again.exr");
    const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                              command.substr(command.find(' ')) + " --quiet";
    EXPECT_EQ(std::system(shell.c_str()), 0) << shell;
    const auto again = readImage(program_.path("again.exr"));
    const RenderFrame& frame = *previewer_->frame();
    EXPECT_TRUE(again && again->rgb() == frame.film->toLayers(*frame.scene).rgb()) << command;
    return command;
  }

  Program program_;
  std::unique_ptr<Previewer> previewer_;
  double time_ = 0.0;
};

/// What a command asks for: all of it but the program, which is not that of the tests.
std::string wordsOf(const std::string& command) { return command.substr(command.find(' ')); }

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
  EXPECT_THAT(commandOfAFlight({1, 0, 0}), HasSubstr("--from="));
}

TEST_F(PreviewerTest, TheCommandLineHasLensesAndOrthographicCameras) {
  openCameras();
  press({keyOf('C')});
  ASSERT_TRUE(runUntilCamera([](const Camera& camera) { return camera.hasLens(); }));
  EXPECT_THAT(commandOfAFlight({0, 0, 1}),
              testing::AllOf(HasSubstr("--lens-radius="), HasSubstr("--focus-distance=0.8")));
  press({Key::Home});
  press({keyOf('C'), false, true});  // before the first is the last
  ASSERT_TRUE(runUntilCamera([](const Camera& camera) { return camera.isOrthographic(); }));
  EXPECT_THAT(commandOfAFlight({1, 0, 1}), HasSubstr("--orthographic="));
}

TEST_F(PreviewerTest, AnOrthographicCameraIsMovedLikeAny) {
  openCameras();
  press({keyOf('C')});
  press({keyOf('C')});  // of the same place as the first
  ASSERT_TRUE(runUntilCamera([](const Camera& camera) { return camera.isOrthographic(); }));
  // A drag that orbits keeps the point that was pressed under the mouse.
  const Camera before = previewer_->frame()->camera;
  const Vec3 pressed = surfaceAt(*previewer_->frame(), {20, 20}).value();
  const Vec2 at = previewer_->content().picture->placement.toFramebuffer({20.5f, 20.5f});
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {at.x, at.y};
  frame();
  io.MouseDown[0] = true;
  frame();
  io.MousePos.x += 60.0f;
  frame();
  io.MouseDown[0] = false;
  frame();
  ASSERT_TRUE(runUntilCamera([&](const Camera& camera) { return camera != before; }));
  const Camera after = previewer_->frame()->camera;
  EXPECT_EQ(after.halfHeight, before.halfHeight);
  EXPECT_NE(after.forward, before.forward);
  EXPECT_NEAR(glm::length(after.project(pressed).value() - before.project(pressed).value()), 0.0f, 0.01f);
  selectAll();
  press({keyOf('F')});
  ASSERT_TRUE(runUntilCamera([&](const Camera& camera) { return camera.halfHeight != before.halfHeight; }));
  press({Key::Home});
  EXPECT_TRUE(runUntilCamera([](const Camera& camera) { return !camera.isOrthographic(); }));
}

TEST_F(PreviewerTest, TheExportDialogTellsOfTheVectorsThatItsCommandReads) {
  openRoom();
  Widgets::setRecording(true);
  const auto textOf = [](const char* name) {
    const auto place = Widgets::find(name);
    return place ? place->text : std::string();
  };
  press({keyOf('E'), true});
  frame();
  EXPECT_THAT(textOf("export.command"), HasSubstr("render"));
  EXPECT_THAT(textOf("export.command"), Not(HasSubstr("--cache"))) << "made from nothing";
  EXPECT_EQ(textOf("export.cache"), "");
  press({Key::Escape});
  for (int i = 0; i < 5; ++i) frame();  // until the text field lets the keyboard go
  PreviewerInput fly;
  fly.flight = {1, 0, 0};
  frame(fly);
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->warm; }));
  press({keyOf('E'), true});
  frame();
  EXPECT_THAT(textOf("export.command"), HasSubstr("room.png.lvcache"));
  EXPECT_THAT(textOf("export.cache"), HasSubstr("room.png.lvcache"));
  EXPECT_THAT(textOf("export.cache"), HasSubstr("Export writes them"));
}

TEST_F(PreviewerTest, TheCommandNamesAllFilesFromTheRoot) {
  openRoom();
  const PreviewerOutput copied = press({keyOf('C'), true, true});
  ASSERT_TRUE(copied.clipboard);
  std::istringstream words(*copied.clipboard);
  std::string program, command, scene;
  words >> program >> command >> scene;
  EXPECT_EQ(program, std::filesystem::read_symlink("/proc/self/exe"));
  EXPECT_EQ(command, "render");
  EXPECT_TRUE(std::filesystem::path(scene).is_absolute()) << scene;
  EXPECT_TRUE(std::filesystem::exists(scene)) << scene;
}

TEST_F(PreviewerTest, TheCommandLineGivesWhatIsShown) {
  openRoom();
  for (const char view : {'3', '5', '7'}) {
    press({keyOf(view)});
    press({keyOf(']')});  // brighter
    frame();
    const PreviewerOutput copied = press({keyOf('C'), true, true});
    ASSERT_TRUE(copied.clipboard);
    const std::string shell = "cd '" + program_.folder().string() + "' && '" LIGHTVANE_PROGRAM "'" +
                              wordsOf(*copied.clipboard) + " --quiet";
    ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
    const CanvasContent content = previewer_->content();
    ASSERT_TRUE(content.picture);
    EXPECT_EQ(readImage(program_.path("picture.png"))->rgb(),
              filePicture(displayColors(*content.picture->view, content.picture->style)).rgb())
        << *copied.clipboard;
  }
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
  previewer_.reset();  // which waits for the file
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

TEST_F(PreviewerTest, AKeyThatCannotActSaysWhy) {
  openRoom();
  Widgets::setRecording(true);
  ASSERT_THAT(toasts(), IsEmpty());
  const std::pair<KeyChord, const char*> keys[] = {
      {{keyOf('H')}, "Compute it here: No pixel is selected."},
      {{keyOf('F')}, "Frame selection: Nothing is selected."},
      {{keyOf('N')}, "Pin selected: No vector is selected."},
      {{keyOf('N'), false, true}, "Recompute selected: No vector is selected."},
      {{Key::Delete}, "Delete selected: No vector is selected."}};
  for (const auto& [chord, reason] : keys) {
    // Only held, as after what it could do until now: nobody asks.
    PreviewerInput held;
    held.keys = {chord};
    held.held = {chord};
    frame(held);
    EXPECT_THAT(toasts(), Not(Contains(reason)));
    press(chord);
    press(chord);
    const std::vector<std::string> told = toasts();
    EXPECT_EQ(std::count(told.begin(), told.end(), reason), 1) << reason;
  }
}

TEST_F(PreviewerTest, WhatIsTypedIsNoKeyThatCannotAct) {
  openRoom();
  Widgets::setRecording(true);
  press({keyOf('E'), true});
  for (int i = 0; i < 5; ++i) frame();
  ASSERT_TRUE(ImGui::GetIO().WantTextInput);
  press({keyOf('H')});
  EXPECT_THAT(toasts(), IsEmpty());
}

TEST_F(PreviewerTest, AFileOfAnotherKindGetsAllThatCanBeOpened) {
  Widgets::setRecording(true);
  program_.write("never.png", "");
  previewer_->open(program_.path("never.png"));
  frame();
  EXPECT_THAT(
      toasts(),
      Contains(HasSubstr("never.png: expected a .toml, .obj, .ply, .gltf, .glb, .lvsession, .lvcache, .exr, "
                         ".hdr or .pfm file, found .png")));
}

// ---- the window's settings

TEST_F(PreviewerTest, TheWindowsSettingsComeBackAtTheNextStart) {
  frame();
  EXPECT_FALSE(program_.exists("config/settings.toml")) << "nothing was changed yet";
  press({keyOf('T'), true});
  press({Key::Equal, true});
  const float scale = previewer_->workspace().display.uiScale;
  ASSERT_GT(scale, 1.0f);
  start();
  EXPECT_THAT(program_.read("config/settings.toml"), HasSubstr("theme = \"bright\""));
  EXPECT_EQ(previewer_->workspace().display.theme, Theme::Bright);
  EXPECT_EQ(previewer_->workspace().display.uiScale, scale);
  openRoom();
  EXPECT_EQ(previewer_->workspace().display.theme, Theme::Bright) << "a scene changes nothing of it";
}

TEST_F(PreviewerTest, ASessionsOwnSettingsHoldForIt) {
  openRoom();
  const Document document = loadDocument(program_.path("room.toml")).value();
  ASSERT_TRUE(saveSession(sessionOf(previewer_->workspace(), document), program_.path("room.lvsession")));
  press({keyOf('T'), true});  // bright, from now on
  previewer_->open(program_.path("room.lvsession"));
  ASSERT_TRUE(runUntil([&] { return previewer_->workspace().display.theme == Theme::Dark; }));
  for (int i = 0; i < 3; ++i) frame();
  press({Key::Equal, true});
  start();
  EXPECT_EQ(previewer_->workspace().display.theme, Theme::Bright) << "nobody changed it";
  EXPECT_GT(previewer_->workspace().display.uiScale, 1.0f) << "that was changed, if in a session";
}

TEST_F(PreviewerTest, ASettingsFileThatCannotBeReadIsToldOfAndStays) {
  const std::string damaged = "version = 1\n[window\n";
  std::filesystem::create_directories(program_.path("config"));
  program_.write("config/settings.toml", damaged);
  start();
  Widgets::setRecording(true);
  frame();
  EXPECT_THAT(toasts(), ElementsAre(HasSubstr("settings.toml:")));
  press({keyOf('T'), true});
  start();
  EXPECT_EQ(program_.read("config/settings.toml"), damaged);
}

// ---- what pictures are held against

TEST_F(PreviewerTest, TracesAReferenceForTheErrorView) {
  openRoom();
  press({keyOf('8')});
  frame();
  EXPECT_FALSE(previewer_->content().picture) << "there is nothing to compare with yet";
  press({keyOf('T')});
  ASSERT_TRUE(runUntil([&] { return shownView() != nullptr; }));
  EXPECT_THAT(shownView()->title, HasSubstr("the reference"));
  EXPECT_EQ(shownView()->width, 40);
  press({keyOf('T')});
  PreviewerInput input;
  input.flight = {1, 0, 0};
  frame(input);
  frame();
  EXPECT_FALSE(previewer_->content().picture) << "the reference is of another view now";
}

TEST_F(PreviewerTest, APictureFromAFileIsAReference) {
  openRoom();
  const RenderFrame& frame = *previewer_->frame();
  ASSERT_TRUE(writeImage(program_.path("same.exr"), frame.film->toLayers(*frame.scene)));
  previewer_->open(program_.path("same.exr"));
  press({keyOf('8')});
  ASSERT_TRUE(runUntil([&] { return shownView() != nullptr; }));
  for (const float error : shownView()->values) ASSERT_NEAR(error, 0.0f, 1e-2f);
}

TEST_F(PreviewerTest, ABadReferenceIsNotShown) {
  openRoom();
  program_.write("broken.exr", "no picture");
  previewer_->open(program_.path("broken.exr"));
  press({keyOf('8')});
  for (int i = 0; i < 20; ++i) frame();
  EXPECT_FALSE(previewer_->content().picture);
}

TEST_F(PreviewerTest, AKeptPictureIsShownBesideOrInPlaceOfTheNewOne) {
  openRoom();
  const auto first = shownView();
  press({keyOf('B')});
  press({keyOf('M')});
  frame();
  CanvasContent content = previewer_->content();
  ASSERT_TRUE(content.second && content.wipe);
  EXPECT_EQ(content.second->view->values, first->values);
  press({keyOf('X')});
  frame();
  content = previewer_->content();
  EXPECT_FALSE(content.second);
  EXPECT_FALSE(content.overlay) << "the overlay is of the other picture";
}

TEST_F(PreviewerTest, TheValueUnderTheMouseIsOfThePictureThatIsThere) {
  openRoom();
  ImGui::GetIO().MousePos = {500, 600};
  const auto valueThere = [&] {
    frame();
    frame();
    EXPECT_TRUE(previewer_->cursor());
    return previewer_->cursor() ? previewer_->cursor()->lines.front() : std::string();
  };
  const std::string before = valueThere();
  press({keyOf('B')});
  press({keyOf('K'), false, true});  // full computation only
  ASSERT_TRUE(runUntil([&] { return isComplete() && valueThere() != before; }));
  const std::string now = valueThere();
  press({keyOf('X')});
  EXPECT_EQ(valueThere(), before) << "B in its place";
  press({keyOf('X')});
  EXPECT_EQ(valueThere(), now);
  // Under a wipe that stands left of the mouse, B is there.
  press({keyOf('M')});
  ImGui::GetIO().MousePos = {900, 400};
  const std::string right = valueThere();
  press({keyOf('M')});
  EXPECT_NE(valueThere(), right);
}

// Exposure, views and overlays: shown by the frame after the key's, and nothing is asked of the session.
TEST_F(PreviewerTest, ADisplayChangeIsInTheNextFrame) {
  openRoom();
  const auto request = previewer_->frame()->request;
  const float before = previewer_->content().picture->style.exposureStops;
  press({keyOf(']')});
  EXPECT_GT(previewer_->content().picture->style.exposureStops, before);
  press({keyOf('3')});
  frame();
  EXPECT_EQ(shownView()->view, PictureView::Indirect);
  press({keyOf('V')});
  frame();
  EXPECT_FALSE(previewer_->content().overlay);
  for (int i = 0; i < 20; ++i) frame();
  EXPECT_EQ(previewer_->frame()->request, request);
}

TEST_F(PreviewerTest, AFullComputationOutlivesTheFramesThatComeMeanwhile) {
  openRoom();
  PreviewerInput fly;
  fly.flight = {1, 0, 0};
  ImGui::GetIO().MousePos = {620, 400};
  frame();
  ImGui::GetIO().MouseDown[0] = true;
  frame();
  ImGui::GetIO().MouseDown[0] = false;
  frame();
  ASSERT_TRUE(previewer_->workspace().selection.pixel);
  press({keyOf('H')});
  frame(fly);  // a new picture, whose frames come one after the other
  ASSERT_TRUE(runUntil([&] { return previewer_->fullComputation() != nullptr; }));
  EXPECT_TRUE(isComplete());
  EXPECT_TRUE(previewer_->fullComputation()->finished || !previewer_->fullComputation()->note.empty());
}

TEST_F(PreviewerTest, AFullComputationStaysWhereACompletePictureIsPaused) {
  openRoom();
  for (const bool down : {false, true, false}) {
    ImGui::GetIO().MousePos = {620, 400};
    ImGui::GetIO().MouseDown[0] = down;
    frame();
  }
  ASSERT_TRUE(previewer_->workspace().selection.pixel);
  press({keyOf('H')});
  ASSERT_TRUE(runUntil([&] { return previewer_->fullComputation() != nullptr; }));
  for (const char* step : {"paused", "gone on with"}) {
    const auto before = previewer_->frame();
    press({Key::Space});
    ASSERT_TRUE(runUntil([&] { return previewer_->frame() != before; }))
        << "the session answers with a frame";
    EXPECT_NE(previewer_->fullComputation(), nullptr) << step;
  }
  PreviewerInput fly;
  fly.flight = {1, 0, 0};
  frame(fly);
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->fullComputation() == nullptr; }))
      << "from elsewhere it is no longer true";
}

TEST_F(PreviewerTest, PausingACompletePictureChangesNoRate) {
  openRoom();
  for (int i = 0; i < 10; ++i) frame();
  const double before = previewer_->status().raysPerSecond;
  ASSERT_GT(before, 0.0);
  for (int i = 0; i < 2; ++i) {
    press({Key::Space});
    for (int n = 0; n < 20; ++n) {
      frame();
      std::this_thread::sleep_for(5ms);
    }
  }
  EXPECT_DOUBLE_EQ(previewer_->status().raysPerSecond, before);
}

// ---- files

TEST_F(PreviewerTest, GoesOnFromVectorsInAFile) {
  openRoom();
  const auto before = previewer_->frame();
  const SceneDescription description = loadScene(program_.path("room.toml")).value();
  ASSERT_TRUE(writeCache(program_.path("room.lvcache"), *before->snapshot,
                         vectorsIdentity(description, {}, before->parameters)));
  press({keyOf('R'), true, true});
  previewer_->open(program_.path("room.lvcache"));
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->warm; }));
  EXPECT_EQ(previewer_->frame()->warm->indirect.size(), before->snapshot->indirect.size());
}

TEST_F(PreviewerTest, VectorsOfAnotherSceneChangeNothing) {
  openRoom();
  const auto before = previewer_->frame();
  const SceneDescription other = loadScene(shippedScene("cornell")).value();
  ASSERT_TRUE(writeCache(program_.path("other.lvcache"), *before->snapshot,
                         vectorsIdentity(other, {}, before->parameters)));
  previewer_->open(program_.path("other.lvcache"));
  for (int i = 0; i < 20; ++i) {
    frame();
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_EQ(previewer_->frame(), before);
}

TEST_F(PreviewerTest, ASessionComesBackAndIsSavedAgain) {
  openRoom();
  PreviewerInput input;
  input.flight = {0, 0, 1};
  frame(input);
  press({keyOf('9')});
  const Document document = loadDocument(program_.path("room.toml")).value();
  const std::filesystem::path path = program_.path("room.lvsession");
  ASSERT_TRUE(saveSession(sessionOf(previewer_->workspace(), document), path));
  const CameraDescription camera = previewer_->workspace().setup.camera;
  press({keyOf('1')});
  press({Key::Home});
  ASSERT_NE(previewer_->workspace().setup.camera, camera);
  previewer_->open(path);
  ASSERT_TRUE(runUntil([&] { return previewer_->workspace().setup.camera == camera; }));
  EXPECT_EQ(previewer_->workspace().display.view, PictureView::Albedo);

  press({keyOf('3')});
  press({keyOf('S'), true});
  EXPECT_TRUE(runUntil([&] { return loadSession(path)->display.view == PictureView::Indirect; }))
      << "to where it was opened, without a question";
}

TEST_F(PreviewerTest, AChangedSceneIsReadAgainWhereThatIsAskedFor) {
  openRoom();
  const Document document = loadDocument(program_.path("room.toml")).value();
  Workspace workspace = previewer_->workspace();
  workspace.display.reloads = true;
  ASSERT_TRUE(saveSession(sessionOf(workspace, document), program_.path("room.lvsession")));
  previewer_->open(program_.path("room.lvsession"));
  ASSERT_TRUE(runUntil([&] { return previewer_->workspace().display.reloads && isComplete(); }));
  const auto scene = previewer_->frame()->scene;
  std::string text = program_.read("room.toml");
  text.replace(text.find("[40, 40]"), 8, "[41, 41]");
  program_.write("room.toml", text);
  EXPECT_TRUE(runUntil([&] { return previewer_->frame() && previewer_->frame()->scene != scene; }));
}

TEST_F(PreviewerTest, AFileThatIsReadAgainKeepsTheViewAndOneThatIsOpenedAgainDoesNot) {
  openRoom();
  const CameraDescription home = previewer_->workspace().setup.camera;
  press({keyOf(']')});
  const float brighter = previewer_->workspace().setup.brightness.exposureStops;
  EXPECT_GT(brighter, 0.0f);
  const auto readAgain = [&](const std::function<void()>& act) {
    const auto scene = previewer_->frame()->scene;
    act();
    ASSERT_TRUE(runUntil([&] { return previewer_->frame() && previewer_->frame()->scene != scene; }));
  };
  readAgain([&] { press({keyOf('R'), true}); });
  EXPECT_EQ(previewer_->workspace().setup.brightness.exposureStops, brighter);
  readAgain([&] { previewer_->open(program_.path("room.toml")); });
  EXPECT_EQ(previewer_->workspace().setup.brightness.exposureStops, 0.0f);
  EXPECT_EQ(previewer_->workspace().setup.camera, home);
  // A file that cannot be opened changes nothing, and the next reading is one again.
  press({keyOf(']')});
  previewer_->open(program_.path("none.toml"));
  ASSERT_TRUE(runUntil([&] { return !previewer_->isLoading(); }));
  readAgain([&] { press({keyOf('R'), true}); });
  EXPECT_EQ(previewer_->workspace().setup.brightness.exposureStops, brighter);
}

TEST_F(PreviewerTest, ACameraThatIsTooFarFromAChangedSceneGivesWayToItsOwn) {
  openRoom();
  const CameraDescription home = previewer_->workspace().setup.camera;
  PreviewerInput input;
  input.flight = {1, 0, 0};
  frame(input);
  frame();
  ASSERT_NE(previewer_->workspace().setup.camera.position, home.position);
  program_.write("room.toml",
                 "version = 1\n[camera]\nposition = [0.0, 0.0, 4e-12]\ntarget = [0.0, 0.0, 0.0]\n"
                 "resolution = [40, 40]\n[material.m]\nemission = [1.0, 1.0, 1.0]\n"
                 "[[shape]]\ntype = \"sphere\"\nmaterial = \"m\"\nradius = 1e-12\n");
  const auto scene = previewer_->frame()->scene;
  press({keyOf('R'), true});
  ASSERT_TRUE(runUntil([&] { return previewer_->frame() && previewer_->frame()->scene != scene; }));
  EXPECT_EQ(previewer_->workspace().setup.camera.position, Vec3d(0.0, 0.0, 4e-12));
  for (int i = 0; i < 3; ++i) {
    press({keyOf('Z'), true});
    frame();
  }
  // As far as it can be, and no farther.
  for (int i = 0; i < 40; ++i) {
    PreviewerInput flight;
    flight.flight = {0, 0, -1e12f};
    frame(flight);
  }
  EXPECT_TRUE(runUntil([&] { return isComplete(); }));
}

TEST_F(PreviewerTest, SideBySideShowsBothPicturesWhole) {
  openRoom();
  press({keyOf('B')});
  press({keyOf('M'), true});
  frame();
  const CanvasContent content = previewer_->content();
  ASSERT_TRUE(content.picture && content.second);
  const Placement& left = content.picture->placement;
  const Placement& right = content.second->placement;
  EXPECT_EQ(right.left, left.left + left.width);
  EXPECT_EQ(right.zoom, left.zoom);
  for (const Placement& placement : {left, right}) {
    const Vec2 first = placement.toFramebuffer(Vec2(0.0f)), last = placement.toFramebuffer(Vec2(40.0f));
    EXPECT_GE(first.x, static_cast<float>(placement.left));
    EXPECT_LE(last.x, static_cast<float>(placement.left + placement.width));
    EXPECT_GE(first.y, static_cast<float>(placement.top));
    EXPECT_LE(last.y, static_cast<float>(placement.top + placement.height));
  }
  // The same pixel is asked about on both.
  ImGuiIO& io = ImGui::GetIO();
  press({keyOf('V')});
  for (const Placement& placement : {left, right}) {
    const Vec2 at = placement.toFramebuffer(Vec2(20.5f, 30.5f));
    for (const bool down : {false, true, false}) {
      io.MousePos = {at.x, at.y};
      io.MouseDown[0] = down;
      frame();
    }
    EXPECT_EQ(previewer_->workspace().selection.pixel, (PixelRef{20, 30}));
  }
}

// ---- vectors

TEST_F(PreviewerTest, PinnedVectorsStayWhenAllOthersGo) {
  openRoom();
  selectAll();
  const std::size_t selected = previewer_->workspace().selection.records.size();
  ASSERT_GT(selected, 10u);
  press({keyOf('N')});
  press({keyOf('R'), true, true});
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->warm; }))
      << "it begins with those that are pinned";
  EXPECT_EQ(previewer_->frame()->warm->indirect.size() + previewer_->frame()->warm->directCount(), selected);
}

TEST_F(PreviewerTest, PinnedVectorsAreTheNewestOfTheirPlaces) {
  openRoom();
  selectAll();
  press({keyOf('N')});
  const auto before = previewer_->frame()->snapshot;
  press({keyOf('N'), false, true});
  ASSERT_TRUE(runUntil([&] {
    return isComplete() && previewer_->frame()->snapshot->indirect[0].energy != before->indirect[0].energy;
  })) << "computed anew";
  const auto anew = previewer_->frame()->snapshot;
  press({keyOf('R'), true, true});
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->snapshot != anew; }));
  EXPECT_EQ(previewer_->frame()->warm->indirect[0].energy, anew->indirect[0].energy);
}

TEST_F(PreviewerTest, UndoTakesBackWhatWasDoneToVectors) {
  openRoom();
  selectAll();
  const auto before = previewer_->frame();
  const std::vector<RecordRef> selected = previewer_->workspace().selection.records;
  ASSERT_GT(selected.size(), 10u);
  const auto copies = pin(nullptr, *before, selected);
  const auto areThere = [&] {
    return isComplete() && pinnedRecords(copies.get(), *previewer_->frame()).size() == selected.size();
  };
  press({keyOf('K')});  // no point that misses one computes it again
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->locked; }));
  press({Key::Delete});
  ASSERT_TRUE(runUntil([&] { return isComplete() && !areThere(); }));
  press({keyOf('Z'), true});
  EXPECT_TRUE(runUntil(areThere)) << "undone";
  press({keyOf('Z'), true, true});
  EXPECT_TRUE(runUntil([&] { return isComplete() && !areThere(); })) << "and done again";
  press({keyOf('Z'), true});
  ASSERT_TRUE(runUntil(areThere));

  press({keyOf('K')});
  selectAll();
  press({keyOf('N'), false, true});
  const auto energy = before->snapshot->indirect[0].energy;
  const auto isAsBefore = [&] {
    const Snapshot& now = *previewer_->frame()->snapshot;
    const RandomKey identity = before->snapshot->indirect[0].birth.identity;
    for (std::size_t i = 0; i < now.indirect.size(); ++i) {
      if (now.indirect[i].birth.identity == identity) return now.indirect[i].energy == energy;
    }
    return false;
  };
  ASSERT_TRUE(runUntil([&] { return isComplete() && !isAsBefore(); })) << "computed anew";
  press({keyOf('Z'), true});
  EXPECT_TRUE(runUntil([&] { return isComplete() && isAsBefore(); })) << "as it was";
}

// Points whose vectors were deleted have computed their own since: undo takes those away, too.
TEST_F(PreviewerTest, UndoLeavesNoVectorOfWhatWasUndone) {
  openRoom();
  const auto picture = previewer_->frame();
  const auto isAsBefore = [&] {
    const RenderFrame& now = *previewer_->frame();
    return isComplete() && now.snapshot->indirect.size() == picture->snapshot->indirect.size() &&
           now.snapshot->directCount() == picture->snapshot->directCount() &&
           std::equal(now.film->indirect.begin(), now.film->indirect.end(), picture->film->indirect.begin());
  };
  ASSERT_TRUE(isAsBefore());
  selectAll();
  press({Key::Delete});
  ASSERT_TRUE(runUntil([&] { return isComplete() && !isAsBefore(); }));
  press({keyOf('Z'), true});
  EXPECT_TRUE(runUntil(isAsBefore)) << "deleted";

  selectAll();
  press({keyOf('N'), false, true});
  ASSERT_TRUE(runUntil([&] { return isComplete() && !isAsBefore(); }));
  press({keyOf('Z'), true});
  EXPECT_TRUE(runUntil(isAsBefore)) << "computed anew";
}

TEST_F(PreviewerTest, ASessionWhoseSceneIsGoneSaysSo) {
  program_.write("lost.lvsession", "version = 1\nscene = \"gone.toml\"\n");
  previewer_->open(program_.path("lost.lvsession"));
  Widgets::setRecording(true);
  ASSERT_TRUE(runUntil([&] { return !toasts().empty(); }));
  EXPECT_THAT(toasts(),
              ElementsAre(testing::AllOf(HasSubstr("gone.toml: no such file"), HasSubstr("lost.lvsession"))));
  previewer_.reset();
  EXPECT_FALSE(program_.exists("state/recent-files")) << "what did not open is none that was";
}

// Whoever presses a key looks at what it does; the tooltip of where the mouse was left would lie over it.
TEST_F(PreviewerTest, AKeyPutsTheTooltipAwayUntilTheMouseMoves) {
  openRoom();
  Widgets::setRecording(true);
  for (int i = 0; i < 3; ++i) frame();
  const auto slider = Widgets::find("ilv.n_min");
  ASSERT_TRUE(slider);
  ImGui::GetIO().MousePos = slider->centre();
  const auto isThere = [&] {
    for (int i = 0; i < 40; ++i) frame();
    return Widgets::find("tooltip").has_value();
  };
  EXPECT_TRUE(isThere());
  press({functionKey(1)});
  EXPECT_FALSE(isThere());
  press({Key::Escape});
  EXPECT_FALSE(isThere());
  ImGui::GetIO().MousePos.x += 1.0f;
  EXPECT_TRUE(isThere());
}

TEST_F(PreviewerTest, UndoTakesBackARefreshOfIndirectLight) {
  openRoom();
  Widgets::setRecording(true);
  press({functionKey(7)});
  const auto click = [&](const char* name) {
    frame();
    const auto place = Widgets::find(name);
    ASSERT_TRUE(place) << name;
    ImGui::GetIO().MousePos = place->centre();
    for (const bool down : {false, true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      frame();
    }
  };
  const auto isStale = [&] {
    frame();
    return Widgets::find("lights.refresh").has_value();
  };
  click("light.0.mute");
  ASSERT_TRUE(isStale());
  click("lights.refresh");
  EXPECT_FALSE(isStale());
  press({keyOf('Z'), true});
  EXPECT_TRUE(isStale()) << "the light is muted, and indirect light is of before";
  press({keyOf('Z'), true});
  EXPECT_FALSE(isStale()) << "nothing was changed";
  Widgets::setRecording(false);
}

TEST_F(PreviewerTest, MeasuresATradeAndTakesAPointsParameters) {
  openRoom();
  ImGui::GetIO().DisplaySize = {1280, 1600};  // all of the panel is in sight
  Widgets::setRecording(true);
  const auto click = [&](const char* name) {
    frame();
    const auto place = Widgets::find(name);
    ASSERT_TRUE(place) << name;
    ImGui::GetIO().MousePos = place->centre();
    for (const bool down : {false, false, true, false}) {
      ImGui::GetIO().MouseDown[0] = down;
      frame();
    }
  };
  press({functionKey(10)});
  click("trade.start");
  // Its thread gives way to all others of the machine: where those are busy, a second of work takes a minute.
  constexpr int kPoliteFrames = 30'000;
  ASSERT_TRUE(runUntil(
      [&] {
        const auto stage = Widgets::find("trade.stage");
        return stage && stage->text == "36 of 36 runs measured.";
      },
      kPoliteFrames));
  const Parameters before = previewer_->workspace().setup.parameters;
  const auto shown = shownView();
  click("trade.point.0");
  frame();
  EXPECT_EQ(previewer_->workspace().display.comparison.with, CompareWith::Point);
  ASSERT_TRUE(shownView());
  EXPECT_NE(shownView(), shown);
  EXPECT_EQ(shownView()->width, 10) << "a quarter of the picture's";

  click("trade.take");
  const Parameters taken = previewer_->workspace().setup.parameters;
  EXPECT_EQ(taken.vectors.ilv.radiusScale, 0.2);
  EXPECT_EQ(taken.vectors.ilv.rows, 6);
  EXPECT_TRUE(runUntil([&] { return isComplete() && previewer_->frame()->parameters == taken; }));
  EXPECT_EQ(shownView()->width, 40) << "the window's own picture";
  EXPECT_FALSE(Widgets::find("trade.stale")) << "what is varied may be anything";
  press({keyOf('Z'), true});
  frame();
  EXPECT_EQ(previewer_->workspace().setup.parameters, before) << "one step takes them back";

  PreviewerInput flight;
  flight.flight = {1.0f, 0.0f, 0.0f};
  frame(flight);
  frame();
  frame();
  const auto stale = Widgets::find("trade.stale");
  ASSERT_TRUE(stale);
  EXPECT_EQ(stale->text, "These points are of another camera.");
  click("trade.clear");
  frame();
  EXPECT_FALSE(Widgets::find("trade.plot"));
  Widgets::setRecording(false);
}

TEST_F(PreviewerTest, PointingAtAVectorMeansItWhereAPixelIsAskedAbout) {
  openRoom();
  ImGuiIO& io = ImGui::GetIO();
  const auto hoverAll = [&] {
    std::size_t hovered = 0;
    for (float x = 320.0f; x < 900.0f; x += 20.0f) {
      io.MousePos = {x, 400.0f};
      frame();
      hovered += !previewer_->workspace().selection.hoveredRecord.isNone();
    }
    return hovered;
  };
  EXPECT_EQ(hoverAll(), 0u);
  press({keyOf('V')});  // no vector takes the click
  for (const bool down : {false, true, false}) {
    io.MousePos = {600, 420};
    io.MouseDown[0] = down;
    frame();
  }
  ASSERT_TRUE(previewer_->workspace().selection.pixel);
  press({keyOf('V')});
  EXPECT_GT(hoverAll(), 0u);
}

TEST_F(PreviewerTest, SelectedVectorsAreComputedAnew) {
  openRoom();
  selectAll();
  const auto before = previewer_->frame();
  const RecordRef record = previewer_->workspace().selection.records.front();
  press({keyOf('N'), false, true});
  ASSERT_TRUE(runUntil([&] { return isComplete() && previewer_->frame() != before; }));
  const IndirectLightVector* old = findIndirect(*before, record);
  const IndirectLightVector* anew = findIndirect(*previewer_->frame(), record);
  ASSERT_TRUE(old != nullptr && anew != nullptr);
  EXPECT_EQ(anew->point.position, old->point.position);
  EXPECT_NE(anew->irradiance, old->irradiance) << "with other random numbers";
}

// ---- whatever anybody does

/// What people do, at random.
class Monkey {
 public:
  explicit Monkey(std::uint32_t seed) : random_(seed) {}

  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  bool oneIn(int count) { return below(count) == 0; }

  /// Any key but those that quit or write over files that are asked for by name.
  KeyChord chord() {
    for (;;) {
      const ActionInfo& info = actionTable()[static_cast<std::size_t>(below(kActionCount))];
      if (info.id == ActionId::Quit || info.keys[0] == '\0') continue;
      const std::string keys = info.keys;
      return parseChord(keys.substr(0, keys.find(' '))).value();
    }
  }

 private:
  std::mt19937 random_;
};

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
constexpr bool kIsFast = false;
#else
constexpr bool kIsFast = true;
#endif

/// LIGHTVANE_RANDOM_SECONDS, which .ci/run sets to a minute: it takes that long to meet what is rare.
std::chrono::seconds monkeyTime() {
  const char* seconds = std::getenv("LIGHTVANE_RANDOM_SECONDS");
  return std::chrono::seconds(seconds != nullptr ? std::max(std::atoi(seconds), 1) : 6);
}

/// How long this thread was ready to run and others had the processor, since it began: what a busy machine
/// adds to every time by the clock. Zero where Linux does not count it.
std::chrono::nanoseconds waitedForProcessor() {
  std::ifstream counts("/proc/thread-self/schedstat");
  long long ran = 0, waited = 0;
  counts >> ran >> waited;
  return std::chrono::nanoseconds(waited);
}

TEST_F(PreviewerTest, LivesThroughWhateverIsDoneToIt) {
  const std::filesystem::path room = openRoom();
  program_.write("bad.toml", "version = 1\n[camera\n");
  program_.write("bad.lvcache", "no vectors");
  program_.write("bad.exr", "no picture");
  program_.write("bad.lvsession", "scene = 3");
  const std::vector<std::filesystem::path> files = {room,
                                                    shippedScene("cornell"),
                                                    program_.path("bad.toml"),
                                                    program_.path("bad.lvcache"),
                                                    program_.path("bad.exr"),
                                                    program_.path("bad.lvsession"),
                                                    program_.path("missing.toml")};
  Monkey monkey(20240229);
  ImGuiIO& io = ImGui::GetIO();
  std::chrono::duration<double> longest{};
  const auto end = std::chrono::steady_clock::now() + monkeyTime();
  int frames = 0;
  for (; std::chrono::steady_clock::now() < end; ++frames) {
    PreviewerInput input;
    if (monkey.oneIn(3)) input.keys.push_back(monkey.chord());
    if (monkey.oneIn(60))
      input.dropped.push_back(files[static_cast<std::size_t>(monkey.below(static_cast<int>(files.size())))]);
    if (monkey.oneIn(10)) input.flight = Vec3(monkey.below(3) - 1, monkey.below(3) - 1, monkey.below(3) - 1);
    if (monkey.oneIn(40))
      io.DisplaySize =
          ImVec2(static_cast<float>(640 + monkey.below(1000)), static_cast<float>(400 + monkey.below(600)));
    io.MousePos = ImVec2(static_cast<float>(monkey.below(1300)), static_cast<float>(monkey.below(820)));
    if (monkey.oneIn(2)) io.MouseDown[monkey.below(3)] = monkey.oneIn(2);
    io.KeyShift = monkey.oneIn(5);
    io.KeyCtrl = monkey.oneIn(5);
    io.MouseWheel = monkey.oneIn(8) ? 1.0f : 0.0f;
    const auto waitedBefore = waitedForProcessor();
    const auto begun = std::chrono::steady_clock::now();
    const PreviewerOutput output = frame(input);
    (void)previewer_->content();
    const auto ended = std::chrono::steady_clock::now();
    const std::chrono::duration<double> took = ended - begun - (waitedForProcessor() - waitedBefore);
    longest = std::max(longest, took);
    ASSERT_FALSE(output.quits);
    if (previewer_->wantedCapture() != nullptr) {
      const Capture& capture = *previewer_->wantedCapture();
      previewer_->finishCapture(Image<Color8>(capture.width, capture.height));
    }
    if (monkey.oneIn(500)) {  // closes while it works, and opens again
      previewer_ = std::make_unique<Previewer>(
          UserFolders{program_.folder() / "config", program_.folder() / "state"}, [] {});
      previewer_->open(room);
    }
  }
  RecordProperty("frames", frames);
  RecordProperty("longest frame", fmt::format("{:.1f} ms", 1e3 * longest.count()));
  fmt::print("{} frames, the longest {:.1f} ms.\n", frames, 1e3 * longest.count());
  // All that the window itself waits for is in it, its locks and files, too.
  if (kIsFast) {
    EXPECT_LT(longest, 50ms);
  }
}

}  // namespace
}  // namespace lightvane
