#include "core/inspect/vector_recomputer.h"

#include "core/inspect/record_report.h"
#include "core/render/direct_vectors.h"

namespace lightvane {
namespace {

/// `anew` in the place of `old` in the growth of the cache.
template <class Record>
Record bornAs(const Record& old, Record anew) {
  const Birth computed = anew.birth;
  anew.birth = old.birth;
  anew.birth.rays = computed.rays;
  anew.birth.identity = computed.identity;
  return anew;
}

}  // namespace

VectorRecomputer::VectorRecomputer(const RenderFrame& frame, const Parameters& parameters,
                                   const StopFlag& stop)
    : frame_(frame),
      parameters_(parameters),
      gatherer_(*frame.indirectTracer, parameters.transport, parameters.vectors),
      sampler_(*frame.tracer, parameters.transport) {
  gatherer_.stopWith(stop);
  gatherer_.knowSight(frame.points->sight.get());
}

std::optional<IndirectLightVector> VectorRecomputer::operator()(const IndirectLightVector& old,
                                                                std::uint64_t seed) {
  const std::optional<VisiblePoint> point = pointOfVector(frame_, old.point, old.birth);
  if (!point) return std::nullopt;
  return bornAs(old, gatherer_.gather({point->lit(*frame_.scene), old.point.footprint}, old.point.key, seed,
                                      rays_, faults_));
}

std::optional<DirectLightVector> VectorRecomputer::operator()(const DirectLightVector& old,
                                                              std::uint32_t light, std::uint64_t seed) {
  const std::optional<VisiblePoint> point = pointOfVector(frame_, old.point, old.birth);
  if (!point) return std::nullopt;
  parameters_.picture.seed = seed;
  return bornAs(old, computeDirectVector(sampler_, *frame_.scene, *point, old.point.key, light, parameters_,
                                         rays_, faults_));
}

Rgb VectorRecomputer::irradianceOf(const DirectLightVector& recomputed, std::uint32_t light) {
  const std::optional<VisiblePoint> point = pointOfVector(frame_, recomputed.point, recomputed.birth);
  if (!point) return Rgb(0.0f);
  return sampler_
      .estimate(point->lit(*frame_.scene), light, parameters_.transport.lightSamples,
                recomputed.birth.identity, rays_, faults_)
      .irradiance;
}

}  // namespace lightvane
