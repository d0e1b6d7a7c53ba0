#pragma once

#include "core/image/image.h"
#include "core/inspect/view_image.h"
#include "core/measure/metric.h"

namespace lightvane {

/// A metric's map as a view, fractions in per cent, from 0 to the value that a hundredth of the pixels
/// exceeds: the worst would leave the rest dark.
ViewImage viewOfErrorMap(const MetricInfo& metric, const ImageFloat& map);

}  // namespace lightvane
