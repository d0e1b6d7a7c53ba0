#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "core/render/light_slots.h"
#include "core/render/questions.h"
#include "core/render/renderer.h"
#include "core/render/tile_answers.h"
#include "core/vectors/answer.h"
#include "core/vectors/gather.h"

namespace lightvane {

/// The paper's method in passes: answer, thin, compute, publish (docs/architecture.md).
class VectorRenderer : public Renderer {
 public:
  VectorRenderer(RenderContext context, CacheInput cache);

  bool done() const override { return stage_ == Stage::Done; }
  bool runPass(const StopFlag& stop) override;
  Film film() const override;
  void addTo(RenderFrame& frame) const override;
  const RenderStatistics& statistics() const override { return statistics_; }
  RenderProgress progress() const override;
  const Snapshot* snapshot() const override { return snapshot_.get(); }
  std::shared_ptr<const Snapshot> gathered() const override;
  KnownView knownView() const override;
  bool askMore(std::span<const std::uint32_t> pixels) override;
  bool isOutOfMemory() const override { return outOfMemory_; }
  Checkpoint checkpoint() const override;
  /// The passes run again, but take the vectors of the checkpoint where they ask for the same.
  void restore(const Checkpoint& checkpoint) override;

 private:
  enum class Stage { Points, Known, Strides, Last, Refine, More, Done };

  /// What a look is for: what a warm cache knows already, where vectors are missing, or the picture.
  enum class Look { Known, Stride, Last };

  /// What a look asks for at a point.
  enum Ask : std::uint8_t { AskNothing = 0, AskDirect = 1, AskIndirect = 2, AskBoth = 3 };
  /// Of the points of each tile; empty where a tile has none to ask.
  using Asks = std::vector<std::vector<std::uint8_t>>;

  /// A point whose vector of some kind has to be computed.
  struct Miss {
    std::uint32_t tile;
    std::uint32_t point;
    SurfaceKey key;
    std::uint32_t light;  ///< index into LightSlots::vectorLights, or kNone for an indirect vector
    TileAnswers::LightReason reason = TileAnswers::Earlier;  ///< of a DLV
    std::uint32_t again = 0;  ///< of an ILV: not 0 where the point has its own, and wants others beside it
  };

  /// One look at a tile, kept apart until the pass is whole.
  struct TileLook {
    bool changed = false;
    TileAnswers answers;
    std::vector<Miss> misses;
  };

  /// What a thread needs; its counts are added up after every loop.
  struct Worker {
    Worker(const RenderContext& context, const Tracer& exact, const Tracer& indirect);
    void knowSight(const LightSight* sight);
    Gatherer gatherer;
    DirectLightSampler direct;    ///< of DLVs, free of RenderContext::lights
    DirectLightSampler exact;     ///< of lights without vectors
    DirectLightSampler mirrored;  ///< of lights in planar mirrors
    Answerer answerer;
    std::vector<std::uint8_t> asks;  ///< of a cluster's points
    std::vector<std::uint32_t> chosen;
    std::vector<std::uint32_t> needed;
    LightShares shares;                       ///< of the lights, at one point
    std::vector<std::uint32_t> worthVectors;  ///< likewise
    std::vector<std::uint32_t> mirroredNear;  ///< mirrored lights that the cluster may see
    std::vector<QueryPoint> queries;
    std::vector<IndirectAnswer> indirectAnswers;
    std::vector<DirectAnswer> directAnswers;
    RayCounts rays;
    SampleFaults faults;
    std::uint64_t fullDirect = 0;
  };

  struct FinishedDirect {
    std::uint32_t light;  ///< of the scene
    DirectLightVector record;
  };

  /// Where a warm cache's vector lies, as placeOf names it, and its number.
  struct WarmNumber {
    RandomKey place;
    std::size_t number;
    auto operator<=>(const WarmNumber&) const = default;
  };

  bool runPoints(const StopFlag& stop);
  /// Answers in which nothing is known but what CacheInput::known brought.
  void beginAnswers();
  /// Answers every point from a warm cache, so that later passes need not look where it was enough.
  bool runKnown(const StopFlag& stop);
  bool runStride(const StopFlag& stop);
  bool runLast(const StopFlag& stop);
  /// Gives pixels that differ from their neighbours all their samples, and answers those.
  bool runRefine(const StopFlag& stop);
  /// Computes what askMore asked for.
  bool runMore(const StopFlag& stop);

