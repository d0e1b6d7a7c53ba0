#include "core/trace/tracer.h"

#include <fmt/format.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define LIGHTVANE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define LIGHTVANE_EMBREE 3
#endif

#include <atomic>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <string>
#include <type_traits>
#include <utility>

#include "core/base/check.h"
#include "core/base/number_text.h"
#include "core/base/tasks.h"
#include "core/scene/brdf.h"

// The only file that includes Embree: 3.13 and 4 differ in how a call takes its options, nothing else.

namespace lightvane {
namespace {

template <class EmbreeRays, class Packet>
constexpr bool kSameLayout =
    sizeof(EmbreeRays) == sizeof(Packet) && offsetof(EmbreeRays, tnear) == offsetof(Packet, tNear) &&
    offsetof(EmbreeRays, dir_x) == offsetof(Packet, directionX) &&
    offsetof(EmbreeRays, tfar) == offsetof(Packet, tFar) &&
    offsetof(EmbreeRays, flags) == offsetof(Packet, flags);
static_assert(kSameLayout<RTCRay8, RayPacketOf<8>> && kSameLayout<RTCRay16, RayPacketOf<16>>);
static_assert(sizeof(RTCRayHit8) <= sizeof(HitPacket));
static_assert(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, Ng_x) == offsetof(HitPacket, normalX));
static_assert(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, u) == offsetof(HitPacket, u));
static_assert(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, primID) == offsetof(HitPacket, primitive));
static_assert(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, geomID) == offsetof(HitPacket, geometry));
static_assert(offsetof(RTCRayHit8, hit) + offsetof(RTCHit8, instID) == offsetof(HitPacket, instance));

// A hit's position carries the rounding of the primitive's coordinates and of Embree's own arithmetic, which
// works relative to the primitive's size. Measured on random triangles and rays (tests/trace), the error
// stays below 2^-21 of the largest coordinate; an offset of 2^-18 leaves a factor of eight.
constexpr float kRelativeOffset = 0x1p-18f;

/// -1 for each of the first lanes, 0 for the others.
template <int Width>
class LaneMask {
 public:
  explicit LaneMask(int count) {
    for (int lane = 0; lane < Width; ++lane) lanes_[lane] = lane < count ? -1 : 0;
  }
  const int* data() const { return lanes_; }

 private:
  alignas(4 * Width) int lanes_[Width];
};

/// The nearest root in (tNear, tFar) of a ray against a sphere, in double: Embree's own spheres lose small
/// far ones.
bool intersectSphere(const SphereShape& sphere, const Ray& ray, float& t) {
  const Vec3d o = Vec3d(ray.origin) - Vec3d(sphere.center);
  const Vec3d d(ray.direction);
  const double a = glm::dot(d, d);
  const double b = glm::dot(o, d);
  // The discriminant from the distance between centre and line: exact where the sphere is small and far.
  const Vec3d nearest = o - (b / a) * d;
  const double radius = sphere.radius;
  const double discriminant = radius * radius - glm::dot(nearest, nearest);
  if (discriminant < 0.0) return false;
  const double root = std::sqrt(discriminant / a);
  for (const double candidate : {-b / a - root, -b / a + root}) {
    const auto rounded = static_cast<float>(candidate);
    if (rounded > ray.tNear && rounded < ray.tFar) {
      t = rounded;
      return true;
    }
  }
  return false;
}

bool intersectDisc(const DiscShape& disc, const Ray& ray, float& t) {
  const Vec3d n(disc.normal);
  const double slope = glm::dot(Vec3d(ray.direction), n);
  if (slope == 0.0) return false;
  const double distance = glm::dot(Vec3d(disc.center) - Vec3d(ray.origin), n) / slope;
  const auto rounded = static_cast<float>(distance);
  if (!(rounded > ray.tNear && rounded < ray.tFar)) return false;
  const Vec3d offset = Vec3d(ray.origin) + distance * Vec3d(ray.direction) - Vec3d(disc.center);
  if (glm::dot(offset, offset) > square(static_cast<double>(disc.radius))) return false;
  t = rounded;
  return true;
}

Ray rayOf(RTCRayN* rays, unsigned int n, unsigned int i) {
  return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          RTCRayN_tnear(rays, n, i),
          RTCRayN_tfar(rays, n, i)};
}

