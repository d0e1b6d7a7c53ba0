#pragma once

#include "core/scene/scene.h"

namespace lightvane {

// How a camera moves under the hand: pure functions from camera to camera. Lengths are in normalised units,
// angles in radians, drags in pixels of the camera's picture. `up` is the world's, a unit vector: the horizon
// stays level.

/// The axis of the world that is nearest to where the camera's own up points: what a scene means by "up".
Vec3 worldUp(const Camera& camera);

/// Around the pivot, which stays where it is on the picture; not over the poles.
Camera orbited(const Camera& camera, const Vec3& pivot, const Vec3& up, float yaw, float pitch);
/// Turned on the spot.
Camera turned(const Camera& camera, const Vec3& up, float yaw, float pitch);
/// Moved in the picture's plane, so that what lies `depth` in front of the camera follows the drag.
Camera panned(const Camera& camera, const Vec2& drag, float depth);
/// Towards the pivot (factor < 1) or away from it; never into it. An orthographic camera stays as far away
/// and shows less or more about the pivot.
Camera dollied(const Camera& camera, const Vec3& pivot, float factor);
/// Moved along its own axes: right, up, forward; an orthographic one shows less in place of coming nearer.
Camera flown(const Camera& camera, const Vec3& step);
/// Looking the same way, from where a ball fills the picture; a lens focuses on it.
Camera framing(const Camera& camera, const Vec3& centre, float radius);

}  // namespace lightvane
