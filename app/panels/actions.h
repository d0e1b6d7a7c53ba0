#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/inspect/view_image.h"

namespace lightvane {

/// Everything that a key, a menu or the command palette can do.
enum class ActionId : std::uint8_t {
  // File
  Open,
  Reload,
  AutoReload,
  Export,
  SaveSession,
  CopyCommand,
  CopyView,
  Quit,
  // Edit
  Undo,
  Redo,
  PresetDraft,
  PresetBalanced,
  PresetFine,
  RulesPrinted,
  RulesPaper,
  RulesRefined,
  ResetParameters,
  // Render
  Pause,
  Stop,
  Restart,
  LockCache,
  FullComputation,
  // View
  ViewBeauty,
  ViewDirect,
  ViewIndirect,
  ViewSpecular,
  ViewWhereComputed,
  ViewVectorsUsed,
  ViewNearestRecord,
  ViewError,
  ViewEstimatedError,
  ViewErrorSources,
  ViewAlbedo,
  ViewNormal,
  ViewDepth,
  ExposureUp,
  ExposureDown,
  ExposureReset,
  Fit,
  OneToOne,
  ZoomIn,
  ZoomOut,
  Legend,
  // Camera
  CameraHome,
  CameraFrame,
  CameraNext,
  CameraPrevious,
  // Compare
  CompareKeep,
  CompareFlip,
  CompareSwap,
  CompareSideBySide,
  CompareWipe,
  CompareDifference,
  ReferenceTrace,
  // Vectors
  OverlayAll,
  OverlayIlv,
  OverlayIlvZones,
  OverlayIlvGradients,
  OverlayDlv,
  OverlayDlvRadius,
  OverlayDlvDirections,
  OverlayMirrorImages,
  ColorByCost,
  GrowthPlay,
  ComputeHere,
  RecordsPin,
  RecordsRecompute,
  RecordsDelete,
  // Window
  Close,
  Palette,
  Help,
  Notices,
  SideBars,
  TabParameters,
  TabView,
  TabOverlays,
  TabLights,
  TabInspector,
  TabTrade,
  SwitchTheme,
  LargerUi,
  SmallerUi,
  NormalUi,
  FullScreen,
  Count
};
inline constexpr std::size_t kActionCount = static_cast<std::size_t>(ActionId::Count);

/// A menu each, in this order.
enum class ActionGroup : std::uint8_t { File, Edit, Render, View, Camera, Compare, Vectors, Window };
inline constexpr std::array<const char*, 8> kActionGroupNames{"File",   "Edit",    "Render",  "View",
                                                              "Camera", "Compare", "Vectors", "Window"};

/// Who carries an action out.
enum class ActionOwner : std::uint8_t {
  Values,  ///< applyAction: it changes the workspace or what is open in the panels
  Window   ///< the window's loop: it needs the session, files, the clipboard or the undo history
};

struct ActionInfo {
  ActionId id;
  ActionGroup group;
  ActionOwner owner;
  const char* name;   ///< in the file of keys: "edit.undo"
  const char* label;  ///< in menus
  const char* help;   ///< one sentence
  const char* keys;   ///< default chords, separated by spaces; may be empty
  /// Acts while a text field has the keyboard, too.
  bool whileTyping = false;
  /// A separator stands before it in its menu.
  bool startsSection = false;
};

/// The table, in the order of the menus; one entry for each ActionId, at its own number.
std::span<const ActionInfo, kActionCount> actionTable();
const ActionInfo& actionInfo(ActionId id);
std::optional<ActionId> actionNamed(std::string_view name);

/// The action that shows a view, and the view that an action shows.
ActionId actionOfView(PictureView view);
std::optional<PictureView> viewOfAction(ActionId id);

}  // namespace lightvane
