#include "core/vectors/answer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Of a point that has no more than n_max vectors: farther than any of them,
// nearer than those that do not serve it.
constexpr float kNoLimit = std::numeric_limits<float>::max();

bool isRefinedWeight(const IlvParameters& p) {
  return p.weight == IlvWeight::Edge && p.gradientTest == IlvGradientTest::Off;
}

}  // namespace

Answerer::Answerer(const Tracer& tracer, const VectorParameters& parameters)
    : tracer_(tracer),
      parameters_(parameters),
      rules_(parameters.ilv, tracer.scene().diagonal),
      dlvRadius_(lightvane::dlvRadius(parameters.dlv, tracer.scene())),
      metresPerUnit_(tracer.scene().metresPerNormalisedUnit()) {}

void Answerer::PointArrays::set(std::span<const QueryPoint> points) {
  count = points.size();
  lanes = (count + kRegister - 1) / kRegister * kRegister;
  for (std::size_t i = 0; i < lanes; ++i) {
    const QueryPoint& p = points[std::min(i, count - 1)];
    x[i] = p.position.x;
    y[i] = p.position.y;
    z[i] = p.position.z;
    normalX[i] = p.normal.x;
    normalY[i] = p.normal.y;
    normalZ[i] = p.normal.z;
    geometricX[i] = p.geometricNormal.x;
    geometricY[i] = p.geometricNormal.y;
    geometricZ[i] = p.geometricNormal.z;
    offset[i] = p.offset;
    // What only fills the lanes is out of every vector's reach.
    reach[i] = i < count ? p.reach : -1.0f;
  }
}

void Answerer::Sums::clear(std::size_t lanes) {
  for (int channel = 0; channel < 3; ++channel) {
    std::fill_n(energy[channel], lanes, 0.0f);
    std::fill_n(lobe[channel], lanes, 0.0f);
    std::fill_n(direction[channel], lanes, 0.0f);
  }
  std::fill_n(weight, lanes, 0.0f);
  std::fill_n(nearestSquared, lanes, kInfinity);
  std::fill_n(count, lanes, 0);
  std::fill_n(nearest, lanes, 0u);
}

void Answerer::Judgements::clear(std::size_t lanes) {
  std::fill_n(mean, lanes, 0.0);
  std::fill_n(variance, lanes, 0.0);
  std::fill_n(valid, lanes, 0);
  std::fill_n(hasVector, lanes, 0);
  std::fill_n(nearestSquared, lanes, kInfinity);
}

void Answerer::findCandidates(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                              const Vec3& centre, float radius, std::size_t before) {
  records.query(key, centre, radius, found_);
  found_.erase(std::lower_bound(found_.begin(), found_.end(), before), found_.end());
  candidates_.clear();
  for (const std::uint32_t number : found_) candidates_.push_back(makeCandidate(records[number], rules_));
}

void Answerer::ask(std::span<const QueryPoint> points, std::size_t candidateCount, int most) {
  points_.set(points);
  candidateCount_ = candidateCount;
  most_ = most;
  weights_.resize(candidateCount * kClusterSize);
  distances_.resize(candidateCount * kClusterSize);
}

void Answerer::weigh(std::span<const QueryPoint> points) {
  ask(points, candidates_.size(), rules_.p.nMax);
  const bool refined = isRefinedWeight(rules_.p);
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const IlvCandidate& a = candidates_[c];
    float* weights = &weights_[c * kClusterSize];
    float* distances = &distances_[c * kClusterSize];
    if (refined && a.cosLobe < -1.5f) {
      weighRefined(a, weights, distances);
      continue;
    }
    std::fill_n(weights, points_.lanes, 0.0f);
    std::fill_n(distances, points_.lanes, kInfinity);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3 ab = points[i].position - a.position;
      const float squared = ab.x * ab.x + ab.y * ab.y + ab.z * ab.z;
      Refusal refusal;
      const float weight =
          ilvWeight(a, points[i].position, points[i].normal, points[i].outgoing, rules_, refusal);
      if (refusal != Refusal::None || weight == 0.0f || !(std::sqrt(squared) <= points[i].reach)) continue;
      weights[i] = weight;
      distances[i] = squared;
    }
  }
}

