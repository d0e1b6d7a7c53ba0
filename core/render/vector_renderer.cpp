#include "core/render/vector_renderer.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <type_traits>

#include "core/base/check.h"
#include "core/render/film_contrast.h"
#include "core/render/learn_sight.h"
#include "core/render/memory.h"
#include "core/render/point_answers.h"
#include "core/render/render_frame.h"
#include "core/render/seed.h"
#include "core/trace/mirrored_lights.h"

namespace lightvane {
namespace {

// Vectors computed by one task: a few milliseconds of gathers, so that stopping is quick and threads end
// together.
constexpr std::size_t kMissesPerTask = 8;

struct GridPlace {
  int x, y;
};
/// Places on a grid relative to the next one above and to the left, the near ones first.
std::vector<GridPlace> gridPlaces(int reach) {
  std::vector<GridPlace> places;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) places.push_back({x, y});
  }
  // From the middle of the cell.
  const auto squared = [](const GridPlace& place) {
    return (2 * place.x - 1) * (2 * place.x - 1) + (2 * place.y - 1) * (2 * place.y - 1);
  };
  std::stable_sort(places.begin(), places.end(),
                   [&](const GridPlace& a, const GridPlace& b) { return squared(a) < squared(b); });
  return places;
}

/// Before the last pass most pixels were not looked at: such a pixel (`unknown`) shows one of a coarser grid
/// that was, of the same kind (1: seen straight, 2: by way of mirrors) and as alike in orientation as there
/// is around, the nearest first. The grids are those of `finest` and its doubles.
void fillUnknown(Film& film, const Image<std::uint8_t>& unknown, const Image<std::uint8_t>& kinds, int finest,
                 TaskPool& pool) {
  static const std::vector<GridPlace> kNear = gridPlaces(1);
  static const std::vector<GridPlace> kFar = gridPlaces(3);
  constexpr float kAlike = 0.999f;
  constexpr int kCoarsest = 1024;
  const auto bestOfGrid = [&](int x, int y, int spacing, const std::vector<GridPlace>& places, bool ofKind) {
    std::optional<std::size_t> best;
    float bestLikeness = 0.0f;
    for (const GridPlace& place : places) {
      const int cx = (x / spacing + place.x) * spacing;
      const int cy = (y / spacing + place.y) * spacing;
      if (cx < 0 || cy < 0 || cx >= film.width || cy >= film.height) continue;
      const int shared = kinds.at(cx, cy) & kinds.at(x, y);
      const bool isOfUse = ofKind ? shared == kinds.at(x, y) : kinds.at(cx, cy) != 0;
      if (unknown.at(cx, cy) != 0 || !isOfUse) continue;
      const float likeness = glm::dot(film.normal().at(cx, cy), film.normal().at(x, y));
      if (best && likeness <= bestLikeness) continue;
      bestLikeness = likeness;
      best = film.direct.index(cx, cy);
      if (likeness >= kAlike) break;
    }
    return best;
  };
  // What is unknown is written, and what is known is read.
  pool.forEach(static_cast<std::size_t>(film.height), [&](std::size_t row, int) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < film.width; ++x) {
      if (unknown.at(x, y) == 0) continue;
      std::optional<std::size_t> known;
      const auto search = [&](const std::vector<GridPlace>& places, bool ofKind) {
        for (int spacing = finest; spacing <= kCoarsest && !known; spacing *= 2)
          known = bestOfGrid(x, y, spacing, places, ofKind);
      };
      search(kNear, true);
      // A kind that is seen here and there, or of which nothing is known.
      search(kFar, true);
      search(kFar, false);
      if (!known) continue;
      film.direct.at(x, y) = film.direct[*known];
      film.indirect.at(x, y) = film.indirect[*known];
      film.specular.at(x, y) = film.specular[*known];
    }
  });
}

}  // namespace

SurfaceKeys indirectKeys(const Material& material, VectorStore store) {
  SurfaceKeys keys{};
  if (store == VectorStore::Vector) {
    keys.keys[keys.count++] = brdfSurfaceKey(material.brdfKey);
    return keys;
  }
  if (material.brdf.hasDiffuse()) keys.keys[keys.count++] = kLambertKey;
  if (material.brdf.hasLobe()) keys.keys[keys.count++] = brdfSurfaceKey(material.brdfKey);
  return keys;
}

VectorRenderer::Worker::Worker(const RenderContext& context, const Tracer& exactTracer,
                               const Tracer& indirectTracer)
    : gatherer(indirectTracer, context.parameters.transport, context.parameters.vectors),
      direct(*context.tracer, context.parameters.transport),
      exact(exactTracer, context.parameters.transport),
      mirrored(indirectTracer, context.parameters.transport),
      answerer(*context.tracer, context.parameters.vectors) {}

void VectorRenderer::Worker::knowSight(const LightSight* sight) {
  gatherer.knowSight(sight);
  exact.knowSight(sight);
}

VectorRenderer::VectorRenderer(RenderContext context, CacheInput cache)
    : context_(std::move(context)),
      cache_(std::move(cache)),
      scene_(*context_.scene),
      radii_(context_.parameters.vectors, scene_),
      slots_(scene_, context_.parameters, context_.lights.direct),
      shownTracer_(relitTracer(context_.tracer, context_.lights.direct)),
      indirectTracer_(relitTracer(context_.tracer, context_.lights.indirect)) {
  for (int i = 0; i < context_.pool->threadCount(); ++i)
    workers_.emplace_back(context_, slots_.keepsApart() ? *context_.tracer : *shownTracer_, *indirectTracer_);
  if (cache_.warm) {
    snapshot_ = cache_.warm;
    const auto know = [&](const auto& records, const auto& nameOf) {
      for (std::size_t i = 0; i < records.size(); ++i) {
        const auto& record = records[i];
        firstPass_ = std::max(firstPass_, record.birth.pass + 1);
        if (cache_.takesOwn) warmNumbers_.push_back({nameOf(placeKey(record)), i});
      }
    };
    know(snapshot_->indirect, [](const RandomKey& place) { return place; });
    for (const std::uint32_t light : slots_.vectorLights())
      know(snapshot_->direct[light], [&](const RandomKey& place) { return place.with(light); });
    std::sort(warmNumbers_.begin(), warmNumbers_.end());
  } else {
    auto empty = std::make_shared<Snapshot>();
    empty->direct.resize(scene_.lights.size());
    snapshot_ = empty;
  }
  LV_CHECK(snapshot_->direct.size() == scene_.lights.size(), "{} trees for {} lights",
           snapshot_->direct.size(), scene_.lights.size());
  const PictureParameters& picture = context_.parameters.picture;
  stride_ = std::max(picture.firstStride, picture.lastStride);
  for (int s = stride_; s / 2 >= picture.lastStride && s > 1; s /= 2) ++passes_;
  questions_ = questionsOf(context_.camera, context_.region, context_.parameters);
  isIndirectSettled_ = cache_.warm && snapshot_->indirect.settles(questions_.indirect);
  isDirectSettled_ = cache_.locked || settlesDirect();
  looksAtKnown_ = cache_.warm && !cache_.locked;
  if (looksAtKnown_) ++passes_;
  if (isAdaptive(context_.parameters)) ++passes_;
}

