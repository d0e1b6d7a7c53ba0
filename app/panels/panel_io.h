#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/panels/actions.h"
#include "app/panels/key_map.h"
#include "app/panels/path_completion.h"
#include "app/panels/trade_io.h"
#include "app/panels/workspace.h"
#include "core/inspect/change_estimate.h"
#include "core/inspect/error_sources.h"
#include "core/inspect/full_computation.h"
#include "core/inspect/overlay.h"
#include "core/inspect/pixel_report.h"
#include "core/inspect/record_report.h"
#include "core/inspect/view_image.h"
#include "core/render/parameters.h"
#include "core/scene/scene_needs.h"

namespace lightvane {

// What panels are given in a frame and what they answer. All of it is values, gathered by the window's loop.

/// What the rendering did so far, of the frame that is shown.
struct RenderStatus {
  int pass = 0;
  std::string stage;                  ///< "stride 8"
  double fraction = 0.0;              ///< of the whole work, 0 to 1
  std::optional<double> secondsLeft;  ///< estimated
  std::uint64_t ilvRecords = 0;
  std::uint64_t dlvRecords = 0;
  double hitRate = 0.0;  ///< of the points looked at, answered by interpolation
  double raysPerSecond = 0.0;
  std::uint64_t memoryBytes = 0;
  std::uint64_t faultySamples = 0;  ///< NaN, infinite or negative: left out
  std::string faultHint = {};       ///< how to make one of them again; empty where there is none
  std::uint64_t unanswered = 0;     ///< points without an answer, with the cache locked
  bool complete = false;
  bool paused = false;
  bool stopped = false;
  std::string loading = {};    ///< what is being loaded, and how far that is; empty otherwise
  std::string reference = {};  ///< how far the reference is that is being traced; empty otherwise
};

struct SceneLight {
  std::string name;         ///< as lightName says, never empty
  bool hasVectors = false;  ///< has a tree of DLVs
};

/// What panels must know of a scene.
struct SceneSummary {
  std::filesystem::path path;
  std::string unit = "m";  ///< of the scene's lengths, as lengthUnit(scene) says
  double metresPerUnit = 1.0;
  double diagonalMetres = 1.0;
  std::vector<SceneLight> lights;
  std::vector<std::string> cameras;
  SceneNeeds needs;
  Parameters start;  ///< the parameters that the scene's file and the command line ask for
};

/// The view on the screen, beside its pixels.
struct ShownView {
  PictureView view = PictureView::Beauty;
  ViewKind kind = ViewKind::Radiance;
  std::string title;
  std::string unit;
  ViewScale scale;  ///< as it is drawn
  std::vector<ViewCategory> categories;
  bool isEmpty = false;  ///< there is nothing to show: the title says why
};

/// What is under the mouse on the picture.
struct CursorInfo {
  PixelRef pixel;
  std::vector<std::string> lines;  ///< "0.82 0.41 0.13 W m^-2 sr^-1", "interpolated from 6 vectors"
};

enum class Severity : std::uint8_t { Note, Warning, Error };

/// Something to be told, once.
struct Notice {
  std::uint64_t id = 0;  ///< rises
  Severity severity = Severity::Note;
  std::string text;  ///< where, what, and how to mend it
  double ageSeconds = 0.0;
};

/// A kind of file that can be written.
struct ExportFormat {
  std::string extension;    ///< ".png"
  std::string description;  ///< "PNG: the view as it is shown, 8 bits"
  bool takesOverlay = false;
};

/// A picture to compare with.
struct Rival {
  bool available = false;
  std::string text;  ///< what it is, or why there is none: "pass 7, A since then: ilv.n_min 4 -> 8"
};

/// The command line that gives a picture without the window.
struct ExportCommand {
  std::string line;
  std::string note;  ///< what of the picture it does not give; empty where it gives all
  /// The vectors that it begins with, which an export writes beside the picture; empty where there are none.
  std::filesystem::path cache = {};
};

struct PanelInput {
  double timeSeconds = 0.0;  ///< since the start; for what plays or fades
  float monitorScale = 1.0f;
  RenderStatus status;
  std::optional<SceneSummary> scene;      ///< nothing while none is loaded
  std::optional<ShownView> shown;         ///< nothing before the first picture
  const OverlayBatch* overlay = nullptr;  ///< its legend and notes are shown; null where nothing is drawn
  std::optional<CursorInfo> cursor;
  std::vector<Notice> notices;  ///< the oldest first
  std::vector<std::filesystem::path> recentFiles;
  std::vector<ExportFormat> exportFormats;
  /// Of the picture once it was exported to a path: the command may name vectors that are written beside it.
  /// Empty before the first picture.
  std::function<ExportCommand(const std::filesystem::path&)> exportCommand;
  /// For each pass of the snapshot that is shown, 1 + the largest Birth::order in it: the time slider's
  /// scale.
  std::vector<std::uint32_t> passLengths;
  // What is known of the selection, of the frame that is shown; null where nothing is selected or not ready
  // yet.
  const Scene* compiledScene = nullptr;  ///< names and units of the reports
  const PixelReport* pixel = nullptr;
  const RecordReport* record = nullptr;
  const FullComputation* full = nullptr;  ///< of the selected pixel
  bool selectionIsPinned = false;         ///< every selected vector
  std::string fullProgress;               ///< of one that is under way: "120 of 1,024 samples"; else empty
  Rival kept;
  Rival reference;
  Rival tradePoint;  ///< of the Trade panel, the one that was clicked
  TradeStatus trade;
  bool tracesReference = false;                      ///< at the moment
  std::shared_ptr<const ErrorSources> errorSources;  ///< where its error comes from; null where not known
  std::string errorSourcesNote;                      ///< how far that is; else empty
  std::string errorNote;  ///< how far off the picture is, as far as that is known; else empty
  /// Where the indirect light shown was computed with other light settings than those set now.
  bool indirectIsStale = false;
  std::string undoLabel, redoLabel;  ///< empty where there is nothing to undo or redo
  /// What these parameters would cost in vectors. Asked for what the mouse is over, every frame: the answer
  /// must be at hand. Nothing where it is not known; empty where nobody can tell.
  std::function<std::optional<ChangeEstimate>(const Parameters&)> estimateChange;
  /// completePath of path_completion.h; panels read no folders themselves. Empty: nothing is completed.
  std::function<PathCompletion(const std::string&)> completePath;
  const KeyMap* keys = nullptr;  ///< never null in a frame

