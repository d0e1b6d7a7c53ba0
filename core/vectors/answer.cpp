#include "core/vectors/answer.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"

namespace lightvane {
namespace {

/// Points by coordinate, so that one candidate is weighed against eight of them at once.
struct PointArrays {
  alignas(32) float x[kClusterSize], y[kClusterSize], z[kClusterSize];
  alignas(32) float nx[kClusterSize], ny[kClusterSize], nz[kClusterSize];
  alignas(32) float reach[kClusterSize];
};

/// ilvWeight for the refined rules without a lobe, the same operations in the same order, over all points at
/// once.
void weighRefined(const IlvCandidate& a, const IlvRules& rules, const PointArrays& points, std::size_t count,
                  float* weights, float* distances) {
  const float limit = 1.0f - rules.sCurv;
  const float inFront = rules.p.inFront ? 1.0f : 0.0f;
  for (std::size_t i = 0; i < count; ++i) {
    const float abx = points.x[i] - a.position.x;
    const float aby = points.y[i] - a.position.y;
    const float abz = points.z[i] - a.position.z;
    const float squared = abx * abx + aby * aby + abz * abz;
    const float distance = std::sqrt(squared);
    const float dnx = a.normal.x - points.nx[i];
    const float dny = a.normal.y - points.ny[i];
    const float dnz = a.normal.z - points.nz[i];
    const float bend = 0.5f * (dnx * dnx + dny * dny + dnz * dnz);
    const float mx = 0.5f * (a.normal.x + points.nx[i]);
    const float my = 0.5f * (a.normal.y + points.ny[i]);
    const float mz = 0.5f * (a.normal.z + points.nz[i]);
    const float height = inFront * (abx * mx + aby * my + abz * mz);
    const float far = distance * a.inverseRadius;
    const float bent = std::sqrt(bend * rules.inverseCurv);
    const float worst = far < bent ? bent : far;  // as std::max has it where bent is 0/0 (S_curv = 1)
    float weight = 1.0f - worst;
    weight = weight > 0.0f ? weight : 0.0f;
    const bool valid = (distance <= a.radius) & (distance <= points.reach[i]) & (bend <= limit) &
                       (height >= -(kInFrontSlope * distance + kInFrontRounding));
    weights[i] = valid ? weight : 0.0f;
    distances[i] = squared;
  }
}

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

void Answerer::weigh(std::span<const QueryPoint> points) {
  weights_.resize(candidates_.size() * kClusterSize);
  distances_.resize(candidates_.size() * kClusterSize);
  PointArrays arrays;
  for (std::size_t i = 0; i < points.size(); ++i) {
    arrays.x[i] = points[i].position.x;
    arrays.y[i] = points[i].position.y;
    arrays.z[i] = points[i].position.z;
    arrays.nx[i] = points[i].normal.x;
    arrays.ny[i] = points[i].normal.y;
    arrays.nz[i] = points[i].normal.z;
    arrays.reach[i] = points[i].reach;
  }
  const bool refined = isRefinedWeight(rules_.p);
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const IlvCandidate& a = candidates_[c];
    float* weights = &weights_[c * kClusterSize];
    float* distances = &distances_[c * kClusterSize];
    if (refined && a.cosLobe < -1.5f) {
      weighRefined(a, rules_, arrays, points.size(), weights, distances);
      continue;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      Refusal refusal;
      const Vec3 ab = points[i].position - a.position;
      distances[i] = ab.x * ab.x + ab.y * ab.y + ab.z * ab.z;
      const float weight =
          ilvWeight(a, points[i].position, points[i].normal, points[i].outgoing, rules_, refusal);
      const bool valid = refusal == Refusal::None && std::sqrt(distances[i]) <= points[i].reach;
      weights[i] = valid ? weight : 0.0f;
    }
  }
}

bool visibilityRay(const IlvCandidate& a, const QueryPoint& b, float distance, Ray& ray) {
  // On a curved surface the chord runs inside: both ends are raised by its sagitta, d * angle / 8.
  const float angle = std::sqrt(2.0f * oneMinusCos(a.normal, b.normal));
  const float lift = 2.0f * b.offset + 0.15f * angle * distance;
  const Vec3 from = b.position + lift * b.geometricNormal;
  const Vec3 way = a.position + lift * a.normal - from;
  const float length = glm::length(way);
  if (!(length > 4.0f * b.offset)) return false;
  ray = {from, way / length, 0.0f, length * (1.0f - 0x1p-12f)};
  return true;
}

void Answerer::testVisibility(std::span<const QueryPoint> points, RayCounts& counts) {
  ShadowPacket packet;
  float* tested[kShadowPacketWidth];
  int lanes = 0;
  const auto flush = [&] {
    if (lanes == 0) return;
    tracer_.occluded(packet, lanes, Coherence::Coherent);
    counts.visibility += static_cast<std::uint64_t>(lanes);
    for (int lane = 0; lane < lanes; ++lane) {
      if (packet.isOccluded(lane)) *tested[lane] = 0.0f;
    }
    lanes = 0;
  };
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const IlvCandidate& a = candidates_[c];
    const float within = a.visibleWithin * a.visibleWithin;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t pair = c * kClusterSize + i;
      if (weights_[pair] == 0.0f || distances_[pair] <= within) continue;
      Ray ray;
      if (!visibilityRay(a, points[i], std::sqrt(distances_[pair]), ray)) continue;
      packet.set(lanes, ray);
      tested[lanes++] = &weights_[pair];
      if (lanes == kShadowPacketWidth) flush();
    }
  }
  flush();
}

