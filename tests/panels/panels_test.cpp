// Every panel, drawn without a window and driven by the mouse.

#include "app/panels/panels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "app/panels/history.h"
#include "app/panels/parameter_info.h"
#include "tests/panels/panel_driver.h"

namespace lightvane {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The driver's own keys and monitor with the rest of a rich input.
void giveRichInput(PanelDriver& driver, const OverlayBatch& overlay) {
  PanelInput rich = richInput(overlay);
  rich.keys = driver.input.keys;
  rich.monitorScale = driver.input.monitorScale;
  rich.timeSeconds = driver.input.timeSeconds;
  driver.input = std::move(rich);
  driver.workspace.setup.lights.resize(driver.input.scene->lights.size());
}

void openAllGroups(PanelState& state) {
  for (const ParameterGroup& group : parameterGroups()) state.parameters.openGroups.insert(group.prefix);
}

std::map<std::string, std::string> textsOf(const Parameters& parameters) {
  std::map<std::string, std::string> texts;
  for (const FieldDescription& row : describeParameters(parameters)) texts[row.field.key] = row.value;
  return texts;
}

/// Keys of the parameters whose text differs.
std::vector<std::string> changedKeys(const Parameters& before, const Parameters& after) {
  std::vector<std::string> keys;
  const auto old = textsOf(before);
  for (const auto& [key, value] : textsOf(after)) {
    if (old.at(key) != value) keys.push_back(key);
  }
  return keys;
}

struct ScreenCase {
  const char* name;
  PanelDriver::Screen screen;
};

class OnEachScreen : public testing::TestWithParam<ScreenCase> {};

void expectNothingClipped(const std::string& what) {
  for (const WidgetPlace& place : Widgets::all()) {
    EXPECT_FALSE(place.isClippedHorizontally())
        << what << ": " << place.name << " from " << place.min.x << " to " << place.max.x << " within "
        << place.clipMin.x << " to " << place.clipMax.x;
  }
}

/// One name, one widget: ImGui would take two of them for one, and tests the wrong one.
void expectNamesAreUnique(const std::string& what) {
  std::set<std::string> names;
  for (const WidgetPlace& place : Widgets::all()) {
    EXPECT_TRUE(names.insert(place.name).second) << what << ": " << place.name;
  }
}

TEST_P(OnEachScreen, EveryPanelIsDrawnAndNothingIsCutOffAtItsSides) {
  const OverlayBatch overlay = someOverlay();
  PanelDriver driver(GetParam().screen);
  giveRichInput(driver, overlay);
  openAllGroups(driver.state);
  for (OverlaySwitch& layer : driver.workspace.display.overlays.layers) layer.shown = true;
  driver.workspace.display.comparison.mode = CompareMode::Wipe;
  driver.workspace.display.scale.fixedRange = true;
  driver.workspace.setup.parameters.vectors.ilv.nMin = 99;  // a contradiction, and changed values
  driver.input.indirectIsStale = true;
  driver.state.trade.selected = 3;
  driver.state.trade.error = "ilv.n_mn=2: no such parameter (did you mean ilv.n_min?)";
  const ActionId tabs[] = {ActionId::TabParameters, ActionId::TabView, ActionId::TabOverlays,
                           ActionId::TabLights, ActionId::TabTrade};
  for (const ActionId tab : tabs) {
    driver.action(tab);
    expectNothingClipped(actionInfo(tab).name);
    expectNamesAreUnique(actionInfo(tab).name);
  }
  for (const ActionId window :
       {ActionId::Help, ActionId::Notices, ActionId::Open, ActionId::Export, ActionId::Palette}) {
    driver.action(window);
    expectNothingClipped(actionInfo(window).name);
    expectNamesAreUnique(actionInfo(window).name);
    driver.action(ActionId::Close);
  }
  EXPECT_GE(driver.layout.picture.width(), 0.35f * GetParam().screen.width);
  EXPECT_GE(driver.layout.picture.height(),
            0.8f * GetParam().screen.height - 40.0f * GetParam().screen.scale);
}

TEST_P(OnEachScreen, NothingIsOpenAndNoSceneIsLoaded) {
  PanelDriver driver(GetParam().screen);
  driver.frames(3);
  expectNothingClipped("empty");
  EXPECT_TRUE(Widgets::find("status.state"));
}

// The longest legend that there is: every reason for a computation, vectors by a scale, and what they have to
// say of themselves.
TEST_P(OnEachScreen, TheLegendSaysAll) {
  OverlayBatch overlay;
  for (const char* text :
       {"ILV: 475 rays", "ILV: 672 rays", "ILV: 949 rays", "ILV: 1,342 rays", "ILV: 1,898 rays", "DLV: light",
        "DLV: no light arrives", "computed for a mirror or glass"})
    overlay.legend.push_back({text, Color8{230, 159, 0, 255}, MarkerShape::Disc});
  overlay.counts = {"every 8th of 17,489 DLVs shown"};
  overlay.notes = {
      "rims of zones: wider where ilv.S_curv lets the surface turn further",
      "zones of 300 ILVs: the others' centres lie in these",
      "gradients (light arrows) point to where it is brighter: a radius long for 100 % over the radius, up "
      "to 200 %"};
  PanelDriver driver(GetParam().screen);
  giveRichInput(driver, overlay);
  driver.input.shown->kind = ViewKind::Categories;
  for (const char* name :
       {"background or light", "interpolated", "full DLV: seed", "direct in full: too few DLVs",
        "direct in full: DLVs too unlike", "full ILV: none yet", "full ILV: distance", "full ILV: curvature",
        "full ILV: too few"})
    driver.input.shown->categories.push_back({name, Color8{86, 180, 233, 255}, true});
  driver.frames(3);
  const auto window = Widgets::find("legend");
  ASSERT_TRUE(window);
  EXPECT_LE(window->max.x, driver.layout.picture.max.x);
  for (const char* name : {"legend.last_entry", "legend.last_note"}) {
    const auto place = Widgets::find(name);
    ASSERT_TRUE(place) << name;
    // At twice the size, the smallest screen has no room for all of it.
    if (GetParam().screen.height / GetParam().screen.scale < 640.0f) continue;
    EXPECT_LE(place->max.x, window->max.x) << name;
    EXPECT_LE(place->max.y, window->max.y) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Screens, OnEachScreen,
                         testing::Values(ScreenCase{"SmallDark", {1024, 640, 1.0f, Theme::Dark}},
                                         ScreenCase{"SmallBright", {1024, 640, 1.0f, Theme::Bright}},
                                         ScreenCase{"SmallScaledDark", {1024, 640, 2.0f, Theme::Dark}},
                                         ScreenCase{"SmallScaledBright", {1024, 640, 2.0f, Theme::Bright}},
                                         ScreenCase{"LargeDark", {2560, 1600, 1.0f, Theme::Dark}},
                                         ScreenCase{"LargeBright", {2560, 1600, 1.0f, Theme::Bright}},
                                         ScreenCase{"LargeScaledDark", {2560, 1600, 2.0f, Theme::Dark}},
                                         ScreenCase{"LargeScaledBright", {2560, 1600, 2.0f, Theme::Bright}}),
                         [](const auto& screen) { return std::string(screen.param.name); });

class Panels : public testing::Test {
 protected:
  Panels() {
    giveRichInput(driver_, overlay_);
    driver_.input.notices.clear();
    driver_.frames(3);
  }

  Parameters& parameters() { return driver_.workspace.setup.parameters; }

  OverlayBatch overlay_ = someOverlay();
  PanelDriver driver_;
};

TEST_F(Panels, EveryParameterAppearsOnceWithItsCostAndTooltip) {
  openAllGroups(driver_.state);
  driver_.frames(2);
  std::map<std::string, int> seen;
  for (const WidgetPlace& place : Widgets::all()) ++seen[place.name];
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string key = row.field.key;
    EXPECT_EQ(seen[key], 1) << key;
    EXPECT_EQ(seen[key + ".cost"], 1) << key;
  }
}

TEST_F(Panels, DraggingANumberChangesThatNumberAlone) {
  openAllGroups(driver_.state);
  driver_.frames(2);
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string key = row.field.key;
    if (row.range.find(" to ") == std::string::npos) continue;
    parameters() = Parameters{};
    const Parameters before = parameters();
    // Towards the side on which there is room.
    driver_.drag(key, 60.0f);
    if (parameters() == before) driver_.drag(key, -60.0f);
    EXPECT_THAT(changedKeys(before, parameters()), ElementsAre(key));
  }
}

