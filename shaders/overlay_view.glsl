// What all overlays share: the camera's view, and the surfaces that they may lie behind. Places on the screen are in
// pixels of the area that the overlay is drawn into, from its bottom left.

uniform mat4 worldToClip;
uniform vec3 eye;
uniform vec2 areaSize;
uniform vec2 corner;      // the picture's top left
uniform float zoom;       // pixels of the screen that a pixel of the picture is wide
uniform float uiScale;
uniform sampler2D depth;  // of the picture: distance along each pixel's ray, the farthest of it and its neighbours
uniform float behind;     // opacity behind a surface
uniform float onSurface;  // how far behind is still on it, as a part of the distance

vec2 toScreen(vec4 clip) { return (0.5 * clip.xy / clip.w + 0.5) * areaSize; }

// The opacity of a point that shows at `screen`: what lies behind a surface is dimmed.
float opacityAt(vec3 point, vec2 screen) {
  ivec2 pixel = ivec2(floor(vec2(screen.x - corner.x, corner.y - screen.y) / zoom));
  float surface = texelFetch(depth, clamp(pixel, ivec2(0), textureSize(depth, 0) - 1), 0).r;
  return distance(point, eye) > surface * (1.0 + onSurface) ? behind : 1.0;
}

// From inside to outside within a pixel, for the distance from an edge in pixels, positive inside.
float coverage(float inside) { return clamp(inside + 0.5, 0.0, 1.0); }
