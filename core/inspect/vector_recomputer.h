#pragma once

#include <optional>

#include "core/render/render_frame.h"
#include "core/vectors/gather.h"

namespace lightvane {

/// Computes vectors of a frame again, each at its own point. Refers to the frame and the flag. One a thread.
class VectorRecomputer {
 public:
  /// `parameters`: the frame's, or such as sample more.
  VectorRecomputer(const RenderFrame& frame, const Parameters& parameters, const StopFlag& stop);

  /// With the random numbers of that seed; nothing where no surface is beneath the vector. Of Birth only cost
  /// and identity are new. Of no use when stopped meanwhile.
  std::optional<IndirectLightVector> operator()(const IndirectLightVector& old, std::uint64_t seed);
  std::optional<DirectLightVector> operator()(const DirectLightVector& old, std::uint32_t light,
                                              std::uint64_t seed);
  /// The irradiance of a light in the same samples: a vector of the whole BRDF does not keep it.
  Rgb irradianceOf(const DirectLightVector& recomputed, std::uint32_t light);

  const RayCounts& rays() const { return rays_; }

 private:
  const RenderFrame& frame_;
  Parameters parameters_;
  Gatherer gatherer_;
  DirectLightSampler sampler_;
  RayCounts rays_;
  SampleFaults faults_;
};

}  // namespace lightvane
