#include "app/previewer.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <unistd.h>

#include "app/camera_motion.h"
#include "app/panels/apply_action.h"
#include "app/panels/path_completion.h"
#include "app/panels/theme.h"
#include "app/picture_metadata.h"
#include "app/settings.h"
#include "app/view.h"
#include "core/base/file.h"
#include "core/image/image_file.h"
#include "core/inspect/record_edit.h"
#include "core/inspect/record_names.h"
#include "core/inspect/units.h"
#include "core/io/cache_file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// A notice is read within this time; errors stay until they are dismissed.
constexpr double kNoticeSeconds = 8.0;
constexpr std::size_t kMostNotices = 50;
// Diagonals of the scene a second.
constexpr float kFlightSpeed = 0.35f;
constexpr float kPickPixels = 9.0f;
// Requests whose frames may still come.
constexpr std::size_t kMostRequests = 256;
constexpr std::string_view kSceneEndings[] = {".toml", ".obj"};

/// Bytes of memory that the process holds at the moment.
std::uint64_t residentBytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

const std::vector<ExportFormat>& exportFormats() {
  static const std::vector<ExportFormat> formats = {
      {".png", "PNG: the view as it is shown, 8 bits", true},
      {".exr", "OpenEXR: every layer, 32-bit floats, scene units", false},
      {".hdr", "Radiance HDR: the picture, scene units", false},
      {".pfm", "PFM: the picture, 32-bit floats, scene units", false}};
  return formats;
}

Vec3 flightStep(const Vec3& flight, float seconds, float diagonal) {
  return flight * (kFlightSpeed * seconds * diagonal);
}

/// The beauty picture in the scene's units.
std::shared_ptr<const ImageRgb> beautyOf(const RenderFrame& frame) {
  return std::make_shared<const ImageRgb>(frame.film->toLayers(*frame.scene).rgb());
}

}  // namespace

Previewer::Previewer(const UserFolders& folders, std::function<void()> wake)
    : wake_(std::move(wake)),
      recent_(folders.recent()),
      loader_(wake_),
      history_(Setup{}),
      inspection_(wake_),
      export_(wake_),
      session_(wake_) {
  std::error_code ignored;
  if (folders.keys().empty() || !fs::is_regular_file(folders.keys(), ignored)) return;
  const auto text = readFile(folders.keys());
  if (!text) {
    notify(Severity::Error, text.error().message());
    return;
  }
  KeyFile file = parseKeyFile(*text, folders.keys().string());
  keys_ = std::move(file.keys);
  for (const Error& error : file.errors) notify(Severity::Error, error.message());
}

void Previewer::notify(Severity severity, const std::string& text) {
  notices_.push_back({++lastNotice_, severity, text, 0.0});
  noticeTimes_.push_back(time_);
  if (notices_.size() > kMostNotices) {
    notices_.erase(notices_.begin());
    noticeTimes_.erase(noticeTimes_.begin());
  }
}

// ---- documents

void Previewer::open(const fs::path& path) { loader_.load(path); }

void Previewer::takeDocument() {
  auto loaded = loader_.take();
  if (!loaded) return;
  if (*loaded) {
    show(**std::move(loaded));
  } else {
    notify(Severity::Error, loaded->error().message());
  }
}

void Previewer::show(Document document) {
  const bool isSameFile = document_ && document_->path == document.path;
  const std::size_t lights = document.scene->lights.size();
  if (!isSameFile || workspace_.setup.lights.size() != lights) {
    workspace_.setup.parameters = document.start;
    workspace_.setup.camera = document.description.cameras.front();
    workspace_.setup.lights.assign(lights, {});
    workspace_.display.exposureStops = 0.0f;
    workspace_.display.placement = {};
    workspace_.display.comparison = {};
    history_.reset(workspace_.setup);
    kept_.reset();
    indirectFactors_.clear();
  }
  workspace_.selection = {};
  for (const std::string& warning : document.warnings) notify(Severity::Warning, warning);
  recent_.add(document.path);
  document_ = std::make_shared<const Document>(std::move(document));
  cache_ = nullptr;
  stopped_ = false;
  ++restarts_;
}

// ---- the session

