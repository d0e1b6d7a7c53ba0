#pragma once

#include <memory>
#include <string>

#include "core/base/load_watch.h"
#include "core/scene/scene.h"
#include "core/trace/clear_space.h"
#include "core/trace/ray.h"

namespace lightvane {

/// Whether the rays of a packet start and go alike: a hint for speed, never for the result.
enum class Coherence { Incoherent, Coherent };

/// A point on a surface as light sees it. Normalised units, world space.
struct SurfacePoint {
  Vec3 position{0.0f};
  Vec3 geometricNormal{0, 0, 1};  ///< unit, on the viewer's side
  Frame frame;                    ///< about the shading normal, on the viewer's side; x follows the tangent
  bool frontSide = true;          ///< the viewer is on the surface's front side
  float curvature = 0.0f;         ///< 1 / radius of a sphere; 0 where it is not known
  float opacity = 1.0f;    ///< the part of the surface that is there; light goes straight through the rest
  Tint tint;               ///< of the material's colours, as its textures have them here
  Rgb emissionTint{1.0f};  ///< what its texture leaves of the emission, in [0, 1]
  float offset = 0.0f;     ///< how far a ray's origin must leave the surface not to meet it again
  std::uint32_t surface = kNone;
  std::uint32_t material = 0;
  std::uint32_t piece = kNone;  ///< of the surface's area light; kNone where it has no part in that

  /// Where a ray that leaves in `direction` starts.
  Vec3 originTowards(const Vec3& direction) const {
    return glm::dot(direction, geometricNormal) >= 0.0f ? position + offset * geometricNormal
                                                        : position - offset * geometricNormal;
  }
};

/// Rays against a Scene. Immutable once made; every method may be called from any thread.
class Tracer {
 public:
  /// Panes and gaps that a ray passes at most: behind more of them, next to nothing is left to be seen.
  static constexpr int kMostPanes = 64;

  /// Builds the acceleration structure, on as many threads as oneTBB is allowed. Throws LoadStopped as
  /// `watch` says, and std::bad_alloc.
  explicit Tracer(std::shared_ptr<const Scene> scene, LoadWatch& watch = LoadWatch::none());
  /// For a scene that differs from the other tracer's in its lights' radiance alone (Scene::relit): shares
  /// the acceleration structure.
  Tracer(std::shared_ptr<const Scene> relit, const Tracer& geometry);
  ~Tracer();
  Tracer(const Tracer&) = delete;
  Tracer& operator=(const Tracer&) = delete;

  const Scene& scene() const { return *scene_; }
  std::shared_ptr<const Scene> sharedScene() const { return scene_; }

  Hit intersect(const Ray& ray) const;
  bool occluded(const Ray& ray) const;

  /// The nearest hits of the first `count` rays of the packet.
  void intersect(HitPacket& packet, int count, Coherence coherence) const;
  /// Sets tFar of the first `count` rays to -infinity where anything stands between tNear and tFar.
  void occluded(ShadowPacket& packet, int count, Coherence coherence) const;

  /// As occluded, but thin panes and gaps in surfaces let light pass: what they leave of it goes to `passed`,
  /// one for each ray. 1 where there is none, and of no meaning where anything else stands in the way.
  void shadow(ShadowPacket& packet, int count, Coherence coherence, std::span<Rgb> passed) const;

  /// The nearest hits of what shadow() takes for opaque, and what stands before them lets pass of light.
  void intersectBehindPanes(HitPacket& packet, int count, Coherence coherence, std::span<Rgb> passed) const;

  /// Where around `centre`, up to `radius` away, points see each other for sure: what keeps out all surfaces
  /// that come so near. `margin` is that of ClearSpace. Cost: some rays', and less than linear in the
  /// surfaces within the radius, because many of them make it shrink.
  ClearSpace clearSpace(const Vec3& centre, float radius, float margin) const;

  /// The surface that `ray` met. The position is put on the primitive itself, not taken along the ray.
  SurfacePoint surfaceAt(const Ray& ray, const Hit& hit) const;

  /// Bytes taken by the acceleration structure.
  std::size_t memoryBytes() const;
  /// "Embree 3.13.5"
  static std::string libraryName();

 private:
  struct Impl;
  /// What the thin panes in the ray's way let pass of light.
  Rgb throughPanes(Ray ray) const;
  /// SurfacePoint::opacity.
  float opacityAt(const OpacityDescription& opacity, const Vec2& uv, const Vec3& position) const;
  /// What the textures leave of the material's colours, and of what it emits, at a point with these texture
  /// coordinates.
  void tint(const MaterialTextures& textures, const Vec2& uv, SurfacePoint& point) const;

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const Impl> impl_;
};

/// The radiance that a surface itself emits towards the viewer it was met from.
inline Rgb emittedRadiance(const Scene& scene, const SurfacePoint& point) {
  const Material& material = scene.materials[point.material];
  if (!point.frontSide && !material.twoSided) return Rgb(0.0f);
  const Rgb emitted = point.emissionTint * material.emission;
  if (scene.lightFactors.empty()) return emitted;
  const std::uint32_t light = scene.surfaces[point.surface].light;
  return light == kNone ? emitted : scene.lightFactors[light] * emitted;
}

}  // namespace lightvane
