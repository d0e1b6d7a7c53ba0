#include "core/render/path_renderer.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Paths a pixel takes in a pass at most: short enough to show and to stop.
constexpr int kMostSamplesPerPass = 16;
constexpr int kPixelsPerTask = 64;

TransportParameters referenceTransport(TransportParameters transport) {
  // Light in mirrors is left to chance: the reference must not share what is to be checked against it.
  transport.mirroredLights = false;
  return transport;
}

}  // namespace

PathRenderer::PathRenderer(RenderContext context)
    : context_(std::move(context)),
      scene_(*context_.scene),
      sums_(static_cast<std::size_t>(context_.region.width) *
            static_cast<std::size_t>(context_.region.height)) {}

Checkpoint PathRenderer::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.passes = statistics_.passes;
  checkpoint.samples = samplesDone_;
  for (const PathSums& sum : sums_) {
    for (const glm::dvec3& v : {sum.emission, sum.direct, sum.indirect, sum.specular, sum.squares,
                                sum.directSquares, sum.indirectSquares}) {
      checkpoint.sums.insert(checkpoint.sums.end(), {v.x, v.y, v.z});
    }
  }
  return checkpoint;
}

void PathRenderer::restore(const Checkpoint& checkpoint) {
  constexpr std::size_t kNumbers = 21;
  LV_CHECK(checkpoint.sums.size() == kNumbers * sums_.size(), "{} sums for {} pixels", checkpoint.sums.size(),
           sums_.size());
  const double* next = checkpoint.sums.data();
  for (PathSums& sum : sums_) {
    for (glm::dvec3* v : {&sum.emission, &sum.direct, &sum.indirect, &sum.specular, &sum.squares,
                          &sum.directSquares, &sum.indirectSquares}) {
      *v = {next[0], next[1], next[2]};
      next += 3;
    }
  }
  samplesDone_ = checkpoint.samples;
  statistics_.passes = checkpoint.passes;
}

bool PathRenderer::done() const {
  return surfaces_ && samplesDone_ >= context_.parameters.picture.pathSamples;
}

bool PathRenderer::runPass(const StopFlag& stop) {
  if (!seen_) {
    VisiblePoints points;
    auto seen = std::make_shared<SeenSurfaces>(context_.region.width, context_.region.height);
    if (!traceVisiblePoints(*context_.tracer, context_.camera, context_.region, context_.parameters,
                            *context_.pool, stop, points, *seen, statistics_.rays)) {
      return false;
    }
    seen_ = std::move(seen);
    if (samplesDone_ >= context_.parameters.picture.pathSamples) {
      surfaces_ = seen_;
      return true;  // a checkpoint brought them all
    }
  }
  const PictureParameters& picture = context_.parameters.picture;
  // One path, and then as many as there are: something to see at once, and soon whole packets.
  const int samples =
      std::min(std::clamp(samplesDone_, 1, kMostSamplesPerPass), picture.pathSamples - samplesDone_);
  const int width = context_.region.width;
  const std::size_t pixels = sums_.size();
  std::vector<PathSums> sums = sums_;
  const auto threads = static_cast<std::size_t>(context_.pool->threadCount());
  struct Worker {
    RadianceEstimator estimator;
    std::vector<PathStart> starts;
    std::vector<PathRadiance> results;
    RayCounts rays;
    SampleFaults faults;
  };
  const EstimatorOptions options{.origin = PathOrigin::Eye, .mirroredLights = false, .straightLight = true};
  std::vector<Worker> workers;
  for (std::size_t i = 0; i < threads; ++i) {
    workers.push_back(
        {RadianceEstimator(*context_.tracer, referenceTransport(context_.parameters.transport), options),
         {},
         {},
         {},
         {}});
    workers.back().estimator.stopWith(stop);
  }
  context_.pool->forEach((pixels + kPixelsPerTask - 1) / kPixelsPerTask, [&](std::size_t task, int w) {
    if (stop) return;
    Worker& worker = workers[static_cast<std::size_t>(w)];
    const std::size_t begin = task * kPixelsPerTask;
    const std::size_t end = std::min(pixels, begin + kPixelsPerTask);
    worker.starts.clear();
    // Sample by sample over the pixels: a packet's rays are neighbours.
    for (int s = samplesDone_; s < samplesDone_ + samples; ++s) {
      for (std::size_t i = begin; i < end; ++i) {
        const int x = static_cast<int>(i) % width;
        const int y = static_cast<int>(i) / width;
        const RandomKey key = randomKey(picture.seed).with(context_.region.pixelAddress(x, y));
        worker.starts.push_back({cameraRay(context_.camera, context_.region.x + x, context_.region.y + y,
                                           s % picture.filmSamples, picture.filmSamples),
                                 key, static_cast<std::uint32_t>(s)});
      }
    }
    worker.results.resize(worker.starts.size());
    worker.estimator.estimate(worker.starts, worker.results, Coherence::Coherent, worker.rays.camera,
                              worker.rays, worker.faults);
    for (std::size_t n = 0; n < worker.results.size(); ++n) {
      PathSums& sum = sums[begin + n % (end - begin)];
      const PathRadiance& radiance = worker.results[n];
      const glm::dvec3 direct(radiance.direct), indirect(radiance.indirect), total(radiance.total());
      sum.emission += glm::dvec3(radiance.emission);
      sum.direct += direct;
      sum.indirect += indirect;
      sum.specular += glm::dvec3(radiance.specular);
      sum.squares += total * total;
      sum.directSquares += direct * direct;
      sum.indirectSquares += indirect * indirect;
    }
  });
  for (const Worker& worker : workers) {
    statistics_.rays += worker.rays;
    statistics_.faults += worker.faults;
  }
  if (stop) return false;
  sums_ = std::move(sums);
  samplesDone_ += samples;
  surfaces_ = seen_;
  ++statistics_.passes;
  return true;
}

Film PathRenderer::film() const {
  // A checkpoint brings sums before anything was seen.
  Film film = surfaces_ ? Film(surfaces_) : Film(context_.region.width, context_.region.height);
  film.variance = film.directVariance = film.indirectVariance = ImageRgb(film.width, film.height);
  if (samplesDone_ == 0) return film;
  const double n = samplesDone_;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const PathSums& sum = sums_[i];
    film.emission[i] = Rgb(sum.emission / n);
    film.direct[i] = Rgb(sum.direct / n);
    film.indirect[i] = Rgb(sum.indirect / n);
    film.specular[i] = Rgb(sum.specular / n);
    if (samplesDone_ == 1) continue;
    const auto ofMean = [&](const glm::dvec3& all, const glm::dvec3& squares) {
      const glm::dvec3 mean = all / n;
      return Rgb(glm::max(glm::dvec3(0.0), squares / n - mean * mean) / (n - 1));
    };
    film.variance[i] = ofMean(sum.emission + sum.direct + sum.indirect + sum.specular, sum.squares);
    film.directVariance[i] = ofMean(sum.direct, sum.directSquares);
    film.indirectVariance[i] = ofMean(sum.indirect, sum.indirectSquares);
  }
  return film;
}

RenderProgress PathRenderer::progress() const {
  const int all = context_.parameters.picture.pathSamples;
  return {fmt::format("{} of {} samples", samplesDone_, all), static_cast<double>(samplesDone_) / all, 0.0,
          samplesDone_ > 0 ? 1 : 0, samplesDone_};
}

}  // namespace lightvane
