#include "app/reference.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/units.h"
#include "core/measure/comparison.h"
#include "core/measure/picture_error.h"

namespace lightvane {
namespace {

// What is made of a frame takes milliseconds of the window's.
constexpr double kSecondsBetweenFrames = 1.0;

int samplesOf(const RenderFrame& frame) {
  return static_cast<int>(std::lround(frame.progress.fraction * Reference::kMostSamples));
}

}  // namespace

Reference::Reference(std::function<void()> wake)
    : wake_(std::move(wake)), noiseOfFrame_(wake_), file_(wake_) {}

void Reference::trace(const SessionRequest& picture) {
  file_.cancel();
  SessionRequest request = picture;
  request.parameters.picture.method = Method::Path;
  request.parameters.picture.pathSamples = kMostSamples;
  // Paths see the lights as the picture's direct light has them.
  request.lights.indirect = request.lights.direct;
  request.cache = nullptr;
  request.locked = false;
  wanted_ = std::move(request);
  sent_.reset();
  picture_ = nullptr;
  noiseOfFrame_.cancel();
  noise_.reset();
  path_.clear();
  tracing_ = true;
  paused_ = false;
}

void Reference::forgetTraced() {
  if (!wanted_) return;
  wanted_.reset();
  sent_.reset();
  // It ends when its pass has stopped.
  if (session_) ending_.run([session = std::shared_ptr<Session>(std::move(session_))] {});
  picture_ = nullptr;
  noiseOfFrame_.cancel();
  noise_.reset();
  tracing_ = paused_ = false;
}

void Reference::open(const std::filesystem::path& path) {
  file_.start([path](const StopFlag&) -> FilePicture { return {path, readImage(path)}; });
}

void Reference::sendRequest(const SessionRequest& wanted, bool yields) {
  if (!session_) session_ = std::make_unique<Session>(wake_);
  SessionRequest request = wanted;
  request.paused = paused_ || yields;
  if (sent_ == request) return;
  const std::uint64_t number = session_->request(request);
  if (!sent_) number_ = number;
  sent_ = std::move(request);
}

void Reference::takeFrame(double now) {
  auto frame = session_->frame();
  const bool isOwn =
      frame && frame->request >= number_ && frame->reduction == 1 && frame->statistics.passes > 0;
  if (!isOwn || (picture_ && picture_->frame() == frame)) return;
  if (picture_ && !frame->complete && now - taken_ < kSecondsBetweenFrames) return;
  taken_ = now;
  tracing_ = tracing_ && !frame->complete;
  if (frame->complete || !noiseOfFrame_.isBusy()) {
    noiseOfFrame_.start(
        [frame](const StopFlag&) { return pictureNoise(frame->film->beauty(), frame->film->variance); });
  }
  picture_ = std::make_unique<RivalPicture>(std::move(frame));
}

std::optional<std::string> Reference::update(bool yields, double now) {
  if (wanted_) {
    sendRequest(*wanted_, yields);
    takeFrame(now);
    if (const auto noise = noiseOfFrame_.take()) noise_ = noise;
    if (const std::string error = session_->status().error; tracing_ && !error.empty()) {
      tracing_ = false;
      return error;
    }
  }
  auto file = file_.take();
  if (!file) return std::nullopt;
  if (!file->picture) return file->picture.error().message();
  forgetTraced();
  picture_ = std::make_unique<RivalPicture>(file->picture->rgb(), varianceOf(*file->picture));
  path_ = file->path;
  return std::nullopt;
}

bool Reference::shows(const SessionRequest& picture) const {
  if (!wanted_) {
    return picture_ && picture_->beauty()->width() == picture.camera.width &&
           picture_->beauty()->height() == picture.camera.height;
  }
  Camera camera = picture.camera;
  camera.exposureStops = wanted_->camera.exposureStops;
  return wanted_->scene == picture.scene && wanted_->camera == camera &&
         wanted_->lights.direct == picture.lights.direct &&
         wanted_->parameters.picture.filmSamples == picture.parameters.picture.filmSamples;
}

std::string Reference::text() const {
  if (!wanted_) return path_.filename().string();
  if (!picture_) return "path traced, no sample yet";
  return fmt::format("path traced, {} samples{}{}", countText(samplesOf(*picture_->frame())),
                     noise_ ? fmt::format(", noise {} %", numberText(100.0 * *noise_, 2)) : "",
                     paused_ ? ", paused" : "");
}

}  // namespace lightvane
