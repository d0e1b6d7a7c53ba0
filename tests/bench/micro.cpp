// Rows of Google Benchmark, for the stages of a rendering of the Cornell box at 512 x 512. "each" is the time
// of one of what the row's name says.

#include <benchmark/benchmark.h>

#include "core/base/check.h"
#include "core/vectors/gather.h"
#include "tests/bench/workbench.h"

namespace lightvane {
namespace {

/// A finished rendering and the visible points that it answered.
struct Stage {
  explicit Stage(DlvMode mode) : parameters(balanced(Method::Vectors)), scene("cornell") {
    constexpr int kSize = 512;
    parameters.vectors.dlv.mode = mode;
    const auto pool = std::make_shared<TaskPool>(1);
    snapshot = render(scene, parameters, wholePicture(kSize), pool).snapshot;
    const RenderContext context = scene.context(parameters, wholePicture(kSize), pool);
    const StopFlag stop = false;
    SeenSurfaces seen(kSize, kSize);
    RayCounts counts;
    traceVisiblePoints(*scene.tracer, context.camera, context.region, parameters, *pool, stop, points, seen,
                       counts);
    for (const VisibleTile& tile : points.tiles) {
      for (const PointCluster& cluster : tile.clusters) {
        Queries& q = queries.emplace_back();
        q.centre = cluster.ball.centre;
        q.radius = cluster.ball.radius;
        for (const std::uint32_t i : cluster.points) {
          const VisiblePoint& p = tile.points[i];
          q.points.push_back({p.position, p.normal, p.geometricNormal, p.outgoing, p.offset});
        }
      }
    }
  }

  struct Queries {
    std::vector<QueryPoint> points;
    Vec3 centre;
    float radius;
  };

