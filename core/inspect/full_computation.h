#pragma once

#include <string>
#include <vector>

#include "core/base/tasks.h"
#include "core/render/render_frame.h"

namespace lightvane {

/// Why a value differs from the full computation with many samples; the three add up to the difference.
struct DifferenceParts {
  /// Shown minus what the vectors of the point itself say, computed with the frame's samples.
  Vec3d interpolation{0.0};
  /// What the point's own vectors say minus the truth, as far as their irradiance is to blame: too few cells
  /// or shadow rays. Of light that is sampled and not interpolated, all of the difference.
  Vec3d noise{0.0};
  /// The rest of it: what comes of a lobe's light being one energy along one direction (P = L / f(D), eq. 4),
  /// with the cells' own error within the lobe. None where the store is `split`, and none without a lobe.
  Vec3d singleDirection{0.0};

  Vec3d sum() const { return interpolation + noise + singleDirection; }
  DifferenceParts& operator+=(const DifferenceParts& other) {
    interpolation += other.interpolation;
    noise += other.noise;
    singleDirection += other.singleDirection;
    return *this;
  }
};

/// A value of the picture beside its own full computation. Scene units, weighted by the throughput of the
/// way.
struct FullValue {
  Vec3d shown{0.0};
  Vec3d full{0.0};
  DifferenceParts parts;

  FullValue& operator+=(const FullValue& other) {
    shown += other.shown;
    full += other.full;
    parts += other.parts;
    return *this;
  }
};

/// A pixel computed in full: what its visible points reflect. Lights and the sky, seen straight or in
/// mirrors, are exact in the picture and left out on both sides.
struct FullComputation {
  bool finished = false;  ///< not stopped, and there was something to compute
  std::string note;       ///< why not, or what to mind; often empty
  int samples = 0;        ///< for each light, and for indirect light, at each point
  FullValue direct;
  FullValue mirrored;  ///< light of lights by way of planar mirrors, which is sampled like direct light
  FullValue indirect;  ///< the rest of what was reflected
  FullValue total;
  Vec3d standardError{0.0};  ///< of total.full
  RayCounts rays;
};

/// Computes a pixel with about `samples` stratified samples (at least 32) of each light and of indirect
/// light, at each of its visible points, and says where the difference from the picture comes from. `x`, `y`
/// count in the region's picture. Deterministic: a function of the frame, the pixel and `samples`. Any
/// thread. Cost: some 5 us a sample and point; ends within milliseconds when `stop` is set, with `finished`
/// false.
FullComputation computeHere(const RenderFrame& frame, int x, int y, int samples, const StopFlag& stop);

/// The parts of one value's difference, where `own` is what the point's own vector says and irradiances are
/// on the point: of that vector, and of many samples. `hasDirection`: the value was represented by one
/// direction.
DifferenceParts differenceParts(const Vec3d& shown, const Vec3d& own, const Vec3d& ownIrradiance,
                                const Vec3d& fullIrradiance, const Vec3d& full, bool hasDirection);

}  // namespace lightvane
