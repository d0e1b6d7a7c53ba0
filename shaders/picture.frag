#version 330 core
// A picture's numbers as colours. What a pixel looks like is said once more in app/gl/picture_style.cpp: change both.

uniform sampler2D values;   // of the picture, as they were computed; row 0 is its top
uniform sampler2D colors;   // 256 x 1: the colour map, or the colours of the categories
uniform vec2 corner;        // the picture's top left, in framebuffer pixels from the bottom left
uniform float zoom;         // framebuffer pixels that a pixel of the picture is wide
uniform bool smoothly;      // magnify linearly
uniform int kind;           // ViewKind
uniform float gain;         // 2^stops
uniform int toneMap;        // ToneMap
uniform float low, high;    // the scale's ends; their base-2 logarithms where it is logarithmic
uniform bool logarithmic;
uniform int categoryCount;

out vec4 color;  // premultiplied

const int kRadiance = 0, kColor = 1, kScalar = 2;
const float kTiny = 1.17549435e-38;

vec3 encodeSrgb(vec3 linear) {
  linear = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, vec3(lessThanEqual(linear, vec3(0.0031308))));
}

vec3 decodeSrgb(vec3 encoded) {
  return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, vec3(lessThanEqual(encoded, vec3(0.04045))));
}

// https://github.com/TheRealMJP/BakingLab, ACES.hlsl: Stephen Hill's fit. By columns.
vec3 filmic(vec3 radiance) {
  const mat3 toFilm = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
  const mat3 toScreen = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
  vec3 v = toFilm * radiance;
  return toScreen * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

vec3 toneMapped(vec3 radiance) {
  if (toneMap == 1) return radiance / (1.0 + dot(radiance, vec3(0.2126, 0.7152, 0.0722)));
  if (toneMap == 2) return filmic(radiance);
  return radiance;
}

bool isBad(float x) { return isnan(x) || isinf(x) || x < 0.0; }

// A pixel of the picture in linear light. `invalid`: no averaging with its neighbours may hide it.
vec3 displayed(ivec2 texel, out bool invalid) {
  vec3 value = texelFetch(values, texel, 0).rgb;
  invalid = kind == kRadiance && (isBad(value.r) || isBad(value.g) || isBad(value.b));
  if (invalid) return decodeSrgb(vec3(1.0, 0.0, 1.0) * ((texel.x + texel.y) % 2 == 0 ? 1.0 : 160.0 / 255.0));
  if (kind == kRadiance) return clamp(toneMapped(min(value * gain, 1e6)), 0.0, 1.0);

  vec3 none = decodeSrgb(vec3((texel.x / 8 + texel.y / 8) % 2 == 0 ? 92.0 / 255.0 : 76.0 / 255.0));
  if (isnan(value.r)) return none;
  if (kind == kColor) return clamp(value, 0.0, 1.0);
  if (kind == kScalar) {
    float number = logarithmic ? log2(max(value.r, kTiny)) : value.r;
    float at = 255.0 * clamp((number - low) / max(high - low, logarithmic ? 1e-6 : 1e-30), 0.0, 1.0);
    int below = int(at);
    vec3 a = texelFetch(colors, ivec2(below, 0), 0).rgb, b = texelFetch(colors, ivec2(min(below + 1, 255), 0), 0).rgb;
    return decodeSrgb(mix(a, b, at - float(below)));
  }
  float category = floor(value.r + 0.5);
  if (category < 0.0 || category >= float(categoryCount)) return none;
  return decodeSrgb(texelFetch(colors, ivec2(int(category), 0), 0).rgb);
}

void main() {
  ivec2 size = textureSize(values, 0);
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

  vec2 span = smoothly ? max(reach, vec2(0.5)) : reach;
  vec2 lower = at - span, upper = at + span;
  ivec2 first = max(ivec2(floor(lower)), ivec2(0)), last = min(ivec2(ceil(upper)) - 1, size - 1);
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  bool invalid = false;
  for (int y = first.y; y <= last.y && !invalid; ++y) {
    for (int x = first.x; x <= last.x && !invalid; ++x) {
      vec2 overlap = min(upper, vec2(x + 1, y + 1)) - max(lower, vec2(x, y));
      float weight = overlap.x * overlap.y;
      vec3 texel = displayed(ivec2(x, y), invalid);
      sum = invalid ? texel : sum + weight * texel;
      weights = invalid ? 1.0 : weights + weight;
    }
  }
  vec3 shown = encodeSrgb(sum / weights);

  if (zoom >= 8.0 && !smoothly) {
    vec2 part = fract(at);
    float cross = min(abs(part.x - part.y), abs(part.x + part.y - 1.0)) * zoom * 0.7071;
    if (invalid) shown = mix(vec3(0.0), shown, clamp(cross - 0.06 * zoom + 0.5, 0.0, 1.0));
    // A line of one pixel of the screen where the picture's pixels meet.
    if (any(notEqual(floor(at - 0.5 / zoom - hair), floor(at + reach)))) {
      float contrast = dot(shown, vec3(0.2126, 0.7152, 0.0722)) > 0.5 ? 0.0 : 1.0;
      shown = mix(shown, vec3(contrast), 0.2);
    }
  }
  color = vec4(shown, 1.0) * coverage.x * coverage.y;
}
