#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/canvas.h"
#include "app/document.h"
#include "app/error_explanation.h"
#include "app/error_watch.h"
#include "app/exporter.h"
#include "app/frame_views.h"
#include "app/inspection.h"
#include "app/navigation.h"
#include "app/notice_list.h"
#include "app/panels/history.h"
#include "app/panels/panels.h"
#include "app/picture_metadata.h"
#include "app/record_history.h"
#include "app/reference.h"
#include "app/session_file.h"
#include "app/trade.h"
#include "app/user_files.h"
#include "app/window_settings.h"
#include "core/inspect/change_estimate.h"
#include "core/inspect/record_edit.h"
#include "core/io/cache_file.h"
#include "core/render/session.h"

namespace lightvane {

/// What the window tells the previewer of a frame, beside what ImGui knows.
struct PreviewerInput {
  double timeSeconds = 0.0;
  float monitorScale = 1.0f;
  std::vector<KeyChord> keys;
  std::set<KeyChord> held;  ///< of `keys`, those that only repeat while they are held
  std::vector<std::filesystem::path> dropped;
  Vec3 flight{0.0f};  ///< right, up, forward: the keys that are held, each -1, 0 or 1
  bool wantsClose = false;
};

/// What the previewer asks of the window.
struct PreviewerOutput {
  bool quits = false;
  bool animates = false;  ///< another frame soon, whatever happens
  bool works = false;     ///< something changes without an event: how far it is
  bool watches = false;   ///< the scene is to be read again when hasFileChanged()
  bool fullScreen = false;
  std::optional<std::string> clipboard;
  std::string title;
};

/// The previewer without its window: takes input, draws panels with ImGui's current context, keeps a session
/// at work, and says what is to be drawn. All of it on one thread, which it never lets wait for the renderer
/// or for files.
class Previewer {
 public:
  /// `wake` is called from other threads whenever there is something new to show.
  Previewer(const UserFolders& folders, std::function<void()> wake);

  /// Opens a file in the background: by its ending a scene, a session, vectors for the scene that is open, or
  /// a picture to be the reference.
  void open(const std::filesystem::path& path);
  /// What the names of files end in that can be opened.
  static std::span<const std::string_view> openedEndings();

  /// A frame, between ImGui::NewFrame and ImGui::Render.
  PreviewerOutput update(const PreviewerInput& input);
  /// What is to be drawn under ImGui's own; ImGui's lists are the caller's to add.
  CanvasContent content() const;

  /// What is to be drawn at its own size and given to finishCapture; null where nothing is.
  const Capture* wantedCapture() const { return exporter_.wanted(); }
  void finishCapture(const Image<Color8>& pixels) { exporter_.finish(pixels); }

  void notify(Severity severity, const std::string& text) { notices_.add(severity, text, time_); }
  const Workspace& workspace() const { return workspace_; }
  /// The newest frame that is shown; null before the first.
  std::shared_ptr<const RenderFrame> frame() const { return views_.frame(); }
  bool isLoading() const { return !loader_.loading().empty(); }
  /// Whether the scene's file is another one than was read. Looks at the disk.
  bool hasFileChanged() const { return timeOfChange().has_value(); }
  // What the window says:
  RenderStatus status() const { return currentStatus(); }
  const std::optional<CursorInfo>& cursor() const { return cursor_; }
  const FullComputation* fullComputation() const { return inspection_.full(); }

 private:
  /// A picture to hold others against, with what made it.
  struct Kept {
    RivalPicture picture;
    Setup setup;
  };
  /// That of a point of the Trade panel.
  struct TradePicture {
    std::size_t point = 0;
    RivalPicture picture;
    int reduction = 1;
    std::string text;  ///< its settings
  };
  /// A picture beside the one that is made, as it is shown.
  struct RivalView {
    std::shared_ptr<const ViewImage> view;
    int reduction = 1;
  };
  /// Vectors from a file.
  struct OpenedCache {
    std::shared_ptr<const Scene> scene;  ///< that they were read for
    std::filesystem::path path;
    Expected<CacheContent> content;
  };
  /// Vectors that were computed anew.
  struct Recomputed {
    std::shared_ptr<const RenderFrame> frame;
    std::shared_ptr<const Snapshot> vectors;  ///< null where it was stopped
    std::vector<RecordRef> records;
  };
  struct OpenedSession {
    std::filesystem::path path;
    Expected<SessionFile> content;
  };

