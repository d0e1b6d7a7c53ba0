#pragma once

#include <vector>

#include "core/render/renderer.h"

namespace lightvane {

/// Sums over a pixel's paths, in double: what a stopped rendering goes on from.
struct PathSums {
  glm::dvec3 emission{0.0}, direct{0.0}, indirect{0.0}, specular{0.0};
  /// Of each path's light: all of it, and two of its layers.
  glm::dvec3 squares{0.0}, directSquares{0.0}, indirectSquares{0.0};
};

/// Unbiased progressive path tracing with next-event estimation and multiple importance sampling: the
/// reference. Every pass adds some paths to every pixel.
class PathRenderer : public Renderer {
 public:
  explicit PathRenderer(RenderContext context);

  bool done() const override;
  bool runPass(const StopFlag& stop) override;
  Film film() const override;
  const RenderStatistics& statistics() const override { return statistics_; }
  RenderProgress progress() const override;

  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

 private:
  RenderContext context_;
  const Scene& scene_;
  std::shared_ptr<const SeenSurfaces> seen_;      ///< null until they are traced
  std::shared_ptr<const SeenSurfaces> surfaces_;  ///< what the film shows: from the first whole pass on
  std::vector<PathSums> sums_;
  int samplesDone_ = 0;
  RenderStatistics statistics_;
};

}  // namespace lightvane
