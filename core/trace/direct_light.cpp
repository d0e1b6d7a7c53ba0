#include "core/trace/direct_light.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

/// The strata of n samples in the unit square: columns * rows = n, as nearly square as n's divisors allow, or
/// all in one row for a light that is points, which the first coordinate chooses among.
struct Strata {
  explicit Strata(int n, bool oneRow = false)
      : columns(oneRow ? n : static_cast<int>(std::sqrt(static_cast<float>(n)))), rows(1) {
    while (n % columns != 0) --columns;
    rows = n / columns;
  }
  Vec2 sample(int index, const Vec2& jitter) const {
    return {(static_cast<float>(index % columns) + jitter.x) / static_cast<float>(columns),
            (static_cast<float>(index / columns) + jitter.y) / static_cast<float>(rows)};
  }
  int columns;
  int rows;
};

}  // namespace

DirectLightSampler::DirectLightSampler(const Tracer& tracer, const TransportParameters& parameters)
    : tracer_(tracer), scene_(tracer.scene()), parameters_(parameters) {}

DirectLightEstimate DirectLightSampler::estimate(const LitPoint& point, std::uint32_t light, int samples,
                                                 RandomKey key, RayCounts& counts, SampleFaults& faults) {
  DirectLightEstimate out;
  candidates_.clear();
  const LightSampler sampler(scene_.lights[light], point.surface.position);
  out.solidAngle = sampler.solidAngle();
  const int distinct = distinctSamples(scene_.lights[light]);
  const int count = distinct == 0 ? samples : std::min(samples, distinct);
  const bool eachOnce = count == distinct;
  const Strata strata(count, distinct != 0);
  const float share = 1.0f / static_cast<float>(count);
  const RandomKey lightKey = key.with(light);
  for (int s = 0; s < count; ++s) {
    LightSample sample;
    const Vec2 jitter = eachOnce ? Vec2(0.5f) : uniform2(lightKey, static_cast<std::uint32_t>(s), 0);
    if (!sampler.sample(strata.sample(s, jitter), sample)) continue;
    if (!(glm::dot(sample.direction, point.surface.geometricNormal) > 0.0f)) continue;
    candidates_.push_back({shadowRay(point.surface, sample.direction, sample.distance),
                           {},
                           false,
                           sample.direction,
                           sample.weight * share});
  }
  resolve(point, out, counts, faults);
  return out;
}

DirectLightEstimate DirectLightSampler::estimateMirrored(const LitPoint& point, int samples, RandomKey key,
                                                         RayCounts& counts, SampleFaults& faults) {
  DirectLightEstimate out;
  if (!parameters_.mirroredLights) return out;
  for (std::uint32_t m = 0; m < scene_.mirroredLights.size(); ++m) {
    const MirroredLight& mirrored = scene_.mirroredLights[m];
    if (!maySeeMirroredLight(scene_, mirrored, point.surface.position)) continue;
    candidates_.clear();
    const LightSampler sampler(mirrored.image, point.surface.position);
    const Strata strata(samples);
    const float share = 1.0f / static_cast<float>(samples);
    const RandomKey lightKey = key.with(0x6d697272U).with(m);
    for (int s = 0; s < samples; ++s) {
      LightSample sample;
      const Vec2 u = strata.sample(s, uniform2(lightKey, static_cast<std::uint32_t>(s), 0));
      MirrorPath way;
      if (!sampler.sample(u, sample) || !(glm::dot(sample.direction, point.surface.geometricNormal) > 0.0f))
        continue;
      if (!mirrorPath(scene_, mirrored, point.surface, sample.direction, sample.distance, way)) continue;
      candidates_.push_back(
          {way.toMirror, way.toLight, true, sample.direction, sample.weight * way.weight * share});
    }
    resolve(point, out, counts, faults);
  }
  return out;
}

void DirectLightSampler::resolve(const LitPoint& point, DirectLightEstimate& out, RayCounts& counts,
                                 SampleFaults& faults) {
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  const Vec3 outgoing = point.surface.frame.toLocal(point.outgoing);
  RayPacket packet;
  for (std::size_t begin = 0; begin < candidates_.size(); begin += kPacketWidth) {
    const int lanes = static_cast<int>(std::min<std::size_t>(kPacketWidth, candidates_.size() - begin));
    for (int lane = 0; lane < lanes; ++lane)
      packet.set(lane, candidates_[begin + static_cast<std::size_t>(lane)].ray);
    tracer_.occluded(packet, lanes, Coherence::Coherent);
    counts.shadow += static_cast<std::uint64_t>(lanes);
    out.rays += lanes;
    for (int lane = 0; lane < lanes; ++lane) {
      if (packet.isOccluded(lane)) continue;
      const Candidate& candidate = candidates_[begin + static_cast<std::size_t>(lane)];
      if (candidate.hasSecond) {
        ++counts.shadow;
        ++out.rays;
        if (tracer_.occluded(candidate.second)) continue;
      }
      const Vec3 incoming = point.surface.frame.toLocal(candidate.direction);
      if (!(incoming.z > 0.0f)) continue;
      const Rgb irradiance = candidate.weight * incoming.z;
      const Rgb lobe = brdf.hasLobe() ? brdf.lobeRgb(incoming, outgoing) * irradiance : Rgb(0.0f);
      if (!isValidSample(irradiance) || !isValidSample(lobe)) {
        ++faults.count;
        continue;
      }
      out.irradiance += irradiance;
      out.lobeRadiance += lobe;
      const float weight = paperBrightness(candidate.weight);
      out.directionSum += weight * candidate.direction;
      out.directionWeight += weight;
    }
  }
}

}  // namespace lightvane
