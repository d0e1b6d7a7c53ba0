#include "core/inspect/full_computation.h"

#include <algorithm>
#include <cmath>

#include "core/inspect/frame_points.h"
#include "core/inspect/specular_ways.h"
#include "core/render/point_answers.h"
#include "core/render/vector_renderer.h"

namespace lightvane {
namespace {

// The samples are taken in so many independent batches; their spread gives the standard error. Stratified
// samples of one batch are not independent.
constexpr int kBatches = 16;

// Streams of random numbers of their own: "full".
constexpr std::uint32_t kFullStream = 0x66756c6cU;

/// Everything that one batch says about a point, normalised units.
struct Batch {
  std::vector<Rgb> lights;            ///< radiance towards the viewer of each light
  std::vector<Rgb> lightIrradiances;  ///< of each light
  Rgb mirrored{0.0f};
  Rgb diffuse{0.0f};     ///< indirect radiance of the Lambertian part
  Rgb lobe{0.0f};        ///< of the lobe
  Rgb irradiance{0.0f};  ///< indirect
};

class Computer {
 public:
  Computer(const RenderFrame& frame, int samples, const StopFlag& stop)
      : frame_(frame),
        scene_(*frame.scene),
        stop_(stop),
        batchSamples_(std::max(2, samples / kBatches)),
        sampler_(*frame.shownTracer, frame.parameters.transport),
        mirrored_(*frame.indirectTracer, frame.parameters.transport),
        gatherer_(*frame.indirectTracer, frame.parameters.transport, frame.parameters.vectors),
        hemisphere_(*frame.indirectTracer, frame.parameters.transport,
                    cellsFor(batchSamples_, frame.parameters.vectors)) {
    gatherer_.stopWith(stop);
    hemisphere_.stopWith(stop);
    gatherer_.knowSight(frame.points->sight.get());
    hemisphere_.knowSight(frame.points->sight.get());
  }

  int samples() const { return batchSamples_ * kBatches; }
  const RayCounts& rays() const { return rays_; }

  /// Adds a point to the computation; not to be used when stopped meanwhile.
  void add(PointRef ref, FullComputation& result) {
    const VisiblePoint& p = frame_.points->tiles[ref.tile].points[ref.point];
    const LitPoint lit = p.lit(scene_);
    std::vector<Batch> batches;
    for (int b = 0; b < kBatches; ++b) {
      if (stop_) return;
      batches.push_back(batch(p, lit, static_cast<std::uint32_t>(b)));
      Rgb all = batches.back().mirrored + batches.back().diffuse + batches.back().lobe;
      for (const Rgb& light : batches.back().lights) all += light;
      totals_[static_cast<std::size_t>(b)] += inScene(p, all);
    }
    for (std::uint32_t light = 0; light < scene_.lights.size(); ++light)
      addLight(ref, lit, light, batches, result);
    const Vec3d mirrored = inScene(p, frame_.answers[ref.tile]->mirrored[ref.point]);
    result.mirrored += sampled(mirrored, mean(p, batches, [](const Batch& b) { return b.mirrored; }));
    addIndirect(ref, lit, batches, result);
  }

  Vec3d standardError() const {
    Vec3d average(0.0);
    for (const Vec3d& total : totals_) average += total / static_cast<double>(kBatches);
    Vec3d variance(0.0);
    for (const Vec3d& total : totals_) variance += (total - average) * (total - average);
    return glm::sqrt(variance / static_cast<double>(kBatches * (kBatches - 1)));
  }

