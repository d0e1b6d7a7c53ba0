// What panels are made of and that needs no drawing: the palette's search, completion of paths, the layout,
// texts of the status bar, marks of scales, actions.

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/apply_action.h"
#include "app/panels/command_palette.h"
#include "app/panels/export_dialog.h"
#include "app/panels/fuzzy.h"
#include "app/panels/layout.h"
#include "app/panels/legend.h"
#include "app/panels/overlay_panel.h"
#include "app/panels/path_completion.h"
#include "app/panels/status_bar.h"
#include "tests/panels/panel_driver.h"
#include "tests/support/temporary_folder.h"

namespace lightvane {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pointwise;

TEST(Fuzzy, FindsLettersInTheirOrder) {
  EXPECT_TRUE(fuzzyScore("", "anything"));
  EXPECT_TRUE(fuzzyScore("wc", "View: Where computed"));
  EXPECT_TRUE(fuzzyScore("n MIN", "ilv.n_min"));
  EXPECT_FALSE(fuzzyScore("nx", "ilv.n_min"));
  EXPECT_FALSE(fuzzyScore("nim.", "ilv.n_min"));
  EXPECT_FALSE(fuzzyScore("a", ""));
}

TEST(Fuzzy, PrefersRunsBeginningsAndShortTexts) {
  EXPECT_GT(fuzzyScore("ilv", "ilv.n_min"), fuzzyScore("ilv", "i like velvet"));
  EXPECT_GT(fuzzyScore("wc", "where computed"), fuzzyScore("wc", "show cat"));
  EXPECT_GT(fuzzyScore("undo", "Edit: Undo"), fuzzyScore("undo", "Edit: Undo everything at once"));
}

TEST(Palette, FindsEveryActionAndEveryParameterByName) {
  for (const ActionInfo& info : actionTable()) {
    if (info.id == ActionId::Palette || info.id == ActionId::Close) continue;
    const std::vector<PaletteEntry> found = findPaletteEntries(info.label);
    ASSERT_FALSE(found.empty()) << info.label;
    bool first = false;  // among the first: labels such as "View" are part of others
    for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 12); ++i) {
      first |= found[i].target == decltype(found[i].target)(info.id);
    }
    EXPECT_TRUE(first) << info.label;
  }
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::vector<PaletteEntry> found = findPaletteEntries(row.field.key);
    ASSERT_FALSE(found.empty()) << row.field.key;
    EXPECT_EQ(std::get<std::string>(found.front().target), row.field.key);
  }
  EXPECT_THAT(findPaletteEntries("qqqq"), IsEmpty());
}

class PathCompletionTest : public testing::Test {
 protected:
  PathCompletionTest() {
    std::filesystem::create_directory(folder_ / "scenes");
    for (const char* name : {"scene_a.toml", "scene_b.toml", "scene.txt", ".hidden.toml", "scenes/x.obj"})
      folder_.write(name, "x");
  }

  PathCompletion complete(const std::string& typed) { return completePath(root_ + typed, endings_); }

  TemporaryFolder folder_;
  std::string root_ = folder_.path().string() + "/";
  std::array<std::string_view, 2> endings_{".toml", ".obj"};
};

TEST_F(PathCompletionTest, OffersFoldersAndFilesOfTheEndings) {
  EXPECT_THAT(complete("").paths,
              ElementsAre(root_ + "scenes/", root_ + "scene_a.toml", root_ + "scene_b.toml"));
  EXPECT_EQ(complete("sc").common, root_ + "scene");
  EXPECT_EQ(complete("scenes/").common, root_ + "scenes/x.obj");
  EXPECT_THAT(complete(".h").paths, ElementsAre(root_ + ".hidden.toml"));
  EXPECT_EQ(completePath(root_, endings_, 1).paths.size(), 1U);
}

TEST_F(PathCompletionTest, KeepsWhatWasTypedWhereThereIsNothing) {
  EXPECT_EQ(complete("nothing").common, root_ + "nothing");
  EXPECT_THAT(complete("no/such/folder/").paths, IsEmpty());
  EXPECT_FALSE(complete("scenes").isFile);
  EXPECT_TRUE(complete("scene_a.toml").isFile);
}