template <class Shape>
bool intersectShape(const Shape& shape, const Ray& ray, float& t) {
  if constexpr (std::is_same_v<Shape, SphereShape>) {
    return intersectSphere(shape, ray, t);
  } else {
    return intersectDisc(shape, ray, t);
  }
}

/// What of a scene an acceleration structure holds. Where there are panes, light asks the two parts apart.
enum class ScenePart { All, WithoutPanes, PanesAlone };

/// The number of the first instance's geometry: those of meshes, spheres and discs come before it.
std::uint32_t firstInstance(const Scene& scene) {
  return static_cast<std::uint32_t>(scene.meshes.size()) + (scene.spheres.empty() ? 0U : 1U) +
         (scene.discs.empty() ? 0U : 1U);
}

/// The instance of a geometry number; null where that is none's.
const MeshInstance* instanceOf(const Scene& scene, std::uint32_t geometry) {
  return geometry == kNone ? nullptr : &scene.instances[geometry - firstInstance(scene)];
}

/// A triangle's corners in normalised units, its front side where they run counter-clockwise.
struct Corners {
  Vec3 a, b, c;
};

Corners cornersOf(const TriangleMesh& mesh, const MeshInstance* instance, const glm::uvec3& numbers) {
  Corners corners{mesh.positions[numbers.x], mesh.positions[numbers.y], mesh.positions[numbers.z]};
  if (instance != nullptr)
    corners = {instance->place(corners.a), instance->place(corners.b), instance->place(corners.c)};
  return corners;
}

bool isOf(ScenePart part, const Scene& scene, std::uint32_t surface) {
  return part == ScenePart::All || scene.materialOf(surface).isPane() == (part == ScenePart::PanesAlone);
}

/// What Embree's callbacks get of a shape list: the shapes, which of them count, and their geometry's number.
template <class Shape>
struct ShapeList {
  const std::vector<Shape>* shapes = nullptr;
  const Scene* scene = nullptr;
  ScenePart part = ScenePart::All;
  unsigned int geometry = 0;
};

template <class Shape>
void boundsCallback(const RTCBoundsFunctionArguments* args) {
  const auto& list = *static_cast<const ShapeList<Shape>*>(args->geometryUserPtr);
  const Shape& shape = (*list.shapes)[args->primID];
  // Padded by what rounding a hit to float can move it.
  const float pad = kRelativeOffset * (std::abs(shape.radius) + maxComponent(glm::abs(shape.center)));
  const Vec3 extent(shape.radius + pad);
  const Vec3 lower = shape.center - extent;
  const Vec3 upper = shape.center + extent;
  *args->bounds_o = {lower.x, lower.y, lower.z, 0.0f, upper.x, upper.y, upper.z, 0.0f};
}

template <class Shape>
void intersectCallback(const RTCIntersectFunctionNArguments* args) {
  const auto& list = *static_cast<const ShapeList<Shape>*>(args->geometryUserPtr);
  const Shape& shape = (*list.shapes)[args->primID];
  if (!isOf(list.part, *list.scene, shape.surface)) return;
  RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, args->N);
  for (unsigned int i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    float t = 0.0f;
    if (!intersectShape(shape, rayOf(rays, args->N, i), t)) continue;
    RTCRayN_tfar(rays, args->N, i) = t;
    RTCHitN_geomID(hits, args->N, i) = list.geometry;
    RTCHitN_primID(hits, args->N, i) = args->primID;
    RTCHitN_u(hits, args->N, i) = 0.0f;
    RTCHitN_v(hits, args->N, i) = 0.0f;
    RTCHitN_instID(hits, args->N, i, 0) = RTC_INVALID_GEOMETRY_ID;
  }
}

template <class Shape>
void occludedCallback(const RTCOccludedFunctionNArguments* args) {
  const auto& list = *static_cast<const ShapeList<Shape>*>(args->geometryUserPtr);
  const Shape& shape = (*list.shapes)[args->primID];
  if (!isOf(list.part, *list.scene, shape.surface)) return;
  for (unsigned int i = 0; i < args->N; ++i) {
    float t = 0.0f;
    if (args->valid[i] != 0 && intersectShape(shape, rayOf(args->ray, args->N, i), t)) {
      RTCRayN_tfar(args->ray, args->N, i) = -kInfinity;
    }
  }
}

#if LIGHTVANE_EMBREE == 4
RTCRayQueryFlags flagsOf(Coherence coherence) {
  return coherence == Coherence::Coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
}
#else
RTCIntersectContext contextOf(Coherence coherence) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherence == Coherence::Coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                   : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}
#endif