TEST_F(Panels, ClickingASwitchChangesThatSwitchAlone) {
  openAllGroups(driver_.state);
  driver_.frames(2);
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string key = row.field.key;
    if (row.range != "true or false") continue;
    parameters() = Parameters{};
    const Parameters before = parameters();
    driver_.click(key);
    EXPECT_THAT(changedKeys(before, parameters()), ElementsAre(key));
    driver_.click(key);
    EXPECT_EQ(parameters(), before) << key;
  }
}

TEST_F(Panels, ChoosingFromAListSetsThatChoice) {
  driver_.click("method.name");
  driver_.click("method.name=path");
  EXPECT_EQ(parameters().picture.method, Method::Path);
  EXPECT_THAT(changedKeys(Parameters{}, parameters()), ElementsAre("method.name"));
}

TEST_F(Panels, RulesSetAllThatTheyName) {
  Parameters expected;
  applyRules(expected.vectors, Rules::Paper);
  driver_.click("method.rules");
  driver_.click("method.rules=paper");
  EXPECT_EQ(parameters(), expected);
  driver_.click("rules.refined");
  EXPECT_EQ(parameters(), Parameters{});
  applyPreset(expected = Parameters{}, Preset::Draft);
  driver_.click("preset.draft");
  EXPECT_EQ(parameters(), expected);
}

