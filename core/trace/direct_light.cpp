#include "core/trace/direct_light.h"

#include <algorithm>
#include <cmath>

namespace lightvane {

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
  const Strata strata = distinct == 0 ? Strata(count) : Strata::row(count);
  const float share = 1.0f / static_cast<float>(count);
  const RandomKey lightKey = key.with(light);
  for (int s = 0; s < count; ++s) {
    LightSample sample;
    const Vec2 jitter = eachOnce ? Vec2(0.5f) : uniform2(lightKey, static_cast<std::uint32_t>(s), 0);
    if (!sampler.sample(strata.sample(s, jitter), sample)) continue;
    if (!(glm::dot(sample.direction, point.surface.geometricNormal) > 0.0f)) continue;
    candidates_.push_back({shadowRay(point.surface, sample.direction, sample.distance), kNone,
                           sample.direction, sample.weight * share});
  }
  resolve(point, out, counts, faults);
  return out;
}

DirectLightEstimate DirectLightSampler::estimateMirrored(const LitPoint& point, int samples, RandomKey key,
                                                         RayCounts& counts, SampleFaults& faults) {
  DirectLightEstimate out;
  if (!parameters_.samplesMirroredLights()) return out;
  for (std::uint32_t m = 0; m < scene_.mirroredLights.size(); ++m) {
    const MirroredLight& mirrored = scene_.mirroredLights[m];
    if (!maySeeMirroredLight(scene_, mirrored, point.surface.position)) continue;
    candidates_.clear();
    secondRays_.clear();
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
      candidates_.push_back({way.toMirror, static_cast<std::uint32_t>(secondRays_.size()), sample.direction,
                             sample.weight * way.weight * share});
      secondRays_.push_back(way.toLight);
    }
    resolve(point, out, counts, faults);
  }
  return out;
}

void DirectLightSampler::resolve(const LitPoint& point, DirectLightEstimate& out, RayCounts& counts,
                                 SampleFaults& faults) {
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  const Vec3 outgoing = point.surface.frame.toLocal(point.outgoing);
  ShadowPacket packet;
  for (std::size_t begin = 0; begin < candidates_.size(); begin += kShadowPacketWidth) {
    const int lanes = static_cast<int>(std::min<std::size_t>(kShadowPacketWidth, candidates_.size() - begin));
    for (int lane = 0; lane < lanes; ++lane)
      packet.set(lane, candidates_[begin + static_cast<std::size_t>(lane)].ray);
    tracer_.occluded(packet, lanes, Coherence::Coherent);
    counts.shadow += static_cast<std::uint64_t>(lanes);
    out.rays += lanes;
    for (int lane = 0; lane < lanes; ++lane) {
      if (packet.isOccluded(lane)) continue;
      const Candidate& candidate = candidates_[begin + static_cast<std::size_t>(lane)];
      if (candidate.second != kNone) {
        ++counts.shadow;
        ++out.rays;
        if (tracer_.occluded(secondRays_[candidate.second])) continue;
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
