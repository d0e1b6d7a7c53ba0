#include "core/trace/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/trace/mirrored_lights.h"

namespace lightvane {

DirectLightSampler::DirectLightSampler(const Tracer& tracer, const TransportParameters& parameters)
    : tracer_(tracer), scene_(tracer.scene()), parameters_(parameters) {
  for (int lane = 0; lane < kBatch; ++lane) candidates_.rays.set(lane, Ray{});
  allMirrored_.resize(scene_.mirroredLights.size());
  std::iota(allMirrored_.begin(), allMirrored_.end(), 0u);
}

DirectLightEstimate DirectLightSampler::estimate(const LitPoint& point, std::uint32_t light, int samples,
                                                 RandomKey key, RayCounts& counts, SampleFaults& faults) {
  DirectLightEstimate out;
  const LightSampler sampler(scene_.lights[light], point.surface.position, point.surface.frame.z);
  out.solidAngle = sampler.solidAngle();
  const int distinct = distinctSamples(scene_.lights[light]);
  const int count = distinct == 0 ? samples : std::min(samples, distinct);
  const bool eachOnce = count == distinct;
  const Strata strata = distinct == 0 ? Strata(count) : Strata::row(count);
  for (int begin = 0; begin < count; begin += kBatch) {
    place(strata, begin, eachOnce, key.with(light));
    sampler.sample(std::min(kBatch, count - begin), samples_);
    aim(point);
    resolve(point, Legs::Straight, 1.0f / static_cast<float>(count), out, counts, faults);
  }
  return out;
}

DirectLightEstimate DirectLightSampler::estimateMirrored(const LitPoint& point, int samples, RandomKey key,
                                                         RayCounts& counts, SampleFaults& faults) {
  return estimateMirrored(point, allMirrored_, samples, key, counts, faults);
}

DirectLightEstimate DirectLightSampler::estimateMirrored(const LitPoint& point,
                                                         std::span<const std::uint32_t> near, int samples,
                                                         RandomKey key, RayCounts& counts,
                                                         SampleFaults& faults) {
  DirectLightEstimate out;
  if (!samplesMirrored()) return out;
  for (const std::uint32_t m : near) {
    const MirroredLight& mirrored = scene_.mirroredLights[m];
    const Vec3& position = point.surface.position;
    if (!maySeeMirroredLight(scene_, mirrored, position) || !imageMayMeetMirror(scene_, mirrored, position))
      continue;
    const LightSampler sampler(mirrored.image, position);
    const Strata strata(samples);
    for (int begin = 0; begin < samples; begin += kBatch) {
      place(strata, begin, false, key.with(0x6d697272U).with(m));
      sampler.sample(std::min(kBatch, samples - begin), samples_);
      aim(point);
      aimByMirror(point, mirrored);
      resolve(point, Legs::ByMirror, 1.0f / static_cast<float>(samples), out, counts, faults);
    }
  }
  return out;
}

void DirectLightSampler::place(const Strata& strata, int begin, bool centred, RandomKey key) {
  SphericalSampleBatch& places = samples_.places;
  for (int i = 0; i < kBatch; ++i) {
    const Vec2 jitter = centred ? Vec2(0.5f) : uniform2(key, static_cast<std::uint32_t>(begin + i), 0);
    const Vec2 place = strata.sample(begin + i, jitter);
    places.u[i] = place.x;
    places.v[i] = place.y;
  }
}

void DirectLightSampler::aim(const LitPoint& point) {
  const SphericalSampleBatch& to = samples_.places;
  const Vec3 normal = point.surface.geometricNormal;
  const float offset = point.surface.offset;
  const Vec3 lift = offset * normal;
  const Vec3 origin = point.surface.position + lift;
  ShadowPacket& rays = candidates_.rays;
  std::int32_t inFront[kBatch];
  for (int i = 0; i < kBatch; ++i) {
    const float dx = to.directionX[i];
    const float dy = to.directionY[i];
    const float dz = to.directionZ[i];
    inFront[i] = dx * normal.x + dy * normal.y + dz * normal.z > 0.0f ? 1 : 0;
    const bool finite = to.distance[i] < kInfinity;
    const float distance = finite ? to.distance[i] : 0.0f;
    const float wayX = distance * dx - lift.x;
    const float wayY = distance * dy - lift.y;
    const float wayZ = distance * dz - lift.z;
    const float length = std::sqrt(wayX * wayX + wayY * wayY + wayZ * wayZ);
    const bool aimed = length > offset;
    const float end = length * kShadowEnd - offset;
    rays.originX[i] = origin.x;
    rays.originY[i] = origin.y;
    rays.originZ[i] = origin.z;
    rays.directionX[i] = finite && aimed ? wayX / length : dx;
    rays.directionY[i] = finite && aimed ? wayY / length : dy;
    rays.directionZ[i] = finite && aimed ? wayZ / length : dz;
    rays.tFar[i] = finite ? (aimed && end > 0.0f ? end : 0.0f) : kInfinity;
    candidates_.directionX[i] = dx;
    candidates_.directionY[i] = dy;
    candidates_.directionZ[i] = dz;
    candidates_.distance[i] = to.distance[i];
  }
  candidates_.count = 0;
  for (int i = 0; i < kBatch; ++i) {
    if (!samples_.reached[i] || inFront[i] == 0) continue;
    candidates_.weight[i] = samples_.weight[i];
    keep(i, candidates_.count++);
  }
}

void DirectLightSampler::keep(int from, int to) {
  if (from == to) return;
  ShadowPacket& rays = candidates_.rays;
  rays.directionX[to] = rays.directionX[from];
  rays.directionY[to] = rays.directionY[from];
  rays.directionZ[to] = rays.directionZ[from];
  rays.tFar[to] = rays.tFar[from];
  candidates_.directionX[to] = candidates_.directionX[from];
  candidates_.directionY[to] = candidates_.directionY[from];
  candidates_.directionZ[to] = candidates_.directionZ[from];
  candidates_.distance[to] = candidates_.distance[from];
  candidates_.weight[to] = candidates_.weight[from];
}

void DirectLightSampler::aimByMirror(const LitPoint& point, const MirroredLight& mirrored) {
  ShadowPacket& rays = candidates_.rays;
  const int count = std::exchange(candidates_.count, 0);
  for (int i = 0; i < count; ++i) {
    const Vec3 direction(candidates_.directionX[i], candidates_.directionY[i], candidates_.directionZ[i]);
    MirrorPath way;
    if (!mirrorPath(scene_, mirrored, point.surface, direction, candidates_.distance[i], way)) continue;
    const int place = candidates_.count++;
    keep(i, place);
    rays.set(place, way.toMirror);
    candidates_.toLight[place] = way.toLight;
    candidates_.weight[place] *= way.weight;
  }
}

void DirectLightSampler::traceSecondLegs(RayCounts& counts, DirectLightEstimate& out) {
  ShadowPacket legs;
  int lanes[kBatch];
  int count = 0;
  for (int i = 0; i < candidates_.count; ++i) {
    if (candidates_.rays.isOccluded(i)) continue;
    legs.set(count, candidates_.toLight[i]);
    lanes[count++] = i;
  }
  if (count == 0) return;
  tracer_.occluded(legs, count, Coherence::Coherent);
  counts.shadow += static_cast<std::uint64_t>(count);
  out.rays += count;
  for (int i = 0; i < count; ++i) {
    if (legs.isOccluded(i)) candidates_.rays.tFar[lanes[i]] = legs.tFar[i];
  }
}

void DirectLightSampler::resolve(const LitPoint& point, Legs legs, float share, DirectLightEstimate& out,
                                 RayCounts& counts, SampleFaults& faults) {
  if (candidates_.count == 0) return;
  tracer_.occluded(candidates_.rays, candidates_.count, Coherence::Coherent);
  counts.shadow += static_cast<std::uint64_t>(candidates_.count);
  out.rays += candidates_.count;
  if (legs == Legs::ByMirror) traceSecondLegs(counts, out);
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  const Vec3 outgoing = point.surface.frame.toLocal(point.outgoing);
  for (int i = 0; i < candidates_.count; ++i) {
    if (candidates_.rays.isOccluded(i)) continue;
    const Vec3 direction(candidates_.directionX[i], candidates_.directionY[i], candidates_.directionZ[i]);
    const Vec3 incoming = point.surface.frame.toLocal(direction);
    if (!(incoming.z > 0.0f)) continue;
    const Rgb light = candidates_.weight[i] * share;
    const Rgb irradiance = light * incoming.z;
    const Rgb lobe = brdf.hasLobe() ? brdf.lobeRgb(incoming, outgoing) * irradiance : Rgb(0.0f);
    if (!isValidSample(irradiance) || !isValidSample(lobe)) {
      ++faults.count;
      continue;
    }
    out.irradiance += irradiance;
    out.lobeRadiance += lobe;
    const float weight = paperBrightness(light);
    out.directionSum += weight * direction;
    out.directionWeight += weight;
  }
}

}  // namespace lightvane
