#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/trace/direct_light.h"
#include "core/vectors/snapshot.h"

namespace lightvane {

/// Points that are answered together, at most.
inline constexpr std::size_t kClusterSize = 64;

/// A point as the answering loops see it.
struct QueryPoint {
  Vec3 position;
  Vec3 normal;  ///< shading, viewer's side
  Vec3 geometricNormal;
  Vec3 outgoing;
  float offset;             ///< SurfacePoint::offset
  float reach = kInfinity;  ///< vectors farther away are refused: see ilv.clearance
};

/// What the valid vectors say about a point.
struct IndirectAnswer {
  Rgb energy{0.0f};                     ///< weighted mean of what IndirectLightVector::energy is
  Vec3 direction{0.0f};                 ///< weighted mean of D, unit; zero where nothing was found
  float weight = 0.0f;                  ///< sum of the weights
  int count = 0;                        ///< vectors used
  std::uint32_t nearest = 0xffffffffU;  ///< number of the nearest vector used
};

/// How far the vectors that answer a point are from each other.
struct IndirectSpread {
  /// Of what one vector says, about its mean, by colour: each vector against the weighted mean of the others,
  /// e_i - E_-i = (e_i - E) / (1 - p_i), where p_i is its part of the weights; that differs by the scatter of
  /// one vector and of that mean, whence sum p_i (e_i - E)^2 / (1 - sum p_i^2).
  Rgb ofOne{0.0f};
  float share = 1.0f;    ///< sum p_i^2: the mean's variance is that part of a vector's
  bool isKnown = false;  ///< two or more vectors answer
};

/// Why an answer from DLVs was given or not.
enum class DirectVerdict : std::uint8_t { Accepted, TooFew, Dispersed, NoWeight };

struct DirectAnswer {
  bool accepted = false;
  DirectVerdict verdict = DirectVerdict::TooFew;
  bool hasVector = false;     ///< a vector of this key is at the point's very position, valid or not
  float nearest = kInfinity;  ///< distance to the nearest valid vector, normalised units
  Rgb energy{0.0f};
  Rgb lobeRadiance{0.0f};
  Vec3 direction{0.0f};
  int count = 0;
};

/// How one ILV fared at one point.
struct IndirectCandidate {
  std::uint32_t number;
  float distance;
  float weight;     ///< 0 where it was not used
  Refusal refusal;  ///< None with weight 0: valid, at the very edge of its validity
  Rgb energy;       ///< what it predicts for the point, extrapolated where the rules
                    ///< say so
};

/// The rule that keeps a DLV from a point (section 4.2.1).
enum class DirectRefusal : std::uint8_t { None, Distance, Orientation, Lobe, BeyondMost };

/// How one DLV fared at one point.
struct DirectCandidate {
  std::uint32_t number;
  float distance;
  float weight;  ///< 0 where it was not used
  DirectRefusal refusal;
};

/// An answer and how it came about.
struct IndirectExplanation {
  IndirectAnswer answer;
  std::vector<IndirectCandidate> candidates;  ///< in the order of their numbers
};
struct DirectExplanation {
  DirectAnswer answer;
  DirectVerdict verdict = DirectVerdict::TooFew;
  int valid = 0;                            ///< neighbours that DirectVerdict is about, at most n_max
  double dispersion = 0.0;                  ///< in the measure of dlv.dispersion_measure; 0
                                            ///< where there were too few
  std::vector<DirectCandidate> candidates;  ///< in the order of their numbers
};

/// The ray that has to be free for vector `a` to serve point `b`, `distance`
/// away from it. False where they are too near for a ray between them.
bool visibilityRay(const IlvCandidate& a, const QueryPoint& b, float distance, Ray& ray);

/// Answers points from a snapshot. The hot loop: the tree is asked once a
/// cluster, candidates are tested and weighed against its points in arrays.
/// Visibility rays go to the n_max nearest only, and on to others in place of
/// those that are hidden. Weights are summed in the order of the vectors'
/// numbers, so that every way to find candidates gives the same bytes. One a
/// thread.
class Answerer {
 public:
  Answerer(const Tracer& tracer, const VectorParameters& parameters);

  const IlvRules& rules() const { return rules_; }
  float dlvRadius() const { return dlvRadius_; }

  /// Indirect answers for points of one key. `centre` and `radius` bound them.
  void answerIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                      std::span<const QueryPoint> points, const Vec3& centre, float radius,
                      std::span<IndirectAnswer> answers, RayCounts& counts);
  /// The spreads of the answers that answerIndirect gave last, for the same records and points.
  void spreadIndirect(const RecordSet<IndirectLightVector>& records, std::span<const QueryPoint> points,
                      std::span<const IndirectAnswer> answers, std::span<IndirectSpread> spreads) const;

