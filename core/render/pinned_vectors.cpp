#include "core/render/pinned_vectors.h"

#include <unordered_set>
#include <vector>

namespace lightvane {
namespace {

/// Those of `pinned` in whose places `known` has nothing.
template <class Record>
std::vector<Record> lacking(const RecordSet<Record>* known, const RecordSet<Record>& pinned) {
  std::unordered_set<RandomKey, RandomKeyHash> places;
  for (std::size_t i = 0; i < pinned.size(); ++i) places.insert(placeKey(pinned[i]));
  for (std::size_t i = 0; known != nullptr && !places.empty() && i < known->size(); ++i)
    places.erase(placeKey((*known)[i]));
  std::vector<Record> records;
  for (std::size_t i = 0; i < pinned.size(); ++i) {
    if (places.contains(placeKey(pinned[i]))) records.push_back(pinned[i]);
  }
  return records;
}

}  // namespace

std::shared_ptr<const Snapshot> withPinned(std::shared_ptr<const Snapshot> vectors,
                                           const PinnedVectors* pinned,
                                           const std::shared_ptr<const Scene>& scene,
                                           const VectorParameters& parameters) {
  if (pinned == nullptr || pinned->scene != scene) return vectors;
  auto next = std::make_shared<Snapshot>();
  if (vectors) *next = *vectors;
  next->direct.resize(scene->lights.size());
  const VectorRadii radii(parameters, *scene);
  std::size_t added = 0;
  const auto putBack = [&](auto& set, const auto& kept) {
    auto records = lacking(vectors ? &set : nullptr, kept);
    added += records.size();
    set = set.with(std::move(records), radii);
  };
  if (pinned->indirectStore == parameters.ilv.store) putBack(next->indirect, pinned->vectors.indirect);
  if (pinned->directStore == parameters.dlv.store) {
    for (std::size_t light = 0; light < pinned->vectors.direct.size(); ++light)
      putBack(next->direct[light], pinned->vectors.direct[light]);
  }
  if (added == 0) return vectors;
  ++next->generation;
  return next;
}

}  // namespace lightvane
