#include "tests/bench/picture_error.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "core/image/image_file.h"

namespace lightvane {
namespace {

namespace fs = std::filesystem;

/// The indirect layer of a method that is unbiased, rendered or read.
ImageRgb indirectLayer(const BenchScene& scene, int size, Method method, int samples, std::uint64_t seed,
                       const fs::path& folder) {
  Parameters parameters = balanced(method);
  parameters.picture.seed = seed;
  (method == Method::Path ? parameters.picture.pathSamples : parameters.picture.naiveSamples) = samples;
  const char* name = method == Method::Path ? "path" : "naive";
  const fs::path path =
      folder / fmt::format("{}-{}-{}{}-seed{}.exr", scene.scene->hash, size, name, samples, seed);
  if (fs::exists(path)) {
    if (const Expected<LayeredImage> kept = readImage(path); kept && kept->width == size) return kept->rgb();
  }
  fmt::print(stderr, "{}: reference by {}, {} samples a pixel\n", scene.name, name, samples);
  ImageRgb indirect =
      render(scene, parameters, wholePicture(size), std::make_shared<TaskPool>()).film.indirect;
  LayeredImage image;
  image.width = size;
  image.height = size;
  image.setRgb("", indirect);
  fs::create_directories(folder);
  if (const Expected<void> written = writeImage(path, image); !written) {
    fmt::print(stderr, "{}\n", written.error().message());
    std::exit(2);
  }
  return indirect;
}

}  // namespace

Reference Reference::ofIndirect(const BenchScene& scene, int size, int samples, const fs::path& folder) {
  return {indirectLayer(scene, size, Method::Path, samples, 1001, folder),
          indirectLayer(scene, size, Method::Path, samples, 1002, folder),
          indirectLayer(scene, size, Method::Naive, samples / 2, 1003, folder)};
}

Reference Reference::ofDirect(const BenchScene& scene, int size, int samples) {
  const auto layer = [&](std::uint64_t seed) {
    Parameters parameters = balanced(Method::Direct);
    parameters.picture.seed = seed;
    parameters.transport.lightSamples = samples;
    return render(scene, parameters, wholePicture(size), std::make_shared<TaskPool>()).film.direct;
  };
  return {layer(1001), layer(1002), layer(1003)};
}

Reference::Reference(ImageRgb first, ImageRgb second, ImageRgb scale)
    : halves_{std::move(first), std::move(second)}, scale_(std::move(scale)) {
  glm::dvec3 sum(0.0);
  double count = 0.0;
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    if (!hasLight(i)) continue;
    sum += glm::dvec3(scale_[i]);
    count += 1.0;
  }
  const glm::dvec3 mean = sum / count;
  eps_ = Rgb(0.01 * mean * mean);
}

double Reference::weight(std::size_t i, int colour) const {
  return 1.0 / (square(static_cast<double>(scale_[i][colour])) + static_cast<double>(eps_[colour]));
}

Reference::Error Reference::relMse(const ImageRgb& layer) const {
  constexpr int kBlock = 32;
  double sum = 0.0;
  double count = 0.0;
  struct Block {
    double sum, count;
  };
  std::vector<Block> blocks;
  for (int y0 = 0; y0 < scale_.height(); y0 += kBlock) {
    for (int x0 = 0; x0 < scale_.width(); x0 += kBlock) {
      Block block{0.0, 0.0};
      for (int y = y0; y < std::min(scale_.height(), y0 + kBlock); ++y) {
        for (int x = x0; x < std::min(scale_.width(), x0 + kBlock); ++x) {
          const std::size_t i = scale_.index(x, y);
          if (!hasLight(i)) continue;
          for (int c = 0; c < 3; ++c) {
            const double value = layer[i][c];
            block.sum += (value - static_cast<double>(halves_[0][i][c])) *
                         (value - static_cast<double>(halves_[1][i][c])) * weight(i, c);
            block.count += 1.0;
          }
        }
      }
      sum += block.sum;
      count += block.count;
      blocks.push_back(block);
    }
  }
  Error error{sum / count, 0.0};
  // A ratio of sums over blocks (Cochran, "Sampling Techniques", 1977, eq. 2.46).
  double squares = 0.0;
  for (const Block& block : blocks) squares += square(block.sum - error.relMse * block.count);
  error.standardError = std::sqrt(squares) / count;
  return error;
}

double Reference::bias(const ImageRgb& layer) const {
  glm::dvec3 difference(0.0);
  glm::dvec3 whole(0.0);
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    if (!hasLight(i)) continue;
    difference += glm::dvec3(layer[i]) - 0.5 * (glm::dvec3(halves_[0][i]) + glm::dvec3(halves_[1][i]));
    whole += glm::dvec3(scale_[i]);
  }
  return (difference.r + difference.g + difference.b) / (whole.r + whole.g + whole.b);
}

double Reference::relMseOfUnbiased(const std::vector<std::vector<ImageRgb>>& renderings,
                                   const std::vector<PictureRegion>& regions) const {
  const auto n = static_cast<double>(renderings.size());
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const PictureRegion& region = regions[r];
    for (int y = 0; y < region.height; ++y) {
      for (int x = 0; x < region.width; ++x) {
        const std::size_t i = scale_.index(region.x + x, region.y + y);
        if (!hasLight(i)) continue;
        for (int c = 0; c < 3; ++c) {
          double values = 0.0;
          double squares = 0.0;
          for (const std::vector<ImageRgb>& rendering : renderings) {
            const double value = rendering[r].at(x, y)[c];
            values += value;
            squares += value * value;
          }
          sum += (squares - values * values / n) / (n - 1.0) * weight(i, c);
          count += 1.0;
        }
      }
    }
  }
  return sum / count;
}

double Reference::noise() const {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    if (!hasLight(i)) continue;
    for (int c = 0; c < 3; ++c) {
      sum += 0.5 * square(static_cast<double>(halves_[0][i][c] - halves_[1][i][c])) * weight(i, c);
      count += 1.0;
    }
  }
  return sum / count;
}

}  // namespace lightvane
