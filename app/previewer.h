#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/canvas.h"
#include "app/document.h"
#include "app/export_job.h"
#include "app/frame_views.h"
#include "app/inspection.h"
#include "app/navigation.h"
#include "app/panels/history.h"
#include "app/panels/panels.h"
#include "app/picture_metadata.h"
#include "app/user_files.h"
#include "core/render/session.h"

namespace lightvane {

/// What the window tells the previewer of a frame, beside what ImGui knows.
struct PreviewerInput {
  double timeSeconds = 0.0;
  float monitorScale = 1.0f;
  std::vector<KeyChord> keys;
  std::vector<std::filesystem::path> dropped;
  Vec3 flight{0.0f};  ///< right, up, forward: the keys that are held, each -1, 0 or 1
  bool wantsClose = false;
};

/// What the previewer asks of the window.
struct PreviewerOutput {
  bool quits = false;
  bool animates = false;  ///< another frame soon, whatever happens
  bool works = false;     ///< it renders: how far, and for how long, changes without an event
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

  /// Loads a scene in the background.
  void open(const std::filesystem::path& path);

  /// A frame, between ImGui::NewFrame and ImGui::Render.
  PreviewerOutput update(const PreviewerInput& input);
  /// What is to be drawn under ImGui's own; ImGui's lists are the caller's to add.
  CanvasContent content() const;

  /// A picture that is to be drawn at its own size and given to finishCapture.
  struct Capture {
    CanvasContent content;
    int width = 0;
    int height = 0;
    std::filesystem::path path;
    std::map<std::string, std::string> metadata;
    std::function<Expected<void>()> writeVectors;  ///< beside it, where the picture began with some
  };
  const std::optional<Capture>& wantedCapture() const { return capture_; }
  void finishCapture(const Image<Color8>& pixels);

  void notify(Severity severity, const std::string& text);
  const Workspace& workspace() const { return workspace_; }
  /// The newest frame that is shown; null before the first.
  std::shared_ptr<const RenderFrame> frame() const { return views_.frame(); }
  bool isLoading() const { return !loader_.loading().empty(); }

 private:
  /// A picture to hold others against.
  struct Kept {
    std::shared_ptr<const RenderFrame> frame;
    Setup setup;
    std::string text;
    std::shared_ptr<const ImageRgb> beauty;
  };

  void takeDocument();
  void show(Document document);
  void takeFrame();
  void handleKeys(const PreviewerInput& input, const PanelInput& panels, PanelOutput& output);
  void carryOut(const PanelOutput& output, PreviewerOutput& result);
  void carryOut(ActionId action, PreviewerOutput& result);
  void navigate(const PreviewerInput& input);
  void sendRequest();
  void startExport(const ExportRequest& request);
  void takeExport();

  PanelInput panelInput(const PreviewerInput& input) const;
  RenderStatus renderStatus(double now) const;
  SceneSummary sceneSummary() const;
  /// As it was asked for, to the last digit.
  CameraDescription cameraOf(const RenderFrame& frame) const;
  PictureIdentity identity(const RenderFrame& frame) const;
  ViewScale shownScale(const ViewImage& view) const;
  std::shared_ptr<const ImageRgb> beautyIfComparable(const RenderFrame& frame) const;
  CanvasContent captureContent(bool withOverlay) const;
  void updateCursor();
  void markSelectedPixel() const;
  void select(const Vec2& screen, bool adds);
  void setCamera(const CameraDescription& camera);
  void frameSelection();
  void deleteSelected();
  void stepCamera(int step);
  std::vector<Rgb> lightFactors() const;
  ShownPicture shownPicture(std::shared_ptr<const ViewImage> view, int reduction,
                            const Placement& placement) const;
  Placement placementOfPicture() const;

  std::function<void()> wake_;
  RecentFiles recent_;
  KeyMap keys_;
  DocumentLoader loader_;
  std::shared_ptr<const Document> document_;
  Workspace workspace_;
  History history_;
  PanelState panels_;
  PanelLayout layout_;
  Navigation navigation_;
  FrameViews views_;
  Inspection inspection_;
  std::optional<Kept> kept_;
  std::shared_ptr<const ViewImage> keptView_;
  std::optional<CursorInfo> cursor_;
  std::vector<Notice> notices_;
  std::vector<double> noticeTimes_;  ///< when each was given
  std::string sessionError_;
  std::uint64_t lastNotice_ = 0;
  ExportJob export_;
  std::optional<Capture> capture_;

  bool paused_ = false;
  bool stopped_ = false;
  std::uint64_t restarts_ = 0;
  std::shared_ptr<const Snapshot> cache_;  ///< vectors that take the place of those that the session has
  std::vector<Rgb> indirectFactors_;       ///< with which ILVs are computed
  std::optional<SessionRequest> requested_;
  std::uint64_t requestNumber_ = 0;
  std::deque<std::pair<std::uint64_t, CameraDescription>> requestCameras_;  ///< by the requests' numbers
  double requestTime_ = 0.0;
  double frameTime_ = 0.0;
  double time_ = 0.0;
  bool cameraMoves_ = false;
  std::string gestureLabel_;

  // Last: its thread is the first to end.
  Session session_;
};

}  // namespace lightvane