  void takeDocument();
  void takeSession();
  void takeCache();
  void takeWritten();
  void takeFrame();
  void takeReference();
  void carryOutTrade(const PanelOutput& output);
  void showTradePoint(std::size_t point);
  /// What is shown now, as a measurement would take it; nothing where no scene is open.
  std::optional<TradeSubject> tradeSubject() const;
  TradeStatus tradeStatus() const;
  void show(Document document);
  void restore(const SessionFile& saved);
  void saveSessionAgain();
  void readVectors(const std::filesystem::path& path);
  /// Of the scene's file, where it is another one than was read.
  std::optional<std::filesystem::file_time_type> timeOfChange() const;
  void reload();
  void reloadIfChanged();
  /// Keeps what somebody changed of the window, and tells what is wrong with the file of it.
  void keepSettings();

  void handleKeys(const PreviewerInput& input, const PanelInput& panels, PanelOutput& output);
  void carryOut(const PanelOutput& output, PreviewerOutput& result);
  void carryOut(ActionId action, PreviewerOutput& result);
  void carryOutFile(ActionId action, PreviewerOutput& result);
  void carryOutRender(ActionId action);
  void carryOutCamera(ActionId action);
  void frameSelection();
  void goTo(const std::optional<Undoable>& state);  ///< of the history; nothing: stays
  void fly(const Vec3& flight, double seconds);
  void navigate();
  void sendRequest();
  SessionRequest requestFor(const Camera& camera) const;
  void write(const ExportRequest& request);
  void writePicture(const ExportRequest& request, const std::shared_ptr<const RenderFrame>& frame);

  PanelInput panelInput(const PreviewerInput& input) const;
  RenderStatus currentStatus() const;
  /// Somebody, or a lack of memory, told the renderer to rest.
  bool isHalted() const;
  /// The picture is what was asked for last, and finished.
  bool isComplete() const;
  /// The picture is being made.
  bool isWorking() const;
  /// As it was asked for, to the last digit.
  CameraDescription cameraOf(const RenderFrame& frame) const;
  /// Of what is shown of the frame, as far as a command line can say it.
  PictureIdentity identityOf(const RenderFrame& frame) const;
  /// In a file: with the vectors that are written beside it, where it began with some.
  PictureIdentity identityOf(const RenderFrame& frame, const std::filesystem::path& path) const;
  ExportCommand exportCommand(const RenderFrame& frame, const std::filesystem::path& path) const;
  /// What a command does not say of a picture that began with vectors, where it names no file of them.
  std::string otherVectorsNote() const;
  /// The difference from a picture that is there.
  bool showsDifference() const;
  PictureView shownView() const;
  bool hasReference() const;
  RivalPicture* rival();
  /// One pixel of it for so many of the picture.
  int reductionOf(const RivalPicture& rival) const;
  ErrorBase errorBase() const;
  Rival describeKept() const;
  Rival describeReference() const;
  Rival describeTradePoint() const;
  /// Picture B or the reference, where the mouse is over it; else null.
  const RivalView* rivalUnderMouse() const;
  void updateCursor();
  void drawMarks(const PanelInput& panels) const;
  void setCamera(const CameraDescription& camera);
  void setCamera(const Camera& camera) { setCamera(describeCamera(document_->scene->normalisation, camera)); }
  void copyCommand(const RenderFrame& frame, PreviewerOutput& result);
  void keepAsB();
  void swapWithB();
  void traceReference();
  void deleteSelected();
  void pinSelected();
  void recomputeSelected();
  void takeRecomputed();
  /// Undo takes this back.
  void noteRecordStep(RecordHistory::Step step, const std::string& label);
  static std::shared_ptr<const RecordHistory::Whole> wholeOf(const RenderFrame& frame);
  /// Does what undo and redo left to be done to vectors, once there is a frame to do it to.
  void takeRecordSteps();
  bool selectionIsPinned() const;
  bool isOfThisSetup(const RenderFrame& frame) const;
  void stepCamera(int step);
  std::vector<Rgb> lightFactors() const;
  PictureStyle pictureStyle(const ViewImage& view) const;
  ShownPicture shownPicture(std::shared_ptr<const ViewImage> view, int reduction,
                            const Placement& placement) const;
  CanvasContent captureContent() const;
  /// Two pictures, each in a half of the picture's area.
  bool isSideBySide() const;
  /// Of the picture that the mouse is over.
  ScreenRect pictureArea() const;
  Placement placementIn(const ScreenRect& area) const;
  Placement placementOfPicture() const { return placementIn(pictureArea()); }
  double pictureAreaInPoints() const;
  Camera compiledCamera() const;

