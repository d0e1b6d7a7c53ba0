#version 330 core
// A line of constant width on the screen: a quad around it and its head.
#include "overlay_view.glsl"

layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;
layout(location = 2) in float widthPixels;
layout(location = 3) in vec4 tint;
layout(location = 4) in uint head;

out vec2 place;                 // pixels along the line from its beginning, and across
flat out vec3 lineFrom;         // its ends in the world, and by how much less is seen of a length there
flat out vec3 lineTo;
flat out vec2 lineDepths;
flat out vec2 lineStart;        // on the screen
flat out vec2 lineDirection;
flat out float lineLength;      // pixels
flat out float halfWidth;
flat out vec2 headSize;         // length and half width, pixels; 0 without a head
flat out vec4 lineColor;

// Nearer than this to the plane of the eye, places on the screen run away.
const float kNear = 1e-4;

void main() {
  vec4 a = worldToClip * vec4(from, 1.0), b = worldToClip * vec4(to, 1.0);
  float depthA = viewDepth(from), depthB = viewDepth(to);
  if (max(depthA, depthB) < kNear) {  // behind the camera: nowhere
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  float beginning = depthA < kNear ? (kNear - depthA) / (depthB - depthA) : 0.0;
  float end = depthB < kNear ? (kNear - depthA) / (depthB - depthA) : 1.0;
  vec4 first = mix(a, b, beginning), last = mix(a, b, end);
  vec2 start = toScreen(first), finish = toScreen(last);

  lineFrom = mix(from, to, beginning);
  lineTo = mix(from, to, end);
  lineDepths = vec2(first.w, last.w);
  lineStart = start;
  lineLength = distance(start, finish);
  vec2 along = lineLength > 1e-3 ? (finish - start) / lineLength : vec2(1.0, 0.0);
  lineDirection = along;
  vec2 across = vec2(-along.y, along.x);
  halfWidth = 0.5 * widthPixels * uiScale;
  headSize = vec2(0.0);
  if (head != 0u && end == 1.0) {
    // Long enough to be seen at the thinnest line; never so long that the shaft is not.
    float headLength = min(4.0 * uiScale + 4.0 * halfWidth, 0.6 * lineLength);
    headSize = headLength * vec2(1.0, 0.42);
  }
  lineColor = tint;

  bool atEnd = (gl_VertexID & 1) == 1;
  float margin = halfWidth + 1.0;
  float sideways = max(margin, headSize.y + 1.0) * (gl_VertexID < 2 ? -1.0 : 1.0);
  place = vec2(atEnd ? lineLength + margin : -margin, sideways);
  vec2 screen = start + place.x * along + place.y * across;
  gl_Position = vec4(2.0 * screen / areaSize - 1.0, 0.0, 1.0);
}
