#pragma once

#include <filesystem>
#include <vector>

#include "tests/bench/workbench.h"

namespace lightvane {

/// A layer of the picture as an unbiased method converges to it, twice with different seeds: two halves whose
/// noise is independent, so that it averages out of a product of differences. What errors are relative to is
/// a third rendering: a pixel that the halves show too dark must not count for more because of it.
class Reference {
 public:
  /// The indirect layer: each half by `path` with `samples` paths a pixel on all cores, the third by `naive`
  /// with half as many samples. Kept in `folder` under the scene's hash, the size and the samples.
  static Reference ofIndirect(const BenchScene& scene, int size, int samples,
                              const std::filesystem::path& folder);
  /// The direct layer, by `direct` with `samples` shadow rays to each light.
  static Reference ofDirect(const BenchScene& scene, int size, int samples);

  struct Error {
    double relMse = 0.0;
    double standardError = 0.0;  ///< of relMse, from the spread over blocks of 32 x 32 pixels
  };
  /// mean((x - r)^2 / (r^2 + eps)) over the pixels with light and the three colours, where eps is
  /// 0.01 mean(r)^2 of the colour. (x - r)^2 is (x - a)(x - b) of the two halves: without their noise.
  Error relMse(const ImageRgb& layer) const;
  /// The mean difference from the halves over the mean of the third: how much too bright the layer is.
  double bias(const ImageRgb& layer) const;

  /// What relMse expects of an unbiased method, over the given regions, from its variance among renderings
  /// with different seeds: `renderings[r][region]`, two at least.
  double relMseOfUnbiased(const std::vector<std::vector<ImageRgb>>& renderings,
                          const std::vector<PictureRegion>& regions) const;

  /// The variance of one half, relative likewise: the noise that relMse leaves out.
  double noise() const;

 private:
  Reference(ImageRgb first, ImageRgb second, ImageRgb scale);
  bool hasLight(std::size_t i) const { return !isBlack(scale_[i]); }
  double weight(std::size_t i, int colour) const;

  ImageRgb halves_[2];
  ImageRgb scale_;
  Rgb eps_{0.0f};
};

}  // namespace lightvane