bool VectorRenderer::runPass(const StopFlag& stop) {
  const bool whole = stage_ == Stage::Points    ? runPoints(stop)
                     : stage_ == Stage::Known   ? runKnown(stop)
                     : stage_ == Stage::Strides ? runStride(stop)
                     : stage_ == Stage::Last    ? runLast(stop)
                     : stage_ == Stage::Refine  ? runRefine(stop)
                     : stage_ == Stage::More    ? runMore(stop)
                                                : true;
  collectCounts(whole);
  if (whole) {
    ++statistics_.passes;
    countAnswers();
  }
  return whole;
}

bool VectorRenderer::runPoints(const StopFlag& stop) {
  std::shared_ptr<const SeenSurfaces> surfaces = cache_.known.surfaces;
  if (cache_.known.points && surfaces) {
    points_ = cache_.known.points;
  } else {
    auto points = std::make_shared<VisiblePoints>();
    auto seen = std::make_shared<SeenSurfaces>(context_.region.width, context_.region.height);
    if (!traceVisiblePoints(*shownTracer_, context_.camera, context_.region, context_.parameters,
                            *context_.pool, stop, *points, *seen, statistics_.rays)) {
      return false;
    }
    points->sight = std::make_shared<const LightSight>(
        learnSight(*context_.tracer, context_.camera, *context_.pool, stop, statistics_.rays));
    if (stop) return false;
    points_ = std::move(points);
    surfaces = std::move(seen);
  }
  for (Worker& worker : workers_) worker.knowSight(points_->sight.get());
  beginAnswers();
  // A warm cache is a seed already.
  if (!cache_.locked && !cache_.warm) {
    const std::vector<Miss> seed = seedMisses();
    std::vector<IndirectLightVector> indirect;
    std::vector<std::vector<DirectLightVector>> direct;
    if (!compute(seed, stop, indirect, direct)) {
      answers_.clear();
      return false;
    }
    publish(std::move(indirect), std::move(direct));
    std::vector<TileLook> looks(answers_.size());
    settleOwn(seed, looks);
    takeAnswers(looks);
  }
  surfaces_ = std::move(surfaces);
  stage_ = cache_.locked ? Stage::Last : looksAtKnown_ ? Stage::Known : Stage::Strides;
  return true;
}

bool VectorRenderer::runKnown(const StopFlag& stop) {
  std::vector<TileLook> looks = lookAtAll(stop, Look::Known, askAll());
  if (stop) return false;
  takeAnswers(looks);
  stage_ = Stage::Strides;
  return true;
}

void VectorRenderer::takeAnswers(std::vector<TileLook>& looks) {
  for (std::size_t t = 0; t < looks.size(); ++t) {
    if (looks[t].changed) answers_[t] = std::make_shared<const TileAnswers>(std::move(looks[t].answers));
  }
}

void VectorRenderer::beginAnswers() {
  const auto& sampled = cache_.known.sampled;
  answers_.resize(points_->tiles.size());
  context_.pool->forEach(answers_.size(), [&](std::size_t t, int) {
    auto answers = std::make_shared<TileAnswers>();
    const std::size_t points = points_->tiles[t].points.size();
    answers->resize(points, slots_.sharedCount());
    if (!sampled.empty()) {
      const TileAnswers& known = *sampled[t];
      answers->sampled = known.sampled;
      answers->mirrored = known.mirrored;
      for (const std::uint32_t light : known.lights) answers->addLight(light);
      std::copy_n(known.lightDirect.begin(), slots_.exactCount() * points, answers->lightDirect.begin());
      // Where a light is faint, that is so whatever vectors there are.
      slots_.forEachAsked(known, [&](std::size_t, std::size_t slot) {
        const std::span<const std::uint8_t> states = known.statesOf(slot);
        for (std::size_t i = 0; i < points; ++i) {
          const bool isFaint = states[i] == TileAnswers::Faint;
          answers->lightState[slot * points + i] = isFaint ? TileAnswers::Faint : TileAnswers::Unknown;
        }
      });
      // Answers of the same DLVs to the same questions.
      const bool hasVectors = !slots_.vectorLights().empty();
      if (hasVectors && settlesDirect() && cache_.known.directQuestions == questions_.direct) {
        answers->lightDirect = known.lightDirect;
        answers->lightState = known.lightState;
        answers->lightReason = known.lightReason;
        answers->fullDlv = known.fullDlv;
      }
    }
    answers_[t] = std::move(answers);
  });
}

std::vector<VectorRenderer::Miss> VectorRenderer::seedMisses() const {
  std::vector<Miss> seed;
  std::set<std::tuple<std::uint32_t, std::uint32_t, SurfaceKey, std::uint32_t>> chosen;
  // A dense seed meets a point more than once.
  const auto addOnce = [&](const Miss& miss) {
    if (chosen.emplace(miss.tile, miss.point, miss.key, miss.light).second) seed.push_back(miss);
  };
  const PictureRegion& region = context_.region;
  const auto scatter = [&](int count, std::uint32_t stream, const auto& add) {
    for (const SeedPlace& place : seedPlaces(region, count, context_.parameters.picture.seed, stream)) {
      const std::uint32_t tile = tileOfPixel(region, place.pixel);
      const std::vector<VisiblePoint>& points = points_->tiles[tile].points;
      if (const VisiblePoint* point = place.choose(points))
        add(tile, static_cast<std::uint32_t>(point - points.data()));
    }
  };
  scatter(context_.parameters.vectors.ilv.seed, kIndirectSeed, [&](std::uint32_t tile, std::uint32_t point) {
    const SurfaceKeys keys = indirectKeys(scene_.materialOf(points_->tiles[tile].points[point].surface),
                                          context_.parameters.vectors.ilv.store);
    for (int k = 0; k < keys.count; ++k) addOnce({tile, point, keys.keys[k], kNone});
  });
  if (slots_.vectorLights().empty()) return seed;
  LightShares shares;
  std::vector<std::uint32_t> asked;
  scatter(context_.parameters.vectors.dlv.seed, kDirectSeed, [&](std::uint32_t tile, std::uint32_t point) {
    const VisiblePoint& p = points_->tiles[tile].points[point];
    for (const std::uint32_t light : lightsWorthVectors(p, shares, asked))
      addOnce(
          {tile, point, directKey(p), static_cast<std::uint32_t>(slots_.indexOf(light)), TileAnswers::Seed});
  });
  return seed;
}

bool VectorRenderer::runStride(const StopFlag& stop) {
  std::vector<TileLook> looks = lookAtAll(stop, Look::Stride, askStride());
  if (stop) return false;
  const std::vector<Miss> misses = thin(looks);
  std::vector<IndirectLightVector> indirect;
  std::vector<std::vector<DirectLightVector>> direct;
  if (!compute(misses, stop, indirect, direct)) return false;
  publish(std::move(indirect), std::move(direct));
  settleOwn(misses, looks);
  takeAnswers(looks);
  knownSpacing_ = stride_;
  if (stride_ / 2 >= context_.parameters.picture.lastStride && stride_ > 1) {
    stride_ /= 2;
  } else {
    stage_ = Stage::Last;
  }
  return true;
}

bool VectorRenderer::runLast(const StopFlag& stop) {
  const State before = state();
  if (!answerAll(looksAtKnown_ ? askUnsettled(*cache_.warm, true) : askAll(), stop)) return giveUp(before);
  knownSpacing_ = 1;
  if (isAdaptive(context_.parameters)) {
    stage_ = Stage::Refine;
  } else {
    finish();
  }
  return true;
}

