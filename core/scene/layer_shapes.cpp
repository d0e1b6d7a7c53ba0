#include "core/scene/layer_shapes.h"

#include "core/scene/direction_table.h"

namespace lightvane {
namespace {

using Nodes = DirectionTable<Rgb>;

// A Lambertian term 1/pi seen along a direction of this cosine: its albedo, and its moments by F and F^2.
LayerMoments lambertMoments(const Vec3& outgoing) {
  constexpr int kPoints = 16;
  LayerMoments sum{};
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      const float step = 1.0f / kPoints;
      const Vec3 incoming =
          sampleCosine({step * (static_cast<float>(i) + 0.5f), step * (static_cast<float>(j) + 0.5f)});
      const double fresnel = schlickFresnel(0.5f * glm::length(incoming + outgoing));
      sum[0] += 1.0;
      sum[1] += fresnel;
      sum[2] += fresnel * fresnel;
    }
  }
  for (double& moment : sum) moment /= kPoints * kPoints;
  return sum;
}

}  // namespace

const Layer& LayerShapes::shape(const LayerDescription& description, bool limitsEnergy) {
  const auto [entry, isNew] = layers_.try_emplace(keyOf(description, limitsEnergy));
  if (!isNew) return entry->second;
  entry->second = Layer(description);
  if (limitsEnergy) entry->second.limitEnergy();
  return entry->second;
}

Layer LayerShapes::layer(const LayerDescription& description, bool limitsEnergy) {
  return shape(description, limitsEnergy).inColor(description.color);
}

const LayerMoments& LayerShapes::meanMoments(const LayerDescription& description) {
  const auto [entry, isNew] = means_.try_emplace(keyOf(description, false));
  if (isNew) entry->second = shape(description, false).meanMoments();
  return entry->second;
}

const std::vector<LayerMoments>& LayerShapes::moments(const LayerDescription& description, bool limitsEnergy,
                                                      int rows) {
  const auto [entry, isNew] = moments_.try_emplace({keyOf(description, limitsEnergy), rows});
  std::vector<LayerMoments>& all = entry->second;
  if (!isNew) return all;
  for (auto cosine = static_cast<int>(lambert_.size()); cosine < Nodes::kCosines; ++cosine)
    lambert_.push_back(lambertMoments(Nodes::nodeDirection(1, 0, cosine)));
  const Layer& layer = shape(description, limitsEnergy);
  for (int row = 0; row < rows; ++row) {
    for (int cosine = 0; cosine < Nodes::kCosines; ++cosine)
      all.push_back(
          layer.moments(Nodes::nodeDirection(rows, row, cosine), lambert_[static_cast<std::size_t>(cosine)]));
  }
  return all;
}

}  // namespace lightvane
