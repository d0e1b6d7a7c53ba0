#include "core/scene/layer.h"

namespace lightvane {

Layer::Layer(const LayerDescription& description)
    : color_(description.color), isGgx_(description.model == LayerModel::Ggx) {
  if (isGgx_) {
    ggx_ = GgxLayer(description);
  } else {
    schlick_ = SchlickLayer(description);
  }
}

LayerMoments Layer::moments(const Vec3& outgoing, const LayerMoments& lambert) const {
  if (isGgx_) return ggx_.isMirror() ? LayerMoments{} : ggx_.moments(double{outgoing.z});
  LayerMoments moments{};
  if (hasGlossy()) moments = schlick_.glossyMoments(outgoing);
  // The excess at `outgoing` alone: the lobe divides by that of the incoming direction where it is higher.
  const double share = schlick_.glossyShare() / schlick_.excess(outgoing);
  for (std::size_t k = 0; k < moments.size(); ++k) {
    moments[k] = share * moments[k] + schlick_.lambertShare() * lambert[k];
  }
  return moments;
}

}  // namespace lightvane
