#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace lightvane {

// Which images of lights in planar mirrors may be left out, before any of their points is chosen: seen from a
// place, two convex outlines that a plane through that place and a side of one of them parts do not overlap.
// Conservative by a margin for rounding, so that what is left out would have given nothing. Images that are
// not one polygon always stay.

/// Numbers in Scene::mirroredLights of those that may be seen from somewhere in the ball; ascending, in place
/// of what `near` had. Cost: some ten planes for each, so that it is asked for many points at once.
void mirroredLightsNear(const Scene& scene, const Vec3& centre, float radius,
                        std::vector<std::uint32_t>& near);

/// What maySeeMirroredLight leaves open: whether the mirror is at least in part within the image's outline,
/// seen from `position`.
bool imageMayMeetMirror(const Scene& scene, const MirroredLight& mirrored, const Vec3& position);

}  // namespace lightvane
