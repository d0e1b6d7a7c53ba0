#version 330 core
// A zone: the part of a plane around a record in which it may be used.
#include "overlay_view.glsl"

layout(location = 0) in vec3 centre;
layout(location = 1) in vec3 axisU;
layout(location = 2) in vec3 axisV;
layout(location = 3) in vec2 cutDirection;
layout(location = 4) in vec2 cutRange;
layout(location = 5) in float rimWidth;
layout(location = 6) in vec4 tint;

out vec3 world;
out vec2 uv;
flat out vec2 cut;
flat out vec2 range;
flat out float rim;
flat out vec4 zoneColor;

// How much longer an axis must be to have room for the soft edge, which is up to a pixel outside of the disc.
float withMargin(vec3 axis) {
  vec4 middle = worldToClip * vec4(centre, 1.0), end = worldToClip * vec4(centre + axis, 1.0);
  if (middle.w <= 0.0 || end.w <= 0.0) return 1.0;
  return 1.0 + 1.5 / max(distance(toScreen(middle), toScreen(end)), 0.5);
}

void main() {
  vec2 side = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  uv = side * vec2(withMargin(axisU), withMargin(axisV));
  world = centre + uv.x * axisU + uv.y * axisV;
  cut = cutDirection;
  range = cutRange;
  rim = rimWidth;
  zoneColor = tint;
  gl_Position = worldToClip * vec4(world, 1.0);
}
