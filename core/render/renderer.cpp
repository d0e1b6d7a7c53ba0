#include "core/render/renderer.h"

#include <algorithm>

#include "core/render/path_renderer.h"
#include "core/render/plain_renderer.h"
#include "core/render/printed_renderer.h"
#include "core/render/vector_renderer.h"
#include "core/trace/direct_light.h"

namespace lightvane {
namespace {

// Below this many shadow rays a light is answered exactly: keeping its vectors would save less than a tenth
// of a picture's time, for twice the error (docs/method.md).
constexpr int kShadowRaysOfALookup = 64;

// Lights without vectors whose radiance at every point is kept for each.
constexpr auto kMostLightsApart = static_cast<std::ptrdiff_t>(kMostLightsInFull);

}  // namespace

std::vector<bool> lightsWithVectors(const Scene& scene, const Parameters& parameters) {
  std::vector<bool> result;
  for (const Light& light : scene.lights) {
    const int distinct = distinctSamples(light);
    const int samples = parameters.transport.lightSamples;
    const int rays = distinct == 0 ? samples : std::min(samples, distinct);
    const DlvMode mode = parameters.vectors.dlv.mode;
    result.push_back(mode == DlvMode::Always || (mode == DlvMode::Auto && rays > kShadowRaysOfALookup));
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
