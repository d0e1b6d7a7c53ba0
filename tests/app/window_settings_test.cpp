// What is kept of the window from start to start, and the file that it is kept in.

#include "app/window_settings.h"

#include <chrono>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/layout.h"
#include "app/session_file.h"
#include "core/base/file.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

const WindowSettings kUsualSettings;

WindowSettings otherSettings() { return {251.7f, 699.9f, Theme::Bright, 1.265625f, true}; }

class WindowSettingsTest : public testing::Test {
 protected:
  std::filesystem::path path() const { return folder_ / "lightvane" / "settings.toml"; }
  std::string text() const { return readFile(path()).value_or(""); }
  void write(const std::string& text) {
    std::filesystem::create_directories(path().parent_path());
    ASSERT_TRUE(writeFileAtomically(path(), text));
  }
  /// Time goes on until what is under way is written.
  static void settle(WindowSettingsFile& file, double& now) {
    for (int i = 0; i < 1000 && file.isBehind(); ++i) {
      file.update(now += 1.0);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  TemporaryFolder folder_;
};

TEST_F(WindowSettingsTest, EveryOneComesBack) {
  const std::string text = windowSettingsText(otherSettings());
  const ReadSettings read = parseWindowSettings(text, path());
  EXPECT_FALSE(read.error) << read.error->message() << "\n" << text;
  EXPECT_EQ(read.settings, otherSettings());
  Display display;
  applySettings(read.settings, display);
  EXPECT_EQ(windowSettings(display), otherSettings());
  EXPECT_NE(display.leftWidth, Display{}.leftWidth);
  EXPECT_EQ(windowSettings(Display{}), kUsualSettings);
}

TEST_F(WindowSettingsTest, AreWrittenForPeople) {
  EXPECT_EQ(
      windowSettingsText(kUsualSettings),
      R"(# What Lightvane's window keeps from start to start, and writes when it changes. Whatever is left out has its default.
version = 1

[window]
left_width = 290.0  # at UI scale 1
right_width = 330.0
theme = "dark"
ui_scale = 1.0  # beside the monitor's
reload = false  # the scene by itself, when its file changes
)");
}

TEST_F(WindowSettingsTest, WithoutAChangeNothingIsWritten) {
  {
    WindowSettingsFile file(path());
    EXPECT_EQ(file.settings(), kUsualSettings);
    file.update(1.0);
  }
  EXPECT_FALSE(std::filesystem::exists(path().parent_path())) << "nor is a folder made";
}

TEST_F(WindowSettingsTest, AreWrittenAtMostOnceASecondAndAtTheEnd) {
  WindowSettings last = kUsualSettings;
  const auto change = [&](WindowSettingsFile& file, float width) {
    const WindowSettings before = last;
    last.leftWidth = width;
    file.keep(before, last);
  };
  {
    WindowSettingsFile file(path());
    double now = 10.0;
    change(file, 300.0f);
    file.update(now);
    EXPECT_FALSE(file.isBehind()) << "the first change is written at once";
    for (int frame = 0; frame < 50; ++frame) {
      change(file, 301.0f + static_cast<float>(frame));
      file.update(now + 0.01 * frame);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      EXPECT_TRUE(file.isBehind()) << frame;
    }
    for (int i = 0; i < 1000 && text().empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_THAT(text(), HasSubstr("left_width = 300.0"));
    settle(file, now);
    EXPECT_FALSE(file.isBehind());
    change(file, 400.0f);
    EXPECT_FALSE(file.takeProblem());
  }
  EXPECT_THAT(text(), HasSubstr("left_width = 400.0"));
  EXPECT_EQ(WindowSettingsFile(path()).settings().leftWidth, 400.0f);
}

TEST_F(WindowSettingsTest, OnlyWhatWasChangedIsKept) {
  WindowSettingsFile file(path());
  // A session is bright; then the side bar is made wider.
  WindowSettings session = kUsualSettings;
  session.theme = Theme::Bright;
  WindowSettings wider = session;
  wider.rightWidth = 500.0f;
  file.keep(session, wider);
  EXPECT_EQ(file.settings().rightWidth, 500.0f);
  EXPECT_EQ(file.settings().theme, Theme::Dark);
}

TEST_F(WindowSettingsTest, AFileWithSomethingWrongIsToldOfAndLeftAlone) {
  struct Case {
    const char* text;
    const char* told;
    Theme theme;  ///< what is right counts all the same
  };
  const Case cases[] = {
      {"version = 1\n[window\n", "settings.toml:", Theme::Dark},
      {"version = 2\n[window]\ntheme = \"bright\"\nglow = 3\n", "2 is of a later Lightvane", Theme::Dark},
      {"version = 1\n[window]\nthem = \"dark\"\nreload = true\n", "did you mean theme?", Theme::Dark},
      {"version = 1\n[window]\ntheme = \"bright\"\nui_scale = 9\n", "0.6 to 3", Theme::Bright},
      {"[window]\ntheme = \"bright\"\n", "version", Theme::Bright}};
  for (const Case& c : cases) {
    write(c.text);
    {
      WindowSettingsFile file(path());
      EXPECT_EQ(file.settings().theme, c.theme) << c.text;
      const std::optional<std::string> problem = file.takeProblem();
      ASSERT_TRUE(problem) << c.text;
      EXPECT_THAT(*problem, HasSubstr(c.told));
      EXPECT_THAT(*problem, HasSubstr("left as it is"));
      EXPECT_FALSE(file.takeProblem()) << "one message";
      file.keep(kUsualSettings, otherSettings());
      EXPECT_FALSE(file.isBehind());
      file.update(100.0);
    }
    EXPECT_EQ(text(), c.text);
  }
}

TEST_F(WindowSettingsTest, AFolderThatCannotBeWrittenIsToldOfOnce) {
  folder_.write("lightvane", "a file where the folder should be");
  WindowSettingsFile file(path());
  EXPECT_EQ(file.settings(), kUsualSettings);
  EXPECT_FALSE(file.takeProblem());
  file.keep(kUsualSettings, otherSettings());
  file.update(10.0);
  std::optional<std::string> problem;
  for (int i = 0; i < 1000 && !problem; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    file.update(10.0);
    problem = file.takeProblem();
  }
  ASSERT_TRUE(problem);
  EXPECT_THAT(*problem, HasSubstr("Settings are not kept"));
  EXPECT_EQ(file.settings(), otherSettings()) << "they hold until the end";
  file.keep(otherSettings(), kUsualSettings);
  file.update(20.0);
  EXPECT_FALSE(file.takeProblem() || file.isBehind());
}

TEST_F(WindowSettingsTest, WithoutAHomeNothingIsKept) {
  WindowSettingsFile file{std::filesystem::path()};
  file.keep(kUsualSettings, otherSettings());
  file.update(10.0);
  EXPECT_FALSE(file.isBehind() || file.takeProblem());
}

TEST_F(WindowSettingsTest, ASessionHasThemWhereItSaysNothing) {
  const auto session = parseSession("version = 1\nscene = \"a.toml\"\n[display.window]\nui_scale = 2.0\n",
                                    folder_ / "a.lvsession", otherSettings());
  ASSERT_TRUE(session) << session.error().message();
  EXPECT_EQ(session->display.theme, Theme::Bright);
  EXPECT_EQ(session->display.uiScale, 2.0f) << "what it says wins";
}

}  // namespace
}  // namespace lightvane