TEST(ExportDialog, EndingsTakeEachOthersPlace) {
  const ExportFormat formats[] = {{".png", "PNG", true}, {".exr", "EXR", false}};
  EXPECT_EQ(withExtension("a.png", formats, ".exr"), "a.exr");
  EXPECT_EQ(withExtension("a.b", formats, ".exr"), "a.b.exr");
  EXPECT_EQ(withExtension("", formats, ".png"), ".png");
}

LayoutInput layoutOf(float width, float height, float scale) {
  return {.screen = {width, height},
          .scale = scale,
          .menuHeight = 22.0f * scale,
          .statusHeight = 24.0f * scale,
          .sideBars = true,
          .leftWidth = 290.0f,
          .rightWidth = 330.0f};
}

TEST(Layout, WhatIsNarrowHasOneSideBar) {
  EXPECT_TRUE(layoutPanels(layoutOf(1280, 800, 1.0f)).left);
  EXPECT_TRUE(layoutPanels(layoutOf(1024, 640, 1.0f)).left);
  EXPECT_FALSE(layoutPanels(layoutOf(900, 640, 1.0f)).left);
  EXPECT_FALSE(layoutPanels(layoutOf(1024, 640, 2.0f)).left);
  LayoutInput without = layoutOf(1280, 800, 1.0f);
  without.sideBars = false;
  const PanelLayout layout = layoutPanels(without);
  EXPECT_FALSE(layout.left);
  EXPECT_FALSE(layout.right);
  EXPECT_EQ(layout.picture.width(), 1280.0f);
}

TEST(Layout, NothingOverlapsAndThePictureKeepsItsPart) {
  for (const float width : {320.0f, 640.0f, 1024.0f, 1280.0f, 2560.0f, 7680.0f}) {
    for (const float scale : {0.6f, 1.0f, 2.0f, 3.0f}) {
      LayoutInput input = layoutOf(width, 640.0f, scale);
      input.leftWidth = input.rightWidth = 5000.0f;
      const PanelLayout layout = layoutPanels(input);
      EXPECT_GE(layout.picture.width(), 0.39f * width) << width << " at " << scale;
      EXPECT_EQ(layout.picture.min.x, layout.left ? layout.left->max.x : 0.0f);
      EXPECT_EQ(layout.picture.max.x, layout.right->min.x);
      EXPECT_EQ(layout.picture.min.y, layout.menu.max.y);
      EXPECT_EQ(layout.picture.max.y, layout.status.min.y);
    }
  }
}

TEST(StatusBar, SaysWhatHappensTheMostImportantFirst) {
  RenderStatus status{.pass = 4, .stage = "stride 8", .fraction = 0.631, .secondsLeft = 12.0};
  const auto textsOf = [&](bool locked) {
    std::vector<std::string> texts;
    for (const StatusItem& item : statusItems(status, true, locked)) texts.push_back(item.text);
    return texts;
  };
  EXPECT_THAT(textsOf(false), ElementsAre("Pass 5, stride 8, 63 %", "about 12.0 s left", "0 ILVs, 0 DLVs",
                                          "0 % interpolated"));
  status.faultySamples = 2;
  status.unanswered = 1500;
  EXPECT_THAT(textsOf(true), Contains("2 bad samples"));
  EXPECT_THAT(textsOf(true), Contains("locked, 1,500 points unanswered"));
  status.paused = true;
  EXPECT_EQ(textsOf(false).front(), "Paused, stride 8, 63 %");
  status.complete = true;
  EXPECT_EQ(textsOf(false).front(), "Complete, 4 passes");
  EXPECT_THAT(statusItems({}, false, false).front().text, HasSubstr("No scene"));
}

TEST(Legend, ScalesAreMarkedAtRoundNumbers) {
  const auto ticks = [](float low, float high, bool logarithmic, int most) {
    return scaleTicks({.map = ColorMap::Viridis, .low = low, .high = high, .logarithmic = logarithmic}, most);
  };
  EXPECT_THAT(ticks(0.0f, 42.0f, false, 4), Pointwise(DoubleNear(1e-9), {0.0, 20.0, 40.0}));
  EXPECT_THAT(ticks(-1.0f, 1.0f, false, 5), Pointwise(DoubleNear(1e-9), {-1.0, -0.5, 0.0, 0.5, 1.0}));
  EXPECT_THAT(ticks(0.001f, 1000.0f, true, 4), Pointwise(DoubleNear(1e-9), {1e-3, 1e-1, 1e1, 1e3}));
  EXPECT_THAT(ticks(2.0f, 8.0f, true, 4), Pointwise(DoubleNear(1e-9), {2.0, 8.0}));
  EXPECT_THAT(ticks(1.0f, 1.0f, false, 4), IsEmpty());
}

