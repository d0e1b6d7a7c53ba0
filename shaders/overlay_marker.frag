#version 330 core
#include "overlay_view.glsl"

in vec2 place;
flat in float radius;
flat in uint shape;  // MarkerShape
flat in vec4 markerColor;

out vec4 color;  // premultiplied

const uint kRing = 1u, kHollowDiamond = 3u;

void main() {
  // Pixels from the edge, positive inside. A diamond's corners reach as far as a disc of its size.
  float inside = shape <= kRing ? radius - length(place) : 0.7071 * (radius - abs(place.x) - abs(place.y));
  if (shape == kRing || shape == kHollowDiamond) {
    float band = 0.5 * max(1.5 * uiScale, 0.3 * radius);  // half of its width
    inside = band - abs(inside - band);
  }
  // A dark edge keeps a marker legible on a picture of its own colour.
  float whole = coverage(inside + 1.0 * uiScale), core = coverage(inside);
  float alpha = markerColor.a * mix(0.6 * whole, 1.0, core);
  if (alpha <= 0.0) discard;
  color = vec4(markerColor.rgb * core * markerColor.a, alpha);
}
