#include "core/render/error_estimate.h"

#include <algorithm>
#include <cmath>

#include "core/render/point_answers.h"
#include "core/render/vector_renderer.h"

namespace lightvane {
namespace {

/// How sure one key's answer of one point is.
struct AnswerSpread {
  Rgb light{0.0f};  ///< what the answer gives the point, radiance towards the viewer
  Rgb ofOne{0.0f};  ///< variance of what one vector gives it
  float share = 1.0f;
  bool isKnown = false;
};

/// Those of a tile: [key * points + point]; `light` is black where no vector answers.
using TileSpreads = std::vector<AnswerSpread>;

/// Asks the vectors of a frame again, one tile at a time. One a thread.
class SpreadAsker {
 public:
  explicit SpreadAsker(const RenderFrame& frame)
      : frame_(frame), answerer_(*frame.tracer, frame.parameters.vectors) {}

  TileSpreads ask(std::size_t tileIndex, const StopFlag& stop) {
    const VisibleTile& tile = frame_.points->tiles[tileIndex];
    TileSpreads spreads(2 * tile.points.size());
    for (const PointCluster& cluster : tile.clusters) {
      if (stop) break;
      const IlvParameters& ilv = frame_.parameters.vectors.ilv;
      const VisiblePoint& first = tile.points[cluster.points.front()];
      const SurfaceKeys keys = indirectKeys(frame_.scene->materialOf(first.surface), ilv.store);
      queries_.clear();
      for (const std::uint32_t i : cluster.points) queries_.push_back(queryPoint(tile.points[i], ilv));
      for (int k = 0; k < keys.count; ++k) {
        const auto key = static_cast<std::size_t>(k);
        askKey(tileIndex, cluster, keys.keys[key], std::span(spreads).subspan(key * tile.points.size()));
      }
    }
    return spreads;
  }

 private:
  void askKey(std::size_t tileIndex, const PointCluster& cluster, SurfaceKey key,
              std::span<AnswerSpread> spreads) {
    const VisibleTile& tile = frame_.points->tiles[tileIndex];
    const RecordSet<IndirectLightVector>& records = frame_.snapshot->indirect;
    answers_.resize(queries_.size());
    spreads_.resize(queries_.size());
    RayCounts counts;
    answerer_.answerIndirect(records, key, queries_, cluster.ball.centre, cluster.ball.radius, answers_,
                             counts);
    answerer_.spreadIndirect(records, queries_, answers_, spreads_);
    for (std::size_t n = 0; n < queries_.size(); ++n) {
      if (answers_[n].count == 0) continue;
      const VisiblePoint& p = tile.points[cluster.points[n]];
      const Brdf& brdf = frame_.scene->materialOf(p.surface).brdf;
      const VectorStore store = frame_.parameters.vectors.ilv.store;
      // Linear in what vectors say.
      const Rgb ofUnit = indirectRadiance(brdf, p, store, key, Rgb(1.0f), answers_[n].direction);
      spreads[cluster.points[n]] = {ofUnit * answers_[n].energy, ofUnit * ofUnit * spreads_[n].ofOne,
                                    spreads_[n].share, spreads_[n].isKnown};
    }
  }

  const RenderFrame& frame_;
  Answerer answerer_;
  std::vector<QueryPoint> queries_;
  std::vector<IndirectAnswer> answers_;
  std::vector<IndirectSpread> spreads_;
};

/// Samples the light of a frame's points once more. One a thread.
class LightResampler {
 public:
  explicit LightResampler(const RenderFrame& frame)
      : frame_(frame),
        exact_(*frame.shownTracer, frame.parameters.transport),
        mirrored_(*frame.indirectTracer, frame.parameters.transport) {
    exact_.knowSight(frame.points->sight.get());
  }

  /// Radiance towards the viewer, by the numbers of this half.
  Rgb sample(const VisiblePoint& p, std::uint32_t half) {
    const LitPoint lit = p.lit(*frame_.scene);
    const Brdf& brdf = frame_.scene->materialOf(p.surface).brdf;
    constexpr std::uint32_t kStream = 0x6e6f6973U;
    const RandomKey key = pointKey(frame_.points->region, p,
                                   randomKey(frame_.parameters.picture.seed).with(kStream).with(half));
    const int samples = frame_.parameters.transport.lightSamples;
    Rgb radiance(0.0f);
    // As the renderer samples them: those that can be dimmed apart, one by one.
    const std::span<const std::uint32_t> lights = frame_.lightSlots.exactLights();
    const std::size_t group = frame_.lightSlots.keepsApart() ? 1 : lights.size();
    for (std::size_t first = 0; first < lights.size(); first += group) {
      radiance += reflectedRadiance(
          brdf, p.tint(),
          exact_.estimateTogether(lit, lights.subspan(first, group), samples, key, rays_, faults_));
    }
    if (mirrored_.samplesMirrored())
      radiance +=
          reflectedRadiance(brdf, p.tint(), mirrored_.estimateMirrored(lit, samples, key, rays_, faults_));
    return radiance;
  }

