#include "core/trace/radiance.h"

#include <algorithm>
#include <cmath>

namespace lightvane {
namespace {

// Lights are all sampled at every vertex up to so many; beyond, one is chosen by the bound of what it can
// give.
constexpr std::size_t kSampleAllLights = 4;

// Dimensions of one vertex's random numbers.
enum Dimension : std::uint32_t {
  RouletteDimension = 0,
  SpecularChoiceDimension = 1,
  BrdfDimension = 2,  // and 3
  LightChoiceDimension = 4,
  MirrorChoiceDimension = 5,
  MirrorSampleDimension = 6,  // and 7
  LightSampleDimension = 8,   // and on, two a sample
  OpacityDimension = 0xffffffffU
};

// Below this survival probability a path's weight would make fireflies rather than save time.
constexpr float kLeastSurvival = 0.05f;

// In a closed room of perfectly white walls nothing is ever absorbed. After so many reflections a path may
// end even if it still carries all of its light; without roulette it has to.
constexpr int kFreeBounces = 64;
constexpr float kMostSurvival = 0.95f;
constexpr int kMostBounces = 1000;

/// The corner that ends the side of the outline that begins at this one. Not by a remainder, which is slow.
std::size_t nextCorner(const PlanarMirror& mirror, std::size_t corner) {
  return corner + 1 < mirror.outline.size() ? corner + 1 : 0;
}

/// All of the light is on the other side of the plane through `position` whose normal is `inwards`.
bool isBeyondSide(const AreaLight& light, const Vec3& position, const Vec3& inwards) {
  const auto height = [&](const Vec3& p) { return glm::dot(p - position, inwards); };
  if (!light.polygon.empty()) {
    return std::all_of(light.polygon.begin(), light.polygon.end(),
                       [&](const Vec3& corner) { return height(corner) < 0.0f; });
  }
  for (const EmitterTriangle& t : light.triangles) {
    if (!(height(t.a) < 0.0f) || !(height(t.b) < 0.0f) || !(height(t.c) < 0.0f)) return false;
  }
  if (light.spheres.empty() && light.discs.empty()) return true;
  const float length = glm::length(inwards);
  for (const EmitterSphere& s : light.spheres) {
    if (!(height(s.center) < -s.radius * length)) return false;
  }
  for (const EmitterDisc& d : light.discs) {
    if (!(height(d.center) < -d.radius * length)) return false;
  }
  return true;
}

}  // namespace

Ray shadowRay(const SurfacePoint& point, const Vec3& direction, float distance) {
  const Vec3 origin = point.originTowards(direction);
  if (!(distance < kInfinity)) return {origin, direction, 0.0f, kInfinity};
  // From the lifted origin to the very same place. Along `direction` itself the ray would end beyond a light
  // that is near, and be stopped by it.
  const float lift = glm::dot(direction, point.geometricNormal) >= 0.0f ? point.offset : -point.offset;
  const Vec3 way = distance * direction - lift * point.geometricNormal;
  const float length = glm::length(way);
  if (!(length > point.offset)) return {origin, direction, 0.0f, 0.0f};
  return {origin, way / length, 0.0f, std::max(0.0f, length * kShadowEnd - point.offset)};
}

bool maySeeMirroredLight(const Scene& scene, const MirroredLight& mirrored, const Vec3& position) {
  const PlanarMirror& mirror = scene.planarMirrors[mirrored.mirror];
  const float height = glm::dot(mirror.normal, position - mirror.outline.front());
  const float side = mirrored.frontSide ? 1.0f : -1.0f;
  if (!(side * height > 0.0f)) return false;
  const auto& image = std::get<AreaLight>(mirrored.image);
  for (std::size_t i = 0; i < mirror.outline.size(); ++i) {
    const Vec3 a = mirror.outline[i] - position;
    const Vec3 b = mirror.outline[nextCorner(mirror, i)] - position;
    // Points inwards, because the outline runs counter-clockwise as seen from the front side.
    const Vec3 inwards = side * glm::cross(b, a);
    if (isBeyondSide(image, position, inwards)) return false;
  }
  return true;
}

Rgb mirrorReflectance(const Scene& scene, const MirroredLight& mirrored, float cosine) {
  const Brdf& brdf = scene.materialOf(scene.planarMirrors[mirrored.mirror].surface).brdf;
  const Vec3 outgoing(std::sqrt(std::max(0.0f, 1.0f - square(cosine))), 0.0f, cosine);
  std::array<SpecularBranch, 2> branches;
  const int count = brdf.specularBranches(outgoing, mirrored.frontSide, {}, branches);
  Rgb reflectance(0.0f);
  for (int i = 0; i < count; ++i) {
    const SpecularBranch& branch = branches[static_cast<std::size_t>(i)];
    if (!branch.transmitted) reflectance += branch.weight;
  }
  return reflectance;
}

bool mirrorPath(const Scene& scene, const MirroredLight& mirrored, const SurfacePoint& point,
                const Vec3& direction, float distance, MirrorPath& path) {
  const PlanarMirror& mirror = scene.planarMirrors[mirrored.mirror];
  const float slope = glm::dot(mirror.normal, direction);
  const float side = mirrored.frontSide ? 1.0f : -1.0f;
  if (!(slope * side < 0.0f)) return false;
  const float t = glm::dot(mirror.normal, mirror.outline.front() - point.position) / slope;
  if (!(t > 0.0f && t < distance)) return false;
  const Vec3 at = point.position + t * direction;
  for (std::size_t i = 0; i < mirror.outline.size(); ++i) {
    if (glm::dot(mirror.inwards[i], at - mirror.outline[i]) < 0.0f) return false;
  }
  path.weight = mirrorReflectance(scene, mirrored, -slope * side);
  // The mirror's own surface must not occlude either part: both stop short of it by a part of their length.
  path.toMirror = shadowRay(point, direction, t);
  const Vec3 reflected = direction - 2.0f * slope * mirror.normal;
  const float rest = distance - t;
  const Vec3 lift = side * point.offset * mirror.normal;
  const Vec3 way = rest * reflected - lift;
  const float length = glm::length(way);
  if (!(length > 0.0f)) return false;
  const float begin = length * (1.0f - kShadowEnd);
  path.toLight = {at + lift, way / length, begin, std::max(begin, length * kShadowEnd - point.offset)};
  return true;
}

RadianceEstimator::RadianceEstimator(const Tracer& tracer, const TransportParameters& parameters,
                                     const EstimatorOptions& options)
    : tracer_(tracer), scene_(tracer.scene()), parameters_(parameters), options_(options) {
  options_.mirroredLights = options.mirroredLights && parameters.samplesMirroredLights();
  if (!parameters_.roulette && parameters_.maxBounces == 0) parameters_.maxBounces = kMostBounces;
}

bool RadianceEstimator::isStopped(std::size_t path) const {
  constexpr std::size_t kPathsBetweenAsking = 4096;
  return stop_ != nullptr && path % kPathsBetweenAsking == 0 && *stop_;
}

bool RadianceEstimator::isLastVertex(const Path& path) const {
  return parameters_.maxBounces > 0 && path.bounces >= parameters_.maxBounces;
}

bool RadianceEstimator::isMirrored(std::uint32_t light, std::uint32_t mirror, bool front) const {
  if (!options_.mirroredLights || mirror == kNone) return false;
  return std::any_of(scene_.mirroredLights.begin(), scene_.mirroredLights.end(), [&](const MirroredLight& m) {
    return m.light == light && m.mirror == mirror && m.frontSide == front;
  });
}

void RadianceEstimator::add(PathRadiance& result, const Path& path, const Rgb& value, bool meetsLight,
                            SampleFaults& faults) {
  if (!isValidSample(value)) {
    ++faults.count;
    return;
  }
  if (path.reachedSpecularly || (path.bounces == 0 && path.specularRun > 0)) {
    result.specular += value;
  } else if (path.bounces == 0) {
    result.emission += value;
  } else if (path.bounces == 1 && path.specularRun == 0 && meetsLight) {
    result.direct += value;
  } else {
    result.indirect += value;
  }
}

void RadianceEstimator::estimate(std::span<const PathStart> starts, std::span<PathRadiance> results,
                                 Coherence first, std::uint64_t& firstRays, RayCounts& counts,
                                 SampleFaults& faults) {
  paths_.clear();
  const bool onSurface = options_.origin == PathOrigin::Surface;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    results[i] = PathRadiance{};
    const PathStart& start = starts[i];
    paths_.push_back({start.ray, Rgb(1.0f), start.key, start.sample, static_cast<std::uint32_t>(i), 0.0f,
                      start.ray.origin, Vec3(0.0f), static_cast<std::uint16_t>(onSurface ? 1 : 0), 0, false,
                      kNone, false});
  }
  traceBounce(first, firstRays);
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    if (hits_[i].found()) results[i].distance = hits_[i].t;
  }
  while (!paths_.empty()) {
    nextPaths_.clear();
    shadows_.clear();
    secondRays_.clear();
    for (std::size_t i = 0; i < paths_.size(); ++i) {
      if (isStopped(i)) {
        litVertices_.clear();
        return;
      }
      shade(paths_[i], hits_[i], results, faults);
      if (litVertices_.size() == LightSampleBatch::kCount) sampleLights();
    }
    sampleLights();
    traceShadows(results, counts, faults);
    std::swap(paths_, nextPaths_);
    traceBounce(Coherence::Incoherent, counts.bounce);
  }
}

