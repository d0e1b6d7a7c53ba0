#pragma once

#include <vector>

#include "core/render/renderer.h"

namespace lightvane {

/// The method as the paper prints it (section 3.3): a seed, then the picture row by row, each full
/// computation stored at once and used by the next pixel. Serial, with a cache of its own and its faults
/// intact: it exists to show them, and its samples are not checked.
class PrintedRenderer : public Renderer {
 public:
  explicit PrintedRenderer(RenderContext context);

  bool done() const override { return havePoints_ && row_ >= context_.region.height; }
  /// The visible points, then sixteen rows a pass.
  bool runPass(const StopFlag& stop) override;
  Film film() const override { return film_; }
  const RenderStatistics& statistics() const override { return statistics_; }
  RenderProgress progress() const override;
  const Snapshot* snapshot() const override { return &cache_; }

  Checkpoint checkpoint() const override { return {}; }
  /// Nothing to go on from: what a row finds depends on every row before it, so a stopped picture begins
  /// anew.
  void restore(const Checkpoint&) override {}

 private:
  struct Tools;

  void storeSeed(Tools& tools);
  void shade(const VisiblePoint& point, Tools& tools);
  Rgb directLight(const VisiblePoint& point, std::uint32_t light, Tools& tools);
  Rgb indirectLight(const VisiblePoint& point, Tools& tools);
  DirectLightVector storeDirect(const VisiblePoint& point, std::uint32_t light, Tools& tools);
  IndirectLightVector storeIndirect(const VisiblePoint& point, Tools& tools);

  RenderContext context_;
  const Scene& scene_;
  VectorRadii radii_;
  std::vector<bool> hasVectors_;  ///< for each light
  bool havePoints_ = false;
  int row_ = 0;                       ///< next row of the picture
  std::vector<VisiblePoint> points_;  ///< by pixel, row by row
  std::size_t next_ = 0;              ///< next point
  Film film_;
  Snapshot cache_;
  RenderStatistics statistics_;
};

}  // namespace lightvane
