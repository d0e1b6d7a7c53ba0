#pragma once

#include <vector>

#include "core/render/renderer.h"
#include "core/vectors/gather.h"

namespace lightvane {

/// The paper's rivals (section 6), which keep nothing: `naive`, a full gather at every visible point, and
/// `direct`, direct light with an ambient term. One pass for what is seen, then one for the direct light of
/// each quarter of the picture, in rows of tiles spread over it; `naive` then gathers likewise, and shows the
/// ambient term until then.
class PlainRenderer : public Renderer {
 public:
  explicit PlainRenderer(RenderContext context);

  bool done() const override { return havePoints_ && part_ == partCount(); }
  bool runPass(const StopFlag& stop) override;
  Film film() const override;
  const RenderStatistics& statistics() const override { return statistics_; }
  RenderProgress progress() const override;
  Checkpoint checkpoint() const override;
  void restore(const Checkpoint& checkpoint) override;

 private:
  static constexpr int kParts = 4;

  struct Worker {
    Gatherer gatherer;
    DirectLightSampler direct;
    RayCounts rays;
    SampleFaults faults;
  };
  struct PointLight {
    Rgb direct{0.0f};
    Rgb indirect{0.0f};
    Rgb irradiance{0.0f};  ///< direct; for the ambient term's mean
  };

  bool isNaive() const { return context_.parameters.picture.method == Method::Naive; }
  int partCount() const { return isNaive() ? 2 * kParts : kParts; }
  void takeRestored();
  RandomKey keyOf(const VisiblePoint& point) const;
  void sampleDirect(const VisiblePoint& point, Worker& worker, PointLight& light) const;
  void gatherIndirect(const VisiblePoint& point, Worker& worker, PointLight& light) const;

  RenderContext context_;
  const Scene& scene_;
  std::vector<std::uint32_t> allLights_;  ///< their numbers
  VisiblePoints points_;
  std::shared_ptr<const SeenSurfaces> surfaces_;
  bool havePoints_ = false;
  int part_ = 0;  ///< the next, of partCount
  std::vector<double>
      restored_;  ///< light of the parts that a checkpoint brought, until the points are known
  std::vector<std::vector<PointLight>> light_;  ///< for each tile; empty while it is not computed
  RenderStatistics statistics_;
};

}  // namespace lightvane