bool VectorRenderer::runRefine(const StopFlag& stop) {
  const State before = state();
  const KnownView unrefined = knownView();
  const Image<std::uint8_t> differing =
      pixelsThatDiffer(film(), context_.parameters.picture.filmContrast, *context_.pool);
  auto points = std::make_shared<VisiblePoints>(*points_);
  auto seen = std::make_shared<SeenSurfaces>(*surfaces_);
  if (!refineVisiblePoints(*shownTracer_, context_.camera, differing, context_.parameters, *context_.pool,
                           stop, *points, *seen, statistics_.rays)) {
    return false;
  }
  adopt(std::move(points));
  surfaces_ = std::move(seen);
  if (!answerAll(askUnsettled(*snapshot_, false), stop)) return giveUp(before);
  unrefined_ = unrefined;
  statistics_.refinedPixels = static_cast<std::uint64_t>(
      std::count_if(differing.begin(), differing.end(), [](auto v) { return v != 0; }));
  finish();
  return true;
}

bool VectorRenderer::askMore(std::span<const std::uint32_t> pixels) {
  if (stage_ != Stage::Done || cache_.locked) return false;
  more_.clear();
  ++moreRounds_;
  for (const std::uint32_t pixel : pixels) {
    const PixelPoints found = pointsOfPixel(*points_, pixel);
    const TileAnswers& answers = *answers_[found.tile];
    const VisibleTile& tile = points_->tiles[found.tile];
    for (std::uint32_t i = found.first; i < found.first + found.count; ++i) {
      const SurfaceKeys keys =
          indirectKeys(scene_.materialOf(tile.points[i].surface), context_.parameters.vectors.ilv.store);
      for (std::size_t k = 0; k < static_cast<std::size_t>(keys.count); ++k) {
        const bool hasOwn = answers.own[k * tile.points.size() + i] != 0;
        more_.push_back({found.tile, i, keys.keys[k], kNone, TileAnswers::Earlier, hasOwn ? moreRounds_ : 0});
      }
    }
  }
  if (more_.empty()) return false;
  ++passes_;
  stage_ = Stage::More;
  return true;
}

bool VectorRenderer::runMore(const StopFlag& stop) {
  const State before = state();
  std::vector<IndirectLightVector> indirect;
  std::vector<std::vector<DirectLightVector>> direct;
  if (!compute(more_, stop, indirect, direct)) return false;
  publish(std::move(indirect), std::move(direct));
  std::vector<TileLook> looks(answers_.size());
  settleOwn(more_, looks);
  takeAnswers(looks);
  // A vector of a point's own is one among those around it.
  if (!answerAll(askUnsettled(*before.snapshot, true), stop)) return giveUp(before);
  finish();
  return true;
}

void VectorRenderer::finish() {
  if (!cache_.locked) settleQuestions();
  stage_ = Stage::Done;
}

bool VectorRenderer::giveUp(const State& before) {
  keepFinished(*snapshot_, *before.snapshot);
  points_ = before.points;
  surfaces_ = before.surfaces;
  answers_ = before.answers;
  snapshot_ = before.snapshot;
  statistics_.fullIndirect = before.fullIndirect;
  statistics_.fullDirect = before.fullDirect;
  return false;
}

void VectorRenderer::keepFinished(const Snapshot& snapshot, const Snapshot& but) {
  for (std::size_t i = but.indirect.size(); i < snapshot.indirect.size(); ++i)
    finishedIndirect_.emplace(snapshot.indirect[i].birth.identity, snapshot.indirect[i]);
  for (std::uint32_t light = 0; light < snapshot.direct.size(); ++light) {
    const RecordSet<DirectLightVector>& direct = snapshot.direct[light];
    for (std::size_t i = light < but.direct.size() ? but.direct[light].size() : 0; i < direct.size(); ++i)
      finishedDirect_.emplace(direct[i].birth.identity, FinishedDirect{light, direct[i]});
  }
}

void VectorRenderer::adopt(std::shared_ptr<const VisiblePoints> refined) {
  context_.pool->forEach(answers_.size(), [&](std::size_t t, int) {
    const std::vector<VisiblePoint>& old = points_->tiles[t].points;
    const std::vector<VisiblePoint>& now = refined->tiles[t].points;
    auto answers = std::make_shared<TileAnswers>();
    answers->resize(now.size(), slots_.sharedCount());
    for (const std::uint32_t light : answers_[t]->lights) answers->addLight(light);
    // Both are sorted by pixel, and the first samples of a pixel met the same in the same order.
    std::size_t o = 0;
    for (std::size_t n = 0; n < now.size(); ++n) {
      if (now[n].sample != 0) continue;
      while (o < old.size() && old[o].pixel < now[n].pixel) ++o;
      // But for a ray that grazes an edge in another packet.
      if (o == old.size() || old[o].pixel != now[n].pixel || old[o].surface != now[n].surface) continue;
      answers->take(n, *answers_[t], o++);
    }
    answers_[t] = std::move(answers);
  });
  points_ = std::move(refined);
  // By points that the tiles no longer have.
  cache_.known.sampled.clear();
}

bool VectorRenderer::answerAll(Asks asks, const StopFlag& stop) {
  for (;;) {
    std::vector<TileLook> looks = lookAtAll(stop, Look::Last, asks);
    if (stop) return false;
    const std::vector<Miss> misses = thin(looks);
    if (misses.empty() || cache_.locked) {
      takeAnswers(looks);
      return true;
    }
    std::vector<IndirectLightVector> indirect;
    std::vector<std::vector<DirectLightVector>> direct;
    if (!compute(misses, stop, indirect, direct)) return false;
    const std::shared_ptr<const Snapshot> known = snapshot_;
    publish(std::move(indirect), std::move(direct));
    settleOwn(misses, looks);
    takeAnswers(looks);
    asks = askUnsettled(*known, false);
  }
}

bool VectorRenderer::settlesDirect() const {
  const std::span<const std::uint32_t> lights = slots_.vectorLights();
  return std::all_of(lights.begin(), lights.end(), [&](std::uint32_t light) {
    return snapshot_->direct[light].settles(questions_.direct);
  });
}

void VectorRenderer::settleQuestions() {
  auto settled = std::make_shared<Snapshot>(*snapshot_);
  settled->indirect = snapshot_->indirect.settling(questions_.indirect);
  for (const std::uint32_t light : slots_.vectorLights())
    settled->direct[light] = snapshot_->direct[light].settling(questions_.direct);
  snapshot_ = std::move(settled);
}

VectorRenderer::Asks VectorRenderer::askAll() const {
  Asks all(points_->tiles.size());
  for (std::size_t t = 0; t < all.size(); ++t) all[t].assign(points_->tiles[t].points.size(), AskBoth);
  return all;
}

VectorRenderer::Asks VectorRenderer::askStride() const {
  Asks asks(points_->tiles.size());
  context_.pool->forEach(asks.size(), [&](std::size_t t, int) {
    const std::vector<VisiblePoint>& points = points_->tiles[t].points;
    const TileAnswers& answers = *answers_[t];
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool isSatisfied = answers.satisfied[i] != 0;
      if (isSatisfied && answers.looked[i] != 0) continue;
      const int x = static_cast<int>(points[i].pixel) % context_.region.width;
      const int y = static_cast<int>(points[i].pixel) / context_.region.width;
      if (x % stride_ != 0 || y % stride_ != 0) continue;
      const bool asksDirect = answers.sampled[i] == 0 || isDirectUnknown(answers, i);
      asks[t].resize(points.size());
      asks[t][i] = isSatisfied ? AskDirect : asksDirect ? AskBoth : AskIndirect;
    }
  });
  return asks;
}

