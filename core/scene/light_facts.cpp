#include "core/scene/light_facts.h"

#include <algorithm>

#include "core/base/overloaded.h"

namespace lightvane {

const char* lightKind(const Light& light) {
  return std::visit(
      Overloaded{[](const PointLight&) { return "point"; }, [](const SpotLight&) { return "spot"; },
                 [](const DirectionalLight&) { return "directional"; },
                 [](const VolumicSphereLight&) { return "volumic sphere"; },
                 [](const AreaLight&) { return "area"; },
                 [](const EnvironmentLight&) { return "environment"; }},
      light);
}

int shadowRaysOf(const Light& light, int samples) {
  const int distinct = distinctSamples(light);
  return distinct == 0 ? samples : std::min(samples, distinct);
}

}  // namespace lightvane
