#include "core/inspect/error_sources.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/measure/counted_pixels.h"
#include "core/measure/mean_estimate.h"

namespace lightvane {
namespace {

constexpr ErrorSourceInfo kInfos[] = {
    {ErrorSource::Noise, "Noise",
     "Vectors, and shadow rays where light is not interpolated, have too few samples.",
     "ilv.rows, ilv.columns, light.samples larger"},
    {ErrorSource::Leaks, "Leaks", "Vectors give light to points from which something hides them.",
     "ilv.visibility on, ilv.visibility_distance smaller"},
    {ErrorSource::Interpolation, "Interpolation",
     "Light between vectors is not what their mean says, however exact they are.",
     "ilv.radius_scale smaller, ilv.n_min larger; dlv.r_max or dlv.dispersion smaller"},
    {ErrorSource::SingleDirection, "Single direction",
     "A lobe's light is kept as one energy along one direction (eq. 4).", "ilv.store and dlv.store split"},
    {ErrorSource::MissingBounces, "Missing bounces",
     "Light that is reflected more often than paths are followed.", "path.max_bounces larger, or 0"}};
static_assert(std::size(kInfos) == kErrorSources);

// Streams of random numbers of their own: "whch".
constexpr std::uint32_t kPixelStream = 0x77686368U;

// Pixels between two looks at what has been done: a third of a second of work, as a rule.
constexpr std::size_t kPixelsAtOnce = 256;
constexpr std::size_t kVectorsAtOnce = 32;
/// What a vector costs, in pixels, as a rule: only for telling how far the work is.
constexpr double kVectorsWork = 8.0;

struct PixelPlace {
  int x, y;
};

/// One in each square of the picture, `stride` wide.
std::vector<PixelPlace> chosenPixels(const RenderFrame& frame, int stride) {
  const RandomKey key = randomKey(frame.parameters.picture.seed).with(kPixelStream);
  std::vector<PixelPlace> places;
  std::uint32_t square = 0;
  for (int top = 0; top < frame.film->height; top += stride) {
    for (int left = 0; left < frame.film->width; left += stride, ++square) {
      const auto within = [&](std::uint32_t dimension, int first, int end) {
        const int side = std::min(stride, end - first);
        return first + std::min(side - 1,
                                static_cast<int>(uniform(key, square, dimension) * static_cast<float>(side)));
      };
      places.push_back({within(0, left, frame.film->width), within(1, top, frame.film->height)});
    }
  }
  return places;
}

/// What is added up of one layer.
class LayerSum {
 public:
  LayerSum(int width, int height)
      : ofSource_(kErrorSources, MeanOfPixels(width, height)), total_(width, height) {}

  /// `scale`: squared, what differences are relative to.
  void add(const PixelPlace& at, const FullValue& one, const FullValue& other, double scale) {
    for (const ErrorSourceInfo& info : kInfos) {
      const auto s = static_cast<std::size_t>(info.source);
      add(ofSource_[s], biases_[s], at, partOf(one.parts, info.source), partOf(other.parts, info.source),
          scale);
    }
    add(total_, totalBias_, at, one.parts.sum(), other.parts.sum(), scale);
  }

  /// `light`: the sum of the picture's luminance.
  SourceErrors errors(double light) const {
    const auto errorOf = [&](const MeanOfPixels& mean, double bias) {
      const MeanEstimate estimate = mean.estimate();
      return SourceError{estimate.root(), estimate.rootError(), light > 0.0 ? bias / light : 0.0};
    };
    SourceErrors errors;
    for (std::size_t s = 0; s < kErrorSources; ++s) errors.ofSource[s] = errorOf(ofSource_[s], biases_[s]);
    errors.total = errorOf(total_, totalBias_);
    return errors;
  }

 private:
  static void add(MeanOfPixels& mean, double& bias, const PixelPlace& at, const Vec3d& one,
                  const Vec3d& other, double scale) {
    if (scale > 0.0) mean.add(at.x, at.y, meanOf(one * other) / scale);
    bias += static_cast<double>(luminance(Rgb(0.5 * (one + other))));
  }

