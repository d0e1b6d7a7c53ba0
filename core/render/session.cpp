#include "core/render/session.h"

#include <chrono>
#include <cmath>
#include <exception>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/base/freed_memory.h"
#include "core/base/number_text.h"
#include "core/render/change.h"
#include "core/render/memory.h"

namespace lightvane {
namespace {

// Pixels of a preview: about 10 ms of work on two cores.
constexpr double kPreviewPixels = 11000.0;
// Faster than the eye follows, frames would only cost time.
constexpr std::int64_t kLeastMillisecondsBetweenFrames = 40;
// A preview with more points than this part unanswered shows less light than the first coarse pass.
constexpr double kMostUnanswered = 0.02;

std::int64_t nowInMilliseconds() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// How much coarser a preview is than the picture; 1 where none is worth while.
int previewReduction(const Camera& camera) {
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const int reduction = static_cast<int>(std::ceil(std::sqrt(pixels / kPreviewPixels)));
  return std::min({reduction, camera.width, camera.height});
}

Camera reduced(Camera camera, int reduction) {
  camera.width = (camera.width + reduction - 1) / reduction;
  camera.height = (camera.height + reduction - 1) / reduction;
  return camera;
}

/// The picture does not depend on how bright it is shown.
bool samePicture(Camera a, const Camera& b) {
  a.exposureStops = b.exposureStops;
  return a == b;
}

bool usesVectors(const Parameters& parameters) {
  return parameters.picture.method == Method::Vectors && parameters.vectors.rules != Rules::Printed;
}

}  // namespace

/// Where frames go that nobody holds any more.
struct Session::Bin {
  std::mutex mutex;
  std::vector<std::unique_ptr<const RenderFrame>> frames;
  bool closed = false;  ///< the session is gone: frames are freed where they are let go

  void put(const RenderFrame* frame) {
    std::unique_ptr<const RenderFrame> owned(frame);
    const std::lock_guard lock(mutex);
    if (!closed) frames.push_back(std::move(owned));
  }
  void empty() {
    std::vector<std::unique_ptr<const RenderFrame>> freed;
    const std::lock_guard lock(mutex);
    freed.swap(frames);
  }
};

Session::Session(std::function<void()> published)
    : published_(std::move(published)), bin_(std::make_shared<Bin>()), thread_([this] { run(); }) {}

Session::~Session() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
    interrupt_ = true;
  }
  wake_.notify_all();
  thread_.join();
  const std::lock_guard lock(bin_->mutex);
  bin_->closed = true;
}

std::uint64_t Session::request(SessionRequest request) {
  std::uint64_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    pending_ = std::move(request);
    number = ++pendingNumber_;
    interrupt_ = true;
  }
  wake_.notify_all();
  return number;
}

std::shared_ptr<const RenderFrame> Session::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

SessionStatus Session::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool Session::hasWork() const {
  return renderer_ && current_ && !current_->paused && !renderer_->done() && !renderer_->isOutOfMemory();
}

void Session::run() {
  const FlushDenormals flush;
  for (;;) {
    std::optional<SessionRequest> next;
    bin_->empty();
    {
      std::unique_lock lock(mutex_);
      if (!pending_ && !ending_ && !hasWork()) {
        status_.working = false;
        lock.unlock();
        if (published_) published_();
        if (std::exchange(isNewScene_, false)) returnFreedMemory();
        lock.lock();
        wake_.wait(lock, [&] { return pending_ || ending_; });
      }
      if (ending_) return;
      next = std::exchange(pending_, std::nullopt);
      currentNumber_ = pendingNumber_;
      interrupt_ = false;
      status_.working = true;
    }
    try {
      if (next) begin(*next);
      if (hasWork()) runPass();
    } catch (const std::bad_alloc&) {
      fail("this takes more memory than there is: a smaller picture or fewer samples take less");
    } catch (const std::exception& broken) {
      fail(broken.what());
    }
  }
}

void Session::fail(const std::string& what) {
  renderer_ = nullptr;
  const std::lock_guard lock(mutex_);
  status_.error = what;
}

void Session::keep() {
  if (!renderer_ || !usesVectors(context_.parameters)) return;
  kept_ = Kept{context_.parameters, context_.camera, context_.lights, renderer_->gathered(),
               renderer_->knownView()};
}

CacheInput Session::cacheFor(const SessionRequest& next, const SessionRequest* before) {
  CacheInput cache;
  cache.locked = next.locked;
  cache.memoryLimitBytes = next.memoryLimitBytes;
  const bool sameScene = before != nullptr && before->scene == next.scene;
  if (!sameScene) kept_.reset();
  const bool begunAnew = before != nullptr && before->restarts != next.restarts;
  const bool newCache = next.cache && (before == nullptr || before->cache != next.cache);
  if (!usesVectors(next.parameters)) return cache;
  if (kept_) {
    const StillTrue still =
        stillTrue(*next.scene, kept_->parameters, kept_->lights, next.parameters, next.lights);
    if (!begunAnew && !newCache)
      cache.warm = stillTrueVectors(kept_->vectors, still, *next.scene, next.parameters);
    if (still.points && samePicture(kept_->camera, next.camera)) {
      cache.known = kept_->view;
      if (!still.sampled) cache.known.sampled.clear();
      // What others answered is not known.
      if (!cache.warm) cache.known.directQuestions = {};
      // Lights that are seen show their own radiance.
      if (kept_->lights.direct != next.lights.direct) cache.known.points = nullptr;
    }
  }
  if (newCache) cache.warm = next.cache;
  cache.warm = withPinned(std::move(cache.warm), next.pinned.get(), next.scene, next.parameters.vectors);
  // Without vectors it begins as if it were the first.
  if (cache.warm && cache.warm->indirect.empty() && cache.warm->directCount() == 0) cache.warm = nullptr;
  return cache;
}

