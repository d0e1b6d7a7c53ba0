#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/render/film.h"
#include "core/render/parameters.h"
#include "core/render/tile_answers.h"
#include "core/render/visible_points.h"
#include "core/vectors/snapshot.h"

namespace lightvane {

struct RenderFrame;

/// What a rendering did so far. Counts are of published passes; a stopped pass adds nothing but rays.
struct RenderStatistics {
  RayCounts rays;
  SampleFaults faults;
  std::uint64_t ilvRecords = 0;
  std::uint64_t dlvRecords = 0;
  std::uint64_t fullIndirect = 0;  ///< ILVs and gathers computed in full
  std::uint64_t interpolatedIndirect =
      0;                         ///< visible points answered from vectors, in the picture as it stands
  std::uint64_t fullDirect = 0;  ///< direct lights computed in full, per point and light
  std::uint64_t interpolatedDirect = 0;  ///< direct lights answered from vectors, likewise
  std::uint64_t unanswered = 0;          ///< points that no vector answers, with the cache locked
  std::uint64_t refinedPixels = 0;       ///< that have more than one sample, where samples are adaptive
  int passes = 0;
};

/// How far a rendering is.
struct RenderProgress {
  std::string stage;      ///< "stride 8", "last pass", "16 of 64 samples"
  double fraction = 0.0;  ///< of the whole work, estimated
  /// Of what the points looked at so far ask for (indirect light, and that of each light with DLVs), the part
  /// that was interpolated.
  double hitRate = 0.0;
  /// Of the pixels whose light is known, across and down; the others show their neighbours. 0 where none is.
  int spacing = 0;
  int paths = 0;  ///< `path`: of every pixel so far
};

/// What a stopped rendering goes on from: as much as makes the result that of no stop. Plain numbers and
/// vectors; core/io puts it in a file together with what it belongs to.
struct Checkpoint {
  int passes = 0;
  int samples = 0;           ///< `path`: paths of every pixel in `sums`
  std::vector<double> sums;  ///< `path`, `naive`, `direct`: the renderer's own layout
  std::shared_ptr<const Snapshot>
      finished;  ///< `vectors`: every vector computed, those of an unfinished pass too
};

/// What a rendering with light vectors found out about its view of the scene.
struct KnownView {
  std::shared_ptr<const VisiblePoints> points;
  std::shared_ptr<const SeenSurfaces> surfaces;
  /// By tile: sampled direct light, of lights without vectors, of those in mirrors, and of points that no DLV
  /// served.
  std::vector<std::shared_ptr<const TileAnswers>> sampled;
  /// The questions for DLVs (Questions::direct) of which `sampled` has the answers, as far as it has any;
  /// RandomKey{} where they are not final.
  RandomKey directQuestions;
};

/// A picture in the making, pass by pass. Not thread-safe, except that `stop` may be set from anywhere.
class Renderer {
 public:
  virtual ~Renderer() = default;

  virtual bool done() const = 0;
  /// Runs the next pass. False when `stop` ended it early: the film then is that of the last whole pass.
  virtual bool runPass(const StopFlag& stop) = 0;
  /// The picture after the last whole pass; complete at every pass boundary, coarse before the last.
  virtual Film film() const = 0;
  virtual const RenderStatistics& statistics() const = 0;
  virtual RenderProgress progress() const = 0;
  virtual Checkpoint checkpoint() const = 0;
  /// Goes on from a checkpoint of the same scene, camera, region and parameters; before the first pass.
  virtual void restore(const Checkpoint& checkpoint) = 0;
  /// Adds to a frame what only this method has: points, vectors and answers.
  virtual void addTo(RenderFrame&) const {}
  /// Every vector computed so far, those of an unfinished pass too; null for methods without.
  virtual std::shared_ptr<const Snapshot> gathered() const { return nullptr; }
  /// For another rendering of the same view; empty for methods without vectors, and before the first pass.
  virtual KnownView knownView() const { return {}; }
  /// The next pass computes a vector at the visible points of these pixels of the region, another one where
  /// they have their own, and answers whatever that reaches; false where that is none. Only of a rendering
  /// that is done, with vectors that it may add to: it is done again after that pass.
  virtual bool askMore(std::span<const std::uint32_t>) { return false; }
  /// A pass would have taken more memory than CacheInput allows: the picture stays that of the last whole
  /// pass, and each further pass ends the same way.
  virtual bool isOutOfMemory() const { return false; }
  /// The vectors, for methods that have them.
  virtual const Snapshot* snapshot() const { return nullptr; }
};

/// Lights that are dimmed, tinted or put out while somebody looks. Direct light is kept for each light and
/// only weighed anew; indirect light holds all of them at once, and may lag behind.
struct LightMix {
  std::vector<Rgb> direct;  ///< by which each light's radiance is multiplied; empty: by 1
  std::vector<Rgb>
      indirect;  ///< likewise, for what is reflected at least once: those that ILVs were made with

  bool operator==(const LightMix&) const = default;
};

/// What every renderer works on. `scene` and `tracer` have the lights as their file has them.
struct RenderContext {
  std::shared_ptr<const Scene> scene;
  std::shared_ptr<const Tracer> tracer;
  Camera camera;
  PictureRegion region;
  Parameters parameters;
  std::shared_ptr<TaskPool> pool;
  LightMix lights = {};
};

/// What is known before the first pass, and whether new vectors may be computed.
struct CacheInput {
  std::shared_ptr<const Snapshot> warm;  ///< vectors of an earlier rendering, used as they are
  bool locked = false;                   ///< interpolate only
  /// A point at which one of those was computed takes that one. A preview's points are others': it saves
  /// looking.
  bool takesOwn = true;
  /// Of an earlier rendering, as far as it still holds (core/render/change.h): parts may be empty. Saves the
  /// rays, changes no byte.
  KnownView known = {};
  /// Of vectors, points and film, by core/render/memory.h; 0 where there is none. A pass that would go beyond
  /// it ends before it computes vectors: Renderer::isOutOfMemory.
  std::size_t memoryLimitBytes = 0;
};

/// A tracer whose lights are multiplied by the factors; the same one where there are none.
std::shared_ptr<const Tracer> relitTracer(const std::shared_ptr<const Tracer>& tracer,
                                          std::span<const Rgb> factors);

std::unique_ptr<Renderer> makeRenderer(const RenderContext& asked, const CacheInput& cache = {});

/// Lights that have a tree of Direct Light Vectors: by dlv.mode, or by counted costs where that is `auto`.
std::vector<bool> lightsWithVectors(const Scene& scene, const Parameters& parameters);

/// Whether the direct light of each light is kept, so that dimming one takes no new ray. Not where lights
/// without vectors are many, or those with them.
bool keepsLightsApart(const Scene& scene, const Parameters& parameters);

}  // namespace lightvane