std::vector<Rgb> Previewer::lightFactors() const {
  const auto& lights = workspace_.setup.lights;
  std::vector<Rgb> factors;
  for (std::size_t light = 0; light < lights.size(); ++light)
    factors.push_back(lightvane::lightFactor(lights, light));
  const bool isPlain =
      std::all_of(factors.begin(), factors.end(), [](const Rgb& f) { return f == Rgb(1.0f); });
  return isPlain ? std::vector<Rgb>() : factors;
}

void Previewer::sendRequest() {
  if (!document_) return;
  const Setup& setup = workspace_.setup;
  // Materials are compiled by the rules' own rule of energy.
  if (energyRuleFor(setup.parameters) != document_->energy) {
    if (loader_.loading().empty()) loader_.recompile(*document_, energyRuleFor(setup.parameters));
    return;
  }
  const auto camera = compileCamera(document_->scene->normalisation, setup.camera, "camera");
  if (!camera) return;
  SessionRequest request;
  request.scene = document_->scene;
  request.tracer = document_->tracer;
  request.camera = *camera;
  request.parameters = setup.parameters;
  request.lights = {lightFactors(), indirectFactors_};
  request.locked = setup.cacheLocked;
  request.paused = paused_ || stopped_;
  request.threads = setup.threads;
  request.restarts = restarts_;
  request.cache = cache_;
  if (requested_ == request) return;
  // What was stopped goes on only when it is asked to, or when something else is wanted.
  if (stopped_ && requested_) {
    SessionRequest same = *requested_;
    same.paused = true;
    if (same != request) {
      stopped_ = false;
      request.paused = paused_;
    }
  }
  requestNumber_ = session_.request(request);
  requestCameras_.emplace_back(requestNumber_, setup.camera);
  if (requestCameras_.size() > kMostRequests) requestCameras_.pop_front();
  requested_ = std::move(request);
  requestTime_ = time_;
}

void Previewer::takeFrame() {
  auto frame = session_.frame();
  // Of a scene that is shown no more.
  if (frame && (!document_ || frame->scene != document_->scene)) frame = nullptr;
  if (frame != views_.frame()) frameTime_ = time_;
  const SessionStatus status = session_.status();
  if (!status.error.empty() && status.error != sessionError_) notify(Severity::Error, status.error);
  sessionError_ = status.error;
  std::shared_ptr<const ImageRgb> rival = kept_ ? kept_->beauty : nullptr;
  Display display = workspace_.display;
  if (display.comparison.mode == CompareMode::Difference && kept_) display.view = PictureView::Error;
  views_.update(std::move(frame), display, workspace_.selection, rival);
  inspection_.update(views_.frame(), workspace_.selection);
  if (!kept_) {
    keptView_ = nullptr;
  } else if (!keptView_ || keptView_->view != workspace_.display.view) {
    keptView_ = std::make_shared<const ViewImage>(
        viewImage(*kept_->frame, workspace_.display.view,
                  views_.frame() ? beautyIfComparable(*views_.frame()).get() : nullptr));
  }
}

std::shared_ptr<const ImageRgb> Previewer::beautyIfComparable(const RenderFrame& frame) const {
  return workspace_.display.view == PictureView::Error ? beautyOf(frame) : nullptr;
}

RenderStatus Previewer::renderStatus(double now) const {
  RenderStatus status;
  status.paused = paused_;
  status.stopped = stopped_;
  status.memoryBytes = residentBytes();
  if (!loader_.loading().empty()) status.loading = loader_.loading().filename().string();
  const std::shared_ptr<const RenderFrame>& frame = views_.frame();
  if (!frame) return status;
  const RenderStatistics& statistics = frame->statistics;
  status.pass = statistics.passes;
  status.stage = frame->reduction > 1 ? "first look" : frame->progress.stage;
  status.fraction = frame->complete ? 1.0 : frame->reduction > 1 ? 0.0 : frame->progress.fraction;
  status.ilvRecords = frame->snapshot ? frame->snapshot->indirect.size() : statistics.ilvRecords;
  status.dlvRecords = frame->snapshot ? frame->snapshot->directCount() : statistics.dlvRecords;
  status.hitRate = frame->progress.hitRate;
  status.faultySamples = statistics.faults.count;
  status.unanswered = statistics.unanswered;
  status.complete = frame->complete && frame->request == requestNumber_;
  const double worked = frameTime_ - requestTime_;
  if (worked > 0.0) status.raysPerSecond = static_cast<double>(statistics.rays.total()) / worked;
  if (!status.complete && !paused_ && !stopped_ && status.fraction > 0.02)
    status.secondsLeft = std::max(0.0, (now - requestTime_) * (1.0 - status.fraction) / status.fraction);
  return status;
}

