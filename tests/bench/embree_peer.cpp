#include "tests/bench/embree_peer.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define LIGHTVANE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define LIGHTVANE_EMBREE 3
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "core/base/check.h"
#include "tests/bench/measure.h"

// The only file of the benchmarks that includes Embree. 3.13 and 4 differ in how a call takes its options.

namespace lightvane {
namespace {

#if LIGHTVANE_EMBREE == 4
struct Options {
  explicit Options(bool coherent) {
    rtcInitIntersectArguments(&intersect);
    rtcInitOccludedArguments(&occluded);
    intersect.flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    occluded.flags = intersect.flags;
  }
  RTCIntersectArguments intersect;
  RTCOccludedArguments occluded;
};
void intersect1(RTCScene scene, Options& o, RTCRayHit& hit) { rtcIntersect1(scene, &hit, &o.intersect); }
void occluded1(RTCScene scene, Options& o, RTCRay& ray) { rtcOccluded1(scene, &ray, &o.occluded); }
void intersectN(const int* valid, RTCScene scene, Options& o, RTCRayHit8& hits) {
  rtcIntersect8(valid, scene, &hits, &o.intersect);
}
void intersectN(const int* valid, RTCScene scene, Options& o, RTCRayHit16& hits) {
  rtcIntersect16(valid, scene, &hits, &o.intersect);
}
void occludedN(const int* valid, RTCScene scene, Options& o, RTCRay8& rays) {
  rtcOccluded8(valid, scene, &rays, &o.occluded);
}
void occludedN(const int* valid, RTCScene scene, Options& o, RTCRay16& rays) {
  rtcOccluded16(valid, scene, &rays, &o.occluded);
}
#else
struct Options {
  explicit Options(bool coherent) {
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  }
  RTCIntersectContext context;
};
void intersect1(RTCScene scene, Options& o, RTCRayHit& hit) { rtcIntersect1(scene, &o.context, &hit); }
void occluded1(RTCScene scene, Options& o, RTCRay& ray) { rtcOccluded1(scene, &o.context, &ray); }
void intersectN(const int* valid, RTCScene scene, Options& o, RTCRayHit8& hits) {
  rtcIntersect8(valid, scene, &o.context, &hits);
}
void intersectN(const int* valid, RTCScene scene, Options& o, RTCRayHit16& hits) {
  rtcIntersect16(valid, scene, &o.context, &hits);
}
void occludedN(const int* valid, RTCScene scene, Options& o, RTCRay8& rays) {
  rtcOccluded8(valid, scene, &o.context, &rays);
}
void occludedN(const int* valid, RTCScene scene, Options& o, RTCRay16& rays) {
  rtcOccluded16(valid, scene, &o.context, &rays);
}
#endif

/// A device and a committed scene of triangles.
class Triangles {
 public:
  Triangles() : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    // "threads=1" is left out, here as in core/trace: Embree would limit oneTBB to it for the whole process.
    // Only building uses threads.
    LV_CHECK(device_ != nullptr, "Embree gives no device");
  }
  ~Triangles() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Triangles(const Triangles&) = delete;
  Triangles& operator=(const Triangles&) = delete;

  void add(const std::vector<Vec3>& positions, const std::vector<glm::uvec3>& triangles) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                        positions.size()),
                positions.data(), sizeof(Vec3) * positions.size());
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        sizeof(glm::uvec3), triangles.size()),
                triangles.data(), sizeof(glm::uvec3) * triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
  void commit() { rtcCommitScene(scene_); }
  RTCScene scene() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

void setRay(RTCRay& to, const Ray& ray) {
  to = {ray.origin.x,
        ray.origin.y,
        ray.origin.z,
        ray.tNear,
        ray.direction.x,
        ray.direction.y,
        ray.direction.z,
        0.0f,
        ray.tFar,
        ~0U,
        0,
        0};
}

