#pragma once

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/base/tasks.h"
#include "core/inspect/exact_vectors.h"
#include "core/inspect/explain_point.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// Why a value differs from the truth; the parts add up to the difference. They are a ladder from the picture
/// to the truth, on which each step sets one thing right and leaves the rest as it is.
struct DifferenceParts {
  /// The same vectors with the same weights, but each computed with many samples. Of light that is sampled
  /// and not interpolated, all of the difference.
  Vec3d noise{0.0};
  /// Without the vectors that something hides from the point.
  Vec3d leaks{0.0};
  /// With a vector of the point's own in place of all others.
  Vec3d interpolation{0.0};
  /// What of that step comes of a lobe's light being one energy along one direction (P = L / f(D), eq. 4):
  /// all that irradiance is not to blame for. None where the store is `split`, and none without a lobe.
  Vec3d singleDirection{0.0};
  /// With all reflections, where path.max_bounces ends them early.
  Vec3d missingBounces{0.0};

  Vec3d sum() const { return noise + leaks + interpolation + singleDirection + missingBounces; }
  DifferenceParts& operator+=(const DifferenceParts& other);
  DifferenceParts& operator*=(double factor);
};

/// A value of the picture beside its own full computation. Scene units, weighted by the throughput of the
/// way.
struct FullValue {
  Vec3d shown{0.0};
  Vec3d full{0.0};
  DifferenceParts parts;

  FullValue& operator+=(const FullValue& other);
  FullValue& operator*=(double factor);
};

/// What a pixel's visible points reflect. Lights and the sky, seen straight or in mirrors, are exact in the
/// picture and left out on both sides.
struct FullValues {
  FullValue direct;
  FullValue mirrored;  ///< light of lights by way of planar mirrors, which is sampled like direct light
  FullValue indirect;  ///< the rest of what was reflected

  FullValue total() const;
};

/// A pixel computed in full.
struct FullComputation {
  bool finished = false;  ///< not stopped, and there was something to compute
  std::string note;       ///< why not, or what to mind; often empty
  int samples = 0;        ///< for each light, and for indirect light, at each point
  FullValues values;
  FullValue total;
  /// The same by half of the samples each. The halves share nothing but what the picture shows.
  std::array<FullValues, 2> halves;
  Vec3d standardError{0.0};  ///< of total.full
  RayCounts rays;
};

/// Computes pixels of a frame in full, which must have vectors. Refers to all that it is given. One a thread.
class FullComputer {
 public:
  /// `samples`: of each light and of indirect light, at each of a pixel's points, stratified; at least 32.
  FullComputer(const RenderFrame& frame, int samples, const StopFlag& stop);
  FullComputer(FullComputer&&) noexcept;
  ~FullComputer();

  int samples() const;
  /// Why there is nothing to compute at that pixel of the region's picture; empty where there is.
  static std::string obstacle(const RenderFrame& frame, int x, int y);
  /// Adds the vectors that have a share in the pixel.
  void findShares(int x, int y, std::set<RecordRef>& shares);
  /// The pixel, of which `exact` has all vectors that have a share in it. Pure, but for the flag; see
  /// computeHere.
  FullComputation compute(int x, int y, const ExactVectors& exact);

 private:
  class Points;
  std::unique_ptr<Points> points_;
};

/// Computes a pixel with about `samples` stratified samples (at least 32) of each light and of indirect
/// light, at each of its visible points, and says where the difference from the picture comes from. `x`, `y`
/// count in the region's picture. Deterministic: a function of the frame, the pixel and `samples`. Any
/// thread. Cost: some 5 us a sample and point, and some 10 ms for each vector that has a share in the pixel;
/// ends within milliseconds when `stop` is set, with `finished` false.
FullComputation computeHere(const RenderFrame& frame, int x, int y, int samples, const StopFlag& stop);

/// Light on a point that vectors gave, beside what it is: radiance towards the viewer, and irradiance.
struct LightAtPoint {
  Vec3d radiance{0.0};
  Vec3d irradiance{0.0};
};
/// The last steps of the ladder, up to where the point's own vector stands for all others: interpolation and
/// singleDirection. `hasDirection`: the light was represented by one direction.
DifferenceParts interpolationParts(const LightAtPoint& interpolated, const LightAtPoint& own,
                                   bool hasDirection);

}  // namespace lightvane