// ---- what panels see

SceneSummary Previewer::sceneSummary() const {
  const Scene& scene = *document_->scene;
  SceneSummary summary;
  summary.path = document_->path;
  summary.unit = lengthUnit(scene);
  summary.metresPerUnit = scene.metresPerUnit;
  summary.diagonalMetres = static_cast<double>(scene.diagonal) * scene.metresPerNormalisedUnit();
  const std::vector<bool> hasVectors = lightsWithVectors(scene, workspace_.setup.parameters);
  for (std::size_t light = 0; light < scene.lights.size(); ++light) {
    summary.lights.push_back({lightName(scene, static_cast<std::uint32_t>(light)), hasVectors[light]});
  }
  summary.cameras = scene.cameraNames;
  summary.needs = scene.needs;
  summary.start = document_->start;
  return summary;
}

CameraDescription Previewer::cameraOf(const RenderFrame& frame) const {
  const auto found = std::find_if(requestCameras_.begin(), requestCameras_.end(),
                                  [&](const auto& entry) { return entry.first == frame.request; });
  return found != requestCameras_.end() ? found->second : workspace_.setup.camera;
}

PictureIdentity Previewer::identity(const RenderFrame& frame) const {
  PictureIdentity identity;
  identity.scenePath = document_->path;
  identity.sceneHash = frame.scene->hash;
  identity.sceneSettings = document_->description.render;
  identity.parameters = frame.parameters;
  // The frame's own: the workspace's may have moved on. One of the scene's where it is one; else the first
  // with what differs.
  const auto& cameras = document_->description.cameras;
  const CameraDescription shown = cameraOf(frame);
  const auto sameView = [&](const CameraDescription& d) {
    return d.position == shown.position && d.target == shown.target && d.up == shown.up &&
           d.fovYDegrees == shown.fovYDegrees;
  };
  const auto own = std::find_if(cameras.begin(), cameras.end(), sameView);
  const CameraDescription& base = own != cameras.end() ? *own : cameras.front();
  if (own == cameras.end())
    identity.cameraChanges = {shown.position, shown.target, shown.up, shown.fovYDegrees};
  identity.cameraName = base.name;
  identity.isDefaultCamera = &base == &cameras.front();
  identity.region = frame.region;
  identity.isDefaultSize = frame.region.fullWidth == base.width && frame.region.fullHeight == base.height;
  for (std::size_t light = 0; light < frame.lights.direct.size(); ++light) {
    if (frame.lights.direct[light] != Rgb(1.0f))
      identity.lights.push_back({frame.scene->lightNames[light], frame.lights.direct[light]});
  }
  identity.lockedCache = frame.locked;
  identity.passes = frame.statistics.passes;
  identity.complete = frame.complete;
  return identity;
}

PanelInput Previewer::panelInput(const PreviewerInput& input) const {
  PanelInput panels;
  panels.timeSeconds = input.timeSeconds;
  panels.monitorScale = input.monitorScale;
  panels.status = renderStatus(input.timeSeconds);
  panels.notices = notices_;
  for (std::size_t i = 0; i < panels.notices.size(); ++i)
    panels.notices[i].ageSeconds = input.timeSeconds - noticeTimes_[i];
  panels.recentFiles.assign(recent_.paths().begin(), recent_.paths().end());
  panels.exportFormats = exportFormats();
  panels.keys = &keys_;
  panels.undoLabel = history_.undoLabel();
  panels.redoLabel = history_.redoLabel();
  panels.completePath = [](const std::string& typed) { return completePath(typed, kSceneEndings); };
  if (!document_) return panels;
  panels.scene = sceneSummary();
  panels.indirectIsStale =
      lightFactors() != indirectFactors_ && workspace_.setup.parameters.picture.method == Method::Vectors;
  panels.passLengths = views_.passes();
  panels.compiledScene = document_->scene.get();
  panels.pixel = inspection_.pixel();
  panels.record = inspection_.record();
  panels.full = inspection_.full();
  if (inspection_.isComputing())
    panels.fullProgress = fmt::format("{} samples", countText(Inspection::kSamples));
  panels.kept = {kept_.has_value(), kept_ ? kept_->text : "Press B to keep this picture."};
  panels.reference = {false, "no reference is open"};
  const auto& frame = views_.frame();
  if (!frame) return panels;
  const ViewImage& view = *views_.view();
  panels.shown = ShownView{view.view, view.kind, view.title, view.unit, shownScale(view), view.categories};
  panels.overlay = views_.overlay().get();
  panels.cursor = cursor_;
  panels.exportCommand = renderCommand(identity(*frame), ".png");
  return panels;
}

