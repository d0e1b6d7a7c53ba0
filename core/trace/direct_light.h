#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/trace/light_sight.h"
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
  /// Subtended by the light, sr; 0 for Dirac lights. Of one of more than LightSampler::kMaxPieces, as far as
  /// the samples know it.
  float solidAngle = 0.0f;
  int rays = 0;
};

/// Of more lights than these, rays are shared out by what the lights may give a point.
inline constexpr std::size_t kMostLightsInFull = 16;

/// What each of many lights may give a point, as a part of what all may: by importance, and by what can be
/// seen of them thereabouts. Lights of which several together may give less than kFaint are taken together.
class LightShares {
 public:
  static constexpr float kFaint = 0.01f;

  /// `normal` is the shading normal, unit. Without a `sight`, nothing hides a light. Cost: see LightTree.
  void weigh(const Scene& scene, const Vec3& position, const Vec3& normal, const LightSight* sight,
             float least = kFaint);

  /// Lights with `least` or more, each by itself, and groups of those with less. Their weights add up to 1 or
  /// less, or there are none.
  std::span<const LightTree::Part> parts() const { return parts_; }
  /// Whether one of the parts is this light, and worth them.
  bool areWorthVectorsOf(std::uint32_t light) const;
  /// Whether a part is one light that is worth vectors here.
  static bool isWorthVectors(const LightTree::Part& part) {
    return part.kind == LightTree::Part::OfLight && part.weight >= kFaint;
  }

 private:
  std::vector<LightTree::Part> parts_;
};

/// Samples lights as seen from visible points, in packets of shadow rays. One a thread.
class DirectLightSampler {
 public:
  DirectLightSampler(const Tracer& tracer, const TransportParameters& parameters);

  /// The exact value, up to the noise of `samples` stratified shadow rays (Dirac lights take as many as they
  /// have points, at most `samples`). Where a lobe is narrower than the light, as many rays follow that, and
  /// both kinds share what it reflects by their densities (Veach & Guibas 1995, balance heuristic); the
  /// irradiance and the direction are of the former alone.
  DirectLightEstimate estimate(const LitPoint& point, std::uint32_t light, int samples, RandomKey key,
                               RayCounts& counts, SampleFaults& faults);

  /// Of many lights, which can be seen from where; none knows of walls. It must outlive the sampler's use.
  void knowSight(const LightSight* sight) { sight_ = sight; }

  /// More lights than kMostLightsInFull have as many rays between them as so many lights in full.
  static constexpr float kLightsWorthOfRays = 8.0f;
  /// What the lights, in the order of their numbers, give together. Up to kMostLightsInFull each has
  /// `samples`, as in estimate(). Of more than those, all the scene's lights have as many rays between them
  /// as kLightsWorthOfRays would: in proportion to what they may give where that makes a ray or more, and the
  /// faint rest by lot. No mean is changed by it. Only irradiance, lobeRadiance and rays are told.
  DirectLightEstimate estimateTogether(const LitPoint& point, std::span<const std::uint32_t> lights,
                                       int samples, RandomKey key, RayCounts& counts, SampleFaults& faults);

  /// As estimateTogether, of those of the lights that are not worth vectors at the point. `shares` is what
  /// its weighing said.
  DirectLightEstimate estimateFaint(const LitPoint& point, std::span<const std::uint32_t> lights,
                                    const LightShares& shares, int samples, RandomKey key, RayCounts& counts,
                                    SampleFaults& faults);

  /// What all planar mirrors' images of area lights give the point: light of the indirect layer that no
  /// gather has to find by chance. Black where TransportParameters::mirroredLights is off.
  DirectLightEstimate estimateMirrored(const LitPoint& point, int samples, RandomKey key, RayCounts& counts,
                                       SampleFaults& faults);
  /// The same, where only the mirrored lights `near` can be seen from the point (mirroredLightsNear).
  DirectLightEstimate estimateMirrored(const LitPoint& point, std::span<const std::uint32_t> near,
                                       int samples, RandomKey key, RayCounts& counts, SampleFaults& faults);
  /// Whether any mirrored light is sampled.
  bool samplesMirrored() const {
    return parameters_.samplesMirroredLights() && !scene_.mirroredLights.empty();
  }

 private:
  static constexpr int kBatch = LightSampleBatch::kCount;
  static_assert(kBatch == kShadowPacketWidth);

  enum class Legs : std::uint8_t { Straight, ByMirror };

  /// Samples that reach the point unless something stands between: the first `count` of each array.
  struct Candidates {
    int count = 0;
    ShadowPacket rays;
    alignas(64) float directionX[kBatch], directionY[kBatch], directionZ[kBatch];  ///< of the samples
    alignas(64) float distance[kBatch];
    float pdf[kBatch];  ///< of the light's samples
    Rgb weight[kBatch];
    Rgb passed[kBatch];       ///< what thin panes leave of it
    ShadowPacket secondLegs;  ///< by way of a mirror: from there to the light
  };

  bool samplesByLobe(const Brdf& brdf, const Light& light, float solidAngle) const;
  /// Chooses the batch's places in the unit square, of the samples from number `begin` on.
  void place(const Strata& strata, int begin, bool centred, RandomKey key);
  /// The samples that leave on the point's own side, with their rays: what shadowRay() says, to the bit.
  void aim(const LitPoint& point);
  /// Of those the ones that pass the mirror, with both their legs: what mirrorPath() says, rounding apart.
  void aimByMirror(const LitPoint& point, const MirroredLight& mirrored);
  /// Moves a candidate to a place that is free.
  void keep(int from, int to);
  void traceSecondLegs(RayCounts& counts, DirectLightEstimate& out);
  /// Of how many samples the estimate of one light is made.
  struct SampleNumbers {
    int ofLight = 0;
    int ofLobe = 0;
  };
  /// Traces the candidates and adds what arrives.
  void resolve(const LitPoint& point, Legs legs, SampleNumbers numbers, DirectLightEstimate& out,
               RayCounts& counts, SampleFaults& faults);
  /// Rays along a lobe, and what of one light they meet.
  struct LobeRays {
    int count = 0;
    std::array<Ray, kPacketWidth> rays;
    std::array<Vec3, kPacketWidth> incoming;  ///< their directions in the point's frame
    std::array<float, kPacketWidth> lobePdf, lightPdf;
    std::array<Rgb, kPacketWidth> radiance;
  };
  void meetLight(std::uint32_t light, const LightSampler& sampler, LobeRays& rays) const;
  void leaveScene(std::uint32_t light, const SurfacePoint& from, LobeRays& rays) const;
  /// Follows the lobe's own directions to the light, in packets.
  void addLobeSamples(const LitPoint& point, std::uint32_t light, const LightSampler& sampler,
                      SampleNumbers numbers, RandomKey key, DirectLightEstimate& out, RayCounts& counts,
                      SampleFaults& faults);

  /// Gives those parts that are asked for, and of them those of the lights, rays of their share of all.
  template <class IsAsked>
  DirectLightEstimate estimateParts(const LitPoint& point, std::span<const std::uint32_t> lights,
                                    const LightShares& shares, int samples, const IsAsked& isAsked,
                                    RandomKey key, RayCounts& counts, SampleFaults& faults);

  const Tracer& tracer_;
  const Scene& scene_;
  TransportParameters parameters_;
  LightSampleBatch samples_;
  Candidates candidates_;
  const LightSight* sight_ = nullptr;
  LightShares shares_;                      ///< of the lights that are estimated together
  std::vector<std::uint32_t> allMirrored_;  ///< numbers of all mirrored lights
};

}  // namespace lightvane