TEST_F(Panels, ANumberIsTypedAfterADoubleClick) {
  driver_.doubleClick("ilv.n_min");
  driver_.type("11");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(parameters().vectors.ilv.nMin, 11);
  EXPECT_THAT(changedKeys(Parameters{}, parameters()), ElementsAre("ilv.n_min"));
  EXPECT_FALSE(driver_.state.controls.typed);
}

TEST_F(Panels, ADoubleClickAloneChangesNothing) {
  driver_.doubleClick("ilv.n_min");
  driver_.press(ImGuiKey_Escape);
  EXPECT_EQ(parameters(), Parameters{});
  EXPECT_FALSE(driver_.state.controls.typed);
}

TEST_F(Panels, WhatIsOutOfRangeIsRefusedWithAMessage) {
  driver_.doubleClick("ilv.n_min");
  driver_.type("5000");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(parameters(), Parameters{});
  ASSERT_TRUE(driver_.state.controls.typed);
  EXPECT_EQ(driver_.state.controls.typed->error, "ilv.n_min takes a value from 1 to 1000, not '5000'");
  driver_.frames(2);
  driver_.type("7");  // the field has the keyboard and all of its text is selected
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(parameters().vectors.ilv.nMin, 7);
}

TEST_F(Panels, LengthsGoRoundTheirUnitsAndStayAsLongAsTheyAre) {
  driver_.state.parameters.openGroups.insert("dlv");
  driver_.frames(2);
  driver_.click("dlv.r_max.unit");
  EXPECT_NEAR(parameters().vectors.dlv.rMax.value(), 0.06, 1e-12) << "1.5 % of 4 m";
  EXPECT_FALSE(parameters().vectors.dlv.rMax.isRelative());
  driver_.doubleClick("dlv.r_max");
  driver_.type("8");
  driver_.press(ImGuiKey_Enter);
  EXPECT_NEAR(parameters().vectors.dlv.rMax.value(), 0.08, 1e-12) << "8 of the scene's centimetres";
  driver_.click("dlv.r_max.unit");
  EXPECT_NEAR(parameters().vectors.dlv.rMax.value(), 0.08, 1e-12) << "in metres";
  driver_.click("dlv.r_max.unit");
  EXPECT_NEAR(parameters().vectors.dlv.rMax.value(), 0.02, 1e-12) << "2 % of 4 m";
  EXPECT_TRUE(parameters().vectors.dlv.rMax.isRelative());
}