void findNearest(RTCScene scene, HitPacket& packet, int count, Coherence coherence) {
  for (int lane = 0; lane < count; ++lane) {
    packet.geometry[lane] = RTC_INVALID_GEOMETRY_ID;
    packet.instance[lane] = RTC_INVALID_GEOMETRY_ID;
  }
  auto* rays = reinterpret_cast<RTCRayHit8*>(&packet);
#if LIGHTVANE_EMBREE == 4
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = flagsOf(coherence);
  rtcIntersect8(LaneMask<kPacketWidth>(count).data(), scene, rays, &arguments);
#else
  RTCIntersectContext context = contextOf(coherence);
  rtcIntersect8(LaneMask<kPacketWidth>(count).data(), scene, &context, rays);
#endif
}

void markOccluded(RTCScene scene, ShadowPacket& packet, int count, Coherence coherence) {
  auto* rays = reinterpret_cast<RTCRay16*>(&packet);
#if LIGHTVANE_EMBREE == 4
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = flagsOf(coherence);
  rtcOccluded16(LaneMask<kShadowPacketWidth>(count).data(), scene, rays, &arguments);
#else
  RTCIntersectContext context = contextOf(coherence);
  rtcOccluded16(LaneMask<kShadowPacketWidth>(count).data(), scene, &context, rays);
#endif
}

/// What the callback of a point query gets.
struct ClearSpaceQuery {
  const Scene& scene;
  ClearSpace space;
};

bool keepOutCallback(RTCPointQueryFunctionArguments* args) {
  auto& [scene, space] = *static_cast<ClearSpaceQuery*>(args->userPtr);
  const std::size_t meshes = scene.meshes.size();
  const MeshInstance* instance =
      args->context->instStackSize > 0 ? instanceOf(scene, args->context->instID[0]) : nullptr;
  if (instance != nullptr || args->geomID < meshes) {
    const TriangleMesh& mesh =
        instance != nullptr ? scene.sharedMeshes[instance->mesh] : scene.meshes[args->geomID];
    const Corners corners = cornersOf(mesh, instance, mesh.triangles[args->primID]);
    space.keepOut(corners.a, corners.b, corners.c);
  } else if (args->geomID == meshes && !scene.spheres.empty()) {
    space.keepOut(scene.spheres[args->primID]);
  } else {
    space.keepOut(scene.discs[args->primID]);
  }
  const bool hasShrunk = space.radius() < args->query->radius;
  args->query->radius = space.radius();
  return hasShrunk;
}

/// The first fault that Embree reports. Its callbacks are called in its frames, and in those of its tasks,
/// where nothing must be thrown: they leave here what is thrown in ours.
class EmbreeFault {
 public:
  static void report(void* self, RTCError code, const char* text) {
    // What the watch has stopped is reported, too.
    if (code == RTC_ERROR_CANCELLED) return;
    auto& fault = *static_cast<EmbreeFault*>(self);
    const std::lock_guard lock(fault.mutex_);
    if (fault.code_.load() != RTC_ERROR_NONE) return;
    fault.text_ = text == nullptr ? "" : text;
    fault.code_ = code;
  }

  /// Throws what was reported since the last time.
  void check() {
    if (code_.load(std::memory_order_relaxed) == RTC_ERROR_NONE) return;
    const std::lock_guard lock(mutex_);
    const RTCError code = code_.exchange(RTC_ERROR_NONE);
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (code != RTC_ERROR_NONE)
      throw InvariantViolation(fmt::format("Embree reports error {}: {}", static_cast<int>(code), text_));
  }

 private:
  std::mutex mutex_;
  std::atomic<RTCError> code_ = RTC_ERROR_NONE;
  std::string text_;
};

/// Tells a watch how far Embree is with a tree; any of its threads.
struct BuildProgress {
  LoadWatch& watch;
  std::mutex telling;

  /// False ends the building.
  static bool report(void* self, double fraction) {
    auto& progress = *static_cast<BuildProgress*>(self);
    if (progress.watch.isStopped()) return false;
    const std::lock_guard lock(progress.telling);
    progress.watch.tellFraction(fraction);
    return true;
  }
};

