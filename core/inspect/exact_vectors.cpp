#include "core/inspect/exact_vectors.h"

#include <algorithm>
#include <cmath>

#include "core/inspect/vector_recomputer.h"

namespace lightvane {
namespace {

// Streams of random numbers of their own, one for each half: "exa0", "exa1".
constexpr std::uint32_t kExactStream = 0x65786130U;

/// How many times the frame's samples each half has.
constexpr int kTimesTheSamples = 8;

Parameters withMoreSamples(Parameters parameters) {
  IlvParameters& ilv = parameters.vectors.ilv;
  // The cells keep their shape as far as whole numbers let them.
  const double along = std::sqrt(static_cast<double>(kTimesTheSamples));
  ilv.rows = static_cast<int>(std::ceil(along * ilv.rows));
  ilv.columns = static_cast<int>(std::ceil(along * ilv.columns));
  parameters.transport.lightSamples *= kTimesTheSamples;
  return parameters;
}

std::uint64_t seedOf(const RandomKey& identity, std::size_t half) {
  return identity.with(kExactStream + static_cast<std::uint32_t>(half)).asSeed();
}

/// The light of one, as far as the other reaches: what its gather met decides on its radius and its weights.
IndirectLightVector reachingAs(const IndirectLightVector& old, IndirectLightVector anew) {
  anew.arithmeticMean = old.arithmeticMean;
  anew.harmonicMean = old.harmonicMean;
  anew.leastDistance = old.leastDistance;
  anew.lobeWidth = old.lobeWidth;
  return anew;
}

}  // namespace

void ExactVectors::compute(std::span<const RecordRef> records, TaskPool& pool, const StopFlag& stop) {
  std::vector<RecordRef> lacking;
  for (const RecordRef& record : records) {
    const std::size_t place = record.isIndirect() ? indirect_.size() : direct_.size();
    if (!places_.try_emplace(record, place).second) continue;
    lacking.push_back(record);
    if (record.isIndirect()) {
      indirect_.emplace_back().fill(frame_.snapshot->indirect[record.number]);
    } else {
      direct_.emplace_back().fill({frame_.snapshot->direct[record.light][record.number]});
    }
  }
  const Parameters parameters = withMoreSamples(frame_.parameters);
  const bool keepsIrradiance = parameters.vectors.dlv.store == VectorStore::Vector;
  std::vector<VectorRecomputer> workers;
  for (int i = 0; i < pool.threadCount(); ++i) workers.emplace_back(frame_, parameters, stop);
  pool.forEach(2 * lacking.size(), [&](std::size_t i, int w) {
    if (stop) return;
    VectorRecomputer& recompute = workers[static_cast<std::size_t>(w)];
    const RecordRef record = lacking[i / 2];
    const std::size_t half = i % 2, place = places_.at(record);
    if (record.isIndirect()) {
      IndirectLightVector& kept = indirect_[place][half];
      if (auto anew = recompute(kept, seedOf(kept.birth.identity, half))) kept = reachingAs(kept, *anew);
    } else {
      Direct& kept = direct_[place][half];
      if (auto anew = recompute(kept.vector, record.light, seedOf(kept.vector.birth.identity, half)))
        kept.vector = *anew;
      if (keepsIrradiance) kept.irradiance = recompute.irradianceOf(kept.vector, record.light);
    }
  });
  for (const VectorRecomputer& worker : workers) rays_ += worker.rays();
}

const IndirectLightVector& ExactVectors::indirect(std::uint32_t number, std::size_t half) const {
  return indirect_[places_.at({kNone, number})][half];
}

const DirectLightVector& ExactVectors::direct(const RecordRef& record, std::size_t half) const {
  return direct_[places_.at(record)][half].vector;
}

const Rgb& ExactVectors::irradiance(const RecordRef& record, std::size_t half) const {
  return direct_[places_.at(record)][half].irradiance;
}

}  // namespace lightvane