  const Rival& rival(CompareWith with) const {
    return with == CompareWith::Kept ? kept : with == CompareWith::Reference ? reference : tradePoint;
  }
};

struct OpenFileRequest {
  std::filesystem::path path;
};
struct ExportRequest {
  std::filesystem::path path;
  bool withOverlay = false;
};

/// What is asked of the window's loop, beside what changed in the workspace.
struct PanelOutput {
  std::vector<ActionId> actions;  ///< those that ActionOwner::Window carries out
  std::optional<OpenFileRequest> open;
  std::optional<ExportRequest> exported;
  std::optional<std::string> clipboard;
  std::vector<std::uint64_t> dismissedNotices;
  std::optional<std::size_t> goToCamera;  ///< index into SceneSummary::cameras
  std::optional<TradePlan> measureTrade;  ///< begins anew
  bool useTradeReference = false;         ///< as it is, though its noise is larger than was asked for
  bool stopTrade = false;                 ///< what was measured stays
  bool clearTrade = false;
  std::optional<std::size_t> showTradePoint;  ///< index into TradeStatus::sweep: its picture is shown
  bool refreshIndirect = false;               ///< gather indirect light anew, under the light settings
  /// Vectors to cross out: what the mouse is over would make them stale, or says that they are.
  StaleKinds stale;
  /// A control is held by the mouse: what changes is one step of the history.
  bool gesture = false;
  /// Something moves by itself: another frame is needed soon, whatever the user does.
  bool animates = false;
};

}  // namespace lightvane
