#pragma once

#include "tests/support/polygon_scene.h"

namespace lightvane {

/// The Cornell box as measured at Cornell University, in metres, with both blocks diffuse and white.
///
/// 17 polygons: floor, light, ceiling, back, right (green), left_a, left_b (red; the published quadrilateral
/// is not planar), short_0 to short_4, tall_0 to tall_4 (block tops are number 0). All are one-sided: the
/// backs of walls and the insides of the blocks receive no light, so that it makes no difference to a
/// two-sided box. The light hangs 0.5 mm under the ceiling, where the published one would lie in it, and
/// reflects nothing. The front, at z = 0, is open and the space outside black.
std::vector<DiffusePolygon> cornellBox();

/// The polygon that closes the front of the box, black, so that all light ends on some polygon.
DiffusePolygon cornellFront();

/// A cube [0, 1]³ seen from inside whose six walls, named "-x", "+x", "-y" to "+z", emit and reflect alike.
/// In it, irradiance is pi e / (1 - rho) everywhere and in every direction.
std::vector<DiffusePolygon> furnaceCube(const Vec3d& reflectance, const Vec3d& emission);

}  // namespace lightvane
