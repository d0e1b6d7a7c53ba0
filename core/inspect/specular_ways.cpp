#include "core/inspect/specular_ways.h"

#include <array>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace lightvane {
namespace {

struct Pending {
  Ray ray;
  Rgb throughput;
  int depth;
  std::string way;
};

std::string eventName(const Scene& scene, const SurfacePoint& point, bool isTransmitted) {
  const std::string& shape = scene.shapeNames[scene.surfaces[point.surface].shape];
  const std::string kind = isTransmitted ? "glass" : "mirror";
  return shape.empty() ? kind : fmt::format("{} ({})", kind, shape);
}

/// Of a surface that reflects nothing.
std::string surfaceName(const Scene& scene, const SurfacePoint& point) {
  const std::string& shape = scene.shapeNames[scene.surfaces[point.surface].shape];
  const std::string kind = maxComponent(emittedRadiance(scene, point)) > 0.0f ? "a light" : "a black surface";
  return shape.empty() ? kind : fmt::format("{} ({})", kind, shape);
}

/// Follows rays through mirrors and glass, one event a call.
class WayTracer {
 public:
  WayTracer(const RenderFrame& frame, int samples)
      : tracer_(*frame.shownTracer),
        scene_(tracer_.scene()),
        parameters_(frame.parameters.transport),
        share_(1.0f / static_cast<float>(samples)) {}

  /// What the rays go on as.
  std::vector<Pending> follow(const std::vector<Pending>& pending) {
    std::vector<Pending> next;
    for (const Pending& at : pending) {
      HitPacket packet;
      packet.rays.set(0, at.ray);
      tracer_.intersect(packet, 1, Coherence::Coherent);
      const Hit hit = packet.hit(0);
      hit.found() ? meet(at, tracer_.surfaceAt(at.ray, hit), next) : leave(at);
    }
    return next;
  }

  PixelWays ways;

 private:
  void endWith(const Pending& at, const std::string& what) {
    if (ways.end.empty()) ways.end = at.depth == 0 ? what : fmt::format("{} by way of {}", what, at.way);
  }

  void leave(const Pending& at) {
    endWith(at, "the background");
    if (at.depth == 0) return;
    for (const Light& light : scene_.lights)
      ways.specularEmission += share_ * at.throughput * radianceFromInfinity(light, at.ray.direction);
  }

  void meet(const Pending& at, const SurfacePoint& point, std::vector<Pending>& next) {
    const Brdf& brdf = scene_.materials[point.material].brdf;
    if (at.depth > 0) ways.specularEmission += share_ * at.throughput * emittedRadiance(scene_, point);
    if (brdf.hasNonSpecular()) {
      ways.points.push_back(
          {at.depth == 0 ? "seen straight" : "by way of " + at.way, point.position, point.surface, at.depth});
    }
    if (!brdf.hasSpecular()) {
      if (!brdf.hasNonSpecular()) endWith(at, surfaceName(scene_, point));
    } else if (at.depth >= parameters_.specularDepth) {
      endWith(at, "a mirror that is not followed (specular.depth)");
    } else {
      branch(at, point, next);
    }
  }

  void branch(const Pending& at, const SurfacePoint& point, std::vector<Pending>& next) const {
    std::array<SpecularBranch, 2> branches;
    const int count = scene_.materials[point.material].brdf.specularBranches(
        point.frame.toLocal(-at.ray.direction), point.frontSide, point.tint, branches);
    for (const SpecularBranch& branch : std::span(branches).first(static_cast<std::size_t>(count))) {
      const Rgb throughput = at.throughput * branch.weight;
      if (!(maxComponent(throughput) > static_cast<float>(parameters_.specularCutoff))) continue;
      const Vec3 direction = glm::normalize(point.frame.toWorld(branch.direction));
      const std::string event = eventName(scene_, point, branch.transmitted);
      next.push_back({{point.originTowards(direction), direction, 0.0f, kInfinity},
                      throughput,
                      at.depth + 1,
                      at.way.empty() ? event : at.way + ", " + event});
    }
  }

  const Tracer& tracer_;
  const Scene& scene_;
  const TransportParameters& parameters_;
  float share_;  ///< of a sample in the pixel
};

}  // namespace

PixelWays tracePixelWays(const RenderFrame& frame, int x, int y) {
  const FlushDenormals flush;
  const int samples = frame.points ? frame.points->samplesOf(frame.film->direct.index(x, y))
                                   : frame.parameters.picture.filmSamples;
  std::vector<Pending> pending;
  for (int s = 0; s < samples; ++s) {
    pending.push_back(
        {cameraRay(frame.camera, frame.region.x + x, frame.region.y + y, s, samples), Rgb(1.0f), 0, {}});
  }
  // Generation by generation, as core/render/visible_points.cpp does, which is what the order of points rests
  // on; a test holds the two to each other.
  WayTracer tracer(frame, samples);
  while (!pending.empty()) pending = tracer.follow(pending);
  return std::move(tracer.ways);
}

}  // namespace lightvane