TEST_F(Panels, ResetGoesToTheScenesValueFirstAndThenToTheDefault) {
  driver_.input.scene->start.vectors.ilv.nMin = 6;
  parameters().vectors.ilv.nMin = 9;
  driver_.frames(2);
  driver_.click("ilv.n_min.reset");
  EXPECT_EQ(parameters().vectors.ilv.nMin, 6);
  driver_.click("ilv.n_min.reset");
  EXPECT_EQ(parameters().vectors.ilv.nMin, 4);
  EXPECT_FALSE(Widgets::find("ilv.n_max.reset")) << "unchanged: nothing to reset";
  parameters().vectors.ilv.rows = 40;
  parameters().picture.seed = 5;
  driver_.frames(2);
  driver_.click("group.ilv.reset");
  EXPECT_EQ(parameters().vectors.ilv.rows, 12);
  EXPECT_EQ(parameters().vectors.ilv.nMin, 6);
  EXPECT_EQ(parameters().picture.seed, 5U);
}

TEST_F(Panels, WhatTheRenderingRunsOnIsSetBelowTheParameters) {
  driver_.click("render.lock_cache");
  EXPECT_TRUE(driver_.workspace.setup.cacheLocked);
  driver_.doubleClick("render.threads");
  driver_.type("3");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(driver_.workspace.setup.threads, 3);
  driver_.click("render.threads.reset");
  EXPECT_EQ(driver_.workspace.setup.threads, 0);
  EXPECT_EQ(parameters(), Parameters{});
}

TEST_F(Panels, TheFilterOpensGroupsAndLeavesWhatFits) {
  driver_.click("parameters.filter");
  driver_.type("roulette");
  driver_.frames(2);
  EXPECT_TRUE(Widgets::find("path.roulette"));
  EXPECT_FALSE(Widgets::find("ilv.n_min"));
  EXPECT_FALSE(Widgets::find("group.naive"));
  driver_.press(ImGuiKey_Escape);
  EXPECT_TRUE(Widgets::find("ilv.n_min"));
}

TEST_F(Panels, AGroupFoldsAndUnfolds) {
  driver_.click("group.ilv");
  EXPECT_FALSE(Widgets::find("ilv.n_min"));
  driver_.click("group.ilv");
  EXPECT_TRUE(Widgets::find("ilv.n_min"));
}

TEST_F(Panels, EstimatesAreAskedForBeforeAChangeIsMade) {
  std::set<int> asked;
  driver_.input.estimateChange = [&](const Parameters& p) {
    asked.insert(p.vectors.ilv.nMin);
    return std::optional(ChangeEstimate{.newIndirect = 1200});
  };
  driver_.hover("ilv.n_min");
  EXPECT_EQ(asked, (std::set<int>{2, 8})) << "half and twice the value";
  EXPECT_EQ(parameters(), Parameters{});
}

TEST_F(Panels, EveryParameterAsksWhatOtherValuesCostWhileTheMouseIsOnIt) {
  openAllGroups(driver_.state);
  driver_.frames(2);
  std::vector<Parameters> asked;
  driver_.input.estimateChange = [&](const Parameters& p) {
    asked.push_back(p);
    return std::optional(ChangeEstimate{.staleIndirect = 7});
  };
  for (const FieldDescription& row : describeParameters(Parameters{})) {
    const std::string key = row.field.key;
    asked.clear();
    driver_.hover(key);
    ASSERT_FALSE(asked.empty()) << key;
    EXPECT_EQ(driver_.output.stale, (StaleKinds{.indirect = true})) << key;
    for (const Parameters& candidate : asked)
      EXPECT_THAT(changedKeys(parameters(), candidate), testing::Contains(key)) << key;
  }
}

/// What the tooltip says, without the breaks of its lines.
std::string shownTooltip() {
  const auto place = Widgets::find("tooltip");
  return place ? place->text : std::string();
}

