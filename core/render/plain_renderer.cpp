#include "core/render/plain_renderer.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/render/direct_vectors.h"
#include "core/vectors/gather.h"

namespace lightvane {

PlainRenderer::PlainRenderer(RenderContext context) : context_(std::move(context)), scene_(*context_.scene) {}

bool PlainRenderer::runPass(const StopFlag& stop) {
  if (!havePoints_) {
    auto seen = std::make_shared<SeenSurfaces>(context_.region.width, context_.region.height);
    if (!traceVisiblePoints(*context_.tracer, context_.camera, context_.region, context_.parameters,
                            *context_.pool, stop, points_, *seen, statistics_.rays)) {
      return false;
    }
    surfaces_ = std::move(seen);
    light_.resize(points_.tiles.size());
    havePoints_ = true;
    takeRestored();
    ++statistics_.passes;
    return true;
  }
  struct Worker {
    Gatherer gatherer;
    DirectLightSampler direct;
    RayCounts rays;
    SampleFaults faults;
  };
  std::vector<Worker> workers;
  for (int i = 0; i < context_.pool->threadCount(); ++i) {
    workers.push_back({Gatherer(*context_.tracer, context_.parameters.transport, context_.parameters.vectors),
                       DirectLightSampler(*context_.tracer, context_.parameters.transport),
                       {},
                       {}});
    workers.back().gatherer.stopWith(stop);
  }
  const bool naive = context_.parameters.picture.method == Method::Naive;
  const TransportParameters& transport = context_.parameters.transport;
  const std::size_t count = points_.tiles.size();
  const auto part = static_cast<std::size_t>(part_);
  std::vector<std::vector<PointLight>> computed((count + kParts - 1 - part) / kParts);
  context_.pool->forEach(computed.size(), [&](std::size_t n, int w) {
    Worker& worker = workers[static_cast<std::size_t>(w)];
    const VisibleTile& tile = points_.tiles[n * kParts + part];
    std::vector<PointLight> lights(tile.points.size());
    for (std::size_t i = 0; i < tile.points.size(); ++i) {
      if (stop) return;
      const VisiblePoint& p = tile.points[i];
      const Brdf& brdf = scene_.materialOf(p.surface).brdf;
      const LitPoint lit = p.lit(scene_);
      const int x = static_cast<int>(p.pixel) % context_.region.width;
      const int y = static_cast<int>(p.pixel) / context_.region.width;
      const RandomKey key = randomKey(context_.parameters.picture.seed)
                                .with(context_.region.pixelAddress(x, y))
                                .with(p.position);
      PointLight& light = lights[i];
      for (std::uint32_t l = 0; l < scene_.lights.size(); ++l) {
        const DirectLightEstimate e =
            worker.direct.estimate(lit, l, transport.lightSamples, key, worker.rays, worker.faults);
        light.direct += reflectedRadiance(brdf, e);
        light.irradiance += e.irradiance;
      }
      if (naive) {
        const DirectLightEstimate e =
            worker.direct.estimateMirrored(lit, transport.lightSamples, key, worker.rays, worker.faults);
        light.indirect = reflectedRadiance(brdf, e) +
                         worker.gatherer.outgoingRadiance(lit, context_.parameters.picture.naiveSamples, key,
                                                          worker.rays, worker.faults);
      }
    }
    computed[n] = std::move(lights);
  });
  for (const Worker& worker : workers) {
    statistics_.rays += worker.rays;
    statistics_.faults += worker.faults;
  }
  if (stop) return false;
  for (std::size_t n = 0; n < computed.size(); ++n) {
    statistics_.fullDirect += computed[n].size() * scene_.lights.size();
    if (naive) statistics_.fullIndirect += computed[n].size();
    light_[n * kParts + part] = std::move(computed[n]);
  }
  ++part_;
  ++statistics_.passes;
  return true;
}

Checkpoint PlainRenderer::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.passes = statistics_.passes;
  checkpoint.samples = part_;
  if (!havePoints_) {
    checkpoint.sums = restored_;  // nothing was added to what an earlier checkpoint brought
    return checkpoint;
  }
  for (std::size_t part = 0; part < static_cast<std::size_t>(part_); ++part) {
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
  LV_CHECK(checkpoint.samples >= 0 && checkpoint.samples <= kParts, "{} parts restored", checkpoint.samples);
  restored_ = checkpoint.sums;
  part_ = checkpoint.samples;
}

void PlainRenderer::takeRestored() {
  std::size_t next = 0;
  for (std::size_t part = 0; part < static_cast<std::size_t>(part_); ++part) {
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
  // The ambient term: a constant irradiance, as a part of the mean direct one.
  glm::dvec3 sum(0.0);
  std::size_t count = 0;
  for (const auto& tile : light_) {
    for (const PointLight& light : tile) sum += glm::dvec3(light.irradiance);
    count += tile.size();
  }
  const bool direct = context_.parameters.picture.method == Method::Direct;
  const Rgb ambient = direct && count > 0
                          ? Rgb(sum * (context_.parameters.picture.ambient / static_cast<double>(count)))
                          : Rgb(0.0f);
  for (std::size_t t = 0; t < light_.size(); ++t) {
    const VisibleTile& tile = points_.tiles[t];
    for (std::size_t i = 0; i < light_[t].size(); ++i) {
      const VisiblePoint& p = tile.points[i];
      const Rgb indirect = light_[t][i].indirect +
                           scene_.materialOf(p.surface).brdf.nonSpecularAlbedoBound() * kInvPi * ambient;
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
  return {havePoints_ ? fmt::format("part {} of {}", std::min(part_ + 1, kParts), kParts) : "visible points",
          havePoints_ ? static_cast<double>(part_) / kParts : 0.0, 0.0, part_ > 0 ? 1 : 0};
}

}  // namespace lightvane