template <class Packet>
void setRay(Packet& to, std::size_t lane, const Ray& ray) {
  to.org_x[lane] = ray.origin.x;
  to.org_y[lane] = ray.origin.y;
  to.org_z[lane] = ray.origin.z;
  to.dir_x[lane] = ray.direction.x;
  to.dir_y[lane] = ray.direction.y;
  to.dir_z[lane] = ray.direction.z;
  to.tnear[lane] = ray.tNear;
  to.tfar[lane] = ray.tFar;
  to.time[lane] = 0.0f;
  to.mask[lane] = ~0U;
  to.id[lane] = 0;
  to.flags[lane] = 0;
}

/// Calls body(begin, lanes, valid) for packets of at most N rays.
template <std::size_t N, class Body>
void forPackets(std::size_t count, const Body& body) {
  alignas(64) int valid[N];
  for (std::size_t begin = 0; begin < count; begin += N) {
    const std::size_t lanes = std::min(N, count - begin);
    for (std::size_t lane = 0; lane < N; ++lane) valid[lane] = lane < lanes ? -1 : 0;
    body(begin, lanes, valid);
  }
}

template <class Packet, std::size_t N>
void intersectPackets(RTCScene scene, Options& options, std::span<const Ray> rays,
                      std::span<float> distances) {
  Packet packet;
  forPackets<N>(rays.size(), [&](std::size_t begin, std::size_t lanes, const int* valid) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      setRay(packet.ray, lane, rays[begin + lane]);
      packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    intersectN(valid, scene, options, packet);
    for (std::size_t lane = 0; lane < lanes; ++lane) distances[begin + lane] = packet.ray.tfar[lane];
  });
}

template <class Packet, std::size_t N>
void occludedPackets(RTCScene scene, Options& options, std::span<const Ray> rays,
                     std::span<float> distances) {
  Packet packet;
  forPackets<N>(rays.size(), [&](std::size_t begin, std::size_t lanes, const int* valid) {
    for (std::size_t lane = 0; lane < lanes; ++lane) setRay(packet, lane, rays[begin + lane]);
    occludedN(valid, scene, options, packet);
    for (std::size_t lane = 0; lane < lanes; ++lane) distances[begin + lane] = packet.tfar[lane];
  });
}

}  // namespace

struct EmbreeUnit::Impl {
  Triangles triangles;
  std::vector<Vec3> floorPoints;
  std::vector<Vec3> origins;
  std::vector<Vec3> directions;
};

// Geometry, rays and the order of the random numbers define the unit: none may change.
EmbreeUnit::EmbreeUnit() : impl_(std::make_unique<Impl>()) {
  std::vector<Vec3> v;
  std::vector<glm::uvec3> f;
  const auto quad = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
    const auto o = static_cast<unsigned>(v.size());
    v.insert(v.end(), {a, b, c, d});
    f.insert(f.end(), {{o, o + 1, o + 2}, {o, o + 2, o + 3}});
  };
  quad({552.8, 0, 0}, {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2});
  quad({556, 548.8, 0}, {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0});
  quad({549.6, 0, 559.2}, {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2});
  quad({0, 0, 559.2}, {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2});
  quad({552.8, 0, 0}, {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0});
  const auto box = [&](Vec3 a, Vec3 b, Vec3 c, Vec3 d, float height) {
    const auto up = [height](Vec3 p) { return Vec3(p.x, height, p.z); };
    quad(up(a), up(b), up(c), up(d));
    quad(a, up(a), up(b), b);
    quad(b, up(b), up(c), c);
    quad(c, up(c), up(d), d);
    quad(d, up(d), up(a), a);
  };
  box({130, 0, 65}, {82, 0, 225}, {240, 0, 272}, {290, 0, 114}, 165);
  box({423, 0, 247}, {265, 0, 296}, {314, 0, 456}, {472, 0, 406}, 330);
  impl_->triangles.add(v, f);
  impl_->triangles.commit();

  // 2000 points of the floor, 8 x 16 cells of equal solid angle above each.
  std::mt19937 generator(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int p = 0; p < 2000; ++p) {
    const float x = 50 + uniform(generator) * 450;
    const float z = 50 + uniform(generator) * 450;
    impl_->floorPoints.emplace_back(x, 0.1f, z);
    for (int m = 0; m < 8; ++m) {
      for (int k = 0; k < 16; ++k) {
        const float c = (static_cast<float>(8 - m) - uniform(generator)) / 8;
        const float s = std::sqrt(std::max(0.0f, 1 - c * c));
        const float t = 6.2831853f * (static_cast<float>(k) + uniform(generator)) / 16;
        impl_->origins.push_back(impl_->floorPoints.back());
        impl_->directions.emplace_back(s * std::cos(t), c, s * std::sin(t));
      }
    }
  }
}