/// Copies into a buffer of Embree's, some megabytes between two looks.
template <class T>
void copyWatched(const std::vector<T>& from, void* to, LoadWatch& watch) {
  constexpr std::size_t kPerLook = std::size_t{1} << 18;
  for (std::size_t i = 0; i < from.size(); i += kPerLook) {
    watch.look();
    std::memcpy(static_cast<T*>(to) + i, from.data() + i, std::min(kPerLook, from.size() - i) * sizeof(T));
  }
}

struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
using OwnedScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;
using OwnedGeometry = std::unique_ptr<std::remove_pointer_t<RTCGeometry>, GeometryRelease>;

/// One of Embree's scenes, with the numbers that hits have for Tracer::surfaceAt: the meshes', the spheres',
/// the discs'.
class AcceleratedPart {
 public:
  /// What building it is of the stage that the watch is told.
  struct Share {
    double from = 0.0, to = 1.0;
  };

  AcceleratedPart(RTCDevice device, const Scene& scene, ScenePart part, Share share, EmbreeFault& fault,
                  LoadWatch& watch)
      : device_(device),
        owner_(scene),
        part_(part),
        share_(share),
        fault_(fault),
        watch_(watch),
        scene_(rtcNewScene(device)) {
    fault_.check();
    prepare(this->scene());
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
      addMesh(this->scene(), scene.meshes[i], 0, static_cast<unsigned int>(i));
    auto next = static_cast<unsigned int>(scene.meshes.size());
    if (!scene.spheres.empty()) addShapes(scene.spheres, spheres_, next++);
    if (!scene.discs.empty()) addShapes(scene.discs, discs_, next);
    shared_.resize(scene.sharedMeshes.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) addInstance(i);
    build(this->scene());
  }
  AcceleratedPart(const AcceleratedPart&) = delete;
  AcceleratedPart& operator=(const AcceleratedPart&) = delete;

  RTCScene scene() const { return scene_.get(); }

  void intersect(HitPacket& packet, int count, Coherence coherence) const {
    findNearest(scene(), packet, count, usable(coherence));
  }
  void occluded(ShadowPacket& packet, int count, Coherence coherence) const {
    markOccluded(scene(), packet, count, usable(coherence));
  }

 private:
  /// What Embree may be told of a packet. Among instances, Embree 3.13 does not always come back from one
  /// that it takes for coherent.
  Coherence usable(Coherence coherence) const {
    return owner_.instances.empty() ? coherence : Coherence::Incoherent;
  }

  /// Of a scene of Embree's, of which this is the whole or what instances share.
  static void prepare(RTCScene scene) {
    // Robust: rays through shared edges meet one of the two triangles. Medium quality: high is not
    // deterministic.
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  }

  /// One of the shared meshes' trees, or the last one.
  void build(RTCScene scene) {
    const double each = (share_.to - share_.from) / static_cast<double>(shared_.size() + 1);
    const double from = share_.from + each * static_cast<double>(built_++);
    watch_.part(from, from + each);
    BuildProgress progress{watch_, {}};
    rtcSetSceneProgressMonitorFunction(scene, BuildProgress::report, &progress);
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    watch_.look();
    fault_.check();
  }

