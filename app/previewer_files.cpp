// What the previewer reads and writes: scenes, sessions, vectors, pictures.

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "app/frame_identity.h"
#include "app/previewer.h"
#include "app/version.h"
#include "app/view.h"
#include "core/base/file.h"
#include "core/base/number_text.h"
#include "core/base/text.h"
#include "core/image/image_file.h"
#include "core/io/ply_file.h"
#include "core/scene/load_scene.h"
#include "core/scene/supported.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

// Between two looks at whether a file has changed.
constexpr double kWatchSeconds = 1.0;
constexpr std::array<std::string_view, 10> kOpenedEndings = {
    ".toml", ".obj", ".ply", ".gltf", ".glb", kSessionEnding, kCacheEnding, ".exr", ".hdr", ".pfm"};
/// Of pictures, to be the reference.
constexpr auto kReferenceEndings = std::span(kOpenedEndings).last<3>();

std::string vectorCounts(const Snapshot& snapshot) {
  return fmt::format("{} ILVs and {} DLVs", countText(snapshot.indirect.size()),
                     countText(snapshot.directCount()));
}

/// When a file was changed last; the beginning of time where it is not there.
fs::file_time_type timeOf(const fs::path& path) {
  std::error_code error;
  const auto time = fs::last_write_time(path, error);
  return error ? fs::file_time_type::min() : time;
}

}  // namespace

std::span<const std::string_view> Previewer::openedEndings() { return kOpenedEndings; }

void Previewer::open(const fs::path& path) {
  const std::string ending = fileEnding(path);
  if (std::find(kReferenceEndings.begin(), kReferenceEndings.end(), ending) != kReferenceEndings.end()) {
    reference_.open(path);
  } else if (ending == kCacheEnding) {
    readVectors(path);
  } else if (ending == kSessionEnding) {
    sessionFile_.start([path, usual = settingsFile_.settings()](const StopFlag&) -> OpenedSession {
      return {path, loadSession(path, usual)};
    });
  } else if (sceneFileKind(path) == SceneFileKind::Unknown) {
    const std::vector<std::string> endings(kOpenedEndings.begin(), kOpenedEndings.end());
    notify(Severity::Error, fmt::format("{}: expected a {} file, found {}", path.string(), listWords(endings),
                                        foundFile(path)));
  } else {
    restored_.reset();
    reloading_ = false;
    loader_.load(path);
  }
}

void Previewer::reload() {
  if (!document_) return;
  restored_.reset();
  reloading_ = true;
  loader_.load(document_->path);
}

void Previewer::takeSession() {
  auto opened = sessionFile_.take();
  if (!opened) return;
  if (!opened->content) return notify(Severity::Error, opened->content.error().message());
  restored_ = *std::move(opened->content);
  restoredFrom_ = opened->path;
  reloading_ = false;
  loader_.load(restored_->scene);
}

void Previewer::takeDocument() {
  auto loaded = loader_.take();
  if (!loaded) return;
  if (*loaded) {
    show(**std::move(loaded));
  } else {
    reloading_ = true;
    const std::string message = loaded->error().message();
    if (!std::exchange(restored_, std::nullopt)) return notify(Severity::Error, message);
    notify(Severity::Error,
           fmt::format("{}. The session {} has it as its scene: mend that, or the line scene = there.",
                       message, restoredFrom_.string()));
  }
}

