#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/render/light_slots.h"
#include "core/render/renderer.h"
#include "core/render/tile_answers.h"

namespace lightvane {

/// A picture together with all that made it, of one generation of the cache: what the session publishes, and
/// what views, overlays and reports are made from. Immutable; any thread may hold one for as long as it
/// likes.
struct RenderFrame {
  std::uint64_t number = 0;   ///< rises with every publication of a session
  std::uint64_t request = 0;  ///< of the session's requests, the one that it answers
  /// A coarse picture for a first look: one pixel for so many of the request's, across and down. 1 in all
  /// others.
  int reduction = 1;
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  Camera camera;
  PictureRegion region;
  Parameters parameters;
  LightMix lights;

  std::shared_ptr<const Film> film;  ///< complete at every pass boundary, coarse before the last
  RenderStatistics statistics;
  RenderProgress progress;
  bool complete = false;

  // Of the method `vectors` (but for the rules `printed`, which keep only their film); null or empty
  // otherwise.
  std::shared_ptr<const VisiblePoints> points;
  std::shared_ptr<const Snapshot> snapshot;
  std::vector<std::shared_ptr<const TileAnswers>> answers;  ///< one for each tile of `points`
  LightSlots lightSlots;                                    ///< of the answers
  /// With the lights as the picture has them, and as its ILVs have them; `tracer` where none is changed.
  std::shared_ptr<const Tracer> shownTracer, indirectTracer;
  /// The vectors that the rendering began with: with them the picture can be made again. Null where it began
  /// with none.
  std::shared_ptr<const Snapshot> warm;
  bool locked = false;  ///< no vector was computed
};

/// The renderer's picture as it stands. Between passes, on the renderer's thread. Cost: the film, as
/// Renderer::film.
RenderFrame makeFrame(const RenderContext& context, const Renderer& renderer);

}  // namespace lightvane