void RadianceEstimator::traceBounce(Coherence coherence, std::uint64_t& rays) {
  hits_.resize(paths_.size());
  rays += paths_.size();
  HitPacket packet;
  for (std::size_t begin = 0; begin < paths_.size(); begin += kPacketWidth) {
    if (isStopped(begin)) return;
    const int count = static_cast<int>(std::min<std::size_t>(kPacketWidth, paths_.size() - begin));
    for (int lane = 0; lane < count; ++lane)
      packet.rays.set(lane, paths_[begin + static_cast<std::size_t>(lane)].ray);
    tracer_.intersect(packet, count, coherence);
    for (int lane = 0; lane < count; ++lane) hits_[begin + static_cast<std::size_t>(lane)] = packet.hit(lane);
  }
}

RandomKey RadianceEstimator::keyOf(const Path& path) {
  return path.key.with(static_cast<std::uint32_t>(path.bounces) * 64U + path.specularRun +
                       (static_cast<std::uint32_t>(path.panes) << 20U));
}

void RadianceEstimator::shade(const Path& path, const Hit& hit, std::span<PathRadiance> results,
                              SampleFaults& faults) {
  if (!hit.found()) {
    if (scene_.needs.infiniteLights) addInfinite(path, results, faults);
    return;
  }
  const SurfacePoint point = tracer_.surfaceAt(path.ray, hit);
  const Material& material = scene_.materials[point.material];
  if (point.opacity < 1.0f) {
    const RandomKey key = keyOf(path);
    if (uniform(key, path.sample, OpacityDimension) >= point.opacity)
      return continueStraight(path, point, hit.t);
  }
  if (scene_.surfaces[point.surface].light != kNone)
    addEmission(path, point, path.beforePanes + hit.t, results, faults);

  const RandomKey key = keyOf(path);
  const Vec3 outgoing = point.frame.toLocal(-path.ray.direction);
  const bool specular = material.brdf.hasSpecular();
  const bool nonSpecular = material.brdf.hasNonSpecular();
  if (nonSpecular) litVertices_.push_back({&path, point, &material.brdf, outgoing, key});
  if (specular && nonSpecular) {
    // One of the two ways, by what each can carry.
    std::array<SpecularBranch, 2> branches;
    float specularShare = 0.0f;
    const int count = material.brdf.specularBranches(outgoing, point.frontSide, point.tint, branches);
    for (int i = 0; i < count; ++i)
      specularShare += maxComponent(branches[static_cast<std::size_t>(i)].weight);
    const float otherShare = maxComponent(material.brdf.nonSpecularAlbedoBound(point.tint));
    const float sum = specularShare + otherShare;
    if (!(sum > 0.0f)) return;
    const float probability = specularShare / sum;
    Path chosen = path;
    if (uniform(key, path.sample, SpecularChoiceDimension) < probability) {
      chosen.throughput /= probability;
      continueSpecularly(chosen, point, outgoing, hit.t, key);
    } else {
      chosen.throughput /= 1.0f - probability;
      continueDiffusely(chosen, point, outgoing, key);
    }
  } else if (specular) {
    continueSpecularly(path, point, outgoing, hit.t, key);
  } else if (nonSpecular) {
    continueDiffusely(path, point, outgoing, key);
  }
}

