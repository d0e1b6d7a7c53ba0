#pragma once

#include "core/base/tasks.h"
#include "core/trace/light_sight.h"
#include "core/trace/tracer.h"

namespace lightvane {

/// Tries which of a scene's many lights can be seen from what the camera sees, and from what light comes to
/// there by a few bounces. A function of the scene and the camera alone: not of the part of the picture that
/// is rendered, of its seed, or of the threads. Knows nothing where there are not more lights than
/// kMostLightsInFull, for which it would not pay. Cost: at most 140,000 rays.
LightSight learnSight(const Tracer& tracer, const Camera& camera, TaskPool& pool, const StopFlag& stop,
                      RayCounts& counts);

}  // namespace lightvane
