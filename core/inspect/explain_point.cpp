#include "core/inspect/explain_point.h"

#include <algorithm>
#include <cmath>

#include "core/render/point_answers.h"
#include "core/render/vector_renderer.h"

namespace lightvane {
namespace {

/// Equal values, or no numbers both.
bool isSame(const Rgb& a, const Rgb& b) {
  for (int c = 0; c < 3; ++c) {
    if (a[c] != b[c] && !(std::isnan(a[c]) && std::isnan(b[c]))) return false;
  }
  return true;
}

/// How many vectors there were after each publication, the newest first.
template <class Record>
std::vector<std::size_t> publications(const RecordSet<Record>& records) {
  std::vector<std::size_t> sizes;
  for (std::size_t size = records.size(); size > 0; size = firstOfPublication(records, size - 1))
    sizes.push_back(size);
  return sizes;
}

/// Whether the vector of that number has a share in what the source gives.
template <class Source>
bool hasShare(const Source& source, std::uint32_t number) {
  if (source.origin == AnswerOrigin::Own) return source.own == number;
  if (source.origin != AnswerOrigin::Interpolated) return false;
  const auto& candidates = source.answer.candidates;
  return std::any_of(candidates.begin(), candidates.end(), [&](const auto& candidate) {
    return candidate.number == number && candidate.weight != 0.0f;
  });
}

/// The vector of that identity at a place.
template <class Record>
std::uint32_t numberOf(const RecordSet<Record>& records, SurfaceKey key, const Vec3& position,
                       const RandomKey& identity, std::vector<std::uint32_t>& found) {
  records.query(key, position, 0.0f, found);
  for (const std::uint32_t number : found) {
    if (records[number].birth.identity == identity) return number;
  }
  return kNone;
}

}  // namespace

const char* answerOriginName(AnswerOrigin origin) {
  switch (origin) {
    case AnswerOrigin::NotYet:
      return "not looked at yet";
    case AnswerOrigin::Unanswered:
      return "no vector is valid";
    case AnswerOrigin::Interpolated:
      return "interpolated";
    case AnswerOrigin::Own:
      return "computed here, as a vector";
    case AnswerOrigin::Computed:
      return "computed here";
  }
  return "";
}

bool isHiddenFrom(const RenderFrame& frame, const VisiblePoint& point, const IlvCandidate& vector,
                  float distance) {
  Ray ray;
  return visibilityRay(vector, queryPoint(point, frame.parameters.vectors.ilv), distance, ray) &&
         frame.tracer->occluded(ray);
}

bool IndirectSource::uses(std::uint32_t number) const { return hasShare(*this, number); }
bool DirectSource::uses(std::uint32_t number) const { return hasShare(*this, number); }

PointExplainer::PointExplainer(const RenderFrame& frame)
    : frame_(frame),
      scene_(*frame.scene),
      answerer_(*frame.tracer, frame.parameters.vectors),
      indirectStarts_(publications(frame.snapshot->indirect)) {}

std::vector<IndirectSource> PointExplainer::indirect(PointRef ref, float radius) {
  const SurfaceKeys keys =
      indirectKeys(scene_.materialOf(point(ref).surface), frame_.parameters.vectors.ilv.store);
  std::vector<IndirectSource> sources;
  for (int k = 0; k < keys.count; ++k) sources.push_back(indirectOfKey(ref, k, keys.keys[k], radius));
  return sources;
}

IndirectSource PointExplainer::indirectOfKey(PointRef ref, int k, SurfaceKey key, float radius) {
  const FlushDenormals flush;
  const VisiblePoint& p = point(ref);
  const TileAnswers& answers = *frame_.answers[ref.tile];
  const std::size_t points = frame_.points->tiles[ref.tile].points.size();
  const std::size_t slot = static_cast<std::size_t>(k) * points + ref.point;
  const RecordSet<IndirectLightVector>& records = frame_.snapshot->indirect;
  const Brdf& brdf = scene_.materialOf(p.surface).brdf;
  const IlvParameters& ilv = frame_.parameters.vectors.ilv;
  const QueryPoint query = queryPoint(p, ilv);

  IndirectSource source;
  source.key = key;
  source.radiance = answers.indirect[slot];
  if (answers.own[slot] != 0) {
    source.own = numberOf(records, key, p.position,
                          vectorKey(p.lit(scene_), key, frame_.parameters.picture.seed), found_);
  }
  RayCounts counts;
  const auto explain = [&](std::size_t before) {
    return answerer_.explainIndirect(records, key, query, p.position, radius, before, counts);
  };
  const auto isExplained = [&](const IndirectAnswer& answer) {
    return answer.count > 0 && isSame(source.radiance, indirectRadiance(brdf, p, ilv.store, key,
                                                                        answer.energy, answer.direction));
  };
  source.answer = explain(records.size());
  const bool isAnswered = answers.looked[ref.point] != 0 || answers.own[slot] != 0;
  if (!isAnswered) {
    source.isExact = true;
    return source;
  }
  if (isExplained(source.answer.answer)) {
    source.origin = AnswerOrigin::Interpolated;
    source.isExact = true;
    return source;
  }
  if (source.own != kNone) {
    const IndirectLightVector& own = records[source.own];
    if (isSame(source.radiance, indirectRadiance(brdf, p, ilv.store, key, own.energy, own.direction))) {
      source.origin = AnswerOrigin::Own;
      source.isExact = true;
      return source;
    }
  }
  for (const std::size_t before : indirectStarts_) {
    if (before == records.size()) continue;
    IndirectExplanation earlier = explain(before);
    if (!isExplained(earlier.answer)) continue;
    source.answer = std::move(earlier);
    source.origin = AnswerOrigin::Interpolated;
    source.isExact = true;
    return source;
  }
  if (isBlack(source.radiance)) {
    // A miss: nothing was valid when the point was looked at last.
    source.origin = AnswerOrigin::Unanswered;
    source.isExact = true;
    return source;
  }
  source.origin = source.own != kNone ? AnswerOrigin::Own : AnswerOrigin::Interpolated;
  return source;
}

std::vector<DirectSource> PointExplainer::direct(PointRef ref, float radius) {
  const TileAnswers& answers = *frame_.answers[ref.tile];
  const std::size_t points = frame_.points->tiles[ref.tile].points.size();
  const LightSlots& slots = frame_.lightSlots;
  std::vector<DirectSource> sources;
  std::vector<std::size_t> slotsOfSources;
  for (std::uint32_t light = 0; light < scene_.lights.size(); ++light) {
    const std::size_t slot = slots.slotAt(answers, light, ref.point);
    const auto group = std::find(slotsOfSources.begin(), slotsOfSources.end(), slot);
    if (group != slotsOfSources.end()) {
      sources[static_cast<std::size_t>(group - slotsOfSources.begin())].lights.push_back(light);
      continue;
    }
    slotsOfSources.push_back(slot);
    const bool isOfVectors = slots.hasVectors(light) && slot == slots.slotOf(answers, light);
    DirectSource& source = sources.emplace_back();
    if (isOfVectors) source = direct(ref, light, radius);
    source.factor = slots.factorOf(answers, slot);
    if (isOfVectors) continue;
    source.lights = {light};
    source.radiance = answers.lightDirect[slot * points + ref.point];
    if (isLookedAt(ref)) source.origin = AnswerOrigin::Computed;
    source.isExact = true;
  }
  return sources;
}

DirectSource PointExplainer::direct(PointRef ref, std::uint32_t light, float radius) {
  const VisiblePoint& p = point(ref);
  const TileAnswers& answers = *frame_.answers[ref.tile];
  const std::size_t slot =
      frame_.lightSlots.slotOf(answers, light) * frame_.points->tiles[ref.tile].points.size() + ref.point;
  const RecordSet<DirectLightVector>& records = frame_.snapshot->direct[light];
  const Material& material = scene_.materialOf(p.surface);
  const DlvParameters& dlv = frame_.parameters.vectors.dlv;
  const SurfaceKey key = directSurfaceKey(material, dlv.store);
  const QueryPoint query = queryPoint(p, frame_.parameters.vectors.ilv);

  DirectSource source;
  source.lights = {light};
  source.radiance = answers.lightDirect[slot];
  const auto radianceOf = [&](const Rgb& energy, const Rgb& lobe, const Vec3& direction) {
    return directRadiance(material.brdf, p, dlv.store, energy, lobe, direction);
  };
  const auto explain = [&](std::size_t before) {
    return answerer_.explainDirect(records, key, query, p.position, radius, directLobeWidth(material.brdf),
                                   before);
  };
  const auto isExplained = [&](const DirectAnswer& answer) {
    return answer.accepted &&
           isSame(source.radiance, radianceOf(answer.energy, answer.lobeRadiance, answer.direction));
  };
  source.answer = explain(records.size());
  switch (answers.lightState[slot]) {
    case TileAnswers::Computed: {
      source.origin = AnswerOrigin::Computed;
      source.isExact = true;
      const RandomKey identity = directVectorKey(p.lit(scene_), key, light, frame_.parameters.picture.seed);
      const std::uint32_t own = numberOf(records, key, p.position, identity, found_);
      if (own == kNone) break;
      const DirectLightVector& record = records[own];
      if (!isSame(source.radiance, radianceOf(record.energy, record.lobeRadiance, record.direction))) break;
      source.own = own;
      source.origin = AnswerOrigin::Own;
      break;
    }
    case TileAnswers::Sampled:
    case TileAnswers::Faint:
      source.origin = AnswerOrigin::Computed;
      source.isExact = true;
      break;
    case TileAnswers::Interpolated:
      source.origin = AnswerOrigin::Interpolated;
      source.isExact = isExplained(source.answer.answer);
      if (source.isExact) break;
      for (const std::size_t before : publications(records)) {
        DirectExplanation earlier = explain(before);
        if (!isExplained(earlier.answer)) continue;
        source.answer = std::move(earlier);
        source.isExact = true;
        break;
      }
      break;
    default:
      // Looked at, but without enough vectors: its own is to be computed.
      source.origin = isLookedAt(ref) ? AnswerOrigin::Unanswered : AnswerOrigin::NotYet;
      source.isExact = true;
      break;
  }
  return source;
}

}  // namespace lightvane