  std::vector<MeanOfPixels> ofSource_;
  MeanOfPixels total_;
  std::array<double, kErrorSources> biases_{};
  double totalBias_ = 0.0;
};

/// Adds up what is found of each pixel, in the order of the pixels.
class Summary {
 public:
  Summary(const RenderFrame& frame, int samples, int stride)
      : shown_(frame.film->sceneBeauty(*frame.scene)),
        counted_({.picture = shown_, .reference = shown_}),
        local_(localMeans(shown_, counted_)),
        direct_(shown_.width(), shown_.height()),
        indirect_(direct_),
        picture_(direct_) {
    sources_.samples = samples;
    sources_.stride = stride;
    const Rgb unknown(std::numeric_limits<float>::quiet_NaN());
    for (ImageFloat& map : sources_.squares) map = ImageFloat(shown_.width(), shown_.height(), unknown.r);
    for (ImageRgb& map : sources_.maps) map = ImageRgb(shown_.width(), shown_.height(), unknown);
    sources_.truth = ImageRgb(shown_.width(), shown_.height(), unknown);
  }

  void add(const PixelPlace& at, const FullComputation& full) {
    const std::size_t i = shown_.index(at.x, at.y);
    const auto& [first, second] = full.halves;
    const DifferenceParts one = first.total().parts, other = second.total().parts;
    for (const ErrorSourceInfo& info : kInfos) {
      const auto s = static_cast<std::size_t>(info.source);
      sources_.maps[s][i] = Rgb(partOf(full.total.parts, info.source));
      sources_.squares[s][i] =
          luminance(Rgb(partOf(one, info.source))) * luminance(Rgb(partOf(other, info.source)));
    }
    sources_.truth[i] = shown_[i] - Rgb(full.total.parts.sum());
    sources_.pixels.push_back(i);
    sources_.rays += full.rays;
    // A pixel that is not finite has no error that could be told; what such pixels are is counted elsewhere.
    if (!counted_[i]) return;
    light_ += static_cast<double>(luminance(shown_[i]));
    const double scale = square(local_[i]) + square(kDarkPart * counted_.referenceMean);
    direct_.add(at, directOf(first), directOf(second), scale);
    indirect_.add(at, first.indirect, second.indirect, scale);
    picture_.add(at, first.total(), second.total(), scale);
  }

  ErrorSources finish(const RayCounts& more) {
    sources_.direct = direct_.errors(light_);
    sources_.indirect = indirect_.errors(light_);
    sources_.picture = picture_.errors(light_);
    sources_.rays += more;
    return std::move(sources_);
  }

 private:
  static FullValue directOf(const FullValues& values) {
    FullValue direct = values.direct;
    direct += values.mirrored;
    return direct;
  }