 private:
  const RenderFrame& frame_;
  DirectLightSampler exact_, mirrored_;
  RayCounts rays_;       // not the picture's
  SampleFaults faults_;  // nor are these
};

}  // namespace

ErrorEstimate estimateError(const RenderFrame& frame, TaskPool& pool, const StopFlag& stop) {
  ErrorEstimate estimate;
  if (!frame.points || !frame.snapshot || frame.answers.empty()) return estimate;
  const std::size_t tiles = frame.points->tiles.size();
  std::vector<SpreadAsker> askers(static_cast<std::size_t>(pool.threadCount()), SpreadAsker(frame));
  std::vector<TileSpreads> spreads(tiles);
  pool.forEach(tiles, [&](std::size_t t, int worker) {
    if (!stop) spreads[t] = askers[static_cast<std::size_t>(worker)].ask(t, stop);
  });
  if (stop) return estimate;
  // What one vector scatters by, as a part of its light: of all for whom that is known.
  double scatter = 0.0, light = 0.0;
  std::size_t known = 0, guessed = 0;
  for (const TileSpreads& tile : spreads) {
    for (const AnswerSpread& spread : tile) {
      if (isBlack(spread.light)) continue;
      ++(spread.isKnown ? known : guessed);
      if (!spread.isKnown) continue;
      scatter += static_cast<double>(spread.ofOne.r + spread.ofOne.g + spread.ofOne.b);
      light += static_cast<double>(glm::dot(spread.light, spread.light));
    }
  }
  if (known == 0) return estimate;
  estimate.guessed = static_cast<double>(guessed) / static_cast<double>(known + guessed);
  const auto relative = light > 0.0 ? static_cast<float>(scatter / light) : 0.0f;
  ImageRgb deviation(frame.points->region.width, frame.points->region.height);
  for (std::size_t t = 0; t < tiles; ++t) {
    const VisibleTile& tile = frame.points->tiles[t];
    const TileAnswers& answers = *frame.answers[t];
    for (std::size_t i = 0; i < tile.points.size(); ++i) {
      Rgb variance(0.0f);
      for (const std::size_t slot : {i, tile.points.size() + i}) {
        const AnswerSpread& spread = spreads[t][slot];
        const Rgb ofOne = spread.isKnown ? spread.ofOne : relative * spread.light * spread.light;
        // Until the last pass weighs it with all others, a vector of the point's own stands alone.
        const bool isAlone = answers.own[slot] != 0 && !frame.complete;
        variance += (isAlone ? 1.0f : spread.share) * ofOne;
      }
      deviation[tile.points[i].pixel] += tile.points[i].throughput * glm::sqrt(variance);
    }
  }
  estimate.variance = ImageRgb(deviation.width(), deviation.height());
  for (std::size_t i = 0; i < deviation.size(); ++i) estimate.variance[i] = deviation[i] * deviation[i];
  return estimate;
}

SamplingNoise estimateSamplingNoise(const RenderFrame& frame, TaskPool& pool, const StopFlag& stop) {
  SamplingNoise noise;
  if (!frame.points || frame.answers.empty()) return noise;
  const PictureRegion& region = frame.points->region;
  noise.counted = ImageFloat(region.width, region.height);
  noise.variance = ImageRgb(region.width, region.height);
  constexpr int kMiddle = SamplingNoise::kStride / 2;
  for (int y = kMiddle; y < region.height; y += SamplingNoise::kStride) {
    for (int x = kMiddle; x < region.width; x += SamplingNoise::kStride) noise.counted.at(x, y) = 1.0f;
  }
  std::vector<LightResampler> samplers(static_cast<std::size_t>(pool.threadCount()), LightResampler(frame));
  // Tiles have no pixel in common.
  ImageRgb difference(region.width, region.height);
  pool.forEach(frame.points->tiles.size(), [&](std::size_t t, int worker) {
    LightResampler& sampler = samplers[static_cast<std::size_t>(worker)];
    for (const VisiblePoint& p : frame.points->tiles[t].points) {
      if (stop) return;
      if (noise.counted[p.pixel] == 0.0f) continue;
      difference[p.pixel] += p.throughput * (sampler.sample(p, 0) - sampler.sample(p, 1));
    }
  });
  for (std::size_t i = 0; i < difference.size(); ++i)
    noise.variance[i] = 0.5f * difference[i] * difference[i];
  return noise;
}

}  // namespace lightvane
