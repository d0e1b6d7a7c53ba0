#pragma once

#include "core/scene/lights.h"

namespace lightvane {

/// "area", "volumic sphere": what kind of light it is, for tables and reports.
const char* lightKind(const Light& light);

/// Rays by which a point samples the light where it may take `samples`: no more than the light has places.
int shadowRaysOf(const Light& light, int samples);

}  // namespace lightvane
