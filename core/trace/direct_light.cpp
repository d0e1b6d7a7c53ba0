#include "core/trace/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/trace/mirrored_lights.h"

namespace lightvane {
namespace {

// One lane of shadowRay(): from `lift` off the surface, `offset` long, to the place that is `distance` away
// along the unit vector (x, y, z). Choices are values, so that loops over it are vectorised.
struct AimedRay {
  float x, y, z, tFar;
};
[[gnu::always_inline]] inline AimedRay aimed(const Vec3& lift, float offset, float x, float y, float z,
                                             float distance) {
  const bool finite = distance < kInfinity;
  const float reach = finite ? distance : 0.0f;
  const float wayX = reach * x - lift.x;
  const float wayY = reach * y - lift.y;
  const float wayZ = reach * z - lift.z;
  const float length = std::sqrt(wayX * wayX + wayY * wayY + wayZ * wayZ);
  const bool turned = finite && length > offset;
  const float end = length * kShadowEnd - offset;
  return {turned ? wayX / length : x, turned ? wayY / length : y, turned ? wayZ / length : z,
          finite ? (turned && end > 0.0f ? end : 0.0f) : kInfinity};
}

/// Whether a ray from `origin` in unit `direction` may meet anything in the ball.
bool meetsBall(const Vec3& origin, const Vec3& direction, const Vec3& centre, float radius) {
  const Vec3 to = centre - origin;
  const float along = glm::dot(to, direction);
  const float distanceSquared = glm::dot(to, to);
  const float reach = square(radius) * 1.0001f;
  if (distanceSquared <= reach) return true;
  return along > 0.0f && distanceSquared - square(along) <= reach + 1e-6f * distanceSquared;
}

double sumOfInverseDensities(const LightSampleBatch& samples) {
  double sum = 0.0;
  for (int i = 0; i < LightSampleBatch::kCount; ++i) {
    if (samples.reached[i] && samples.pdf[i] > 0.0f) sum += 1.0 / static_cast<double>(samples.pdf[i]);
  }
  return sum;
}

/// Adds `weight` times what one light gives to what several give.
void addTo(DirectLightEstimate& sum, const DirectLightEstimate& one, float weight) {
  sum.irradiance += weight * one.irradiance;
  sum.lobeRadiance += weight * one.lobeRadiance;
  sum.rays += one.rays;
}

}  // namespace

DirectLightSampler::DirectLightSampler(const Tracer& tracer, const TransportParameters& parameters)
    : tracer_(tracer), scene_(tracer.scene()), parameters_(parameters) {
  for (int lane = 0; lane < kBatch; ++lane) {
    candidates_.rays.set(lane, Ray{});
    candidates_.secondLegs.set(lane, Ray{});
  }
  allMirrored_.resize(scene_.mirroredLights.size());
  std::iota(allMirrored_.begin(), allMirrored_.end(), 0u);
}

DirectLightEstimate DirectLightSampler::estimate(const LitPoint& point, std::uint32_t light, int samples,
                                                 RandomKey key, RayCounts& counts, SampleFaults& faults) {
  DirectLightEstimate out;
  const LightSampler sampler(scene_.lights[light], point.surface.position, point.surface.frame.z);
  const int distinct = distinctSamples(scene_.lights[light]);
  const int count = distinct == 0 ? samples : std::min(samples, distinct);
  const bool eachOnce = count == distinct;
  const Strata strata = distinct == 0 ? Strata(count) : Strata::row(count);
  const bool byLobe = samplesByLobe(scene_.materials[point.surface.material].brdf, scene_.lights[light],
                                    sampler.apparentSize());
  const SampleNumbers numbers{count, byLobe ? count : 0};
  double inverseDensities = 0.0;
  for (int begin = 0; begin < count; begin += kBatch) {
    place(strata, begin, eachOnce, key.with(light));
    sampler.sample(std::min(kBatch, count - begin), samples_);
    if (sampler.isByArea()) inverseDensities += sumOfInverseDensities(samples_);
    aim(point);
    resolve(point, Legs::Straight, numbers, out, counts, faults);
  }
  // To look at each of very many pieces would cost more than all rays do. What samples stand for, one over
  // their density, is on average what all pieces take in.
  out.solidAngle = sampler.isByArea() ? static_cast<float>(inverseDensities / count) : sampler.solidAngle();
  if (byLobe) addLobeSamples(point, light, sampler, numbers, key.with(light), out, counts, faults);
  return out;
}

void LightShares::weigh(const Scene& scene, const Vec3& position, const Vec3& normal, const LightSight* sight,
                        float least) {
  scene.lightTree.share(scene.lights, position, normal, least, LightSight::at(sight, position), parts_);
}

bool LightShares::areWorthVectorsOf(std::uint32_t light) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const LightTree::Part& part) {
    return part.number == light && isWorthVectors(part);
  });
}