ViewScale Previewer::shownScale(const ViewImage& view) const {
  ViewScale scale = view.scale;
  const ScaleOverride& chosen = workspace_.display.scale;
  if (chosen.map) scale.map = *chosen.map;
  if (chosen.fixedRange) {
    scale.low = chosen.low;
    scale.high = chosen.high;
  }
  return scale;
}

// ---- a frame

PreviewerOutput Previewer::update(const PreviewerInput& input) {
  const double passed = std::clamp(input.timeSeconds - time_, 0.0, 0.1);
  time_ = input.timeSeconds;
  PreviewerOutput result;
  takeDocument();
  takeExport();
  for (const fs::path& path : input.dropped) open(path);
  takeFrame();

  const PanelInput panels = panelInput(input);
  PanelOutput output;
  const Workspace before = workspace_;
  handleKeys(input, panels, output);
  layout_ = drawPanels(workspace_, panels, panels_, output);
  if (input.wantsClose) result.quits = true;
  carryOut(output, result);
  cameraMoves_ = false;
  navigate(input);
  if (document_ && input.flight != Vec3(0.0f) && !ImGui::GetIO().WantTextInput) {
    if (const auto camera =
            compileCamera(document_->scene->normalisation, workspace_.setup.camera, "camera")) {
      setCamera(describeCamera(
          document_->scene->normalisation,
          flown(*camera, flightStep(input.flight, static_cast<float>(passed), document_->scene->diagonal))));
      cameraMoves_ = true;
      gestureLabel_ = "Fly";
      result.animates = true;
    }
  }
  history_.update(workspace_.setup, output.gesture || cameraMoves_, cameraMoves_ ? gestureLabel_ : "");
  sendRequest();
  updateCursor();
  markSelectedPixel();
  const bool fades = std::any_of(panels.notices.begin(), panels.notices.end(),
                                 [](const Notice& n) { return n.ageSeconds < kNoticeSeconds; });
  result.animates = result.animates || output.animates || workspace_ != before || fades;
  const bool rests = panels.status.complete || paused_ || stopped_;
  result.works = document_ && !rests;
  result.fullScreen = workspace_.display.fullScreen;
  result.title = document_ ? fmt::format("{} - Lightvane", document_->path.filename().string()) : "Lightvane";
  return result;
}

void Previewer::handleKeys(const PreviewerInput& input, const PanelInput& panels, PanelOutput& output) {
  for (const KeyChord& chord : input.keys) {
    const auto action = keys_.actionFor(chord);
    if (!action) continue;
    if (ImGui::GetIO().WantTextInput && !actionInfo(*action).whileTyping) continue;
    applyAction(*action, workspace_, panels, panels_, output);
  }
}

void Previewer::carryOut(const PanelOutput& output, PreviewerOutput& result) {
  for (const ActionId action : output.actions) carryOut(action, result);
  if (output.open) open(output.open->path);
  if (output.goToCamera && *output.goToCamera < document_->description.cameras.size())
    setCamera(document_->description.cameras[*output.goToCamera]);
  if (output.exported) startExport(*output.exported);
  if (output.clipboard) result.clipboard = output.clipboard;
  for (const std::uint64_t id : output.dismissedNotices) {
    const auto found =
        std::find_if(notices_.begin(), notices_.end(), [&](const Notice& notice) { return notice.id == id; });
    if (found == notices_.end()) continue;
    noticeTimes_.erase(noticeTimes_.begin() + (found - notices_.begin()));
    notices_.erase(found);
  }
  if (output.refreshIndirect) indirectFactors_ = lightFactors();
}

