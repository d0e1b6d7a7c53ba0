#include "core/vectors/gather.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

/// Cells in the order in which their rays are traced: blocks of 2 x 4, so that a packet's rays go alike.
std::vector<std::uint32_t> blockOrder(int rows, int columns) {
  constexpr int kBlockRows = 2;
  constexpr int kBlockColumns = 4;
  std::vector<std::uint32_t> order;
  order.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (int r = 0; r < rows; r += kBlockRows) {
    for (int c = 0; c < columns; c += kBlockColumns) {
      for (int y = r; y < std::min(rows, r + kBlockRows); ++y) {
        for (int x = c; x < std::min(columns, c + kBlockColumns); ++x) {
          order.push_back(static_cast<std::uint32_t>(y * columns + x));
        }
      }
    }
  }
  return order;
}

constexpr EstimatorOptions kGatherOptions = {
    .origin = PathOrigin::Surface, .mirroredLights = true, .straightLight = false};

RandomKey placedKey(std::uint64_t seed, SurfaceKey key, const Vec3& position, const Vec3& normal,
                    const Vec3& outgoing) {
  const RandomKey random = randomKey(seed).with(key).with(position).with(normal);
  // Irradiance does not depend on where it is seen from; its numbers must not either.
  return key == kLambertKey ? random : random.with(outgoing);
}
RandomKey placedKey(std::uint64_t seed, const VectorPoint& point) {
  return placedKey(seed, point.key, point.position, point.normal, point.outgoing);
}

}  // namespace

RandomKey vectorKey(const LitPoint& point, SurfaceKey key, std::uint64_t seed) {
  return placedKey(seed, key, point.surface.position, point.surface.frame.z, point.outgoing);
}

RandomKey placeKey(const IndirectLightVector& record) { return placedKey(0, record.point); }
RandomKey placeKey(const DirectLightVector& record) {
  // As directVectorKey (core/render/direct_vectors.h): a DLV is of one view.
  return placedKey(0, record.point).with(record.point.outgoing);
}

Gatherer::Gatherer(const Tracer& tracer, const TransportParameters& transport,
                   const VectorParameters& parameters)
    : scene_(tracer.scene()), parameters_(parameters), estimator_(tracer, transport, kGatherOptions) {}

void Gatherer::traceHemisphere(const LitPoint& point, int rows, int columns, RandomKey key, RayCounts& counts,
                               SampleFaults& faults) {
  if (rows != orderedRows_ || columns != orderedColumns_) {
    cellOrder_ = blockOrder(rows, columns);
    orderedRows_ = rows;
    orderedColumns_ = columns;
  }
  hemisphere_.rows = rows;
  hemisphere_.columns = columns;
  hemisphere_.cells.assign(cellOrder_.size(), GatherCell{});
  starts_.clear();
  for (const std::uint32_t index : cellOrder_) {
    const std::uint32_t row = index / static_cast<std::uint32_t>(columns);
    const std::uint32_t column = index % static_cast<std::uint32_t>(columns);
    const Vec2 jitter = uniform2(key, index, 0);
    // theta = acos((M - j - X) / M), phi = 2 pi (k + Y) / N
    const float cosTheta =
        (static_cast<float>(rows) - static_cast<float>(row) - jitter.x) / static_cast<float>(rows);
    const float sinTheta = std::sqrt(std::max(0.0f, 1.0f - cosTheta * cosTheta));
    const float phi = kTwoPi * (static_cast<float>(column) + jitter.y) / static_cast<float>(columns);
    GatherCell& cell = hemisphere_.cells[index];
    cell.direction = {sinTheta * std::cos(phi), sinTheta * std::sin(phi), cosTheta};
    const Vec3 direction = point.surface.frame.toWorld(cell.direction);
    // Below the true surface a smooth normal's hemisphere sees the inside of the shape: dark.
    if (!(glm::dot(direction, point.surface.geometricNormal) > 0.0f)) continue;
    starts_.push_back({{point.surface.originTowards(direction), direction, 0.0f, kInfinity}, key, index});
  }
  results_.resize(starts_.size());
  estimator_.estimate(starts_, results_, Coherence::Coherent, counts.gather, counts, faults);
  for (std::size_t i = 0; i < starts_.size(); ++i) {
    GatherCell& cell = hemisphere_.cells[starts_[i].sample];
    cell.radiance = results_[i].indirect;
    cell.distance = results_[i].distance;
  }
}