  /// `firstSurface` is what the mesh's surfaces count from.
  void addMesh(RTCScene scene, const TriangleMesh& mesh, std::uint32_t firstSurface,
               unsigned int number) const {
    const OwnedGeometry owned(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE));
    RTCGeometry geometry = owned.get();
    // Copied, because Embree reads vertices in steps of 16 bytes and may look beyond the last one.
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
    auto* indices = static_cast<unsigned int*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
    fault_.check();
    LV_CHECK(positions != nullptr && indices != nullptr, "no memory for {} triangles", mesh.triangles.size());
    copyWatched(mesh.positions, positions, watch_);
    copyWatched(mesh.triangles, indices, watch_);
    // A triangle of another part becomes a point, so that the others keep their numbers.
    for (std::size_t t = 0; part_ != ScenePart::All && t < mesh.triangles.size(); ++t) {
      watch_.piece(t);
      if (!isOf(part_, owner_, firstSurface + mesh.surfaces[t]))
        indices[3 * t + 1] = indices[3 * t + 2] = indices[3 * t];
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, number);
  }

  void addInstance(std::size_t index) {
    const MeshInstance& instance = owner_.instances[index];
    OwnedScene& mesh = shared_[instance.mesh];
    if (!mesh) {
      mesh.reset(rtcNewScene(device_));
      fault_.check();
      prepare(mesh.get());
      // All its instances let light pass at the same triangles: SharedMeshes sees to it.
      addMesh(mesh.get(), owner_.sharedMeshes[instance.mesh], instance.firstSurface, 0);
      build(mesh.get());
    }
    watch_.piece(index);
    const OwnedGeometry owned(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE));
    RTCGeometry geometry = owned.get();
    rtcSetGeometryInstancedScene(geometry, mesh.get());
    const glm::mat3& m = instance.linear;
    const Vec3& offset = instance.offset;
    const std::array<float, 12> toWorld = {m[0].x, m[0].y, m[0].z, m[1].x,   m[1].y,   m[1].z,
                                           m[2].x, m[2].y, m[2].z, offset.x, offset.y, offset.z};
    rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, toWorld.data());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene(), geometry, firstInstance(owner_) + static_cast<unsigned int>(index));
  }

  template <class Shape>
  void addShapes(const std::vector<Shape>& shapes, ShapeList<Shape>& list, unsigned int number) {
    const OwnedGeometry owned(rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER));
    RTCGeometry geometry = owned.get();
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned int>(shapes.size()));
    rtcSetGeometryUserData(geometry, &list);
    rtcSetGeometryBoundsFunction(geometry, boundsCallback<Shape>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersectCallback<Shape>);
    rtcSetGeometryOccludedFunction(geometry, occludedCallback<Shape>);
    list = {&shapes, &owner_, part_, number};
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene(), geometry, number);
  }

  RTCDevice device_;
  const Scene& owner_;  ///< whose spheres and discs are looked at
  ScenePart part_;
  Share share_;
  EmbreeFault& fault_;
  LoadWatch& watch_;                ///< of the constructor alone
  std::size_t built_ = 0;           ///< trees
  std::vector<OwnedScene> shared_;  ///< for each of the scene's shared meshes; outlive what places them
  OwnedScene scene_;
  ShapeList<SphereShape> spheres_;
  ShapeList<DiscShape> discs_;
};

}  // namespace

struct Tracer::Impl {
  RTCDevice device = nullptr;
  mutable EmbreeFault fault;
  std::atomic<std::ptrdiff_t> bytes = 0;
  std::shared_ptr<const Scene> owner;
  std::unique_ptr<const AcceleratedPart> all;
  std::unique_ptr<const AcceleratedPart> withoutPanes, panes;  ///< null where there are no panes