  /// What a pass goes back to that stops before all is answered: it is whole or it is not.
  struct State {
    std::shared_ptr<const VisiblePoints> points;
    std::shared_ptr<const SeenSurfaces> surfaces;
    std::vector<std::shared_ptr<const TileAnswers>> answers;
    std::shared_ptr<const Snapshot> snapshot;
    std::uint64_t fullIndirect = 0, fullDirect = 0;
  };
  State state() const {
    return {points_, surfaces_, answers_, snapshot_, statistics_.fullIndirect, statistics_.fullDirect};
  }
  bool giveUp(const State& before);
  /// The snapshot's vectors but those that it shares with another are taken where they are asked for again.
  void keepFinished(const Snapshot& snapshot, const Snapshot& but);
  void finish();
  /// Asks, computes what is missing and asks again where that reaches, until nothing is missing.
  bool answerAll(Asks asks, const StopFlag& stop);
  /// The refined points are the picture's. What was known of those that it had is known of them.
  void adopt(std::shared_ptr<const VisiblePoints> refined);

  std::vector<Miss> seedMisses() const;
  /// Looks at the points of the tile for what `asks` says of each.
  void look(std::uint32_t tileIndex, TileLook& result, Worker& worker, const StopFlag& stop, Look kind,
            std::span<const std::uint8_t> asks) const;
  /// The look's own answers, to be changed: at first a copy of the tile's, which frames may hold.
  TileAnswers& change(std::uint32_t tileIndex, TileLook& look) const;
  /// Both look at points of one cluster, Worker::needed, which `ball` holds.
  void lookDirect(std::uint32_t tileIndex, const Ball& ball, TileLook& look, Worker& worker, Look kind) const;
  /// Those of the lights with vectors that are, at a point: all, but for where they are many. Ascending;
  /// `lights` keeps them.
  std::span<const std::uint32_t> lightsWorthVectors(const VisiblePoint& point, LightShares& shares,
                                                    std::vector<std::uint32_t>& lights) const;
  /// Samples the lights with vectors that are faint at the point.
  void sampleFaint(std::uint32_t tileIndex, std::uint32_t index, TileAnswers& answers, Worker& worker) const;
  /// Direct light that no vector holds, at the points whose light was not sampled yet.
  void sampleOnce(std::uint32_t tileIndex, const Ball& ball, TileAnswers& answers, Worker& worker) const;
  /// Gives the point the answer of the DLVs, or of its own, or samples its light, or notes that it misses.
  void takeDirect(const Miss& asked, std::size_t lightSlot, const DirectAnswer& answer, TileLook& look,
                  Worker& worker, Look kind) const;
  void lookIndirect(std::uint32_t tileIndex, const Ball& ball, TileLook& look, Worker& worker,
                    Look kind) const;
  std::vector<TileLook> lookAtAll(const StopFlag& stop, Look kind, const Asks& asks);
  void takeAnswers(std::vector<TileLook>& looks);
  Asks askAll() const;
  /// What a stride has to ask: at the points of its grid that are not answered yet.
  Asks askStride() const;
  /// What the last pass has to ask, because the point is not answered for good, or because
  /// it is in reach of vectors that are not among the `known`. `weighsOwn`: points that their own vectors
  /// answered are still to be weighed with all others.
  Asks askUnsettled(const Snapshot& known, bool weighsOwn) const;
  /// Adds what is to be asked because the point is not answered for good.
  void askForMissing(const TileAnswers& answers, bool weighsOwn, std::vector<std::uint8_t>& asks) const;
  /// Whether a light with vectors has given the point no answer yet.
  bool isDirectUnknown(const TileAnswers& answers, std::size_t point) const;
  /// Whether the snapshot's DLVs are all that the picture asks for.
  bool settlesDirect() const;
  /// The picture is complete: its vectors settle its questions.
  void settleQuestions();

