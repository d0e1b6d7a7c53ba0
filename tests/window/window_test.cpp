// The real window as a user has it: on a display, with mouse and keyboard.

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"
#include "core/image/image_file.h"
#include "tests/support/temporary_folder.h"
#include "tests/window/application.h"
#include "tests/window/virtual_desktop.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;
using namespace std::chrono_literals;

/// A text with one part, which it has, replaced.
std::string replaced(std::string text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) throw std::runtime_error("the shipped scene has no: " + part);
  return text.replace(at, part.size(), by);
}

/// The shipped Cornell box in another size and with more settings in its [render], which is its end.
std::string cornell(int width, int height, const std::string& settings) {
  const std::string shipped =
      readFile(fs::path(LIGHTVANE_SOURCE_DIR) / "assets/scenes/cornell-mirror.toml").value();
  return replaced(shipped, "resolution = [512, 512]", fmt::format("resolution = [{}, {}]", width, height)) +
         settings + "\n";
}

std::string quickScene() { return cornell(120, 100, "preset = \"draft\"\nseed = 3"); }
/// One that is under way for as long as a test takes.
std::string slowScene() { return cornell(1600, 1200, "preset = \"fine\""); }

/// Whether a command line gives a complete picture that has this part in it.
auto completeWith(const std::string& part) {
  return [part](const std::string& command) {
    return command.find(part) != std::string::npos && command.find("--passes") == std::string::npos;
  };
}
auto completeWithout(const std::string& part) {
  return [part](const std::string& command) {
    return command.find(part) == std::string::npos && command.find("--passes") == std::string::npos;
  };
}

/// A run of the program, with the quick scene, that is to end by itself.
struct TemporaryRun {
  TemporaryRun(const std::vector<std::string>& words, const std::string& display,
               std::map<std::string, std::string> environment = {}) {
    environment.insert({{"DISPLAY", display}, {"WAYLAND_DISPLAY", ""}, {"HOME", folder.path()}});
    folder.write("scene.toml", quickScene());
    std::vector<std::string> all = {LIGHTVANE_PROGRAM};
    all.insert(all.end(), words.begin(), words.end());
    ChildProcess process({.words = all,
                          .environment = std::move(environment),
                          .folder = folder.path(),
                          .err = folder / "err"});
    exitCode = process.waitForExit(60s);
    err = readFile(folder / "err").value();
  }
  TemporaryFolder folder;
  std::optional<int> exitCode;
  std::string err;
};

class RealWindow : public testing::Test {
 protected:
  /// Opens a scene of that text.
  void open(const std::string& scene) {
    write("scene.toml", scene);
    application_.start({application_.path("scene.toml")});
  }
  void openAndComplete() {
    open(quickScene());
    application_.waitUntilComplete();
  }
  void write(const std::string& name, const std::string& content) const {
    ASSERT_TRUE(writeFileAtomically(application_.path(name), content));
  }
  Spot middleOfPicture() const { return application_.waitForWidget("picture").centre(); }
  void orbit() const {
    const Spot middle = middleOfPicture();
    application_.drag(middle, {middle.x + 120, middle.y + 30});
  }
  LayeredImage picture(const std::string& name) const { return readImage(application_.path(name)).value(); }
  bool hasToast(const std::string& part) const {
    const std::vector<SeenWidget> widgets = application_.widgets();
    return std::any_of(widgets.begin(), widgets.end(), [&](const SeenWidget& widget) {
      return widget.name.starts_with("toast.") && widget.text.find(part) != std::string::npos;
    });
  }
  bool isComplete() const { return application_.textOf("status.state").starts_with("Complete"); }
  void waitUntilRendering() const {
    application_.waitForText("status.state",
                             [](const std::string& text) { return text.starts_with("Pass"); });
    EXPECT_FALSE(isComplete());
  }
  /// Until nothing is drawn for its own sake any more: messages and tooltips come and go.
  void settle() const {
    constexpr auto kShort = 500ms;
    constexpr double kFewFrames = 0.05;
    double before = -1.0;
    application_.waitUntil("nothing moves", [&] {
      const double last = std::exchange(before, application_.processorSeconds());
      std::this_thread::sleep_for(kShort);
      return application_.processorSeconds() - before < kFewFrames && last >= 0.0;
    });
  }
  void pressDigits() const {
    for (const char digit : std::string("1234567890")) application_.press(std::string(1, digit));
  }

  VirtualDesktop desktop_;
  Application application_{desktop_};
};

