// What all overlays share: the camera's view, and the surfaces that they may lie behind. Places on the screen are in
// pixels of the area that the overlay is drawn into, from its bottom left.

uniform mat4 worldToClip;
uniform vec3 eye;
uniform vec3 forward;         // the viewing axis, a unit vector
uniform float pictureHeight;  // what an orthographic picture shows of the world; 0 where lines of sight meet in the eye
uniform vec2 areaSize;
uniform vec2 corner;      // the picture's top left
uniform float zoom;       // pixels of the screen that a pixel of the picture is wide
uniform float uiScale;
uniform sampler2D depth;  // of the picture: distance along each pixel's ray, the farthest of it and its neighbours
uniform float behind;     // opacity behind a surface
uniform float onSurface;  // how far behind is still on it, as a part of the distance; orthographic, of the height

// The distance along the viewing axis.
float viewDepth(vec3 point) { return dot(point - eye, forward); }

vec2 toScreen(vec4 clip) { return (0.5 * clip.xy / clip.w + 0.5) * areaSize; }

// The opacity of a point that shows at `screen`: what lies behind a surface is dimmed.
float opacityAt(vec3 point, vec2 screen) {
  ivec2 pixel = ivec2(floor(vec2(screen.x - corner.x, corner.y - screen.y) / zoom));
  float surface = texelFetch(depth, clamp(pixel, ivec2(0), textureSize(depth, 0) - 1), 0).r;
  bool hidden = pictureHeight > 0.0 ? viewDepth(point) > surface + onSurface * pictureHeight
                                    : distance(point, eye) > surface * (1.0 + onSurface);
  return hidden ? behind : 1.0;
}

// From inside to outside within a pixel, for the distance from an edge in pixels, positive inside.
float coverage(float inside) { return clamp(inside + 0.5, 0.0, 1.0); }
