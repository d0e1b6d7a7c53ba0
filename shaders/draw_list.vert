#version 330 core
// ImGui's triangles, in points from the top left.

uniform vec2 displayPosition;
uniform vec2 displaySize;

layout(location = 0) in vec2 position;
layout(location = 1) in vec2 textureAt;
layout(location = 2) in vec4 tint;

out vec2 at;
out vec4 vertexColor;

void main() {
  at = textureAt;
  vertexColor = tint;
  vec2 part = (position - displayPosition) / displaySize;
  gl_Position = vec4(2.0 * part.x - 1.0, 1.0 - 2.0 * part.y, 0.0, 1.0);
}