float RadianceEstimator::brdfWeight(const Path& path, std::uint32_t light, float lightDensity) const {
  lightDensity *= static_cast<float>(parameters_.bounceLightSamples);
  if (scene_.lights.size() > kSampleAllLights) {
    const float probability = scene_.lightTree.probability(
        scene_.lights, light, path.vertex, path.vertexNormal, LightSight::at(sight_, path.vertex));
    if (!(probability > 0.0f)) return 1.0f;
    lightDensity *= probability;
  }
  return path.pdf / (path.pdf + lightDensity);
}

void RadianceEstimator::addEmission(const Path& path, const SurfacePoint& point, float distance,
                                    std::span<PathRadiance> results, SampleFaults& faults) {
  const Rgb emitted = emittedRadiance(scene_, point);
  if (isBlack(emitted)) return;
  const std::uint32_t light = scene_.surfaces[point.surface].light;
  const bool straight = path.bounces > 0 && path.specularRun == 0;
  float weight = 1.0f;
  if (straight) {
    const bool fromOriginSurface = options_.origin == PathOrigin::Surface && path.bounces == 1;
    if (fromOriginSurface) {
      if (!options_.straightLight) return;
    } else if (path.pdf > 0.0f) {
      const float cosAtLight = std::abs(glm::dot(path.ray.direction, point.geometricNormal));
      const float pdf =
          lightPdf(scene_.lights[light], path.vertex, path.ray.direction, point.piece, distance, cosAtLight);
      weight = brdfWeight(path, light, pdf);
    }
  } else if (path.bounces > 0 && path.specularRun == 1 && isMirrored(light, path.mirror, path.mirrorFront)) {
    return;
  }
  add(results[path.result], path, path.throughput * emitted * weight, true, faults);
}

