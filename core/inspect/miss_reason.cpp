#include "core/inspect/miss_reason.h"

#include <optional>

#include "core/render/point_answers.h"

namespace lightvane {
namespace {

struct Nearest {
  std::optional<std::uint32_t> number;
  float distance = kInfinity;
};

/// The nearest of the vectors `found` that are numbered below `before`.
Nearest nearestOf(const RecordSet<IndirectLightVector>& records, const std::vector<std::uint32_t>& found,
                  std::size_t before, const Vec3& position) {
  Nearest nearest;
  for (const std::uint32_t number : found) {
    if (number >= before) break;
    const float distance = glm::length(records[number].point.position - position);
    if (distance < nearest.distance) nearest = {number, distance};
  }
  return nearest;
}

/// The nearest vector of `key` among those numbered below `before`.
std::optional<std::uint32_t> nearestBefore(const RecordSet<IndirectLightVector>& records, std::size_t before,
                                           SurfaceKey key, const Vec3& position, float firstRadius,
                                           float diagonal) {
  std::vector<std::uint32_t> found;
  // Where few were known before, the tree would be asked for far too large a ball: one by one is quicker.
  constexpr std::size_t kFew = 256;
  if (before <= kFew) {
    for (std::uint32_t number = 0; number < before; ++number) {
      if (records[number].point.key == key) found.push_back(number);
    }
    return nearestOf(records, found, before, position).number;
  }
  // A query finds all vectors within its ball, and some beyond: those that reach into it. The nearest one
  // found is the nearest of all once the ball is as large as its distance.
  for (float radius = firstRadius;;) {
    records.query(key, position, radius, found);
    const Nearest nearest = nearestOf(records, found, before, position);
    if (nearest.distance <= radius || radius > 2.0f * diagonal) return nearest.number;
    // Rounded up: the ball must hold what it was made for.
    radius = nearest.number ? nearest.distance * (1.0f + 0x1p-20f) : 4.0f * radius;
  }
}

MissReason reasonOf(Refusal refusal) {
  switch (refusal) {
    case Refusal::Distance:
      return MissReason::Distance;
    case Refusal::Curvature:
      return MissReason::Curvature;
    case Refusal::Gradient:
      return MissReason::Gradient;
    case Refusal::InFront:
      return MissReason::InFront;
    case Refusal::Lobe:
      return MissReason::Lobe;
    case Refusal::Clearance:
      return MissReason::Clearance;
    case Refusal::Visibility:
      return MissReason::Visibility;
    case Refusal::None:
    case Refusal::BeyondMost:
      return MissReason::TooFew;
  }
  return MissReason::TooFew;
}

}  // namespace

const char* missReasonName(MissReason reason) {
  switch (reason) {
    case MissReason::Seed:
      return "seed";
    case MissReason::NoneYet:
      return "none yet";
    case MissReason::Distance:
      return "distance";
    case MissReason::Curvature:
      return "curvature";
    case MissReason::Gradient:
      return "gradient";
    case MissReason::InFront:
      return "in front";
    case MissReason::Lobe:
      return "lobe";
    case MissReason::Clearance:
      return "clearance";
    case MissReason::Visibility:
      return "visibility";
    case MissReason::TooFew:
      return "too few";
  }
  return "";
}

const char* missReasonHelp(MissReason reason) {
  switch (reason) {
    case MissReason::Seed:
      return "Computed before the first pass, at a place chosen by chance.";
    case MissReason::NoneYet:
      return "No vector was known yet that surfaces of this kind share.";
    case MissReason::Distance:
      return "The nearest vector's radius did not reach the point.";
    case MissReason::Curvature:
      return "The nearest vector's normal differed by more than S_curv allows.";
    case MissReason::Gradient:
      return "The nearest vector's gradient predicted a change beyond S_E.";
    case MissReason::InFront:
      return "The nearest vector lay in front of the point.";
    case MissReason::Lobe:
      return "The nearest vector was computed for another direction of view.";
    case MissReason::Clearance:
      return "The nearest vector was farther than the point's own clearance allows.";
    case MissReason::Visibility:
      return "Something stands between the point and the nearest vector.";
    case MissReason::TooFew:
      return "The nearest vector was valid, but there were fewer than n_min.";
  }
  return "";
}

MissReason missReason(const RecordSet<IndirectLightVector>& records, std::size_t before, SurfaceKey key,
                      const QueryPoint& point, const IlvRules& rules, const Tracer& tracer) {
  const float diagonal = tracer.scene().diagonal;
  // The spacing of vectors is of the order of a few hundredths of a room: most searches end with the first
  // ball.
  const std::optional<std::uint32_t> nearest =
      nearestBefore(records, before, key, point.position, 0x1p-6f * diagonal, diagonal);
  if (!nearest) return MissReason::NoneYet;
  const IlvCandidate a = makeCandidate(records[*nearest], rules);
  Refusal refusal;
  const float weight = ilvWeight(a, point.position, point.normal, point.outgoing, rules, refusal);
  if (refusal != Refusal::None) return reasonOf(refusal);
  const float distance = glm::length(point.position - a.position);
  if (!(distance <= point.reach)) return MissReason::Clearance;
  // Valid, and at the very edge.
  if (weight == 0.0f)
    return distance * a.inverseRadius >= 1.0f ? MissReason::Distance : MissReason::Curvature;
  if (rules.p.visibility && distance > a.visibleWithin) {
    Ray ray;
    if (visibilityRay(a, point, distance, ray) && tracer.occluded(ray)) return MissReason::Visibility;
  }
  return MissReason::TooFew;
}

std::vector<ComputedVector> computedVectors(const RenderFrame& frame) {
  std::vector<ComputedVector> computed;
  if (!frame.points || !frame.snapshot) return computed;
  const FlushDenormals flush;
  const RecordSet<IndirectLightVector>& records = frame.snapshot->indirect;
  const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
  for (std::uint32_t number = 0; number < records.size(); ++number) {
    const IndirectLightVector& record = records[number];
    const PointRef ref = pointOfRecord(*frame.points, record.point, record.birth);
    if (ref.isNone()) continue;
    MissReason reason = MissReason::Seed;
    if (record.birth.pass > 0) {
      const VisiblePoint& p = frame.points->tiles[ref.tile].points[ref.point];
      reason = missReason(records, firstOfPublication(records, number), record.point.key,
                          queryPoint(p, rules.p), rules, *frame.tracer);
    }
    computed.push_back({number, ref, reason});
  }
  return computed;
}

}  // namespace lightvane
