#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/render/renderer.h"

namespace lightvane {

/// A scene, compiled and ready to trace.
struct BenchScene {
  /// Of tests/bench/scenes or assets/scenes, by the file's name without its extension; ends the program with
  /// the loader's message where it fails.
  explicit BenchScene(const std::string& sceneName);
  /// Of no file; builds what traces it.
  BenchScene(std::string sceneName, std::shared_ptr<const Scene> compiled);

  std::string name;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  Camera camera;

  RenderContext context(const Parameters& parameters, const PictureRegion& region,
                        std::shared_ptr<TaskPool> pool) const;
};

PictureRegion wholePicture(int size);

/// Blocks of 8 x 8 pixels, one at a random place in each cell of a grid of 64 x 64 pixels: what a method
/// costs and errs on them stands for the whole picture, at 1/64 of the price.
std::vector<PictureRegion> pictureSample(int size);

/// The defaults, which are the preset `balanced`, for a method.
Parameters balanced(Method method);

/// A finished rendering.
struct Rendering {
  Film film;
  RenderStatistics statistics;
  std::shared_ptr<const Snapshot> snapshot;  ///< where the method has vectors
  double cpuSeconds = 0.0;                   ///< of all threads, from makeRenderer to the film
  double wallSeconds = 0.0;
};
Rendering render(const BenchScene& scene, const Parameters& parameters, const PictureRegion& region,
                 const std::shared_ptr<TaskPool>& pool);

}  // namespace lightvane