void Previewer::show(Document document) {
  // Read again, or compiled again for other rules of energy. A file that is opened begins as it says itself.
  const bool isRead = std::exchange(reloading_, true);
  const bool isSameFile = isRead && document_ && document_->path == document.path;
  if (!isSameFile && !restored_) sessionPath_.clear();
  const std::size_t lights = document.scene->lights.size();
  if (!isSameFile || workspace_.setup.lights.size() != lights) {
    workspace_.setup.parameters = document.start;
    workspace_.setup.camera = document.description.cameras.front();
    workspace_.setup.lights.assign(lights, {});
    workspace_.setup.indirectFactors.clear();
    workspace_.setup.brightness.exposureStops = 0.0f;
    workspace_.display.placement = {};
    workspace_.display.comparison = {};
    history_.reset(undoableOf(workspace_));
    panels_.parameters.filter.clear();
    kept_.reset();
    trade_.stop();
    tradePicture_.reset();
    pinned_ = nullptr;
    recordHistory_.clear();
    recordSteps_.clear();
  }
  if (isSameFile) {
    // The camera stays; how large a picture is, only the file says.
    workspace_.setup.camera.width = document.description.cameras.front().width;
    workspace_.setup.camera.height = document.description.cameras.front().height;
    const auto kept = compileCamera(document.scene->normalisation, workspace_.setup.camera, "The camera");
    if (!kept) {
      notify(Severity::Warning, kept.error().message() + ". The scene's own is used.");
      workspace_.setup.camera = document.description.cameras.front();
    }
  }
  workspace_.selection = {};
  for (const std::string& warning : document.warnings) notify(Severity::Warning, warning);
  if (restored_) sessionPath_ = restoredFrom_;
  recent_.add(restored_ ? restoredFrom_ : document.path);
  documentTime_ = timeOf(document.path);
  document_ = std::make_shared<const Document>(std::move(document));
  cache_ = nullptr;
  reference_.forgetTraced();
  stopped_ = false;
  ++restarts_;
  if (const auto saved = std::exchange(restored_, std::nullopt)) restore(*saved);
}

void Previewer::restore(const SessionFile& saved) {
  RestoredSession restored = applySession(saved, *document_, workspace_.display);
  for (const std::string& warning : restored.warnings) notify(Severity::Warning, warning);
  workspace_ = std::move(restored.workspace);
  workspace_.setup.indirectFactors = lightFactors();
  history_.reset(undoableOf(workspace_));
  // The session's, and nobody's change.
  shownSettings_ = windowSettings(workspace_.display);
}

void Previewer::keepSettings() {
  const WindowSettings now = windowSettings(workspace_.display);
  settingsFile_.keep(shownSettings_, now);
  shownSettings_ = now;
  settingsFile_.update(time_);
  if (const auto problem = settingsFile_.takeProblem()) notify(Severity::Error, *problem);
}

void Previewer::saveSessionAgain() {
  if (!sessionPath_.empty()) return write({sessionPath_, false});
  // Where, is asked once.
  panels_.exportDialog = ExportDialogState{
      .open = true, .takeFocus = true, .path = document_->path.stem().string() + std::string(kSessionEnding)};
}

std::optional<fs::file_time_type> Previewer::timeOfChange() const {
  if (!document_ || isLoading()) return std::nullopt;
  const fs::file_time_type now = timeOf(document_->path);
  // A file that is gone is being replaced.
  if (now == documentTime_ || now == fs::file_time_type::min()) return std::nullopt;
  return now;
}

void Previewer::reloadIfChanged() {
  if (!workspace_.display.reloads || time_ - watchTime_ < kWatchSeconds) return;
  watchTime_ = time_;
  const auto changed = timeOfChange();
  if (!changed) return;
  documentTime_ = *changed;
  notify(Severity::Note, fmt::format("{} changed and is read again.", document_->path.filename().string()));
  loader_.load(document_->path);
}

void Previewer::readVectors(const fs::path& path) {
  const Parameters& parameters = workspace_.setup.parameters;
  if (!document_) return notify(Severity::Error, "Vectors belong to a scene: open that first.");
  if (parameters.picture.method != Method::Vectors || parameters.vectors.rules == Rules::Printed) {
    return notify(Severity::Error,
                  "Vectors are of no use to this method and rules: set method.name to vectors, and "
                  "method.rules to paper or refined.");
  }
  CacheIdentity identity =
      vectorsIdentity(document_->description, workspace_.setup.indirectFactors, parameters);
  cacheFile_.start([path, scene = document_->scene, identity = std::move(identity),
                    vectors = parameters.vectors](const StopFlag&) -> OpenedCache {
    return {scene, path, readCache(path, identity, *scene, vectors)};
  });
}

