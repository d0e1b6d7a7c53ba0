#include "core/render/learn_sight.h"

#include <array>
#include <cmath>
#include <optional>

#include "core/scene/lights.h"
#include "core/trace/direct_light.h"
#include "core/trace/radiance.h"

namespace lightvane {
namespace {

constexpr std::size_t kWalks = 1024;
constexpr std::size_t kWalksOfATask = 64;
constexpr int kVertices = 4;  ///< of a walk, where light is asked for
constexpr int kSpecularSteps = 16;
/// At a vertex: first of all groups alike, then of what may matter there.
constexpr int kTrials = kShadowPacketWidth;

/// Random numbers of one vertex.
enum Dimension : std::uint32_t { Direction = 0, Choice = 2, Branch = 3, Light = 4 };

/// A place where a walk asks for light.
struct Vertex {
  SurfacePoint point;
  RandomKey key;
};

/// Lights by their groups, those without any left out.
struct GroupedLights {
  explicit GroupedLights(const Scene& scene) {
    std::vector<std::vector<std::uint32_t>> byGroup(LightTree::kGroups);
    for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
      groupOf.push_back(static_cast<std::uint32_t>(scene.lightTree.groupOf(light)));
      byGroup[groupOf.back()].push_back(light);
    }
    for (std::vector<std::uint32_t>& lights : byGroup) {
      if (!lights.empty()) groups.push_back(std::move(lights));
    }
  }
  /// Any group, and any of its lights.
  std::uint32_t any(const Vec2& u) const {
    const auto pick = [](const auto& all, float place) -> const auto& {
      return all[std::min(static_cast<std::size_t>(place * static_cast<float>(all.size())), all.size() - 1)];
    };
    return pick(pick(groups, u.x), u.y);
  }
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> groupOf;  ///< of each light
};

/// Follows lines of sight from the camera as light would come along them, from surface to surface.
class SightWalk {
 public:
  SightWalk(const Tracer& tracer, const Camera& camera) : tracer_(tracer), camera_(camera) {}

  std::vector<Vertex> follow(std::uint32_t number, RayCounts& counts) const {
    const RandomKey key = RandomKey{}.with(0x73696768U).with(number);
    std::vector<Vertex> vertices;
    const Vec2 place(r2Place(number));
    const Sight sight = camera_.sight(place.x * static_cast<float>(camera_.width),
                                      place.y * static_cast<float>(camera_.height));
    Ray ray{sight.origin, sight.direction};
    for (std::uint32_t step = 0; step < kSpecularSteps && vertices.size() < kVertices; ++step) {
      ++(step == 0 ? counts.camera : counts.bounce);
      const Hit hit = tracer_.intersect(ray);
      if (!hit.found()) break;
      const SurfacePoint point = tracer_.surfaceAt(ray, hit);
      const RandomKey here = key.with(step);
      const Brdf& brdf = tracer_.scene().materials[point.material].brdf;
      if (uniform(here, 0, Choice) >= point.opacity) {
        ray = {point.originTowards(ray.direction), ray.direction};
        continue;
      }
      const bool isSpecular =
          brdf.hasSpecular() && (!brdf.hasNonSpecular() || uniform(here, 1, Choice) < 0.5f);
      std::optional<Vec3> next;
      if (isSpecular) {
        next = specularDirection(point, ray.direction, here);
      } else if (brdf.hasNonSpecular()) {
        vertices.push_back({point, here});
        next = point.frame.toWorld(sampleCosine(uniform2(here, 0, Direction)));
      }
      if (!next) break;
      ray = {point.originTowards(*next), *next};
    }
    return vertices;
  }

 private:
  std::optional<Vec3> specularDirection(const SurfacePoint& point, const Vec3& towards, RandomKey key) const {
    std::array<SpecularBranch, 2> branches;
    const int count = tracer_.scene().materials[point.material].brdf.specularBranches(
        point.frame.toLocal(-towards), point.frontSide, point.tint, branches);
    if (count == 0) return std::nullopt;
    const std::size_t chosen = count == 2 && uniform(key, 0, Branch) < 0.5f ? 1 : 0;
    return glm::normalize(point.frame.toWorld(branches[chosen].direction));
  }

