#include "core/render/plain_renderer.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/render/direct_vectors.h"
#include "core/render/learn_sight.h"
#include "core/vectors/gather.h"

namespace lightvane {

PlainRenderer::PlainRenderer(RenderContext context)
    : context_(std::move(context)), scene_(*context_.scene), allLights_(scene_.lights.size()) {
  std::iota(allLights_.begin(), allLights_.end(), 0U);
}

bool PlainRenderer::runPass(const StopFlag& stop) {
  if (!havePoints_) {
    auto seen = std::make_shared<SeenSurfaces>(context_.region.width, context_.region.height);
    if (!traceVisiblePoints(*context_.tracer, context_.camera, context_.region, context_.parameters,
                            *context_.pool, stop, points_, *seen, statistics_.rays)) {
      return false;
    }
    points_.sight = std::make_shared<const LightSight>(
        learnSight(*context_.tracer, context_.camera, *context_.pool, stop, statistics_.rays));
    if (stop) return false;
    surfaces_ = std::move(seen);
    light_.resize(points_.tiles.size());
    havePoints_ = true;
    takeRestored();
    ++statistics_.passes;
    return true;
  }
  std::vector<Worker> workers;
  for (int i = 0; i < context_.pool->threadCount(); ++i) {
    workers.push_back({Gatherer(*context_.tracer, context_.parameters.transport, context_.parameters.vectors),
                       DirectLightSampler(*context_.tracer, context_.parameters.transport),
                       {},
                       {}});
    workers.back().gatherer.stopWith(stop);
    workers.back().gatherer.knowSight(points_.sight.get());
    workers.back().direct.knowSight(points_.sight.get());
  }
  // Direct light first, everywhere: there is something to see while the gathers take their time.
  const bool isOfDirect = part_ < kParts;
  const auto part = static_cast<std::size_t>(part_ % kParts);
  std::vector<std::vector<PointLight>> computed((light_.size() + kParts - 1 - part) / kParts);
  context_.pool->forEach(computed.size(), [&](std::size_t n, int w) {
    const std::size_t t = n * kParts + part;
    computed[n] = light_[t];
    computed[n].resize(points_.tiles[t].points.size());
    Worker& worker = workers[static_cast<std::size_t>(w)];
    for (std::size_t i = 0; i < computed[n].size() && !stop; ++i) {
      const VisiblePoint& point = points_.tiles[t].points[i];
      isOfDirect ? sampleDirect(point, worker, computed[n][i])
                 : gatherIndirect(point, worker, computed[n][i]);
    }
  });
  for (const Worker& worker : workers) {
    statistics_.rays += worker.rays;
    statistics_.faults += worker.faults;
  }
  if (stop) return false;
  for (std::size_t n = 0; n < computed.size(); ++n) {
    if (isOfDirect) {
      statistics_.fullDirect += computed[n].size() * scene_.lights.size();
    } else {
      statistics_.fullIndirect += computed[n].size();
    }
    light_[n * kParts + part] = std::move(computed[n]);
  }
  ++part_;
  ++statistics_.passes;
  return true;
}

RandomKey PlainRenderer::keyOf(const VisiblePoint& p) const {
  const int x = static_cast<int>(p.pixel) % context_.region.width;
  const int y = static_cast<int>(p.pixel) / context_.region.width;
  return randomKey(context_.parameters.picture.seed)
      .with(context_.region.pixelAddress(x, y))
      .with(p.position);
}

void PlainRenderer::sampleDirect(const VisiblePoint& p, Worker& worker, PointLight& light) const {
  const Brdf& brdf = scene_.materialOf(p.surface).brdf;
  const LitPoint lit = p.lit(scene_);
  const DirectLightEstimate e = worker.direct.estimateTogether(
      lit, allLights_, context_.parameters.transport.lightSamples, keyOf(p), worker.rays, worker.faults);
  light.direct = reflectedRadiance(brdf, p.tint(), e);
  light.irradiance = e.irradiance;
}

void PlainRenderer::gatherIndirect(const VisiblePoint& p, Worker& worker, PointLight& light) const {
  const LitPoint lit = p.lit(scene_);
  const DirectLightEstimate mirrored = worker.direct.estimateMirrored(
      lit, context_.parameters.transport.lightSamples, keyOf(p), worker.rays, worker.faults);
  light.indirect = reflectedRadiance(scene_.materialOf(p.surface).brdf, p.tint(), mirrored) +
                   worker.gatherer.outgoingRadiance(lit, context_.parameters.picture.naiveSamples, keyOf(p),
                                                    worker.rays, worker.faults);
}

Checkpoint PlainRenderer::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.passes = statistics_.passes;
  checkpoint.samples = part_;
  if (!havePoints_) {
    checkpoint.sums = restored_;  // nothing was added to what an earlier checkpoint brought
    return checkpoint;
  }
  for (std::size_t part = 0; part < static_cast<std::size_t>(std::min(part_, kParts)); ++part) {
    for (std::size_t t = part; t < light_.size(); t += kParts) {
      for (const PointLight& light : light_[t]) {
        for (const Rgb* v : {&light.direct, &light.indirect, &light.irradiance}) {
          checkpoint.sums.insert(checkpoint.sums.end(), {v->r, v->g, v->b});
        }
      }
    }
  }
  return checkpoint;
}

