#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "core/scene/layer.h"

namespace lightvane {

/// What layers of one model, roughness and isotropy have in common, whatever their colours: the tables that
/// take 1 ms and more to compute. Materials that are compiled one after the other share one of these, so that
/// thousands that differ in colours cost as much as one. Not for several threads.
class LayerShapes {
 public:
  /// The layer in its colour; `limitsEnergy`: see Layer::limitEnergy.
  Layer layer(const LayerDescription& description, bool limitsEnergy);
  /// Layer::meanMoments of a Ggx layer.
  const LayerMoments& meanMoments(const LayerDescription& description);
  /// Layer::moments at all nodes of a DirectionTable of so many rows, one row after the other.
  const std::vector<LayerMoments>& moments(const LayerDescription& description, bool limitsEnergy, int rows);

 private:
  using Key = std::tuple<LayerModel, double, double, bool>;
  static Key keyOf(const LayerDescription& description, bool limitsEnergy) {
    return {description.model, description.roughness, description.isotropy, limitsEnergy};
  }
  const Layer& shape(const LayerDescription& description, bool limitsEnergy);

  std::map<Key, Layer> layers_;
  std::map<Key, LayerMoments> means_;
  std::map<std::tuple<Key, int>, std::vector<LayerMoments>> moments_;
  std::vector<LayerMoments> lambert_;  ///< of 1/pi, by cosine; empty until it is asked for
};

}  // namespace lightvane