TEST(Growth, PlaysToItsEndAndThenShowsAll) {
  GrowthTime growth{.all = false, .moment = 0, .playing = true};
  int frames = 0;
  while (advanceGrowth(growth, 6000, 1.0 / 60.0)) ++frames;
  EXPECT_EQ(growth, GrowthTime{});
  EXPECT_NEAR(frames, 600, 2) << "ten seconds";
  EXPECT_FALSE(advanceGrowth(growth, 6000, 1.0));
  growth = {.all = false, .moment = 0, .playing = true};
  EXPECT_TRUE(advanceGrowth(growth, 3, 0.0)) << "few vectors are one a frame";
  EXPECT_EQ(growth.moment, 1U);
}

TEST(Growth, MomentsRunThroughThePasses) {
  const std::uint32_t lengths[] = {3, 0, 2};
  EXPECT_EQ(momentsOf(lengths), 5U);
  EXPECT_EQ(birthAt(lengths, 0), (BirthTime{0, 0}));
  EXPECT_EQ(birthAt(lengths, 1), (BirthTime{0, 0}));
  EXPECT_EQ(birthAt(lengths, 3), (BirthTime{0, 2}));
  EXPECT_EQ(birthAt(lengths, 4), (BirthTime{2, 0}));
  EXPECT_EQ(birthAt(lengths, 5), (BirthTime{2, 1}));
  EXPECT_EQ(momentText(lengths, 3), "seed, 3 of 3");
  EXPECT_EQ(momentText(lengths, 5), "pass 2, 2 of 2");
  EXPECT_EQ(momentText({}, 0), "");
}

TEST(OverlaySettings, AreTheStylesOwnUntilTheyAreTouched) {
  OverlaySettings settings;
  const OverlayStyle usual;
  OverlayStyle style = overlayStyle(settings, {}, {});
  EXPECT_EQ(style.indirectMarkers.shown, usual.indirectMarkers.shown);
  EXPECT_EQ(style.zones.opacity, usual.zones.opacity);
  EXPECT_EQ(style.mostShown, usual.mostShown);
  EXPECT_FALSE(style.until);

  settings.layer(OverlayKind::MirrorImages) = {.shown = true, .size = 2.0f, .opacity = 0.5f};
  settings.growth = {.all = false, .moment = 4};
  const std::uint32_t lengths[] = {3, 2};
  const RecordRef selected{.light = kNone, .number = 7};
  style = overlayStyle(settings, lengths, {selected});
  EXPECT_TRUE(style.mirrorImages.shown);
  EXPECT_EQ(style.mirrorImages.size, 2.0f);
  EXPECT_EQ(style.until, (BirthTime{1, 0}));
  EXPECT_THAT(style.selected, ElementsAre(selected));
  settings.shown = false;
  EXPECT_FALSE(overlayStyle(settings, lengths, {}).indirectMarkers.shown);
}