void PlainRenderer::restore(const Checkpoint& checkpoint) {
  LV_CHECK(checkpoint.samples >= 0 && checkpoint.samples <= partCount(), "{} parts restored",
           checkpoint.samples);
  restored_ = checkpoint.sums;
  part_ = checkpoint.samples;
}

void PlainRenderer::takeRestored() {
  std::size_t next = 0;
  for (std::size_t part = 0; part < static_cast<std::size_t>(std::min(part_, kParts)); ++part) {
    for (std::size_t t = part; t < light_.size(); t += kParts) {
      light_[t].resize(points_.tiles[t].points.size());
      for (PointLight& light : light_[t]) {
        LV_CHECK(next + 9 <= restored_.size(), "{} numbers restore too few points", restored_.size());
        for (Rgb* v : {&light.direct, &light.indirect, &light.irradiance}) {
          for (int c = 0; c < 3; ++c) (*v)[c] = static_cast<float>(restored_[next++]);
        }
      }
    }
  }
  statistics_.passes = part_;
  restored_ = {};
}

Film PlainRenderer::film() const {
  Film film = havePoints_ ? Film(surfaces_) : Film(context_.region.width, context_.region.height);
  // The ambient term: a constant irradiance, as a part of the mean direct one. `naive` has it where nothing
  // was gathered yet.
  glm::dvec3 sum(0.0);
  std::size_t count = 0;
  for (const auto& tile : light_) {
    for (const PointLight& light : tile) sum += glm::dvec3(light.irradiance);
    count += tile.size();
  }
  const Rgb ambient =
      count > 0 ? Rgb(sum * (context_.parameters.picture.ambient / static_cast<double>(count))) : Rgb(0.0f);
  for (std::size_t t = 0; t < light_.size(); ++t) {
    const VisibleTile& tile = points_.tiles[t];
    const bool isGathered = static_cast<int>(t % kParts) < part_ - kParts;
    for (std::size_t i = 0; i < light_[t].size(); ++i) {
      const VisiblePoint& p = tile.points[i];
      const Rgb indirect =
          isGathered ? light_[t][i].indirect
                     : scene_.materialOf(p.surface).brdf.nonSpecularAlbedoBound(p.tint()) * kInvPi * ambient;
      if (p.throughSpecular) {
        film.specular[p.pixel] += p.throughput * (light_[t][i].direct + indirect);
      } else {
        film.direct[p.pixel] += p.throughput * light_[t][i].direct;
        film.indirect[p.pixel] += p.throughput * indirect;
      }
    }
  }
  return film;
}

RenderProgress PlainRenderer::progress() const {
  RenderProgress progress;
  if (!havePoints_) {
    progress.stage = "visible points";
    return progress;
  }
  const int next = std::min(part_, partCount() - 1);
  progress.stage =
      fmt::format("{}, part {} of {}", next < kParts ? "direct light" : "gathers", next % kParts + 1, kParts);
  // Gathers take nearly all of the time.
  constexpr double kDirectShare = 0.04;
  const double direct = std::min(1.0, static_cast<double>(part_) / kParts);
  const double gathered = std::max(0.0, static_cast<double>(part_ - kParts) / kParts);
  progress.fraction = isNaive() ? kDirectShare * direct + (1.0 - kDirectShare) * gathered : direct;
  // Before all tiles have direct light some of them are black.
  progress.spacing = part_ >= kParts ? 1 : 0;
  return progress;
}

}  // namespace lightvane