  const Tracer& tracer_;
  const Camera& camera_;
};

/// Tries lights from the vertices of a walk.
class SightTrials {
 public:
  SightTrials(const Tracer& tracer, const GroupedLights& lights)
      : tracer_(tracer), scene_(tracer.scene()), lights_(lights) {}

  /// `choose(u)` gives a light for each random place in the unit square, or nothing.
  template <class Choose>
  void at(const Vertex& vertex, std::uint32_t stream, const Choose& choose,
          std::vector<LightSight::Trial>& trials, RayCounts& counts) const {
    const SurfacePoint& point = vertex.point;
    ShadowPacket packet;
    std::array<std::uint32_t, kTrials> groups{};
    int lanes = 0;
    const RandomKey key = vertex.key.with(stream);
    for (std::uint32_t i = 0; i < kTrials; ++i) {
      const std::optional<std::uint32_t> light = choose(uniform2(key, i, Choice));
      if (!light || !(lightImportance(scene_.lights[*light], point.position, point.frame.z) > 0.0f)) continue;
      LightSample sample;
      const LightSampler sampler(scene_.lights[*light], point.position, point.frame.z);
      if (!sampler.sample(uniform2(key, i, Light), sample)) continue;
      if (!(glm::dot(sample.direction, point.geometricNormal) > 0.0f)) continue;
      packet.set(lanes, shadowRay(point, sample.direction, sample.distance));
      groups[static_cast<std::size_t>(lanes++)] = lights_.groupOf[*light];
    }
    std::array<Rgb, kTrials> passed;
    passed.fill(Rgb(1.0f));
    tracer_.shadow(packet, lanes, Coherence::Incoherent, passed);
    counts.shadow += static_cast<std::uint64_t>(lanes);
    for (int lane = 0; lane < lanes; ++lane) {
      const auto n = static_cast<std::size_t>(lane);
      trials.push_back({point.position, groups[n], !packet.isOccluded(lane) && !isBlack(passed[n])});
    }
  }

 private:
  const Tracer& tracer_;
  const Scene& scene_;
  const GroupedLights& lights_;
};

}  // namespace

LightSight learnSight(const Tracer& tracer, const Camera& camera, TaskPool& pool, const StopFlag& stop,
                      RayCounts& counts) {
  const Scene& scene = tracer.scene();
  if (scene.lights.size() <= kMostLightsInFull) return {};
  const GroupedLights grouped(scene);
  constexpr std::size_t kTasks = kWalks / kWalksOfATask;
  struct Task {
    std::vector<Vertex> vertices;
    std::vector<LightSight::Trial> trials;
    RayCounts counts;
  };
  std::vector<Task> tasks(kTasks);
  const SightWalk walk(tracer, camera);
  const SightTrials trying(tracer, grouped);
  const auto collect = [&] {
    std::vector<LightSight::Trial> all;
    for (const Task& task : tasks) all.insert(all.end(), task.trials.begin(), task.trials.end());
    return LightSight(scene.lightTree, all);
  };
  pool.forEach(kTasks, [&](std::size_t t, int) {
    Task& task = tasks[t];
    for (std::size_t w = 0; w < kWalksOfATask && !stop; ++w) {
      for (const Vertex& vertex :
           walk.follow(static_cast<std::uint32_t>(t * kWalksOfATask + w), task.counts)) {
        trying.at(
            vertex, 1, [&](const Vec2& u) { return std::optional(grouped.any(u)); }, task.trials,
            task.counts);
        task.vertices.push_back(vertex);
      }
    }
  });
  const LightSight first = collect();
  pool.forEach(kTasks, [&](std::size_t t, int) {
    Task& task = tasks[t];
    for (const Vertex& vertex : task.vertices) {
      if (stop) return;
      const Vec3& place = vertex.point.position;
      const LightTree::Sight known = first.at(place);
      const auto choose = [&](const Vec2& u) -> std::optional<std::uint32_t> {
        const auto choice = scene.lightTree.choose(scene.lights, place, vertex.point.frame.z, u.x, known);
        return choice ? std::optional(choice->light) : std::nullopt;
      };
      trying.at(vertex, 2, choose, task.trials, task.counts);
    }
  });
  for (const Task& task : tasks) counts += task.counts;
  return collect();
}

}  // namespace lightvane
