#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/random.h"
#include "core/base/tasks.h"
#include "core/trace/light_sight.h"
#include "core/trace/parameters.h"
#include "core/trace/tracer.h"

namespace lightvane {

/// Samples that were not finite or negative: left out, and counted.
struct SampleFaults {
  std::uint64_t count = 0;
  SampleFaults& operator+=(const SampleFaults& other) {
    count += other.count;
    return *this;
  }
};

/// Where a path begins.
enum class PathOrigin : std::uint8_t {
  Eye,     ///< a camera ray
  Surface  ///< a ray that left a surface non-specularly: lights it meets straight are that surface's direct
           ///< light
};

/// A path to be followed: its first ray, what its random numbers belong to, and its number among those of
/// that key.
struct PathStart {
  Ray ray;
  RandomKey key;
  std::uint32_t sample = 0;
};

/// The radiance that arrives along a path's first ray, split by layers (docs/architecture.md). For paths that
/// begin on a surface, `direct` is light met straight, `indirect` all the rest; emission and specular stay
/// black.
struct PathRadiance {
  Rgb emission{0.0f};
  Rgb direct{0.0f};
  Rgb indirect{0.0f};
  Rgb specular{0.0f};
  float distance = kInfinity;  ///< to the first hit

  Rgb total() const { return emission + direct + indirect + specular; }
};

/// How the estimator treats light that other stages may have counted.
struct EstimatorOptions {
  PathOrigin origin = PathOrigin::Surface;
  /// Light by way of one planar mirror is sampled as the image of the light (Scene::mirroredLights) at every
  /// vertex, and at a path's origin surface it is left to the caller.
  bool mirroredLights = true;
  /// Light met straight from the origin surface is added to `direct` (with weight 1); else it is left out.
  bool straightLight = false;
};

/// Follows many paths at once, bounce by bounce, in packets of rays: the one place where radiance along a ray
/// is estimated, for gathers, the rivals of the paper, and the reference. Next-event estimation and BRDF
/// sampling are combined by the balance heuristic (Veach 1997); Russian roulette goes by albedo. Unbiased
/// where no limit is set.
///
/// A result depends on its own path's start and on the batch it is given in (through ties in Embree's
/// packets), never on threads. One estimator a thread; it keeps its memory between calls.
class RadianceEstimator {
 public:
  RadianceEstimator(const Tracer& tracer, const TransportParameters& parameters,
                    const EstimatorOptions& options);

  /// Estimates that are under way when the flag is set end soon, with results that are not to be used. The
  /// flag must outlive them.
  void stopWith(const StopFlag& stop) { stop_ = &stop; }

  /// See DirectLightSampler::knowSight.
  void knowSight(const LightSight* sight) { sight_ = sight; }

  /// Estimates results[i] for starts[i]. The first rays count as `firstRays`.
  void estimate(std::span<const PathStart> starts, std::span<PathRadiance> results, Coherence first,
                std::uint64_t& firstRays, RayCounts& counts, SampleFaults& faults);

 private:
  struct Path {
    Ray ray;
    Rgb throughput;
    RandomKey key;
    std::uint32_t sample;
    std::uint32_t result;
    float pdf;          ///< of the last non-specular event's direction; 0 where light met next counts in full
    Vec3 vertex;        ///< the last non-specular vertex
    Vec3 vertexNormal;  ///< its shading normal
    std::uint16_t bounces;      ///< non-specular events
    std::uint16_t specularRun;  ///< specular events since the last non-specular one, or since the eye
    bool reachedSpecularly;     ///< the first non-specular vertex was reached by way of specular events
    std::uint32_t mirror;       ///< planar mirror of the only specular event since `vertex`, or kNone
    bool mirrorFront;
    std::uint16_t panes = 0;   ///< thin ones passed since `vertex`
    float beforePanes = 0.0f;  ///< the way from there to the last of them, where it is a straight one
  };
  /// A vertex of a path where light is sampled.
  struct LitVertex {
    const Path* path;  ///< of paths_
    SurfacePoint point;
    const Brdf* brdf;
    Vec3 outgoing;  ///< local
    RandomKey key;
  };
  struct ShadowRay {
    Ray ray;
    std::uint32_t second;  ///< of secondRays_: from the mirror to the light; or kNone
    std::uint32_t result;
    Rgb contribution;
    bool direct;  ///< belongs to PathRadiance::direct, else as the path's layer says
    bool specular;
  };

