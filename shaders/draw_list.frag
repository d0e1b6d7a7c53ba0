#version 330 core

uniform sampler2D image;

in vec2 at;
in vec4 vertexColor;

out vec4 color;

void main() { color = vertexColor * texture(image, at); }
