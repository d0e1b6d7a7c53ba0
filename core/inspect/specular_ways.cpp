#include "core/inspect/specular_ways.h"

#include <array>

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

}  // namespace

PixelWays tracePixelWays(const RenderFrame& frame, int x, int y) {
  const FlushDenormals flush;
  const Tracer& tracer = *frame.shownTracer;
  const Scene& scene = tracer.scene();
  const int samples = frame.parameters.picture.filmSamples;
  PixelWays ways;
  std::vector<Pending> pending;
  for (int s = 0; s < samples; ++s) {
    pending.push_back({cameraRay(frame.camera, frame.region.x + x, frame.region.y + y, s, samples),
                       Rgb(1.0f / static_cast<float>(samples)),
                       0,
                       {}});
  }
  // Generation by generation, as core/render/visible_points.cpp does, which is what the order of points rests
  // on; a test holds the two to each other.
  std::vector<Pending> next;
  for (; !pending.empty(); std::swap(pending, next)) {
    next.clear();
    for (const Pending& at : pending) {
      HitPacket packet;
      packet.rays.set(0, at.ray);
      tracer.intersect(packet, 1, Coherence::Coherent);
      const Hit hit = packet.hit(0);
      const auto endWith = [&](const std::string& what) {
        if (ways.end.empty()) ways.end = at.depth == 0 ? what : fmt::format("{} by way of {}", what, at.way);
      };
      if (!hit.found()) {
        endWith("the background");
        if (at.depth == 0) continue;
        for (const Light& light : scene.lights)
          ways.specularEmission += at.throughput * radianceFromInfinity(light, at.ray.direction);
        continue;
      }
      const SurfacePoint point = tracer.surfaceAt(at.ray, hit);
      const Brdf& brdf = scene.materials[point.material].brdf;
      if (at.depth > 0) ways.specularEmission += at.throughput * emittedRadiance(scene, point);
      if (brdf.hasNonSpecular()) {
        ways.points.push_back({at.depth == 0 ? "seen straight" : "by way of " + at.way, point.position,
                               point.surface, at.depth});
      }
      if (!brdf.hasSpecular()) {
        if (!brdf.hasNonSpecular()) endWith(surfaceName(scene, point));
        continue;
      }
      if (at.depth >= frame.parameters.transport.specularDepth) {
        endWith("a mirror that is not followed (specular.depth)");
        continue;
      }
      std::array<SpecularBranch, 2> branches;
      const int count =
          brdf.specularBranches(point.frame.toLocal(-at.ray.direction), point.frontSide, branches);
      for (int i = 0; i < count; ++i) {
        const SpecularBranch& branch = branches[static_cast<std::size_t>(i)];
        const Rgb throughput = at.throughput * branch.weight;
        if (!(static_cast<float>(samples) * maxComponent(throughput) >
              static_cast<float>(frame.parameters.transport.specularCutoff))) {
          continue;
        }
        const Vec3 direction = glm::normalize(point.frame.toWorld(branch.direction));
        const std::string event = eventName(scene, point, branch.transmitted);
        next.push_back({{point.originTowards(direction), direction, 0.0f, kInfinity},
                        throughput,
                        at.depth + 1,
                        at.way.empty() ? event : at.way + ", " + event});
      }
    }
  }
  return ways;
}

}  // namespace lightvane