template <class IsAsked>
DirectLightEstimate DirectLightSampler::estimateParts(const LitPoint& point,
                                                      std::span<const std::uint32_t> lights,
                                                      const LightShares& shares, int samples,
                                                      const IsAsked& isAsked, RandomKey key,
                                                      RayCounts& counts, SampleFaults& faults) {
  constexpr std::uint32_t kLotStream = 0x6c6f7473U;
  const Vec3& position = point.surface.position;
  const Vec3& normal = point.surface.frame.z;
  const LightTree::Sight sight = LightSight::at(sight_, position);
  const RandomKey lots = key.with(kLotStream);
  DirectLightEstimate out;
  const auto add = [&](std::uint32_t light, int rays, float weight, RandomKey itsKey) {
    if (lights.size() < scene_.lights.size() && !std::binary_search(lights.begin(), lights.end(), light))
      return;
    addTo(out, estimate(point, light, rays, itsKey, counts, faults), weight);
  };
  // Where the faint ones' shares add up to a whole number, one of them is drawn: each as often as it has a
  // share of a ray (systematic sampling).
  float sum = uniform(lots, 0, 0);
  std::uint32_t drawn = 0;
  for (const LightTree::Part& part : shares.parts()) {
    if (!isAsked(part)) continue;
    const float share = part.weight * static_cast<float>(samples) * kLightsWorthOfRays;
    if (part.kind == LightTree::Part::OfLight && share >= 1.0f) {
      add(part.number, std::min(static_cast<int>(std::ceil(share)), samples), 1.0f, key);
      continue;
    }
    for (sum += share; sum >= 1.0f; sum -= 1.0f) {
      const RandomKey lot = lots.with(++drawn);
      const auto choice =
          scene_.lightTree.chooseOf(part, scene_.lights, position, normal, uniform(lot, 0, 0), sight);
      if (choice) add(choice->light, 1, 1.0f / (share * choice->probability), lot);
    }
  }
  return out;
}

DirectLightEstimate DirectLightSampler::estimateTogether(const LitPoint& point,
                                                         std::span<const std::uint32_t> lights, int samples,
                                                         RandomKey key, RayCounts& counts,
                                                         SampleFaults& faults) {
  if (lights.size() > kMostLightsInFull) {
    const float least = 1.0f / (static_cast<float>(samples) * kLightsWorthOfRays);
    shares_.weigh(scene_, point.surface.position, point.surface.frame.z, sight_, least);
    const auto all = [](const LightTree::Part&) { return true; };
    return estimateParts(point, lights, shares_, samples, all, key, counts, faults);
  }
  DirectLightEstimate out;
  for (const std::uint32_t light : lights)
    addTo(out, estimate(point, light, samples, key, counts, faults), 1.0f);
  return out;
}

DirectLightEstimate DirectLightSampler::estimateFaint(const LitPoint& point,
                                                      std::span<const std::uint32_t> lights,
                                                      const LightShares& shares, int samples, RandomKey key,
                                                      RayCounts& counts, SampleFaults& faults) {
  const auto faint = [](const LightTree::Part& part) { return !LightShares::isWorthVectors(part); };
  return estimateParts(point, lights, shares, samples, faint, key, counts, faults);
}