void Previewer::takeCache() {
  auto opened = cacheFile_.take();
  if (!opened || !document_ || opened->scene != document_->scene) return;
  if (!opened->content) return notify(Severity::Error, opened->content.error().message());
  for (const std::string& warning : opened->content->warnings) notify(Severity::Warning, warning);
  cache_ = std::make_shared<const Snapshot>(std::move(opened->content->snapshot));
  workspace_.selection.records.clear();
  notify(Severity::Note, fmt::format("{} from {}.", vectorCounts(*cache_), opened->path.filename().string()));
}

void Previewer::write(const ExportRequest& request) {
  if (exporter_.isBusy()) {
    return notify(Severity::Warning, "Another file is being written: try again when it is there.");
  }
  const std::string ending = fileEnding(request.path);
  if (ending == kSessionEnding) {
    sessionPath_ = request.path;
    return exporter_.write(request.path, [path = request.path, saved = sessionOf(workspace_, *document_)] {
      return saveSession(saved, path);
    });
  }
  const std::shared_ptr<const RenderFrame> frame = views_.frame();
  if (!frame || frame->reduction > 1) {
    return notify(Severity::Warning, "There is no picture to export yet.");
  }
  if (ending != kCacheEnding && !isPlyPath(request.path)) return writePicture(request, frame);
  if (!frame->snapshot) return notify(Severity::Error, "This method has no vectors to be written.");
  exporter_.write(request.path, [frame, path = request.path, document = document_] {
    if (!isPlyPath(path)) return writeCache(path, *frame->snapshot, cacheIdentity(*frame, *document));
    return writePly(path, *frame->snapshot, *frame->scene, frame->parameters.vectors,
                    {fmt::format("Lightvane {}", versionText()), document->path.string()});
  });
}

void Previewer::writePicture(const ExportRequest& request, const std::shared_ptr<const RenderFrame>& frame) {
  if (auto checked = checkWritableImage(request.path); !checked) {
    return notify(Severity::Error, checked.error().message());
  }
  const PictureIdentity made = identityOf(*frame, request.path);
  std::optional<Exporter::Beside> vectors;
  if (made.cache) {
    vectors = {*made.cache, [frame, cache = *made.cache, owner = cacheIdentity(*frame, *document_)] {
                 return writeCache(cache, *frame->warm, owner);
               }};
  }
  const std::string ending = fileEnding(request.path);
  std::map<std::string, std::string> metadata = pictureMetadata(made, ending);
  const std::shared_ptr<const ViewImage> view = isForScreens(ending) ? views_.view() : nullptr;
  if (view && view->empty())
    return notify(Severity::Warning, fmt::format("There is nothing to export: {}.", view->title));
  if (view && request.withOverlay) {
    // What is shown, at the picture's own size: drawn by the next frame's canvas.
    return exporter_.capture({captureContent(), frame->film->width, frame->film->height}, request.path,
                             std::move(metadata), std::move(vectors));
  }
  const PictureStyle style = view ? pictureStyle(*view) : PictureStyle{};
  exporter_.write(
      request.path,
      [frame, view, style, metadata = std::move(metadata), path = request.path] {
        // As `lightvane render` does.
        LayeredImage image =
            view ? filePicture(displayColors(*view, style)) : frame->film->toLayers(*frame->scene);
        image.metadata = metadata;
        return writeImage(path, image);
      },
      std::move(vectors));
}

void Previewer::takeWritten() {
  const auto written = exporter_.take();
  if (!written) return;
  if (written->done) {
    std::error_code ignored;
    const std::string picture = fs::absolute(written->path, ignored).string();
    notify(Severity::Note, written->beside.empty()
                               ? fmt::format("Wrote {}.", picture)
                               : fmt::format("Wrote {}, and beside it {} with the vectors that it needs.",
                                             picture, written->beside.filename().string()));
  } else {
    notify(Severity::Error, written->done.error().message());
  }
}

}  // namespace lightvane
