#include "tests/bench/targets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include "core/image/image_file.h"
#include "core/measure/masks.h"
#include "core/measure/metric.h"
#include "tests/bench/embree_peer.h"
#include "tests/bench/measure.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// The sampled pixels of a picture, side by side: block after block.
struct SampledPicture {
  std::vector<ImageRgb> beauty, variance;  ///< of each region; the latter of a reference
};

template <class T>
Image<T> blockOf(const Image<T>& picture, const PictureRegion& region) {
  Image<T> block(region.width, region.height);
  for (int y = 0; y < region.height; ++y) {
    for (int x = 0; x < region.width; ++x) block.at(x, y) = picture.at(region.x + x, region.y + y);
  }
  return block;
}

/// Of one rendering of some samples of the hemisphere. All other numbers are as `balanced` has them, but
/// direct light has many samples.
std::vector<ImageRgb> naiveBlocks(const BenchScene& scene, const std::vector<PictureRegion>& regions,
                                  int samples, std::uint64_t seed, const std::shared_ptr<TaskPool>& pool) {
  Parameters parameters = balanced(Method::Naive);
  parameters.picture.seed = seed;
  parameters.picture.naiveSamples = samples;
  parameters.transport.lightSamples = std::max(samples / 4, 16);
  std::vector<ImageRgb> blocks;
  for (const PictureRegion& region : regions)
    blocks.push_back(render(scene, parameters, region, pool).film.beauty());
  return blocks;
}

/// Four renderings with seeds of their own: their mean, and how far it is to be trusted. Kept in the folder
/// under the scene's hash, the size and the samples, as a strip of blocks.
SampledPicture reference(const BenchScene& scene, const std::vector<PictureRegion>& regions,
                         const TargetOptions& options) {
  constexpr int kRenderings = 4;
  const int side = regions.front().width;
  const fs::path path = options.referenceFolder / fmt::format("{}-{}x{}-blocks-naive{}.exr",
                                                              scene.scene->hash, regions.front().fullWidth,
                                                              regions.size(), options.referenceSamples);
  const auto cut = [&](const LayeredImage& strip, const std::string& layer) {
    std::vector<ImageRgb> blocks;
    const ImageRgb pixels = strip.rgb(layer);
    for (int b = 0; b < static_cast<int>(regions.size()); ++b)
      blocks.push_back(blockOf(pixels, {strip.width, strip.height, 0, b * side, side, side}));
    return blocks;
  };
  if (fs::exists(path)) {
    if (const auto kept = readImage(path)) return {cut(*kept, ""), cut(*kept, "variance")};
  }
  fmt::print(stderr, "{}: reference by naive, {} samples a pixel\n", scene.name, options.referenceSamples);
  const auto pool = std::make_shared<TaskPool>();
  LayeredImage strip;
  strip.width = side;
  strip.height = side * static_cast<int>(regions.size());
  ImageRgb mean(strip.width, strip.height), variance(strip.width, strip.height);
  std::vector<ImageRgb> sums(regions.size(), ImageRgb(side, side)), squares = sums;
  for (int r = 0; r < kRenderings; ++r) {
    const auto blocks = naiveBlocks(scene, regions, std::max(options.referenceSamples / kRenderings, 1),
                                    1000 + static_cast<std::uint64_t>(r), pool);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (std::size_t i = 0; i < blocks[b].size(); ++i) {
        sums[b][i] += blocks[b][i];
        squares[b][i] += blocks[b][i] * blocks[b][i];
      }
    }
  }
  for (std::size_t b = 0; b < regions.size(); ++b) {
    for (std::size_t i = 0; i < sums[b].size(); ++i) {
      const Rgb value = sums[b][i] / static_cast<float>(kRenderings);
      mean[b * sums[b].size() + i] = value;
      variance[b * sums[b].size() + i] =
          glm::max(Rgb(0.0f), squares[b][i] / static_cast<float>(kRenderings) - value * value) /
          static_cast<float>(kRenderings - 1);
    }
  }
  strip.setRgb("", mean);
  strip.setRgb("variance", variance);
  fs::create_directories(options.referenceFolder);
  if (const Expected<void> written = writeImage(path, strip); !written) {
    fmt::print(stderr, "{}\n", written.error().message());
    std::exit(2);
  }
  return {cut(strip, ""), cut(strip, "variance")};
}

