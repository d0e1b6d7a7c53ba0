#include "app/trade.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/statistics_file.h"
#include "app/version.h"
#include "core/base/number_text.h"
#include "core/image/image_file.h"
#include "core/inspect/units.h"
#include "core/measure/picture_error.h"
#include "core/measure/sweep_run.h"

namespace lightvane {
namespace {

using SteadyClock = std::chrono::steady_clock;

constexpr int kMostReferencePaths = 1 << 20;
// A file of a smaller picture than that of so many pixels for one is of another.
constexpr int kMostReduction = 64;

int coarseSize(int pixels, int reduction) { return (pixels + reduction - 1) / reduction; }

Camera reducedBy(Camera camera, int reduction) {
  camera.width = coarseSize(camera.width, reduction);
  camera.height = coarseSize(camera.height, reduction);
  return camera;
}

/// The size does not count, nor does what only a screen shows.
bool isSameCamera(Camera a, const Camera& b) {
  a.width = b.width;
  a.height = b.height;
  a.exposureStops = b.exposureStops;
  return a == b;
}

/// This thread alone. The window's and the renderer's go before it wherever they have something to do.
void takeLowestPriority() {
  constexpr int kLeastUrgent = 19;
  // Without it the measurement only is less polite.
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLeastUrgent));
}

/// Those of which less is better: what a plot of errors can show.
std::vector<const MetricInfo*> tradeMetrics() {
  std::vector<const MetricInfo*> all = allMetrics();
  std::erase_if(all, [](const MetricInfo* metric) { return metric->better != BetterValue::Lower; });
  return all;
}

/// Why points of a measurement are not of what is shown now; empty where they are, but for parameters.
std::string whyStale(const TradeSubject& measured, const TradeSubject& now) {
  if (now.document->path != measured.document->path) return "These points are of another scene.";
  if (now.document->scene->hash != measured.document->scene->hash)
    return "The scene has changed since these points were measured.";
  if (!isSameCamera(now.camera, measured.camera)) return "These points are of another camera.";
  if (now.lights != measured.lights) return "These points are of other lights.";
  return {};
}

}  // namespace

/// Paths that were traced, and what for.
struct TradeMeasurement::TracedReference {
  std::shared_ptr<const Scene> scene;
  Camera camera;
  std::vector<Rgb> lights;
  TransportParameters transport;
  int filmSamples = 1;
  LayeredImage picture;
  int paths = 0;
  double noise = 1.0;

  bool serves(const RenderContext& context, double mostNoise) const {
    return scene == context.scene && camera == context.camera && lights == context.lights.direct &&
           transport == context.parameters.transport &&
           filmSamples == context.parameters.picture.filmSamples && noise <= mostNoise;
  }
  std::string text() const {
    return fmt::format("{} paths a pixel, noise {} %", countText(static_cast<std::size_t>(paths)),
                       numberText(100.0 * noise, 2));
  }
};

/// What both threads know.
struct TradeMeasurement::Shared {
  StopFlag stop{false};
  StopFlag enough{false};  ///< of the reference
  mutable std::mutex mutex;
  std::condition_variable changed;
  // Under the mutex:
  bool yields = false;
  TradeStatus status;  ///< but for what is stale
  std::vector<std::shared_ptr<const ImageRgb>> pictures;
  std::shared_ptr<const TracedReference> traced;
  int reduction = 1;
};

/// One measurement, on its thread.
class TradeMeasurement::Work {
 public:
  Work(std::shared_ptr<Shared> shared, TradePlan plan, TradeSubject subject, std::function<void()> wake)
      : shared_(std::move(shared)),
        plan_(std::move(plan)),
        subject_(std::move(subject)),
        wake_(std::move(wake)) {}

  void run() {
    takeLowestPriority();
    const auto done = measure();
    tell([&](TradeStatus& status) {
      status.isRunning = status.isWaiting = status.isTracing = false;
      status.secondsLeft.reset();
      if (!done) status.error = done.error().message();
      status.stage = !done || !status.sweep ? std::string()
                                            : fmt::format("{}{} of {} runs measured.",
                                                          *done ? "" : "Stopped: ", runsDone_, runsInAll_);
    });
  }

 private:
  /// Changes what is told, and wakes the window.
  template <class Change>
  void tell(const Change& change) {
    {
      const std::lock_guard lock(shared_->mutex);
      change(shared_->status);
    }
    if (wake_) wake_();
  }