void Answerer::keepNearest(std::size_t points) {
  const auto most = static_cast<std::size_t>(rules_.p.nMax);
  if (candidates_.size() <= most) return;
  for (std::size_t i = 0; i < points; ++i) {
    ranking_.clear();
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const std::size_t pair = c * kClusterSize + i;
      if (weights_[pair] != 0.0f) ranking_.emplace_back(distances_[pair], static_cast<std::uint32_t>(c));
    }
    if (ranking_.size() <= most) continue;
    std::nth_element(ranking_.begin(), ranking_.begin() + static_cast<std::ptrdiff_t>(most), ranking_.end());
    for (std::size_t r = most; r < ranking_.size(); ++r)
      weights_[ranking_[r].second * kClusterSize + i] = 0.0f;
  }
}

void Answerer::answerIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                              std::span<const QueryPoint> points, const Vec3& centre, float radius,
                              std::span<IndirectAnswer> answers, RayCounts& counts) {
  LV_CHECK(points.size() <= kClusterSize, "{} points in a cluster", points.size());
  records.query(key, centre, radius, found_);
  candidates_.clear();
  for (const std::uint32_t number : found_) candidates_.push_back(makeCandidate(records[number], rules_));
  weigh(points);
  if (rules_.p.visibility) testVisibility(points, counts);
  keepNearest(points.size());
  answerFound(records, points, answers);
}

void Answerer::answerFound(const RecordSet<IndirectLightVector>& records, std::span<const QueryPoint> points,
                           std::span<IndirectAnswer> answers) {
  float nearest[kClusterSize];
  for (std::size_t i = 0; i < points.size(); ++i) {
    answers[i] = IndirectAnswer{};
    nearest[i] = kInfinity;
  }
  for (std::size_t c = 0; c < candidates_.size(); ++c) {
    const IndirectLightVector& record = records[found_[c]];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::size_t pair = c * kClusterSize + i;
      const float weight = weights_[pair];
      if (weight == 0.0f) continue;
      IndirectAnswer& answer = answers[i];
      answer.energy += weight * ilvExtrapolate(record, points[i].position, points[i].normal, rules_.p,
                                               candidates_[c].gradientScale);
      answer.direction += weight * record.direction;
      answer.weight += weight;
      ++answer.count;
      if (distances_[pair] < nearest[i]) {
        nearest[i] = distances_[pair];
        answer.nearest = found_[c];
      }
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    IndirectAnswer& answer = answers[i];
    if (answer.count == 0) continue;
    answer.energy /= answer.weight;
    const float length = glm::length(answer.direction);
    answer.direction = length > 0.0f ? answer.direction / length : points[i].normal;
  }
}

IndirectExplanation Answerer::explainIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                                              const QueryPoint& point, const Vec3& centre, float radius,
                                              std::size_t before, RayCounts& counts) {
  const std::span<const QueryPoint> points(&point, 1);
  records.query(key, centre, radius, found_);
  std::erase_if(found_, [&](std::uint32_t number) { return number >= before; });
  candidates_.clear();
  for (const std::uint32_t number : found_) candidates_.push_back(makeCandidate(records[number], rules_));

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
    const float distance = std::sqrt(distances_[c * kClusterSize]);
    if (refusal == Refusal::None && !(distance <= point.reach)) refusal = Refusal::Clearance;
    explanation.candidates.push_back({found_[c], distance, weights_[c * kClusterSize], refusal,
                                      ilvExtrapolate(records[found_[c]], point.position, point.normal,
                                                     rules_.p, candidates_[c].gradientScale)});
  }
  if (rules_.p.visibility) testVisibility(points, counts);
  refuseLost(Refusal::Visibility);
  keepNearest(1);
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

