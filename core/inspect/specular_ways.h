#pragma once

#include <string>
#include <vector>

#include "core/render/render_frame.h"

namespace lightvane {

/// How a camera ray came to a visible point, or on to a light.
struct SpecularWay {
  std::string text;  ///< "seen straight", "by way of mirror (left wall)", "by way of glass (ball) and mirror"
  Vec3 position{0.0f};
  std::uint32_t surface = kNone;
  int depth = 0;  ///< specular events on the way
};

/// What a pixel's camera rays meet.
struct PixelWays {
  std::vector<SpecularWay> points;  ///< the pixel's visible points, in the order of VisiblePoints
  Rgb specularEmission{0.0f};       ///< of lights and the sky seen by way of mirrors and glass, normalised
  /// Where a ray ended without a point: "the background by way of mirror (tall block)", "a light (ceiling)".
  std::string end;
};

/// Traces a pixel's camera rays again: as the visible points were found, but remembering the way. `x`, `y`
/// count in the region's picture. Any thread. Cost: some microseconds a ray.
PixelWays tracePixelWays(const RenderFrame& frame, int x, int y);

}  // namespace lightvane