/// ilvWeight for the refined rules without a lobe, the same operations in the
/// same order, over all points at once.
void Answerer::weighRefined(const IlvCandidate& a, float* weights, float* distances) const {
  const float limit = 1.0f - rules_.sCurv;
  const float inverseCurv = rules_.inverseCurv;
  const float inFront = rules_.p.inFront ? 1.0f : 0.0f;
  for (std::size_t i = 0; i < points_.lanes; ++i) {
    const float abx = points_.x[i] - a.position.x;
    const float aby = points_.y[i] - a.position.y;
    const float abz = points_.z[i] - a.position.z;
    const float squared = abx * abx + aby * aby + abz * abz;
    const float distance = std::sqrt(squared);
    const float dnx = a.normal.x - points_.normalX[i];
    const float dny = a.normal.y - points_.normalY[i];
    const float dnz = a.normal.z - points_.normalZ[i];
    const float bend = 0.5f * (dnx * dnx + dny * dny + dnz * dnz);
    const float mx = 0.5f * (a.normal.x + points_.normalX[i]);
    const float my = 0.5f * (a.normal.y + points_.normalY[i]);
    const float mz = 0.5f * (a.normal.z + points_.normalZ[i]);
    const float height = inFront * (abx * mx + aby * my + abz * mz);
    const float far = distance * a.inverseRadius;
    const float bent = std::sqrt(bend * inverseCurv);
    const float worst = far < bent ? bent : far;  // as std::max has it where bent is 0/0 (S_curv = 1)
    const float weight = 1.0f - worst;
    const bool valid = (distance <= a.radius) & (distance <= points_.reach[i]) & (bend <= limit) &
                       (height >= -(kInFrontSlope * distance + kInFrontRounding)) & (weight > 0.0f);
    weights[i] = valid ? weight : 0.0f;
    distances[i] = valid ? squared : kInfinity;
  }
}

bool visibilityRay(const IlvCandidate& a, const QueryPoint& b, float distance, Ray& ray) {
  // On a curved surface the chord runs inside: both ends are raised by its
  // sagitta, d * angle / 8.
  const float angle = std::sqrt(2.0f * oneMinusCos(a.normal, b.normal));
  const float lift = 2.0f * b.offset + 0.15f * angle * distance;
  const Vec3 from = b.position + lift * b.geometricNormal;
  const Vec3 way = a.position + lift * a.normal - from;
  const float length = glm::length(way);
  if (!(length > 4.0f * b.offset)) return false;
  ray = {from, way / length, 0.0f, length * (1.0f - 0x1p-12f)};
  return true;
}

void Answerer::chooseNearest(std::span<const QueryPoint> points, const Vec3& centre, float radius,
                             RayCounts& counts) {
  std::fill_n(tested_, points_.lanes, -1.0f);
  limitToNearest();
  if (rules_.p.visibility) findClearSpace(points, centre, radius);
  while (rules_.p.visibility && testVisibility(counts)) limitToNearest();
}

void Answerer::findClearSpace(std::span<const QueryPoint> points, const Vec3& centre, float radius) {
  // Less than what the rays of a few candidates cost.
  constexpr std::size_t kWorthwhile = 64;
  clearSpace_ = ClearSpace(centre, 0.0f, 0.0f);
  if (points.size() * candidates_.size() < kWorthwhile) return;
  float farthest = 0.0f;
  for (const IlvCandidate& a : candidates_) farthest = std::max(farthest, glm::length(a.position - centre));
  float offset = kInfinity;
  for (const QueryPoint& point : points) offset = std::min(offset, point.offset);
  // Rays begin twice the offset above their surface.
  clearSpace_ = tracer_.clearSpace(centre + 2.0f * offset * points.front().geometricNormal,
                                   std::max(farthest, radius) + 4.0f * offset, 0.5f * offset);
}

template <class Work>
void Answerer::forLanes(const Work& work) const {
  for (std::size_t begin = 0; begin < points_.lanes; begin += kLanes)
    work(Lanes{begin, std::min(kLanes, points_.lanes - begin)});
}

void Answerer::limitToNearest() {
  forLanes([&](const Lanes& lanes) { limitToNearest(lanes); });
}

void Answerer::limitToNearest(const Lanes& lanes) {
  LimitSearch search = rangeOfDistances(lanes);
  while (search.open) {
    LimitSearch::Split split;
    for (std::size_t c = 0; c < candidateCount_; ++c) {
      const float* squared = &distances_[c * kClusterSize + lanes.begin];
      for (std::size_t i = 0; i < lanes.count; ++i) {
        const float value = squared[i];
        const bool within = value <= search.middle[i];
        const bool isNearest = within & (value > split.below[i]);
        const bool isNext = !within & (value < split.above[i]);
        split.within[i] += within ? 1 : 0;
        split.below[i] = isNearest ? value : split.below[i];
        split.above[i] = isNext ? value : split.above[i];
      }
    }
    search.narrow(lanes.count, split, most_);
  }
  std::copy_n(search.high, lanes.count, &limits_[lanes.begin]);
}

Answerer::LimitSearch Answerer::rangeOfDistances(const Lanes& lanes) const {
  LimitSearch search;
  std::fill_n(search.low, kLanes, kInfinity);
  for (std::size_t c = 0; c < candidateCount_; ++c) {
    const float* squared = &distances_[c * kClusterSize + lanes.begin];
    for (std::size_t i = 0; i < lanes.count; ++i) {
      const bool serves = squared[i] < kInfinity;
      const bool isLargest = serves & (squared[i] > search.high[i]);
      search.atHigh[i] += serves ? 1 : 0;
      search.low[i] = squared[i] < search.low[i] ? squared[i] : search.low[i];
      search.high[i] = isLargest ? squared[i] : search.high[i];
    }
  }
  for (std::size_t i = 0; i < lanes.count; ++i) {
    const bool isLimited = search.atHigh[i] > most_;
    search.high[i] = isLimited ? search.high[i] : kNoLimit;
    search.low[i] = isLimited ? search.low[i] : kNoLimit;
  }
  search.findMiddle(lanes.count, most_);
  return search;
}