void RadianceEstimator::addInfinite(const Path& path, std::span<PathRadiance> results, SampleFaults& faults) {
  const bool straight = path.bounces > 0 && path.specularRun == 0;
  if (straight && options_.origin == PathOrigin::Surface && path.bounces == 1 && !options_.straightLight)
    return;
  for (std::size_t l = 0; l < scene_.lights.size(); ++l) {
    const Rgb radiance = radianceFromInfinity(scene_.lights[l], path.ray.direction);
    if (isBlack(radiance)) continue;
    float weight = 1.0f;
    if (straight && path.pdf > 0.0f) {
      weight = brdfWeight(path, static_cast<std::uint32_t>(l),
                          lightPdfAtInfinity(scene_.lights[l], path.ray.direction, path.vertexNormal));
    }
    add(results[path.result], path, path.throughput * radiance * weight, true, faults);
  }
}

void RadianceEstimator::sampleLights() {
  if (litVertices_.empty()) return;
  if (scene_.lights.size() <= kSampleAllLights) {
    for (std::size_t l = 0; l < scene_.lights.size(); ++l) sampleLight(l);
  } else {
    for (const LitVertex& at : litVertices_) sampleOneOfManyLights(at);
  }
  if (options_.mirroredLights && !scene_.mirroredLights.empty()) {
    for (const LitVertex& at : litVertices_) sampleMirroredLight(at);
  }
  litVertices_.clear();
}