void Previewer::carryOut(ActionId action, PreviewerOutput& result) {
  switch (action) {
    case ActionId::Quit:
      result.quits = true;
      break;
    case ActionId::Reload:
      if (document_) open(document_->path);
      break;
    case ActionId::CopyCommand:
      if (views_.frame()) {
        result.clipboard = renderCommand(identity(*views_.frame()), ".png");
        notify(Severity::Note, "The command line of this picture is in the clipboard.");
      }
      break;
    case ActionId::CopyView: {
      const CameraDescription& d = workspace_.setup.camera;
      result.clipboard = fmt::format(
          "[camera]\nposition = [{}, {}, {}]\ntarget = [{}, {}, {}]\nup = [{}, {}, {}]\nfov_y = {}\n"
          "resolution = [{}, {}]\nexposure = {}\n",
          d.position.x, d.position.y, d.position.z, d.target.x, d.target.y, d.target.z, d.up.x, d.up.y,
          d.up.z, d.fovYDegrees, d.width, d.height, d.exposureStops);
      notify(Severity::Note, "The camera is in the clipboard, as a [camera] of a scene file.");
      break;
    }
    case ActionId::ComputeHere:
      inspection_.computeHere();
      break;
    case ActionId::RecordsDelete:
      deleteSelected();
      break;
    case ActionId::Undo:
      if (const auto setup = history_.undo()) workspace_.setup = *setup;
      break;
    case ActionId::Redo:
      if (const auto setup = history_.redo()) workspace_.setup = *setup;
      break;
    case ActionId::Pause:
      if (stopped_) {
        stopped_ = false;
      } else {
        paused_ = !paused_;
      }
      break;
    case ActionId::Stop:
      stopped_ = true;
      break;
    case ActionId::Restart:
      stopped_ = paused_ = false;
      indirectFactors_ = lightFactors();
      cache_ = nullptr;
      ++restarts_;
      break;
    case ActionId::CameraHome:
      setCamera(document_->description.cameras.front());
      break;
    case ActionId::CameraFrame:
      frameSelection();
      break;
    case ActionId::CameraNext:
      stepCamera(1);
      break;
    case ActionId::CameraPrevious:
      stepCamera(-1);
      break;
    case ActionId::CompareKeep:
      if (const auto& frame = views_.frame()) {
        kept_ =
            Kept{frame, workspace_.setup,
                 fmt::format("pass {}, kept at {:.0f} s", frame->statistics.passes, time_), beautyOf(*frame)};
        keptView_ = nullptr;
      }
      break;
    case ActionId::CompareSwap:
      if (kept_ && views_.frame()) {
        Kept mine{views_.frame(), workspace_.setup, "the picture before the swap", beautyOf(*views_.frame())};
        workspace_.setup = kept_->setup;
        kept_ = std::move(mine);
        keptView_ = nullptr;
      }
      break;
    default:
      break;
  }
}

void Previewer::deleteSelected() {
  const auto& frame = views_.frame();
  if (!frame || !frame->snapshot || workspace_.selection.records.empty()) return;
  cache_ = withoutRecords(*frame, workspace_.selection.records);
  notify(Severity::Note,
         fmt::format("{} {} deleted{}", countText(workspace_.selection.records.size()),
                     workspace_.selection.records.size() == 1 ? "vector" : "vectors",
                     workspace_.setup.cacheLocked
                         ? "."
                         : ": points that miss it compute their own, unless the cache is locked."));
  workspace_.selection.records.clear();
}

// ---- the camera and the mouse

void Previewer::setCamera(const CameraDescription& camera) {
  CameraDescription next = camera;
  // Size and exposure are the picture's, whoever looks from where.
  next.width = workspace_.setup.camera.width;
  next.height = workspace_.setup.camera.height;
  if (!compileCamera(document_->scene->normalisation, next, "camera")) return;
  workspace_.setup.camera = next;
}

void Previewer::stepCamera(int step) {
  const auto& cameras = document_->description.cameras;
  const auto count = static_cast<int>(cameras.size());
  int current = 0;
  for (int i = 0; i < count; ++i) {
    if (cameras[static_cast<std::size_t>(i)].position == workspace_.setup.camera.position) current = i;
  }
  setCamera(cameras[static_cast<std::size_t>((current + step + count) % count)]);
}

