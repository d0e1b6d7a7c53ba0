#pragma once

#include <cstdint>

#include "core/base/math.h"

namespace lightvane {

/// A ray in normalised units; `direction` is a unit vector.
struct Ray {
  Vec3 origin{0.0f};
  Vec3 direction{0.0f, 0.0f, 1.0f};
  float tNear = 0.0f;
  float tFar = kInfinity;
};

/// What a ray met. Geometries are numbered meshes first, then the spheres (one geometry), then the discs
/// (one), then instances; a triangle of an instance has its mesh's only geometry, 0.
struct Hit {
  float t = kInfinity;
  std::uint32_t geometry = 0xffffffffU;
  std::uint32_t instance = 0xffffffffU;
  std::uint32_t primitive = 0;
  float u = 0.0f, v = 0.0f;  ///< barycentric, of triangles

  bool found() const { return geometry != 0xffffffffU; }
};

/// Rays and what they meet, laid out as Embree wants them, so that nothing is copied on the way.
/// Lanes at and beyond the number of rays given to the Tracer are not looked at.
template <int Width>
struct alignas(4 * Width) RayPacketOf {
  float originX[Width], originY[Width], originZ[Width];
  float tNear[Width];
  float directionX[Width], directionY[Width], directionZ[Width];
  float time[Width];
  float tFar[Width];  ///< in: the farthest distance; out: the hit's, or -infinity where occluded() says so
  std::uint32_t mask[Width], id[Width], flags[Width];

  void set(int lane, const Ray& ray) {
    originX[lane] = ray.origin.x;
    originY[lane] = ray.origin.y;
    originZ[lane] = ray.origin.z;
    directionX[lane] = ray.direction.x;
    directionY[lane] = ray.direction.y;
    directionZ[lane] = ray.direction.z;
    tNear[lane] = ray.tNear;
    tFar[lane] = ray.tFar;
    time[lane] = 0.0f;
    mask[lane] = 0xffffffffU;
    id[lane] = 0;
    flags[lane] = 0;
  }
  Ray ray(int lane) const {
    return {{originX[lane], originY[lane], originZ[lane]},
            {directionX[lane], directionY[lane], directionZ[lane]},
            tNear[lane],
            tFar[lane]};
  }
  bool isOccluded(int lane) const { return tFar[lane] < 0.0f; }
};

// Measured (tests/bench): Embree answers shadow rays fastest by sixteen, nearest hits by eight.
inline constexpr int kPacketWidth = 8;
inline constexpr int kShadowPacketWidth = 16;
using ShadowPacket = RayPacketOf<kShadowPacketWidth>;

struct alignas(32) HitPacket {
  RayPacketOf<kPacketWidth> rays;
  float normalX[kPacketWidth], normalY[kPacketWidth], normalZ[kPacketWidth];
  float u[kPacketWidth], v[kPacketWidth];
  std::uint32_t primitive[kPacketWidth], geometry[kPacketWidth];
  std::uint32_t instance[2 * kPacketWidth];  ///< Embree 4.3 keeps a second word

  Hit hit(int lane) const {
    Hit h;
    if (geometry[lane] == 0xffffffffU) return h;
    h.t = rays.tFar[lane];
    h.geometry = geometry[lane];
    h.instance = instance[lane];
    h.primitive = primitive[lane];
    h.u = u[lane];
    h.v = v[lane];
    return h;
  }
};

/// Rays counted by what they are for. Counts, not clocks, decide and explain costs.
struct RayCounts {
  std::uint64_t camera = 0;      ///< from the eye, through mirrors and glass
  std::uint64_t gather = 0;      ///< first rays of hemisphere gathers
  std::uint64_t bounce = 0;      ///< later rays of gathers and paths
  std::uint64_t shadow = 0;      ///< towards lights
  std::uint64_t visibility = 0;  ///< towards records

  std::uint64_t total() const { return camera + gather + bounce + shadow + visibility; }
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera;
    gather += other.gather;
    bounce += other.bounce;
    shadow += other.shadow;
    visibility += other.visibility;
    return *this;
  }
};

}  // namespace lightvane