TEST_F(Panels, EachMethodTellsWhatItReallyCosts) {
  driver_.input.estimateChange = [](const Parameters&) { return std::optional(ChangeEstimate{}); };
  driver_.hover("method.name");
  EXPECT_THAT(shownTooltip(), HasSubstr("naive: a full gather at every visible point, of 128 rays each"));
  EXPECT_THAT(shownTooltip(), HasSubstr("path: 64 paths for each pixel"));
  EXPECT_THAT(shownTooltip(), HasSubstr("the vectors stay"));
  EXPECT_THAT(shownTooltip(), Not(HasSubstr("vectors anew")));
  EXPECT_THAT(shownTooltip(), Not(HasSubstr("no new vector"))) << "that is the least of what rivals cost";
}

TEST_F(Panels, ALightsIntensityTellsItsCost) {
  driver_.action(ActionId::TabLights);
  driver_.hover("light.0.stops");
  EXPECT_THAT(shownTooltip(), HasSubstr("A stop is a factor of two."));
  EXPECT_THAT(shownTooltip(), HasSubstr("Direct light follows at once"));
}

TEST_F(Panels, EveryControlOfTheOverlaySaysThatOnlyTheDisplayFollows) {
  driver_.action(ActionId::TabOverlays);
  for (OverlaySwitch& layer : driver_.workspace.display.overlays.layers) layer.shown = true;
  driver_.frames(2);
  std::vector<std::string> controls;
  for (const WidgetPlace& place : Widgets::all()) {
    const bool isReset = place.name.ends_with(".reset");
    if ((place.name.starts_with("overlay.") || place.name.starts_with("growth.")) && !isReset)
      controls.push_back(place.name);
  }
  ASSERT_GE(controls.size(), 20u);
  for (const std::string& control : controls) {
    driver_.hover(control);
    EXPECT_THAT(shownTooltip(), HasSubstr(costSentence(ChangeCost::Display))) << control;
  }
}

TEST_F(Panels, ADragIsOneStepOfTheHistory) {
  History history(undoableOf(driver_.workspace));
  const int before = driver_.gestures;
  driver_.drag("ilv.n_min", 40.0f);
  EXPECT_GE(driver_.gestures - before, 8) << "frames in which the control was held";
  EXPECT_FALSE(driver_.output.gesture) << "after the mouse was released";
  history.update(undoableOf(driver_.workspace), false);
  EXPECT_THAT(history.undoLabel(), HasSubstr("ilv.n_min 4 -> "));
}

TEST_F(Panels, ThePaletteRunsActions) {
  driver_.action(ActionId::Palette);
  driver_.type("where comp");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(driver_.workspace.display.view, PictureView::WhereComputed);
  EXPECT_FALSE(driver_.state.palette.open);
}

TEST_F(Panels, ThePaletteGoesToAParameterAndLetsItBeTyped) {
  driver_.action(ActionId::TabLights);
  driver_.action(ActionId::Palette);
  driver_.type("roulette");
  driver_.press(ImGuiKey_Enter);
  driver_.frames(3);
  EXPECT_TRUE(driver_.require("path.roulette").isVisible());
  driver_.action(ActionId::Palette);
  driver_.type("dlvrmax");
  driver_.press(ImGuiKey_Enter);
  driver_.frames(3);
  ASSERT_TRUE(driver_.state.controls.typed);
  EXPECT_EQ(driver_.state.controls.typed->control, "dlv.r_max");
  driver_.type("3");
  driver_.press(ImGuiKey_Enter);
  EXPECT_DOUBLE_EQ(parameters().vectors.dlv.rMax.value(), 0.03);
}

TEST_F(Panels, ThePaletteMovesWithTheArrows) {
  driver_.action(ActionId::Palette);
  driver_.type("preset");
  driver_.press(ImGuiKey_DownArrow);
  driver_.press(ImGuiKey_DownArrow);
  driver_.press(ImGuiKey_UpArrow);
  EXPECT_EQ(driver_.state.palette.chosen, 1);
  driver_.action(ActionId::Close);
  EXPECT_FALSE(driver_.state.palette.open);
}