/// Whether the rendering is what is asked for, so that it goes on where it was.
bool Session::goesOn(const SessionRequest& next, const SessionRequest& before) const {
  SessionRequest same = before;
  same.paused = next.paused;
  same.camera.exposureStops = next.camera.exposureStops;
  same.pinned = next.pinned;
  if (same != next) return false;
  if (before.pinned == next.pinned || !usesVectors(next.parameters)) return true;
  // Pinning what is there changes nothing yet.
  const std::shared_ptr<const Snapshot> vectors = renderer_->gathered();
  return withPinned(vectors, next.pinned.get(), next.scene, next.parameters.vectors) == vectors;
}

/// Refuses a picture that would not fit before anything is allocated for it. Vectors stay for the next.
bool Session::refuseForMemory(const SessionRequest& next) {
  if (next.memoryLimitBytes == 0) return false;
  const std::size_t bytes =
      estimatedPictureBytes(*next.scene, next.parameters, PictureRegion::whole(next.camera));
  if (bytes <= next.memoryLimitBytes) return false;
  fail(
      fmt::format("a picture of {} x {} pixels takes about {}, and the limit is {}: make it smaller, take "
                  "fewer samples a pixel, or raise the limit",
                  next.camera.width, next.camera.height, byteText(bytes), byteText(next.memoryLimitBytes)));
  return true;
}

void Session::begin(const SessionRequest& next) {
  if (current_ && renderer_ && goesOn(next, *current_)) {
    current_ = next;
    // Until it has a frame of its own, what is shown is another picture.
    if (isShown_) publish(*frame());
    return;
  }
  keep();
  {
    const std::lock_guard lock(mutex_);
    status_.error.clear();
    status_.stopped.clear();
  }
  // As if it had not been asked for: what it brings is new to the next.
  if (refuseForMemory(next)) return;
  const std::optional<SessionRequest> before = std::exchange(current_, next);
  isNewScene_ = isNewScene_ || (before && before->scene != next.scene);
  if (!pool_ || !before || before->threads != next.threads) pool_ = std::make_shared<TaskPool>(next.threads);
  cache_ = cacheFor(next, before ? &*before : nullptr);
  renderer_ = nullptr;
  isShown_ = false;
  context_ = {next.scene,      next.tracer, next.camera, PictureRegion::whole(next.camera),
              next.parameters, pool_,       next.lights};
  publishPreview();
  renderer_ = makeRenderer(context_, cache_);
  unpublished_ = false;
}

void Session::publishPreview() {
  showFrom_ = 1 << 30;
  const int reduction = previewReduction(context_.camera);
  if (reduction <= 1) return;
  RenderContext small = context_;
  small.camera = reduced(context_.camera, reduction);
  small.region = PictureRegion::whole(small.camera);
  CacheInput cache{.warm = cache_.warm, .locked = true, .takesOwn = false};
  // `printed` computes row by row, `naive` tile by tile: what they would show at once is direct light.
  const Method method = small.parameters.picture.method;
  if (method == Method::Naive || (method == Method::Vectors && !usesVectors(small.parameters)))
    small.parameters.picture.method = Method::Direct;
  const std::unique_ptr<Renderer> renderer = makeRenderer(small, cache);
  const bool isEndless = small.parameters.picture.method == Method::Path;
  while (!renderer->done() && !(isEndless && renderer->statistics().passes > 0)) {
    if (!renderer->runPass(ending_)) return;
  }
  RenderFrame frame = makeFrame(small, *renderer);
  frame.reduction = reduction;
  frame.complete = false;
  const double points = frame.points ? static_cast<double>(frame.points->pointCount()) : 0.0;
  if (static_cast<double>(frame.statistics.unanswered) <= kMostUnanswered * points) showFrom_ = reduction;
  publish(std::move(frame));
}

void Session::runPass() {
  const bool whole = renderer_->runPass(interrupt_);
  if (whole) unpublished_ = true;
  {
    const std::lock_guard lock(mutex_);
    status_.request = currentNumber_;
    status_.statistics = renderer_->statistics();
    status_.progress = renderer_->progress();
  }
  if (renderer_->isOutOfMemory()) {
    const std::lock_guard lock(mutex_);
    status_.stopped = fmt::format(
        "stopped after {} passes: more vectors would go beyond the memory limit of {}. A larger limit, a "
        "smaller picture or fewer vectors lets it end",
        renderer_->statistics().passes, byteText(cache_.memoryLimitBytes));
  }
  const int spacing = renderer_->progress().spacing;
  const bool fine = spacing > 0 && spacing <= showFrom_;
  const bool due = renderer_->done() || renderer_->isOutOfMemory() ||
                   nowInMilliseconds() - lastPublished_ >= kLeastMillisecondsBetweenFrames;
  if (unpublished_ && fine && due) {
    publish(makeFrame(context_, *renderer_));
    unpublished_ = false;
  }
}

void Session::publish(RenderFrame frame) {
  frame.number = ++frameNumber_;
  frame.request = currentNumber_;
  std::shared_ptr<const RenderFrame> next(new RenderFrame(std::move(frame)),
                                          [bin = bin_](const RenderFrame* old) { bin->put(old); });
  lastPublished_ = nowInMilliseconds();
  isShown_ = true;
  {
    const std::lock_guard lock(mutex_);
    frame_.swap(next);
  }
  if (published_) published_();
}

}  // namespace lightvane
