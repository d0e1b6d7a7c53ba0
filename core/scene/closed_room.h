#pragma once

#include <optional>

#include "core/base/load_watch.h"
#include "core/scene/description.h"

namespace lightvane {

/// A lamp for a room without light: where the meshes that `scene` has close in what its first camera stands
/// in, so that no sky could be seen from there; else nothing. It hangs half way from the camera to what is
/// above, and by its intensity, W sr^-1, the room has a mean radiance of about 0.4.
///
/// Decided by 64 rays that are spread evenly over all directions, each against every triangle: 0.1 s for a
/// million of them. Where the first rays meet nothing, as under an open sky, no more are sent. What lets
/// light pass closes nothing in. Throws LoadStopped as `watch` says.
std::optional<PointLightDescription> lampForClosedRoom(const SceneDescription& scene, LoadWatch& watch);

}  // namespace lightvane