Rgb RadianceEstimator::reflected(const LitVertex& at, const Vec3& direction, const Rgb& weight) {
  const Vec3 incoming = at.point.frame.toLocal(direction);
  if (!(glm::dot(direction, at.point.geometricNormal) > 0.0f && incoming.z > 0.0f)) return Rgb(0.0f);
  return at.path->throughput * at.brdf->evaluate(incoming, at.outgoing, at.point.tint) * incoming.z * weight;
}

void RadianceEstimator::addShadowRay(const LitVertex& at, const Ray& ray, std::uint32_t second,
                                     const Rgb& contribution) {
  // The vertex at hand is the path's next non-specular one: its light arrives straight at that vertex.
  const bool firstVertex = at.path->bounces == 0;
  const bool specularLayer = at.path->reachedSpecularly || (firstVertex && at.path->specularRun > 0);
  shadows_.push_back(
      {ray, second, at.path->result, contribution, firstVertex && second == kNone, specularLayer});
}

std::uint32_t RadianceEstimator::lightDimension(std::size_t light, int sample, int samples) {
  const std::size_t number = light * static_cast<std::size_t>(samples) + static_cast<std::size_t>(sample);
  return LightSampleDimension + 2U * static_cast<std::uint32_t>(number);
}

void RadianceEstimator::sampleOneOfManyLights(const LitVertex& at) {
  const float u = uniform(at.key, at.path->sample, LightChoiceDimension);
  const Vec3& place = at.point.position;
  const auto choice =
      scene_.lightTree.choose(scene_.lights, place, at.point.frame.z, u, LightSight::at(sight_, place));
  if (!choice) return;
  const int samples = parameters_.bounceLightSamples;
  const LightSampler sampler(scene_.lights[choice->light], place, at.point.frame.z);
  for (int s = 0; s < samples; ++s) {
    LightSample light;
    if (sampler.sample(uniform2(at.key, at.path->sample, lightDimension(choice->light, s, samples)), light))
      useLightSample(at, light, choice->probability);
  }
}

void RadianceEstimator::sampleLight(std::size_t l) {
  const int samples = parameters_.bounceLightSamples;
  SphericalPointBatch points;
  LightSampleBatch batch;
  std::array<Vec3, LightSampleBatch::kCount> normals;
  // Lanes beyond the last vertex repeat the first one.
  const auto vertexOf = [&](std::size_t lane) -> const LitVertex& {
    return litVertices_[lane < litVertices_.size() ? lane : 0];
  };
  for (std::size_t i = 0; i < LightSampleBatch::kCount; ++i) {
    const SurfacePoint& point = vertexOf(i).point;
    points.x[i] = point.position.x;
    points.y[i] = point.position.y;
    points.z[i] = point.position.z;
    normals[i] = point.frame.z;
  }
  for (int s = 0; s < samples; ++s) {
    const std::uint32_t dimension = lightDimension(l, s, samples);
    for (std::size_t i = 0; i < LightSampleBatch::kCount; ++i) {
      const LitVertex& at = vertexOf(i);
      batch.places.u[i] = uniform(at.key, at.path->sample, dimension);
      batch.places.v[i] = uniform(at.key, at.path->sample, dimension + 1);
    }
    sampleFromEach(scene_.lights[l], static_cast<int>(litVertices_.size()), points, normals, batch);
    for (std::size_t i = 0; i < litVertices_.size(); ++i) {
      if (batch.reached[i]) useLightSample(litVertices_[i], batch.at(static_cast<int>(i)), 1.0f);
    }
  }
}

