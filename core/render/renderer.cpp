#include "core/render/renderer.h"

#include <algorithm>

#include "core/render/path_renderer.h"
#include "core/render/plain_renderer.h"
#include "core/render/printed_renderer.h"
#include "core/render/vector_renderer.h"
#include "core/render/vectors_of_lights.h"
#include "core/scene/light_facts.h"
#include "core/trace/direct_light.h"

namespace lightvane {
namespace {

// With fewer shadow rays, sampling a light costs less than looking up its vectors and making them. With more,
// samples leave less noise than interpolation has errors of its own, which no sample takes away. Measured in
// powers of 2: docs/trade.md, "Whether auto chooses right for each light".
constexpr int kFewestRaysForVectors = 64;
constexpr int kMostRaysForVectors = 128;

// Lights without vectors whose radiance at every point is kept for each.
constexpr auto kMostLightsApart = static_cast<std::ptrdiff_t>(kMostLightsInFull);

}  // namespace

bool autoKeepsVectors(int shadowRays) {
  return shadowRays >= kFewestRaysForVectors && shadowRays <= kMostRaysForVectors;
}

bool isBeyondVectors(int shadowRays) { return shadowRays > kMostRaysForVectors; }

std::vector<bool> lightsWithVectors(const Scene& scene, const Parameters& parameters) {
  std::vector<bool> result;
  for (const Light& light : scene.lights) {
    const DlvMode mode = parameters.vectors.dlv.mode;
    result.push_back(
        mode == DlvMode::Always ||
        (mode == DlvMode::Auto && autoKeepsVectors(shadowRaysOf(light, parameters.transport.lightSamples))));
  }
  return result;
}

bool keepsLightsApart(const Scene& scene, const Parameters& parameters) {
  const std::vector<bool> hasVectors = lightsWithVectors(scene, parameters);
  const auto without = static_cast<std::size_t>(std::count(hasVectors.begin(), hasVectors.end(), false));
  return without <= kMostLightsApart && hasVectors.size() - without <= kMostLightsInFull;
}

std::shared_ptr<const Tracer> relitTracer(const std::shared_ptr<const Tracer>& tracer,
                                          std::span<const Rgb> factors) {
  return factors.empty() ? tracer : std::make_shared<const Tracer>(tracer->scene().relit(factors), *tracer);
}

std::unique_ptr<Renderer> makeRenderer(const RenderContext& asked, const CacheInput& cache) {
  RenderContext context = asked;
  const bool keepsLights = context.parameters.picture.method == Method::Vectors &&
                           context.parameters.vectors.rules != Rules::Printed;
  if (!keepsLights) {
    context.tracer = relitTracer(context.tracer, context.lights.direct);
    context.scene = context.tracer->sharedScene();
  }
  switch (context.parameters.picture.method) {
    case Method::Path:
      return std::make_unique<PathRenderer>(context);
    case Method::Naive:
    case Method::Direct:
      return std::make_unique<PlainRenderer>(context);
    case Method::Vectors:
      break;
  }
  if (context.parameters.vectors.rules == Rules::Printed) return std::make_unique<PrintedRenderer>(context);
  return std::make_unique<VectorRenderer>(context, cache);
}

}  // namespace lightvane