TEST(OverlaySettings, AsManyVectorsToAnAreaOfTheScreen) {
  const auto most = [](double width, double height) {
    OverlaySettings settings;
    settings.mostRecords = 2000;
    return fittedTo(settings, width * height).mostRecords;
  };
  EXPECT_EQ(most(640, 640), 2000);
  EXPECT_EQ(most(700, 700), 2000);
  EXPECT_EQ(most(1280, 640), 4000);
  EXPECT_EQ(most(320, 320), 500);
  EXPECT_EQ(most(1e6, 1e6), 64'000) << "no more than lie in the window";
  EXPECT_EQ(most(0, 0), 1);
}

class AppliedActions : public testing::Test {
 protected:
  AppliedActions() {
    static const OverlayBatch overlay = someOverlay();
    input_ = richInput(overlay);
    ImGui::CreateContext();
  }
  ~AppliedActions() override { ImGui::DestroyContext(); }

  void apply(ActionId id) { applyAction(id, workspace_, input_, state_, output_); }

  Workspace workspace_;
  PanelInput input_;
  PanelState state_;
  PanelOutput output_;
};

TEST_F(AppliedActions, EachIsCarriedOutHereOrHandedOn) {
  workspace_.selection.records.push_back(RecordRef{.light = kNone, .number = 3});
  workspace_.selection.pixel = PixelRef{3, 4};
  for (const ActionInfo& info : actionTable()) {
    const Workspace before = workspace_;
    output_ = {};
    ASSERT_NO_THROW(apply(info.id)) << info.name;
    if (info.owner == ActionOwner::Window) {
      EXPECT_THAT(output_.actions, ElementsAre(info.id)) << info.name;
      EXPECT_EQ(workspace_, before) << info.name;
    } else {
      EXPECT_THAT(output_.actions, IsEmpty()) << info.name;
    }
  }
}

TEST_F(AppliedActions, SaysWhyNot) {
  const PanelInput empty;
  for (const ActionId id :
       {ActionId::Undo, ActionId::Redo, ActionId::Reload, ActionId::Export, ActionId::CameraFrame,
        ActionId::CompareFlip, ActionId::RecordsDelete, ActionId::GrowthPlay, ActionId::CameraNext}) {
    const ActionStatus status = actionStatus(id, workspace_, empty, state_);
    EXPECT_THAT(status.whyNot, testing::EndsWith(".")) << actionInfo(id).name;
    applyAction(id, workspace_, empty, state_, output_);
  }
  EXPECT_THAT(output_.actions, IsEmpty());
  EXPECT_EQ(workspace_, Workspace{});
}

TEST_F(AppliedActions, SwitchesGoThereAndBack) {
  for (const ActionInfo& info : actionTable()) {
    if (info.owner == ActionOwner::Window || viewOfAction(info.id) || info.id == ActionId::Fit) continue;
    const auto before = actionStatus(info.id, workspace_, input_, state_).checked;
    if (!before) continue;
    apply(info.id);
    EXPECT_NE(actionStatus(info.id, workspace_, input_, state_).checked, before) << info.name;
    apply(info.id);
    EXPECT_EQ(actionStatus(info.id, workspace_, input_, state_).checked, before) << info.name;
  }
}

TEST_F(AppliedActions, ZoomKeepsTheMiddleWhereItIs) {
  apply(ActionId::OneToOne);
  workspace_.display.placement.pan = {10.0f, -4.0f};
  apply(ActionId::ZoomIn);
  EXPECT_EQ(workspace_.display.placement.zoom, 2.0f);
  EXPECT_EQ(workspace_.display.placement.pan, Vec2(20.0f, -8.0f));
  for (int i = 0; i < 40; ++i) apply(ActionId::ZoomIn);
  EXPECT_EQ(workspace_.display.placement.zoom, 128.0f);
  apply(ActionId::Fit);
  EXPECT_TRUE(workspace_.display.placement.fit);
}

TEST_F(AppliedActions, FullComputationTakesThePlaceOfVectorsAndGivesItBack) {
  apply(ActionId::FullComputation);
  EXPECT_EQ(workspace_.setup.parameters.picture.method, Method::Naive);
  apply(ActionId::FullComputation);
  EXPECT_EQ(workspace_, Workspace{});
}

TEST_F(AppliedActions, ColoursOfCostShowWhatTheyColour) {
  OverlaySettings& overlays = workspace_.display.overlays;
  overlays.shown = false;
  overlays.layer(OverlayKind::Ilv).shown = false;
  apply(ActionId::ColorByCost);
  EXPECT_EQ(overlays.coloring, VectorColoring::Cost);
  EXPECT_TRUE(overlays.shown && overlays.layer(OverlayKind::Ilv).shown);
  apply(ActionId::ColorByCost);
  EXPECT_EQ(overlays.coloring, OverlaySettings{}.coloring);
  EXPECT_TRUE(overlays.shown) << "they are looked at";
}

TEST_F(AppliedActions, ResettingParametersGoesToTheScenesOwn) {
  input_.scene->start.vectors.ilv.nMin = 6;
  apply(ActionId::PresetDraft);
  apply(ActionId::RulesPaper);
  EXPECT_EQ(workspace_.setup.parameters.vectors.rules, Rules::Paper);
  apply(ActionId::ResetParameters);
  EXPECT_EQ(workspace_.setup.parameters, input_.scene->start);
}

}  // namespace
}  // namespace lightvane
