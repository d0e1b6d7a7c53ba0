#include "app/previewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

#include "app/camera_motion.h"
#include "app/frame_identity.h"
#include "app/panels/apply_action.h"
#include "app/panels/path_completion.h"
#include "app/panels/theme.h"
#include "app/picking.h"
#include "app/picture_marks.h"
#include "app/render_status.h"
#include "core/base/file.h"
#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/record_names.h"
#include "core/scene/write_scene.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// A notice is read within this time; errors stay until they are dismissed.
constexpr double kNoticeSeconds = 8.0;
// Diagonals of the scene a second.
constexpr double kFlightSpeed = 0.35;
// A longer frame than this moves the camera no farther.
constexpr double kLongestFlight = 0.1;
// Requests whose frames may still come.
constexpr std::size_t kMostRequests = 256;
// After a key or another picture.
constexpr int kFramesToSettle = 3;
// Between two looks at the memory that the program holds.
constexpr double kMemorySeconds = 1.0;

bool showsBoth(const Comparison& comparison) {
  return comparison.mode == CompareMode::SideBySide || comparison.mode == CompareMode::Wipe;
}

std::string vectorsText(std::size_t count) {
  return fmt::format("{} {}", countText(count), count == 1 ? "vector" : "vectors");
}

}  // namespace