bool DirectLightSampler::samplesByLobe(const Brdf& brdf, const Light& light, float solidAngle) const {
  // Where the lobe is wider, it changes so little over the light that the light's samples alone, which are
  // strata of what is looked for, have less noise than both kinds (LobeSamples.TakeTheNoiseOfLargeLights).
  constexpr float kNarrow = 0.6f;
  const float lightRadius = std::sqrt(solidAngle * kInvPi);
  return parameters_.lightsByLobe && brdf.hasLobe() && !isDirac(light) &&
         brdf.lobeHalfWidth() < kNarrow * lightRadius;
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
      resolve(point, Legs::ByMirror, {samples, 0}, out, counts, faults);
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
    const AimedRay ray = aimed(lift, offset, dx, dy, dz, to.distance[i]);
    rays.originX[i] = origin.x;
    rays.originY[i] = origin.y;
    rays.originZ[i] = origin.z;
    rays.directionX[i] = ray.x;
    rays.directionY[i] = ray.y;
    rays.directionZ[i] = ray.z;
    rays.tFar[i] = ray.tFar;
    candidates_.directionX[i] = dx;
    candidates_.directionY[i] = dy;
    candidates_.directionZ[i] = dz;
    candidates_.distance[i] = to.distance[i];
  }
  candidates_.count = 0;
  for (int i = 0; i < kBatch; ++i) {
    if (!samples_.reached[i] || inFront[i] == 0) continue;
    candidates_.weight[i] = samples_.weight[i];
    candidates_.pdf[i] = samples_.pdf[i];
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
  candidates_.pdf[to] = candidates_.pdf[from];
}

void DirectLightSampler::aimByMirror(const LitPoint& point, const MirroredLight& mirrored) {
  const PlanarMirror& mirror = scene_.planarMirrors[mirrored.mirror];
  const Vec3 normal = mirrored.frontSide ? mirror.normal : -mirror.normal;  // towards the point
  const Vec3& position = point.surface.position;
  const float offset = point.surface.offset;
  const float height = glm::dot(normal, position - mirror.outline.front());
  float slope[kBatch], toMirror[kBatch], atX[kBatch], atY[kBatch], atZ[kBatch];
  std::int32_t passes[kBatch];
  for (int i = 0; i < kBatch; ++i) {
    const float dx = candidates_.directionX[i];
    const float dy = candidates_.directionY[i];
    const float dz = candidates_.directionZ[i];
    slope[i] = dx * normal.x + dy * normal.y + dz * normal.z;
    toMirror[i] = -height / slope[i];
    passes[i] = (slope[i] < 0.0f ? 1 : 0) & (toMirror[i] > 0.0f ? 1 : 0) &
                (toMirror[i] < candidates_.distance[i] ? 1 : 0);
    atX[i] = position.x + toMirror[i] * dx;
    atY[i] = position.y + toMirror[i] * dy;
    atZ[i] = position.z + toMirror[i] * dz;
  }
  for (std::size_t c = 0; c < mirror.outline.size(); ++c) {
    const Vec3 corner = mirror.outline[c];
    const Vec3 inwards = mirror.inwards[c];
    for (int i = 0; i < kBatch; ++i) {
      const float inside =
          inwards.x * (atX[i] - corner.x) + inwards.y * (atY[i] - corner.y) + inwards.z * (atZ[i] - corner.z);
      passes[i] &= inside < 0.0f ? 0 : 1;
    }
  }
  const Vec3 lift = offset * point.surface.geometricNormal;
  const Vec3 liftOfMirror = offset * normal;
  ShadowPacket& first = candidates_.rays;
  ShadowPacket& second = candidates_.secondLegs;
  for (int i = 0; i < kBatch; ++i) {
    const float dx = candidates_.directionX[i];
    const float dy = candidates_.directionY[i];
    const float dz = candidates_.directionZ[i];
    const AimedRay ray = aimed(lift, offset, dx, dy, dz, toMirror[i]);
    first.directionX[i] = ray.x;
    first.directionY[i] = ray.y;
    first.directionZ[i] = ray.z;
    first.tFar[i] = ray.tFar;
    const float rest = candidates_.distance[i] - toMirror[i];
    const float turn = 2.0f * slope[i];
    const float wayX = rest * (dx - turn * normal.x) - liftOfMirror.x;
    const float wayY = rest * (dy - turn * normal.y) - liftOfMirror.y;
    const float wayZ = rest * (dz - turn * normal.z) - liftOfMirror.z;
    const float length = std::sqrt(wayX * wayX + wayY * wayY + wayZ * wayZ);
    passes[i] &= length > 0.0f ? 1 : 0;
    const float begin = length * (1.0f - kShadowEnd);
    const float end = length * kShadowEnd - offset;
    second.originX[i] = atX[i] + liftOfMirror.x;
    second.originY[i] = atY[i] + liftOfMirror.y;
    second.originZ[i] = atZ[i] + liftOfMirror.z;
    second.directionX[i] = wayX / length;
    second.directionY[i] = wayY / length;
    second.directionZ[i] = wayZ / length;
    second.tNear[i] = begin;
    second.tFar[i] = end < begin ? begin : end;
  }
  const int count = std::exchange(candidates_.count, 0);
  for (int i = 0; i < count; ++i) {
    if (passes[i] == 0) continue;
    const int place = candidates_.count++;
    keep(i, place);
    if (place != i) second.set(place, second.ray(i));
    candidates_.weight[place] *= mirrorReflectance(scene_, mirrored, -slope[i]);
  }
}