  std::function<void()> wake_;
  RecentFiles recent_;
  WindowSettingsFile settingsFile_;
  WindowSettings shownSettings_;  ///< the window's own, after the last frame: a session may have others
  KeyMap keys_;
  DocumentLoader loader_;
  std::shared_ptr<const Document> document_;
  std::filesystem::file_time_type documentTime_;  ///< of its file, when it was loaded
  double watchTime_ = 0.0;                        ///< when the file was looked at last
  Workspace workspace_;
  History history_;
  PanelState panels_;
  PanelLayout layout_;
  Navigation navigation_;
  std::optional<ScreenRect> dragged_;  ///< a rectangle that is being drawn
  bool overRight_ = false;             ///< of two pictures side by side, where the mouse is, or was pressed
  FrameViews views_;
  Inspection inspection_;
  ErrorWatch errorWatch_;
  ErrorExplanation explanation_;
  std::optional<Kept> kept_;
  std::optional<TradePicture> tradePicture_;
  std::optional<RivalView> rivalView_;
  std::optional<CursorInfo> cursor_;
  NoticeList notices_;
  std::string sessionError_;
  std::string sessionStop_;
  Exporter exporter_;
  BackgroundJob<OpenedCache> cacheFile_;
  BackgroundJob<OpenedSession> sessionFile_;
  std::optional<SessionFile> restored_;  ///< waits for its scene
  std::filesystem::path restoredFrom_;   ///< its file
  bool reloading_ = true;                ///< what the loader brings is the scene that is open, read anew
  std::filesystem::path sessionPath_;    ///< where the session was opened or saved last; empty if nowhere
  BackgroundJob<Recomputed> recomputed_;
  RecordHistory recordHistory_;
  std::vector<RecordHistory::Step> recordSteps_;  ///< wait for a frame
  std::string recordLabel_;                       ///< of what was done since the last update of the history
  Reference reference_;
  TradeMeasurement trade_;
  int framesToSettle_ = 0;  ///< that are drawn after something changed, though nothing else does
  StaleKinds stale_;        ///< vectors that the panels wanted crossed out last
  mutable std::unique_ptr<ChangeEstimator> estimator_;  ///< of the frame that is shown; remembers answers

  bool paused_ = false;
  bool stopped_ = false;
  std::uint64_t restarts_ = 0;
  std::shared_ptr<const Snapshot> cache_;  ///< vectors that take the place of those that the session has
  std::shared_ptr<const PinnedVectors> pinned_;
  std::optional<SessionRequest> requested_;
  std::uint64_t requestNumber_ = 0;
  std::deque<std::pair<std::uint64_t, CameraDescription>> requestCameras_;  ///< by the requests' numbers
  double requestTime_ = 0.0;  ///< when the rendering began, as if it had never been paused
  double pausedTime_ = 0.0;   ///< when it was paused last
  double frameTime_ = 0.0;
  double time_ = 0.0;
  float monitorScale_ = 1.0f;
  bool cameraMoves_ = false;
  std::string gestureLabel_;
  std::uint64_t memoryBytes_ = 0;
  double memoryTime_ = 0.0;  ///< when it was measured

  // Last: its thread is the first to end.
  Session session_;
};

}  // namespace lightvane