void Previewer::frameSelection() {
  const auto& frame = views_.frame();
  if (!frame) return;
  Bounds bounds;
  for (const RecordRef& record : workspace_.selection.records) {
    if (const IndirectLightVector* ilv = findIndirect(*frame, record)) bounds.add(ilv->point.position);
    if (const DirectLightVector* dlv = findDirect(*frame, record)) bounds.add(dlv->point.position);
  }
  if (workspace_.selection.pixel && frame->reduction == 1) {
    const PixelRef& pixel = *workspace_.selection.pixel;
    if (pixel.x < frame->film->width && pixel.y < frame->film->height &&
        std::isfinite(frame->film->depth.at(pixel.x, pixel.y)))
      bounds.add(frame->film->position.at(pixel.x, pixel.y));
  }
  if (bounds.empty()) return;
  const float radius = std::max(0.5f * bounds.diagonal(), 0.05f * frame->scene->diagonal);
  setCamera(describeCamera(frame->scene->normalisation, framing(frame->camera, bounds.centre(), radius)));
}

Placement Previewer::placementOfPicture() const {
  return placePicture(workspace_.display.placement, layout_.picture, workspace_.setup.camera.width,
                      workspace_.setup.camera.height);
}

void Previewer::navigate(const PreviewerInput&) {
  if (!document_) return;
  const ImGuiIO& io = ImGui::GetIO();
  PictureMouse mouse;
  mouse.position = {io.MousePos.x, io.MousePos.y};
  const ScreenRect& area = layout_.picture;
  const bool inside = mouse.position.x >= area.min.x && mouse.position.x < area.max.x &&
                      mouse.position.y >= area.min.y && mouse.position.y < area.max.y;
  mouse.overPicture = inside && !io.WantCaptureMouse;
  for (int button = 0; button < 3; ++button) mouse.down[button] = io.MouseDown[button];
  mouse.wheel = io.MouseWheel;
  mouse.shift = io.KeyShift;
  mouse.ctrl = io.KeyCtrl;
  mouse.alt = io.KeyAlt;

  const auto camera = compileCamera(document_->scene->normalisation, workspace_.setup.camera, "camera");
  if (!camera) return;
  Navigation::View view;
  view.camera = *camera;
  view.up = worldUp(document_->scene->cameras.front());
  view.pivot = document_->scene->bounds.centre();
  view.picture = placementOfPicture();
  view.placement = workspace_.display.placement;
  view.area = area;
  if (workspace_.display.comparison.mode == CompareMode::Wipe && kept_)
    view.wipe = workspace_.display.comparison.wipe;
  if (const auto& frame = views_.frame()) {
    const Vec2 at = view.picture.toPicture(mouse.position) / static_cast<float>(frame->reduction);
    const auto x = static_cast<int>(std::floor(at.x));
    const auto y = static_cast<int>(std::floor(at.y));
    if (x >= 0 && y >= 0 && x < frame->film->width && y < frame->film->height &&
        std::isfinite(frame->film->depth.at(x, y)))
      view.pivot = frame->film->position.at(x, y);
  }
  const PictureMotion motion = navigation_.update(mouse, view);
  if (motion.camera) {
    setCamera(describeCamera(document_->scene->normalisation, *motion.camera));
    cameraMoves_ = motion.held;
    gestureLabel_ = motion.label;
  }
  if (motion.placement) workspace_.display.placement = *motion.placement;
  if (motion.wipe) workspace_.display.comparison.wipe = *motion.wipe;
  if (motion.clicked) select(*motion.clicked, mouse.shift || mouse.ctrl);
}

void Previewer::select(const Vec2& screen, bool adds) {
  const auto& frame = views_.frame();
  if (!frame) return;
  const Vec2 at = placementOfPicture().toPicture(screen);
  Selection& selection = workspace_.selection;
  if (views_.overlay()) {
    Camera camera = frame->camera;
    const auto reduction = static_cast<float>(frame->reduction);
    const float zoom = placementOfPicture().zoom * reduction;
    const RecordRef record = pickMarker(*views_.overlay(), camera, at.x / reduction, at.y / reduction,
                                        kPickPixels / zoom, frame->film->depth);
    if (!record.isNone()) {
      const auto found = std::find(selection.records.begin(), selection.records.end(), record);
      if (!adds) {
        selection.records = {record};
      } else if (found != selection.records.end()) {
        selection.records.erase(found);
      } else {
        selection.records.insert(selection.records.begin(), record);
      }
      return;
    }
  }
  const PixelRef pixel{static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))};
  const bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < workspace_.setup.camera.width &&
                      pixel.y < workspace_.setup.camera.height;
  if (!adds) selection.records.clear();
  selection.pixel = inside ? std::optional(pixel) : std::nullopt;
}