Rgb Gatherer::traceLobe(const LitPoint& point, int samples, RandomKey key, MeanDistances& distances,
                        Vec3& direction, RayCounts& counts, SampleFaults& faults) {
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  const Vec3 outgoing = point.surface.frame.toLocal(point.outgoing);
  const Strata strata(samples);  // of the unit square that the lobe's sampling maps from
  starts_.clear();
  pdfs_.clear();
  for (int s = 0; s < samples; ++s) {
    const auto sample = static_cast<std::uint32_t>(s);
    const Vec3 incoming = brdf.sampleLobe(outgoing, strata.sample(s, uniform2(key, sample, 0)));
    const float pdf = incoming.z > 0.0f ? brdf.lobePdf(incoming, outgoing) : 0.0f;
    const Vec3 world = point.surface.frame.toWorld(incoming);
    if (!(pdf > 0.0f) || !(glm::dot(world, point.surface.geometricNormal) > 0.0f)) continue;
    starts_.push_back({{point.surface.originTowards(world), world, 0.0f, kInfinity}, key, sample});
    pdfs_.push_back(pdf);
  }
  results_.resize(starts_.size());
  estimator_.estimate(starts_, results_, Coherence::Coherent, counts.gather, counts, faults);
  Rgb radiance(0.0f);
  Vec3 sum(0.0f);
  Hemisphere hits;  // only its distances are asked for
  for (std::size_t i = 0; i < starts_.size(); ++i) {
    const Vec3 incoming = point.surface.frame.toLocal(starts_[i].ray.direction);
    const Rgb value =
        brdf.lobeRgb(incoming, outgoing, point.surface.tint) * results_[i].indirect * (incoming.z / pdfs_[i]);
    if (!isValidSample(value)) {
      ++faults.count;
      continue;
    }
    radiance += value;
    sum += paperBrightness(value) * starts_[i].ray.direction;
    hits.cells.push_back({incoming, value, results_[i].distance});
  }
  distances = meanDistances(hits);
  const float length = glm::length(sum);
  direction = length > 0.0f ? sum / length : point.surface.frame.z;
  return radiance / static_cast<float>(samples);
}

IndirectLightVector Gatherer::gather(const GatherPoint& point, SurfaceKey key, std::uint64_t seed,
                                     RayCounts& counts, SampleFaults& faults) {
  LitPoint lit = point.lit;
  // Vectors are free of textures: who asks them has their own.
  lit.surface.tint = Tint();
  const Frame& frame = lit.surface.frame;
  const std::uint64_t raysBefore = counts.total();
  const RandomKey random = vectorKey(lit, key, seed);
  const IlvParameters& ilv = parameters_.ilv;
  IndirectLightVector record;
  record.point = {lit.surface.position, frame.z, frame.x, lit.outgoing, key, point.footprint};

  MeanDistances distances;
  const bool isLobe = ilv.store == VectorStore::Split && key != kLambertKey;
  if (isLobe) {
    record.energy =
        traceLobe(lit, ilv.rows * ilv.columns, random, distances, record.direction, counts, faults);
    record.irradiance = record.energy;
    record.lobeWidth = scene_.materials[lit.surface.material].brdf.lobeHalfWidth();
  } else {
    traceHemisphere(lit, ilv.rows, ilv.columns, random, counts, faults);
    distances = meanDistances(hemisphere_);
    record.irradiance = hemisphereIrradiance(hemisphere_);
    const Vec3 localDirection = hemisphereDirection(hemisphere_);
    record.direction = frame.toWorld(localDirection);
    const IrradianceGradient gradient =
        ilv.gradient == IlvGradient::Printed ? printedGradient(hemisphere_) : stratifiedGradient(hemisphere_);
    for (int c = 0; c < 3; ++c) {
      record.gradient[c] = frame.toWorld(gradient.translation[c]);
      record.rotation[c] = frame.toWorld(gradient.rotation[c]);
    }
    record.energy = record.irradiance;
    if (ilv.store == VectorStore::Vector) {
      // Eq. 5, then P = L / f_r,d(D), eq. 4.
      const Brdf& brdf = scene_.materials[lit.surface.material].brdf;
      const Vec3 outgoing = frame.toLocal(lit.outgoing);
      Rgb radiance(0.0f);
      for (const GatherCell& cell : hemisphere_.cells) {
        radiance += brdf.evaluate(cell.direction, outgoing) * cell.radiance * cell.direction.z;
      }
      radiance *= kTwoPi / static_cast<float>(hemisphere_.cells.size());
      const Rgb f = brdf.evaluate(localDirection, outgoing);
      for (int c = 0; c < 3; ++c) record.energy[c] = f[c] > 0.0f ? radiance[c] / f[c] : 0.0f;
    }
  }
  record.arithmeticMean = distances.arithmetic;
  record.harmonicMean = distances.harmonic;
  record.leastDistance = distances.least;
  record.birth.rays = static_cast<std::uint32_t>(counts.total() - raysBefore);
  record.birth.identity = random;
  return record;
}

Rgb Gatherer::outgoingRadiance(const LitPoint& point, int samples, RandomKey key, RayCounts& counts,
                               SampleFaults& faults) {
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  Rgb radiance(0.0f);
  if (brdf.hasDiffuse()) {
    // Cells about twice as many around as down, as the paper's M and N.
    int rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(samples) / 2.0f)));
    while (samples % rows != 0) --rows;
    traceHemisphere(point, rows, samples / rows, key.with(0u), counts, faults);
    radiance += brdf.diffuse(point.surface.tint) * kInvPi * hemisphereIrradiance(hemisphere_);
  }
  if (brdf.hasLobe()) {
    MeanDistances distances;
    Vec3 direction;
    radiance += traceLobe(point, samples, key.with(1u), distances, direction, counts, faults);
  }
  return radiance;
}

}  // namespace lightvane
