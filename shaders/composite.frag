#version 330 core
// Lays a layer over what is there, pixel on pixel.

uniform sampler2D layer;  // premultiplied
uniform vec2 corner;      // its bottom left, in framebuffer pixels
uniform float opacity;

out vec4 color;

void main() { color = opacity * texelFetch(layer, ivec2(gl_FragCoord.xy - corner), 0); }
