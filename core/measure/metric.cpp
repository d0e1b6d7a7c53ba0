#include "core/measure/metric.h"

#include <algorithm>
#include <array>

namespace lightvane {

// A line a metric. Each is a function `MetricInfo name()` in a file of its own.
#define LV_METRICS(X) \
  X(biasMetric)       \
  X(mraeMetric)       \
  X(rmseMetric)       \
  X(relMseMetric)     \
  X(relativeMetric)   \
  X(worstTileMetric)  \
  X(psnrMetric)       \
  X(ssimMetric)       \
  X(flipMetric)       \
  X(hdrFlipMetric)

#define LV_DECLARE(function) MetricInfo function();
LV_METRICS(LV_DECLARE)
#undef LV_DECLARE

std::span<const MetricInfo> metrics() {
#define LV_CALL(function) function(),
  static const std::array all{LV_METRICS(LV_CALL)};
#undef LV_CALL
  return all;
}
#undef LV_METRICS

std::vector<const MetricInfo*> allMetrics() {
  std::vector<const MetricInfo*> all;
  for (const MetricInfo& metric : metrics()) all.push_back(&metric);
  return all;
}

const MetricInfo* findMetric(std::string_view name) {
  const std::span<const MetricInfo> all = metrics();
  const auto found = std::ranges::find(all, name, &MetricInfo::name);
  return found != all.end() ? &*found : nullptr;
}

}  // namespace lightvane
