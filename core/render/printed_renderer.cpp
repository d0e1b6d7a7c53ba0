#include "core/render/printed_renderer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/render/direct_vectors.h"
#include "core/render/seed.h"
#include "core/vectors/gather.h"

namespace lightvane {
namespace {

constexpr int kRowsPerPass = 16;

}  // namespace

struct PrintedRenderer::Tools {
  Tools(const RenderContext& context, const StopFlag& stopFlag)
      : gatherer(*context.tracer, context.parameters.transport, context.parameters.vectors),
        direct(*context.tracer, context.parameters.transport),
        answerer(*context.tracer, context.parameters.vectors),
        stop(stopFlag) {}

  Gatherer gatherer;
  DirectLightSampler direct;
  Answerer answerer;
  const StopFlag& stop;
};

PrintedRenderer::PrintedRenderer(RenderContext context)
    : context_(std::move(context)),
      scene_(*context_.scene),
      radii_(context_.parameters.vectors, scene_),
      hasVectors_(lightsWithVectors(scene_, context_.parameters)),
      film_(context_.region.width, context_.region.height) {
  cache_.direct.resize(scene_.lights.size());
}

bool PrintedRenderer::runPass(const StopFlag& stop) {
  const FlushDenormals flush;
  Tools tools(context_, stop);
  if (!havePoints_) {
    VisiblePoints points;
    auto seen = std::make_shared<SeenSurfaces>(film_.width, film_.height);
    if (!traceVisiblePoints(*context_.tracer, context_.camera, context_.region, context_.parameters,
                            *context_.pool, stop, points, *seen, statistics_.rays)) {
      return false;
    }
    film_ = Film(std::move(seen));
    for (const VisibleTile& tile : points.tiles)
      points_.insert(points_.end(), tile.points.begin(), tile.points.end());
    std::stable_sort(points_.begin(), points_.end(),
                     [](const VisiblePoint& a, const VisiblePoint& b) { return a.pixel < b.pixel; });
    const Snapshot before = cache_;
    storeSeed(tools);
    if (stop) {
      cache_ = before;
      return false;
    }
    havePoints_ = true;
    ++statistics_.passes;
    return true;
  }
  // A pass is whole or it is not, here too: sixteen rows are shaded on copies.
  const Film filmBefore = film_;
  const Snapshot cacheBefore = cache_;
  const RenderStatistics statisticsBefore = statistics_;
  const int end = std::min(context_.region.height, row_ + kRowsPerPass);
  const auto endPixel = static_cast<std::uint32_t>(end * context_.region.width);
  std::size_t i = next_;
  for (; i < points_.size() && points_[i].pixel < endPixel; ++i) {
    if (stop) {
      film_ = filmBefore;
      cache_ = cacheBefore;
      statistics_ = statisticsBefore;
      return false;
    }
    shade(points_[i], tools);
  }
  next_ = i;
  row_ = end;
  ++statistics_.passes;
  statistics_.ilvRecords = cache_.indirect.size();
  statistics_.dlvRecords = cache_.directCount();
  return true;
}

void PrintedRenderer::storeSeed(Tools& tools) {
  const std::uint64_t seed = context_.parameters.picture.seed;
  for (const SeedPlace& place :
       seedPlaces(context_.region, context_.parameters.vectors.ilv.seed, seed, kIndirectSeed)) {
    if (tools.stop) return;
    if (const VisiblePoint* point = place.choose(points_)) storeIndirect(*point, tools);
  }
  if (std::find(hasVectors_.begin(), hasVectors_.end(), true) == hasVectors_.end()) return;
  for (const SeedPlace& place :
       seedPlaces(context_.region, context_.parameters.vectors.dlv.seed, seed, kDirectSeed)) {
    if (tools.stop) return;
    const VisiblePoint* point = place.choose(points_);
    for (std::uint32_t l = 0; point != nullptr && l < scene_.lights.size(); ++l) {
      if (hasVectors_[l]) storeDirect(*point, l, tools);
    }
  }
}

void PrintedRenderer::shade(const VisiblePoint& point, Tools& tools) {
  Rgb direct(0.0f);
  for (std::uint32_t l = 0; l < scene_.lights.size(); ++l) direct += directLight(point, l, tools);
  const Rgb indirect = indirectLight(point, tools);
  if (point.throughSpecular) {
    film_.specular[point.pixel] += point.throughput * (direct + indirect);
  } else {
    film_.direct[point.pixel] += point.throughput * direct;
    film_.indirect[point.pixel] += point.throughput * indirect;
  }
}

Rgb PrintedRenderer::directLight(const VisiblePoint& point, std::uint32_t light, Tools& tools) {
  const DlvParameters& dlv = context_.parameters.vectors.dlv;
  const Brdf& brdf = scene_.materialOf(point.surface).brdf;
  if (!hasVectors_[light]) {
    const LitPoint lit = point.lit(scene_);
    const DirectLightEstimate e = tools.direct.estimate(
        lit, light, context_.parameters.transport.lightSamples,
        vectorKey(lit, kLambertKey, context_.parameters.picture.seed), statistics_.rays, statistics_.faults);
    ++statistics_.fullDirect;
    return reflectedRadiance(brdf, point.tint(), e);
  }
  const QueryPoint query{point.position, point.normal, point.geometricNormal, point.outgoing, point.offset};
  DirectAnswer answer;
  tools.answerer.answerDirect(cache_.direct[light], kLambertKey, {&query, 1}, point.position, 0.0f, 0.0f,
                              {&answer, 1});
  if (answer.accepted) {
    ++statistics_.interpolatedDirect;
    return directRadiance(brdf, point, dlv.store, answer.energy, answer.lobeRadiance, answer.direction);
  }
  const DirectLightVector record = storeDirect(point, light, tools);
  film_.fullDlv[point.pixel] += 1.0f;
  return directRadiance(brdf, point, dlv.store, record.energy, record.lobeRadiance, record.direction);
}

Rgb PrintedRenderer::indirectLight(const VisiblePoint& point, Tools& tools) {
  const LitPoint lit = point.lit(scene_);
  const Material& material = scene_.materialOf(point.surface);
  const DirectLightEstimate mirrored = tools.direct.estimateMirrored(
      lit, context_.parameters.transport.lightSamples,
      vectorKey(lit, kLambertKey, context_.parameters.picture.seed), statistics_.rays, statistics_.faults);
  const QueryPoint query{point.position, point.normal, point.geometricNormal, point.outgoing, point.offset};
  IndirectAnswer answer;
  tools.answerer.answerIndirect(cache_.indirect, brdfSurfaceKey(material.brdfKey), {&query, 1},
                                point.position, 0.0f, {&answer, 1}, statistics_.rays);
  film_.ilvCount[point.pixel] = static_cast<float>(answer.count);
  film_.recordId[point.pixel] = answer.count > 0 ? answer.nearest + 1 : 0u;
  Rgb energy = answer.energy;
  Vec3 direction = answer.direction;
  if (answer.count >= context_.parameters.vectors.ilv.nMin) {
    ++statistics_.interpolatedIndirect;
  } else {
    const IndirectLightVector record = storeIndirect(point, tools);
    film_.fullIlv[point.pixel] += 1.0f;
    energy = record.energy;
    direction = record.direction;
  }
  return reflectedRadiance(material.brdf, point.tint(), mirrored) +
         energy * material.brdf.evaluate(lit.surface.frame.toLocal(direction),
                                         lit.surface.frame.toLocal(point.outgoing), point.tint());
}

DirectLightVector PrintedRenderer::storeDirect(const VisiblePoint& point, std::uint32_t light, Tools& tools) {
  DirectLightVector record = computeDirectVector(tools.direct, scene_, point, kLambertKey, light,
                                                 context_.parameters, statistics_.rays, statistics_.faults);
  ++statistics_.fullDirect;
  RecordSet<DirectLightVector>& set = cache_.direct[light];
  record.birth = {static_cast<std::uint32_t>(statistics_.passes),
                  static_cast<std::uint32_t>(set.size()),
                  point.pixel,
                  record.birth.rays,
                  record.birth.identity,
                  point.throughSpecular};
  set = set.with({record}, radii_);
  return record;
}

IndirectLightVector PrintedRenderer::storeIndirect(const VisiblePoint& point, Tools& tools) {
  const SurfaceKey key = brdfSurfaceKey(scene_.materialOf(point.surface).brdfKey);
  IndirectLightVector record =
      tools.gatherer.gather({point.lit(scene_), point.vectorFootprint}, key, context_.parameters.picture.seed,
                            statistics_.rays, statistics_.faults);
  ++statistics_.fullIndirect;
  record.birth = {static_cast<std::uint32_t>(statistics_.passes),
                  static_cast<std::uint32_t>(cache_.indirect.size()),
                  point.pixel,
                  record.birth.rays,
                  record.birth.identity,
                  point.throughSpecular};
  cache_.indirect = cache_.indirect.with({record}, radii_);
  ++cache_.generation;
  return record;
}

RenderProgress PrintedRenderer::progress() const {
  const auto looked = static_cast<double>(statistics_.fullIndirect + statistics_.interpolatedIndirect);
  return {havePoints_ ? fmt::format("row {} of {}", row_, context_.region.height) : "visible points",
          static_cast<double>(row_) / context_.region.height,
          looked > 0.0 ? static_cast<double>(statistics_.interpolatedIndirect) / looked : 0.0,
          row_ > 0 ? 1 : 0};
}

}  // namespace lightvane
