#include "core/inspect/record_edit.h"

#include <algorithm>
#include <vector>

#include "core/vectors/validity.h"

namespace lightvane {
namespace {

template <class Record, class RadiusOf>
RecordSet<Record> without(const RecordSet<Record>& set, std::uint32_t light,
                          std::span<const RecordRef> records, const RadiusOf& radiusOf) {
  std::vector<Record> kept;
  kept.reserve(set.size());
  for (std::uint32_t number = 0; number < set.size(); ++number) {
    if (std::find(records.begin(), records.end(), RecordRef{light, number}) == records.end())
      kept.push_back(set[number]);
  }
  return RecordSet<Record>().with(std::move(kept), radiusOf);
}

}  // namespace

std::shared_ptr<const Snapshot> withoutRecords(const RenderFrame& frame, std::span<const RecordRef> records) {
  if (!frame.snapshot) return nullptr;
  const VectorParameters& parameters = frame.parameters.vectors;
  const IlvRules rules(parameters.ilv, frame.scene->diagonal);
  const float rMax = dlvRadius(parameters.dlv, *frame.scene);
  auto next = std::make_shared<Snapshot>();
  next->generation = frame.snapshot->generation + 1;
  next->indirect = without(frame.snapshot->indirect, kNone, records,
                           [&](const IndirectLightVector& record) { return ilvRadius(record, rules); });
  for (std::uint32_t light = 0; light < frame.snapshot->direct.size(); ++light) {
    next->direct.push_back(without(frame.snapshot->direct[light], light, records,
                                   [&](const DirectLightVector&) { return rMax; }));
  }
  return next;
}

}  // namespace lightvane