VectorRenderer::Asks VectorRenderer::askUnsettled(const Snapshot& known, bool weighsOwn) const {
  const auto newerThan = [&](const auto& before, const auto& now) {
    using Set = std::remove_cvref_t<decltype(now)>;
    std::vector<typename Set::Record> newer;
    for (std::size_t i = before.size(); i < now.size(); ++i) newer.push_back(now[i]);
    return Set().with(std::move(newer), radii_);
  };
  const RecordSet<IndirectLightVector> indirect = newerThan(known.indirect, snapshot_->indirect);
  std::vector<RecordSet<DirectLightVector>> direct;
  for (const std::uint32_t light : slots_.vectorLights())
    direct.push_back(newerThan(known.direct[light], snapshot_->direct[light]));
  Asks asks(points_->tiles.size());
  context_.pool->forEach(asks.size(), [&](std::size_t t, int) {
    const VisibleTile& tile = points_->tiles[t];
    const TileAnswers& answers = *answers_[t];
    asks[t].resize(tile.points.size());
    std::vector<std::uint32_t> found;
    std::vector<TreeEntry> zones;
    for (const PointCluster& cluster : tile.clusters) {
      const auto askWhereReached = [&](const auto& added, SurfaceKey key, Ask ask) {
        added.query(key, cluster.ball.centre, cluster.ball.radius, found);
        zones.clear();
        // Rounding may not make the reach shorter than where the vector is valid.
        for (const std::uint32_t number : found)
          zones.push_back({added[number].point.position, radii_(added[number]) * (1.0f + 0x1p-20f)});
        for (const std::uint32_t i : cluster.points) {
          const Ball point{tile.points[i].position, 0.0f};
          const bool isReached = std::any_of(zones.begin(), zones.end(),
                                             [&](const TreeEntry& zone) { return zone.meets(point); });
          if (isReached) asks[t][i] = static_cast<std::uint8_t>(asks[t][i] | ask);
        }
      };
      const VisiblePoint& first = tile.points[cluster.points.front()];
      const SurfaceKeys keys =
          indirectKeys(scene_.materialOf(first.surface), context_.parameters.vectors.ilv.store);
      for (int k = 0; k < keys.count; ++k) askWhereReached(indirect, keys.keys[k], AskIndirect);
      slots_.forEachAsked(answers, [&](std::size_t l, std::size_t) {
        askWhereReached(direct[l], directKey(first), AskDirect);
      });
    }
    askForMissing(answers, weighsOwn, asks[t]);
  });
  return asks;
}

void VectorRenderer::askForMissing(const TileAnswers& answers, bool weighsOwn,
                                   std::vector<std::uint8_t>& asks) const {
  // A miss that was thinned away has to be looked at again, whether or not a vector came near. Choices are
  // values, so that the loops are vectorised.
  const std::size_t points = asks.size();
  const std::uint8_t ownCounts = weighsOwn ? 1 : 0;
  for (std::size_t i = 0; i < points; ++i) {
    const std::uint8_t weighs = ownCounts & (answers.own[i] | answers.own[points + i]);
    const bool asksIndirect = (answers.satisfied[i] == 0) | (weighs != 0);
    asks[i] |= asksIndirect ? AskIndirect : AskNothing;
    asks[i] |= answers.sampled[i] == 0 ? AskDirect : AskNothing;
  }
  slots_.forEachAsked(answers, [&](std::size_t, std::size_t slot) {
    const std::span<const std::uint8_t> states = answers.statesOf(slot);
    for (std::size_t i = 0; i < points; ++i)
      asks[i] |= states[i] == TileAnswers::Unknown ? AskDirect : AskNothing;
  });
}

bool VectorRenderer::isDirectUnknown(const TileAnswers& answers, std::size_t point) const {
  bool isUnknown = false;
  slots_.forEachAsked(answers, [&](std::size_t, std::size_t slot) {
    isUnknown |= answers.statesOf(slot)[point] == TileAnswers::Unknown;
  });
  return isUnknown;
}

std::vector<VectorRenderer::TileLook> VectorRenderer::lookAtAll(const StopFlag& stop, Look kind,
                                                                const Asks& asks) {
  std::vector<TileLook> looks(points_->tiles.size());
  context_.pool->forEach(looks.size(), [&](std::size_t t, int worker) {
    if (stop || asks[t].empty()) return;
    look(static_cast<std::uint32_t>(t), looks[t], workers_[static_cast<std::size_t>(worker)], stop, kind,
         asks[t]);
  });
  return looks;
}

TileAnswers& VectorRenderer::change(std::uint32_t tileIndex, TileLook& look) const {
  if (!look.changed) look.answers = *answers_[tileIndex];
  look.changed = true;
  return look.answers;
}

void VectorRenderer::look(std::uint32_t tileIndex, TileLook& result, Worker& worker, const StopFlag& stop,
                          Look kind, std::span<const std::uint8_t> asks) const {
  const VisibleTile& tile = points_->tiles[tileIndex];
  for (const PointCluster& cluster : tile.clusters) {
    if (stop) return;
    worker.asks.clear();
    for (const std::uint32_t i : cluster.points) worker.asks.push_back(asks[i]);
    Ball ball{};
    worker.needed.clear();
    for (const Ask part : {AskDirect, AskIndirect}) {
      worker.chosen.clear();
      for (std::size_t n = 0; n < cluster.points.size(); ++n) {
        if ((worker.asks[n] & part) != 0) worker.chosen.push_back(cluster.points[n]);
      }
      if (worker.chosen.empty()) continue;
      change(tileIndex, result);
      if (worker.chosen != worker.needed) {
        std::swap(worker.chosen, worker.needed);
        worker.queries.clear();
        for (const std::uint32_t i : worker.needed)
          worker.queries.push_back(queryPoint(tile.points[i], context_.parameters.vectors.ilv));
        ball = ballAround(tile, worker.needed);
      }
      if (part == AskDirect) {
        lookDirect(tileIndex, ball, result, worker, kind);
      } else {
        lookIndirect(tileIndex, ball, result, worker, kind);
      }
    }
    // What the warm cache does not know shows its neighbours until a pass comes to it.
    for (std::size_t n = 0; n < cluster.points.size(); ++n) {
      if (worker.asks[n] == AskNothing) continue;
      const std::uint32_t i = cluster.points[n];
      const bool isKnown = result.answers.answered[i] != 0 && !isDirectUnknown(result.answers, i);
      result.answers.looked[i] = kind != Look::Known || isKnown ? 1 : 0;
    }
  }
  if (kind == Look::Known) {
    result.misses.clear();
  } else if (!warmNumbers_.empty()) {
    settleKnown(result);
  }
}

