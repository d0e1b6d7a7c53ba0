#include "core/measure/sweep_run.h"

#include <chrono>

#include <fmt/format.h>

#include "core/render/memory.h"

namespace lightvane {
namespace {

using WallClock = std::chrono::steady_clock;

}  // namespace

Expected<Parameters> withSettings(const Parameters& parameters, const SweepSettings& settings) {
  std::vector<RenderSetting> all;
  for (const auto& [key, value] : settings) all.push_back({key, value, fmt::format("{}={}", key, value)});
  return applySettings(parameters, all);
}

Expected<std::vector<Parameters>> withEachSettings(const Parameters& parameters,
                                                   const std::vector<SweepSettings>& points) {
  std::vector<Parameters> all;
  for (const SweepSettings& settings : points) {
    auto one = withSettings(parameters, settings);
    if (!one) return tl::unexpected(one.error());
    all.push_back(*std::move(one));
  }
  return all;
}

bool renderToEnd(Renderer& renderer, const StopFlag& stop, const std::function<void()>& beforePass) {
  const FlushDenormals flush;
  while (!renderer.done()) {
    if (beforePass) beforePass();
    if (!renderer.runPass(stop)) return false;
  }
  return true;
}

Expected<std::optional<MeasuredRun>> measureRun(const RenderContext& context, const RunConditions& conditions,
                                                const StopFlag& stop) {
  const double cpu = conditions.cpuSeconds();
  const WallClock::time_point wall = WallClock::now();
  const std::unique_ptr<Renderer> renderer = makeRenderer(context);
  if (!renderToEnd(*renderer, stop, conditions.beforePass)) return std::nullopt;
  MeasuredRun measured;
  SweepRun& run = measured.run;
  run.cpuSeconds = conditions.cpuSeconds() - cpu;
  run.wallSeconds = std::chrono::duration<double>(WallClock::now() - wall).count();
  const RenderStatistics& statistics = renderer->statistics();
  run.seed = context.parameters.picture.seed;
  run.rays = statistics.rays;
  run.ilvRecords = statistics.ilvRecords;
  run.dlvRecords = statistics.dlvRecords;
  run.fullIndirect = statistics.fullIndirect;
  run.fullDirect = statistics.fullDirect;
  run.memoryBytes = estimatedPictureBytes(*context.scene, context.parameters, context.region);
  if (const Snapshot* snapshot = renderer->snapshot()) run.memoryBytes += vectorBytes(*snapshot);

  measured.frame = makeFrame(context, *renderer);
  auto comparison = compareImages(measured.frame.film->toLayers(*context.scene), "the picture",
                                  conditions.reference, conditions.referenceName, conditions.comparison);
  if (!comparison) return tl::unexpected(comparison.error());
  measured.comparison = *std::move(comparison);
  for (const LayerComparison& layer : measured.comparison.layers) {
    for (std::size_t m = 0; m < layer.results.size(); ++m) {
      run.metrics[fmt::format("{}.{}", layer.layer, conditions.comparison.metrics[m]->name)] =
          layer.results[m].value;
    }
  }
  return measured;
}

}  // namespace lightvane