void Answerer::LimitSearch::narrow(std::size_t count, const Split& split, std::int32_t most) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool isOpen = low[i] < high[i];
    const bool isEnough = isOpen & (split.within[i] >= most);
    const bool isTooLow = isOpen & !isEnough;
    const float lowest = isTooLow ? split.above[i] : low[i];
    high[i] = isEnough ? split.below[i] : high[i];
    atHigh[i] = isEnough ? split.within[i] : atHigh[i];
    low[i] = atHigh[i] == most ? high[i] : lowest;
  }
  findMiddle(count, most);
}

void Answerer::LimitSearch::findMiddle(std::size_t count, std::int32_t most) {
  std::int32_t anyOpen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto least = std::bit_cast<std::int32_t>(low[i]);
    const auto largest = std::bit_cast<std::int32_t>(high[i]);
    // Where a few are too many, one by one is faster than half by half.
    const bool isNear = atHigh[i] - most <= kOneByOne;
    const std::int32_t between = isNear ? largest - 1 : least + (largest - least) / 2;
    middle[i] = std::bit_cast<float>(least < largest ? between : largest);
    anyOpen |= least < largest ? 1 : 0;
  }
  open = anyOpen != 0;
}

Answerer::VisibilityRays::VisibilityRays() {
  for (int lane = 0; lane < kShadowPacketWidth; ++lane) packet.set(lane, Ray{});
}

void Answerer::aim(std::size_t candidate, const Lanes& lanes, VisibilityRays& __restrict rays) const {
  const auto [begin, n] = lanes;
  const IlvCandidate& a = candidates_[candidate];
  const float* distances = &distances_[candidate * kClusterSize + begin];
  const float within = a.visibleWithin * a.visibleWithin;
  std::int32_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float squared = distances[i];
    const bool asked = (squared > within) & (squared > tested_[begin + i]) & (squared <= limits_[begin + i]);
    rays.asked[i] = asked ? 1 : 0;
    any |= rays.asked[i];
  }
  rays.count = 0;
  if (any == 0) return;
  // visibilityRay, the same operations in the same order.
  ShadowPacket& packet = rays.packet;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = begin + i;
    const float dnx = a.normal.x - points_.normalX[p];
    const float dny = a.normal.y - points_.normalY[p];
    const float dnz = a.normal.z - points_.normalZ[p];
    const float angle = std::sqrt(2.0f * (0.5f * (dnx * dnx + dny * dny + dnz * dnz)));
    const float distance = std::sqrt(distances[i]);
    const float lift = 2.0f * points_.offset[p] + 0.15f * angle * distance;
    packet.originX[i] = points_.x[p] + lift * points_.geometricX[p];
    packet.originY[i] = points_.y[p] + lift * points_.geometricY[p];
    packet.originZ[i] = points_.z[p] + lift * points_.geometricZ[p];
    rays.endX[i] = a.position.x + lift * a.normal.x;
    rays.endY[i] = a.position.y + lift * a.normal.y;
    rays.endZ[i] = a.position.z + lift * a.normal.z;
  }
  if (!dropClear(n, rays)) return;
  for (std::size_t i = 0; i < n; ++i) {
    const float wayX = rays.endX[i] - packet.originX[i];
    const float wayY = rays.endY[i] - packet.originY[i];
    const float wayZ = rays.endZ[i] - packet.originZ[i];
    const float length = std::sqrt(wayX * wayX + wayY * wayY + wayZ * wayZ);
    rays.asked[i] = length > 4.0f * points_.offset[begin + i] ? rays.asked[i] : 0;
    rays.count += rays.asked[i];
    packet.directionX[i] = wayX / length;
    packet.directionY[i] = wayY / length;
    packet.directionZ[i] = wayZ / length;
    packet.tFar[i] = length * (1.0f - 0x1p-12f);
  }
}