TEST_F(RealWindow, OpensASceneCompletesItAndCloses) {
  const auto begun = std::chrono::steady_clock::now();
  open(quickScene());
  const std::chrono::duration<double> opened = std::chrono::steady_clock::now() - begun;
  application_.waitUntilComplete();
  const std::chrono::duration<double> completed = std::chrono::steady_clock::now() - begun;
  RecordProperty("opened", fmt::format("{:.2f} s", opened.count()));
  fmt::print("The window was there after {:.2f} s, the picture complete after {:.2f} s.\n", opened.count(),
             completed.count());
  EXPECT_EQ(application_.title(), "scene.toml - Lightvane");
  const SeenWidget status = *application_.find("status.state");
  EXPECT_LE(status.y1, VirtualDesktop::kHeight) << "the window is larger than the screen";
  application_.quit();
}

// The contract: the picture of the window can be made again without it.
TEST_F(RealWindow, ExportsWhatItsCommandLineRendersToo) {
  openAndComplete();
  for (const std::string extension : {".exr", ".png"}) {
    const std::string exported = "exported" + extension;
    application_.exportTo(exported, completeWithout("--from="));
    const std::map<std::string, std::string> metadata = picture(exported).metadata;
    EXPECT_EQ(metadata.at("complete"), "true");
    const std::string command = metadata.at("command");
    ASSERT_THAT(command, StartsWith("lightvane render "));
    const std::string program = fs::path(LIGHTVANE_PROGRAM).parent_path();
    ChildProcess render({.words = {"sh", "-c", fmt::format("PATH='{}':$PATH; {}", program, command)},
                         .environment = {{"DISPLAY", ""}},
                         .folder = application_.folder()});
    ASSERT_EQ(render.waitForExit(60s), 0) << command;
    const bool isSame = readFile(application_.path(exported)).value() ==
                        readFile(application_.path("picture" + extension)).value();
    EXPECT_TRUE(isSame) << exported << " differs from what this gives: " << command;
  }
  application_.quit();
}

TEST_F(RealWindow, DraggingThePictureMovesTheCamera) {
  openAndComplete();
  application_.exportTo("before.png", completeWithout("--from="));
  orbit();
  application_.exportTo("after.png", completeWith("--from="));
  EXPECT_EQ(picture("before.png").metadata.count("camera_changes"), 0U);
  EXPECT_THAT(picture("after.png").metadata.at("camera_changes"), HasSubstr("from="));
  EXPECT_FALSE(picture("before.png").rgb() == picture("after.png").rgb());
  application_.quit();
}

// Fingers often leave Ctrl before the letter, and before a frame is drawn: D flies only by itself.
TEST_F(RealWindow, AShortcutsLetterDoesNotFly) {
  openAndComplete();
  for (int i = 0; i < 12; ++i) {
    desktop_.xdotool({"keydown", "ctrl", "keydown", "d", "keyup", "ctrl"});
    std::this_thread::sleep_for(100ms);
    desktop_.xdotool({"keyup", "d"});
  }
  application_.exportTo("after.png", completeWithout("--from="));
  EXPECT_EQ(picture("after.png").metadata.count("camera_changes"), 0U);
  application_.quit();
}

// Quick fingers, and programs that type for their users, hold a key for less than a frame.
TEST_F(RealWindow, ATapShorterThanAFrameIsATap) {
  openAndComplete();
  const auto tap = [&](const char* chord) { desktop_.xdotool({"key", "--delay", "4", chord}); };
  for (const std::string text : {"one.png", "two.png", "three.png", "four.png", "five.png", "six.png"}) {
    tap("ctrl+e");
    application_.waitForWidget("export.path");
    application_.waitForWidget("export.command");
    tap("ctrl+a");
    desktop_.xdotool({"type", "--delay", "4", text});
    application_.waitForText("export.path", [&](const std::string& typed) { return typed == text; });
    tap("Return");
    application_.waitUntil("the dialog is closed", [&] { return !application_.find("window.export"); });
    application_.waitUntil("there is " + text, [&] { return fs::exists(application_.path(text)); });
  }
  application_.quit();
}

TEST_F(RealWindow, DraggingASliderChangesItsParameterAndUndoTakesItBack) {
  openAndComplete();
  const std::string before = application_.waitForWidget("ilv.rows").text;
  const Spot slider = application_.find("ilv.rows")->centre();
  application_.drag(slider, {slider.x + 60, slider.y});
  const std::string dragged =
      application_.waitForText("ilv.rows", [&](const std::string& text) { return text != before; });
  ASSERT_NE(dragged, before);
  const auto isSetTo = [](const std::string& value) { return completeWith("--set ilv.rows=" + value + " "); };
  application_.exportTo("dragged.png", isSetTo(dragged));
  EXPECT_THAT(picture("dragged.png").metadata.at("parameters"), HasSubstr("ilv.rows=" + dragged));

  application_.press("ctrl+z");
  application_.waitForText("ilv.rows", [&](const std::string& text) { return text == before; });
  application_.exportTo("undone.png", isSetTo(before));
  EXPECT_EQ(picture("undone.png").metadata.at("parameters"),
            replaced(picture("dragged.png").metadata.at("parameters"), "ilv.rows=" + dragged,
                     "ilv.rows=" + before));
  application_.quit();
}