TEST_F(Panels, MenusCarryActionsOutOrHandThemOn) {
  driver_.click("menu.View");
  driver_.click("menu.view.depth");
  EXPECT_EQ(driver_.workspace.display.view, PictureView::Depth);
  driver_.click("menu.Render");
  driver_.click("menu.render.pause");
  EXPECT_THAT(driver_.asked.actions, Contains(ActionId::Pause));
  driver_.click("menu.Camera");
  driver_.click("menu.cameras");
  driver_.click("menu.cameras.1");
  EXPECT_EQ(driver_.asked.goToCamera, 1U);
  driver_.input.kept.available = false;
  driver_.click("menu.Compare");
  driver_.click("menu.compare.swap");
  EXPECT_THAT(driver_.asked.actions, Not(Contains(ActionId::CompareSwap))) << "there is nothing to swap with";
}

TEST_F(Panels, TheViewPanelShowsViewsAndSetsTheScale) {
  driver_.action(ActionId::TabView);
  driver_.click("view.indirect");
  EXPECT_EQ(driver_.workspace.display.view, PictureView::Indirect);
  driver_.drag("exposure", 40.0f);
  EXPECT_GT(driver_.workspace.setup.brightness.exposureStops, 0.0f);
  driver_.click("exposure.reset");
  EXPECT_EQ(driver_.workspace.setup.brightness.exposureStops, 0.0f);
  driver_.click("tone_mapping");
  driver_.click("tone_mapping=Reinhard");
  EXPECT_EQ(driver_.workspace.setup.brightness.toneMapping, ToneMap::Reinhard);
  driver_.click("color_map");
  driver_.click("color_map=cividis");
  EXPECT_EQ(driver_.workspace.display.scale.map, ColorMap::Cividis);
  driver_.click("fixed_range");
  EXPECT_EQ(driver_.workspace.display.scale.high, 42.0f) << "begins where the picture's range was";
  driver_.doubleClick("range.high");
  driver_.type("-5");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(driver_.workspace.display.scale.high, 42.0f) << "below the low end";
}

TEST_F(Panels, TheOverlayPanelSwitchesKindsAndMovesThroughTheirGrowth) {
  driver_.action(ActionId::TabOverlays);
  OverlaySettings& overlays = driver_.workspace.display.overlays;
  overlays.shown = overlays.layer(OverlayKind::IlvZones).shown = false;
  driver_.click("overlay.ilv_zones");
  EXPECT_TRUE(overlays.layer(OverlayKind::IlvZones).shown);
  EXPECT_TRUE(overlays.shown) << "who asks for one kind wants to see it";
  driver_.drag("overlay.ilv_zones.opacity", 30.0f);
  EXPECT_GT(overlays.layer(OverlayKind::IlvZones).opacity, 0.35f);
  driver_.click("overlay.coloring");
  driver_.click("overlay.coloring=energy");
  EXPECT_EQ(overlays.coloring, VectorColoring::Energy);

  driver_.drag("growth.moment", -60.0f);
  EXPECT_FALSE(overlays.growth.all);
  EXPECT_LT(overlays.growth.moment, momentsOf(driver_.input.passLengths));
  const std::uint64_t before = overlays.growth.moment;
  driver_.click("growth.play");
  EXPECT_TRUE(overlays.growth.playing);
  EXPECT_TRUE(driver_.output.animates);
  EXPECT_GT(overlays.growth.moment, before);
  driver_.frames(700);
  EXPECT_EQ(overlays.growth, GrowthTime{}) << "plays to its end, and then shows all";
}

TEST_F(Panels, TheLightsPanelEditsTheLightThatIsClicked) {
  driver_.action(ActionId::TabLights);
  std::vector<LightSetting>& lights = driver_.workspace.setup.lights;
  driver_.click("light.0.solo");
  driver_.click("light.1.mute");
  driver_.drag("light.2.stops", -30.0f);
  EXPECT_TRUE(lights[0].soloed);
  EXPECT_FALSE(lights[0].muted);
  EXPECT_TRUE(lights[1].muted);
  EXPECT_LT(lights[2].stops, 0.0f);
  EXPECT_FALSE(Widgets::find("lights.refresh"));
  driver_.input.indirectIsStale = true;
  driver_.frames(2);
  driver_.click("lights.refresh");
  EXPECT_TRUE(driver_.asked.refreshIndirect);
  driver_.click("lights.reset");
  EXPECT_EQ(lights, std::vector<LightSetting>(3));
}