bool Answerer::dropClear(std::size_t n, VisibilityRays& __restrict rays) const {
  if (!(clearSpace_.radius() > 0.0f)) return true;
  // ClearSpace::holds both ends.
  const Vec3 centre = clearSpace_.centre();
  const float most = square(clearSpace_.radius());
  std::int32_t isClear[kLanes];
  for (std::size_t i = 0; i < n; ++i) {
    const float fromX = rays.packet.originX[i] - centre.x;
    const float fromY = rays.packet.originY[i] - centre.y;
    const float fromZ = rays.packet.originZ[i] - centre.z;
    const float endX = rays.endX[i] - centre.x;
    const float endY = rays.endY[i] - centre.y;
    const float endZ = rays.endZ[i] - centre.z;
    const bool isNear = (fromX * fromX + fromY * fromY + fromZ * fromZ < most) &
                        (endX * endX + endY * endY + endZ * endZ < most);
    isClear[i] = isNear ? 1 : 0;
  }
  for (const ClearSpace::Plane& plane : clearSpace_.planes()) {
    const float least = clearSpace_.margin() - plane.offset;
    for (std::size_t i = 0; i < n; ++i) {
      const float from = plane.normal.x * rays.packet.originX[i] + plane.normal.y * rays.packet.originY[i] +
                         plane.normal.z * rays.packet.originZ[i];
      const float end =
          plane.normal.x * rays.endX[i] + plane.normal.y * rays.endY[i] + plane.normal.z * rays.endZ[i];
      isClear[i] &= ((from > least) & (end > least)) ? 1 : 0;
    }
  }
  std::int32_t any = 0;
  for (std::size_t i = 0; i < n; ++i) {
    rays.asked[i] = isClear[i] != 0 ? 0 : rays.asked[i];
    any |= rays.asked[i];
  }
  return any != 0;
}

bool Answerer::testVisibility(RayCounts& counts) {
  ShadowPacket packet;
  std::size_t pairs[kShadowPacketWidth];
  int count = 0;
  bool isOneLost = false;
  const auto lose = [&](std::size_t pair) {
    weights_[pair] = 0.0f;
    distances_[pair] = kInfinity;
    isOneLost |= limits_[pair % kClusterSize] < kNoLimit;
  };
  const auto flush = [&] {
    if (count == 0) return;
    tracer_.occluded(packet, count, Coherence::Coherent);
    counts.visibility += static_cast<std::uint64_t>(count);
    for (int lane = 0; lane < count; ++lane) {
      if (packet.isOccluded(lane)) lose(pairs[lane]);
    }
    count = 0;
  };
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    forLanes([&](const Lanes& at) {
      VisibilityRays& rays = visibilityRays_;
      aim(c, at, rays);
      const std::size_t first = c * kClusterSize + at.begin;
      if (rays.count == kShadowPacketWidth) {
        tracer_.occluded(rays.packet, kShadowPacketWidth, Coherence::Coherent);
        counts.visibility += kLanes;
        for (int lane = 0; lane < kShadowPacketWidth; ++lane) {
          if (rays.packet.isOccluded(lane)) lose(first + static_cast<std::size_t>(lane));
        }
        return;
      }
      if (rays.count == 0) return;
      for (std::size_t i = 0; i < at.count; ++i) {
        if (rays.asked[i] == 0) continue;
        packet.set(count, rays.packet.ray(static_cast<int>(i)));
        pairs[count++] = first + i;
        if (count == kShadowPacketWidth) flush();
      }
    });
  }
  flush();
  std::copy_n(limits_, points_.lanes, tested_);
  return isOneLost;
}

void Answerer::dropBeyondLimits() {
  forLanes([&](const Lanes& lanes) { dropBeyondLimits(lanes); });
}

void Answerer::dropBeyondLimits(const Lanes& lanes) {
  const auto [begin, n] = lanes;
  const float* limits = &limits_[begin];
  if (std::all_of(limits, limits + n, [](float limit) { return limit == kNoLimit; })) return;
  std::int32_t left[kLanes];  // of those that are exactly as far as the limit
  std::fill_n(left, n, most_);
  for (std::size_t c = 0; c < candidateCount_; ++c) {
    const float* squared = &distances_[c * kClusterSize + begin];
    for (std::size_t i = 0; i < n; ++i) left[i] -= squared[i] < limits[i] ? 1 : 0;
  }
  for (std::size_t c = 0; c < candidateCount_; ++c) {
    const float* squared = &distances_[c * kClusterSize + begin];
    float* weights = &weights_[c * kClusterSize + begin];
    for (std::size_t i = 0; i < n; ++i) {
      const bool isAtLimit = squared[i] == limits[i];
      const bool stays = (squared[i] < limits[i]) | (isAtLimit & (left[i] > 0));
      left[i] -= isAtLimit ? 1 : 0;
      weights[i] = stays ? weights[i] : 0.0f;
    }
  }
}

void Answerer::answerIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                              std::span<const QueryPoint> points, const Vec3& centre, float radius,
                              std::span<IndirectAnswer> answers, RayCounts& counts) {
  LV_CHECK(points.size() <= kClusterSize, "{} points in a cluster", points.size());
  if (points.empty()) return;
  findCandidates(records, key, centre, radius, records.size());
  weigh(points);
  chooseNearest(points, centre, radius, counts);
  dropBeyondLimits();
  answerFound(records, points, answers);
}

