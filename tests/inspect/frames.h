#pragma once

#include "core/render/render_frame.h"
#include "tests/pictures/pictures.h"

// Frames for tests: small pictures together with what made them.

namespace lightvane::inspect_test {

using render_test::parametersWith;
using render_test::Settings;
using render_test::shippedScene;
using render_test::Stage;

/// A scene, the way it is rendered, and a name for the test's.
struct Way {
  const char* name;
  const char* scene;
  Settings settings;
  LightMix lights = {};  ///< for scenes of one light
};
inline void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

/// The frame of a rendering after `passes` passes; of the whole one where that is negative.
inline RenderFrame renderFrame(const Stage& stage, const Parameters& parameters, int passes = -1,
                               const CacheInput& cache = {}, const LightMix& lights = {}) {
  RenderContext context = stage.context(parameters);
  context.lights = lights;
  const std::unique_ptr<Renderer> renderer = makeRenderer(context, cache);
  const StopFlag never = false;
  for (int pass = 0; pass != passes && !renderer->done(); ++pass) {
    if (!renderer->runPass(never)) throw std::runtime_error("a pass stopped that nobody asked to");
  }
  return makeFrame(context, *renderer);
}

/// The frame of one of assets/scenes, `size` pixels wide and high.
inline RenderFrame renderShipped(const std::string& scene, int size, const Settings& settings = {},
                                 int passes = -1, const LightMix& lights = {}) {
  return renderFrame(Stage(shippedScene(scene, size, size)), parametersWith(settings), passes, {}, lights);
}

/// Direct and indirect vectors, and a mirror to see them in.
inline const RenderFrame& mirrorFrame() {
  static const RenderFrame frame = renderShipped(
      "cornell-mirror.toml", 64, {{"ilv.seed", "20"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}});
  return frame;
}

/// The same room, seen by parallel lines.
inline const RenderFrame& orthographicFrame() {
  static const RenderFrame frame = [] {
    SceneDescription description = shippedScene("cornell-mirror.toml", 64, 64);
    CameraDescription& camera = description.cameras.front();
    camera.projection = Projection::Orthographic;
    camera.orthographicHeight = 0.54;  // of the room, which is 0.549 high: nothing of the picture is empty
    return renderFrame(Stage(description),
                       parametersWith({{"ilv.seed", "20"}, {"dlv.mode", "always"}, {"dlv.seed", "300"}}));
  }();
  return frame;
}

/// A light that was dimmed and tinted twice, the second time after the ILVs were computed.
inline LightMix dimmedLight() { return {{Rgb(0.5f, 0.25f, 2.0f)}, {Rgb(1.5f, 0.25f, 0.5f)}}; }

}  // namespace lightvane::inspect_test
