#include "app/panels/history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lightvane {
namespace {

Undoable withNMin(int nMin, PictureView view = PictureView::Beauty) {
  Undoable state;
  state.setup.parameters.vectors.ilv.nMin = nMin;
  state.shown.view = view;
  return state;
}

int nMinOf(const std::optional<Undoable>& state) {
  return state ? state->setup.parameters.vectors.ilv.nMin : -1;
}

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
  Undoable orbited = withNMin(4);
  orbited.setup.camera.position = {1.0, 2.0, 3.0};
  history.update(orbited, true, "Orbit");
  orbited.setup.camera.position.x = 2.0;
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

TEST(History, ALookThroughViewsIsOneStep) {
  History history(withNMin(4));
  history.update(withNMin(8), false);
  history.update(withNMin(8, PictureView::Direct), false);
  history.update(withNMin(8, PictureView::Normal), false);
  EXPECT_EQ(history.undoLabel(), "View");
  const auto undone = history.undo();
  ASSERT_TRUE(undone);
  EXPECT_EQ(*undone, withNMin(8));
  history.update(withNMin(8, PictureView::Normal), false);
  history.update(withNMin(8), false);
  EXPECT_EQ(history.undoLabel(), "ilv.n_min 4 -> 8") << "looked there and back";
}

// Undo, look, redo: how people compare.
TEST(History, WhatIsShownSinceDoesNotEndWhatCanBeMadeAgain) {
  History history(withNMin(4));
  history.update(withNMin(8), false);
  history.update(withNMin(8, PictureView::Direct), false);
  history.undo();
  history.undo();
  EXPECT_EQ(history.redoLabel(), "ilv.n_min 4 -> 8");
  history.update(withNMin(4, PictureView::Normal), false);
  const auto redone = history.redo();
  ASSERT_TRUE(redone);
  EXPECT_EQ(*redone, withNMin(8, PictureView::Normal));
  EXPECT_FALSE(history.canRedo()) << "the direct view would be set over the one that was chosen since";
}

TEST(History, TakesOfAWorkspaceAllButWhereItIsLookedAtFrom) {
  Workspace before;
  Workspace changed = before;
  changed.setup.threads = 2;
  changed.display.view = PictureView::Albedo;
  changed.display.smooth = true;
  changed.display.scale.low = -1.0f;
  changed.display.overlays.mostRecords = 7;
  changed.display.comparison.mode = CompareMode::Difference;
  changed.display.comparison.with = CompareWith::Reference;
  Workspace there = before;
  restore(undoableOf(changed), there);
  EXPECT_EQ(there, changed);

  changed.display.overlays.growth = {.all = false, .moment = 3, .playing = true};
  changed.display.placement.zoom = 4.0f;
  changed.display.comparison.flipped = true;
  EXPECT_EQ(undoableOf(changed), undoableOf(there)) << "no step";
  restore(undoableOf(before), changed);
  EXPECT_EQ(changed.display.overlays.growth.moment, 3u);
  EXPECT_EQ(changed.display.placement.zoom, 4.0f);
  EXPECT_TRUE(changed.display.comparison.flipped);
}

struct NamedChange {
  const char* label;
  void (*apply)(Undoable&);
};

TEST(History, ChangesAreDescribedByWhatDiffers) {
  const NamedChange changes[] = {
      {"", [](Undoable&) {}},
      {"ilv.S_curv 0.95 -> 0.9", [](Undoable& s) { s.setup.parameters.vectors.ilv.sCurv = 0.9; }},
      {"dlv.r_max 1.5% -> 0.08m",
       [](Undoable& s) { s.setup.parameters.vectors.dlv.rMax = Length::metres(0.08); }},
      {"2 parameters",
       [](Undoable& s) {
         s.setup.parameters.picture.seed = 2;
         s.setup.parameters.vectors.ilv.rows = 8;
       }},
      {"Light 2", [](Undoable& s) { s.setup.lights[1].muted = true; }},
      {"2 lights",
       [](Undoable& s) {
         s.setup.lights[0].muted = true;
         s.setup.lights[1].stops = 1.0f;
       }},
      {"Lock cache", [](Undoable& s) { s.setup.cacheLocked = true; }},
      {"Threads", [](Undoable& s) { s.setup.threads = 3; }},
      {"View", [](Undoable& s) { s.shown.view = PictureView::Normal; }},
      {"Overlays", [](Undoable& s) { s.shown.overlays.layer(OverlayKind::Dlv).opacity = 0.5f; }},
      {"Comparing", [](Undoable& s) { s.shown.compareMode = CompareMode::Wipe; }},
      {"Colour scale", [](Undoable& s) { s.shown.scale.high = 2.0f; }},
      {"Smoothing", [](Undoable& s) { s.shown.smooth = true; }},
      {"Camera", [](Undoable& s) { s.setup.camera.fovYDegrees = 20.0; }},
  };
  for (const NamedChange& change : changes) {
    Undoable before;
    before.setup.lights.resize(2);
    Undoable after = before;
    change.apply(after);
    EXPECT_EQ(describeChange(before, after), change.label);
  }
}

}  // namespace
}  // namespace lightvane