void Answerer::answerFound(const RecordSet<IndirectLightVector>& records, std::span<const QueryPoint> points,
                           std::span<IndirectAnswer> answers) {
  sums_.clear(points_.lanes);
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const IndirectLightVector& record = records[found_[c]];
    forLanes([&](const Lanes& lanes) {
      const float* weights = &weights_[c * kClusterSize + lanes.begin];
      if (std::any_of(weights, weights + lanes.count, [](float weight) { return weight != 0.0f; }))
        addVector(record, c, lanes);
    });
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    IndirectAnswer& answer = answers[i];
    answer = IndirectAnswer{};
    answer.count = sums_.count[i];
    if (answer.count == 0) continue;
    answer.nearest = sums_.nearest[i];
    answer.weight = sums_.weight[i];
    answer.energy = Rgb(sums_.energy[0][i], sums_.energy[1][i], sums_.energy[2][i]) / answer.weight;
    const Vec3 direction(sums_.direction[0][i], sums_.direction[1][i], sums_.direction[2][i]);
    const float length = glm::length(direction);
    answer.direction = length > 0.0f ? direction / length : points[i].normal;
  }
}

void Answerer::spreadIndirect(const RecordSet<IndirectLightVector>& records,
                              std::span<const QueryPoint> points, std::span<const IndirectAnswer> answers,
                              std::span<IndirectSpread> spreads) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const IndirectAnswer& answer = answers[i];
    IndirectSpread& spread = spreads[i];
    spread = IndirectSpread{};
    if (answer.count < 2) continue;
    Vec3d sum(0.0);
    double squares = 0.0;
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const float weight = weights_[c * kClusterSize + i];
      if (weight == 0.0f) continue;
      const Rgb energy = ilvExtrapolate(records[found_[c]], points[i].position, points[i].normal, rules_.p,
                                        candidates_[c].gradientScale);
      const double part = static_cast<double>(weight) / static_cast<double>(answer.weight);
      const Vec3d difference = Vec3d(energy) - Vec3d(answer.energy);
      sum += part * difference * difference;
      squares += part * part;
    }
    // All the weight on one of them says as little as one alone.
    constexpr double kAlone = 1e-6;
    if (!(squares < 1.0 - kAlone)) continue;
    spread.ofOne = Rgb(sum / (1.0 - squares));
    spread.share = static_cast<float>(squares);
    spread.isKnown = true;
  }
}

void Answerer::addVector(const IndirectLightVector& record, std::size_t candidate, const Lanes& lanes) {
  const auto [begin, n] = lanes;
  const std::size_t first = candidate * kClusterSize + begin;
  float weight[kLanes];
  std::int32_t used[kLanes];
  for (std::size_t i = 0; i < n; ++i) {
    weight[i] = weights_[first + i];
    used[i] = weight[i] != 0.0f ? 1 : 0;
  }
  // ilvExtrapolate, the same operations in the same order.
  const float scale = candidates_[candidate].gradientScale;
  float abx[kLanes], aby[kLanes], abz[kLanes], turnX[kLanes], turnY[kLanes], turnZ[kLanes];
  const Vec3 at = record.point.position;
  const Vec3 normal = record.point.normal;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = begin + i;
    abx[i] = scale * (points_.x[p] - at.x);
    aby[i] = scale * (points_.y[p] - at.y);
    abz[i] = scale * (points_.z[p] - at.z);
    turnX[i] = normal.y * points_.normalZ[p] - points_.normalY[p] * normal.z;
    turnY[i] = normal.z * points_.normalX[p] - points_.normalZ[p] * normal.x;
    turnZ[i] = normal.x * points_.normalY[p] - points_.normalX[p] * normal.y;
  }
  const bool extrapolates = rules_.p.extrapolate;
  for (int channel = 0; channel < 3; ++channel) {
    const float own = record.energy[channel];
    const Vec3 gradient = record.gradient[channel];
    const Vec3 rotation = record.rotation[channel];
    const float low = extrapolates ? static_cast<float>(rules_.p.extrapolateMin) * own : own;
    const float high = extrapolates ? static_cast<float>(rules_.p.extrapolateMax) * own : own;
    float* energy = &sums_.energy[channel][begin];
    for (std::size_t i = 0; i < n; ++i) {
      const float moved = abx[i] * gradient.x + aby[i] * gradient.y + abz[i] * gradient.z;
      const float turned = turnX[i] * rotation.x + turnY[i] * rotation.y + turnZ[i] * rotation.z;
      const float predicted = own + moved + turned;
      const float raised = predicted < low ? low : predicted;
      const float value = high < raised ? high : raised;
      energy[i] += used[i] != 0 ? weight[i] * value : 0.0f;
    }
    const float towards = record.direction[channel];
    float* direction = &sums_.direction[channel][begin];
    for (std::size_t i = 0; i < n; ++i) direction[i] += weight[i] * towards;
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = begin + i;
    const float squared = distances_[first + i];
    const bool isNearer = (used[i] != 0) & (squared < sums_.nearestSquared[p]);
    sums_.weight[p] += weight[i];
    sums_.count[p] += used[i];
    sums_.nearestSquared[p] = isNearer ? squared : sums_.nearestSquared[p];
    sums_.nearest[p] = isNearer ? found_[candidate] : sums_.nearest[p];
  }
}

