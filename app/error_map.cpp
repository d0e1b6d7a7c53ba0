#include "app/error_map.h"

#include <algorithm>

namespace lightvane {

ViewImage viewOfErrorMap(const MetricInfo& metric, const ImageFloat& map) {
  ViewImage view;
  view.kind = ViewKind::Scalar;
  view.width = map.width();
  view.height = map.height();
  view.title = metric.label;
  const bool isFraction = metric.unit == MetricUnit::Fraction;
  view.unit = isFraction ? "%" : "";
  for (const float value : map) view.values.push_back(isFraction ? 100.0f * value : value);
  std::vector<float> sorted = view.values;
  const std::size_t place = sorted.size() - 1 - sorted.size() / 100;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(place), sorted.end());
  view.scale.high = sorted[place] > 0.0f ? sorted[place] : 1.0f;
  return view;
}

}  // namespace lightvane