void VectorRenderer::lookDirect(std::uint32_t tileIndex, const Ball& ball, TileLook& look, Worker& worker,
                                Look kind) const {
  sampleOnce(tileIndex, ball, look.answers, worker);
  if (slots_.vectorLights().empty()) return;
  const VisibleTile& tile = points_->tiles[tileIndex];
  const SurfaceKey key = directKey(tile.points[worker.needed.front()]);
  const float lobeWidth = directLobeWidth(brdfOf(tile.points[worker.needed.front()]));
  worker.directAnswers.resize(worker.queries.size());
  slots_.forEachAsked(look.answers, [&](std::size_t l, std::size_t slot) {
    const auto isFinal = [&](std::uint32_t i) {
      const std::uint8_t state = look.answers.statesOf(slot)[i];
      // Vectors that came after its light was sampled may serve the point.
      return state == TileAnswers::Computed || state == TileAnswers::Faint ||
             (isDirectSettled_ && state != TileAnswers::Unknown) ||
             (kind != Look::Last && state == TileAnswers::Sampled);
    };
    if (std::all_of(worker.needed.begin(), worker.needed.end(), isFinal)) return;
    worker.answerer.answerDirect(snapshot_->direct[slots_.vectorLights()[l]], key, worker.queries,
                                 ball.centre, ball.radius, lobeWidth, worker.directAnswers);
    for (std::size_t n = 0; n < worker.needed.size(); ++n) {
      const std::uint32_t i = worker.needed[n];
      if (isFinal(i)) continue;
      takeDirect({tileIndex, i, key, static_cast<std::uint32_t>(l)}, slot, worker.directAnswers[n], look,
                 worker, kind);
    }
  });
}

void VectorRenderer::sampleOnce(std::uint32_t tileIndex, const Ball& ball, TileAnswers& answers,
                                Worker& worker) const {
  const VisibleTile& tile = points_->tiles[tileIndex];
  const int samples = context_.parameters.transport.lightSamples;
  const bool asksMirrors = worker.mirrored.samplesMirrored() &&
                           std::any_of(worker.needed.begin(), worker.needed.end(),
                                       [&](std::uint32_t i) { return answers.sampled[i] == 0; });
  const RandomKey seed = randomKey(context_.parameters.picture.seed);
  worker.mirroredNear.clear();
  if (asksMirrors) mirroredLightsNear(scene_, ball.centre, ball.radius, worker.mirroredNear);
  const bool isNoneNear = slots_.exactLights().empty() && worker.mirroredNear.empty();
  for (const std::uint32_t i : worker.needed) {
    if (answers.sampled[i] != 0) continue;
    if (slots_.isByTile()) sampleFaint(tileIndex, i, answers, worker);
    answers.sampled[i] = 1;
    if (isNoneNear) continue;
    const VisiblePoint& p = tile.points[i];
    const LitPoint lit = p.lit(scene_);
    const RandomKey key = pointKey(context_.region, p, seed);
    // Lights that are kept apart are few, each with a slot of its own; all others share the first one.
    const std::size_t group = slots_.keepsApart() ? 1 : slots_.exactLights().size();
    for (std::size_t first = 0; first < slots_.exactLights().size(); first += group) {
      const DirectLightEstimate e = worker.exact.estimateTogether(
          lit, slots_.exactLights().subspan(first, group), samples, key, worker.rays, worker.faults);
      const std::size_t slot = slots_.slotOf(answers, slots_.exactLights()[first]);
      answers.lightDirect[slot * tile.points.size() + i] += reflectedRadiance(brdfOf(p), p.tint(), e);
      worker.fullDirect += group;
    }
    if (worker.mirroredNear.empty()) continue;
    const DirectLightEstimate mirrored =
        worker.mirrored.estimateMirrored(lit, worker.mirroredNear, samples, key, worker.rays, worker.faults);
    answers.mirrored[i] = reflectedRadiance(brdfOf(p), p.tint(), mirrored);
  }
}

void VectorRenderer::sampleFaint(std::uint32_t tileIndex, std::uint32_t index, TileAnswers& answers,
                                 Worker& worker) const {
  const std::vector<VisiblePoint>& points = points_->tiles[tileIndex].points;
  const VisiblePoint& p = points[index];
  for (const std::uint32_t light : lightsWorthVectors(p, worker.shares, worker.worthVectors))
    slots_.claim(answers, light);
  slots_.forEachAsked(answers, [&](std::size_t l, std::size_t slot) {
    const bool isWorth =
        std::binary_search(worker.worthVectors.begin(), worker.worthVectors.end(), slots_.vectorLights()[l]);
    if (!isWorth) answers.lightState[slot * points.size() + index] = TileAnswers::Faint;
  });
  const RandomKey key = pointKey(context_.region, p, randomKey(context_.parameters.picture.seed));
  const DirectLightEstimate estimate =
      worker.exact.estimateFaint(p.lit(scene_), slots_.vectorLights(), worker.shares,
                                 context_.parameters.transport.lightSamples, key, worker.rays, worker.faults);
  answers.lightDirect[index] += reflectedRadiance(brdfOf(p), p.tint(), estimate);
}

std::span<const std::uint32_t> VectorRenderer::lightsWorthVectors(const VisiblePoint& p, LightShares& shares,
                                                                  std::vector<std::uint32_t>& lights) const {
  if (!slots_.isByTile()) return slots_.vectorLights();
  lights.clear();
  shares.weigh(scene_, p.position, p.normal, points_->sight.get());
  for (const LightTree::Part& part : shares.parts()) {
    if (LightShares::isWorthVectors(part) && slots_.hasVectors(part.number)) lights.push_back(part.number);
  }
  std::sort(lights.begin(), lights.end());
  return lights;
}

void VectorRenderer::takeDirect(const Miss& asked, std::size_t lightSlot, const DirectAnswer& answer,
                                TileLook& look, Worker& worker, Look kind) const {
  TileAnswers& answers = look.answers;
  // What was computed at the point answers it, as in the passes that filled the cache.
  if (answer.hasVector && settleKnown(asked, answers)) return;
  const VisibleTile& tile = points_->tiles[asked.tile];
  const VisiblePoint& p = tile.points[asked.point];
  const std::size_t slot = lightSlot * tile.points.size() + asked.point;
  const bool isSampled = answers.lightState[slot] == TileAnswers::Sampled;
  if (answer.accepted) {
    if (isSampled) --answers.fullDlv[asked.point];
    answers.lightState[slot] = TileAnswers::Interpolated;
    answers.lightReason[slot] = TileAnswers::NotInFull;
    answers.lightDirect[slot] = directRadiance(brdfOf(p), p, context_.parameters.vectors.dlv.store,
                                               answer.energy, answer.lobeRadiance, answer.direction);
    return;
  }
  if (isSampled) return;
  const auto reason = answer.verdict == DirectVerdict::TooFew ? TileAnswers::TooFew : TileAnswers::TooUnlike;
  // Where vectors that are as dense as misses are kept do not serve, more of them would not either.
  const bool isDense = answer.nearest < static_cast<float>(context_.parameters.picture.thin) * p.footprint;
  if (kind != Look::Last && !isDirectSettled_ && !isDense) {
    answers.lightState[slot] = TileAnswers::Unknown;
    look.misses.push_back({asked.tile, asked.point, asked.key, asked.light, reason});
    return;
  }
  // Whoever no DLVs serve computes its own light, which is not stored. The same samples give the same light.
  const TileAnswers* known = cache_.known.sampled.empty() ? nullptr : cache_.known.sampled[asked.tile].get();
  const bool isKnown =
      known != nullptr && slot < known->lightState.size() && known->lightState[slot] == TileAnswers::Sampled;
  if (isKnown) {
    answers.lightDirect[slot] = known->lightDirect[slot];
  } else {
    const RandomKey key = pointKey(context_.region, p, randomKey(context_.parameters.picture.seed));
    const DirectLightEstimate e =
        worker.direct.estimate(p.lit(scene_), slots_.vectorLights()[asked.light],
                               context_.parameters.transport.lightSamples, key, worker.rays, worker.faults);
    answers.lightDirect[slot] = reflectedRadiance(brdfOf(p), p.tint(), e);
    ++worker.fullDirect;
  }
  answers.lightState[slot] = TileAnswers::Sampled;
  answers.lightReason[slot] = reason;
  ++answers.fullDlv[asked.point];
}