/// Means over the pixels that count.
struct MeanError {
  double error = 0.0;
  double ofReference = 0.0;  ///< what a perfect picture would have
};

MeanError errorOf(const Film& film, const std::vector<PictureRegion>& regions, const SampledPicture& truth) {
  const MetricInfo& mrae = *findMetric("mrae");
  const ImageFloat mask = bothMasks(edgeMask(film.depth(), film.normal()), lightMask(film.emission));
  const ImageRgb beauty = film.beauty();
  MeanError mean;
  double count = 0.0;
  for (std::size_t b = 0; b < regions.size(); ++b) {
    const ImageFloat counted = blockOf(mask, regions[b]);
    const MetricResult result = mrae.compute({.picture = blockOf(beauty, regions[b]),
                                              .reference = truth.beauty[b],
                                              .variance = &truth.variance[b],
                                              .mask = &counted});
    if (result.counted == 0) continue;
    const auto pixels = static_cast<double>(result.counted);
    mean.error += pixels * result.value;
    mean.ofReference += pixels * result.ofReference.value_or(0.0);
    count += pixels;
  }
  mean.error /= count;
  mean.ofReference /= count;
  return mean;
}

struct Target {
  const char* scene;
  Preset preset;
  int size;
  double mostError;  ///< 0.023: 2.3 %
  double units;
  double elsewhere;  ///< units of the best other program, at that error
};
constexpr Target kTargets[] = {{"cornell", Preset::Balanced, 512, 0.023, 0.64, 6.4},
                               {"cornell-mirror", Preset::Balanced, 512, 0.026, 0.9, 8.9},
                               {"table-room", Preset::Fine, 400, 0.05, 3.6, 54.0},
                               {"table-room", Preset::Balanced, 400, 0.15, 0.2, 2.1}};

std::string row(const Target& target, const EmbreeUnit& unit, const TargetOptions& options) {
  const BenchScene scene(target.scene);
  const int size = static_cast<int>(std::lround(options.scale * target.size));
  const std::vector<PictureRegion> regions = pictureSample(size);
  const SampledPicture truth = reference(scene, regions, options);
  const auto pool = std::make_shared<TaskPool>(1);
  Parameters parameters;
  applyPreset(parameters, target.preset);
  Samples seconds, units, errors;
  double ofReference = 0.0;
  std::size_t records = 0;
  for (int round = 0; round < options.rounds; ++round) {
    fmt::print(stderr, "{}: round {} of {}\n", scene.name, round + 1, options.rounds);
    units.values.push_back(unit.seconds());
    parameters.picture.seed = static_cast<std::uint64_t>(round + 1);
    const Rendering rendering = render(scene, parameters, wholePicture(size), pool);
    seconds.values.push_back(rendering.cpuSeconds);
    const MeanError error = errorOf(rendering.film, regions, truth);
    errors.values.push_back(100.0 * error.error);
    ofReference = 100.0 * error.ofReference;
    records = rendering.statistics.ilvRecords;
  }
  return fmt::format("| {} {}², `{}` | {:.1f} | {} | {:.1f} | {:.2f} | {} | {:.2g} | {:.2g} | {} |\n",
                     scene.name, size, choiceName(kPresetNames, target.preset), 100.0 * target.mostError,
                     withSpread(errors, 2), ofReference, seconds.best(), withSpread(ratio(seconds, units), 2),
                     target.units, target.elsewhere, records);
}

}  // namespace

TargetOptions TargetOptions::quick() {
  TargetOptions options;
  options.scale = 0.16;
  options.rounds = 1;
  options.referenceSamples = 64;
  return options;
}

std::string targetsTable(const TargetOptions& options) {
  const EmbreeUnit unit;
  std::string text =
      "| picture | error to reach, % | error, % | of these the reference's noise | CPU, s | units | units to "
      "reach "
      "| at best elsewhere | ILVs |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const Target& target : kTargets) text += row(target, unit, options);
  return text;
}

}  // namespace lightvane
