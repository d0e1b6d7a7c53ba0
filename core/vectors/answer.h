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

struct DirectAnswer {
  bool accepted = false;
  Rgb energy{0.0f};
  Rgb lobeRadiance{0.0f};
  Vec3 direction{0.0f};
  int count = 0;
};

/// Answers points from a snapshot. The hot loop: the tree is asked once a cluster, candidates are tested and
/// weighed against its points in arrays. Weights are summed in the order of the vectors' numbers, so that
/// every way to find candidates gives the same bytes. One a thread.
class Answerer {
 public:
  Answerer(const Tracer& tracer, const VectorParameters& parameters);

  const IlvRules& rules() const { return rules_; }
  float dlvRadius() const { return dlvRadius_; }

  /// Indirect answers for points of one key. `centre` and `radius` bound them.
  void answerIndirect(const RecordSet<IndirectLightVector>& records, SurfaceKey key,
                      std::span<const QueryPoint> points, const Vec3& centre, float radius,
                      std::span<IndirectAnswer> answers, RayCounts& counts);

  /// One light's direct answers for points of one key.
  void answerDirect(const RecordSet<DirectLightVector>& records, SurfaceKey key,
                    std::span<const QueryPoint> points, const Vec3& centre, float radius, float lobeWidth,
                    std::span<DirectAnswer> answers);

 private:
  void weigh(std::span<const QueryPoint> points);
  void testVisibility(std::span<const QueryPoint> points, RayCounts& counts);
  void keepNearest(std::size_t points);

  const Tracer& tracer_;
  VectorParameters parameters_;
  IlvRules rules_;
  float dlvRadius_;
  double metresPerUnit_;
  std::vector<std::uint32_t> found_;
  std::vector<IlvCandidate> candidates_;
  std::vector<float> weights_;    ///< [candidate * kClusterSize + point]
  std::vector<float> distances_;  ///< squared, likewise
  std::vector<std::pair<float, std::uint32_t>> ranking_;
};

}  // namespace lightvane
