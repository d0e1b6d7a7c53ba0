#include "app/panels/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

Setup withNMin(int nMin) {
  Setup setup;
  setup.parameters.vectors.ilv.nMin = nMin;
  return setup;
}

int nMinOf(const std::optional<Setup>& setup) { return setup ? setup->parameters.vectors.ilv.nMin : -1; }

TEST(History, TakesBackAndMakesAgainEachChange) {
  History history(withNMin(4));
  history.update(withNMin(8), false);
  history.update(withNMin(9), false);
  EXPECT_EQ(history.undoLabel(), "ilv.n_min 8 -> 9");
  EXPECT_EQ(nMinOf(history.undo()), 8);
  EXPECT_EQ(history.undoLabel(), "ilv.n_min 4 -> 8");
  EXPECT_EQ(history.redoLabel(), "ilv.n_min 8 -> 9");
  EXPECT_EQ(nMinOf(history.undo()), 4);
  EXPECT_FALSE(history.canUndo());
  EXPECT_EQ(history.undo(), std::nullopt);
  EXPECT_EQ(nMinOf(history.redo()), 8);
  EXPECT_EQ(nMinOf(history.redo()), 9);
  EXPECT_FALSE(history.canRedo());
  EXPECT_EQ(history.redo(), std::nullopt);
}

TEST(History, AGestureIsOneStepHoweverManyFramesItTakes) {
  History history(withNMin(4));
  for (int n = 5; n <= 12; ++n) history.update(withNMin(n), true);
  history.update(withNMin(12), true);
  history.update(withNMin(12), false);
  EXPECT_EQ(history.undoLabel(), "ilv.n_min 4 -> 12");
  EXPECT_EQ(nMinOf(history.undo()), 4);
  EXPECT_FALSE(history.canUndo());
}

TEST(History, AGestureThatEndsWhereItBeganIsNoStep) {
  History history(withNMin(4));
  history.update(withNMin(9), true);
  history.update(withNMin(4), true);
  history.update(withNMin(4), false);
  EXPECT_FALSE(history.canUndo());
}

TEST(History, UndoWithinAGestureEndsIt) {
  History history(withNMin(4));
  history.update(withNMin(9), true);
  EXPECT_TRUE(history.canUndo());
  EXPECT_EQ(history.undoLabel(), "ilv.n_min 4 -> 9");
  EXPECT_EQ(nMinOf(history.undo()), 4);
  history.update(withNMin(4), true);
  EXPECT_EQ(nMinOf(history.redo()), 9);
}

TEST(History, FramesWithoutAChangeKeepWhatCanBeMadeAgain) {
  History history(withNMin(4));
  history.update(withNMin(9), false);
  history.undo();
  history.update(withNMin(4), false);
  EXPECT_TRUE(history.canRedo());
  history.update(withNMin(5), false);
  EXPECT_FALSE(history.canRedo()) << "a new change ends the old future";
}

TEST(History, GestureNamesCount) {
  History history(withNMin(4));
  lightvane::Setup orbited = withNMin(4);
  orbited.camera.position = {1.0, 2.0, 3.0};
  history.update(orbited, true, "Orbit");
  orbited.camera.position.x = 2.0;
  history.update(orbited, true, "Pan");
  history.update(orbited, false);
  EXPECT_EQ(history.undoLabel(), "Orbit");
}

TEST(History, ForgetsTheOldestStepsBeyondItsLimit) {
  History history(withNMin(1), 3);
  for (int n = 2; n <= 10; ++n) history.update(withNMin(n), false);
  int steps = 0;
  int last = 10;
  while (const auto setup = history.undo()) {
    ++steps;
    last = nMinOf(setup);
  }
  EXPECT_EQ(steps, 3);
  EXPECT_EQ(last, 7);
}

TEST(History, AnotherSceneBeginsAnew) {
  History history(withNMin(1));
  history.update(withNMin(2), false);
  history.reset(withNMin(7));
  EXPECT_FALSE(history.canUndo());
  history.update(withNMin(7), false);
  EXPECT_FALSE(history.canUndo());
}

struct NamedChange {
  const char* label;
  void (*apply)(Setup&);
};

TEST(History, ChangesAreDescribedByWhatDiffers) {
  const NamedChange changes[] = {
      {"", [](lightvane::Setup&) {}},
      {"ilv.S_curv 0.95 -> 0.9", [](lightvane::Setup& s) { s.parameters.vectors.ilv.sCurv = 0.9; }},
      {"dlv.r_max 1.5% -> 0.08m",
       [](lightvane::Setup& s) { s.parameters.vectors.dlv.rMax = Length::metres(0.08); }},
      {"2 parameters",
       [](lightvane::Setup& s) {
         s.parameters.picture.seed = 2;
         s.parameters.vectors.ilv.rows = 8;
       }},
      {"Light 2", [](lightvane::Setup& s) { s.lights[1].muted = true; }},
      {"2 lights",
       [](lightvane::Setup& s) {
         s.lights[0].muted = true;
         s.lights[1].stops = 1.0f;
       }},
      {"Lock cache", [](lightvane::Setup& s) { s.cacheLocked = true; }},
      {"Threads", [](lightvane::Setup& s) { s.threads = 3; }},
      {"Camera", [](lightvane::Setup& s) { s.camera.fovYDegrees = 20.0; }},
  };
  for (const NamedChange& change : changes) {
    lightvane::Setup before;
    before.lights.resize(2);
    lightvane::Setup after = before;
    change.apply(after);
    EXPECT_EQ(describeChange(before, after), change.label);
  }
}

}  // namespace
}  // namespace lightvane