void Previewer::updateCursor() {
  cursor_.reset();
  const auto& frame = views_.frame();
  const ImGuiIO& io = ImGui::GetIO();
  if (!frame || !views_.view() || views_.view()->empty() || io.WantCaptureMouse) return;
  const Vec2 mouse(io.MousePos.x, io.MousePos.y);
  const ScreenRect& area = layout_.picture;
  if (mouse.x < area.min.x || mouse.x >= area.max.x || mouse.y < area.min.y || mouse.y >= area.max.y) return;
  const Vec2 at = placementOfPicture().toPicture(mouse);
  const PixelRef pixel{static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))};
  const int x = pixel.x / frame->reduction;
  const int y = pixel.y / frame->reduction;
  if (at.x < 0.0f || at.y < 0.0f || x >= views_.view()->width || y >= views_.view()->height) return;
  cursor_ = CursorInfo{pixel, {viewValueText(*views_.view(), x, y)}};
}

// ---- drawing

void Previewer::markSelectedPixel() const {
  if (!views_.frame() || !workspace_.selection.pixel) return;
  // A frame about the pixel, light on dark, that never gets so small that it is not seen.
  constexpr float kLeastHalf = 5.0f;
  const float scale = totalScale(workspace_.display, ImGui::GetIO().DisplayFramebufferScale.x);
  const Placement placement = placementOfPicture();
  const PixelRef& pixel = *workspace_.selection.pixel;
  const Vec2 middle =
      placement.toFramebuffer({static_cast<float>(pixel.x) + 0.5f, static_cast<float>(pixel.y) + 0.5f});
  const float half = std::max(kLeastHalf * scale, 0.5f * placement.zoom);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect(layout_.picture.min, layout_.picture.max);
  for (const auto& [color, width] : {std::pair(IM_COL32(0, 0, 0, 255), 3.0f * scale),
                                     std::pair(IM_COL32(255, 255, 255, 255), 1.0f * scale)}) {
    list.AddRect({middle.x - half, middle.y - half}, {middle.x + half, middle.y + half}, color, 0.0f, 0,
                 width);
  }
  list.PopClipRect();
}

ShownPicture Previewer::shownPicture(std::shared_ptr<const ViewImage> view, int reduction,
                                     const Placement& placement) const {
  ShownPicture shown;
  shown.style.exposureStops =
      static_cast<float>(workspace_.setup.camera.exposureStops) + workspace_.display.exposureStops;
  shown.style.toneMap = workspace_.display.toneMapping;
  shown.style.scale = shownScale(*view);
  shown.placement = placement;
  shown.placement.zoom *= static_cast<float>(reduction);
  // A first look is not worth its squares.
  shown.style.smooth = workspace_.display.smooth || reduction > 1;
  shown.view = std::move(view);
  return shown;
}

CanvasContent Previewer::content() const {
  CanvasContent content;
  const ImVec4 background = toVec4(paletteOf(workspace_.display.theme).background);
  content.background = {static_cast<std::uint8_t>(std::lround(255.0f * background.x)),
                        static_cast<std::uint8_t>(std::lround(255.0f * background.y)),
                        static_cast<std::uint8_t>(std::lround(255.0f * background.z)), 255};
  const auto& frame = views_.frame();
  if (!frame || !views_.view() || views_.view()->empty()) return content;
  content.uiScale = ImGui::GetIO().DisplayFramebufferScale.x;
  const float pixels = content.uiScale;
  ScreenRect area = layout_.picture;
  area.min = {area.min.x * pixels, area.min.y * pixels};
  area.max = {area.max.x * pixels, area.max.y * pixels};
  PicturePlacement placed = workspace_.display.placement;
  placed.zoom *= pixels;
  placed.pan *= pixels;
  const Placement placement =
      placePicture(placed, area, workspace_.setup.camera.width, workspace_.setup.camera.height);

  content.picture = shownPicture(views_.view(), frame->reduction, placement);
  const Comparison& comparison = workspace_.display.comparison;
  if (kept_ && keptView_ && !keptView_->empty()) {
    const ShownPicture rival = shownPicture(keptView_, kept_->frame->reduction, placement);
    if (comparison.flipped) {
      content.picture = rival;
    } else if (comparison.mode == CompareMode::Wipe) {
      content.second = rival;
      content.wipe = comparison.wipe;
    } else if (comparison.mode == CompareMode::SideBySide) {
      const auto [left, right] = placement.halves();
      content.picture->placement = left;
      content.second = rival;
      content.second->placement = right;
    }
  }
  if ((views_.overlay() || inspection_.served()) && !comparison.flipped) {
    OverlayView overlay;
    if (inspection_.served() && !inspection_.served()->markers.empty())
      overlay.batches.push_back(inspection_.served());
    if (views_.overlay()) overlay.batches.push_back(views_.overlay());
    overlay.depth = views_.depth();
    overlay.camera = frame->camera;
    overlay.placement = content.picture->placement;
    overlay.pen.uiScale = totalScale(workspace_.display, ImGui::GetIO().DisplayFramebufferScale.x);
    content.overlay = std::move(overlay);
  }
  return content;
}

