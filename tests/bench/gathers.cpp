#include "tests/bench/gathers.h"

#include <cmath>

#include <fmt/format.h>

#include "core/render/visible_points.h"
#include "core/vectors/gather.h"
#include "tests/bench/measure.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

/// Points of a scene's picture that have diffuse light, each at a random place of one tile.
std::vector<GatherPoint> somePoints(const BenchScene& scene) {
  constexpr int kSize = 256;
  const Parameters parameters = balanced(Method::Vectors);
  const auto pool = std::make_shared<TaskPool>(1);
  const RenderContext context = scene.context(parameters, wholePicture(kSize), pool);
  const StopFlag stop = false;
  SeenSurfaces seen(kSize, kSize);
  RayCounts counts;
  VisiblePoints visible;
  traceVisiblePoints(*scene.tracer, context.camera, context.region, parameters, *pool, stop, visible, seen,
                     counts);
  std::vector<GatherPoint> points;
  const RandomKey key = randomKey(0x67617468U);
  for (std::uint32_t t = 0; t < visible.tiles.size(); ++t) {
    const std::vector<VisiblePoint>& all = visible.tiles[t].points;
    if (all.empty()) continue;
    const auto place = static_cast<std::size_t>(uniform(key, t, 0) * static_cast<float>(all.size()));
    const VisiblePoint& p = all[std::min(place, all.size() - 1)];
    if (scene.scene->materialOf(p.surface).brdf.hasDiffuse())
      points.push_back({p.lit(*scene.scene), p.vectorFootprint});
  }
  return points;
}

/// Sums over the seeds of one point, of luminances.
struct Moments {
  double sum = 0.0, squares = 0.0;
  int count = 0;

  void add(double value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  double mean() const { return sum / count; }
  double variance() const { return std::max(0.0, squares / count - square(mean())) * count / (count - 1); }
};

struct GatherRow {
  Samples seconds;            ///< of one gather, by round
  double variance = 0.0;      ///< of the irradiance, relative; the mean over the points
  double stepVariance = 0.0;  ///< of what the gradient adds a fifth of the mean distance away, likewise
  double rays = 0.0;
};

GatherRow measured(const BenchScene& scene, const std::vector<GatherPoint>& points, int rows, int rounds,
                   int seeds) {
  Parameters parameters = balanced(Method::Vectors);
  parameters.vectors.ilv.rows = rows;
  parameters.vectors.ilv.columns = 2 * rows;
  Gatherer gatherer(*scene.tracer, parameters.transport, parameters.vectors);
  GatherRow row;
  SampleFaults faults;
  std::vector<Moments> irradiances(points.size());
  std::vector<Moments> steps(2 * points.size());
  std::uint64_t seed = 0;
  std::uint64_t rays = 0;
  for (int round = 0; round < rounds; ++round) {
    const double start = threadCpuSeconds();
    for (int s = 0; s < seeds; ++s) {
      ++seed;
      for (std::size_t p = 0; p < points.size(); ++p) {
        RayCounts counts;
        const IndirectLightVector vector = gatherer.gather(points[p], kLambertKey, seed, counts, faults);
        rays += counts.total();
        irradiances[p].add(luminance(vector.irradiance));
        const float step = 0.2f * vector.harmonicMean;
        const Frame& frame = points[p].lit.surface.frame;
        const Vec3 towards = luminance(Rgb(1, 0, 0)) * vector.gradient[0] +
                             luminance(Rgb(0, 1, 0)) * vector.gradient[1] +
                             luminance(Rgb(0, 0, 1)) * vector.gradient[2];
        steps[2 * p].add(step * glm::dot(towards, frame.x));
        steps[2 * p + 1].add(step * glm::dot(towards, frame.y));
      }
    }
    row.seconds.values.push_back((threadCpuSeconds() - start) / (seeds * static_cast<double>(points.size())));
  }
  const auto count = static_cast<double>(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double meanSquared = square(irradiances[p].mean());
    if (!(meanSquared > 0.0)) continue;
    row.variance += irradiances[p].variance() / meanSquared / count;
    row.stepVariance += (steps[2 * p].variance() + steps[2 * p + 1].variance()) / (2.0 * meanSquared) / count;
  }
  row.rays = static_cast<double>(rays) / (static_cast<double>(seed) * count);
  return row;
}

}  // namespace

std::string gathersTable(int rounds, int seeds) {
  std::string text =
      "| scene | cells | rays | each, µs | deviation, % | of a step by the gradient, % | to 1 %, µs | with "
      "the "
      "step, µs |\n|---|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const char* name : {"cornell", "cornell-mirror", "fig4-spheres", "two-rooms", "textures"}) {
    const BenchScene scene(name);
    const std::vector<GatherPoint> points = somePoints(scene);
    for (const int rows : {8, 12, 20}) {
      const GatherRow row = measured(scene, points, rows, rounds, seeds);
      const double seconds = row.seconds.best();
      text += fmt::format("| {} | {} x {} | {:.0f} | {:.1f} | {:.2f} | {:.2f} | {:.0f} | {:.0f} |\n", name,
                          rows, 2 * rows, row.rays, 1e6 * seconds, 100.0 * std::sqrt(row.variance),
                          100.0 * std::sqrt(row.stepVariance), 1e6 * seconds * row.variance / 1e-4,
                          1e6 * seconds * (row.variance + row.stepVariance) / 1e-4);
    }
  }
  return text;
}

}  // namespace lightvane