TEST_F(Panels, TheSideBarsAreDraggedWiderWithinBounds) {
  const float before = driver_.layout.right->width();
  driver_.drag("splitter.right", -50.0f);
  EXPECT_NEAR(driver_.layout.right->width(), before + 50.0f, 2.0f);
  driver_.drag("splitter.right", 2000.0f);
  EXPECT_NEAR(driver_.layout.right->width(), kLeastBarWidth, 2.0f);
  driver_.drag("splitter.left", 30.0f);
  EXPECT_NEAR(driver_.workspace.display.leftWidth, 320.0f, 2.0f);
  driver_.action(ActionId::SideBars);
  EXPECT_FALSE(driver_.layout.right);
}

TEST_F(Panels, TheOpenDialogOpensWhatIsThere) {
  driver_.input.completePath = [](const std::string& typed) {
    PathCompletion completion;
    completion.common = "scenes/";
    if (typed.starts_with("scenes/")) completion.paths = {"scenes/more/", "scenes/a.toml"};
    completion.isFile = typed == "scenes/a.toml";
    return completion;
  };
  driver_.action(ActionId::Open);
  driver_.type("sc");
  driver_.press(ImGuiKey_Tab);
  EXPECT_EQ(driver_.state.openDialog.text, "scenes/");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(driver_.state.openDialog.error, "There is no file 'scenes/'.");
  driver_.frames(3);
  driver_.click("open.found.1");
  ASSERT_TRUE(driver_.asked.open);
  EXPECT_EQ(driver_.asked.open->path, "scenes/a.toml");
  EXPECT_FALSE(driver_.state.openDialog.open);
}

TEST_F(Panels, ANameTypedIntoTheExportDialogReplacesTheOneProposed) {
  // The second time ImGui still knows the field's text and cursor.
  for (const char* name : {"one.png", "two.exr"}) {
    driver_.action(ActionId::Export);
    driver_.frames(2);
    driver_.type(name);
    EXPECT_EQ(driver_.state.exportDialog.path, name);
    driver_.press(ImGuiKey_Enter);
    EXPECT_FALSE(driver_.state.exportDialog.open);
    driver_.frames(2);
  }
}

TEST_F(Panels, TheExportDialogKeepsEndingAndFormatTogether) {
  driver_.action(ActionId::Export);
  EXPECT_EQ(driver_.state.exportDialog.path, "cornell-mirror.png");
  EXPECT_TRUE(Widgets::find("export.overlay"));
  driver_.click("export.format");
  driver_.click("export.format=EXR: all layers");
  EXPECT_EQ(driver_.state.exportDialog.path, "cornell-mirror.exr");
  EXPECT_FALSE(Widgets::find("export.overlay")) << "EXR has none";
  driver_.click("export.path");
  driver_.doubleClick("export.path");  // selects a word; End and Backspace would do as well
  driver_.type("x.gif");
  driver_.press(ImGuiKey_Enter);
  EXPECT_EQ(driver_.state.exportDialog.error, "The file's name must end in .png or .exr.");
  driver_.frames(2);
  for (int i = 0; i < 3; ++i) driver_.press(ImGuiKey_Backspace);  // the field has the keyboard again
  driver_.type("png");
  driver_.press(ImGuiKey_Enter);
  ASSERT_TRUE(driver_.asked.exported);
  EXPECT_EQ(driver_.asked.exported->path, "x.png");
  EXPECT_FALSE(driver_.state.exportDialog.open);
}

