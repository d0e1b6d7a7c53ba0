#version 330 core
#include "overlay_view.glsl"

in vec2 place;
flat in vec3 lineFrom;
flat in vec3 lineTo;
flat in vec2 lineDepths;
flat in vec2 lineStart;
flat in vec2 lineDirection;
flat in float lineLength;
flat in float halfWidth;
flat in vec2 headSize;
flat in vec4 lineColor;

out vec4 color;  // premultiplied

void main() {
  // The shaft, round at its ends; it stops inside of the head, whose tip is the end of the line.
  float shaftLength = lineLength - 0.5 * headSize.x;
  float inside = halfWidth - length(vec2(place.x - clamp(place.x, 0.0, shaftLength), place.y));
  if (headSize.x > 0.0) {
    vec2 normal = normalize(headSize.yx);
    float side = -dot(normal, vec2(place.x - lineLength, abs(place.y)));
    inside = max(inside, min(side, place.x - (lineLength - headSize.x)));
  }
  float alpha = lineColor.a * coverage(inside);
  if (alpha <= 0.0) discard;
  // Whether the line is behind a surface is asked where the line itself is: beside it, a floor is nearer or farther.
  // What is halfway on the screen is nearer than halfway in the world, in perspective.
  float part = lineLength > 0.0 ? clamp(place.x / lineLength, 0.0, 1.0) : 0.0;
  float worldPart = part * lineDepths.x / mix(lineDepths.y, lineDepths.x, part);
  vec2 screen = lineStart + part * lineLength * lineDirection;
  color = vec4(lineColor.rgb, 1.0) * alpha * opacityAt(mix(lineFrom, lineTo, worldPart), screen);
}
