#pragma once

#include <cstdint>
#include <vector>

#include "core/inspect/frame_points.h"
#include "core/trace/tracer.h"
#include "core/vectors/answer.h"

namespace lightvane {

/// Why an ILV was computed: what kept the vectors that were known before from serving its point.
enum class MissReason : std::uint8_t {
  Seed,     ///< nobody asked: it belongs to the seed
  NoneYet,  ///< no vector of its key was known
  // What refused the nearest vector of its key, by the rule:
  Distance,
  Curvature,
  Gradient,
  InFront,
  Lobe,
  Clearance,
  Visibility,
  TooFew  ///< the nearest was valid, but there were fewer than n_min of such
};
/// In a word or two.
const char* missReasonName(MissReason reason);
/// A sentence.
const char* missReasonHelp(MissReason reason);

/// The rule that made `point` miss, among vectors of `key` numbered below `before`: the nearest of them is
/// judged. Pure. Cost: two queries of the tree and at most one ray.
MissReason missReason(const RecordSet<IndirectLightVector>& records, std::size_t before, SurfaceKey key,
                      const QueryPoint& point, const IlvRules& rules, const Tracer& tracer);

/// An ILV of the snapshot that was computed for a visible point of the frame.
struct ComputedVector {
  std::uint32_t number;
  PointRef point;
  MissReason reason;
};

/// All of them, in the order of their numbers, judged by the frame's parameters. A function of the frame's
/// snapshot, points and parameters alone: for as long as these stay, a caller may keep it. Empty for methods
/// without vectors. Any thread. Cost: about 3 us a vector.
std::vector<ComputedVector> computedVectors(const RenderFrame& frame);

}  // namespace lightvane
