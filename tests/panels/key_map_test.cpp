#include "app/panels/key_map.h"

#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

KeyChord chord(const std::string& text) {
  const auto parsed = parseChord(text);
  EXPECT_TRUE(parsed) << text;
  return parsed.value_or(KeyChord{});
}

TEST(KeyChord, IsReadAndWrittenAlike) {
  for (const char* text : {"A", "Ctrl+Shift+P", "F1", "F12", "Space", "Esc", "Ctrl+.", "[", "\\", "Shift+0",
                           "Ctrl+Alt+Shift+PageDown", "Alt+`", "=", "Ctrl+-"}) {
    EXPECT_EQ(formatChord(chord(text)), text);
  }
  EXPECT_EQ(chord("ctrl + p"), (KeyChord{.key = keyOf('P'), .ctrl = true}));
}

TEST(KeyChord, RefusesWhatIsNoKey) {
  for (const char* text : {"", "Ctrl", "Ctrl+", "Ctrl+Ctrl+P", "Hyper+P", "F13", "PP", "+", "%", "P+Ctrl"}) {
    EXPECT_EQ(parseChord(text), std::nullopt) << text;
  }
}

TEST(Actions, HaveNamesLabelsAndHelp) {
  std::set<std::string> names;
  for (const ActionInfo& info : actionTable()) {
    EXPECT_TRUE(names.insert(info.name).second) << info.name;
    EXPECT_THAT(std::string(info.label), SizeIs(testing::Gt(0U))) << info.name;
    EXPECT_THAT(std::string(info.help), testing::EndsWith(".")) << info.name;
    EXPECT_EQ(actionNamed(info.name), info.id);
  }
  EXPECT_EQ(actionNamed("edit.nothing"), std::nullopt);
}

TEST(Actions, ShowEachView) {
  for (int i = 0; i <= static_cast<int>(PictureView::Depth); ++i) {
    const auto view = static_cast<PictureView>(i);
    EXPECT_EQ(viewOfAction(actionOfView(view)), view);
  }
  EXPECT_EQ(viewOfAction(ActionId::Quit), std::nullopt);
  EXPECT_EQ(viewOfAction(ActionId::ExposureUp), std::nullopt);
}

TEST(KeyMap, DefaultsNeverCollide) {
  const KeyMap keys;
  std::set<KeyChord> seen;
  for (const ActionInfo& info : actionTable()) {
    for (const KeyChord& c : keys.chordsOf(info.id)) {
      EXPECT_TRUE(seen.insert(c).second) << formatChord(c) << " of " << info.name << " has two meanings";
      EXPECT_EQ(keys.actionFor(c), info.id);
    }
  }
  EXPECT_EQ(keys.actionFor(chord("Ctrl+Alt+Shift+Q")), std::nullopt);
}

TEST(KeyMap, KnowsTheKeysThatUsersExpect) {
  const KeyMap keys;
  EXPECT_EQ(keys.actionFor(chord("Space")), ActionId::Pause);
  EXPECT_EQ(keys.actionFor(chord("Ctrl+Y")), ActionId::Redo);
  EXPECT_EQ(keys.actionFor(chord("Esc")), ActionId::Close);
  EXPECT_EQ(keys.actionFor(chord("5")), ActionId::ViewWhereComputed);
  EXPECT_EQ(keys.allTextOf(ActionId::Redo), "Ctrl+Shift+Z, Ctrl+Y");
  EXPECT_EQ(keys.textOf(ActionId::CopyView), "");
}

TEST(KeyFile, ChangesWhatItNamesAndNothingElse) {
  const KeyFile file = parseKeyFile(
      "# mine\n"
      "\n"
      "edit.undo = \"Ctrl+U\"  # as at work\n"
      "  render.pause=\"\"\r\n"
      "view.depth = \"Shift+D  Alt+9\"\n",
      "keys.toml");
  EXPECT_THAT(file.errors, IsEmpty());
  EXPECT_EQ(file.keys.actionFor(chord("Ctrl+U")), ActionId::Undo);
  EXPECT_EQ(file.keys.actionFor(chord("Ctrl+Z")), std::nullopt);
  EXPECT_EQ(file.keys.actionFor(chord("Space")), std::nullopt);
  EXPECT_EQ(file.keys.actionFor(chord("Alt+9")), ActionId::ViewDepth);
  EXPECT_EQ(file.keys.actionFor(chord("Ctrl+Q")), ActionId::Quit);
}