  /// Until the window's picture rests.
  void wait() {
    std::unique_lock lock(shared_->mutex);
    if (!shared_->yields || shared_->stop) return;
    const SteadyClock::time_point begun = SteadyClock::now();
    shared_->status.isWaiting = true;
    shared_->changed.wait(lock, [&] { return !shared_->yields || shared_->stop; });
    shared_->status.isWaiting = false;
    waited_ += SteadyClock::now() - begun;
  }

  /// Since a stage began, without what was spent waiting.
  double workedSeconds() const {
    return std::chrono::duration<double>(SteadyClock::now() - stageBegun_ - waited_).count();
  }
  void beginStage() {
    stageBegun_ = SteadyClock::now();
    waited_ = {};
  }
  void tellStage(const std::string& text, double fraction) {
    const double worked = workedSeconds();
    tell([&](TradeStatus& status) {
      status.stage = text;
      status.fraction = fraction;
      status.secondsLeft.reset();
      if (fraction > 0.0) status.secondsLeft = worked / fraction - worked;
    });
  }

  RenderContext contextFor(const Document& document, const Parameters& parameters) const {
    return {document.scene, document.tracer, reduced_,       PictureRegion::whole(reduced_),
            parameters,     pool_,           subject_.lights};
  }

  /// Scenes are compiled by a rule that parameters may vary.
  Expected<const Document*> documentFor(const Parameters& parameters) {
    const EnergyRule energy = energyRuleFor(parameters);
    if (energy == subject_.document->energy) return subject_.document.get();
    if (!other_ || other_->energy != energy) {
      auto compiled = recompiled(*subject_.document, energy);
      if (!compiled) return tl::unexpected(compiled.error());
      other_ = *std::move(compiled);
    }
    return &*other_;
  }

  /// True where all runs are done, false where it was stopped.
  Expected<bool> measure() {
    const std::vector<SweepSettings> points = sweepGrid(plan_.varied);
    const auto parameters = withEachSettings(subject_.parameters, points);
    if (!parameters) return tl::unexpected(parameters.error());
    runsInAll_ = points.size() * static_cast<std::size_t>(plan_.seeds);
    const auto reference = plan_.reference.empty() ? traceReference() : readReference();
    if (!reference) return tl::unexpected(reference.error());
    if (!*reference) return false;
    beginSweep();
    // Memory is taken and pages are touched before anything is measured.
    if (auto warm = renderUnmeasured(parameters->front()); !warm || !*warm) return warm;
    beginStage();
    // Seed by seed over all points: what else the machine does meets them all alike.
    for (int seed = 0; seed < plan_.seeds; ++seed) {
      for (std::size_t p = 0; p < points.size(); ++p) {
        const SweepPoint named{
            choiceName(kMethodNames, (*parameters)[p].picture.method), points[p], {}, {}, {}, {}, {}};
        tellStage(fmt::format("{} of {}: {}, seed {}", runsDone_ + 1, runsInAll_, named.name(),
                              (*parameters)[p].picture.seed + static_cast<std::uint64_t>(seed)),
                  static_cast<double>(runsDone_) / static_cast<double>(runsInAll_));
        auto done = measurePoint(named, p, (*parameters)[p], seed);
        if (!done || !*done) return done;
      }
    }
    return true;
  }

  void beginSweep() {
    sweep_.scene = subject_.document->path.string();
    sweep_.sceneHash = subject_.document->scene->hash;
    sweep_.width = reduced_.width;
    sweep_.height = reduced_.height;
    sweep_.threads = pool_->threadCount();
    sweep_.version = versionText();
    sweep_.reference = referenceName_;
    sweep_.referenceNoise = referenceNoise_;
    sweep_.varied = plan_.varied;
    tell([&](TradeStatus& status) {
      status.reference = referenceName_;
      status.isTracing = false;
    });
  }

  Expected<bool> renderUnmeasured(const Parameters& parameters) {
    const auto document = documentFor(parameters);
    if (!document) return tl::unexpected(document.error());
    const std::unique_ptr<Renderer> renderer = makeRenderer(contextFor(**document, parameters));
    return renderToEnd(*renderer, shared_->stop, [this] { wait(); });
  }

