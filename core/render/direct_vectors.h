#pragma once

#include "core/render/parameters.h"
#include "core/render/visible_points.h"
#include "core/vectors/records.h"

namespace lightvane {

/// Radiance towards the viewer of light that was sampled at the point itself.
inline Rgb reflectedRadiance(const Brdf& brdf, const Tint& tint, const DirectLightEstimate& e) {
  return brdf.diffuse(tint) * kInvPi * e.irradiance + e.lobeRadiance;
}

/// Radiance towards the viewer of a Direct Light Vector's fields: split, or P f_r,d(D) (eq. 4).
Rgb directRadiance(const Brdf& brdf, const VisiblePoint& point, VectorStore store, const Rgb& energy,
                   const Rgb& lobeRadiance, const Vec3& direction);

/// The full computation of a Direct Light Vector (section 4.1). birth.rays and birth.identity are filled.
DirectLightVector computeDirectVector(DirectLightSampler& sampler, const Scene& scene,
                                      const VisiblePoint& point, SurfaceKey key, std::uint32_t light,
                                      const Parameters& parameters, RayCounts& counts, SampleFaults& faults);

/// What the numbers of a direct vector belong to.
RandomKey directVectorKey(const LitPoint& point, SurfaceKey key, std::uint32_t light, std::uint64_t seed);

}  // namespace lightvane