  Parameters parameters;
  BenchScene scene;
  std::shared_ptr<const Snapshot> snapshot;
  VisiblePoints points;
  std::vector<Queries> queries;
};

const Stage& indirectStage() {
  static const Stage stage(DlvMode::Never);
  return stage;
}

const Stage& directStage() {
  static const Stage stage(DlvMode::Always);
  return stage;
}

/// The picture's points, every `step`-th of each tile.
std::vector<const VisiblePoint*> somePoints(const Stage& stage, std::size_t step) {
  std::vector<const VisiblePoint*> points;
  for (const VisibleTile& tile : stage.points.tiles) {
    for (std::size_t i = 0; i < tile.points.size(); i += step) points.push_back(&tile.points[i]);
  }
  return points;
}

void countEach(benchmark::State& state, std::size_t things) {
  state.counters["each"] =
      benchmark::Counter(static_cast<double>(things),
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void answerIndirectOfAPixel(benchmark::State& state) {
  const Stage& stage = indirectStage();
  Answerer answerer(*stage.scene.tracer, stage.parameters.vectors);
  std::vector<IndirectAnswer> answers(kClusterSize);
  RayCounts rays;
  std::size_t points = 0;
  for (const Stage::Queries& q : stage.queries) points += q.points.size();
  for (auto _ : state) {
    for (const Stage::Queries& q : stage.queries) {
      answerer.answerIndirect(stage.snapshot->indirect, kLambertKey, q.points, q.centre, q.radius, answers,
                              rays);
      benchmark::DoNotOptimize(answers.data());
    }
  }
  countEach(state, points);
}

void answerDirectOfAPixel(benchmark::State& state) {
  const Stage& stage = directStage();
  Answerer answerer(*stage.scene.tracer, stage.parameters.vectors);
  std::vector<DirectAnswer> answers(kClusterSize);
  std::size_t points = 0;
  for (const Stage::Queries& q : stage.queries) points += q.points.size();
  LV_CHECK(!stage.snapshot->direct.front().empty(), "no direct light vectors");
  for (auto _ : state) {
    for (const Stage::Queries& q : stage.queries) {
      answerer.answerDirect(stage.snapshot->direct.front(), kLambertKey, q.points, q.centre, q.radius, 0.0f,
                            answers);
      benchmark::DoNotOptimize(answers.data());
    }
  }
  countEach(state, points);
}

void gatherOfAVector(benchmark::State& state) {
  const Stage& stage = indirectStage();
  const std::vector<const VisiblePoint*> points = somePoints(stage, 512);
  Gatherer gatherer(*stage.scene.tracer, stage.parameters.transport, stage.parameters.vectors);
  RayCounts rays;
  SampleFaults faults;
  for (auto _ : state) {
    for (const VisiblePoint* p : points) {
      benchmark::DoNotOptimize(
          gatherer.gather({p->lit(*stage.scene.scene), p->vectorFootprint}, kLambertKey, 1, rays, faults));
    }
  }
  countEach(state, points.size());
}

void directLightOfAPixel(benchmark::State& state) {
  const Stage& stage = indirectStage();
  const std::vector<const VisiblePoint*> points = somePoints(stage, 16);
  DirectLightSampler sampler(*stage.scene.tracer, stage.parameters.transport);
  RayCounts rays;
  SampleFaults faults;
  for (auto _ : state) {
    for (const VisiblePoint* p : points) {
      benchmark::DoNotOptimize(sampler.estimate(p->lit(*stage.scene.scene), 0,
                                                stage.parameters.transport.lightSamples,
                                                randomKey(1).with(p->pixel), rays, faults));
    }
  }
  countEach(state, points.size());
}

void lightSampleOfManyAtAPoint(benchmark::State& state) {
  const Stage& stage = indirectStage();
  const std::vector<const VisiblePoint*> points = somePoints(stage, 16);
  const int samples = static_cast<int>(state.range(0));
  for (auto _ : state) {
    for (const VisiblePoint* p : points) {
      const LightSampler sampler(stage.scene.scene->lights.front(), p->position);
      const RandomKey key = randomKey(1).with(p->pixel);
      for (int s = 0; s < samples; ++s) {
        LightSample sample;
        benchmark::DoNotOptimize(sampler.sample(uniform2(key, static_cast<std::uint32_t>(s), 0), sample));
        benchmark::DoNotOptimize(sample);
      }
    }
  }
  countEach(state, points.size() * static_cast<std::size_t>(samples));
}

/// The indirect vectors of the picture as spheres of validity.
std::vector<TreeEntry> treeEntries(const Stage& stage) {
  const IlvRules rules(stage.parameters.vectors.ilv, stage.scene.scene->diagonal);
  std::vector<TreeEntry> entries;
  for (std::size_t i = 0; i < stage.snapshot->indirect.size(); ++i) {
    const IndirectLightVector& record = stage.snapshot->indirect[i];
    entries.push_back({record.point.position, ilvRadius(record, rules)});
  }
  return entries;
}

void queryOfTheTree(benchmark::State& state) {
  const Stage& stage = indirectStage();
  const RecordTree tree(treeEntries(stage));
  std::vector<std::uint32_t> found;
  for (auto _ : state) {
    for (const Stage::Queries& q : stage.queries) {
      found.clear();
      tree.query(q.centre, q.radius, [&](std::uint32_t i) { found.push_back(i); });
      benchmark::DoNotOptimize(found.data());
    }
  }
  countEach(state, stage.queries.size());
}

void queryByBruteForce(benchmark::State& state) {
  const Stage& stage = indirectStage();
  const std::vector<TreeEntry> entries = treeEntries(stage);
  std::vector<std::uint32_t> found;
  for (auto _ : state) {
    for (const Stage::Queries& q : stage.queries) {
      found.clear();
      for (std::uint32_t i = 0; i < entries.size(); ++i) {
        const Vec3 difference = entries[i].position - q.centre;
        const float together = q.radius + entries[i].radius;
        if (glm::dot(difference, difference) <= together * together) found.push_back(i);
      }
      benchmark::DoNotOptimize(found.data());
    }
  }
  countEach(state, stage.queries.size());
}

BENCHMARK(answerIndirectOfAPixel)->Unit(benchmark::kMillisecond);
BENCHMARK(answerDirectOfAPixel)->Unit(benchmark::kMillisecond);
BENCHMARK(gatherOfAVector)->Unit(benchmark::kMillisecond);
BENCHMARK(directLightOfAPixel)->Unit(benchmark::kMillisecond);
BENCHMARK(lightSampleOfManyAtAPoint)->Arg(1)->Arg(16)->Unit(benchmark::kMillisecond);
BENCHMARK(queryOfTheTree)->Unit(benchmark::kMillisecond);
BENCHMARK(queryByBruteForce)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lightvane