EmbreeUnit::~EmbreeUnit() = default;

const std::vector<Vec3>& EmbreeUnit::floorPoints() const { return impl_->floorPoints; }

double EmbreeUnit::seconds() const {
  const std::vector<Vec3>& o = impl_->origins;
  const std::vector<Vec3>& d = impl_->directions;
  RTCScene scene = impl_->triangles.scene();
  double best = 1e9;
  double sum = 0.0;  // of what was met, so that the compiler keeps it
  for (int repetition = 0; repetition < 5; ++repetition) {
    Options options(false);
    const double start = threadCpuSeconds();
    for (std::size_t i = 0; i < o.size(); ++i) {
      RTCRayHit h;
      setRay(h.ray, {o[i], d[i], 1e-3f, 1e30f});
      h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      intersect1(scene, options, h);
      if (h.ray.tfar < 1e29f) sum += h.ray.tfar;
    }
    best = std::min(best, (threadCpuSeconds() - start) / static_cast<double>(o.size()) * 1e7);
  }
  LV_CHECK(sum > 0.0, "no ray met the Cornell box");
  return best;
}

struct EmbreePeer::Impl {
  Triangles triangles;
};

EmbreePeer::EmbreePeer(const Scene& scene) : impl_(std::make_unique<Impl>()) {
  LV_CHECK(scene.spheres.empty() && scene.discs.empty(), "{} spheres and {} discs", scene.spheres.size(),
           scene.discs.size());
  for (const TriangleMesh& mesh : scene.meshes) impl_->triangles.add(mesh.positions, mesh.triangles);
  impl_->triangles.commit();
}

EmbreePeer::~EmbreePeer() = default;

void EmbreePeer::intersect(std::span<const Ray> rays, std::span<float> distances, Width width,
                           bool coherent) const {
  RTCScene scene = impl_->triangles.scene();
  Options options(coherent);
  switch (width) {
    case Width::One:
      for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRayHit h;
        setRay(h.ray, rays[i]);
        h.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        h.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        intersect1(scene, options, h);
        distances[i] = h.ray.tfar;
      }
      break;
    case Width::Eight:
      intersectPackets<RTCRayHit8, 8>(scene, options, rays, distances);
      break;
    case Width::Sixteen:
      intersectPackets<RTCRayHit16, 16>(scene, options, rays, distances);
      break;
  }
}

void EmbreePeer::occluded(std::span<const Ray> rays, std::span<float> distances, Width width,
                          bool coherent) const {
  RTCScene scene = impl_->triangles.scene();
  Options options(coherent);
  switch (width) {
    case Width::One:
      for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRay r;
        setRay(r, rays[i]);
        occluded1(scene, options, r);
        distances[i] = r.tfar;
      }
      break;
    case Width::Eight:
      occludedPackets<RTCRay8, 8>(scene, options, rays, distances);
      break;
    case Width::Sixteen:
      occludedPackets<RTCRay16, 16>(scene, options, rays, distances);
      break;
  }
}

}  // namespace lightvane