  /// One light's direct answers for points of one key.
  void answerDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                    std::span<const QueryPoint> points, const Vec3& centre, float radius, float lobeWidth,
                    std::span<DirectAnswer> answers);

  /// The answer of one point by the same steps, and what every step made of
  /// every candidate. Only vectors numbered below `before` take part: what was
  /// known when they were all. `centre` and `radius` bound the candidates as
  /// above; the answer is the same for all balls that hold the point.
  IndirectExplanation explainIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                                      const QueryPoint& point, const Vec3& centre, float radius,
                                      std::size_t before, RayCounts& counts);
  DirectExplanation explainDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                                  const QueryPoint& point, const Vec3& centre, float radius, float lobeWidth,
                                  std::size_t before);

 private:
  /// Points that a loop works on at once: two vector registers wide.
  static constexpr std::size_t kLanes = 16;
  static constexpr std::size_t kRegister = 8;
  static_assert(kClusterSize % kLanes == 0 && kLanes % kRegister == 0);

  /// A cluster's points by coordinate, so that a candidate is held against
  /// several of them at once.
  struct PointArrays {
    void set(std::span<const QueryPoint> points);

    std::size_t count = 0;
    std::size_t lanes = 0;  ///< `count` up to a multiple of kRegister; those
                            ///< beyond repeat the last point
    alignas(32) float x[kClusterSize], y[kClusterSize], z[kClusterSize];
    alignas(32) float normalX[kClusterSize], normalY[kClusterSize], normalZ[kClusterSize];
    alignas(32) float geometricX[kClusterSize], geometricY[kClusterSize], geometricZ[kClusterSize];
    alignas(32) float offset[kClusterSize], reach[kClusterSize];
  };

  /// Rays from some of the points to a candidate; those of which `asked` is 0
  /// are not wanted.
  struct VisibilityRays {
    static_assert(kLanes == kShadowPacketWidth);
    VisibilityRays();

    ShadowPacket packet;
    alignas(32) float endX[kLanes], endY[kLanes], endZ[kLanes];
    alignas(32) std::int32_t asked[kLanes];
    std::int32_t count;  ///< of those asked
  };

  /// Some of a cluster's points. How many they are is not told to the compiler:
  /// GCC 12 unrolls loops of a few rounds before it could vectorise them.
  struct Lanes {
    std::size_t begin;
    std::size_t count;  ///< at most kLanes
  };

  /// Looks for the distance within which a point has n_max vectors, for some points at once, where sorting
  /// would take them one by one: narrows an interval whose ends are distances of vectors, by what is within
  /// its middle, until its upper end has so many, or is the least that has more (equally far ones).
  struct LimitSearch {
    /// What the middle parts, by point.
    struct Split {
      std::int32_t within[kLanes] = {};
      float below[kLanes] = {};  ///< the largest within
      float above[kLanes];       ///< the least beyond
      Split() { std::fill_n(above, kLanes, kInfinity); }
    };
    static constexpr std::int32_t kOneByOne = 3;

    float low[kLanes], high[kLanes] = {};  ///< squared distances
    std::int32_t atHigh[kLanes] = {};      ///< vectors within the upper end
    float middle[kLanes];
    bool open = false;  ///< not found for all of them

    void narrow(std::size_t count, const Split& split, std::int32_t most);
    void findMiddle(std::size_t count, std::int32_t most);
  };

  /// The sums of which answers are made, by point.
  struct Sums {
    void clear(std::size_t lanes);

    alignas(32) float energy[3][kClusterSize], lobe[3][kClusterSize], direction[3][kClusterSize];
    alignas(32) float weight[kClusterSize];
    alignas(32) float nearestSquared[kClusterSize];
    alignas(32) std::int32_t count[kClusterSize];
    alignas(32) std::uint32_t nearest[kClusterSize];
  };

  /// What DLVs are to the points, by point.
  struct Judgements {
    void clear(std::size_t lanes);

    alignas(64) double mean[kClusterSize], variance[kClusterSize];  ///< of the brightness of those ranked
    alignas(32) std::int32_t valid[kClusterSize];                   ///< ranked or beyond n_max
    alignas(32) std::int32_t hasVector[kClusterSize];               ///< DirectAnswer::hasVector
    alignas(32) float nearestSquared[kClusterSize];                 ///< to the nearest of the valid
    DirectVerdict verdict[kClusterSize];
  };

  /// Makes room for a cluster's points and so many candidates, of which a point takes `most`.
  void ask(std::span<const QueryPoint> points, std::size_t candidateCount, int most);
  void findCandidates(const RecordSet<IndirectLightVector>& records, SurfaceKey key, const Vec3& centre,
                      float radius, std::size_t before);
  void weigh(std::span<const QueryPoint> points);
  void weighRefined(const IlvCandidate& a, float* weights, float* distances) const;
  /// Finds for every point the n_max nearest candidates that it sees: sets
  /// limits_, and takes the weight of those that are hidden. The others are not
  /// asked.
  void chooseNearest(std::span<const QueryPoint> points, const Vec3& centre, float radius, RayCounts& counts);
  /// Sets clearSpace_ for rays between the points, which lie in a ball of this centre and radius, and the
  /// candidates.
  void findClearSpace(std::span<const QueryPoint> points, const Vec3& centre, float radius);
  void limitToNearest();
  void limitToNearest(const Lanes& lanes);
  LimitSearch rangeOfDistances(const Lanes& lanes) const;
  /// Asks candidates within the limits, but for those that were asked before.
  /// True where one is hidden and another may take its place.
  bool testVisibility(RayCounts& counts);
  void aim(std::size_t candidate, const Lanes& lanes, VisibilityRays& rays) const;
  /// Asks no ray where the first `n` lanes' ends see each other for sure. False where none is left.
  bool dropClear(std::size_t n, VisibilityRays& rays) const;
  void dropBeyondLimits();
  void dropBeyondLimits(const Lanes& lanes);
  template <class Work>
  void forLanes(const Work& work) const;
  void answerFound(const RecordSet<IndirectLightVector>& records, std::span<const QueryPoint> points,
                   std::span<IndirectAnswer> answers);
  void addVector(const IndirectLightVector& record, std::size_t candidate, const Lanes& lanes);
  void findDirectCandidates(const RecordSet<DirectLightVector>& records, SurfaceKey key, const Vec3& centre,
                            float radius, std::size_t before);
  /// Takes those of clusterCandidates_ for candidates that are within `reach` of one of the points, perhaps.
  void keepInReach(std::span<const QueryPoint> points, float reach);
  /// Whether the first `count` points have as many valid candidates as they take, all of them so near.
  bool areNearestWithin(std::size_t count, float reach) const;
  /// Ranks the candidates for every point, and says whether their answer would be accepted: sets judgements_,
  /// and the weights of those that are ranked to 1.
  void judgeDirect(std::span<const QueryPoint> points, float lobeWidth);
  void weighDirect(std::size_t candidate, const Lanes& lanes);
  void refuseTurned(std::size_t candidate, std::span<const QueryPoint> points, float cosLobe);
  void countDirect();
  void disperse();
  /// The answers of the points that are accepted.
  void sumDirect(std::span<DirectAnswer> answers);
  void addDirectVector(std::size_t candidate, const Lanes& lanes);
  DirectRefusal refusalOf(const DirectLightVector& a, const QueryPoint& point, float cosLobe,
                          float& squared) const;
  float directWeight(float squared) const;

  const Tracer& tracer_;
  VectorParameters parameters_;
  IlvRules rules_;
  float dlvRadius_;
  double metresPerUnit_;
  std::vector<std::uint32_t> found_;
  PointArrays points_;
  std::vector<IlvCandidate> candidates_;
  std::vector<float> weights_;              ///< [candidate * kClusterSize + point]; 0 where
                                            ///< it does not serve the point
  std::vector<float> distances_;            ///< likewise: squared; infinity where it does
                                            ///< not serve the point
  alignas(32) float limits_[kClusterSize];  ///< squared distance to the n_max-th
                                            ///< nearest that serve a point
  alignas(32) float tested_[kClusterSize];  ///< squared distance up to which
                                            ///< visibility is known
  VisibilityRays visibilityRays_;
  ClearSpace clearSpace_{Vec3(0.0f), 0.0f, 0.0f};
  Sums sums_;
  std::size_t candidateCount_ = 0;  ///< rows of weights_ and distances_
  std::int32_t most_ = 0;           ///< n_max of what is asked
  std::vector<const DirectLightVector*> directCandidates_;
  std::vector<const DirectLightVector*> clusterCandidates_;
  float directReach_ = kInfinity;  ///< within which the cluster before had all that it took
  std::vector<float> brightness_;  ///< of directCandidates_
  Judgements judgements_;
};

}  // namespace lightvane