TEST_F(RealWindow, ClickingAPixelShowsWhatItIsMadeOf) {
  openAndComplete();
  application_.press("F8");
  application_.press("v");  // no vectors in the mouse's way
  EXPECT_FALSE(application_.find("inspector.point.0.light.0"));
  // The back wall; the mirror block is in the middle.
  const SeenWidget area = application_.waitForWidget("picture");
  application_.click(Spot{(area.x0 + area.x1) / 2, area.y0 + (area.y1 - area.y0) * 35 / 100});
  application_.waitForWidget("inspector.point.0.light.0");
  application_.press("Escape");
  application_.waitUntil("the selection is cleared",
                         [&] { return !application_.find("inspector.point.0.light.0"); });
  application_.quit();
}

TEST_F(RealWindow, AWrongPathIsAMessageAndTheWindowLivesOn) {
  openAndComplete();
  application_.press("ctrl+o");
  application_.fillIn("open.path", application_.path("missing.toml"));
  application_.press("Return");
  application_.waitForText("open.error", [](const std::string& text) { return !text.empty(); });

  write("broken.toml", "version = 1\n[material.x]\ndiffuse = 3\n");
  application_.fillIn("open.path", application_.path("broken.toml"));
  application_.press("Return");
  application_.waitUntil("a message names the file", [&] { return hasToast("broken.toml"); });
  EXPECT_EQ(application_.title(), "scene.toml - Lightvane") << "the scene that was open stays";
  application_.exportTo("still.png", completeWithout("--from="));
  application_.quit();
}

TEST_F(RealWindow, ADroppedSceneIsOpenedAndABadFileIsAMessage) {
  openAndComplete();
  write("broken.toml", "version = 1\n[camera\n");
  application_.drop(application_.path("broken.toml"));
  application_.waitUntil("a message names the file", [&] { return hasToast("broken.toml"); });
  EXPECT_EQ(application_.title(), "scene.toml - Lightvane") << "the scene that was open stays";
  write("other.toml", quickScene());
  application_.drop(application_.path("other.toml"));
  application_.waitUntil("the other scene is open",
                         [&] { return application_.title() == "other.toml - Lightvane"; });
  application_.waitUntilComplete();
  application_.quit();
}

/// A file that takes seconds to be read: so many triangles with a corner in common.
std::string largeObj(int triangles) {
  std::string text = "v 0 0 0\n";
  for (int i = 0; i <= triangles; ++i) text += fmt::format("v {} {} 1\n", i, i % 7);
  for (int i = 0; i < triangles; ++i) text += fmt::format("f 1 {} {}\n", i + 2, i + 3);
  return text;
}

TEST_F(RealWindow, ReadingASceneCanBeStopped) {
  openAndComplete();
  write("large.obj", largeObj(2'000'000));
  application_.drop(application_.path("large.obj"));
  // Once a second: what is done for it, and how much of that.
  application_.waitForText("status.loading", [](const std::string& text) { return text.ends_with(" %"); });
  application_.press("ctrl+period");
  application_.waitUntil("a message says so", [&] { return hasToast("large.obj is not read"); });
  EXPECT_FALSE(application_.find("status.loading"));
  settle();
  EXPECT_EQ(application_.title(), "scene.toml - Lightvane") << "the scene that was open stays";
  EXPECT_TRUE(isComplete()) << "its rendering was not stopped";
  application_.quit();
}

TEST_F(RealWindow, AMissingSceneIsAMessageToo) {
  application_.start({application_.path("missing.toml")});
  application_.waitUntil("a message names the file", [&] { return hasToast("missing.toml"); });
  pressDigits();
  orbit();
  for (const char* chord : {"ctrl+z", "ctrl+r", "ctrl+shift+c", "Home", "c", "b", "f", "h", "x", "m"})
    application_.press(chord);
  EXPECT_TRUE(application_.isRunning());
  application_.quit();
}

TEST_F(RealWindow, ClosesAtOnceWhileItRenders) {
  open(slowScene());
  waitUntilRendering();
  EXPECT_LT(application_.quit(), 2s);
}

