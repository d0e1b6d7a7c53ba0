#version 330 core
// A developed picture on the screen, at any zoom.

uniform sampler2D picture;  // sRGB; row 0 is its top; alpha 0 where a value is invalid
uniform vec2 corner;        // its top left, in framebuffer pixels from the bottom left
uniform float zoom;         // framebuffer pixels that a pixel of the picture is wide
uniform bool smoothly;      // magnify linearly

out vec4 color;  // premultiplied

void main() {
  ivec2 size = textureSize(picture, 0);
  vec2 at = vec2(gl_FragCoord.x - corner.x, corner.y - gl_FragCoord.y) / zoom;  // in the picture's pixels

  // What this pixel of the screen covers of the picture: the mean over it is right for every zoom. It minifies
  // without aliasing, gives magnified pixels crisp edges that are smooth where they fall between the screen's, and is
  // the pixel itself at zoom 1. A mean over the width of one pixel is linear interpolation. Rounding must not
  // bring in a neighbour by a hair's breadth, hence `hair`.
  float hair = 1e-3 / zoom;
  vec2 reach = vec2(0.5 / zoom - hair);
  vec2 inside = min(at + reach, vec2(size)) - max(at - reach, vec2(0.0));
  if (inside.x <= 0.0 || inside.y <= 0.0) discard;
  vec2 coverage = clamp(0.5 * inside / reach, 0.0, 1.0);

  // Squares stand for linear light, in which light is averaged: next to sRGB's true curve the difference is not seen,
  // and powers cost more than all the rest.
  vec2 span = smoothly ? max(reach, vec2(0.5)) : reach;
  vec2 lower = max(at - span, vec2(0.0)), upper = min(at + span, vec2(size));
  ivec2 first = ivec2(lower), last = min(ivec2(upper), size - 1);
  vec4 sum = vec4(0.0);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 overlap = min(upper, vec2(x + 1, y + 1)) - max(lower, vec2(x, y));
      vec4 texel = texelFetch(picture, ivec2(x, y), 0);
      sum += overlap.x * overlap.y * vec4(texel.rgb * texel.rgb, texel.a);
    }
  }
  vec2 extent = upper - lower;
  sum /= extent.x * extent.y;
  vec3 shown = sqrt(sum.rgb);

  // No mean may hide an invalid value.
  bool invalid = sum.a < 0.9999;
  if (invalid) shown = vec3(1.0, 0.0, 1.0) * ((int(at.x) + int(at.y)) % 2 == 0 ? 1.0 : 160.0 / 255.0);

  if (zoom >= 8.0 && !smoothly) {
    vec2 part = fract(at);
    float cross = min(abs(part.x - part.y), abs(part.x + part.y - 1.0)) * zoom * 0.7071;
    if (invalid) shown *= clamp(cross - 0.06 * zoom + 0.5, 0.0, 1.0);
    // A line of one pixel of the screen where the picture's pixels meet.
    if (any(notEqual(floor(at - 0.5 / zoom - hair), floor(at + reach)))) {
      float contrast = dot(shown, vec3(0.2126, 0.7152, 0.0722)) > 0.5 ? 0.0 : 1.0;
      shown = mix(shown, vec3(contrast), 0.2);
    }
  }
  color = vec4(shown, 1.0) * coverage.x * coverage.y;
}
