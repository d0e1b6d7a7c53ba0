#version 330 core
#include "overlay_view.glsl"

uniform float fillOpacity;
uniform float rimOpacity;

in vec3 world;
in vec2 uv;
flat in vec2 cut;
flat in vec2 range;
flat in float rim;
flat in vec4 zoneColor;

out vec4 color;  // premultiplied

// By how much `value` changes from a pixel to the next.
float slope(float value) { return max(length(vec2(dFdx(value), dFdy(value))), 1e-12); }

void main() {
  float r = length(uv), rSlope = slope(r);
  float s = dot(cut, uv), sSlope = slope(s);
  float inside = (1.0 - r) / rSlope;  // pixels from the edge
  if (cut != vec2(0.0)) inside = min(inside, min(s - range.x, range.y - s) / sSlope);
  // Nothing else clips what is behind an orthographic camera.
  if (inside < -0.5 || viewDepth(world) <= 0.0) discard;

  float opacity = fillOpacity;
  if (rim > 0.0) opacity = mix(opacity, rimOpacity, coverage((r - (1.0 - rim)) / rSlope));
  opacity = mix(1.0, opacity, coverage(inside - 1.25 * uiScale));  // the outline
  color = vec4(zoneColor.rgb, 1.0) * zoneColor.a * opacity * coverage(inside) * opacityAt(world, gl_FragCoord.xy);
}
