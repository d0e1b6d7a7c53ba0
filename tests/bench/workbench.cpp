#include "tests/bench/workbench.h"

#include <cstdlib>

#include <fmt/format.h>

#include "core/scene/load_scene.h"
#include "tests/bench/measure.h"

namespace lightvane {
namespace {

template <class T>
T valueOrExit(Expected<T> value) {
  if (!value) {
    fmt::print(stderr, "{}\n", value.error().message());
    std::exit(2);
  }
  return *std::move(value);
}

std::filesystem::path fileOf(const std::string& sceneName) {
  const std::filesystem::path source = LIGHTVANE_SOURCE_DIR;
  const std::filesystem::path own = source / "tests" / "bench" / "scenes" / (sceneName + ".toml");
  return std::filesystem::exists(own) ? own : source / "assets" / "scenes" / (sceneName + ".toml");
}

}  // namespace

BenchScene::BenchScene(const std::string& sceneName)
    : name(sceneName),
      scene(valueOrExit(Scene::compile(valueOrExit(loadScene(fileOf(sceneName)))))),
      tracer(std::make_shared<const Tracer>(scene)),
      camera(scene->cameras.front()) {}

BenchScene::BenchScene(std::string sceneName, std::shared_ptr<const Scene> compiled)
    : name(std::move(sceneName)),
      scene(std::move(compiled)),
      tracer(std::make_shared<const Tracer>(scene)),
      camera(scene->cameras.front()) {}

RenderContext BenchScene::context(const Parameters& parameters, const PictureRegion& region,
                                  std::shared_ptr<TaskPool> pool) const {
  RenderContext context{scene, tracer, camera, region, parameters, std::move(pool)};
  context.camera.width = region.fullWidth;
  context.camera.height = region.fullHeight;
  return context;
}

PictureRegion wholePicture(int size) { return {size, size, 0, 0, size, size}; }

std::vector<PictureRegion> pictureSample(int size) {
  constexpr int kCell = 64;
  constexpr int kBlock = 8;
  const RandomKey key = randomKey(0x73616d706c65U);
  std::vector<PictureRegion> blocks;
  for (int y = 0; y + kCell <= size; y += kCell) {
    for (int x = 0; x + kCell <= size; x += kCell) {
      const Vec2 u = uniform2(key, static_cast<std::uint32_t>(blocks.size()), 0);
      const auto place = [](float at) { return static_cast<int>(at * (kCell - kBlock + 1)); };
      blocks.push_back({size, size, x + place(u.x), y + place(u.y), kBlock, kBlock});
    }
  }
  return blocks;
}

Parameters balanced(Method method) {
  Parameters parameters;
  applyPreset(parameters, Preset::Balanced);
  parameters.picture.method = method;
  return parameters;
}

Rendering render(const BenchScene& scene, const Parameters& parameters, const PictureRegion& region,
                 const std::shared_ptr<TaskPool>& pool) {
  const StopFlag stop = false;
  Rendering rendering;
  const double wall = wallSeconds();
  const double cpu = processCpuSeconds();
  const std::unique_ptr<Renderer> renderer = makeRenderer(scene.context(parameters, region, pool));
  while (!renderer->done()) renderer->runPass(stop);
  rendering.film = renderer->film();
  rendering.cpuSeconds = processCpuSeconds() - cpu;
  rendering.wallSeconds = wallSeconds() - wall;
  rendering.statistics = renderer->statistics();
  if (renderer->snapshot() != nullptr) {
    rendering.snapshot = std::make_shared<const Snapshot>(*renderer->snapshot());
  }
  return rendering;
}

}  // namespace lightvane