  ImageRgb shown_;
  CountedPixels counted_;
  Image<double> local_;
  LayerSum direct_, indirect_, picture_;
  double light_ = 0.0;
  ErrorSources sources_;
};

/// Calls body(index, worker) for each index, in portions, and after each portion, on the calling thread,
/// done(begin, end). False where it was stopped.
template <class Body, class Done>
bool inPortions(std::size_t count, TaskPool& pool, const StopFlag& stop, const Body& body, const Done& done) {
  for (std::size_t begin = 0; begin < count; begin += kPixelsAtOnce) {
    const std::size_t end = std::min(begin + kPixelsAtOnce, count);
    pool.forEach(end - begin, [&](std::size_t i, int worker) {
      if (!stop) body(begin + i, static_cast<std::size_t>(worker));
    });
    if (stop) return false;
    done(begin, end);
  }
  return true;
}

}  // namespace

std::span<const ErrorSourceInfo> errorSourceInfos() { return kInfos; }

const Vec3d& partOf(const DifferenceParts& parts, ErrorSource source) {
  switch (source) {
    case ErrorSource::Noise:
      return parts.noise;
    case ErrorSource::Leaks:
      return parts.leaks;
    case ErrorSource::Interpolation:
      return parts.interpolation;
    case ErrorSource::SingleDirection:
      return parts.singleDirection;
    case ErrorSource::MissingBounces:
      break;
  }
  return parts.missingBounces;
}

std::size_t ErrorSources::lookedAt(int x, int y) const {
  const int across = (truth.width() + stride - 1) / stride;
  const int place = y / stride * across + x / stride;
  return pixels[static_cast<std::size_t>(place)];
}

std::optional<ErrorSource> ErrorSources::largest(int x, int y) const {
  std::array<double, kErrorSources> sums{};
  for (int ny = y - stride; ny <= y + stride; ny += stride) {
    for (int nx = x - stride; nx <= x + stride; nx += stride) {
      if (nx < 0 || ny < 0 || nx >= truth.width() || ny >= truth.height()) continue;
      const std::size_t pixel = lookedAt(nx, ny);
      for (std::size_t s = 0; s < kErrorSources; ++s) sums[s] += static_cast<double>(squares[s][pixel]);
    }
  }
  const auto* const most = std::max_element(sums.begin(), sums.end());
  if (!(*most > 0.0)) return std::nullopt;
  return static_cast<ErrorSource>(most - sums.begin());
}

std::string errorSourceObstacle(const RenderFrame& frame) {
  if (!frame.points || !frame.snapshot) return "only pictures made with vectors can tell";
  if (!frame.complete || frame.reduction != 1) return "the picture is not complete";
  return {};
}

std::optional<ErrorSources> errorSources(const RenderFrame& frame, const ErrorSourceRequest& request,
                                         TaskPool& pool, const StopFlag& stop,
                                         const std::function<void(double)>& told) {
  const auto tell = [&](double part) {
    if (told) told(part);
  };
  std::vector<FullComputer> computers;
  for (int i = 0; i < pool.threadCount(); ++i) computers.emplace_back(frame, request.samples, stop);
  const std::vector<PixelPlace> pixels = chosenPixels(frame, request.stride);

  std::vector<std::set<RecordRef>> shares(computers.size());
  const auto findShares = [&](std::size_t i, std::size_t worker) {
    const auto [x, y] = pixels[i];
    if (FullComputer::obstacle(frame, x, y).empty()) computers[worker].findShares(x, y, shares[worker]);
  };
  const auto nothing = [](std::size_t, std::size_t) {};
  if (!inPortions(pixels.size(), pool, stop, findShares, nothing)) return std::nullopt;
  std::set<RecordRef> all;
  for (std::set<RecordRef>& found : shares) all.merge(found);
  const std::vector<RecordRef> records(all.begin(), all.end());

  const double ofVectors = kVectorsWork * static_cast<double>(records.size());
  const double whole = ofVectors + static_cast<double>(pixels.size());
  ExactVectors exact(frame);
  for (std::size_t begin = 0; begin < records.size(); begin += kVectorsAtOnce) {
    tell(kVectorsWork * static_cast<double>(begin) / whole);
    exact.compute(std::span(records).subspan(begin, std::min(kVectorsAtOnce, records.size() - begin)), pool,
                  stop);
    if (stop) return std::nullopt;
  }

  Summary summary(frame, computers.front().samples(), request.stride);
  std::vector<FullComputation> found(kPixelsAtOnce);
  const auto compute = [&](std::size_t i, std::size_t worker) {
    const auto [x, y] = pixels[i];
    FullComputation& full = found[i % kPixelsAtOnce];
    full = {};
    if (FullComputer::obstacle(frame, x, y).empty()) full = computers[worker].compute(x, y, exact);
  };
  const auto addUp = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) summary.add(pixels[i], found[i % kPixelsAtOnce]);
    tell((ofVectors + static_cast<double>(end)) / whole);
  };
  if (!inPortions(pixels.size(), pool, stop, compute, addUp)) return std::nullopt;
  return summary.finish(exact.rays());
}

}  // namespace lightvane
