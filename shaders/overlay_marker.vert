#version 330 core
// A record's place: a shape of constant size on the screen.
#include "overlay_view.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in float sizePixels;
layout(location = 2) in vec4 tint;
layout(location = 3) in uint markerShape;
layout(location = 4) in uint inMirror;  // an image, behind a mirror's surface and seen in it

out vec2 place;  // pixels from the middle
flat out float radius;
flat out uint shape;
flat out vec4 markerColor;

void main() {
  vec4 clip = worldToClip * vec4(position, 1.0);
  if (viewDepth(position) <= 0.0) {  // behind the camera: nowhere
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  vec2 middle = toScreen(clip);
  radius = 0.5 * sizePixels * uiScale;
  place = (vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0) * (radius + 2.0 * uiScale);
  shape = markerShape;
  // As a whole: half a marker says nothing about where its record is.
  markerColor = tint * vec4(1.0, 1.0, 1.0, inMirror != 0u ? 1.0 : opacityAt(position, middle));
  gl_Position = vec4(2.0 * (middle + place) / areaSize - 1.0, 0.0, 1.0);
}
