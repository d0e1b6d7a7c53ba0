#include "app/reference.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/units.h"

namespace lightvane {
namespace {

/// The standard error of a pixel's luminance, root mean square over the picture, as a part of the picture's
/// mean luminance; 0 where it is not known.
double relativeNoise(const Film& film) {
  double variance = 0.0, mean = 0.0;
  for (std::size_t i = 0; i < film.variance.size(); ++i) {
    // Of colours that vary together: the luminance of the standard errors.
    variance += std::pow(static_cast<double>(luminance(glm::sqrt(film.variance[i]))), 2.0);
    mean += luminance(film.beauty(i));
  }
  if (!(mean > 0.0)) return 0.0;
  const auto pixels = static_cast<double>(film.variance.size());
  return std::sqrt(variance / pixels) / (mean / pixels);
}

// What is made of a frame takes milliseconds of the window's.
constexpr double kSecondsBetweenFrames = 1.0;

int samplesOf(const RenderFrame& frame) {
  return static_cast<int>(std::lround(frame.progress.fraction * Reference::kMostSamples));
}

}  // namespace

Reference::Reference(std::function<void()> wake) : wake_(std::move(wake)), file_(wake_) {}

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
  tracing_ = paused_ = false;
}

void Reference::open(const std::filesystem::path& path) {
  file_.start([path](const StopFlag&) -> FilePicture {
    auto image = readImage(path);
    if (!image) return {path, tl::unexpected(image.error())};
    return {path, image->rgb()};
  });
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
  noise_ = relativeNoise(*frame->film);
  picture_ = std::make_unique<RivalPicture>(std::move(frame));
}

std::optional<std::string> Reference::update(bool yields, double now) {
  if (wanted_) {
    sendRequest(*wanted_, yields);
    takeFrame(now);
    if (const std::string error = session_->status().error; tracing_ && !error.empty()) {
      tracing_ = false;
      return error;
    }
  }
  auto file = file_.take();
  if (!file) return std::nullopt;
  if (!file->picture) return file->picture.error().message();
  forgetTraced();
  picture_ = std::make_unique<RivalPicture>(*std::move(file->picture));
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
  return fmt::format("path traced, {} samples, noise {} %{}", countText(samplesOf(*picture_->frame())),
                     numberText(100.0 * noise_, 2), paused_ ? ", paused" : "");
}

}  // namespace lightvane