  Expected<bool> measurePoint(const SweepPoint& named, std::size_t index, Parameters parameters, int seed) {
    const auto document = documentFor(parameters);
    if (!document) return tl::unexpected(document.error());
    const Parameters first = parameters;
    parameters.picture.seed += static_cast<std::uint64_t>(seed);
    const RunConditions conditions{
        .reference = *reference_,
        .referenceName = referenceName_,
        .comparison = {tradeMetrics(), {}, false, false, static_cast<double>(reduced_.exposureStops)},
        .cpuSeconds = threadCpuSeconds,
        .beforePass = [this] { wait(); }};
    auto measured = measureRun(contextFor(**document, parameters), conditions, shared_->stop);
    if (!measured) return tl::unexpected(measured.error());
    // What was stopped while it was compared comes too late: nobody expects another point.
    std::optional<MeasuredRun>& run = *measured;
    if (!run || shared_->stop) return false;
    if (index == sweep_.points.size()) sweep_.points.push_back(named);
    sweep_.points[index].runs.push_back(std::move(run->run));
    ++runsDone_;
    auto sweep = std::make_shared<const Sweep>(sweep_);
    std::shared_ptr<const ImageRgb> picture;
    if (seed == 0) {
      const RenderFrame& frame = run->frame;
      picture = std::make_shared<const ImageRgb>(frame.film->sceneBeauty(*frame.scene));
    }
    tell([&](TradeStatus& status) {
      if (shared_->stop) return;  // it was set under the mutex: nothing is added after that
      status.sweep = std::move(sweep);
      status.fraction = static_cast<double>(runsDone_) / static_cast<double>(runsInAll_);
      if (!picture) return;
      status.parameters.push_back(first);
      shared_->pictures.push_back(std::move(picture));
    });
    return true;
  }

  // ---- the reference: false where it was stopped

  Expected<bool> traceReference() {
    setReduction(plan_.reduction);
    Parameters parameters = subject_.parameters;
    parameters.picture.method = Method::Path;
    parameters.picture.pathSamples = kMostReferencePaths;
    parameters.picture.seed = kReferenceSeed;
    RenderContext context = contextFor(*subject_.document, parameters);
    // Paths see the lights as the picture's direct light has them.
    context.lights.indirect = context.lights.direct;
    std::shared_ptr<const TracedReference> traced;
    {
      const std::lock_guard lock(shared_->mutex);
      traced = shared_->traced;
    }
    if (!traced || !traced->serves(context, plan_.referenceNoise)) {
      auto now = tracePaths(context);
      if (!now) return false;
      traced = std::make_shared<const TracedReference>(*std::move(now));
      const std::lock_guard lock(shared_->mutex);
      shared_->traced = traced;
    }
    reference_ = std::shared_ptr<const LayeredImage>(traced, &traced->picture);
    referenceName_ = "the path traced reference: " + traced->text();
    referenceNoise_ = traced->noise;
    return true;
  }

  std::optional<TracedReference> tracePaths(const RenderContext& context) {
    TracedReference traced{context.scene,
                           context.camera,
                           context.lights.direct,
                           context.parameters.transport,
                           context.parameters.picture.filmSamples,
                           {}};
    const FlushDenormals flush;
    const std::unique_ptr<Renderer> renderer = makeRenderer(context);
    beginStage();
    tellStage("Traces the reference.", 0.0);
    while (!renderer->done()) {
      wait();
      if (!renderer->runPass(shared_->stop)) return std::nullopt;
      traced.paths = renderer->progress().paths;
      if (renderer->statistics().passes < kLeastReferencePasses) continue;
      const Film film = renderer->film();
      traced.noise = pictureNoise(film.beauty(), film.variance);
      if (traced.noise <= plan_.referenceNoise || shared_->enough) break;
      tell([](TradeStatus& status) { status.isTracing = true; });
      const double part = plan_.referenceNoise / traced.noise;  // it falls with the root of the paths
      tellStage(
          fmt::format("Reference: {} of {} %", traced.text(), numberText(100.0 * plan_.referenceNoise, 2)),
          part * part);
    }
    traced.picture = renderer->film().toLayers(*context.scene);
    return traced;
  }