void VectorRenderer::lookIndirect(std::uint32_t tileIndex, const Ball& ball, TileLook& look, Worker& worker,
                                  Look kind) const {
  const VisibleTile& tile = points_->tiles[tileIndex];
  TileAnswers& answers = look.answers;
  const IlvParameters& ilv = context_.parameters.vectors.ilv;
  const bool last = kind == Look::Last;
  // Settled ones are as many as the last pass found enough.
  const int nMin = last || isIndirectSettled_ ? ilv.nMinLast : ilv.nMin;
  const SurfaceKeys keys =
      indirectKeys(scene_.materialOf(tile.points[worker.needed.front()].surface), ilv.store);
  worker.indirectAnswers.resize(worker.queries.size());
  for (const std::uint32_t i : worker.needed) {
    answers.satisfied[i] = 1;
    answers.answered[i] = 1;
  }
  for (int k = 0; k < keys.count; ++k) {
    worker.answerer.answerIndirect(snapshot_->indirect, keys.keys[k], worker.queries, ball.centre,
                                   ball.radius, worker.indirectAnswers, worker.rays);
    for (std::size_t n = 0; n < worker.needed.size(); ++n) {
      const std::uint32_t i = worker.needed[n];
      const std::size_t slot = static_cast<std::size_t>(k) * tile.points.size() + i;
      const bool own = answers.own[slot] != 0;
      const IndirectAnswer& answer = worker.indirectAnswers[n];
      // What was computed here answers the point, until the last pass weighs it with all others.
      if (own && (!last || answer.count == 0)) continue;
      answers.indirect[slot] =
          answer.count > 0 ? indirectRadiance(tile.points[i], keys.keys[k], answer.energy, answer.direction)
                           : Rgb(0.0f);
      if (k == 0) {
        answers.ilvCount[i] = static_cast<std::uint16_t>(answer.count);
        answers.nearest[i] = answer.nearest;
      }
      if (answer.count == 0) answers.answered[i] = 0;
      if (answer.count < nMin && !own) {
        answers.satisfied[i] = 0;
        look.misses.push_back({tileIndex, i, keys.keys[k], kNone});
      }
    }
  }
}

std::vector<VectorRenderer::Miss> VectorRenderer::thin(const std::vector<TileLook>& looks) const {
  // A spatial hash whose cells are as large as the distance below which two misses share a vector.
  struct Kept {
    Vec3 position;
    Vec3 normal;
    SurfaceKey key;
    std::uint32_t light;
  };
  std::unordered_map<RandomKey, std::vector<Kept>, RandomKeyHash> cells;
  std::vector<Miss> kept;
  const auto thinPixels = static_cast<float>(context_.parameters.picture.thin);
  for (const TileLook& look : looks) {
    for (const Miss& miss : look.misses) {
      const VisiblePoint& p = points_->tiles[miss.tile].points[miss.point];
      const float apart = thinPixels * p.footprint;
      if (!(apart > 0.0f)) {
        kept.push_back(miss);
        continue;
      }
      int level = 0;
      std::frexp(apart, &level);
      const float size = std::ldexp(1.0f, level);
      const auto cellOf = [&](float x, int offset) {
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(x / size)) + offset);
      };
      const auto cellKey = [&](int dx, int dy, int dz) {
        return RandomKey{}
            .with(static_cast<std::uint32_t>(level))
            .with(cellOf(p.position.x, dx))
            .with(cellOf(p.position.y, dy))
            .with(cellOf(p.position.z, dz));
      };
      bool isShared = false;
      for (int d = 0; d < 27 && !isShared; ++d) {
        const auto cell = cells.find(cellKey(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1));
        if (cell == cells.end()) continue;
        for (const Kept& other : cell->second) {
          const Vec3 away = other.position - p.position;
          if (other.key == miss.key && other.light == miss.light && glm::dot(away, away) < apart * apart &&
              glm::dot(other.normal, p.normal) > 0.8f) {
            isShared = true;
            break;
          }
        }
      }
      if (isShared) continue;
      cells[cellKey(0, 0, 0)].push_back({p.position, p.normal, miss.key, miss.light});
      kept.push_back(miss);
    }
  }
  return kept;
}

std::uint64_t VectorRenderer::seedOf(const Miss& miss) const {
  const std::uint64_t seed = context_.parameters.picture.seed;
  return miss.again == 0 ? seed : randomKey(seed).with(miss.again).asSeed();
}

RandomKey VectorRenderer::memoKey(const Miss& miss) const {
  const LitPoint lit = points_->tiles[miss.tile].points[miss.point].lit(scene_);
  const std::uint64_t seed = seedOf(miss);
  return miss.light == kNone ? vectorKey(lit, miss.key, seed)
                             : directVectorKey(lit, miss.key, slots_.vectorLights()[miss.light], seed);
}

RandomKey VectorRenderer::placeOf(const Miss& miss) const {
  const LitPoint lit = points_->tiles[miss.tile].points[miss.point].lit(scene_);
  const RandomKey place = vectorKey(lit, miss.key, 0);
  return miss.light == kNone ? place : place.with(lit.outgoing).with(slots_.vectorLights()[miss.light]);
}

bool VectorRenderer::fitsInMemory(const std::vector<Miss>& misses) const {
  if (cache_.memoryLimitBytes == 0 || misses.empty()) return true;
  const auto direct = static_cast<std::size_t>(
      std::count_if(misses.begin(), misses.end(), [](const Miss& miss) { return miss.light != kNone; }));
  const PictureMemory memory = pictureMemory(scene_, context_.parameters);
  const std::size_t pixels =
      static_cast<std::size_t>(context_.region.width) * static_cast<std::size_t>(context_.region.height);
  const std::size_t bytes =
      pixels * memory.perPixel + points_->pointCount() * memory.perPoint +
      vectorBytes(snapshot_->indirect.size() + misses.size() - direct, snapshot_->directCount() + direct);
  return bytes <= cache_.memoryLimitBytes;
}