Previewer::Previewer(const UserFolders& folders, std::function<void()> wake)
    : wake_(std::move(wake)),
      recent_(folders.recent()),
      settingsFile_(folders.settings()),
      shownSettings_(settingsFile_.settings()),
      loader_(wake_),
      history_({}),
      inspection_(wake_),
      errorWatch_(wake_),
      explanation_(wake_),
      exporter_(wake_),
      cacheFile_(wake_),
      sessionFile_(wake_),
      recomputed_(wake_),
      reference_(wake_),
      trade_(wake_),
      session_(wake_) {
  applySettings(shownSettings_, workspace_.display);
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

SessionRequest Previewer::requestFor(const Camera& camera) const {
  const Setup& setup = workspace_.setup;
  SessionRequest request;
  request.scene = document_->scene;
  request.tracer = document_->tracer;
  request.camera = camera;
  request.parameters = setup.parameters;
  request.lights = {lightFactors(), workspace_.setup.indirectFactors};
  request.locked = setup.cacheLocked;
  request.paused = paused_ || stopped_;
  request.threads = setup.threads;
  request.memoryLimitBytes = 1'000'000 * static_cast<std::size_t>(setup.memoryLimitMegabytes);
  request.restarts = restarts_;
  request.cache = cache_;
  request.pinned = pinned_;
  return request;
}

void Previewer::sendRequest() {
  if (!document_) return;
  // Materials are compiled by the rules' own rule of energy.
  const EnergyRule energy = energyRuleFor(workspace_.setup.parameters);
  if (energy != document_->energy) {
    if (!isLoading()) loader_.recompile(*document_, energy);
    return;
  }
  SessionRequest request = requestFor(compiledCamera());
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
  // A rendering that is paused, or goes on, is no new one.
  bool isSameRendering = false;
  if (requested_) {
    SessionRequest same = *requested_;
    same.paused = request.paused;
    isSameRendering = same == request;
  }
  if (!isSameRendering) {
    requestTime_ = time_;
  } else if (request.paused) {
    pausedTime_ = time_;
  } else if (!isComplete()) {
    requestTime_ += time_ - pausedTime_;
  }
  requestNumber_ = session_.request(request);
  requestCameras_.emplace_back(requestNumber_, workspace_.setup.camera);
  if (requestCameras_.size() > kMostRequests) requestCameras_.pop_front();
  requested_ = std::move(request);
}

void Previewer::takeFrame() {
  auto frame = session_.frame();
  // Of a scene that is shown no more.
  if (frame && (!document_ || frame->scene != document_->scene)) frame = nullptr;
  // The same picture comes again where a rendering is paused.
  const auto& shown = views_.frame();
  if (!frame || !shown || frame->film != shown->film) frameTime_ = time_;
  const SessionStatus status = session_.status();
  if (!status.error.empty() && status.error != sessionError_) notify(Severity::Error, status.error);
  sessionError_ = status.error;
  if (!status.stopped.empty() && status.stopped != sessionStop_) notify(Severity::Warning, status.stopped);
  sessionStop_ = status.stopped;

  const Display& display = workspace_.display;
  const Comparison& comparison = display.comparison;
  RivalPicture* other = rival();
  const ErrorBase base = errorBase();
  const auto viewBefore = views_.view();
  const auto overlayBefore = views_.overlay();
  views_.update(std::move(frame), shownView(), fittedTo(display.overlays, pictureAreaInPoints()),
                workspace_.selection, base, pinned_, stale_);
  ReferencePixels reference;
  if (hasReference()) reference = {reference_.picture()->beauty(), reference_.picture()->variance()};
  errorWatch_.update(views_.frame(), reference, !isWorking());
  views_.take(errorWatch_.estimateOf(views_.frame().get()));
  explanation_.update(views_.frame(), shownView() == PictureView::ErrorSources, !isWorking());
  views_.take(explanation_.sourcesOf(views_.frame().get()), display.source);
  if (views_.view() != viewBefore || views_.overlay() != overlayBefore) framesToSettle_ = kFramesToSettle;
  inspection_.update(views_.frame(), workspace_.selection, !isWorking());

  rivalView_.reset();
  if (other != nullptr && (showsBoth(comparison) || comparison.flipped))
    rivalView_ = RivalView{other->view(display.view, base), reductionOf(*other)};
}

RenderStatus Previewer::currentStatus() const {
  RenderStatus status;
  if (const auto& frame = views_.frame()) {
    // While it runs, up to now: what is left goes down between two frames.
    // A first look is of a rendering of its own: where the real one is, only the session knows.
    const SessionStatus session = session_.status();
    const bool isAhead = frame->reduction > 1 && session.request == requestNumber_;
    const double worked = (!isHalted() && !frame->complete ? time_ : frameTime_) - requestTime_;
    status =
        isAhead ? renderStatus(session.statistics, session.progress, worked) : renderStatus(*frame, worked);
    status.complete = isComplete();
    if (isHalted()) status.secondsLeft.reset();
  }
  status.paused = paused_;
  status.stopped = stopped_ || !sessionStop_.empty();
  status.memoryBytes = memoryBytes_;
  if (isLoading()) {
    const LoadProgress::State progress = loader_.progress();
    status.loading = progress.stage.empty() ? loader_.loading().filename().string() : progressText(progress);
  }
  if (reference_.isTracing()) status.reference = reference_.text();
  return status;
}

bool Previewer::isHalted() const { return paused_ || stopped_ || !sessionStop_.empty(); }

bool Previewer::isComplete() const {
  const auto& frame = views_.frame();
  return frame && frame->complete && frame->request == requestNumber_;
}

bool Previewer::isWorking() const { return document_ && !isHalted() && !isComplete(); }

// ---- pictures to compare with

bool Previewer::hasReference() const {
  return reference_.picture() != nullptr && requested_ && reference_.shows(*requested_);
}

RivalPicture* Previewer::rival() {
  switch (workspace_.display.comparison.with) {
    case CompareWith::Reference:
      return hasReference() ? reference_.picture() : nullptr;
    case CompareWith::Point:
      return tradePicture_ ? &tradePicture_->picture : nullptr;
    case CompareWith::Kept:
      break;
  }
  return kept_ ? &kept_->picture : nullptr;
}

int Previewer::reductionOf(const RivalPicture& rival) const {
  if (tradePicture_ && &rival == &tradePicture_->picture) return tradePicture_->reduction;
  return rival.frame() ? rival.frame()->reduction : 1;
}

bool Previewer::showsDifference() const {
  const Comparison& comparison = workspace_.display.comparison;
  if (comparison.mode != CompareMode::Difference) return false;
  if (comparison.with == CompareWith::Point) return tradePicture_.has_value();
  return comparison.with == CompareWith::Kept ? kept_.has_value() : hasReference();
}

PictureView Previewer::shownView() const {
  return showsDifference() ? PictureView::Error : workspace_.display.view;
}

ErrorBase Previewer::errorBase() const {
  if (kept_ && showsDifference() && workspace_.display.comparison.with == CompareWith::Kept)
    return {kept_->picture.beauty(), "picture B"};
  if (tradePicture_ && showsDifference() && workspace_.display.comparison.with == CompareWith::Point)
    return {tradePicture_->picture.beauty(), "the point's picture"};
  if (hasReference()) return {reference_.picture()->beauty(), "the reference"};
  return {nullptr,
          fmt::format("{}; {} traces one",
                      reference_.picture() == nullptr ? "there is no reference yet"
                                                      : "the reference is of another view, or other lights",
                      keys_.textOf(ActionId::ReferenceTrace))};
}

Rival Previewer::describeKept() const {
  if (!kept_) return {false, fmt::format("{} keeps this picture.", keys_.textOf(ActionId::CompareKeep))};
  const std::string difference = describeChange(kept_->setup, workspace_.setup);
  return {true, fmt::format("pass {}, {}", kept_->picture.frame()->statistics.passes,
                            difference.empty() ? "the same settings" : "A since then: " + difference)};
}

Rival Previewer::describeReference() const {
  if (hasReference()) return {true, reference_.text()};
  if (requested_ && reference_.isTracing() && reference_.shows(*requested_))
    return {false, reference_.text()};
  return {false, errorBase().name + ", or open an EXR or HDR picture."};
}

Rival Previewer::describeTradePoint() const {
  if (tradePicture_) return {true, tradePicture_->text};
  return {false, fmt::format("Click a point of the Trade tab ({}).", keys_.textOf(ActionId::TabTrade))};
}

void Previewer::keepAsB() {
  const auto& frame = views_.frame();
  if (!frame || frame->reduction > 1) return;
  kept_.emplace(Kept{RivalPicture(frame), workspace_.setup});
  workspace_.display.comparison.with = CompareWith::Kept;
}

void Previewer::swapWithB() {
  if (!kept_ || !views_.frame()) return;
  Setup other = kept_->setup;
  // Vectors stay as they are.
  other.recordState = workspace_.setup.recordState;
  keepAsB();
  workspace_.setup = other;
}

void Previewer::traceReference() {
  if (!requested_) return;
  const bool isOfThis = reference_.shows(*requested_);
  if (isOfThis && reference_.isTracing()) {
    reference_.setPaused(true);
  } else if (isOfThis && reference_.isPaused()) {
    reference_.setPaused(false);
  } else {
    reference_.trace(*requested_);
  }
  workspace_.display.comparison.with = CompareWith::Reference;
}

void Previewer::takeReference() {
  if (const auto error = reference_.update(isWorking(), time_)) notify(Severity::Error, *error);
}

// ---- what panels see

CameraDescription Previewer::cameraOf(const RenderFrame& frame) const {
  const auto found = std::find_if(requestCameras_.begin(), requestCameras_.end(),
                                  [&](const auto& entry) { return entry.first == frame.request; });
  return found != requestCameras_.end() ? found->second : workspace_.setup.camera;
}

PictureIdentity Previewer::identityOf(const RenderFrame& frame) const {
  PictureLook look = workspace_.look();
  look.view = shownView();
  std::optional<fs::path> reference;
  if (look.view == PictureView::Error) {
    const bool isAgainstFile =
        hasReference() && errorBase().picture == reference_.picture()->beauty() && !reference_.path().empty();
    if (isAgainstFile) {
      reference = reference_.path();
    } else {
      look.view = PictureView::Beauty;
    }
  }
  PictureIdentity identity = pictureIdentity(frame, *document_, cameraOf(frame), look);
  identity.reference = std::move(reference);
  const auto sources = explanation_.sourcesOf(&frame);
  if (look.view == PictureView::ErrorSources && sources)
    identity.explain = ErrorSourceRequest{sources->samples, sources->stride};
  return identity;
}

PictureIdentity Previewer::identityOf(const RenderFrame& frame, const fs::path& path) const {
  PictureIdentity identity = identityOf(frame);
  // What was looked at before is part of the picture: with these vectors the command makes it again.
  if (frame.warm) identity.cache = path.string() + std::string(kCacheEnding);
  return identity;
}

ExportCommand Previewer::exportCommand(const RenderFrame& frame, const fs::path& path) const {
  // Vectors and sessions are no pictures, and have no others beside them: the command of the picture that
  // they belong to. By the name alone, as this is asked for in every frame.
  const auto& pictures = imageExtensions();
  const bool isPicture = std::find(pictures.begin(), pictures.end(), fileEnding(path)) != pictures.end();
  const std::string ending = isPicture ? fileEnding(path) : ".png";
  const PictureIdentity identity = isPicture ? identityOf(frame, path) : identityOf(frame);
  ExportCommand command{renderCommandHere(identity, ending), "", identity.cache.value_or(fs::path())};
  if (frame.warm && !isPicture) command.note = otherVectorsNote();
  if (isForScreens(ending) && shownView() == PictureView::Error && !identity.reference) {
    if (!command.note.empty()) command.note += " ";
    command.note +=
        "It gives the picture itself: the error is against a picture that is in no file. Open an EXR as the "
        "reference, and the command names it.";
  }
  return command;
}

std::string Previewer::otherVectorsNote() const {
  return fmt::format(
      "This picture also has vectors of other views or parameters, which the command does not know: {} "
      "begins anew without them, and an export of the picture writes them, too.",
      keys_.textOf(ActionId::Restart));
}

PanelInput Previewer::panelInput(const PreviewerInput& input) const {
  PanelInput panels;
  panels.timeSeconds = input.timeSeconds;
  panels.monitorScale = input.monitorScale;
  panels.status = currentStatus();
  panels.notices = notices_.at(input.timeSeconds);
  panels.recentFiles.assign(recent_.paths().begin(), recent_.paths().end());
  panels.exportFormats = exportFormats();
  panels.keys = &keys_;
  panels.undoLabel = history_.undoLabel();
  panels.redoLabel = history_.redoLabel();
  panels.completePath = [](const std::string& typed) { return completePath(typed, openedEndings()); };
  if (!document_) return panels;
  panels.scene = summaryOf(*document_, workspace_.setup.parameters);
  panels.indirectIsStale = lightFactors() != workspace_.setup.indirectFactors &&
                           workspace_.setup.parameters.picture.method == Method::Vectors;
  panels.passLengths = views_.passes();
  panels.compiledScene = document_->scene.get();
  panels.pixel = inspection_.pixel();
  panels.record = inspection_.record();
  panels.full = inspection_.full();
  if (inspection_.isComputing())
    panels.fullProgress = fmt::format("{} samples", countText(Inspection::kSamples));
  if (inspection_.isWaiting()) panels.fullProgress = "Begins when the rendering rests.";
  panels.kept = describeKept();
  panels.reference = describeReference();
  panels.errorNote = errorWatch_.textOf(views_.frame().get());
  panels.errorSources = explanation_.sourcesOf(views_.frame().get());
  panels.errorSourcesNote = explanation_.textOf(views_.frame().get());
  panels.tradePoint = describeTradePoint();
  panels.trade = tradeStatus();
  panels.tracesReference = reference_.isTracing();
  panels.selectionIsPinned = selectionIsPinned();
  const auto& frame = views_.frame();
  if (!frame) return panels;
  const ViewImage& view =
      workspace_.display.comparison.flipped && rivalView_ ? *rivalView_->view : *views_.view();
  panels.shown = ShownView{view.view,       view.kind,   view.title, view.unit, pictureStyle(view).scale,
                           view.categories, view.empty()};
  if (!workspace_.display.comparison.flipped) panels.overlay = views_.overlay().get();
  panels.cursor = cursor_;
  if (frame->reduction == 1) {
    panels.estimateChange = [this](const Parameters& candidate) {
      if (!estimator_ || estimator_->frame() != views_.frame())
        estimator_ = std::make_unique<ChangeEstimator>(views_.frame());
      return estimator_->estimate(candidate, {lightFactors(), workspace_.setup.indirectFactors});
    };
  }
  panels.exportCommand = [this, frame](const fs::path& path) { return exportCommand(*frame, path); };
  return panels;
}

// ---- a frame

PreviewerOutput Previewer::update(const PreviewerInput& input) {
  const double passed = std::clamp(input.timeSeconds - time_, 0.0, kLongestFlight);
  time_ = input.timeSeconds;
  monitorScale_ = input.monitorScale;
  if (time_ - memoryTime_ >= kMemorySeconds || memoryBytes_ == 0) {
    memoryTime_ = time_;
    memoryBytes_ = residentBytes();
  }
  PreviewerOutput result;
  takeSession();
  takeDocument();
  takeCache();
  takeRecomputed();
  takeWritten();
  for (const fs::path& path : input.dropped) open(path);
  reloadIfChanged();
  takeReference();
  trade_.setYields(panels_.trade.waits && isWorking());
  takeFrame();
  takeRecordSteps();

  const PanelInput panels = panelInput(input);
  PanelOutput output;
  const Workspace before = workspace_;
  handleKeys(input, panels, output);
  layout_ = drawPanels(workspace_, panels, panels_, output);
  // What windows are as large as, and what lies under the mouse, is known a frame later.
  framesToSettle_ = input.keys.empty() ? std::max(framesToSettle_ - 1, 0) : kFramesToSettle;
  const bool marksOthers = stale_ != output.stale;
  stale_ = output.stale;
  if (input.wantsClose) result.quits = true;
  carryOut(output, result);
  cameraMoves_ = false;
  if (document_) {
    navigate();
    fly(input.flight, passed);
  }
  const std::string recordLabel = std::exchange(recordLabel_, {});
  history_.update(undoableOf(workspace_), output.gesture || cameraMoves_,
                  cameraMoves_ ? gestureLabel_ : recordLabel);
  keepSettings();
  recent_.update();
  sendRequest();
  updateCursor();
  drawMarks(panels);
  const bool fades = std::any_of(panels.notices.begin(), panels.notices.end(),
                                 [](const Notice& n) { return n.ageSeconds < kNoticeSeconds; });
  result.animates = output.animates || marksOthers || framesToSettle_ > 0 || input.flight != Vec3(0.0f) ||
                    workspace_ != before || fades || wantedCapture();
  result.works = isLoading() || settingsFile_.isBehind() || recent_.isBehind() ||
                 (document_ && (isWorking() || reference_.isTracing() || panels.trade.isRunning));
  result.watches = document_ && workspace_.display.reloads;
  result.fullScreen = workspace_.display.fullScreen;
  result.title = document_ ? fmt::format("{} - Lightvane", document_->path.filename().string()) : "Lightvane";
  return result;
}

void Previewer::handleKeys(const PreviewerInput& input, const PanelInput& panels, PanelOutput& output) {
  for (const KeyChord& chord : input.keys) {
    const auto action = keys_.actionFor(chord);
    if (!action) continue;
    const bool isTyping = ImGui::GetIO().WantTextInput;
    if (isTyping && !actionInfo(*action).whileTyping) continue;
    const std::string whyNot = actionStatus(*action, workspace_, panels, panels_).whyNot;
    if (!whyNot.empty() && !isTyping && !input.held.contains(chord))
      notify(Severity::Note, fmt::format("{}: {}", actionInfo(*action).label, whyNot));
    applyAction(*action, workspace_, panels, panels_, output);
    panels_.controls.isQuiet = true;
  }
}

void Previewer::carryOut(const PanelOutput& output, PreviewerOutput& result) {
  for (const ActionId action : output.actions) carryOut(action, result);
  if (output.open) open(output.open->path);
  if (output.goToCamera && *output.goToCamera < document_->description.cameras.size())
    setCamera(document_->description.cameras[*output.goToCamera]);
  if (output.exported) write(*output.exported);
  carryOutTrade(output);
  if (output.clipboard) result.clipboard = output.clipboard;
  for (const std::uint64_t id : output.dismissedNotices) notices_.dismiss(id);
  if (output.refreshIndirect) workspace_.setup.indirectFactors = lightFactors();
}

// One function a menu.
void Previewer::carryOut(ActionId action, PreviewerOutput& result) {
  switch (actionInfo(action).group) {
    case ActionGroup::File:
      return carryOutFile(action, result);
    case ActionGroup::Edit:
      return action == ActionId::Undo ? goTo(history_.undo()) : goTo(history_.redo());
    case ActionGroup::Render:
      return carryOutRender(action);
    case ActionGroup::Camera:
      return carryOutCamera(action);
    case ActionGroup::Compare:
      if (action == ActionId::CompareKeep) keepAsB();
      if (action == ActionId::CompareSwap) swapWithB();
      if (action == ActionId::ReferenceTrace) traceReference();
      return;
    case ActionGroup::Vectors:
      if (action == ActionId::ComputeHere) inspection_.computeHere();
      if (action == ActionId::RecordsPin) pinSelected();
      if (action == ActionId::RecordsRecompute) recomputeSelected();
      if (action == ActionId::RecordsDelete) deleteSelected();
      return;
    case ActionGroup::View:
    case ActionGroup::Window:
      return;  // all of them are the panels' own
  }
}

void Previewer::carryOutFile(ActionId action, PreviewerOutput& result) {
  if (action == ActionId::Quit) result.quits = true;
  if (action == ActionId::Reload) reload();
  if (action == ActionId::SaveSession) saveSessionAgain();
  if (action == ActionId::CopyCommand && views_.frame()) copyCommand(*views_.frame(), result);
  if (action == ActionId::CopyView) {
    result.clipboard = cameraToml(workspace_.setup.camera);
    notify(Severity::Note, "The camera is in the clipboard, as a [camera] of a scene file.");
  }
}

void Previewer::carryOutRender(ActionId action) {
  if (action == ActionId::Stop && loader_.isReading()) {
    notify(Severity::Note, fmt::format("{} is not read.", loader_.loading().string()));
    loader_.cancel();
    restored_.reset();
    reloading_ = true;
  } else if (action == ActionId::Stop) {
    stopped_ = true;
  }
  if (action == ActionId::Pause) {
    paused_ = !stopped_ && !paused_;
    stopped_ = false;
  }
  if (action == ActionId::Restart) {
    stopped_ = paused_ = false;
    workspace_.setup.indirectFactors = lightFactors();
    cache_ = nullptr;
    ++restarts_;
  }
}

void Previewer::carryOutCamera(ActionId action) {
  if (action == ActionId::CameraHome) setCamera(document_->description.cameras.front());
  if (action == ActionId::CameraNext) stepCamera(1);
  if (action == ActionId::CameraPrevious) stepCamera(-1);
  if (action == ActionId::CameraFrame) frameSelection();
}

void Previewer::frameSelection() {
  const auto& frame = views_.frame();
  if (!frame) return;
  if (const auto ball = ballAround(*frame, workspace_.selection))
    setCamera(framing(frame->camera, ball->centre, ball->radius));
}

void Previewer::goTo(const std::optional<Undoable>& state) {
  if (!state) return;
  for (RecordHistory::Step& step : recordHistory_.way(workspace_.setup.recordState, state->setup.recordState))
    recordSteps_.push_back(std::move(step));
  lightvane::restore(*state, workspace_);
}

void Previewer::noteRecordStep(RecordHistory::Step step, const std::string& label) {
  workspace_.setup.recordState = recordHistory_.add(workspace_.setup.recordState, std::move(step));
  recordLabel_ = label;
}

void Previewer::takeRecordSteps() {
  const auto& frame = views_.frame();
  if (recordSteps_.empty() || !frame || !frame->snapshot || frame->reduction > 1 || !isOfThisSetup(*frame))
    return;
  RenderFrame changed = *frame;
  for (const RecordHistory::Step& step : std::exchange(recordSteps_, {})) {
    changed.snapshot = step.after && step.after->isOf(changed)
                           ? step.after->vectors
                           : exchanged(changed, step.gone.get(), step.come.get());
    pinned_ = step.pinnedAfter;
  }
  if (changed.snapshot == frame->snapshot) return;
  cache_ = changed.snapshot;
  workspace_.selection.records.clear();
}

std::shared_ptr<const RecordHistory::Whole> Previewer::wholeOf(const RenderFrame& frame) {
  return std::make_shared<const RecordHistory::Whole>(
      RecordHistory::Whole{frame.snapshot, frame.scene, frame.parameters, frame.lights});
}

void Previewer::deleteSelected() {
  const auto& frame = views_.frame();
  if (!frame || !frame->snapshot || !isOfThisSetup(*frame)) return;
  const std::vector<RecordRef> records = std::exchange(workspace_.selection.records, {});
  cache_ = withoutRecords(*frame, records);
  RecordHistory::Step step{
      .gone = pin(nullptr, *frame, records), .pinnedBefore = pinned_, .before = wholeOf(*frame)};
  // Those that are pinned would come back.
  step.pinnedAfter = pinned_ = unpin(pinned_, *frame, records);
  noteRecordStep(std::move(step), "Delete " + vectorsText(records.size()));
  notify(Severity::Note,
         fmt::format("{} deleted{}", vectorsText(records.size()),
                     workspace_.setup.cacheLocked
                         ? "."
                         : fmt::format(": points that miss {} compute their own, unless the cache is locked.",
                                       records.size() == 1 ? "it" : "them")));
}

void Previewer::copyCommand(const RenderFrame& frame, PreviewerOutput& result) {
  result.clipboard = renderCommandHere(identityOf(frame), ".png");
  if (frame.warm) {
    notify(Severity::Warning, "The command is in the clipboard. " + otherVectorsNote());
  } else {
    notify(Severity::Note, "The command line of this picture is in the clipboard.");
  }
}

bool Previewer::selectionIsPinned() const {
  const auto& frame = views_.frame();
  return frame && arePinned(pinned_.get(), *frame, workspace_.selection.records);
}

void Previewer::pinSelected() {
  const auto& frame = views_.frame();
  if (!frame) return;
  const auto& records = workspace_.selection.records;
  const bool wasPinned = selectionIsPinned();
  RecordHistory::Step step{.pinnedBefore = pinned_};
  step.pinnedAfter = wasPinned ? unpin(pinned_, *frame, records) : pin(pinned_, *frame, records);
  if (step.pinnedAfter == pinned_) return;
  pinned_ = step.pinnedAfter;
  noteRecordStep(std::move(step), (wasPinned ? "Unpin " : "Pin ") + vectorsText(records.size()));
}

bool Previewer::isOfThisSetup(const RenderFrame& frame) const {
  return requested_ && frame.scene == requested_->scene && frame.parameters == requested_->parameters &&
         frame.lights == requested_->lights;
}

void Previewer::recomputeSelected() {
  const std::shared_ptr<const RenderFrame> frame = views_.frame();
  if (!frame || !frame->snapshot) return;
  recomputed_.start([frame, records = workspace_.selection.records,
                     threads = workspace_.setup.threads](const StopFlag& stop) -> Recomputed {
    const FlushDenormals flush;
    TaskPool pool(threads);
    return {frame, recomputed(*frame, records, pool, stop), records};
  });
}

void Previewer::takeRecomputed() {
  auto done = recomputed_.take();
  if (!done || !done->vectors) return;
  if (!isOfThisSetup(*done->frame)) {
    return notify(Severity::Warning,
                  "The vectors that were computed anew are of other parameters or lights, and not used.");
  }
  // Of those that are pinned, the new ones are.
  const std::vector<RecordRef> pinned = pinnedRecords(pinned_.get(), *done->frame);
  RenderFrame anew = *done->frame;
  anew.snapshot = cache_ = std::move(done->vectors);
  RecordHistory::Step step{.gone = pin(nullptr, *done->frame, done->records),
                           .come = pin(nullptr, anew, done->records),
                           .pinnedBefore = pinned_,
                           .before = wholeOf(*done->frame)};
  step.pinnedAfter = pinned_ = pin(pinned_, anew, pinned);
  noteRecordStep(std::move(step), "Recompute " + vectorsText(done->records.size()));
  notify(Severity::Note, fmt::format("{} computed anew.", vectorsText(done->records.size())));
}

// ---- the camera and the mouse

Camera Previewer::compiledCamera() const {
  // Every camera of the workspace was compiled before it got there, but steps may lead back to one of a scene
  // that was larger before its file was changed.
  const auto camera = compileCamera(document_->scene->normalisation, workspace_.setup.camera, "camera");
  return camera ? *camera : document_->scene->cameras.front();
}

void Previewer::setCamera(const CameraDescription& camera) {
  CameraDescription next = camera;
  // The size is the picture's, whoever looks from where.
  next.width = workspace_.setup.camera.width;
  next.height = workspace_.setup.camera.height;
  if (!compileCamera(document_->scene->normalisation, next, "camera")) return;
  workspace_.setup.camera = next;
}

void Previewer::stepCamera(int step) {
  const auto& cameras = document_->description.cameras;
  const auto count = static_cast<int>(cameras.size());
  // The one that is looked through, else one of the same place: several may share it.
  const CameraDescription& shown = workspace_.setup.camera;
  auto found = std::find_if(cameras.begin(), cameras.end(),
                            [&](const CameraDescription& camera) { return isSameView(camera, shown); });
  if (found == cameras.end()) {
    found = std::find_if(cameras.begin(), cameras.end(),
                         [&](const CameraDescription& camera) { return camera.position == shown.position; });
  }
  const int current = found == cameras.end() ? 0 : static_cast<int>(found - cameras.begin());
  setCamera(cameras[static_cast<std::size_t>((current + step + count) % count)]);
}

void Previewer::fly(const Vec3& flight, double seconds) {
  if (flight == Vec3(0.0f) || ImGui::GetIO().WantTextInput) return;
  const auto length = static_cast<float>(kFlightSpeed * seconds) * document_->scene->diagonal;
  setCamera(flown(compiledCamera(), length * flight));
  cameraMoves_ = true;
  gestureLabel_ = "Fly";
}

bool Previewer::isSideBySide() const {
  const Comparison& comparison = workspace_.display.comparison;
  return rivalView_ && comparison.mode == CompareMode::SideBySide && !comparison.flipped;
}

ScreenRect Previewer::pictureArea() const {
  if (!isSideBySide()) return layout_.picture;
  const auto [left, right] = layout_.picture.halves();
  return overRight_ ? right : left;
}

Placement Previewer::placementIn(const ScreenRect& area) const {
  return placePicture(workspace_.display.placement, area, workspace_.setup.camera.width,
                      workspace_.setup.camera.height);
}

double Previewer::pictureAreaInPoints() const {
  const double zoom = placementOfPicture().zoom / totalScale(workspace_.display, monitorScale_);
  return square(zoom) * workspace_.setup.camera.width * workspace_.setup.camera.height;
}

void Previewer::navigate() {
  const ImGuiIO& io = ImGui::GetIO();
  PictureMouse mouse;
  mouse.position = {io.MousePos.x, io.MousePos.y};
  mouse.overPicture = layout_.picture.contains(io.MousePos) && !io.WantCaptureMouse;
  for (int button = 0; button < 3; ++button) mouse.down[button] = io.MouseDown[button];
  mouse.wheel = io.MouseWheel;
  mouse.shift = io.KeyShift;
  mouse.ctrl = io.KeyCtrl;
  mouse.alt = io.KeyAlt;

  const CameraDescription& camera = workspace_.setup.camera;
  const auto& frame = views_.frame();
  Navigation::View view;
  view.camera = compiledCamera();
  view.up = worldUp(document_->scene->cameras.front());
  view.pivot = document_->scene->bounds.centre();
  if (!mouse.down[0] && !mouse.down[1] && !mouse.down[2])
    overRight_ = layout_.picture.halves().second.contains(io.MousePos);
  view.picture = placementOfPicture();
  view.placement = workspace_.display.placement;
  view.area = pictureArea();
  if (workspace_.display.comparison.mode == CompareMode::Wipe && rivalView_)
    view.wipe = workspace_.display.comparison.wipe;
  const auto pixel = pixelAt(view.picture, mouse.position, camera.width, camera.height);
  if (frame && pixel) view.pivot = surfaceAt(*frame, *pixel).value_or(view.pivot);

  const PictureMotion motion = navigation_.update(mouse, view);
  if (motion.camera) {
    setCamera(*motion.camera);
    cameraMoves_ = motion.held;
    gestureLabel_ = motion.label;
  }
  if (motion.placement) workspace_.display.placement = *motion.placement;
  if (motion.wipe) workspace_.display.comparison.wipe = *motion.wipe;
  dragged_ = motion.rectangle;
  if (!frame) return;
  Selection& selection = workspace_.selection;
  if (motion.clicked) {
    selection = selectionAfterClick(selection, *frame, views_.overlay().get(), view.picture, *motion.clicked,
                                    mouse.shift || mouse.ctrl);
    // What was clicked is to be explained.
    if (!(selection == Selection{})) panels_.rightTab = panels_.onlyTab = PanelTab::Inspector;
  }
  if (motion.chosen) {
    const OverlaySettings& overlays = workspace_.display.overlays;
    const PickedKinds kinds{overlays.layer(OverlayKind::Ilv).shown, overlays.layer(OverlayKind::Dlv).shown};
    const ScreenRect& area = *motion.chosen;
    selection = selectionAfterDrag(selection, *frame, kinds, view.picture, {area.min.x, area.min.y},
                                   {area.max.x, area.max.y}, mouse.alt);
  }
}

const Previewer::RivalView* Previewer::rivalUnderMouse() const {
  const Comparison& comparison = workspace_.display.comparison;
  if (!rivalView_ || rivalView_->view->empty()) return nullptr;
  const ScreenRect& area = layout_.picture;
  const bool isThere = comparison.flipped || (comparison.mode == CompareMode::SideBySide && overRight_) ||
                       (comparison.mode == CompareMode::Wipe &&
                        ImGui::GetIO().MousePos.x >= area.min.x + comparison.wipe * area.width());
  return isThere ? &*rivalView_ : nullptr;
}

void Previewer::updateCursor() {
  cursor_.reset();
  const auto& frame = views_.frame();
  const ImGuiIO& io = ImGui::GetIO();
  if (!frame || views_.view()->empty() || io.WantCaptureMouse || !layout_.picture.contains(io.MousePos))
    return;
  const RivalView* other = rivalUnderMouse();
  const ViewImage& view = other != nullptr ? *other->view : *views_.view();
  const int reduction = other != nullptr ? other->reduction : frame->reduction;
  const auto pixel = pixelAt(placementOfPicture(), {io.MousePos.x, io.MousePos.y}, view.width * reduction,
                             view.height * reduction);
  if (!pixel) return;
  cursor_ = CursorInfo{*pixel, {viewValueText(view, pixel->x / reduction, pixel->y / reduction)}};
  // In place of this picture, the other shows no vectors.
  if (workspace_.display.comparison.flipped && other != nullptr) return;
  const RecordRef record =
      recordAt(*frame, views_.overlay().get(), placementOfPicture(), {io.MousePos.x, io.MousePos.y});
  if (!record.isNone()) cursor_->lines.push_back(recordName(*frame->scene, record));
  // Its row in the inspector is lit, where there are rows.
  workspace_.selection.hoveredRecord = workspace_.selection.pixel ? record : RecordRef{};
}

// ---- drawing

void Previewer::drawMarks(const PanelInput& panels) const {
  const float scale = totalScale(workspace_.display, monitorScale_);
  const ScreenRect& area = layout_.picture;
  const Comparison& comparison = workspace_.display.comparison;
  const auto& view = views_.view();
  const bool isAlone = comparison.mode == CompareMode::Off && !comparison.flipped;
  if (view && !view->empty() && views_.frame()->reduction == 1 && isAlone)
    markValues(area, placementIn(area), *view, pictureStyle(*view));
  if (views_.frame() && workspace_.selection.pixel) {
    const auto [left, right] = area.halves();
    const ScreenRect first = isSideBySide() ? left : area;
    markPixel(first, placementIn(first), *workspace_.selection.pixel, scale);
    if (isSideBySide()) markPixel(right, placementIn(right), *workspace_.selection.pixel, scale);
  }
  if (dragged_)
    markRectangle(area, {dragged_->min.x, dragged_->min.y}, {dragged_->max.x, dragged_->max.y}, scale);
  if (!rivalView_) return;
  const bool isKept = comparison.with == CompareWith::Kept;
  const char* const who = isKept ? "B" : comparison.with == CompareWith::Point ? "Point" : "Reference";
  const std::string other = fmt::format("{}: {}", who, panels.rival(comparison.with).text);
  if (comparison.flipped) {
    markSplit(area, {other, "", area.max.x, false}, scale);
  } else {
    const bool isWipe = comparison.mode == CompareMode::Wipe;
    markSplit(area,
              {isKept ? "A: as it is now" : "As it is now", other,
               area.min.x + (isWipe ? comparison.wipe : 0.5f) * area.width(), isWipe},
              scale);
  }
}

PictureStyle Previewer::pictureStyle(const ViewImage& view) const {
  return styleFor(workspace_.look(), view, workspace_.setup.camera.exposureStops);
}

ShownPicture Previewer::shownPicture(std::shared_ptr<const ViewImage> view, int reduction,
                                     const Placement& placement) const {
  ShownPicture shown;
  shown.style = pictureStyle(*view);
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
  const float pixels = content.uiScale = ImGui::GetIO().DisplayFramebufferScale.x;
  PicturePlacement placed = workspace_.display.placement;
  placed.zoom *= pixels;
  placed.pan *= pixels;
  const auto placementAt = [&](const ScreenRect& area) {
    const ScreenRect scaled{{area.min.x * pixels, area.min.y * pixels},
                            {area.max.x * pixels, area.max.y * pixels}};
    return placePicture(placed, scaled, workspace_.setup.camera.width, workspace_.setup.camera.height);
  };
  const auto [left, right] = layout_.picture.halves();
  const Placement placement = placementAt(isSideBySide() ? left : layout_.picture);

  content.picture = shownPicture(views_.view(), frame->reduction, placement);
  const Comparison& comparison = workspace_.display.comparison;
  if (rivalView_ && !rivalView_->view->empty()) {
    ShownPicture other = shownPicture(rivalView_->view, rivalView_->reduction,
                                      isSideBySide() ? placementAt(right) : placement);
    if (comparison.flipped) {
      content.picture = std::move(other);
    } else if (showsBoth(comparison)) {
      content.second = std::move(other);
      if (comparison.mode == CompareMode::Wipe) content.wipe = comparison.wipe;
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
    overlay.pen.uiScale = pixels * totalScale(workspace_.display, monitorScale_);
    content.overlay = std::move(overlay);
  }
  return content;
}

CanvasContent Previewer::captureContent() const {
  CanvasContent content = this->content();
  const Placement whole{0, 0, views_.view()->width, views_.view()->height, Vec2(0.0f), 1.0f};
  content.picture = shownPicture(views_.view(), 1, whole);
  content.second.reset();
  if (content.overlay) content.overlay->placement = whole;
  return content;
}

}  // namespace lightvane