TEST(KeyFile, KeysCanBeSwapped) {
  const KeyFile file = parseKeyFile("zoom.in = \"-\"\nzoom.out = \"=\"\n", "keys.toml");
  EXPECT_THAT(file.errors, IsEmpty());
  EXPECT_EQ(file.keys.actionFor(chord("-")), ActionId::ZoomIn);
  EXPECT_EQ(file.keys.actionFor(chord("=")), ActionId::ZoomOut);
}

struct BadFile {
  const char* text;
  const char* message;
};

TEST(KeyFile, SaysWhatIsWrongAndKeepsTheDefaults) {
  const BadFile files[] = {
      {"edit.undoo = \"Ctrl+U\"", "keys.toml:1: there is no action 'edit.undoo' (did you mean edit.undo?)"},
      {"\nedit.undo = \"Ctrl+Foo\"",
       "keys.toml:2: 'Ctrl+Foo' is no key (keys are written as Ctrl+Shift+P, F5, Space or [)"},
      {"edit.undo = Ctrl+U",
       "keys.toml:1: 'edit.undo = Ctrl+U' is not of the form action = \"keys\" (as in edit.undo = "
       "\"Ctrl+Z\")"},
      {"edit.undo = \"Ctrl+U", "not of the form"},
      {"edit.undo = \"Ctrl+U\" rest", "not of the form"},
      {"edit.undo", "not of the form"},
      {"edit.undo = \"Ctrl+Q\"",
       "keys.toml:1: Ctrl+Q would be both edit.undo and file.quit (give file.quit other keys in a line of "
       "its "
       "own)"},
      {"edit.undo = \"W\"", "keys.toml:1: W is held to fly through the scene (add Ctrl, Alt or Shift to it)"},
  };
  for (const BadFile& bad : files) {
    const KeyFile file = parseKeyFile(bad.text, "keys.toml");
    ASSERT_THAT(file.errors, SizeIs(1)) << bad.text;
    EXPECT_THAT(file.errors.front().message(), HasSubstr(bad.message));
    EXPECT_EQ(file.keys.actionFor(chord("Ctrl+Z")), ActionId::Undo) << bad.text;
    EXPECT_EQ(file.keys.actionFor(chord("Ctrl+Q")), ActionId::Quit) << bad.text;
  }
}

TEST(KeyFile, OfTwoLinesThatCollideTheLaterGivesWay) {
  const KeyFile file = parseKeyFile("edit.undo = \"Ctrl+U\"\nfile.quit = \"Ctrl+U\"\n", "keys.toml");
  ASSERT_THAT(file.errors, SizeIs(1));
  EXPECT_THAT(file.errors.front().message(), HasSubstr("keys.toml:2"));
  EXPECT_EQ(file.keys.actionFor(chord("Ctrl+U")), ActionId::Undo);
  EXPECT_EQ(file.keys.actionFor(chord("Ctrl+Q")), ActionId::Quit);
}

TEST(KeyFile, ALineThatIsGivenUpMayTakeAnotherWithIt) {
  // zoom.in takes zoom.out's key, zoom.out goes to quit's, which is refused and comes back.
  const KeyFile file = parseKeyFile("zoom.in = \"-\"\nzoom.out = \"Ctrl+Q\"\n", "keys.toml");
  EXPECT_THAT(file.errors, SizeIs(2));
  EXPECT_EQ(keyFileText(file.keys), keyFileText(KeyMap()));
}

TEST(KeyFile, TheShippedExampleIsTheDefaults) {
  const auto text = readFile(LIGHTVANE_SOURCE_DIR "/assets/keys.toml");
  ASSERT_TRUE(text) << text.error().message();
  const std::string expected = keyFileText(KeyMap());
  if (*text != expected) {
    const std::string path = testing::TempDir() + "lightvane_keys.toml";
    ASSERT_TRUE(writeFileAtomically(path, expected));
    ADD_FAILURE() << "assets/keys.toml is not what the table of actions gives; " << path << " is";
  }
  EXPECT_THAT(parseKeyFile(*text, "keys.toml").errors, IsEmpty());
}

}  // namespace
}  // namespace lightvane