void Answerer::answerDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                            std::span<const QueryPoint> points, const Vec3& centre, float radius,
                            float lobeWidth, std::span<DirectAnswer> answers) {
  records.query(key, centre, radius, found_);
  const float cosLobe = lobeWidth > 0.0f ? std::cos(lobeWidth) : -2.0f;
  double dispersion = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
    answerDirectPoint(records, points[i], cosLobe, answers[i], dispersion);
}

DirectVerdict Answerer::answerDirectPoint(const RecordSet<DirectLightVector>& records,
                                          const QueryPoint& point, float cosLobe, DirectAnswer& answer,
                                          double& dispersion) {
  const DlvParameters& p = parameters_.dlv;
  answer = DirectAnswer{};
  ranking_.clear();
  for (const std::uint32_t number : found_) {
    float squared;
    if (refusalOf(records[number], point, cosLobe, squared) == DirectRefusal::None)
      ranking_.emplace_back(squared, number);
  }
  if (ranking_.size() < static_cast<std::size_t>(p.nMin)) return DirectVerdict::TooFew;
  if (ranking_.size() > static_cast<std::size_t>(p.nMax)) {
    std::nth_element(ranking_.begin(), ranking_.begin() + p.nMax, ranking_.end());
    ranking_.resize(static_cast<std::size_t>(p.nMax));
  }
  std::sort(ranking_.begin(), ranking_.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });

  double mean = 0.0;
  for (const auto& [squared, number] : ranking_) {
    mean += paperBrightness(records[number].energy) + paperBrightness(records[number].lobeRadiance);
  }
  mean /= static_cast<double>(ranking_.size());
  double variance = 0.0;
  for (const auto& [squared, number] : ranking_) {
    variance += square(static_cast<double>(paperBrightness(records[number].energy) +
                                           paperBrightness(records[number].lobeRadiance)) -
                       mean);
  }
  variance /= static_cast<double>(ranking_.size());
  dispersion = dlvDispersion(p, mean, variance);
  if (!dlvDispersionAccepts(p, mean, variance)) return DirectVerdict::Dispersed;

  float sum = 0.0f;
  for (const auto& [squared, number] : ranking_) {
    const DirectLightVector& a = records[number];
    const float weight = directWeight(squared);
    sum += weight;
    answer.energy += weight * a.energy;
    answer.lobeRadiance += weight * a.lobeRadiance;
    answer.direction += weight * a.direction;
  }
  if (!(sum > 0.0f)) {
    answer = DirectAnswer{};
    return DirectVerdict::NoWeight;
  }
  answer.accepted = true;
  answer.count = static_cast<int>(ranking_.size());
  answer.energy /= sum;
  answer.lobeRadiance /= sum;
  answer.direction /= sum;
  const float length = glm::length(answer.direction);
  if (p.normaliseDirection && length > 0.0f) answer.direction /= length;
  return DirectVerdict::Accepted;
}

DirectExplanation Answerer::explainDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                                          const QueryPoint& point, const Vec3& centre, float radius,
                                          float lobeWidth, std::size_t before) {
  records.query(key, centre, radius, found_);
  std::erase_if(found_, [&](std::uint32_t number) { return number >= before; });
  const float cosLobe = lobeWidth > 0.0f ? std::cos(lobeWidth) : -2.0f;
  DirectExplanation explanation;
  explanation.verdict =
      answerDirectPoint(records, point, cosLobe, explanation.answer, explanation.dispersion);
  explanation.valid = static_cast<int>(ranking_.size());
  for (const std::uint32_t number : found_) {
    float squared;
    DirectRefusal refusal = refusalOf(records[number], point, cosLobe, squared);
    const bool isRanked = std::any_of(ranking_.begin(), ranking_.end(),
                                      [&](const auto& ranked) { return ranked.second == number; });
    if (refusal == DirectRefusal::None && !isRanked) refusal = DirectRefusal::BeyondMost;
    const bool isUsed = isRanked && explanation.verdict == DirectVerdict::Accepted;
    explanation.candidates.push_back(
        {number, std::sqrt(squared), isUsed ? directWeight(squared) : 0.0f, refusal});
  }
  return explanation;
}

}  // namespace lightvane
