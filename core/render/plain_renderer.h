#pragma once

#include <vector>

#include "core/render/renderer.h"

namespace lightvane {

/// The paper's rivals (section 6), which keep nothing: `naive`, a full gather at every visible point, and
/// `direct`, direct light with an ambient term. One pass for what is seen, then one for each quarter of the
/// picture, in rows of tiles spread over it.
class PlainRenderer : public Renderer {
 public:
  explicit PlainRenderer(RenderContext context);

  bool done() const override { return havePoints_ && part_ == kParts; }
  bool runPass(const StopFlag& stop) override;
  Film film() const override;
  const RenderStatistics& statistics() const override { return statistics_; }
  RenderProgress progress() const override;
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

 private:
  static constexpr int kParts = 4;

  struct PointLight {
    Rgb direct{0.0f};
    Rgb indirect{0.0f};
    Rgb irradiance{0.0f};  ///< direct; for the ambient term's mean
  };

  RenderContext context_;
  const Scene& scene_;
  VisiblePoints points_;
  std::shared_ptr<const SeenSurfaces> surfaces_;
  bool havePoints_ = false;
  int part_ = 0;
  std::vector<double>
      restored_;  ///< light of the parts that a checkpoint brought, until the points are known
  void takeRestored();

  std::vector<std::vector<PointLight>> light_;  ///< for each tile; empty while it is not computed
  RenderStatistics statistics_;
};

}  // namespace lightvane
