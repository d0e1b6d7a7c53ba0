#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/trace/radiance.h"
#include "tests/support/statistics.h"

namespace lightvane::trace_test {

/// Blocks of equally many samples, each block the mean of `sample(block, index)`.
template <class Sample>
std::vector<double> blockMeans(std::size_t blocks, std::size_t samples, const Sample& sample) {
  std::vector<double> means(blocks, 0.0);
  for (std::size_t b = 0; b < blocks; ++b) {
    for (std::size_t s = 0; s < samples; ++s) means[b] += sample(b, s) / static_cast<double>(samples);
  }
  return means;
}

/// Passes where the mean of the blocks is `reference` within `tolerance` (a fraction of it) at 99.9 %
/// confidence, and where the test is sharp enough to refuse the same blocks with a bias injected: 1 %, or
/// twice the tolerance where that is more. A test that cannot see such a bias proves nothing.
inline void expectUnbiased(const std::vector<double>& blocks, double reference, const std::string& what,
                           double tolerance = 0.005, double referenceStandardError = 0.0) {
  const BiasTest test{.tolerance = tolerance};
  const BiasTest::Result result = test.againstValue(blocks, reference, referenceStandardError);
  EXPECT_TRUE(result.passes()) << what << ": " << result.explanation;
  const double injected = tolerance < 0.01 ? 0.01 : 2.0 * tolerance;
  for (const double factor : {1.0 - injected, 1.0 + injected}) {
    std::vector<double> biased = blocks;
    for (double& block : biased) block *= factor;
    const BiasTest::Result seen = test.againstValue(biased, reference, referenceStandardError);
    EXPECT_FALSE(seen.passes()) << what << ", times " << factor << ": " << seen.explanation;
  }
}

/// The same against another noisy estimate.
inline void expectSameMean(const std::vector<double>& a, const std::vector<double>& b,
                           const std::string& what, double tolerance = 0.005) {
  const MeanInterval reference = meanInterval(b, 0.999);
  expectUnbiased(a, reference.mean, what, tolerance, reference.standardError);
}

/// Estimates many paths and reports them block by block.
class PathBlocks {
 public:
  PathBlocks(const Tracer& tracer, const TransportParameters& transport, const EstimatorOptions& options)
      : estimator_(tracer, transport, options) {}

  void knowSight(const LightSight* sight) { estimator_.knowSight(sight); }
  /// `ray(key, sample)` gives each path's first ray.
  template <class MakeRay>
  void run(std::size_t blocks, std::size_t samples, std::uint64_t seed, const MakeRay& makeRay) {
    results.assign(blocks, std::vector<PathRadiance>(samples));
    std::vector<PathStart> starts(samples);
    for (std::size_t b = 0; b < blocks; ++b) {
      const RandomKey key = randomKey(seed).with(static_cast<std::uint32_t>(b));
      for (std::size_t s = 0; s < samples; ++s) {
        const auto sample = static_cast<std::uint32_t>(s);
        starts[s] = {makeRay(key, sample), key, sample};
      }
      estimator_.estimate(starts, results[b], Coherence::Incoherent, counts.gather, counts, faults);
    }
  }
  template <class Part>
  std::vector<double> means(const Part& part) const {
    return blockMeans(results.size(), results.front().size(),
                      [&](std::size_t b, std::size_t s) { return static_cast<double>(part(results[b][s])); });
  }

  std::vector<std::vector<PathRadiance>> results;
  RayCounts counts;
  SampleFaults faults;

 private:
  RadianceEstimator estimator_;
};

/// Random directions: uniform on the sphere, or with density cos / pi about z.
inline Vec3 uniformDirection(const Vec2& u) {
  const float z = 1.0f - 2.0f * u.x;
  const float s = std::sqrt(std::max(0.0f, 1.0f - z * z));
  return {s * std::cos(kTwoPi * u.y), s * std::sin(kTwoPi * u.y), z};
}
inline Vec3 cosineDirection(const Vec2& u) {
  const float s = std::sqrt(u.x);
  return {s * std::cos(kTwoPi * u.y), s * std::sin(kTwoPi * u.y), std::sqrt(1.0f - u.x)};
}

}  // namespace lightvane::trace_test