  ~Impl() {
    for (auto* part : {&all, &withoutPanes, &panes}) part->reset();
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

Tracer::Tracer(std::shared_ptr<const Scene> scene, LoadWatch& watch) : scene_(std::move(scene)) {
  const std::string triangles = shortCount(static_cast<double>(scene_->triangleCount()));
  const LoadStage stage(watch, fmt::format("building the tree of {} triangles", triangles));
  // Embree builds trees on all threads at once: two scenes are ready as soon one after the other, and what
  // its libraries share among builds is then seen to be in order by the thread sanitizer, too.
  static std::mutex building;
  const std::lock_guard lock(building);
  const auto impl = std::make_shared<Impl>();
  impl->owner = scene_;
  // A thread count limits oneTBB for the whole process: none is given where our own loops run on it.
  impl->device = rtcNewDevice(kLibrariesMayUseThreads ? nullptr : "threads=1");
  LV_CHECK(impl->device != nullptr, "Embree gives no device (error {})",
           static_cast<int>(rtcGetDeviceError(nullptr)));
  rtcSetDeviceErrorFunction(impl->device, EmbreeFault::report, &impl->fault);
  rtcSetDeviceMemoryMonitorFunction(
      impl->device,
      [](void* user, std::ptrdiff_t bytes, bool) {
        static_cast<Impl*>(user)->bytes += bytes;
        return true;
      },
      impl.get());
  const auto accelerate = [&](ScenePart part, AcceleratedPart::Share share) {
    return std::make_unique<const AcceleratedPart>(impl->device, *scene_, part, share, impl->fault, watch);
  };
  if (!scene_->needs.panes) {
    impl->all = accelerate(ScenePart::All, {0.0, 1.0});
  } else {
    impl->all = accelerate(ScenePart::All, {0.0, 0.4});
    impl->withoutPanes = accelerate(ScenePart::WithoutPanes, {0.4, 0.8});
    impl->panes = accelerate(ScenePart::PanesAlone, {0.8, 1.0});
  }
  impl_ = impl;
}

Tracer::Tracer(std::shared_ptr<const Scene> relit, const Tracer& geometry)
    : scene_(std::move(relit)), impl_(geometry.impl_) {}

Tracer::~Tracer() = default;

ClearSpace Tracer::clearSpace(const Vec3& centre, float radius, float margin) const {
  ClearSpaceQuery asked{*scene_, ClearSpace(centre, radius, margin)};
  RTCPointQuery query{centre.x, centre.y, centre.z, 0.0f, radius};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(impl_->all->scene(), &query, &context, keepOutCallback, &asked);
  impl_->fault.check();
  return asked.space;
}

Hit Tracer::intersect(const Ray& ray) const {
  HitPacket packet;
  packet.rays.set(0, ray);
  intersect(packet, 1, Coherence::Incoherent);
  return packet.hit(0);
}

bool Tracer::occluded(const Ray& ray) const {
  ShadowPacket packet;
  packet.set(0, ray);
  occluded(packet, 1, Coherence::Incoherent);
  return packet.isOccluded(0);
}

void Tracer::intersect(HitPacket& packet, int count, Coherence coherence) const {
  impl_->all->intersect(packet, count, coherence);
}

void Tracer::occluded(ShadowPacket& packet, int count, Coherence coherence) const {
  impl_->all->occluded(packet, count, coherence);
}

void Tracer::shadow(ShadowPacket& packet, int count, Coherence coherence, std::span<Rgb> passed) const {
  std::fill_n(passed.begin(), count, Rgb(1.0f));
  if (!impl_->panes) return occluded(packet, count, coherence);
  const ShadowPacket asked = packet;
  impl_->withoutPanes->occluded(packet, count, coherence);
  for (int lane = 0; lane < count; ++lane) {
    if (!packet.isOccluded(lane)) passed[static_cast<std::size_t>(lane)] = throughPanes(asked.ray(lane));
  }
}

void Tracer::intersectBehindPanes(HitPacket& packet, int count, Coherence coherence,
                                  std::span<Rgb> passed) const {
  std::fill_n(passed.begin(), count, Rgb(1.0f));
  if (!impl_->panes) return intersect(packet, count, coherence);
  impl_->withoutPanes->intersect(packet, count, coherence);
  // The packet's rays end at what they met.
  for (int lane = 0; lane < count; ++lane)
    passed[static_cast<std::size_t>(lane)] = throughPanes(packet.rays.ray(lane));
}

Rgb Tracer::throughPanes(Ray ray) const {
  Rgb passed(1.0f);
  for (int i = 0; i < kMostPanes; ++i) {
    HitPacket packet;
    packet.rays.set(0, ray);
    impl_->panes->intersect(packet, 1, Coherence::Incoherent);
    const Hit hit = packet.hit(0);
    if (!hit.found()) return passed;
    const SurfacePoint point = surfaceAt(ray, hit);
    const Brdf& brdf = scene_->materials[point.material].brdf;
    Rgb transmitted(0.0f);
    if (brdf.isThin() && point.opacity > 0.0f) {
      std::array<SpecularBranch, 2> branches;
      const int count =
          brdf.specularBranches(point.frame.toLocal(-ray.direction), point.frontSide, point.tint, branches);
      for (const SpecularBranch& branch : std::span(branches).first(static_cast<std::size_t>(count))) {
        if (branch.transmitted) transmitted = point.opacity * branch.weight;
      }
    }
    transmitted += Rgb(1.0f - point.opacity);
    passed *= transmitted;
    if (isBlack(passed)) return passed;
    ray.origin = point.originTowards(ray.direction);
    ray.tNear = 0.0f;
    ray.tFar -= hit.t;
    if (!(ray.tFar > 0.0f)) return passed;
  }
  return Rgb(0.0f);
}

void Tracer::tint(const MaterialTextures& textures, const Vec2& uv, SurfacePoint& point) const {
  const auto fill = [&](const std::optional<TextureUse>& use, Rgb& color) {
    if (use) color = scene_->textureColor(*use, point.position, uv);
  };
  fill(textures.diffuse, point.tint.diffuse);
  fill(textures.mirror, point.tint.mirror);
  fill(textures.transmission, point.tint.transmission);
  for (std::size_t i = 0; i < textures.layers.size(); ++i) fill(textures.layers[i], point.tint.layers[i]);
  fill(textures.emission, point.emissionTint);
}

float Tracer::opacityAt(const OpacityDescription& opacity, const Vec2& uv, const Vec3& position) const {
  auto value = static_cast<float>(opacity.value);
  if (opacity.texture) {
    const Rgb color = scene_->textureColor(*opacity.texture, position, uv);
    value *= (color.r + color.g + color.b) / 3.0f;
  }
  if (opacity.cutoff > 0.0) return value >= static_cast<float>(opacity.cutoff) ? 1.0f : 0.0f;
  return std::clamp(value, 0.0f, 1.0f);
}

namespace {

/// What a hit says beside the point on the surface.
struct MetSurface {
  Vec2 uv{0.0f};
  Vec3 shadingNormal;
  Vec3 tangent{0.0f};
  float extent = 0.0f;  ///< the largest coordinate that the hit's arithmetic went through
  Rgb ofMesh{1.0f};     ///< what the mesh's own colours multiply the material's by
};

float largestCoordinate(const Vec3& v) {
  return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}

/// What the corners of a triangle have, where it was hit.
template <class T>
T interpolated(const std::vector<T>& values, const glm::uvec3& corners, const Hit& hit) {
  const float w = 1.0f - hit.u - hit.v;
  return w * values[corners.x] + hit.u * values[corners.y] + hit.v * values[corners.z];
}

/// A triangle of the mesh, whose corners `place` puts where they are seen.
template <class Place>
void meetTriangle(const TriangleMesh& mesh, const Place& place, const Hit& hit, SurfacePoint& point,
                  MetSurface& met) {
  const glm::uvec3& corners = mesh.triangles[hit.primitive];
  const Vec3& a = place(mesh.positions[corners.x]);
  const Vec3& b = place(mesh.positions[corners.y]);
  const Vec3& c = place(mesh.positions[corners.z]);
  const float w = 1.0f - hit.u - hit.v;
  point.position = w * a + hit.u * b + hit.v * c;
  // In double: slivers and triangles of 2^-20 diagonals square to nothing in float.
  point.geometricNormal = Vec3(glm::normalize(glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
  point.surface = mesh.surfaces[hit.primitive];
  point.piece = mesh.pieces[hit.primitive];
  met.extent = std::max(largestCoordinate(a), std::max(largestCoordinate(b), largestCoordinate(c)));
  if (!mesh.uvs.empty()) {
    met.uv = interpolated(mesh.uvs, corners, hit);
    const Vec2 du = mesh.uvs[corners.y] - mesh.uvs[corners.x];
    const Vec2 dv = mesh.uvs[corners.z] - mesh.uvs[corners.x];
    met.tangent = (b - a) * dv.y - (c - a) * du.y;
    if (du.x * dv.y - du.y * dv.x < 0.0f) met.tangent = -met.tangent;
  }
  if (!mesh.colors.empty()) met.ofMesh = interpolated(mesh.colors, corners, hit);
}

/// The shading normal of a mesh, from a normal of any length, or the face's own.
Vec3 smoothNormal(const Vec3& n, const Vec3& faceNormal) {
  const float lengthSquared = glm::dot(n, n);
  // A vertex normal on the other side of the face is an error of the file: the face's own is used.
  const bool isOfUse = lengthSquared > 0.0f && glm::dot(n, faceNormal) > 0.0f;
  return isOfUse ? n / std::sqrt(lengthSquared) : faceNormal;
}

void meetMesh(const TriangleMesh& mesh, const Hit& hit, SurfacePoint& point, MetSurface& met) {
  const glm::uvec3& corners = mesh.triangles[hit.primitive];
  meetTriangle(
      mesh, [](const Vec3& p) -> const Vec3& { return p; }, hit, point, met);
  met.shadingNormal = point.geometricNormal;
  if (!mesh.normals.empty())
    met.shadingNormal = smoothNormal(interpolated(mesh.normals, corners, hit), point.geometricNormal);
}

void meetInstance(const TriangleMesh& mesh, const MeshInstance& instance, const Hit& hit, SurfacePoint& point,
                  MetSurface& met) {
  const glm::uvec3& corners = mesh.triangles[hit.primitive];
  meetTriangle(
      mesh, [&](const Vec3& p) { return instance.place(p); }, hit, point, met);
  point.surface += instance.firstSurface;
  met.extent = instance.reach;
  if (instance.mirrors) point.geometricNormal = -point.geometricNormal;
  met.shadingNormal = point.geometricNormal;
  if (!mesh.normals.empty())
    met.shadingNormal =
        smoothNormal(instance.ofNormals * interpolated(mesh.normals, corners, hit), point.geometricNormal);
}

void meetSphere(const SphereShape& sphere, const Ray& ray, const Hit& hit, bool hasTextures,
                SurfacePoint& point, MetSurface& met) {
  const Vec3d fromCentre =
      Vec3d(ray.origin) + static_cast<double>(hit.t) * Vec3d(ray.direction) - Vec3d(sphere.center);
  // To a ray in float, a far and tiny sphere is its centre.
  const Vec3d normal =
      fromCentre == Vec3d(0.0) ? -glm::normalize(Vec3d(ray.direction)) : glm::normalize(fromCentre);
  point.geometricNormal = Vec3(normal);
  point.position = Vec3(Vec3d(sphere.center) + static_cast<double>(sphere.radius) * normal);
  point.surface = sphere.surface;
  point.piece = sphere.piece;
  point.curvature = 1.0f / sphere.radius;
  met.shadingNormal = point.geometricNormal;
  met.extent = largestCoordinate(sphere.center) + sphere.radius;
  if (hasTextures) met.uv = sphereUv(point.geometricNormal);
}

void meetDisc(const DiscShape& disc, const Ray& ray, const Hit& hit, bool hasTextures, SurfacePoint& point,
              MetSurface& met) {
  const Vec3d n(disc.normal);
  const Vec3d along = Vec3d(ray.origin) + static_cast<double>(hit.t) * Vec3d(ray.direction);
  point.position = Vec3(along - glm::dot(along - Vec3d(disc.center), n) * n);
  point.geometricNormal = disc.normal;
  point.surface = disc.surface;
  point.piece = disc.piece;
  met.shadingNormal = point.geometricNormal;
  met.extent = largestCoordinate(disc.center) + disc.radius;
  if (hasTextures) met.uv = discUv(disc.center, disc.normal, disc.radius, point.position);
}

}  // namespace

SurfacePoint Tracer::surfaceAt(const Ray& ray, const Hit& hit) const {
  SurfacePoint point;
  MetSurface met;
  auto& [uv, shadingNormal, tangent, extent, ofMesh] = met;
  const bool hasTextures = scene_->needs.textures;
  if (const MeshInstance* instance = instanceOf(*scene_, hit.instance)) {
    meetInstance(scene_->sharedMeshes[instance->mesh], *instance, hit, point, met);
  } else if (hit.geometry < scene_->meshes.size()) {
    meetMesh(scene_->meshes[hit.geometry], hit, point, met);
  } else if (!scene_->spheres.empty() && hit.geometry == scene_->meshes.size()) {
    meetSphere(scene_->spheres[hit.primitive], ray, hit, hasTextures, point, met);
  } else {
    meetDisc(scene_->discs[hit.primitive], ray, hit, hasTextures, point, met);
  }
  point.offset = kRelativeOffset * extent;
  point.material = scene_->surfaces[point.surface].material;
  point.frontSide = glm::dot(ray.direction, point.geometricNormal) < 0.0f;
  if (!point.frontSide) {
    point.geometricNormal = -point.geometricNormal;
    shadingNormal = -shadingNormal;
  }
  // A smooth normal that faces away from the viewer has no meaning for a BRDF.
  if (glm::dot(ray.direction, shadingNormal) >= 0.0f) shadingNormal = point.geometricNormal;
  const Material& material = scene_->materials[point.material];
  if (material.textures.any()) tint(material.textures, uv, point);
  if (ofMesh != Rgb(1.0f)) {
    for (Rgb* color : {&point.tint.diffuse, &point.tint.mirror, &point.tint.transmission}) *color *= ofMesh;
  }
  if (!material.opacity.isFull()) point.opacity = opacityAt(material.opacity, uv, point.position);
  if (scene_->needs.anisotropy && material.hasTangent) tangent = material.tangent;
  point.frame =
      tangent == Vec3(0.0f) ? Frame::aboutNormal(shadingNormal) : Frame::aboutNormal(shadingNormal, tangent);
  return point;
}

std::size_t Tracer::memoryBytes() const {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, impl_->bytes));
}

std::string Tracer::libraryName() { return fmt::format("Embree {}", RTC_VERSION_STRING); }

}  // namespace lightvane