bool VectorRenderer::compute(const std::vector<Miss>& misses, const StopFlag& stop,
                             std::vector<IndirectLightVector>& indirect,
                             std::vector<std::vector<DirectLightVector>>& direct) {
  outOfMemory_ = !fitsInMemory(misses);
  if (outOfMemory_) return false;
  std::vector<std::uint32_t> places(misses.size());
  direct.assign(slots_.vectorLights().size(), {});
  std::vector<std::size_t> directCounts(slots_.vectorLights().size(), 0);
  std::size_t indirectCount = 0;
  for (std::size_t m = 0; m < misses.size(); ++m) {
    std::size_t& count = misses[m].light == kNone ? indirectCount : directCounts[misses[m].light];
    places[m] = static_cast<std::uint32_t>(count++);
  }
  indirect.resize(indirectCount);
  for (std::size_t l = 0; l < direct.size(); ++l) direct[l].resize(directCounts[l]);
  std::vector<std::uint8_t> finished(misses.size(), 0);
  for (Worker& worker : workers_) worker.gatherer.stopWith(stop);
  context_.pool->forEach((misses.size() + kMissesPerTask - 1) / kMissesPerTask, [&](std::size_t task, int w) {
    Worker& worker = workers_[static_cast<std::size_t>(w)];
    for (std::size_t m = task * kMissesPerTask; m < std::min(misses.size(), (task + 1) * kMissesPerTask);
         ++m) {
      if (stop) return;
      const Miss& miss = misses[m];
      const VisiblePoint& p = points_->tiles[miss.tile].points[miss.point];
      const RandomKey identity = memoKey(miss);
      Birth birth;
      if (miss.light == kNone) {
        IndirectLightVector& record = indirect[places[m]];
        const auto known = finishedIndirect_.find(identity);
        record = known != finishedIndirect_.end()
                     ? known->second
                     : worker.gatherer.gather({p.lit(scene_), p.vectorFootprint}, miss.key, seedOf(miss),
                                              worker.rays, worker.faults);
        birth.rays = record.birth.rays;
      } else {
        DirectLightVector& record = direct[miss.light][places[m]];
        const auto known = finishedDirect_.find(identity);
        record =
            known != finishedDirect_.end()
                ? known->second.record
                : computeDirectVector(worker.direct, scene_, p, miss.key, slots_.vectorLights()[miss.light],
                                      context_.parameters, worker.rays, worker.faults);
        ++worker.fullDirect;
        birth.rays = record.birth.rays;
      }
      birth.identity = identity;
      birth.pass = firstPass_ + static_cast<std::uint32_t>(statistics_.passes);
      birth.order = places[m];
      birth.pixel = p.pixel;
      birth.throughSpecular = p.throughSpecular;
      (miss.light == kNone ? indirect[places[m]].birth : direct[miss.light][places[m]].birth) = birth;
      if (stop) return;  // in the middle of it, perhaps
      finished[m] = 1;
    }
  });
  const bool whole = std::all_of(finished.begin(), finished.end(), [](std::uint8_t f) { return f != 0; });
  if (!whole) {
    for (std::size_t m = 0; m < misses.size(); ++m) {
      if (finished[m] == 0) continue;
      if (misses[m].light == kNone) {
        finishedIndirect_.insert_or_assign(indirect[places[m]].birth.identity, indirect[places[m]]);
      } else {
        const DirectLightVector& record = direct[misses[m].light][places[m]];
        finishedDirect_.insert_or_assign(record.birth.identity,
                                         FinishedDirect{slots_.vectorLights()[misses[m].light], record});
      }
    }
  }
  return whole;
}

void VectorRenderer::publish(std::vector<IndirectLightVector> indirect,
                             std::vector<std::vector<DirectLightVector>> direct) {
  auto next = std::make_shared<Snapshot>(*snapshot_);
  ++next->generation;
  statistics_.fullIndirect += indirect.size();
  for (const IndirectLightVector& record : indirect) finishedIndirect_.erase(record.birth.identity);
  for (const auto& records : direct) {
    for (const DirectLightVector& record : records) finishedDirect_.erase(record.birth.identity);
  }
  next->indirect = snapshot_->indirect.with(std::move(indirect), radii_);
  for (std::size_t l = 0; l < direct.size(); ++l) {
    RecordSet<DirectLightVector>& set = next->direct[slots_.vectorLights()[l]];
    set = set.with(std::move(direct[l]), radii_);
  }
  snapshot_ = std::move(next);
}

void VectorRenderer::settleOwn(const std::vector<Miss>& misses, std::vector<TileLook>& looks) const {
  std::vector<std::size_t> directNext(slots_.vectorLights().size());
  std::size_t indirectNext = snapshot_->indirect.size();
  for (std::size_t l = 0; l < directNext.size(); ++l) {
    directNext[l] = snapshot_->direct[slots_.vectorLights()[l]].size();
  }
  for (const Miss& miss : misses) --(miss.light == kNone ? indirectNext : directNext[miss.light]);
  for (const Miss& miss : misses) {
    TileAnswers& answers = change(miss.tile, looks[miss.tile]);
    settle(miss, miss.light == kNone ? indirectNext++ : directNext[miss.light]++, answers);
  }
}

void VectorRenderer::settleKnown(TileLook& look) const {
  // Those of DLVs looked for theirs when they were asked.
  std::erase_if(look.misses,
                [&](const Miss& miss) { return miss.light == kNone && settleKnown(miss, look.answers); });
}

bool VectorRenderer::settleKnown(const Miss& miss, TileAnswers& answers) const {
  const RandomKey place = placeOf(miss);
  const auto known = std::lower_bound(warmNumbers_.begin(), warmNumbers_.end(), WarmNumber{place, 0});
  if (known == warmNumbers_.end() || known->place != place) return false;
  settle(miss, known->number, answers);
  return true;
}

void VectorRenderer::settle(const Miss& miss, std::size_t number, TileAnswers& answers) const {
  const VisibleTile& tile = points_->tiles[miss.tile];
  const VisiblePoint& p = tile.points[miss.point];
  if (miss.light != kNone) {
    const DirectLightVector& record = snapshot_->direct[slots_.vectorLights()[miss.light]][number];
    const std::uint32_t light = slots_.vectorLights()[miss.light];
    const std::size_t slot = slots_.claim(answers, light) * tile.points.size() + miss.point;
    answers.lightDirect[slot] = directRadiance(brdfOf(p), p, context_.parameters.vectors.dlv.store,
                                               record.energy, record.lobeRadiance, record.direction);
    answers.lightState[slot] = TileAnswers::Computed;
    answers.lightReason[slot] = miss.reason;
    ++answers.fullDlv[miss.point];
    return;
  }
  const IndirectLightVector& record = snapshot_->indirect[number];
  const SurfaceKeys keys = indirectKeys(scene_.materialOf(p.surface), context_.parameters.vectors.ilv.store);
  const std::size_t k = keys.count == 2 && keys.keys[1] == miss.key ? 1 : 0;
  const std::size_t slot = k * tile.points.size() + miss.point;
  answers.indirect[slot] = indirectRadiance(p, miss.key, record.energy, record.direction);
  answers.own[slot] = 1;
  if (k == 0) {
    answers.nearest[miss.point] = static_cast<std::uint32_t>(number);
    answers.ilvCount[miss.point] = 1;
  }
  if (keys.count == 1) {
    answers.answered[miss.point] = 1;
    answers.satisfied[miss.point] = 1;
  }
}

Rgb VectorRenderer::indirectRadiance(const VisiblePoint& p, SurfaceKey key, const Rgb& energy,
                                     const Vec3& direction) const {
  return lightvane::indirectRadiance(brdfOf(p), p, context_.parameters.vectors.ilv.store, key, energy,
                                     direction);
}

SurfaceKey VectorRenderer::directKey(const VisiblePoint& p) const {
  return directSurfaceKey(scene_.materialOf(p.surface), context_.parameters.vectors.dlv.store);
}

void VectorRenderer::collectCounts(bool whole) {
  for (Worker& worker : workers_) {
    statistics_.rays += worker.rays;
    statistics_.faults += worker.faults;
    if (whole) statistics_.fullDirect += worker.fullDirect;
    worker.rays = {};
    worker.faults = {};
    worker.fullDirect = 0;
  }
}