// ---- files

void Previewer::startExport(const ExportRequest& request) {
  const auto& frame = views_.frame();
  if (!frame || frame->reduction > 1) {
    notify(Severity::Warning, "There is no picture to export yet.");
    return;
  }
  if (export_.isBusy()) {
    notify(Severity::Warning, "Another picture is being written: try again when it is there.");
    return;
  }
  if (auto checked = checkWritableImage(request.path); !checked) {
    notify(Severity::Error, checked.error().message());
    return;
  }
  const std::string extension = request.path.extension().string();
  PictureIdentity made = identity(*frame);
  std::function<Expected<void>()> writeVectors = [] { return Expected<void>(); };
  if (frame->warm) {
    // What was looked at before is part of the picture: with these vectors the command makes it again.
    const fs::path cache = request.path.string() + ".lvcache";
    made.cache = cache;
    const CacheIdentity owner{
        litHash(sceneHash(document_->description, HashScope::Light), frame->lights.indirect),
        parametersAsText(frame->parameters), ""};
    writeVectors = [frame, cache, owner] { return writeCache(cache, *frame->warm, owner); };
  }
  std::map<std::string, std::string> metadata = pictureMetadata(made, extension);
  if (extension == ".png") {
    // What is shown, at the picture's own size: drawn by the next frame's canvas.
    capture_ = Capture{captureContent(request.withOverlay),
                       frame->film->width,
                       frame->film->height,
                       request.path,
                       std::move(metadata),
                       std::move(writeVectors)};
    return;
  }
  export_.start(request.path, [frame, metadata = std::move(metadata), path = request.path, writeVectors] {
    if (auto written = writeVectors(); !written) return written;
    LayeredImage image = frame->film->toLayers(*frame->scene);
    image.metadata = metadata;
    return writeImage(path, image, {});
  });
}

CanvasContent Previewer::captureContent(bool withOverlay) const {
  CanvasContent content = this->content();
  const Placement whole{0, 0, views_.view()->width, views_.view()->height, Vec2(0.0f), 1.0f};
  content.picture = shownPicture(views_.view(), 1, whole);
  content.second.reset();
  if (content.overlay) content.overlay->placement = whole;
  if (!withOverlay) content.overlay.reset();
  return content;
}

void Previewer::finishCapture(const Image<Color8>& pixels) {
  if (!capture_) return;
  const Capture capture = std::move(*capture_);
  capture_.reset();
  LayeredImage image;
  image.width = pixels.width();
  image.height = pixels.height();
  ImageRgb colors(image.width, image.height);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const Color8& c = pixels[i];
    colors[i] = {decodeSrgb(static_cast<float>(c.r) / 255.0f), decodeSrgb(static_cast<float>(c.g) / 255.0f),
                 decodeSrgb(static_cast<float>(c.b) / 255.0f)};
  }
  image.setRgb("", colors);
  image.metadata = capture.metadata;
  export_.start(capture.path,
                [image = std::move(image), path = capture.path, writeVectors = capture.writeVectors] {
                  auto written = writeVectors();
                  return written ? writeImage(path, image, {}) : written;
                });
}

void Previewer::takeExport() {
  const auto outcome = export_.take();
  if (!outcome) return;
  if (outcome->done) {
    notify(Severity::Note, fmt::format("Wrote {}.", outcome->path.string()));
  } else {
    notify(Severity::Error, outcome->done.error().message());
  }
}

}  // namespace lightvane