IndirectExplanation Answerer::explainIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                                              const QueryPoint& point, const Vec3& centre, float radius,
                                              std::size_t before, RayCounts& counts) {
  const std::span<const QueryPoint> points(&point, 1);
  findCandidates(records, key, centre, radius, before);
  IndirectExplanation explanation;
  // What the rays or n_max took the weight of is refused by them.
  const auto refuseLost = [&](Refusal refusal) {
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      IndirectCandidate& candidate = explanation.candidates[c];
      if (candidate.weight == 0.0f || weights_[c * kClusterSize] != 0.0f) continue;
      candidate.weight = 0.0f;
      candidate.refusal = refusal;
    }
  };
  weigh(points);
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    Refusal refusal;
    ilvWeight(candidates_[c], point.position, point.normal, point.outgoing, rules_, refusal);
    const Vec3 away = point.position - candidates_[c].position;
    const float distance = std::sqrt(away.x * away.x + away.y * away.y + away.z * away.z);
    if (refusal == Refusal::None && !(distance <= point.reach)) refusal = Refusal::Clearance;
    explanation.candidates.push_back({found_[c], distance, weights_[c * kClusterSize], refusal,
                                      ilvExtrapolate(records[found_[c]], point.position, point.normal,
                                                     rules_.p, candidates_[c].gradientScale)});
  }
  chooseNearest(points, centre, radius, counts);
  refuseLost(Refusal::Visibility);
  dropBeyondLimits();
  refuseLost(Refusal::BeyondMost);
  answerFound(records, points, std::span(&explanation.answer, 1));
  return explanation;
}

DirectRefusal Answerer::refusalOf(const DirectLightVector& a, const QueryPoint& point, float cosLobe,
                                  float& squared) const {
  const Vec3 ab = point.position - a.point.position;
  squared = glm::dot(ab, ab);
  if (squared > dlvRadius_ * dlvRadius_) return DirectRefusal::Distance;
  if (1.0f - oneMinusCos(a.point.normal, point.normal) < static_cast<float>(parameters_.dlv.normalCosine))
    return DirectRefusal::Orientation;
  if (cosLobe > -1.5f && glm::dot(a.point.outgoing, point.outgoing) < cosLobe) return DirectRefusal::Lobe;
  return DirectRefusal::None;
}

float Answerer::directWeight(float squared) const {
  const float distance = std::sqrt(squared);
  return parameters_.dlv.weight == DlvWeight::Normalised
             ? dlvWeightNormalised(distance, dlvRadius_)
             : dlvWeightPrinted(distance * static_cast<float>(metresPerUnit_),
                                dlvRadius_ * static_cast<float>(metresPerUnit_));
}

void Answerer::findDirectCandidates(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                                    const Vec3& centre, float radius, std::size_t before) {
  records.query(key, centre, radius, found_);
  found_.erase(std::lower_bound(found_.begin(), found_.end(), before), found_.end());
  directCandidates_.clear();
  for (const std::uint32_t number : found_) directCandidates_.push_back(&records[number]);
}

void Answerer::answerDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                            std::span<const QueryPoint> points, const Vec3& centre, float radius,
                            float lobeWidth, std::span<DirectAnswer> answers) {
  LV_CHECK(points.size() <= kClusterSize, "{} points in a cluster", points.size());
  if (points.empty()) return;
  // All that r_max reaches may be most of a scene, where a point takes the n_max nearest: what is around it
  // is enough, where so many of that are valid. How far around, the points before are the best guess of.
  float found = 0.0f;
  const auto find = [&](float reach) {
    const float rounding = dlvRadius_ * 0x1p-20f;
    findDirectCandidates(records, key, centre, radius + (reach - dlvRadius_) + rounding, records.size());
    clusterCandidates_.swap(directCandidates_);
    found = reach;
  };
  float farthest = 0.0f;
  for (std::size_t begin = 0; begin < points.size(); begin += kLanes) {
    const std::size_t count = std::min(kLanes, points.size() - begin);
    float reach = std::min(directReach_, dlvRadius_);
    for (bool isWhole = false; !isWhole;) {
      if (found < reach) find(reach);
      keepInReach(points.subspan(begin, count), reach);
      judgeDirect(points.subspan(begin, count), lobeWidth);
      isWhole = reach >= dlvRadius_ || areNearestWithin(count, reach);
      if (!isWhole) reach = std::min(2.0f * reach, dlvRadius_);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (limits_[i] < kNoLimit) farthest = std::max(farthest, limits_[i]);
    }
    sumDirect(answers.subspan(begin, count));
  }
  directReach_ = farthest > 0.0f ? 1.25f * std::sqrt(farthest) : kInfinity;
}

bool Answerer::areNearestWithin(std::size_t count, float reach) const {
  const float within = reach * reach * (1.0f - 0x1p-16f);
  const int enough = std::max(parameters_.dlv.nMin, parameters_.dlv.nMax);
  bool all = true;
  for (std::size_t i = 0; i < count; ++i) all &= judgements_.valid[i] > enough && limits_[i] <= within;
  return all;
}