void RadianceEstimator::useLightSample(const LitVertex& at, const LightSample& light, float probability) {
  const auto samples = static_cast<float>(parameters_.bounceLightSamples);
  Rgb value = reflected(at, light.direction, light.weight * (1.0f / (samples * probability)));
  if (isBlack(value)) return;
  // No BRDF sample follows the last vertex: light samples carry all of its light.
  if (light.pdf > 0.0f && !isLastVertex(*at.path)) {
    const float lightDensity = light.pdf * samples * probability;
    value *=
        lightDensity / (lightDensity + at.brdf->pdf(at.point.frame.toLocal(light.direction), at.outgoing));
  }
  addShadowRay(at, shadowRay(at.point, light.direction, light.distance), kNone, value);
}

void RadianceEstimator::sampleMirroredLight(const LitVertex& at) {
  mayBeSeen_.clear();
  for (const MirroredLight& mirrored : scene_.mirroredLights) {
    if (maySeeMirroredLight(scene_, mirrored, at.point.position)) mayBeSeen_.push_back(&mirrored);
  }
  if (mayBeSeen_.empty()) return;
  const auto candidates = static_cast<float>(mayBeSeen_.size());
  const auto pick =
      static_cast<std::size_t>(uniform(at.key, at.path->sample, MirrorChoiceDimension) * candidates);
  if (pick >= mayBeSeen_.size()) return;
  const MirroredLight& mirrored = *mayBeSeen_[pick];
  LightSample light;
  MirrorPath way;
  if (!lightvane::sampleLight(mirrored.image, at.point.position,
                              uniform2(at.key, at.path->sample, MirrorSampleDimension), light) ||
      !mirrorPath(scene_, mirrored, at.point, light.direction, light.distance, way)) {
    return;
  }
  const Rgb value = reflected(at, light.direction, light.weight * way.weight * candidates);
  if (isBlack(value)) return;
  addShadowRay(at, way.toMirror, static_cast<std::uint32_t>(secondRays_.size()), value);
  secondRays_.push_back(way.toLight);
}

void RadianceEstimator::continueSpecularly(const Path& path, const SurfacePoint& point, const Vec3& outgoing,
                                           float distance, RandomKey key) {
  if (path.specularRun + path.panes >= parameters_.specularDepth) return;
  std::array<SpecularBranch, 2> branches;
  const int count =
      scene_.materials[point.material].brdf.specularBranches(outgoing, point.frontSide, point.tint, branches);
  if (count == 0) return;
  std::size_t chosen = 0;
  float probability = 1.0f;
  if (count == 2) {
    const float first = maxComponent(branches[0].weight);
    const float sum = first + maxComponent(branches[1].weight);
    if (!(sum > 0.0f)) return;
    const float toFirst = first / sum;
    const float u = uniform(key, path.sample, BrdfDimension);
    chosen = u < toFirst ? 0 : 1;
    probability = chosen == 0 ? toFirst : 1.0f - toFirst;
  }
  Path next = path;
  next.throughput *= branches[chosen].weight / probability;
  if (parameters_.roulette) {
    // Long ways through mirrors and glass end by what they still carry, so that no limit has to cut them.
    const float survival = std::min(1.0f, maxComponent(next.throughput));
    if (!(survival > 0.0f)) return;
    if (path.specularRun + path.panes > 2 && survival < 0.5f) {
      if (uniform(key, path.sample, RouletteDimension) >= survival) return;
      next.throughput /= survival;
    }
  }
  const Vec3 direction = glm::normalize(point.frame.toWorld(branches[chosen].direction));
  next.ray = {point.originTowards(direction), direction, 0.0f, kInfinity};
  if (branches[chosen].transmitted && path.bounces > 0 && scene_.materials[point.material].brdf.isThin()) {
    // Shadow rays pass panes, too, so that what the path meets is no way around them.
    return continueStraight(next, point, distance);
  }
  next.mirror = path.specularRun == 0 && !branches[chosen].transmitted
                    ? scene_.surfaces[point.surface].planarMirror
                    : kNone;
  next.mirrorFront = point.frontSide;
  ++next.specularRun;
  nextPaths_.push_back(next);
}