 private:
  /// A hemisphere of about `samples` cells, twice as many around as down.
  static VectorParameters cellsFor(int samples, VectorParameters vectors) {
    vectors.ilv.rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(samples) / 2.0f)));
    vectors.ilv.columns = std::max(1, samples / vectors.ilv.rows);
    return vectors;
  }

  /// Radiance at a point as the pixel has it, in the scene's units.
  Vec3d inScene(const VisiblePoint& p, const Rgb& radiance) const {
    return Vec3d(p.throughput) * Vec3d(radiance) * std::ldexp(1.0, scene_.normalisation.radianceExponent);
  }

  template <class ValueOf>
  Vec3d mean(const VisiblePoint& p, const std::vector<Batch>& batches, const ValueOf& valueOf) const {
    Vec3d sum(0.0);
    for (const Batch& batch : batches) sum += inScene(p, valueOf(batch));
    return sum / static_cast<double>(kBatches);
  }

  /// Of light that was sampled at the point, in the picture too.
  static FullValue sampled(const Vec3d& shown, const Vec3d& full) {
    FullValue value{shown, full, {}};
    value.parts.noise = shown - full;
    return value;
  }

  Batch batch(const VisiblePoint& p, const LitPoint& lit, std::uint32_t number) {
    const RandomKey key =
        pointKey(frame_.region, p, randomKey(frame_.parameters.picture.seed)).with(kFullStream).with(number);
    const Brdf& brdf = scene_.materialOf(p.surface).brdf;
    Batch batch;
    for (std::uint32_t light = 0; light < scene_.lights.size(); ++light) {
      const DirectLightEstimate e = sampler_.estimate(lit, light, batchSamples_, key, rays_, faults_);
      batch.lights.push_back(reflectedRadiance(brdf, p.tint(), e));
      batch.lightIrradiances.push_back(e.irradiance);
    }
    batch.mirrored = reflectedRadiance(brdf, p.tint(),
                                       mirrored_.estimateMirrored(lit, batchSamples_, key, rays_, faults_));
    const Rgb outgoing = gatherer_.outgoingRadiance(lit, batchSamples_, key, rays_, faults_);
    if (brdf.hasDiffuse()) {
      batch.irradiance = hemisphereIrradiance(gatherer_.hemisphere());
      batch.diffuse = brdf.diffuse(p.tint()) * kInvPi * batch.irradiance;
    } else if (frame_.parameters.vectors.ilv.store == VectorStore::Vector) {
      // A vector of the whole BRDF samples the hemisphere though nothing here is Lambertian.
      batch.irradiance =
          hemisphere_.gather({lit, p.vectorFootprint}, kLambertKey, key.asSeed(), rays_, faults_).irradiance;
    }
    batch.lobe = outgoing - batch.diffuse;
    return batch;
  }

  void addLight(PointRef ref, const LitPoint& lit, std::uint32_t light, const std::vector<Batch>& batches,
                FullComputation& result) {
    const VisiblePoint& p = frame_.points->tiles[ref.tile].points[ref.point];
    const Vec3d full = mean(p, batches, [&](const Batch& b) { return b.lights[light]; });
    const TileAnswers& answers = *frame_.answers[ref.tile];
    const LightSlots& slots = frame_.lightSlots;
    const std::size_t slot = slots.slotAt(answers, light, ref.point);
    const std::size_t points = frame_.points->tiles[ref.tile].points.size();
    Vec3d shown = inScene(p, slots.factorOf(answers, slot) * answers.lightDirect[slot * points + ref.point]);
    if (!slots.hasVectors(light) || slot != slots.slotOf(answers, light)) {
      // Many lights that no vectors give share a slot: the first of them stands for what is shown of all.
      std::uint32_t first = 0;
      while (slots.slotAt(answers, first, ref.point) != slot) ++first;
      if (first != light) shown = Vec3d(0.0);
      result.direct += sampled(shown, full);
      return;
    }
    const Material& material = scene_.materialOf(p.surface);
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    const SurfaceKey key = directSurfaceKey(material, dlv.store);
    const DirectLightVector own =
        computeDirectVector(sampler_, scene_, p, key, light, frame_.parameters, rays_, faults_);
    // The same samples once more: a vector of the whole BRDF does not keep the irradiance.
    const DirectLightEstimate e = sampler_.estimate(lit, light, frame_.parameters.transport.lightSamples,
                                                    own.birth.identity, rays_, faults_);
    const Vec3d ownRadiance =
        inScene(p, directRadiance(material.brdf, p, dlv.store, own.energy, own.lobeRadiance, own.direction));
    result.direct += {shown, full,
                      differenceParts(shown, ownRadiance, Vec3d(e.irradiance), irradianceOf(batches, light),
                                      full, dlv.store == VectorStore::Vector && material.brdf.hasLobe())};
  }

  static Vec3d irradianceOf(const std::vector<Batch>& batches, std::uint32_t light) {
    Vec3d sum(0.0);
    for (const Batch& batch : batches) sum += Vec3d(batch.lightIrradiances[light]);
    return sum / static_cast<double>(kBatches);
  }

  void addIndirect(PointRef ref, const LitPoint& lit, const std::vector<Batch>& batches,
                   FullComputation& result) {
    const VisiblePoint& p = frame_.points->tiles[ref.tile].points[ref.point];
    const Material& material = scene_.materialOf(p.surface);
    const VectorStore store = frame_.parameters.vectors.ilv.store;
    const SurfaceKeys keys = indirectKeys(material, store);
    const std::size_t points = frame_.points->tiles[ref.tile].points.size();
    Vec3d fullIrradiance(0.0);
    for (const Batch& b : batches) fullIrradiance += Vec3d(b.irradiance) / static_cast<double>(kBatches);
    for (int k = 0; k < keys.count; ++k) {
      const SurfaceKey key = keys.keys[k];
      const Vec3d full = mean(p, batches, [&](const Batch& b) {
        if (store == VectorStore::Vector) return b.diffuse + b.lobe;
        return key == kLambertKey ? b.diffuse : b.lobe;
      });
      const Vec3d shown =
          inScene(p, frame_.answers[ref.tile]->indirect[static_cast<std::size_t>(k) * points + ref.point]);
      const IndirectLightVector own =
          gatherer_.gather({lit, p.vectorFootprint}, key, frame_.parameters.picture.seed, rays_, faults_);
      const Vec3d ownRadiance =
          inScene(p, indirectRadiance(material.brdf, p, store, key, own.energy, own.direction));
      result.indirect += {shown, full,
                          differenceParts(shown, ownRadiance, Vec3d(own.irradiance), fullIrradiance, full,
                                          store == VectorStore::Vector && material.brdf.hasLobe())};
    }
  }

  const RenderFrame& frame_;
  const Scene& scene_;
  const StopFlag& stop_;
  int batchSamples_;
  DirectLightSampler sampler_;   ///< of the lights as they are shown
  DirectLightSampler mirrored_;  ///< of those that are reflected, as ILVs have them
  Gatherer gatherer_;            ///< with the frame's cells
  Gatherer hemisphere_;          ///< with as many cells as a batch has samples
  RayCounts rays_;
  SampleFaults faults_;
  std::array<Vec3d, kBatches> totals_{};  ///< of all points, for each batch
};

}  // namespace

