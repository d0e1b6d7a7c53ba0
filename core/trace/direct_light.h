#pragma once

#include <vector>

#include "core/trace/radiance.h"

namespace lightvane {

/// A surface point that asks for light, seen along `outgoing` (world, unit, towards the viewer).
struct LitPoint {
  SurfacePoint surface;
  Vec3 outgoing{0, 0, 1};
};

/// What one light gives one point straight. Normalised units, linear colours.
struct DirectLightEstimate {
  Rgb irradiance{0.0f};    ///< on the surface, occlusion included
  Rgb lobeRadiance{0.0f};  ///< that the material's lobe sends towards the viewer; zero without a lobe
  Vec3 directionSum{
      0.0f};  ///< sum of brightness * solid angle * direction over the free samples (section 4.1)
  float directionWeight = 0.0f;  ///< the sum's weights
  float solidAngle = 0.0f;       ///< subtended by the light, sr; 0 for Dirac lights
  int rays = 0;
};

/// Samples lights as seen from visible points, in packets of shadow rays. One a thread.
class DirectLightSampler {
 public:
  DirectLightSampler(const Tracer& tracer, const TransportParameters& parameters);

  /// The exact value, up to the noise of `samples` stratified shadow rays (Dirac lights take as many as they
  /// have points, at most `samples`).
  DirectLightEstimate estimate(const LitPoint& point, std::uint32_t light, int samples, RandomKey key,
                               RayCounts& counts, SampleFaults& faults);

  /// What all planar mirrors' images of area lights give the point: light of the indirect layer that no
  /// gather has to find by chance. Black where TransportParameters::mirroredLights is off.
  DirectLightEstimate estimateMirrored(const LitPoint& point, int samples, RandomKey key, RayCounts& counts,
                                       SampleFaults& faults);

 private:
  struct Candidate {
    Ray ray;
    std::uint32_t second;  ///< of secondRays_: from the mirror to the light; or kNone
    Vec3 direction;
    Rgb weight;
  };
  void resolve(const LitPoint& point, DirectLightEstimate& out, RayCounts& counts, SampleFaults& faults);

  const Tracer& tracer_;
  const Scene& scene_;
  TransportParameters parameters_;
  std::vector<Candidate> candidates_;
  std::vector<Ray> secondRays_;
};

}  // namespace lightvane
