#include "core/inspect/record_edit.h"

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_set>

#include "core/inspect/record_names.h"
#include "core/inspect/record_report.h"
#include "core/inspect/vector_recomputer.h"
#include "core/vectors/validity.h"

namespace lightvane {
namespace {

// Streams of random numbers of their own: "anew".
constexpr std::uint32_t kAnewStream = 0x616e6577U;

template <class Record>
RecordSet<Record> without(const RecordSet<Record>& set, std::uint32_t light,
                          const std::set<RecordRef>& records, const VectorRadii& radii) {
  const auto isOfSet = [&](const RecordRef& record) { return record.light == light; };
  if (std::none_of(records.begin(), records.end(), isOfSet)) return set;
  std::vector<Record> kept;
  kept.reserve(set.size());
  for (std::uint32_t number = 0; number < set.size(); ++number) {
    if (!records.contains({light, number})) kept.push_back(set[number]);
  }
  return RecordSet<Record>().with(std::move(kept), radii);
}

template <class Record>
std::vector<Record> recordsOf(const RecordSet<Record>& set) {
  std::vector<Record> records;
  records.reserve(set.size());
  for (std::size_t number = 0; number < set.size(); ++number) records.push_back(set[number]);
  return records;
}

std::uint64_t seedAfter(const RandomKey& identity) { return identity.with(kAnewStream).asSeed(); }

/// The records that the frame has, each once.
std::vector<RecordRef> distinctRecords(const RenderFrame& frame, std::span<const RecordRef> records) {
  std::vector<RecordRef> distinct;
  std::set<RecordRef> seen;
  for (const RecordRef& record : records) {
    const bool exists = findIndirect(frame, record) != nullptr || findDirect(frame, record) != nullptr;
    if (exists && seen.insert(record).second) distinct.push_back(record);
  }
  return distinct;
}

/// Whether the numbers of `pinned` mean what the frame's do.
bool meansTheSame(const PinnedVectors& pinned, const RenderFrame& frame) {
  const VectorParameters& vectors = frame.parameters.vectors;
  return pinned.scene == frame.scene && pinned.indirectStore == vectors.ilv.store &&
         pinned.directStore == vectors.dlv.store;
}

using Places = std::unordered_set<RandomKey, RandomKeyHash>;
template <class Records>
Places placesOf(const Records& records) {
  Places places;
  for (std::size_t i = 0; i < records.size(); ++i) places.insert(placeKey(records[i]));
  return places;
}

/// Adds those of the set whose places are among these.
template <class Record>
void addPlaced(const RecordSet<Record>& set, std::uint32_t light, const Places& places,
               std::vector<RecordRef>& records) {
  for (std::uint32_t number = 0; !places.empty() && number < set.size(); ++number) {
    if (places.contains(placeKey(set[number]))) records.push_back({light, number});
  }
}

/// The set but for vectors in the places of these, and with `added`.
template <class Record>
RecordSet<Record> replaced(const RecordSet<Record>& set, const std::vector<Record>& gone,
                           const std::vector<Record>& added) {
  const Places gonePlaces = placesOf(gone);
  std::vector<Record> records;
  for (std::size_t i = 0; i < set.size(); ++i) {
    if (!gonePlaces.contains(placeKey(set[i]))) records.push_back(set[i]);
  }
  records.insert(records.end(), added.begin(), added.end());
  // Nobody asks a tree of them.
  return RecordSet<Record>().with(std::move(records), [](const Record&) { return 0.0f; });
}

/// The vectors that `records` name, by kind and light.
struct Selection {
  std::vector<IndirectLightVector> indirect;
  std::vector<std::vector<DirectLightVector>> direct;
};
Selection select(const RenderFrame& frame, std::span<const RecordRef> records) {
  Selection selection;
  selection.direct.resize(frame.scene->lights.size());
  for (const RecordRef& record : distinctRecords(frame, records)) {
    if (const IndirectLightVector* indirect = findIndirect(frame, record)) {
      selection.indirect.push_back(*indirect);
    } else if (const DirectLightVector* direct = findDirect(frame, record)) {
      selection.direct[record.light].push_back(*direct);
    }
  }
  return selection;
}

}  // namespace

std::shared_ptr<const Snapshot> withoutRecords(const RenderFrame& frame, std::span<const RecordRef> records) {
  if (!frame.snapshot) return nullptr;
  const VectorRadii radii(frame.parameters.vectors, *frame.scene);
  auto next = std::make_shared<Snapshot>();
  next->generation = frame.snapshot->generation + 1;
  const std::set<RecordRef> gone(records.begin(), records.end());
  next->indirect = without(frame.snapshot->indirect, kNone, gone, radii);
  for (std::uint32_t light = 0; light < frame.snapshot->direct.size(); ++light) {
    next->direct.push_back(without(frame.snapshot->direct[light], light, gone, radii));
  }
  return next;
}

std::shared_ptr<const Snapshot> exchanged(const RenderFrame& frame, const PinnedVectors* gone,
                                          const PinnedVectors* come) {
  const std::vector<RecordRef> going = pinnedRecords(gone, frame);
  return withPinned(going.empty() ? frame.snapshot : withoutRecords(frame, going), come, frame.scene,
                    frame.parameters.vectors);
}

std::shared_ptr<const Snapshot> recomputed(const RenderFrame& frame, std::span<const RecordRef> records,
                                           TaskPool& pool, const StopFlag& stop) {
  if (!frame.snapshot || stop) return nullptr;
  const std::vector<RecordRef> chosen = distinctRecords(frame, records);
  std::vector<IndirectLightVector> indirect = recordsOf(frame.snapshot->indirect);
  std::vector<std::vector<DirectLightVector>> direct;
  for (const auto& set : frame.snapshot->direct) direct.push_back(recordsOf(set));

  std::vector<VectorRecomputer> workers;
  for (int i = 0; i < pool.threadCount(); ++i) workers.emplace_back(frame, frame.parameters, stop);
  pool.forEach(chosen.size(), [&](std::size_t i, int w) {
    if (stop) return;
    VectorRecomputer& recompute = workers[static_cast<std::size_t>(w)];
    const auto [light, number] = chosen[i];
    if (light == kNone) {
      IndirectLightVector& old = indirect[number];
      old = recompute(old, seedAfter(old.birth.identity)).value_or(old);
    } else {
      DirectLightVector& old = direct[light][number];
      old = recompute(old, light, seedAfter(old.birth.identity)).value_or(old);
    }
  });
  if (stop) return nullptr;  // in the middle of one, perhaps

  const VectorRadii radii(frame.parameters.vectors, *frame.scene);
  auto next = std::make_shared<Snapshot>();
  next->generation = frame.snapshot->generation + 1;
  next->indirect = RecordSet<IndirectLightVector>().with(std::move(indirect), radii);
  for (auto& set : direct) next->direct.push_back(RecordSet<DirectLightVector>().with(std::move(set), radii));
  return next;
}

std::shared_ptr<const PinnedVectors> pin(std::shared_ptr<const PinnedVectors> pinned,
                                         const RenderFrame& frame, std::span<const RecordRef> records) {
  if (!frame.snapshot || distinctRecords(frame, records).empty()) return pinned;
  PinnedVectors next;
  if (pinned && meansTheSame(*pinned, frame)) next = *pinned;
  next.scene = frame.scene;
  next.indirectStore = frame.parameters.vectors.ilv.store;
  next.directStore = frame.parameters.vectors.dlv.store;
  const Selection selection = select(frame, records);
  next.vectors.indirect = replaced(next.vectors.indirect, selection.indirect, selection.indirect);
  next.vectors.direct.resize(selection.direct.size());
  for (std::size_t light = 0; light < selection.direct.size(); ++light) {
    next.vectors.direct[light] =
        replaced(next.vectors.direct[light], selection.direct[light], selection.direct[light]);
  }
  return std::make_shared<const PinnedVectors>(std::move(next));
}

std::shared_ptr<const PinnedVectors> unpin(std::shared_ptr<const PinnedVectors> pinned,
                                           const RenderFrame& frame, std::span<const RecordRef> records) {
  if (!pinned || !frame.snapshot || pinned->scene != frame.scene) return pinned;
  PinnedVectors next = *pinned;
  const Selection selection = select(frame, records);
  next.vectors.indirect = replaced(next.vectors.indirect, selection.indirect, {});
  for (std::size_t light = 0; light < selection.direct.size(); ++light)
    next.vectors.direct[light] = replaced(next.vectors.direct[light], selection.direct[light], {});
  if (next.count() == 0) return nullptr;
  return std::make_shared<const PinnedVectors>(std::move(next));
}

bool arePinned(const PinnedVectors* pinned, const RenderFrame& frame, std::span<const RecordRef> records) {
  if (records.empty() || pinned == nullptr || pinned->scene != frame.scene) return false;
  const Places indirectPlaces = placesOf(pinned->vectors.indirect);
  std::vector<Places> directPlaces;
  for (const auto& set : pinned->vectors.direct) directPlaces.push_back(placesOf(set));
  return std::all_of(records.begin(), records.end(), [&](const RecordRef& record) {
    if (const IndirectLightVector* indirect = findIndirect(frame, record))
      return indirectPlaces.contains(placeKey(*indirect));
    if (const DirectLightVector* direct = findDirect(frame, record))
      return directPlaces[record.light].contains(placeKey(*direct));
    return false;
  });
}

std::vector<RecordRef> pinnedRecords(const PinnedVectors* pinned, const RenderFrame& frame) {
  std::vector<RecordRef> records;
  if (pinned == nullptr || !frame.snapshot || pinned->scene != frame.scene) return records;
  addPlaced(frame.snapshot->indirect, kNone, placesOf(pinned->vectors.indirect), records);
  for (std::uint32_t light = 0; light < frame.snapshot->direct.size(); ++light)
    addPlaced(frame.snapshot->direct[light], light, placesOf(pinned->vectors.direct[light]), records);
  return records;
}

}  // namespace lightvane
