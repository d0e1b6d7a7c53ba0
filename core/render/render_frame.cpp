#include "core/render/render_frame.h"

namespace lightvane {

RenderFrame makeFrame(const RenderContext& context, const Renderer& renderer) {
  RenderFrame frame;
  frame.scene = context.scene;
  frame.tracer = context.tracer;
  frame.camera = context.camera;
  frame.region = context.region;
  frame.parameters = context.parameters;
  frame.lights = context.lights;
  frame.film = std::make_shared<const Film>(renderer.film());
  frame.statistics = renderer.statistics();
  frame.progress = renderer.progress();
  frame.complete = renderer.done();
  renderer.addTo(frame);
  return frame;
}

}  // namespace lightvane
