#include "app/panels/actions.h"

namespace lightvane {
namespace {

constexpr bool kTyping = true;
constexpr bool kSection = true;

// What views are called and show is core/inspect's to say.
constexpr std::array<ActionInfo, kActionCount> makeEntries() {
  using enum ActionId;
  using enum ActionGroup;
  constexpr auto kValues = ActionOwner::Values;
  constexpr auto kWindow = ActionOwner::Window;
  return {{
      {Open, File, kValues, "file.open", "Open...",
       "Opens a scene, a session, vectors for it (.lvcache), or a picture to be the reference (.exr, .hdr).",
       "Ctrl+O", kTyping},
      {Reload, File, kWindow, "file.reload", "Reload",
       "Reads the scene's file again; keeps camera and parameters.", "Ctrl+R", kTyping},
      {AutoReload, File, kValues, "file.auto_reload", "Reload by itself",
       "Reads the scene's file again whenever it changes on disk.", ""},
      {ActionId::Export, File, kValues, "file.export", "Export...",
       "Writes the picture, the vectors or the session to a file.", "Ctrl+E", kTyping, kSection},
      {SaveSession, File, kWindow, "file.save_session", "Save session",
       "Saves scene, camera, parameters and view, to open them again.", "Ctrl+S", kTyping},
      {CopyCommand, File, kWindow, "file.copy_command", "Copy command line",
       "Copies the command line that gives this picture without a window.", "Ctrl+Shift+C", kTyping},
      {CopyView, File, kWindow, "file.copy_view", "Copy camera",
       "Copies the camera as it stands, as the [camera] of a scene file.", ""},
      {Quit, File, kWindow, "file.quit", "Quit", "Ends the program.", "Ctrl+Q", kTyping, kSection},

      {Undo, Edit, kWindow, "edit.undo", "Undo",
       "Takes the last change of parameters, lights, camera, vectors or what is shown back.", "Ctrl+Z"},
      {Redo, Edit, kWindow, "edit.redo", "Redo", "Makes the change again that was taken back last.",
       "Ctrl+Shift+Z Ctrl+Y"},
      {PresetDraft, Edit, kValues, "preset.draft", "Preset: draft",
       "Sampling densities for a fast picture; rules stay.", "", false, kSection},
      {PresetBalanced, Edit, kValues, "preset.balanced", "Preset: balanced",
       "The default sampling densities; rules stay.", ""},
      {PresetFine, Edit, kValues, "preset.fine", "Preset: fine",
       "Sampling densities for an accurate picture; rules stay.", ""},
      {RulesPrinted, Edit, kValues, "rules.printed", "Rules: printed",
       "The method as the paper prints it, faults included.", "", false, kSection},
      {RulesPaper, Edit, kValues, "rules.paper", "Rules: paper",
       "The paper's method made stable, nothing else changed.", ""},
      {RulesRefined, Edit, kValues, "rules.refined", "Rules: refined",
       "The method with our refinements: the default.", ""},
      {ResetParameters, Edit, kValues, "parameters.reset", "Reset all parameters",
       "Sets every parameter to what the scene starts with.", "", false, kSection},

      {Pause, Render, kWindow, "render.pause", "Pause",
       "Pauses the rendering after the work at hand, or goes on with it.", "Space"},
      {Stop, Render, kWindow, "render.stop", "Stop",
       "Ends the rendering, or the reading of a scene; what there is stays.", "Ctrl+."},
      {Restart, Render, kWindow, "render.restart", "Restart", "Forgets all vectors and begins again.",
       "Ctrl+Shift+R"},
      {LockCache, Render, kValues, "render.lock_cache", "Lock cache",
       "Interpolates from the vectors that exist and computes no new one.", "K", false, kSection},
      {FullComputation, Render, kValues, "render.full_computation", "Full computation only",
       "Computes every point in full and interpolates nothing, or goes back to vectors. Vectors stay.",
       "Shift+K"},

      {ViewBeauty, View, kValues, "view.beauty", "", "", "1"},
      {ViewDirect, View, kValues, "view.direct", "", "", "2"},
      {ViewIndirect, View, kValues, "view.indirect", "", "", "3"},
      {ViewSpecular, View, kValues, "view.specular", "", "", "4"},
      {ViewWhereComputed, View, kValues, "view.where_computed", "", "", "5"},
      {ViewVectorsUsed, View, kValues, "view.vectors_used", "", "", "6"},
      {ViewNearestRecord, View, kValues, "view.nearest_record", "", "", "7"},
      {ViewError, View, kValues, "view.error", "", "", "8"},
      {ViewEstimatedError, View, kValues, "view.estimated_error", "", "", "Shift+8"},
      {ViewErrorSources, View, kValues, "view.error_sources", "", "", "Shift+9"},
      {ViewAlbedo, View, kValues, "view.albedo", "", "", "9"},
      {ViewNormal, View, kValues, "view.normal", "", "", "0"},
      {ViewDepth, View, kValues, "view.depth", "", "", "Shift+0"},
      {ExposureUp, View, kValues, "exposure.up", "Brighter", "Raises the exposure by a third of a stop.", "]",
       false, kSection},
      {ExposureDown, View, kValues, "exposure.down", "Darker", "Lowers the exposure by a third of a stop.",
       "["},
      {ExposureReset, View, kValues, "exposure.reset", "Camera's exposure",
       "Sets the exposure to the camera's own.", "Backspace"},
      {Fit, View, kValues, "zoom.fit", "Fit", "Shows the whole picture as large as there is room.", "Ctrl+0",
       kTyping, kSection},
      {OneToOne, View, kValues, "zoom.one_to_one", "1:1",
       "Shows each pixel of the picture as one of the screen.", "Ctrl+1", kTyping},
      {ZoomIn, View, kValues, "zoom.in", "Zoom in", "Shows the picture twice as large.", "="},
      {ZoomOut, View, kValues, "zoom.out", "Zoom out", "Shows the picture half as large.", "-"},
      {Legend, View, kValues, "view.legend", "Legend", "Shows what the colours mean, over the picture.", "J",
       false, kSection},

      {CameraHome, Camera, kWindow, "camera.home", "Home", "Goes back to the scene's camera.", "Home"},
      {CameraFrame, Camera, kWindow, "camera.frame", "Frame selection",
       "Moves the camera so that what is selected fills the picture.", "F"},
      {CameraNext, Camera, kWindow, "camera.next", "Next camera", "Goes to the scene's next camera.", "C"},
      {CameraPrevious, Camera, kWindow, "camera.previous", "Previous camera",
       "Goes to the scene's camera before.", "Shift+C"},

      {CompareKeep, Compare, kWindow, "compare.keep", "Keep as B",
       "Keeps this picture and its parameters, to hold others against.", "B"},
      {CompareFlip, Compare, kValues, "compare.flip", "Flip A / B",
       "Shows the other picture in place of this one.", "X"},
      {CompareSwap, Compare, kWindow, "compare.swap", "Swap A and B",
       "Goes on with B's parameters, and keeps this picture as B.", "Shift+X"},
      {CompareSideBySide, Compare, kValues, "compare.side_by_side", "Side by side",
       "Shows both pictures, one beside the other.", "Ctrl+M", false, kSection},
      {CompareWipe, Compare, kValues, "compare.wipe", "Wipe",
       "Shows both pictures on either side of a line that can be dragged.", "M"},
      {CompareDifference, Compare, kValues, "compare.difference", "Difference",
       "Shows by how much the pictures differ.", "Shift+M"},
      {ReferenceTrace, Compare, kWindow, "reference.trace", "Trace reference",
       "Traces paths of this view in the background, for views of the error and to compare with. Pauses and "
       "goes on.",
       "T", false, kSection},

      {OverlayAll, Vectors, kValues, "overlay.all", "Show vectors",
       "Shows or hides everything that is drawn over the picture.", "V"},
      {OverlayIlv, Vectors, kValues, "overlay.ilv", "ILVs", "Shows where indirect light vectors are.", "I",
       false, kSection},
      {OverlayIlvZones, Vectors, kValues, "overlay.ilv_zones", "ILV validity",
       "Shows where each ILV may be used, at true size.", "Z"},
      {OverlayIlvGradients, Vectors, kValues, "overlay.ilv_gradients", "ILV gradients",
       "Shows how the light of each ILV changes along its surface.", "G"},
      {OverlayDlv, Vectors, kValues, "overlay.dlv", "DLVs",
       "Shows where direct light vectors are, in a colour for each light.", "L"},
      {OverlayDlvRadius, Vectors, kValues, "overlay.dlv_radius", "DLV radius",
       "Shows r_max about each DLV, at true size.", "R"},
      {OverlayDlvDirections, Vectors, kValues, "overlay.dlv_directions", "DLV directions",
       "Shows where the light of each DLV comes from, and how much.", "Shift+L"},
      {OverlayMirrorImages, Vectors, kValues, "overlay.mirror_images", "In mirrors",
       "Shows the vectors in planar mirrors, too.", "Shift+V"},
      {ColorByCost, Vectors, kValues, "overlay.color_by_cost", "Colour by cost",
       "Colours ILVs by the rays that each of them took, or by what it serves again.", "Shift+I"},
      {GrowthPlay, Vectors, kValues, "growth.play", "Play growth",
       "Shows the vectors in the order in which they were computed.", "P", false, kSection},
      {ComputeHere, Vectors, kWindow, "pixel.compute_here", "Compute it here",
       "Computes the selected pixel in full, with many samples, and says where the difference comes from.",
       "H", false, kSection},
      {RecordsPin, Vectors, kWindow, "records.pin", "Pin selected",
       "Keeps the selected vectors whatever becomes of the others, or lets them go.", "N", false, kSection},
      {RecordsRecompute, Vectors, kWindow, "records.recompute", "Recompute selected",
       "Computes the selected vectors anew at their places, with other random numbers.", "Shift+N"},
      {RecordsDelete, Vectors, kWindow, "records.delete", "Delete selected",
       "Takes the selected vectors out of the cache.", "Delete"},

      {Close, Window, kValues, "window.close", "Close or cancel",
       "Closes what is open, clears the selection, or ends a comparison. Never quits.", "Esc", kTyping},
      {Palette, Window, kValues, "window.palette", "Command palette",
       "Finds every action and parameter by name.", "Ctrl+P", kTyping},
      {Help, Window, kValues, "window.help", "Help", "Shows all keys.", "F1", kTyping},
      {Notices, Window, kValues, "window.notices", "Messages", "Lists warnings and errors.", "F2", kTyping},
      {SideBars, Window, kValues, "window.side_bars", "Side bars", "Shows or hides the side bars.", "F9",
       kTyping, kSection},
      {TabParameters, Window, kValues, "tab.parameters", "Method", "Goes to the parameters.", "F4", kTyping},
      {TabView, Window, kValues, "tab.view", "View", "Goes to views, exposure and comparison.", "F5",
       kTyping},
      {TabOverlays, Window, kValues, "tab.overlays", "Vectors", "Goes to what is drawn over the picture.",
       "F6", kTyping},
      {TabLights, Window, kValues, "tab.lights", "Lights", "Goes to the lights.", "F7", kTyping},
      {TabInspector, Window, kValues, "tab.inspector", "Inspect",
       "Goes to what a pixel or a vector is made of.", "F8", kTyping},
      {TabTrade, Window, kValues, "tab.trade", "Trade",
       "Goes to what other parameters would cost and bring: error against time.", "F10", kTyping},
      {SwitchTheme, Window, kValues, "window.theme", "Light theme",
       "Changes between the dark and the light theme.", "Ctrl+T", kTyping, kSection},
      {LargerUi, Window, kValues, "window.larger", "Larger controls", "Makes text and controls larger.",
       "Ctrl+=", kTyping},
      {SmallerUi, Window, kValues, "window.smaller", "Smaller controls", "Makes text and controls smaller.",
       "Ctrl+-", kTyping},
      {NormalUi, Window, kValues, "window.normal_size", "Normal controls",
       "Makes text and controls as large as the monitor asks for.", ""},
      {FullScreen, Window, kValues, "window.full_screen", "Full screen",
       "Fills the screen, or goes back to a window.", "F11", kTyping},
  }};
}

constexpr std::array<ActionInfo, kActionCount> kEntries = makeEntries();

constexpr bool tableIsInOrder() {
  for (std::size_t i = 0; i < kEntries.size(); ++i) {
    if (kEntries[i].id != static_cast<ActionId>(i)) return false;
  }
  return true;
}
static_assert(tableIsInOrder(), "actionInfo takes an action's number for its place");

constexpr auto kFirstView = static_cast<unsigned>(ActionId::ViewBeauty);
constexpr auto kLastView = static_cast<unsigned>(ActionId::ViewDepth);
static_assert(kLastView - kFirstView == static_cast<unsigned>(PictureView::Depth),
              "views and the actions that show them come in the same order");

std::array<ActionInfo, kActionCount> makeTable() {
  std::array<ActionInfo, kActionCount> table = kEntries;
  for (const PictureViewInfo& view : pictureViews()) {
    ActionInfo& info = table[static_cast<std::size_t>(actionOfView(view.view))];
    info.label = view.label;
    info.help = view.help;
  }
  return table;
}

}  // namespace

std::span<const ActionInfo, kActionCount> actionTable() {
  static const std::array<ActionInfo, kActionCount> table = makeTable();
  return table;
}

const ActionInfo& actionInfo(ActionId id) { return actionTable()[static_cast<std::size_t>(id)]; }

std::optional<ActionId> actionNamed(std::string_view name) {
  for (const ActionInfo& info : kEntries) {
    if (name == info.name) return info.id;
  }
  return std::nullopt;
}

ActionId actionOfView(PictureView view) {
  return static_cast<ActionId>(kFirstView + static_cast<unsigned>(view));
}

std::optional<PictureView> viewOfAction(ActionId id) {
  const auto number = static_cast<unsigned>(id);
  if (number < kFirstView || number > kLastView) return std::nullopt;
  return static_cast<PictureView>(number - kFirstView);
}

}  // namespace lightvane