void DirectLightSampler::traceSecondLegs(RayCounts& counts, DirectLightEstimate& out) {
  ShadowPacket legs;
  int lanes[kBatch];
  int count = 0;
  for (int i = 0; i < candidates_.count; ++i) {
    if (candidates_.rays.isOccluded(i)) continue;
    legs.set(count, candidates_.secondLegs.ray(i));
    lanes[count++] = i;
  }
  if (count == 0) return;
  Rgb passed[kBatch];
  tracer_.shadow(legs, count, Coherence::Coherent, passed);
  counts.shadow += static_cast<std::uint64_t>(count);
  out.rays += count;
  for (int i = 0; i < count; ++i) {
    if (legs.isOccluded(i)) candidates_.rays.tFar[lanes[i]] = legs.tFar[i];
    candidates_.passed[lanes[i]] *= passed[i];
  }
}

void DirectLightSampler::resolve(const LitPoint& point, Legs legs, SampleNumbers numbers,
                                 DirectLightEstimate& out, RayCounts& counts, SampleFaults& faults) {
  if (candidates_.count == 0) return;
  tracer_.shadow(candidates_.rays, candidates_.count, Coherence::Coherent, candidates_.passed);
  counts.shadow += static_cast<std::uint64_t>(candidates_.count);
  out.rays += candidates_.count;
  if (legs == Legs::ByMirror) traceSecondLegs(counts, out);
  const Brdf& brdf = scene_.materials[point.surface.material].brdf;
  const Vec3 outgoing = point.surface.frame.toLocal(point.outgoing);
  const float share = 1.0f / static_cast<float>(numbers.ofLight);
  for (int i = 0; i < candidates_.count; ++i) {
    if (candidates_.rays.isOccluded(i)) continue;
    const Vec3 direction(candidates_.directionX[i], candidates_.directionY[i], candidates_.directionZ[i]);
    const Vec3 incoming = point.surface.frame.toLocal(direction);
    if (!(incoming.z > 0.0f)) continue;
    const Rgb light = candidates_.weight[i] * share * candidates_.passed[i];
    const Rgb irradiance = light * incoming.z;
    Rgb lobe = brdf.hasLobe() ? brdf.lobeRgb(incoming, outgoing, point.surface.tint) * irradiance : Rgb(0.0f);
    if (numbers.ofLobe > 0) {
      const float density = static_cast<float>(numbers.ofLight) * candidates_.pdf[i];
      lobe *= density / (density + static_cast<float>(numbers.ofLobe) * brdf.lobePdf(incoming, outgoing));
    }
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

void DirectLightSampler::addLobeSamples(const LitPoint& point, std::uint32_t light,
                                        const LightSampler& sampler, SampleNumbers numbers, RandomKey key,
                                        DirectLightEstimate& out, RayCounts& counts, SampleFaults& faults) {
  constexpr std::uint32_t kLobeStream = 0x6c6f6265U;
  const SurfacePoint& surface = point.surface;
  const Brdf& brdf = scene_.materials[surface.material].brdf;
  const Vec3 outgoing = surface.frame.toLocal(point.outgoing);
  const auto* area = std::get_if<AreaLight>(&scene_.lights[light]);
  LobeRays rays;
  const auto flush = [&] {
    if (area != nullptr) {
      meetLight(light, sampler, rays);
    } else {
      leaveScene(light, surface, rays);
    }
    counts.shadow += static_cast<std::uint64_t>(rays.count);
    out.rays += rays.count;
    for (int i = 0; i < rays.count; ++i) {
      if (isBlack(rays.radiance[i])) continue;
      const Vec3& incoming = rays.incoming[i];
      // Balance heuristic: the weight is the sample's density over the sum of all, and the former cancels.
      const float density = static_cast<float>(numbers.ofLight) * rays.lightPdf[i] +
                            static_cast<float>(numbers.ofLobe) * rays.lobePdf[i];
      const Rgb lobe =
          brdf.lobeRgb(incoming, outgoing, surface.tint) * (incoming.z / density) * rays.radiance[i];
      if (!isValidSample(lobe)) {
        ++faults.count;
        continue;
      }
      out.lobeRadiance += lobe;
    }
    rays.count = 0;
  };
  const Strata strata(numbers.ofLobe);
  const RandomKey lobeKey = key.with(kLobeStream);
  for (int s = 0; s < numbers.ofLobe; ++s) {
    const Vec2 jitter = uniform2(lobeKey, static_cast<std::uint32_t>(s), 0);
    const Vec3 incoming = brdf.sampleLobe(outgoing, strata.sample(s, jitter));
    if (!(incoming.z > 0.0f)) continue;
    const float pdf = brdf.lobePdf(incoming, outgoing);
    const Vec3 direction = surface.frame.toWorld(incoming);
    if (!(pdf > 0.0f) || !(glm::dot(direction, surface.geometricNormal) > 0.0f)) continue;
    if (area != nullptr && !meetsBall(surface.position, direction, area->boundCenter, area->boundRadius))
      continue;
    rays.rays[rays.count] = {surface.originTowards(direction), direction, 0.0f, kInfinity};
    rays.incoming[rays.count] = incoming;
    rays.lobePdf[rays.count] = pdf;
    if (++rays.count == kPacketWidth) flush();
  }
  if (rays.count > 0) flush();
}

void DirectLightSampler::meetLight(std::uint32_t light, const LightSampler& sampler, LobeRays& rays) const {
  HitPacket packet;
  for (int i = 0; i < rays.count; ++i) packet.rays.set(i, rays.rays[i]);
  Rgb passed[kPacketWidth];
  tracer_.intersectBehindPanes(packet, rays.count, Coherence::Incoherent, passed);
  for (int i = 0; i < rays.count; ++i) {
    rays.radiance[i] = Rgb(0.0f);
    const Hit hit = packet.hit(i);
    if (!hit.found()) continue;
    const SurfacePoint met = tracer_.surfaceAt(rays.rays[i], hit);
    if (scene_.surfaces[met.surface].light != light) continue;
    rays.radiance[i] = passed[i] * emittedRadiance(scene_, met);
    rays.lightPdf[i] = sampler.pdf(rays.rays[i].direction, met.piece);
  }
}

void DirectLightSampler::leaveScene(std::uint32_t light, const SurfacePoint& from, LobeRays& rays) const {
  ShadowPacket packet;
  for (int i = 0; i < rays.count; ++i) packet.set(i, rays.rays[i]);
  Rgb passed[kPacketWidth];
  tracer_.shadow(packet, rays.count, Coherence::Incoherent, passed);
  for (int i = 0; i < rays.count; ++i) {
    const Vec3& direction = rays.rays[i].direction;
    const bool arrives = !packet.isOccluded(i);
    rays.radiance[i] =
        arrives ? passed[i] * radianceFromInfinity(scene_.lights[light], direction) : Rgb(0.0f);
    rays.lightPdf[i] = lightPdfAtInfinity(scene_.lights[light], direction, from.frame.z);
  }
}

}  // namespace lightvane