  void traceBounce(Coherence coherence, std::uint64_t& rays);
  void shade(const Path& path, const Hit& hit, std::span<PathRadiance> results, SampleFaults& faults);
  void addEmission(const Path& path, const SurfacePoint& point, float distance,
                   std::span<PathRadiance> results, SampleFaults& faults);
  void addInfinite(const Path& path, std::span<PathRadiance> results, SampleFaults& faults);
  /// At all of litVertices_, which it empties.
  void sampleLights();
  void sampleLight(std::size_t light);
  void sampleOneOfManyLights(const LitVertex& at);
  /// What a sample of the light, which is sampled here with `probability`, adds to the path if nothing stands
  /// between.
  void useLightSample(const LitVertex& at, const LightSample& light, float probability);
  static std::uint32_t lightDimension(std::size_t light, int sample, int samples);
  void sampleMirroredLight(const LitVertex& at);
  /// What the path carries of light that arrives from `direction` with `weight` (radiance over density).
  static Rgb reflected(const LitVertex& at, const Vec3& direction, const Rgb& weight);
  void addShadowRay(const LitVertex& at, const Ray& ray, std::uint32_t second, const Rgb& contribution);
  /// The surface lies `distance` along the path's ray.
  void continueSpecularly(const Path& path, const SurfacePoint& point, const Vec3& outgoing, float distance,
                          RandomKey key);
  /// As if the surface were not there.
  void continueStraight(const Path& path, const SurfacePoint& point, float distance);
  void continueDiffusely(const Path& path, const SurfacePoint& point, const Vec3& outgoing, RandomKey key);
  void traceShadows(std::span<PathRadiance> results, RayCounts& counts, SampleFaults& faults);
  /// Of the random numbers at the path's next vertex.
  static RandomKey keyOf(const Path& path);
  static void add(PathRadiance& result, const Path& path, const Rgb& value, bool meetsLight,
                  SampleFaults& faults);
  /// The balance heuristic's share of a light that a BRDF sample met, where light sampling has
  /// `lightDensity`.
  float brdfWeight(const Path& path, std::uint32_t light, float lightDensity) const;
  /// Nothing that a vertex beyond this one reflects is to be followed.
  bool isLastVertex(const Path& path) const;
  bool isMirrored(std::uint32_t light, std::uint32_t mirror, bool front) const;
  /// Asked for every so many paths: a wave of a large gather takes longer than a stop may.
  bool isStopped(std::size_t path) const;

  const Tracer& tracer_;
  const Scene& scene_;
  TransportParameters parameters_;
  EstimatorOptions options_;
  const LightSight* sight_ = nullptr;
  std::vector<Path> paths_;
  std::vector<Path> nextPaths_;
  std::vector<Hit> hits_;
  std::vector<LitVertex> litVertices_;  ///< that wait for their light, at most a batch; empty between bounces
  std::vector<ShadowRay> shadows_;
  std::vector<Ray> secondRays_;
  std::vector<const MirroredLight*> mayBeSeen_;  ///< from one vertex
  const StopFlag* stop_ = nullptr;
};

/// Shadow rays stop this part of their length before the light, so that they do not meet it.
inline constexpr float kShadowEnd = 1.0f - 0x1p-12f;

/// The ray that must be free for a light sample to reach a surface point. It starts off the surface and ends
/// short of the light, and aims at the sample from there: its direction is `direction` but for that.
Ray shadowRay(const SurfacePoint& point, const Vec3& direction, float distance);

/// The part of a light that its mirror reflects, by colour, to where it is seen under `cosine` with the
/// normal.
Rgb mirrorReflectance(const Scene& scene, const MirroredLight& mirrored, float cosine);

/// The way from a point to a mirrored light's sample: where it meets the mirror, and what the mirror leaves
/// of it.
struct MirrorPath {
  Ray toMirror;
  Ray toLight;
  Rgb weight{0.0f};
};
/// False where the direct line to the sample of the image does not pass the mirror's outline.
bool mirrorPath(const Scene& scene, const MirroredLight& mirrored, const SurfacePoint& point,
                const Vec3& direction, float distance, MirrorPath& path);

/// Whether the mirrored light may be seen from `position`: it is on the right side of the mirror, and no
/// plane through it and an edge of the mirror parts the image from the outline. Cheap, conservative.
bool maySeeMirroredLight(const Scene& scene, const MirroredLight& mirrored, const Vec3& position);

}  // namespace lightvane