TEST_F(Panels, TheExportDialogTellsOfTheVectorsThatTheCommandNeeds) {
  std::set<std::string> there;
  driver_.input.completePath = [&](const std::string& typed) {
    return PathCompletion{{}, typed, there.contains(typed)};
  };
  const auto textOf = [](const char* name) {
    const auto place = Widgets::find(name);
    return place ? place->text : std::string();
  };
  driver_.action(ActionId::Export);
  EXPECT_EQ(textOf("export.cache"), "") << "made from nothing";
  driver_.input.exportCommand = [](const std::filesystem::path& path) {
    return ExportCommand{"lightvane render", "", path.string() + ".lvcache"};
  };
  driver_.frames(2);
  const std::string picture = driver_.state.exportDialog.path;
  EXPECT_THAT(textOf("export.cache"), HasSubstr("It needs " + picture + ".lvcache"));
  EXPECT_THAT(textOf("export.cache"), HasSubstr("Export writes them"));
  EXPECT_EQ(textOf("export.replaces"), "");
  // An export writes two files, and tells of each that it would replace.
  there = {picture + ".lvcache"};
  driver_.frames(2);
  EXPECT_THAT(textOf("export.replaces"), HasSubstr(picture + ".lvcache"));
  there = {picture};
  driver_.frames(2);
  EXPECT_EQ(textOf("export.replaces"), "This file is there already and will be replaced.");
  there = {picture, picture + ".lvcache"};
  driver_.frames(2);
  EXPECT_THAT(textOf("export.replaces"), HasSubstr("This file and its vectors, " + picture + ".lvcache"));
  driver_.click("export.copy");
  EXPECT_EQ(driver_.asked.clipboard, "lightvane render");
}

TEST_F(Panels, EscClosesTheTopmostThingAndNeverQuits) {
  driver_.workspace.selection.pixel = PixelRef{3, 4};
  driver_.workspace.display.comparison.flipped = true;
  driver_.action(ActionId::Help);
  driver_.action(ActionId::Palette);
  driver_.action(ActionId::Close);
  EXPECT_TRUE(driver_.state.help.open);
  driver_.action(ActionId::Close);
  EXPECT_FALSE(driver_.state.help.open);
  EXPECT_TRUE(driver_.workspace.selection.pixel);
  driver_.action(ActionId::Close);
  EXPECT_FALSE(driver_.workspace.selection.pixel);
  EXPECT_TRUE(driver_.workspace.display.comparison.flipped);
  driver_.action(ActionId::Close);
  EXPECT_FALSE(driver_.workspace.display.comparison.flipped);
  driver_.action(ActionId::Close);
  EXPECT_THAT(driver_.asked.actions, IsEmpty());
}

TEST_F(Panels, EscClosesAnOpenListFirst) {
  driver_.workspace.selection.pixel = PixelRef{3, 4};
  driver_.action(ActionId::TabOverlays);
  driver_.frames(2);
  driver_.click("overlay.coloring");
  driver_.frames(2);
  ASSERT_TRUE(Widgets::find("overlay.coloring=age"));
  driver_.action(ActionId::Close);
  driver_.frames(2);
  EXPECT_FALSE(Widgets::find("overlay.coloring=age"));
  EXPECT_TRUE(driver_.workspace.selection.pixel) << "one thing at a time";
}

TEST_F(Panels, NoticesAreShownForAWhileAndPutAwayByAClick) {
  driver_.input.notices = {{7, Severity::Error, "cannot read x.toml", 0.0},
                           {8, Severity::Note, "old", 100.0}};
  driver_.frames(3);
  EXPECT_TRUE(Widgets::find("toast.7"));
  EXPECT_FALSE(Widgets::find("toast.8"));
  driver_.click("toast.7");
  EXPECT_THAT(driver_.asked.dismissedNotices, ElementsAre(7U));
}

TEST_F(Panels, WidgetsAreNotRecordedUnlessAsked) {
  Widgets::setRecording(false);
  driver_.frames();
  EXPECT_THAT(Widgets::all(), IsEmpty());
  EXPECT_EQ(widgetsAsText(), "");
  Widgets::setRecording(true);
  driver_.frames();
  EXPECT_THAT(widgetsAsText(), HasSubstr("menu.File "));
}

}  // namespace
}  // namespace lightvane