  Expected<bool> readReference() {
    auto read = readImage(plan_.reference);
    if (!read) return tl::unexpected(read.error());
    const Camera& camera = subject_.camera;
    int reduction = 1;
    while (reduction <= kMostReduction && (coarseSize(camera.width, reduction) != read->width ||
                                           coarseSize(camera.height, reduction) != read->height))
      ++reduction;
    if (reduction > kMostReduction) {
      return makeError(
          plan_.reference.string(),
          fmt::format("has {} x {} pixels; the picture's {} x {}, or as many for whole numbers of "
                      "them, are needed",
                      read->width, read->height, camera.width, camera.height));
    }
    const auto hash = read->metadata.find("scene_hash");
    if (hash != read->metadata.end() && hash->second != subject_.document->scene->hash) {
      return makeError(plan_.reference.string(), "is of another scene, or of this one before it changed",
                       "make it anew with lightvane reference");
    }
    setReduction(reduction);
    referenceName_ = plan_.reference.filename().string();
    if (const ImageRgb variance = varianceOf(*read); !variance.empty())
      referenceNoise_ = pictureNoise(read->rgb(), variance);
    reference_ = std::make_shared<const LayeredImage>(*std::move(read));
    return true;
  }

  void setReduction(int reduction) {
    reduced_ = reducedBy(subject_.camera, reduction);
    const std::lock_guard lock(shared_->mutex);
    shared_->reduction = reduction;
  }

  std::shared_ptr<Shared> shared_;
  TradePlan plan_;
  TradeSubject subject_;
  std::function<void()> wake_;
  // One thread: its clock is then that of all the work.
  std::shared_ptr<TaskPool> pool_ = std::make_shared<TaskPool>(1);
  Camera reduced_;
  std::optional<Document> other_;  ///< compiled by another rule of energy
  std::shared_ptr<const LayeredImage> reference_;
  std::string referenceName_;
  std::optional<double> referenceNoise_;
  Sweep sweep_;
  std::size_t runsDone_ = 0, runsInAll_ = 0;
  SteadyClock::time_point stageBegun_ = SteadyClock::now();
  SteadyClock::duration waited_{};
};

TradeMeasurement::TradeMeasurement(std::function<void()> wake) : wake_(std::move(wake)) {}

TradeMeasurement::~TradeMeasurement() { stop(); }

void TradeMeasurement::start(const TradePlan& plan, const TradeSubject& subject) {
  clear();
  if (!shared_) shared_ = std::make_shared<Shared>();
  shared_->yields = yields_;
  shared_->status.isRunning = true;
  shared_->status.stage = "Begins.";
  subject_ = subject;
  auto work = std::make_shared<Work>(shared_, plan, subject, wake_);
  threads_.run([work] { work->run(); });
}

void TradeMeasurement::useReference() {
  if (shared_) shared_->enough = true;
}

void TradeMeasurement::stop() {
  if (!shared_) return;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->stop = true;
  }
  shared_->changed.notify_all();
}

void TradeMeasurement::clear() {
  stop();
  if (!shared_) return;
  // Paths stay for the next one.
  auto shared = std::make_shared<Shared>();
  {
    const std::lock_guard lock(shared_->mutex);
    shared->traced = shared_->traced;
  }
  shared_ = std::move(shared);
  subject_.reset();
}

void TradeMeasurement::setYields(bool yields) {
  if (std::exchange(yields_, yields) == yields || !shared_) return;
  {
    const std::lock_guard lock(shared_->mutex);
    shared_->yields = yields;
  }
  shared_->changed.notify_all();
}

TradeStatus TradeMeasurement::status(const std::optional<TradeSubject>& now) const {
  if (!shared_) return {};
  TradeStatus status;
  {
    const std::lock_guard lock(shared_->mutex);
    status = shared_->status;
  }
  // It ends within moments, and nothing more comes of it.
  if (shared_->stop) status.isRunning = status.isWaiting = false;
  if (!now || !subject_) return status;
  status.stale = whyStale(*subject_, *now);
  if (!status.stale.empty() || !status.sweep || status.sweep->points.empty()) return status;
  // What is varied may be set to anything, as nothing of it is in the points; nor is the seed in what they
  // tell.
  const SweepSettings& settings = status.sweep->points.front().settings;
  const auto measured = withSettings(subject_->parameters, settings);
  auto current = withSettings(now->parameters, settings);
  if (measured && current) current->picture.seed = measured->picture.seed;
  if (!measured || !current || *current != *measured)
    status.stale = "These points are of other parameters, beside those that were varied.";
  return status;
}

std::shared_ptr<const ImageRgb> TradeMeasurement::picture(std::size_t point) const {
  if (!shared_) return nullptr;
  const std::lock_guard lock(shared_->mutex);
  return point < shared_->pictures.size() ? shared_->pictures[point] : nullptr;
}

int TradeMeasurement::reduction() const {
  if (!shared_) return 1;
  const std::lock_guard lock(shared_->mutex);
  return shared_->reduction;
}

}  // namespace lightvane