  std::vector<Miss> thin(const std::vector<TileLook>& looks) const;
  bool fitsInMemory(const std::vector<Miss>& misses) const;
  /// Computes the vectors of the misses; false when stopped, with the finished ones kept aside, and where
  /// they would take too much memory.
  bool compute(const std::vector<Miss>& misses, const StopFlag& stop,
               std::vector<IndirectLightVector>& indirect,
               std::vector<std::vector<DirectLightVector>>& direct);
  void publish(std::vector<IndirectLightVector> indirect, std::vector<std::vector<DirectLightVector>> direct);
  /// Gives the points of the misses the light of their own vectors, which are the snapshot's newest.
  void settleOwn(const std::vector<Miss>& misses, std::vector<TileLook>& looks) const;
  /// Takes the misses whose own vectors a warm cache has out of the list, and settles their points with
  /// those.
  void settleKnown(TileLook& look) const;
  bool settleKnown(const Miss& miss, TileAnswers& answers) const;
  /// Gives the point of a miss the light of its own vector, the snapshot's `number`.
  void settle(const Miss& miss, std::size_t number, TileAnswers& answers) const;
  void collectCounts(bool whole);
  void countAnswers();

  /// Of the miss's random numbers: the picture's, but for those of vectors beside a point's own.
  std::uint64_t seedOf(const Miss& miss) const;
  RandomKey memoKey(const Miss& miss) const;
  /// Names the place of the miss as placeKey does that of its vector, and the light.
  RandomKey placeOf(const Miss& miss) const;
  Rgb indirectRadiance(const VisiblePoint& point, SurfaceKey key, const Rgb& energy,
                       const Vec3& direction) const;
  const Brdf& brdfOf(const VisiblePoint& point) const { return scene_.materialOf(point.surface).brdf; }
  SurfaceKey directKey(const VisiblePoint& point) const;

  RenderContext context_;
  CacheInput cache_;
  const Scene& scene_;
  VectorRadii radii_;
  LightSlots slots_;
  std::shared_ptr<const Tracer> shownTracer_;     ///< lit by LightMix::direct
  std::shared_ptr<const Tracer> indirectTracer_;  ///< lit by LightMix::indirect
  Stage stage_ = Stage::Points;
  int stride_ = 1;
  int passes_ = 3;             ///< that there will be: of points, of one stride, the last
  bool looksAtKnown_ = false;  ///< there is a pass for Look::Known
  Questions questions_;
  /// The warm cache's ILVs are all that the picture asks for.
  bool isIndirectSettled_ = false;
  /// The snapshot's DLVs are all that there will be: a point that they do not serve is sampled.
  bool isDirectSettled_ = false;
  std::uint32_t firstPass_ = 0;  ///< Birth::pass of the first pass: those of a warm cache came before
  int knownSpacing_ = 0;         ///< RenderProgress::spacing
  std::shared_ptr<const VisiblePoints> points_;
  std::shared_ptr<const SeenSurfaces> surfaces_;
  std::vector<std::shared_ptr<const TileAnswers>> answers_;  ///< by tile
  KnownView unrefined_;                                      ///< knownView, once pixels are refined
  std::vector<Miss> more_;                                   ///< of askMore
  std::uint32_t moreRounds_ = 0;
  std::vector<Worker> workers_;
  std::shared_ptr<const Snapshot> snapshot_;
  // Of unfinished passes; not in the snapshot.
  std::unordered_map<RandomKey, IndirectLightVector, RandomKeyHash> finishedIndirect_;
  std::unordered_map<RandomKey, FinishedDirect, RandomKeyHash> finishedDirect_;
  std::vector<WarmNumber> warmNumbers_;  ///< sorted
  RenderStatistics statistics_;
  double hitRate_ = 0.0;
  bool outOfMemory_ = false;
};

/// The keys of the ILV trees that a BRDF draws on: irradiance for its Lambertian part and its lobe's own
/// under `split`, the whole BRDF's under `vector`.
struct SurfaceKeys {
  SurfaceKey keys[2];
  int count = 0;
};
SurfaceKeys indirectKeys(const Material& material, VectorStore store);

}  // namespace lightvane
