#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/math.h"
#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

// Splotches and leaks hide in means over a picture, and its worst pixel is but its noisiest. Between the two
// is the worst tile, where only what neighbouring pixels share is an error:
//
// - In a block of 4x4 pixels the squared error is the mean of d_i d_j over pairs of different pixels. Where
// the
//   pixels' errors d are independent its expectation is the square of their mean: noise of the picture and of
//   the reference adds nothing, known or not, and a single wrong pixel in a block of right ones gives 0.
// - A tile is 4x4 blocks, of which the worst is left out: even an extreme pixel, whose product with the
// others'
//   noise is large, has no say.

namespace lightvane {
namespace {

constexpr int kBlockSize = 4;
constexpr int kTileBlocks = 4;
constexpr int kTileStep = 2;  // blocks: tiles overlap by half
// With fewer blocks each is a large part of the tile.
constexpr std::size_t kBlocksToDropOne = 4;
// A tile of which less counts is an edge or a light with its surroundings, and too few pixels to be sure of.
constexpr double kLeastPart = 0.25;

struct Block {
  double count = 0.0;
  glm::dvec3 sum{0.0}, sumOfSquares{0.0};  // of differences
  double reference = 0.0;                  // sum

  void add(const glm::dvec3& difference, double referenceMean) {
    count += 1.0;
    sum += difference;
    sumOfSquares += difference * difference;
    reference += referenceMean;
  }
  /// The mean of d_i d_j of two different pixels and one colour.
  double sharedSquare() const {
    const glm::dvec3 pairs = sum * sum - sumOfSquares;
    return (pairs.r + pairs.g + pairs.b) / (3.0 * count * (count - 1.0));
  }
};

struct BlockError {
  double square = 0.0;
  double weight = 0.0;  // pixels
};

int blocksAlong(int pixels) { return (pixels + kBlockSize - 1) / kBlockSize; }

/// Where tiles begin along an axis, in blocks: the last ends with the picture.
std::vector<int> tileStarts(int blocks) {
  std::vector<int> starts;
  const int last = std::max(blocks - kTileBlocks, 0);
  for (int start = 0; start < last; start += kTileStep) starts.push_back(start);
  starts.push_back(last);
  return starts;
}

/// Of the blocks' squared errors.
MeanEstimate meanWithoutWorst(std::vector<BlockError>& blocks) {
  if (blocks.size() >= kBlocksToDropOne)
    blocks.erase(std::ranges::max_element(blocks, {}, &BlockError::square));
  double weight = 0.0, sum = 0.0, scatter = 0.0;
  for (const BlockError& block : blocks) {
    weight += block.weight;
    sum += block.weight * block.square;
  }
  const double mean = sum / weight;
  for (const BlockError& block : blocks) scatter += square(block.weight * (block.square - mean));
  return {mean, std::sqrt(scatter) / weight};
}

Image<Block> blocksOf(const MetricInput& input, const CountedPixels& counted) {
  const int width = input.reference.width(), height = input.reference.height();
  Image<Block> blocks(blocksAlong(width), blocksAlong(height), Block{});
  counted.forEach([&](int x, int y, std::size_t i) {
    blocks.at(x / kBlockSize, y / kBlockSize)
        .add(glm::dvec3(input.picture[i]) - glm::dvec3(input.reference[i]), meanOf(input.reference[i]));
  });
  return blocks;
}

/// The squared relative error of the tile whose first block is this one; none where too little counts.
std::optional<MeanEstimate> tileError(const Image<Block>& blocks, int left, int top, int pixels,
                                      double dark) {
  std::vector<BlockError> errors;
  double count = 0.0, reference = 0.0;
  for (int y = top; y < std::min(top + kTileBlocks, blocks.height()); ++y) {
    for (int x = left; x < std::min(left + kTileBlocks, blocks.width()); ++x) {
      const Block& block = blocks.at(x, y);
      count += block.count;
      reference += block.reference;
      if (block.count > 1.0) errors.push_back({block.sharedSquare(), block.count});
    }
  }
  if (errors.empty() || count < kLeastPart * pixels) return std::nullopt;
  const MeanEstimate error = meanWithoutWorst(errors);
  const double scale = square(reference / count) + square(dark);
  // Black of black is right, and anything else wrong by all.
  if (!(scale > 0.0)) return MeanEstimate{error.mean > 0.0 ? 1.0 : 0.0, 0.0};
  return MeanEstimate{error.mean / scale, error.standardError / scale};
}

void raise(ImageFloat& map, const PixelArea& area, const CountedPixels& counted, double value) {
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x) {
      if (counted(x, y)) map.at(x, y) = std::max(map.at(x, y), static_cast<float>(value));
    }
  }
}

MetricResult computeWorstTile(const MetricInput& input) {
  const CountedPixels counted(input);
  MetricResult result = counted.result();
  const Image<Block> blocks = blocksOf(input, counted);
  const double dark = kDarkPart * counted.referenceMean;
  for (const int top : tileStarts(blocks.height())) {
    for (const int left : tileStarts(blocks.width())) {
      PixelArea area{left * kBlockSize, top * kBlockSize};
      area.width = std::min(area.x + kTileBlocks * kBlockSize, input.reference.width()) - area.x;
      area.height = std::min(area.y + kTileBlocks * kBlockSize, input.reference.height()) - area.y;
      const std::optional<MeanEstimate> error = tileError(blocks, left, top, area.width * area.height, dark);
      if (!error) continue;
      raise(result.map, area, counted, error->root());
      if (result.area && error->root() <= result.value) continue;
      result.value = error->root();
      result.standardError = error->rootError();
      result.area = area;
    }
  }
  if (result.area) result.ofReference = ofNoiseAlone(input, computeWorstTile);
  return result;
}

}  // namespace

// Noise cancels in it, whether its variance is known or not. What the largest of many tiles keeps of it is
// stated.
MetricInfo worstTileMetric() {
  return {.name = "worst-tile",
          .label = "Worst tile",
          .unit = MetricUnit::Fraction,
          .description =
              "The largest relative error of a tile of 16x16 pixels (they overlap by half), counting "
              "what neighbouring pixels share: in each block of 4x4 pixels the mean product of the "
              "errors of two of them, over all but the tile's worst block. It is relative to the "
              "tile's mean of the reference and to 1 % of the mean of all.",
          .map = "relative error of the worst tile around",
          .compute = computeWorstTile};
}

}  // namespace lightvane
