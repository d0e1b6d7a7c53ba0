#version 330 core
// What a picture's numbers look like, pixel for pixel. core/inspect/picture_style.cpp says the same on the CPU: change both.

uniform sampler2D values;  // as they were computed; row 0 is the picture's top
uniform sampler2D colors;  // 256 x 1: the colour map, or the colours of the categories
uniform int kind;          // ViewKind
uniform float gain;        // 2^stops
uniform int toneMap;       // ToneMap
uniform float low, high;   // the scale's ends; their base-2 logarithms where it is logarithmic
uniform bool logarithmic;
uniform int categoryCount;

out vec4 color;  // sRGB; alpha 0 where the value is invalid

const int kRadiance = 0, kColor = 1, kScalar = 2;
const float kTiny = 1.17549435e-38;

vec3 encodeSrgb(vec3 linear) {
  linear = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear, vec3(lessThanEqual(linear, vec3(0.0031308))));
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

bool isInvalid(float x) { return isnan(x) || isinf(x) || x < 0.0; }

vec3 onScale(float value) {
  float number = logarithmic ? log2(max(value, kTiny)) : value;
  float at = 255.0 * clamp((number - low) / max(high - low, logarithmic ? 1e-6 : 1e-30), 0.0, 1.0);
  int below = int(at);
  return mix(texelFetch(colors, ivec2(below, 0), 0).rgb, texelFetch(colors, ivec2(min(below + 1, 255), 0), 0).rgb,
             at - float(below));
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 value = texelFetch(values, pixel, 0).rgb;
  if (kind == kRadiance) {
    bool invalid = isInvalid(value.r) || isInvalid(value.g) || isInvalid(value.b);
    vec3 marker = vec3(1.0, 0.0, 1.0) * ((pixel.x + pixel.y) % 2 == 0 ? 1.0 : 160.0 / 255.0);
    color = invalid ? vec4(marker, 0.0) : vec4(encodeSrgb(toneMapped(min(value * gain, 1e6))), 1.0);
    return;
  }
  float category = floor(value.r + 0.5);
  bool none = isnan(value.r) || (kind > kScalar && (category < 0.0 || category >= float(categoryCount)));
  if (none) {
    color = vec4(vec3((pixel.x / 8 + pixel.y / 8) % 2 == 0 ? 92.0 / 255.0 : 76.0 / 255.0), 1.0);
  } else if (kind == kColor) {
    color = vec4(encodeSrgb(value), 1.0);
  } else if (kind == kScalar) {
    color = vec4(onScale(value.r), 1.0);
  } else {
    color = vec4(texelFetch(colors, ivec2(int(category), 0), 0).rgb, 1.0);
  }
}
