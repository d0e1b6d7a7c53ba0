#pragma once

#include <vector>

#include "core/trace/direct_light.h"
#include "core/vectors/parameters.h"
#include "core/vectors/records.h"

namespace lightvane {

/// One cell of a gather: a direction and what came from there.
struct GatherCell {
  Vec3 direction{0.0f};  ///< local to the point's frame
  Rgb radiance{0.0f};
  float distance = kInfinity;
};

/// The sampled hemisphere above a point (paper, Fig. 2): rows in the polar angle, columns around the normal,
/// each cell of the same solid angle 2 pi / (M N). Kept so that the inspector can show it.
struct Hemisphere {
  int rows = 0;
  int columns = 0;
  std::vector<GatherCell> cells;  ///< row by row

  const GatherCell& cell(int row, int column) const {
    return cells[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

/// What a gather point needs beside its surface.
struct GatherPoint {
  LitPoint lit;
  float footprint = 0.0f;  ///< width of a pixel of a picture 256 pixels high, here
};

/// The name of the random numbers of a vector: everything that it is a function of, but for the parameters.
RandomKey vectorKey(const LitPoint& point, SurfaceKey key, std::uint64_t seed);

/// Mean distances of a hemisphere's hits; infinity where nothing was hit.
struct MeanDistances {
  float arithmetic = kInfinity;
  float harmonic = kInfinity;
  float least = kInfinity;
};
MeanDistances meanDistances(const Hemisphere& hemisphere);

/// Irradiance of a hemisphere, eq. 1 and 5: 2 pi / (M N) sum L cos.
Rgb hemisphereIrradiance(const Hemisphere& hemisphere);
/// The average incident direction, section 5.2.2, unit and local; the normal where all is dark.
Vec3 hemisphereDirection(const Hemisphere& hemisphere);

/// Gradients of irradiance, local to the frame: `translation[c]` per unit of length, `rotation[c]` an axis
/// per radian.
struct IrradianceGradient {
  Vec3 translation[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
  Vec3 rotation[3] = {Vec3(0.0f), Vec3(0.0f), Vec3(0.0f)};
};
/// Eq. 6 as printed: only the change of the cosine, in x, y and z.
IrradianceGradient printedGradient(const Hemisphere& hemisphere);
/// Ward & Heckbert 1992 for cells of equal solid angle (cos theta_j- = 1 - j/M): the walls between cells move
/// when the point does. Tangent plane only.
IrradianceGradient stratifiedGradient(const Hemisphere& hemisphere);

/// Computes Indirect Light Vectors in full. One a thread; see RadianceEstimator.
class Gatherer {
 public:
  Gatherer(const Tracer& tracer, const TransportParameters& transport, const VectorParameters& parameters);

  /// See RadianceEstimator::stopWith.
  void stopWith(const StopFlag& stop) { estimator_.stopWith(stop); }
  /// See DirectLightSampler::knowSight.
  void knowSight(const LightSight* sight) { estimator_.knowSight(sight); }

  /// The vector of `key` at a point: irradiance for kLambertKey, lobe or whole BRDF for others. Pure: a
  /// function of the arguments and the parameters. birth.rays is filled, the rest of birth is the caller's.
  IndirectLightVector gather(const GatherPoint& point, SurfaceKey key, std::uint64_t seed, RayCounts& counts,
                             SampleFaults& faults);

  /// The hemisphere of the last gather.
  const Hemisphere& hemisphere() const { return hemisphere_; }

  /// Indirect radiance towards the viewer by a plain gather of `samples` rays (the naive method, and the path
  /// tracer's ground): hemisphere cells for Lambert, BRDF samples for lobes. Mirrored lights are not part of
  /// it.
  Rgb outgoingRadiance(const LitPoint& point, int samples, RandomKey key, RayCounts& counts,
                       SampleFaults& faults);

 private:
  void traceHemisphere(const LitPoint& point, int rows, int columns, RandomKey key, RayCounts& counts,
                       SampleFaults& faults);
  Rgb traceLobe(const LitPoint& point, int samples, RandomKey key, MeanDistances& distances, Vec3& direction,
                RayCounts& counts, SampleFaults& faults);

  const Scene& scene_;
  VectorParameters parameters_;
  RadianceEstimator estimator_;
  Hemisphere hemisphere_;
  std::vector<std::uint32_t> cellOrder_;
  int orderedRows_ = 0;
  int orderedColumns_ = 0;
  std::vector<PathStart> starts_;
  std::vector<PathRadiance> results_;
  std::vector<float> pdfs_;
};

}  // namespace lightvane
