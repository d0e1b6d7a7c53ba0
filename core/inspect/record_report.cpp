#include "core/inspect/record_report.h"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "core/base/number_text.h"
#include "core/inspect/explain_point.h"
#include "core/inspect/record_names.h"
#include "core/inspect/units.h"
#include "core/render/direct_vectors.h"
#include "core/render/point_answers.h"

namespace lightvane {
namespace {

// To the bit: vectors that hold a NaN are the same too.
bool isSame(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
bool isSame(const Vec3& a, const Vec3& b) { return isSame(a.x, b.x) && isSame(a.y, b.y) && isSame(a.z, b.z); }
bool isSame(const VectorPoint& a, const VectorPoint& b) {
  return isSame(a.position, b.position) && isSame(a.normal, b.normal) && isSame(a.tangent, b.tangent) &&
         isSame(a.outgoing, b.outgoing) && a.key == b.key && isSame(a.footprint, b.footprint);
}
bool isSame(const IndirectLightVector& a, const IndirectLightVector& b) {
  for (int c = 0; c < 3; ++c) {
    if (!isSame(a.gradient[c], b.gradient[c]) || !isSame(a.rotation[c], b.rotation[c])) return false;
  }
  return isSame(a.point, b.point) && isSame(a.direction, b.direction) && isSame(a.energy, b.energy) &&
         isSame(a.irradiance, b.irradiance) && isSame(a.arithmeticMean, b.arithmeticMean) &&
         isSame(a.harmonicMean, b.harmonicMean) && isSame(a.leastDistance, b.leastDistance) &&
         isSame(a.lobeWidth, b.lobeWidth);
}
bool isSame(const DirectLightVector& a, const DirectLightVector& b) {
  return isSame(a.point, b.point) && isSame(a.direction, b.direction) && isSame(a.solidAngle, b.solidAngle) &&
         isSame(a.energy, b.energy) && isSame(a.lobeRadiance, b.lobeRadiance) && a.occluded == b.occluded;
}

std::string vectorText(const Vec3& v) { return rgbText(v); }

class Rows {
 public:
  explicit Rows(const RenderFrame& frame)
      : frame_(frame), scene_(*frame.scene), scale_(scene_.normalisation.radianceScale()) {}

  void add(const char* label, std::string text) { rows_.push_back({label, std::move(text)}); }
  void addLength(const char* label, float normalised) { add(label, lengthText(scene_, normalised)); }
  void addEnergy(const char* label, const Rgb& normalised, const char* unit) {
    add(label, rgbText(scale_ * normalised) + " " + unit);
  }

  void addBirth(const Birth& birth) {
    const auto width = static_cast<std::uint32_t>(std::max(frame_.region.width, 1));
    add("computed in", birth.pass == 0 ? std::string("the seed") : fmt::format("pass {}", birth.pass));
    add("number in its pass", countText(birth.order));
    add("asked for by pixel", fmt::format("{}, {}{}", birth.pixel % width, birth.pixel / width,
                                          birth.throughSpecular ? ", by way of a mirror or glass" : ""));
    add("cost", countText(birth.rays) + " rays");
    add("identity", fmt::format("{:08x}{:08x}", birth.identity.high, birth.identity.low));
  }

  void addPoint(const VectorPoint& point, VectorStore store) {
    add("serves", surfaceKeyName(scene_, point.key, store));
    add("position", pointText(scene_, point.position));
    add("normal", vectorText(point.normal));
    add("tangent", vectorText(point.tangent));
    add("towards the viewer", vectorText(point.outgoing));
    addLength("footprint of a pixel (of 256)", point.footprint);
  }

  void addIndirect(const IndirectLightVector& r) {
    const IlvParameters& ilv = frame_.parameters.vectors.ilv;
    const IlvRules rules(ilv, scene_.diagonal);
    const IlvCandidate a = makeCandidate(r, rules);
    const bool isRadiance = ilv.store == VectorStore::Split && r.point.key != kLambertKey;
    addPoint(r.point, ilv.store);
    // Where the two are one thing, it is said once.
    const char* const unit = isRadiance ? kRadianceUnit : kIrradianceUnit;
    if (ilv.store == VectorStore::Vector) {
      addEnergy("energy P", r.energy, unit);
      addEnergy("irradiance E", r.irradiance, unit);
    } else {
      addEnergy(isRadiance ? "lobe's radiance" : "irradiance E", r.energy, unit);
    }
    add("direction D", vectorText(r.direction));
    add("D from the normal", angleText(angleBetween(r.direction, r.point.normal)));
    addLength("radius of validity", a.radius);
    addLength("mean distance, harmonic", r.harmonicMean);
    addLength("mean distance, arithmetic", r.arithmeticMean);
    addLength("least distance", r.leastDistance);
    add("change over the radius",
        a.brightness > 0.0f ? numberText(100.0 * glm::length(a.gradient) * a.radius / a.brightness) + " %"
                            : "none: it is black");
    constexpr const char* kGradients[3] = {"gradient of red", "gradient of green", "gradient of blue"};
    constexpr const char* kRotations[3] = {"turning, red", "turning, green", "turning, blue"};
    const auto perLength = static_cast<float>(scale_ / scene_.normalisation.sceneLength(1.0));
    for (int c = 0; c < 3; ++c)
      add(kGradients[c], vectorText(perLength * r.gradient[c]) + " " + unit + " per " + lengthUnit(scene_));
    for (int c = 0; c < 3; ++c)
      add(kRotations[c], vectorText(scale_ * r.rotation[c]) + " " + unit + " per rad");
    if (ilv.extrapolate) add("gradients used", numberText(100.0 * a.gradientScale) + " %");
    add("lobe", r.lobeWidth > 0.0f ? angleText(r.lobeWidth) + " half width" : "none: it never expires");
    if (r.lobeWidth > 0.0f)
      add("expires when the view turns by", angleText(std::acos(std::clamp(a.cosLobe, -1.0f, 1.0f))));
    add("a ray must tell", ilv.visibility ? "beyond " + lengthText(scene_, a.visibleWithin) : "never");
  }

  void addDirect(const DirectLightVector& r, std::uint32_t light) {
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    add("light", lightName(scene_, light));
    addPoint(r.point, dlv.store);
    addEnergy(dlv.store == VectorStore::Vector ? "energy P" : "irradiance", r.energy, kIrradianceUnit);
    if (dlv.store == VectorStore::Split) addEnergy("lobe's radiance", r.lobeRadiance, kRadianceUnit);
    add("light that arrives", r.occluded ? "none" : "all, or a part");
    add("direction D", vectorText(r.direction));
    add("length of D", numberText(glm::length(r.direction)));
    add("solid angle of the light", numberText(r.solidAngle) + " sr");
    addLength("radius of validity (r_max)", dlvRadius(dlv, scene_));
  }

  std::vector<ReportRow> take() { return std::move(rows_); }

 private:
  const RenderFrame& frame_;
  const Scene& scene_;
  float scale_;
  std::vector<ReportRow> rows_;
};

/// Why a vector that was computed again is another.
std::string whyDifferent(bool isIdentitySame, bool isOfThisView) {
  if (!isIdentitySame)
    return isOfThisView ? "it was computed with another seed"
                        : "it was computed with another seed, or elsewhere";
  return isOfThisView
             ? "it was computed with other parameters"
             : "it was computed with other parameters, or the surface beneath it was not found exactly";
}

template <class Record>
void compare(const Record& stored, const Record& again, bool isOfThisView, RecordReport& report) {
  if (isSame(stored, again)) {
    report.recomputation = Recomputation::Same;
    return;
  }
  report.recomputation = Recomputation::Different;
  report.note = "computed again it is another: " +
                whyDifferent(stored.birth.identity == again.birth.identity, isOfThisView);
}

void recompute(const RenderFrame& frame, const IndirectLightVector& record, RecordReport& report) {
  const std::optional<VisiblePoint> point = pointOfVector(frame, record.point, record.birth);
  if (!point) return;
  const VectorParameters& vectors = frame.parameters.vectors;
  Gatherer gatherer(*frame.indirectTracer, frame.parameters.transport, vectors);
  gatherer.knowSight(frame.points->sight.get());
  RayCounts counts;
  SampleFaults faults;
  const IndirectLightVector again =
      gatherer.gather({point->lit(*frame.scene), record.point.footprint}, record.point.key,
                      frame.parameters.picture.seed, counts, faults);
  const bool isOfThisView = !pointOfRecord(*frame.points, record.point, record.birth).isNone();
  compare(record, again, isOfThisView, report);
  if (report.recomputation != Recomputation::Same) return;
  if (vectors.ilv.store == VectorStore::Split && record.point.key != kLambertKey) {
    report.note = "a lobe's samples follow the lobe and make no hemisphere";
    return;
  }
  report.hemisphere = gatherer.hemisphere();
  const float scale = frame.scene->normalisation.radianceScale();
  for (GatherCell& cell : report.hemisphere.cells) cell.radiance *= scale;
}

void recompute(const RenderFrame& frame, const DirectLightVector& record, std::uint32_t light,
               RecordReport& report) {
  const std::optional<VisiblePoint> point = pointOfVector(frame, record.point, record.birth);
  if (!point) return;
  DirectLightSampler sampler(*frame.tracer, frame.parameters.transport);
  RayCounts counts;
  SampleFaults faults;
  const DirectLightVector again = computeDirectVector(sampler, *frame.scene, *point, record.point.key, light,
                                                      frame.parameters, counts, faults);
  const bool isOfThisView = !pointOfRecord(*frame.points, record.point, record.birth).isNone();
  compare(record, again, isOfThisView, report);
}

/// Calls visit(point) for the points of the frame that lie within `radius` of `place`.
template <class Visit>
void forEachPointNear(const VisiblePoints& points, const Vec3& place, float radius, const Visit& visit) {
  // A little more: callers decide by the rules themselves.
  const float reach = radius * (1.0f + 0x1p-16f);
  for (std::uint32_t t = 0; t < points.tiles.size(); ++t) {
    for (const PointCluster& cluster : points.tiles[t].clusters) {
      const Vec3 away = cluster.ball.centre - place;
      if (glm::dot(away, away) > square(reach + cluster.ball.radius)) continue;
      for (const std::uint32_t i : cluster.points) {
        const Vec3 offset = points.tiles[t].points[i].position - place;
        if (glm::dot(offset, offset) <= reach * reach) visit(PointRef{t, i});
      }
    }
  }
}

}  // namespace

std::optional<VisiblePoint> pointOfVector(const RenderFrame& frame, const VectorPoint& place,
                                          const Birth& birth) {
  if (!frame.points) return std::nullopt;
  const PointRef ref = pointOfRecord(*frame.points, place, birth);
  if (!ref.isNone()) {
    VisiblePoint point = frame.points->tiles[ref.tile].points[ref.point];
    // Points of one place that two rays of a pixel found may differ in these.
    point.tangent = place.tangent;
    point.outgoing = place.outgoing;
    return point;
  }
  // Down on the surface from a little above it. Surfaces that are nearer to each other than this are not told
  // apart, and then the comparison says so.
  const FlushDenormals flush;
  const float height = 0x1p-12f * frame.scene->diagonal;
  const Ray ray{place.position + height * place.normal, -place.normal, 0.0f, 2.0f * height};
  const Hit hit = frame.tracer->intersect(ray);
  if (!hit.found()) return std::nullopt;
  const SurfacePoint surface = frame.tracer->surfaceAt(ray, hit);
  VisiblePoint point{};
  point.position = place.position;
  point.geometricNormal = surface.geometricNormal;
  point.normal = place.normal;
  point.tangent = place.tangent;
  point.outgoing = place.outgoing;
  point.offset = surface.offset;
  point.clearance = kInfinity;
  point.footprint = point.vectorFootprint = place.footprint;
  point.surface = surface.surface;
  point.pixel = birth.pixel;
  point.frontSide = surface.frontSide;
  point.throughSpecular = birth.throughSpecular;
  return point;
}

RecordReport recordReport(const RenderFrame& frame, const RecordRef& record) {
  const FlushDenormals flush;
  RecordReport report;
  report.record = record;
  const IndirectLightVector* indirect = findIndirect(frame, record);
  const DirectLightVector* direct = findDirect(frame, record);
  if (indirect == nullptr && direct == nullptr) {
    report.title = report.note = "no such vector";
    return report;
  }
  report.title = recordName(*frame.scene, record);
  const VectorPoint& place = indirect != nullptr ? indirect->point : direct->point;
  report.frame = {place.tangent, glm::cross(place.normal, place.tangent), place.normal};
  Rows rows(frame);
  if (indirect != nullptr) {
    rows.addIndirect(*indirect);
    rows.addBirth(indirect->birth);
    recompute(frame, *indirect, report);
  } else {
    rows.addDirect(*direct, record.light);
    rows.addBirth(direct->birth);
    recompute(frame, *direct, record.light, report);
  }
  if (report.recomputation == Recomputation::Impossible)
    report.note = "cannot be computed again: no surface is where it was computed";
  report.rows = rows.take();
  return report;
}

Image<std::uint8_t> servedPixels(const RenderFrame& frame, const RecordRef& record) {
  if (!frame.film) return {};
  Image<std::uint8_t> mask(frame.film->width, frame.film->height);
  if (!frame.points) return mask;
  PointExplainer explainer(frame);
  if (const IndirectLightVector* vector = findIndirect(frame, record)) {
    const IlvRules rules(frame.parameters.vectors.ilv, frame.scene->diagonal);
    const IlvCandidate a = makeCandidate(*vector, rules);
    forEachPointNear(*frame.points, a.position, a.radius, [&](PointRef ref) {
      const VisiblePoint& p = explainer.point(ref);
      // Most points near a vector are refused by a rule that takes no ray; its own point is served anyway.
      Refusal refusal;
      const float weight = ilvWeight(a, p.position, p.normal, p.outgoing, rules, refusal);
      if (mask[p.pixel] != 0 || (weight == 0.0f && p.position != a.position)) return;
      for (const IndirectSource& source : explainer.indirect(ref, p.offset)) {
        if (source.key == vector->point.key && source.uses(record.number)) mask[p.pixel] = 1;
      }
    });
  } else if (const DirectLightVector* direct = findDirect(frame, record)) {
    const DlvParameters& dlv = frame.parameters.vectors.dlv;
    forEachPointNear(*frame.points, direct->point.position, dlvRadius(dlv, *frame.scene), [&](PointRef ref) {
      const VisiblePoint& p = explainer.point(ref);
      const SurfaceKey key = directSurfaceKey(frame.scene->materialOf(p.surface), dlv.store);
      if (mask[p.pixel] != 0 || key != direct->point.key) return;
      if (explainer.direct(ref, record.light, p.offset).uses(record.number)) mask[p.pixel] = 1;
    });
  }
  return mask;
}

}  // namespace lightvane