void Answerer::keepInReach(std::span<const QueryPoint> points, float reach) {
  const Ball ball = ballOf(points, [](const QueryPoint& point) { return point.position; });
  directCandidates_.clear();
  for (const DirectLightVector* a : clusterCandidates_) {
    const TreeEntry zone{a->point.position, reach};
    if (zone.meets(ball)) directCandidates_.push_back(a);
  }
}

void Answerer::judgeDirect(std::span<const QueryPoint> points, float lobeWidth) {
  const DlvParameters& p = parameters_.dlv;
  const float cosLobe = lobeWidth > 0.0f ? std::cos(lobeWidth) : -2.0f;
  ask(points, directCandidates_.size(), p.nMax);
  judgements_.clear(points_.lanes);
  for (std::size_t c = 0; c < directCandidates_.size(); ++c) {
    forLanes([&](const Lanes& lanes) { weighDirect(c, lanes); });
    if (cosLobe > -1.5f) refuseTurned(c, points, cosLobe);
  }
  countDirect();
  limitToNearest();
  dropBeyondLimits();
  disperse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    judgements_.verdict[i] = judgements_.valid[i] < p.nMin ? DirectVerdict::TooFew
                             : dlvDispersionAccepts(p, judgements_.mean[i], judgements_.variance[i])
                                 ? DirectVerdict::Accepted
                                 : DirectVerdict::Dispersed;
  }
}

/// refusalOf and directWeight, but for the lobe, the same operations in the same order.
void Answerer::weighDirect(std::size_t candidate, const Lanes& lanes) {
  const auto [begin, n] = lanes;
  const VectorPoint& a = directCandidates_[candidate]->point;
  const float farthest = dlvRadius_ * dlvRadius_;
  const auto leastCosine = static_cast<float>(parameters_.dlv.normalCosine);
  float* weights = &weights_[candidate * kClusterSize + begin];
  float* distances = &distances_[candidate * kClusterSize + begin];
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t p = begin + i;
    const float abx = points_.x[p] - a.position.x;
    const float aby = points_.y[p] - a.position.y;
    const float abz = points_.z[p] - a.position.z;
    const float squared = abx * abx + aby * aby + abz * abz;
    const float dnx = a.normal.x - points_.normalX[p];
    const float dny = a.normal.y - points_.normalY[p];
    const float dnz = a.normal.z - points_.normalZ[p];
    const float bend = 0.5f * (dnx * dnx + dny * dny + dnz * dnz);
    const bool valid = (squared <= farthest) & (1.0f - bend >= leastCosine) & (points_.reach[p] >= 0.0f);
    judgements_.hasVector[p] |= squared == 0.0f ? 1 : 0;
    distances[i] = valid ? squared : kInfinity;
    weights[i] = valid ? 1.0f : 0.0f;
  }
}

void Answerer::refuseTurned(std::size_t candidate, std::span<const QueryPoint> points, float cosLobe) {
  const Vec3& outgoing = directCandidates_[candidate]->point.outgoing;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(glm::dot(outgoing, points[i].outgoing) < cosLobe)) continue;
    distances_[candidate * kClusterSize + i] = kInfinity;
    weights_[candidate * kClusterSize + i] = 0.0f;
  }
}

void Answerer::countDirect() {
  forLanes([&](const Lanes& lanes) {
    for (std::size_t c = 0; c < directCandidates_.size(); ++c) {
      const float* weights = &weights_[c * kClusterSize + lanes.begin];
      const float* distances = &distances_[c * kClusterSize + lanes.begin];
      for (std::size_t i = 0; i < lanes.count; ++i) {
        const float squared = distances[i];
        float& nearest = judgements_.nearestSquared[lanes.begin + i];
        judgements_.valid[lanes.begin + i] += weights[i] != 0.0f ? 1 : 0;
        nearest = squared < nearest ? squared : nearest;
      }
    }
  });
}

void Answerer::disperse() {
  brightness_.clear();
  for (const DirectLightVector* a : directCandidates_)
    brightness_.push_back(paperBrightness(a->energy) + paperBrightness(a->lobeRadiance));
  const auto sum = [&](double* sums, const Lanes& lanes, const auto& term) {
    for (std::size_t c = 0; c < directCandidates_.size(); ++c) {
      const float* weights = &weights_[c * kClusterSize + lanes.begin];
      const auto brightness = static_cast<double>(brightness_[c]);
      for (std::size_t i = 0; i < lanes.count; ++i) {
        const double value = term(brightness, lanes.begin + i);
        sums[lanes.begin + i] += weights[i] != 0.0f ? value : 0.0;
      }
    }
    for (std::size_t i = lanes.begin; i < lanes.begin + lanes.count; ++i)
      sums[i] /= static_cast<double>(std::clamp(judgements_.valid[i], 1, most_));
  };
  forLanes([&](const Lanes& lanes) {
    sum(judgements_.mean, lanes, [](double brightness, std::size_t) { return brightness; });
    sum(judgements_.variance, lanes,
        [&](double brightness, std::size_t i) { return square(brightness - judgements_.mean[i]); });
  });
}

