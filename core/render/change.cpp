#include "core/render/change.h"

#include <string_view>

#include "core/vectors/validity.h"

namespace lightvane {
namespace {

/// What a new value of the field makes untrue.
void apply(StillTrue& still, const Field& field) {
  const std::string_view key = field.key;
  if (key.starts_with("ilv.")) {
    still.radii = false;
    if (field.cost == ChangeCost::Vectors && key != "ilv.seed") still.indirectVectors = false;
    // Measured with the points, for whoever asks for it.
    if (key == "ilv.clearance") still.points = false;
  } else if (key.starts_with("dlv.")) {
    still.radii = false;
    if (field.cost == ChangeCost::Vectors && key != "dlv.seed") still.directVectors = false;
    // Which lights are sampled.
    if (key == "dlv.mode") still.sampled = false;
  } else if (key == "seed" || key == "method.rules") {
    still.sampled = still.indirectVectors = still.directVectors = false;
  } else if (key == "film.samples" || key == "film.contrast" || key == "method.name") {
    // Light vectors measure more at a point than their rivals.
    still.points = false;
  } else if (key.starts_with("specular.")) {
    still.points = still.sampled = still.indirectVectors = false;
  } else if (key == "light.samples") {
    // It may also decide which lights have vectors.
    still.sampled = still.directVectors = false;
  } else if (key == "light.bounce_samples") {
    still.indirectVectors = false;
  } else if (key == "light.mirrored" || key == "path.roulette" || key == "path.max_bounces") {
    still.sampled = still.indirectVectors = false;
  }
  // What is left (passes.*, samples of the rivals) decides where vectors are computed or what
  // they are compared with, not what is in them.
}

}  // namespace

StillTrue stillTrue(const Scene& scene, const Parameters& before, const Parameters& after) {
  StillTrue still;
  const std::vector<FieldDescription> old = describeParameters(before);
  const std::vector<FieldDescription> now = describeParameters(after);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (old[i].value != now[i].value) apply(still, now[i].field);
  }
  // Answers keep one slot for each light that is sampled.
  if (lightsWithVectors(scene, before) != lightsWithVectors(scene, after)) still.sampled = false;
  if (!still.points) still.sampled = false;
  return still;
}

StillTrue stillTrue(const Scene& scene, const Parameters& before, const LightMix& lightsBefore,
                    const Parameters& after, const LightMix& lightsAfter) {
  StillTrue still = stillTrue(scene, before, after);
  if (lightsBefore.indirect != lightsAfter.indirect) still.indirectVectors = still.sampled = false;
  if (lightsBefore.direct != lightsAfter.direct && !keepsLightsApart(scene, after)) still.sampled = false;
  return still;
}

std::shared_ptr<const Snapshot> stillTrueVectors(std::shared_ptr<const Snapshot> snapshot,
                                                 const StillTrue& still, const Scene& scene,
                                                 const Parameters& after) {
  if (!snapshot || (!still.indirectVectors && !still.directVectors)) return nullptr;
  if (still.indirectVectors && still.directVectors && still.radii) return snapshot;
  auto next = std::make_shared<Snapshot>();
  next->generation = snapshot->generation + 1;
  next->direct.resize(snapshot->direct.size());
  const VectorRadii radii(after.vectors, scene);
  if (still.indirectVectors) next->indirect = snapshot->indirect.rebuilt(radii);
  if (still.directVectors) {
    for (std::size_t light = 0; light < next->direct.size(); ++light)
      next->direct[light] = snapshot->direct[light].rebuilt(radii);
  }
  return next;
}

}  // namespace lightvane