void VectorRenderer::countAnswers() {
  statistics_.ilvRecords = snapshot_->indirect.size();
  statistics_.dlvRecords = snapshot_->directCount();
  statistics_.interpolatedIndirect = 0;
  statistics_.interpolatedDirect = 0;
  statistics_.unanswered = 0;
  std::uint64_t looked = 0;
  std::uint64_t asked = 0;  // of ILVs, and of each light's DLVs where it is not faint
  for (const auto& tile : answers_) {
    const TileAnswers& answers = *tile;
    std::uint32_t seen = 0, answered = 0, own = 0, interpolated = 0, askedDirect = 0;
    // No branches: one would be missed at every edge of a zone.
    for (std::size_t i = 0; i < answers.looked.size(); ++i) {
      const bool isSeen = answers.looked[i] != 0;
      const bool isAnswered = isSeen & (answers.answered[i] != 0);
      seen += isSeen ? 1 : 0;
      answered += isAnswered ? 1 : 0;
      const bool isOwn = isAnswered & (answers.own[i] != 0);
      own += isOwn ? 1 : 0;
    }
    // What is kept from before is not counted until a pass has looked at its point.
    slots_.forEachAsked(answers, [&](std::size_t, std::size_t slot) {
      const std::span<const std::uint8_t> states = answers.statesOf(slot);
      for (std::size_t i = 0; i < answers.looked.size(); ++i) {
        const std::uint8_t state = states[i];
        const bool isInterpolated = (answers.looked[i] != 0) & (state == TileAnswers::Interpolated);
        interpolated += isInterpolated ? 1 : 0;
        const bool isAsked = (answers.looked[i] != 0) & (state != TileAnswers::Faint);
        askedDirect += isAsked ? 1 : 0;
      }
    });
    looked += seen;
    asked += askedDirect;
    statistics_.unanswered += seen - answered;
    statistics_.interpolatedIndirect += answered - own;
    statistics_.interpolatedDirect += interpolated;
  }
  asked += looked;
  const std::uint64_t interpolated = statistics_.interpolatedIndirect + statistics_.interpolatedDirect;
  hitRate_ = asked > 0 ? static_cast<double>(interpolated) / static_cast<double>(asked) : 0.0;
}

Film VectorRenderer::film() const {
  if (answers_.empty()) return {context_.region.width, context_.region.height};
  Film film(surfaces_);
  Image<std::uint8_t> unknown(film.width, film.height);
  Image<std::uint8_t> kinds(film.width, film.height);
  std::atomic<bool> isAnyUnknown = false;
  std::atomic<bool> isAnyKnown = false;
  // Tiles have no pixel in common.
  context_.pool->forEach(points_->tiles.size(), [&](std::size_t t, int) {
    const VisibleTile& tile = points_->tiles[t];
    const TileAnswers& answers = *answers_[t];
    const std::size_t slots = slots_.count(answers);
    std::uint32_t lastPixel = kNone;
    bool isTileUnknown = false;
    bool isTileKnown = false;
    for (std::size_t i = 0; i < tile.points.size(); ++i) {
      const VisiblePoint& p = tile.points[i];
      kinds[p.pixel] = static_cast<std::uint8_t>(kinds[p.pixel] | (p.throughSpecular ? 2 : 1));
      if (answers.looked[i] == 0) {
        unknown[p.pixel] = 1;
        isTileUnknown = true;
        continue;
      }
      isTileKnown = true;
      Rgb direct(0.0f);
      for (std::size_t slot = 0; slot < slots; ++slot)
        direct += slots_.factorOf(answers, slot) * answers.lightDirect[slot * tile.points.size() + i];
      const Rgb indirect =
          answers.mirrored[i] + answers.indirect[i] + answers.indirect[tile.points.size() + i];
      if (p.throughSpecular) {
        film.specular[p.pixel] += p.throughput * (direct + indirect);
      } else {
        film.direct[p.pixel] += p.throughput * direct;
        film.indirect[p.pixel] += p.throughput * indirect;
      }
      film.fullIlv[p.pixel] += static_cast<float>(answers.own[i] + answers.own[tile.points.size() + i]);
      film.fullDlv[p.pixel] += answers.fullDlv[i];
      if (p.pixel != lastPixel) {
        film.ilvCount[p.pixel] = answers.ilvCount[i];
        film.recordId[p.pixel] = answers.nearest[i] == kNone ? 0u : answers.nearest[i] + 1;
      }
      lastPixel = p.pixel;
    }
    if (isTileUnknown) isAnyUnknown = true;
    if (isTileKnown) isAnyKnown = true;
  });
  // Of what a warm cache answered any pixel may be known.
  const int finest = looksAtKnown_ ? 2 : std::max(2, knownSpacing_);
  if (isAnyUnknown && isAnyKnown) fillUnknown(film, unknown, kinds, finest, *context_.pool);
  return film;
}

void VectorRenderer::addTo(RenderFrame& frame) const {
  frame.points = points_;
  frame.snapshot = snapshot_;
  frame.answers = answers_;
  frame.lightSlots = slots_;
  frame.shownTracer = shownTracer_;
  frame.indirectTracer = indirectTracer_;
  frame.warm = cache_.warm;
  frame.locked = cache_.locked;
}

RenderProgress VectorRenderer::progress() const {
  RenderProgress progress;
  progress.hitRate = hitRate_;
  progress.spacing = knownSpacing_;
  switch (stage_) {
    case Stage::Points:
      progress.stage = "visible points";
      break;
    case Stage::Known:
      progress.stage = "known vectors";
      break;
    case Stage::Strides:
      progress.stage = fmt::format("stride {}", stride_);
      break;
    case Stage::Last:
      progress.stage = "last pass";
      break;
    case Stage::Refine:
      progress.stage = "more samples";
      break;
    case Stage::More:
      progress.stage = "more vectors";
      break;
    case Stage::Done:
      progress.stage = "done";
      break;
  }
  progress.fraction = std::min(1.0, static_cast<double>(statistics_.passes) / passes_);
  return progress;
}

void VectorRenderer::restore(const Checkpoint& checkpoint) {
  if (checkpoint.finished) keepFinished(*checkpoint.finished, {});
}

std::shared_ptr<const Snapshot> VectorRenderer::gathered() const {
  if (finishedIndirect_.empty() && finishedDirect_.empty()) return snapshot_;
  // In the order of their identities: a hash map's own order must not show.
  const auto byIdentity = [](const auto& a, const auto& b) {
    return std::pair(a.birth.identity.high, a.birth.identity.low) <
           std::pair(b.birth.identity.high, b.birth.identity.low);
  };
  std::vector<IndirectLightVector> indirect;
  for (const auto& [identity, record] : finishedIndirect_) indirect.push_back(record);
  std::vector<std::vector<DirectLightVector>> direct(scene_.lights.size());
  for (const auto& [identity, finished] : finishedDirect_) direct[finished.light].push_back(finished.record);
  std::sort(indirect.begin(), indirect.end(), byIdentity);
  auto all = std::make_shared<Snapshot>(*snapshot_);
  ++all->generation;
  all->indirect = all->indirect.with(std::move(indirect), radii_);
  for (std::size_t light = 0; light < direct.size(); ++light) {
    std::sort(direct[light].begin(), direct[light].end(), byIdentity);
    all->direct[light] = all->direct[light].with(std::move(direct[light]), radii_);
  }
  return all;
}

KnownView VectorRenderer::knownView() const {
  if (unrefined_.points) return unrefined_;
  if (!surfaces_) return {};
  // From settled vectors any answer is final, and the last pass settles them.
  return {points_, surfaces_, answers_, settlesDirect() ? questions_.direct : RandomKey{}};
}

Checkpoint VectorRenderer::checkpoint() const {
  Checkpoint checkpoint;
  checkpoint.passes = statistics_.passes;
  checkpoint.finished = gathered();
  return checkpoint;
}

}  // namespace lightvane
