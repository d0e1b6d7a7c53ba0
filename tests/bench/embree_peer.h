#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/trace/ray.h"

namespace lightvane {

// Embree as it is without us: the unit of time that whole pictures are told in, and the peer of core/trace.

/// Seconds of CPU that ten million single incoherent rays take in Embree, in the Cornell box of 30 triangles:
/// a unit of time that follows the machine.
class EmbreeUnit {
 public:
  EmbreeUnit();
  ~EmbreeUnit();

  /// The best of five repetitions of 256,000 rays, scaled. About a tenth of the unit itself.
  double seconds() const;
  /// The 2000 points that the rays leave from, in millimetres; some lie under the blocks.
  const std::vector<Vec3>& floorPoints() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Embree with its default flags on the triangles of a scene, called as its manual does.
class EmbreePeer {
 public:
  /// Rays that one call is given.
  enum class Width { One, Eight, Sixteen };

  /// Meshes only: spheres and discs are core/trace's own.
  explicit EmbreePeer(const Scene& scene);
  ~EmbreePeer();

  /// distances[i] becomes that of the nearest hit of rays[i], or infinity.
  void intersect(std::span<const Ray> rays, std::span<float> distances, Width width, bool coherent) const;
  /// distances[i] becomes negative where anything stands in the way of rays[i].
  void occluded(std::span<const Ray> rays, std::span<float> distances, Width width, bool coherent) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lightvane
