#pragma once

#include <string>

#include "app/panels/controls.h"
#include "core/vectors/gather.h"

namespace lightvane {

class Scene;

/// What a hemisphere's picture shows.
enum class HemisphereLook { Radiance, Distance };

/// The cell under a point of the hemisphere's disc, as row and column; nothing outside of it. (0, 0) is the
/// middle and 1 the rim. Cells of the same solid angle have the same area (Lambert's projection): the normal
/// is in the middle, the tangent to the right.
struct HemisphereCell {
  int row = 0;
  int column = 0;

  bool operator==(const HemisphereCell&) const = default;
};
std::optional<HemisphereCell> hemisphereCellAt(const Hemisphere& hemisphere, float x, float y);

/// The cells of a gather as a disc as wide as the line, with the value under the mouse as a tooltip. Recorded
/// as "inspector.hemisphere".
void drawHemisphere(const ControlStyle& style, const Hemisphere& hemisphere, HemisphereLook look,
                    const Scene& scene);

}  // namespace lightvane