void Answerer::sumDirect(std::span<DirectAnswer> answers) {
  sums_.clear(points_.lanes);
  for (std::size_t c = 0; c < directCandidates_.size(); ++c) {
    forLanes([&](const Lanes& lanes) { addDirectVector(c, lanes); });
  }
  const auto at = [](const float(&sums)[3][kClusterSize], std::size_t i) {
    return Vec3(sums[0][i], sums[1][i], sums[2][i]);
  };
  for (std::size_t i = 0; i < points_.count; ++i) {
    DirectAnswer& answer = answers[i];
    answer = DirectAnswer{};
    answer.hasVector = judgements_.hasVector[i] != 0;
    answer.nearest = std::sqrt(judgements_.nearestSquared[i]);
    if (judgements_.verdict[i] == DirectVerdict::Accepted && !(sums_.weight[i] > 0.0f))
      judgements_.verdict[i] = DirectVerdict::NoWeight;
    answer.verdict = judgements_.verdict[i];
    if (answer.verdict != DirectVerdict::Accepted) continue;
    answer.accepted = true;
    answer.count = std::min(judgements_.valid[i], most_);
    answer.energy = at(sums_.energy, i) / sums_.weight[i];
    answer.lobeRadiance = at(sums_.lobe, i) / sums_.weight[i];
    answer.direction = at(sums_.direction, i) / sums_.weight[i];
    const float length = glm::length(answer.direction);
    if (parameters_.dlv.normaliseDirection && length > 0.0f) answer.direction /= length;
  }
}

void Answerer::addDirectVector(std::size_t candidate, const Lanes& lanes) {
  const auto [begin, n] = lanes;
  const float* ranked = &weights_[candidate * kClusterSize + begin];
  const float* squared = &distances_[candidate * kClusterSize + begin];
  if (std::none_of(ranked, ranked + n, [](float weight) { return weight != 0.0f; })) return;
  float weight[kLanes];
  if (parameters_.dlv.weight == DlvWeight::Normalised) {
    // directWeight without its branches, which would keep the loop from being vectorised.
    for (std::size_t i = 0; i < n; ++i) {
      const float distance = std::sqrt(ranked[i] != 0.0f ? squared[i] : 0.0f);
      const float value = dlvWeightNormalised(distance, dlvRadius_);
      weight[i] = ranked[i] != 0.0f ? value : 0.0f;
    }
  } else {
    for (std::size_t i = 0; i < n; ++i) weight[i] = ranked[i] != 0.0f ? directWeight(squared[i]) : 0.0f;
  }
  for (int channel = 0; channel < 3; ++channel) {
    const float own = directCandidates_[candidate]->energy[channel];
    const float lobe = directCandidates_[candidate]->lobeRadiance[channel];
    const float towards = directCandidates_[candidate]->direction[channel];
    float* energies = &sums_.energy[channel][begin];
    float* lobes = &sums_.lobe[channel][begin];
    float* directions = &sums_.direction[channel][begin];
    for (std::size_t i = 0; i < n; ++i) {
      energies[i] += weight[i] * own;
      lobes[i] += weight[i] * lobe;
      directions[i] += weight[i] * towards;
    }
  }
  for (std::size_t i = 0; i < n; ++i) sums_.weight[begin + i] += weight[i];
}

DirectExplanation Answerer::explainDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                                          const QueryPoint& point, const Vec3& centre, float radius,
                                          float lobeWidth, std::size_t before) {
  findDirectCandidates(records, key, centre, radius, before);
  DirectExplanation explanation;
  judgeDirect({&point, 1}, lobeWidth);
  sumDirect({&explanation.answer, 1});
  explanation.verdict = judgements_.verdict[0];
  explanation.valid = std::min(judgements_.valid[0], most_);
  const bool isTold = explanation.verdict == DirectVerdict::Accepted ||
                      explanation.verdict == DirectVerdict::Dispersed ||
                      explanation.verdict == DirectVerdict::NoWeight;
  if (isTold)
    explanation.dispersion = dlvDispersion(parameters_.dlv, judgements_.mean[0], judgements_.variance[0]);
  const float cosLobe = lobeWidth > 0.0f ? std::cos(lobeWidth) : -2.0f;
  for (std::size_t c = 0; c < directCandidates_.size(); ++c) {
    float squared;
    DirectRefusal refusal = refusalOf(*directCandidates_[c], point, cosLobe, squared);
    const bool isRanked = weights_[c * kClusterSize] != 0.0f;
    if (refusal == DirectRefusal::None && !isRanked) refusal = DirectRefusal::BeyondMost;
    const bool isUsed = isRanked && explanation.verdict == DirectVerdict::Accepted;
    explanation.candidates.push_back(
        {found_[c], std::sqrt(squared), isUsed ? directWeight(squared) : 0.0f, refusal});
  }
  return explanation;
}

}  // namespace lightvane