void RadianceEstimator::continueStraight(const Path& path, const SurfacePoint& point, float distance) {
  if (path.panes >= Tracer::kMostPanes) return;
  Path next = path;
  next.ray = {point.originTowards(path.ray.direction), path.ray.direction, 0.0f, kInfinity};
  next.beforePanes += distance;
  ++next.panes;
  nextPaths_.push_back(next);
}

void RadianceEstimator::continueDiffusely(const Path& path, const SurfacePoint& point, const Vec3& outgoing,
                                          RandomKey key) {
  const Brdf& brdf = scene_.materials[point.material].brdf;
  if (isLastVertex(path)) return;
  const Vec2 u = uniform2(key, path.sample, BrdfDimension);
  Path next = path;
  Vec3 incoming;
  if (!brdf.hasLobe()) {
    incoming = sampleCosine(u);
    next.throughput *= brdf.diffuse(point.tint);
    next.pdf = incoming.z * kInvPi;
  } else {
    incoming = brdf.sample(outgoing, u);
    next.pdf = incoming.z > 0.0f ? brdf.pdf(incoming, outgoing) : 0.0f;
    if (!(next.pdf > 0.0f)) return;
    next.throughput *= brdf.evaluate(incoming, outgoing, point.tint) * (incoming.z / next.pdf);
  }
  if (!(incoming.z > 0.0f) || !(maxComponent(next.throughput) > 0.0f)) return;
  if (parameters_.roulette) {
    const float survival = std::clamp(maxComponent(next.throughput), kLeastSurvival,
                                      path.bounces < kFreeBounces ? 1.0f : kMostSurvival);
    if (survival < 1.0f) {
      if (uniform(key, path.sample, RouletteDimension) >= survival) return;
      next.throughput /= survival;
    }
  }
  const Vec3 direction = point.frame.toWorld(incoming);
  if (!(glm::dot(direction, point.geometricNormal) > 0.0f)) return;
  next.ray = {point.originTowards(direction), direction, 0.0f, kInfinity};
  next.vertex = point.position;
  next.vertexNormal = point.frame.z;
  next.reachedSpecularly = path.reachedSpecularly || (path.bounces == 0 && path.specularRun > 0);
  ++next.bounces;
  next.specularRun = 0;
  next.panes = 0;
  next.beforePanes = 0.0f;
  next.mirror = kNone;
  nextPaths_.push_back(next);
}

void RadianceEstimator::traceShadows(std::span<PathRadiance> results, RayCounts& counts,
                                     SampleFaults& faults) {
  ShadowPacket packet;
  for (std::size_t begin = 0; begin < shadows_.size(); begin += kShadowPacketWidth) {
    if (isStopped(begin)) return;
    const int count = static_cast<int>(std::min<std::size_t>(kShadowPacketWidth, shadows_.size() - begin));
    for (int lane = 0; lane < count; ++lane)
      packet.set(lane, shadows_[begin + static_cast<std::size_t>(lane)].ray);
    Rgb passed[kShadowPacketWidth];
    tracer_.shadow(packet, count, Coherence::Incoherent, passed);
    counts.shadow += static_cast<std::uint64_t>(count);
    for (int lane = 0; lane < count; ++lane) {
      if (packet.isOccluded(lane)) continue;
      const ShadowRay& shadow = shadows_[begin + static_cast<std::size_t>(lane)];
      Rgb contribution = shadow.contribution * passed[lane];
      if (shadow.second != kNone) {
        ++counts.shadow;
        ShadowPacket second;
        Rgb passedThen;
        second.set(0, secondRays_[shadow.second]);
        tracer_.shadow(second, 1, Coherence::Incoherent, {&passedThen, 1});
        if (second.isOccluded(0)) continue;
        contribution *= passedThen;
      }
      if (!isValidSample(contribution)) {
        ++faults.count;
        continue;
      }
      PathRadiance& result = results[shadow.result];
      (shadow.specular ? result.specular : shadow.direct ? result.direct : result.indirect) += contribution;
    }
  }
}

}  // namespace lightvane