TEST_F(RealWindow, FollowsItsSizeWhileItRenders) {
  open(slowScene());
  waitUntilRendering();
  for (const auto& [width, height] : {std::pair(900, 700), std::pair(640, 400), std::pair(1270, 790)}) {
    application_.resize(width, height);
    application_.waitUntil(fmt::format("the window is {} pixels wide and {} high", width, height), [&] {
      const auto picture = application_.find("picture");
      const auto status = application_.find("status.state");
      const auto splitter = application_.find("splitter.right");
      return picture && status && splitter && splitter->x0 < width && splitter->x0 > width / 3 &&
             status->y1 <= height && status->y0 > height - 50 && picture->y1 <= status->y0;
    });
  }
  EXPECT_FALSE(isComplete());
  application_.quit();
}

TEST_F(RealWindow, NoKeyEndsItButItsOwn) {
  open(slowScene());
  pressDigits();
  application_.press("Escape");
  waitUntilRendering();
  pressDigits();
  application_.press("space");  // pauses
  pressDigits();
  application_.press("Escape");
  // Other cameras and other comparisons while a coarse picture is shown.
  application_.press("b");
  application_.press("m");
  orbit();
  pressDigits();
  application_.press("shift+m");
  pressDigits();
  for (const char* chord : {"ctrl+e", "ctrl+p", "F1", "F2"}) {
    application_.press(chord);
    pressDigits();
    application_.press("Escape");
    application_.press("Escape");
  }
  EXPECT_TRUE(application_.isRunning());
  application_.quit();
}

TEST_F(RealWindow, EscapeNeverQuits) {
  openAndComplete();
  application_.click(middleOfPicture());
  application_.press("ctrl+e");
  application_.waitForWidget("window.export");
  for (int i = 0; i < 5; ++i) application_.press("Escape");
  application_.waitUntil("the dialog is closed", [&] { return !application_.find("window.export"); });
  EXPECT_TRUE(application_.isRunning());
  pressDigits();
  application_.quit();
}

// What a software GL does on threads of its own, a graphics card does elsewhere.
TEST_F(RealWindow, AFrameTakesItsThreadLittleTimeWhileItRenders) {
  // Vectors of both kinds, and more of them on the screen than by default: some 7,000.
  write("scene.toml", cornell(512, 512, "preset = \"balanced\""));
  write("many.lvsession", "version = 1\nscene = \"scene.toml\"\n[display.overlays]\nmost = 5000\n");
  application_.start({application_.path("many.lvsession")});
  application_.waitUntilComplete();
  const auto show = [](const std::string& what, const Application::FrameCost& cost) {
    fmt::print("{}: {} frames of {:.1f} ms of the window's thread.\n", what, cost.frames, cost.milliseconds);
    EXPECT_GT(cost.frames, 5);
    EXPECT_LT(cost.milliseconds, 16.0);
  };
  application_.press("p");
  show("Growing", application_.measureFrames(2s));
  application_.press("ctrl+shift+r");
  show("Rendering, with all vectors shown", application_.measureFrames(1500ms));
  application_.quit();
}

TEST_F(RealWindow, SleepsWhenThereIsNothingToDo) {
  constexpr auto kMeasured = 3s;
  openAndComplete();
  const auto share = [&](const std::string& where) {
    const double before = application_.processorSeconds();
    std::this_thread::sleep_for(kMeasured);
    const double percent = 100.0 * (application_.processorSeconds() - before) / kMeasured.count();
    fmt::print("Idle with the mouse {}: {:.1f} % of a processor.\n", where, percent);
    return percent;
  };
  application_.moveTo(middleOfPicture());
  settle();
  EXPECT_LT(share("over the picture"), 2.0);
  application_.moveTo(application_.waitForWidget("ilv.n_min").centre());
  settle();
  EXPECT_LT(share("on a slider"), 2.0);
  application_.quit();
}

TEST(WithoutDisplay, ItRendersAPictureInstead) {
  const TemporaryRun run({"scene.toml"}, "");
  EXPECT_EQ(run.exitCode, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("there is no display for the window"));
  EXPECT_TRUE(fs::exists(run.folder / "scene.png"));
}

TEST(BrokenGl, IsOneMessageThatSaysWhatToDo) {
  const VirtualDesktop desktop;
  const TemporaryRun run({"scene.toml"}, desktop.display(), {{"MESA_GL_VERSION_OVERRIDE", "2.1"}});
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("lightvane: error: "));
  EXPECT_THAT(run.err, HasSubstr("OpenGL 3.3"));
  EXPECT_THAT(run.err, HasSubstr("install libgl1-mesa-dri"));
}

TEST(WithoutDisplay, AWrongDisplayIsOneMessage) {
  const TemporaryRun run({"scene.toml"}, ":4711");
  EXPECT_EQ(run.exitCode, 2);
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.err, StartsWith("lightvane: error: "));
  EXPECT_THAT(run.err, HasSubstr(":4711"));
  EXPECT_THAT(run.err, HasSubstr("lightvane render"));
}

}  // namespace
}  // namespace lightvane
