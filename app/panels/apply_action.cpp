#include "app/panels/apply_action.h"

#include <algorithm>
#include <cmath>

#include <imgui.h>

#include "core/base/check.h"

namespace lightvane {
namespace {

constexpr float kExposureStep = 1.0f / 3.0f;
constexpr float kUiScaleStep = 1.125f;
constexpr float kLeastUiScale = 0.6f;
constexpr float kLargestUiScale = 3.0f;
constexpr float kLeastZoom = 1.0f / 64.0f;
constexpr float kLargestZoom = 128.0f;

std::optional<OverlayKind> overlayOf(ActionId id) {
  const auto first = static_cast<int>(ActionId::OverlayIlv);
  const auto number = static_cast<int>(id) - first;
  if (number < 0 || number >= static_cast<int>(kOverlayKinds)) return std::nullopt;
  return static_cast<OverlayKind>(number);
}
static_assert(static_cast<int>(ActionId::OverlayMirrorImages) - static_cast<int>(ActionId::OverlayIlv) ==
                  static_cast<int>(OverlayKind::MirrorImages),
              "overlays and the actions that switch them come in the same order");

std::optional<PanelTab> tabOf(ActionId id) {
  const auto number = static_cast<int>(id) - static_cast<int>(ActionId::TabParameters);
  if (number < 0 || number >= static_cast<int>(kPanelTabs)) return std::nullopt;
  return static_cast<PanelTab>(number);
}
static_assert(static_cast<int>(ActionId::TabTrade) - static_cast<int>(ActionId::TabParameters) ==
                  static_cast<int>(PanelTab::Trade),
              "tabs and the actions that show them come in the same order");

std::optional<CompareMode> compareModeOf(ActionId id) {
  switch (id) {
    case ActionId::CompareSideBySide:
      return CompareMode::SideBySide;
    case ActionId::CompareWipe:
      return CompareMode::Wipe;
    case ActionId::CompareDifference:
      return CompareMode::Difference;
    default:
      return std::nullopt;
  }
}

std::string whyNoRival(const Workspace& workspace, const PanelInput& input) {
  const CompareWith with = workspace.display.comparison.with;
  if (input.rival(with).available) return {};
  if (with == CompareWith::Point) return "No point of a trade is selected.";
  return with == CompareWith::Kept ? "No picture was kept as B yet." : "There is no reference yet.";
}

/// Why an action cannot be taken; empty where it can.
std::string whyNot(ActionId id, const Workspace& workspace, const PanelInput& input) {
  using enum ActionId;
  const bool scene = input.scene.has_value();
  const bool picture = input.shown.has_value();
  switch (id) {
    case Undo:
      return input.undoLabel.empty() ? "There is nothing to take back." : "";
    case Redo:
      return input.redoLabel.empty() ? "There is nothing to make again." : "";
    case Stop:
      return scene || !input.status.loading.empty() ? "" : "Nothing is under way.";
    case Reload:
    case Pause:
    case Restart:
    case CameraHome:
    case CopyView:
    case CopyCommand:
    case AutoReload:
    case SaveSession:
    case ReferenceTrace:
      return scene ? "" : "No scene is open.";
    case ExposureUp:
    case ExposureDown:
    case ExposureReset:
      return picture && input.shown->kind != ViewKind::Radiance
                 ? "This view shows no light: it has no exposure."
                 : "";
    case Export:
    case CompareKeep:
      return picture ? "" : "There is no picture yet.";
    case CameraFrame:
      if (!scene) return "No scene is open.";
      return workspace.selection.pixel || !workspace.selection.records.empty() ? "" : "Nothing is selected.";
    case CameraNext:
    case CameraPrevious:
      return scene && input.scene->cameras.size() > 1 ? "" : "The scene has no other camera.";
    case CompareSwap:
      return input.kept.available ? "" : "No picture was kept as B yet.";
    case CompareFlip:
    case CompareSideBySide:
    case CompareWipe:
    case CompareDifference:
      return whyNoRival(workspace, input);
    case ComputeHere:
      return workspace.selection.pixel ? "" : "No pixel is selected.";
    case RecordsPin:
    case RecordsRecompute:
    case RecordsDelete:
      return workspace.selection.records.empty() ? "No vector is selected." : "";
    case GrowthPlay:
      return momentsOf(input.passLengths) > 0 ? "" : "There are no vectors yet.";
    default:
      return {};
  }
}

std::optional<bool> isOn(ActionId id, const Workspace& workspace, const PanelInput& input,
                         const PanelState& state) {
  const Display& display = workspace.display;
  if (const auto view = viewOfAction(id)) return display.view == *view;
  if (const auto overlay = overlayOf(id)) return display.overlays.layer(*overlay).shown;
  if (const auto mode = compareModeOf(id)) return display.comparison.mode == *mode;
  switch (id) {
    case ActionId::Pause:
      return input.status.paused;
    case ActionId::AutoReload:
      return display.reloads;
    case ActionId::LockCache:
      return workspace.setup.cacheLocked;
    case ActionId::FullComputation:
      return workspace.setup.parameters.picture.method == Method::Naive;
    case ActionId::ColorByCost:
      return display.overlays.coloring == VectorColoring::Cost;
    case ActionId::ReferenceTrace:
      return input.tracesReference;
    case ActionId::RecordsPin:
      return input.selectionIsPinned;
    case ActionId::Legend:
      return display.legend;
    case ActionId::Fit:
      return display.placement.fit;
    case ActionId::CompareFlip:
      return display.comparison.flipped;
    case ActionId::OverlayAll:
      return display.overlays.shown;
    case ActionId::GrowthPlay:
      return display.overlays.growth.playing;
    case ActionId::Palette:
      return state.palette.open;
    case ActionId::Help:
      return state.help.open;
    case ActionId::Notices:
      return state.notices.listOpen;
    case ActionId::SideBars:
      return display.sideBars;
    case ActionId::SwitchTheme:
      return display.theme == Theme::Bright;
    case ActionId::FullScreen:
      return display.fullScreen;
    default:
      return std::nullopt;
  }
}

void zoomBy(PicturePlacement& placement, float factor) {
  const float zoom = std::clamp(placement.zoom * factor, kLeastZoom, kLargestZoom);
  placement.pan *= zoom / placement.zoom;
  placement.zoom = zoom;
  placement.fit = false;
}

void switchOverlay(OverlaySettings& overlays, OverlayKind kind) {
  OverlaySwitch& layer = overlays.layer(kind);
  layer.shown = !layer.shown;
  // Who asks for one kind wants to see it.
  if (layer.shown) overlays.shown = true;
}

void switchColoringByCost(OverlaySettings& overlays) {
  if (overlays.coloring == VectorColoring::Cost) {
    overlays.coloring = OverlaySettings{}.coloring;
    return;
  }
  overlays.coloring = VectorColoring::Cost;
  overlays.layer(OverlayKind::Ilv).shown = true;
  overlays.shown = true;
}

void togglePlaying(GrowthTime& growth, std::uint64_t moments) {
  growth.playing = !growth.playing;
  if (!growth.playing) return;
  // From the beginning, where there is nothing left to play.
  if (growth.all || growth.moment >= moments) growth.moment = 0;
  growth.all = false;
}

void openDialog(PanelState& state) {
  state.openDialog = OpenDialogState{.open = true, .takeFocus = true};
  state.exportDialog.open = false;
}

void openExportDialog(PanelState& state) {
  state.exportDialog.open = true;
  state.exportDialog.takeFocus = true;
  state.exportDialog.error.clear();
  state.openDialog.open = false;
}

void showTab(PanelTab tab, Display& display, PanelState& state) {
  display.sideBars = true;
  (isLeftTab(tab) ? state.leftTab : state.rightTab) = tab;
  state.onlyTab = tab;
}

void applyToDisplay(ActionId id, Display& display, const PanelInput& input) {
  using enum ActionId;
  switch (id) {
    case Fit:
      display.placement = PicturePlacement{};
      return;
    case OneToOne:
      display.placement = PicturePlacement{.fit = false};
      return;
    case ZoomIn:
      return zoomBy(display.placement, 2.0f);
    case ZoomOut:
      return zoomBy(display.placement, 0.5f);
    case Legend:
      display.legend = !display.legend;
      return;
    case AutoReload:
      display.reloads = !display.reloads;
      return;
    case CompareFlip:
      display.comparison.flipped = !display.comparison.flipped;
      return;
    case OverlayAll:
      display.overlays.shown = !display.overlays.shown;
      return;
    case ColorByCost:
      return switchColoringByCost(display.overlays);
    case GrowthPlay:
      return togglePlaying(display.overlays.growth, momentsOf(input.passLengths));
    case SideBars:
      display.sideBars = !display.sideBars;
      return;
    case SwitchTheme:
      display.theme = display.theme == Theme::Dark ? Theme::Bright : Theme::Dark;
      return;
    case LargerUi:
      display.uiScale = std::min(display.uiScale * kUiScaleStep, kLargestUiScale);
      return;
    case SmallerUi:
      display.uiScale = std::max(display.uiScale / kUiScaleStep, kLeastUiScale);
      return;
    case NormalUi:
      display.uiScale = 1.0f;
      return;
    case FullScreen:
      display.fullScreen = !display.fullScreen;
      return;
    default:
      LV_CHECK(false, "the action {} is in the table as one of values", actionInfo(id).name);
  }
}

void applyToSetup(ActionId id, Setup& setup, const PanelInput& input) {
  Parameters& parameters = setup.parameters;
  switch (id) {
    case ActionId::PresetDraft:
      return applyPreset(parameters, Preset::Draft);
    case ActionId::PresetBalanced:
      return applyPreset(parameters, Preset::Balanced);
    case ActionId::PresetFine:
      return applyPreset(parameters, Preset::Fine);
    case ActionId::RulesPrinted:
      return applyRules(parameters.vectors, Rules::Printed);
    case ActionId::RulesPaper:
      return applyRules(parameters.vectors, Rules::Paper);
    case ActionId::RulesRefined:
      return applyRules(parameters.vectors, Rules::Refined);
    case ActionId::ResetParameters:
      parameters = input.scene ? input.scene->start : Parameters{};
      return;
    case ActionId::ExposureUp:
    case ActionId::ExposureDown: {
      float& stops = setup.brightness.exposureStops;
      const float step = id == ActionId::ExposureUp ? kExposureStep : -kExposureStep;
      stops = std::clamp(stops + step, -kMaxExposureStops, kMaxExposureStops);
      return;
    }
    case ActionId::ExposureReset:
      setup.brightness.exposureStops = 0.0f;
      return;
    case ActionId::LockCache:
      setup.cacheLocked = !setup.cacheLocked;
      return;
    case ActionId::FullComputation:
      parameters.picture.method =
          parameters.picture.method == Method::Naive ? Method::Vectors : Method::Naive;
      return;
    default:
      LV_CHECK(false, "{} is no action on the setup", actionInfo(id).name);
  }
}

bool isOfSetup(ActionId id) {
  return (id >= ActionId::PresetDraft && id <= ActionId::ResetParameters) || id == ActionId::LockCache ||
         id == ActionId::FullComputation || id == ActionId::ExposureUp || id == ActionId::ExposureDown ||
         id == ActionId::ExposureReset;
}

}  // namespace

ActionStatus actionStatus(ActionId id, const Workspace& workspace, const PanelInput& input,
                          const PanelState& state) {
  return {whyNot(id, workspace, input), isOn(id, workspace, input, state)};
}

void applyAction(ActionId id, Workspace& workspace, const PanelInput& input, PanelState& state,
                 PanelOutput& output) {
  if (!whyNot(id, workspace, input).empty()) return;
  if (actionInfo(id).owner == ActionOwner::Window) {
    output.actions.push_back(id);
    return;
  }
  Display& display = workspace.display;
  if (const auto view = viewOfAction(id)) {
    display.view = *view;
  } else if (const auto overlay = overlayOf(id)) {
    switchOverlay(display.overlays, *overlay);
  } else if (const auto mode = compareModeOf(id)) {
    CompareMode& current = display.comparison.mode;
    current = current == *mode ? CompareMode::Off : *mode;
  } else if (const auto tab = tabOf(id)) {
    showTab(*tab, display, state);
  } else if (isOfSetup(id)) {
    applyToSetup(id, workspace.setup, input);
  } else {
    switch (id) {
      case ActionId::Open:
        return openDialog(state);
      case ActionId::Export:
        return openExportDialog(state);
      case ActionId::Close:
        return closeTopmost(workspace, state);
      case ActionId::Palette:
        state.palette = PaletteState{.open = !state.palette.open, .takeFocus = true};
        return;
      case ActionId::Help:
        state.help = HelpState{.open = !state.help.open, .takeFocus = true};
        return;
      case ActionId::Notices:
        state.notices.listOpen = !state.notices.listOpen;
        return;
      default:
        return applyToDisplay(id, display, input);
    }
  }
}

void closeTopmost(Workspace& workspace, PanelState& state) {
  if (!state.controls.openList.empty()) {
    state.controls.closeList = true;
  } else if (state.palette.open) {
    state.palette.open = false;
  } else if (state.openDialog.open) {
    state.openDialog.open = false;
  } else if (state.exportDialog.open) {
    state.exportDialog.open = false;
  } else if (state.help.open) {
    state.help.open = false;
  } else if (state.notices.listOpen) {
    state.notices.listOpen = false;
  } else if (state.controls.typed) {
    state.controls.typed.reset();
  } else if (ImGui::GetIO().WantTextInput) {
    // ImGui ends typing itself, and puts back what was there before.
  } else if (!state.parameters.filter.empty()) {
    state.parameters.filter.clear();
  } else if (!(workspace.selection == Selection{})) {
    workspace.selection = Selection{};
  } else {
    Comparison& comparison = workspace.display.comparison;
    comparison.flipped = false;
    comparison.mode = CompareMode::Off;
  }
}

}  // namespace lightvane
