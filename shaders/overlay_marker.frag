#version 330 core
#include "overlay_view.glsl"

in vec2 place;
flat in float radius;
flat in uint shape;  // MarkerShape
flat in vec4 markerColor;

out vec4 color;  // premultiplied

const uint kRing = 1u, kHollowDiamond = 3u, kSquare = 4u, kCross = 5u, kTriangle = 6u;

// Pixels from the edge, positive inside. The corners of a diamond and of a square reach as far as a disc of that size.
float depthInside() {
  if (shape <= kRing) return radius - length(place);
  vec2 side = abs(place);
  if (shape == kTriangle) return 0.5 * radius - max(0.866 * side.x + 0.5 * place.y, -place.y);
  // Two bars along the diagonals.
  if (shape == kCross)
    return min(0.5 * max(1.8 * uiScale, 0.3 * radius) - 0.7071 * abs(side.x - side.y), radius - length(place));
  return shape == kSquare ? 0.7071 * radius - max(side.x, side.y) : 0.7071 * (radius - side.x - side.y);
}

void main() {
  float inside = depthInside();
  if (shape == kRing || shape == kHollowDiamond || shape == kSquare) {
    // Half of its width. What frames a marker leaves it free.
    float band = 0.5 * max(1.5 * uiScale, (shape == kSquare ? 0.2 : 0.3) * radius);
    inside = band - abs(inside - band);
  }
  // A dark edge keeps a marker legible on a picture of its own colour.
  float whole = coverage(inside + 1.0 * uiScale), core = coverage(inside);
  float alpha = markerColor.a * mix(0.6 * whole, 1.0, core);
  if (alpha <= 0.0) discard;
  color = vec4(markerColor.rgb * core * markerColor.a, alpha);
}
