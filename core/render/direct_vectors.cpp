#include "core/render/direct_vectors.h"

#include "core/vectors/gather.h"

namespace lightvane {

Rgb directRadiance(const Brdf& brdf, const VisiblePoint& point, VectorStore store, const Rgb& energy,
                   const Rgb& lobeRadiance, const Vec3& direction) {
  const Tint& tint = point.tint();
  const bool isSplit = store == VectorStore::Split;
  const Rgb lambert = brdf.diffuse(tint) * kInvPi * energy;
  if (isSplit && !brdf.changesLobe(tint)) return lambert + lobeRadiance;
  const Frame frame = point.frame();
  if (isSplit) {
    return lambert +
           lobeRadiance * brdf.lobeShare(frame.toLocal(direction), frame.toLocal(point.outgoing), tint);
  }
  return energy * brdf.evaluate(frame.toLocal(direction), frame.toLocal(point.outgoing), tint);
}

RandomKey directVectorKey(const LitPoint& point, SurfaceKey key, std::uint32_t light, std::uint64_t seed) {
  return vectorKey(point, key, seed).with(light).with(point.outgoing);
}

DirectLightVector computeDirectVector(DirectLightSampler& sampler, const Scene& scene,
                                      const VisiblePoint& point, SurfaceKey key, std::uint32_t light,
                                      const Parameters& parameters, RayCounts& counts, SampleFaults& faults) {
  LitPoint lit = point.lit(scene);
  // Vectors are free of textures: who asks them has their own.
  lit.surface.tint = Tint();
  const RandomKey identity = directVectorKey(lit, key, light, parameters.picture.seed);
  const DirectLightEstimate e =
      sampler.estimate(lit, light, parameters.transport.lightSamples, identity, counts, faults);
  const DlvParameters& dlv = parameters.vectors.dlv;
  DirectLightVector record;
  record.point = {point.position, point.normal, point.tangent, point.outgoing, key, point.footprint};
  record.solidAngle = e.solidAngle;
  record.occluded = !(e.directionWeight > 0.0f);
  if (!record.occluded) {
    record.direction = e.directionSum / e.directionWeight;
    const float length = glm::length(record.direction);
    if (dlv.normaliseDirection && length > 0.0f) record.direction /= length;
  }
  if (dlv.store == VectorStore::Split) {
    record.energy = e.irradiance;
    record.lobeRadiance = e.lobeRadiance;
  } else {
    const Brdf& brdf = scene.materialOf(point.surface).brdf;
    const Rgb radiance = reflectedRadiance(brdf, Tint(), e);
    const Frame& frame = lit.surface.frame;
    const Rgb f = brdf.evaluate(frame.toLocal(record.direction), frame.toLocal(point.outgoing));
    for (int c = 0; c < 3; ++c) record.energy[c] = f[c] > 0.0f ? radiance[c] / f[c] : 0.0f;
  }
  record.birth.rays = static_cast<std::uint32_t>(e.rays);
  record.birth.identity = identity;
  return record;
}

}  // namespace lightvane