DifferenceParts differenceParts(const Vec3d& shown, const Vec3d& own, const Vec3d& ownIrradiance,
                                const Vec3d& fullIrradiance, const Vec3d& full, bool hasDirection) {
  DifferenceParts parts;
  parts.interpolation = shown - own;
  parts.noise = own - full;
  if (!hasDirection) return parts;
  for (int c = 0; c < 3; ++c) {
    // Without irradiance there is no ratio, and no direction to blame.
    if (!(ownIrradiance[c] > 0.0)) continue;
    // What the vector reflects of each unit of irradiance, on the difference of irradiances.
    const double noise = own[c] / ownIrradiance[c] * (ownIrradiance[c] - fullIrradiance[c]);
    parts.singleDirection[c] = parts.noise[c] - noise;
    parts.noise[c] = noise;
  }
  return parts;
}

FullComputation computeHere(const RenderFrame& frame, int x, int y, int samples, const StopFlag& stop) {
  FullComputation result;
  if (!frame.film || x < 0 || y < 0 || x >= frame.film->width || y >= frame.film->height) {
    result.note = "outside of the picture";
    return result;
  }
  if (!frame.points) {
    result.note = "only pictures made with vectors have points to compute at";
    return result;
  }
  const PixelPoints points =
      pointsOfPixel(*frame.points, static_cast<std::uint32_t>(frame.film->depth().index(x, y)));
  if (points.count == 0) {
    result.note =
        fmt::format("no surface here asks for light: the pixel shows {}", tracePixelWays(frame, x, y).end);
    return result;
  }
  const FlushDenormals flush;
  Computer computer(frame, samples, stop);
  for (std::uint32_t n = 0; n < points.count; ++n) {
    if (frame.answers[points.tile]->looked[points.first + n] == 0) {
      result.note = "not looked at yet: there is nothing to compare with";
      return result;
    }
  }
  for (std::uint32_t n = 0; n < points.count; ++n) {
    computer.add({points.tile, points.first + n}, result);
    result.rays = computer.rays();
    if (stop) {
      FullComputation stopped;
      stopped.note = "stopped";
      stopped.rays = result.rays;
      return stopped;
    }
  }
  result.samples = computer.samples();
  result.total = result.direct;
  result.total += result.mirrored;
  result.total += result.indirect;
  result.standardError = computer.standardError();
  result.finished = true;
  return result;
}

}  // namespace lightvane
