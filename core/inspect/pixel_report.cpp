#include "core/inspect/pixel_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/inspect/record_names.h"
#include "core/inspect/specular_ways.h"
#include "core/inspect/units.h"
#include "core/render/point_answers.h"

namespace lightvane {
namespace {

// Refused candidates that a report lists, the nearest first: what a table can show.
constexpr std::size_t kListed = 48;
// Candidates are looked for in a ball that grows until so many are found, so that also a lonely point is told
// of its neighbours.
constexpr std::size_t kWanted = 8;

/// "distance 0.12 m > radius 0.1 m", with as many digits as it takes to tell the numbers apart.
template <class TextOf>
std::string comparison(const char* what, double value, const char* relation, const char* bound, double limit,
                       const TextOf& textOf) {
  int digits = 3;
  while (digits < 9 && value != limit && textOf(value, digits) == textOf(limit, digits)) ++digits;
  return fmt::format("{} {} {} {}{}{}", what, textOf(value, digits), relation, bound, *bound != 0 ? " " : "",
                     textOf(limit, digits));
}

std::string percentText(double part, int digits) { return numberText(100.0 * part, digits) + " %"; }

class Reporter {
 public:
  explicit Reporter(const RenderFrame& frame)
      : frame_(frame),
        scene_(*frame.scene),
        explainer_(frame),
        rules_(frame.parameters.vectors.ilv, scene_.diagonal),
        scale_(scene_.normalisation.radianceScale()) {}

  PointReport report(PointRef ref) {
    const VisiblePoint& p = explainer_.point(ref);
    const Surface& surface = scene_.surfaces[p.surface];
    PointReport report;
    report.point = ref;
    report.throughput = p.throughput;
    report.position = p.position;
    report.normal = p.normal;
    report.clearance = p.clearance;
    report.material = scene_.materials[surface.material].name;
    report.shape = scene_.shapeNames[surface.shape];
    report.throughSpecular = p.throughSpecular;
    report.mirrored = scale_ * frame_.answers[ref.tile]->mirrored[ref.point];
    report.indirectSum = report.mirrored;
    // The spacing of vectors is a few hundredths of a room.
    for (float radius = 0x1p-6f * scene_.diagonal;; radius *= 4.0f) {
      const std::vector<IndirectSource> sources = explainer_.indirect(ref, radius);
      const bool isEnough = std::all_of(sources.begin(), sources.end(), [](const IndirectSource& source) {
        return source.answer.candidates.size() >= kWanted;
      });
      if (!isEnough && radius < scene_.diagonal) continue;
      for (const IndirectSource& source : sources) report.indirect.push_back(indirect(p, source));
      break;
    }
    for (const DirectSource& source : explainer_.direct(ref, 0x1p-6f * scene_.diagonal))
      report.lights.push_back(direct(p, source));
    for (const AnswerReport& answer : report.indirect) report.indirectSum += answer.explained;
    for (const AnswerReport& answer : report.lights) report.direct += answer.explained;
    return report;
  }

 private:
  std::string length(double normalised, int digits) const { return lengthText(scene_, normalised, digits); }

  /// By how much the rule refuses the vector.
  std::string refusalText(const IndirectLightVector& record, const IlvCandidate& a, const VisiblePoint& p,
                          const CandidateReport& candidate, Refusal refusal) const {
    const auto lengthOf = [&](double v, int digits) { return length(v, digits); };
    switch (refusal) {
      case Refusal::Distance:
        return comparison("distance", candidate.distance, ">", "radius", a.radius, lengthOf);
      case Refusal::Curvature:
        return comparison("angle", candidate.angle, ">", "", std::acos(std::clamp(rules_.sCurv, -1.0f, 1.0f)),
                          angleText);
      case Refusal::Gradient: {
        const bool isSigned = rules_.p.gradientTest == IlvGradientTest::Signed;
        return comparison("change", isSigned ? candidate.relativeChange : std::abs(candidate.relativeChange),
                          ">", "S_E", rules_.p.sE, percentText);
      }
      case Refusal::InFront: {
        const Vec3 middle = 0.5f * (a.normal + p.normal);
        return comparison("in front by", -glm::dot(p.position - a.position, middle), ">", "",
                          kInFrontSlope * candidate.distance + kInFrontRounding, lengthOf);
      }
      case Refusal::Lobe:
        return comparison("view turned by", angleBetween(a.outgoing, p.outgoing), ">", "",
                          std::acos(std::clamp(a.cosLobe, -1.0f, 1.0f)), angleText);
      case Refusal::Clearance:
        return comparison("distance", candidate.distance, ">", "clearance", indirectReach(p, rules_.p),
                          lengthOf);
      case Refusal::Visibility:
        return fmt::format("hidden: the ray to it is blocked; asked beyond {} of the {} it saw nearest",
                           length(a.visibleWithin, 3), length(record.leastDistance, 3));
      case Refusal::BeyondMost:
        return fmt::format("beyond n_max: {} valid vectors are nearer", rules_.p.nMax);
      case Refusal::None:
        break;
    }
    return {};
  }

  AnswerReport indirect(const VisiblePoint& p, const IndirectSource& source) const {
    const Brdf& brdf = scene_.materialOf(p.surface).brdf;
    const VectorStore store = rules_.p.store;
    AnswerReport report;
    report.name = surfaceKeyName(scene_, source.key, store);
    report.origin = source.origin;
    report.radiance = scale_ * source.radiance;
    const IndirectAnswer& answer = source.answer.answer;
    for (const IndirectCandidate& c : source.answer.candidates) {
      const IndirectLightVector& record = frame_.snapshot->indirect[c.number];
      const IlvCandidate a = makeCandidate(record, rules_);
      CandidateReport candidate;
      candidate.record = {kNone, c.number};
      candidate.distance = c.distance;
      candidate.angle = angleBetween(a.normal, p.normal);
      const float change = glm::dot(p.position - a.position, a.gradient);
      candidate.relativeChange = a.brightness > 0.0f ? change / a.brightness : 0.0f;
      candidate.weight = c.weight;
      candidate.own = c.number == source.own;
      if (c.refusal != Refusal::None) {
        candidate.rule = refusalName(c.refusal);
        candidate.verdict = refusalText(record, a, p, candidate, c.refusal);
      } else if (c.weight == 0.0f) {
        candidate.rule = "weight";
        candidate.verdict = "weight 0 at the edge of its validity";
      } else if (source.origin == AnswerOrigin::Interpolated) {
        candidate.used = true;
        candidate.share = scale_ * indirectRadiance(brdf, p, store, source.key,
                                                    c.energy * (c.weight / answer.weight), answer.direction);
        candidate.verdict = fmt::format("used, {} of the weight", percentText(c.weight / answer.weight, 3));
        candidate.hidden = isHiddenFrom(frame_, p, a, c.distance);
      } else if (source.origin == AnswerOrigin::Own && candidate.own) {
        candidate.used = true;
        candidate.share = report.radiance;
        candidate.verdict = "used alone: computed at this point";
      } else {
        candidate.rule = "not asked";
        candidate.verdict = source.origin == AnswerOrigin::Own
                                ? "valid, but the point has its own"
                                : "valid, but not asked yet: no pass has come to this point";
      }
      report.candidates.push_back(std::move(candidate));
    }
    finish(report, source.isExact);
    return report;
  }

  std::string directRefusalText(const DirectLightVector& record, const VisiblePoint& p,
                                const DirectCandidate& c, float angle) const {
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    switch (c.refusal) {
      case DirectRefusal::Distance:
        return comparison("distance", c.distance, ">", "r_max", dlvRadius(dlv, scene_),
                          [&](double v, int digits) { return length(v, digits); });
      case DirectRefusal::Orientation:
        return comparison("angle", angle, ">", "", std::acos(std::clamp(dlv.normalCosine, -1.0, 1.0)),
                          angleText);
      case DirectRefusal::Lobe:
        return comparison("view turned by", angleBetween(record.point.outgoing, p.outgoing), ">", "",
                          directLobeWidth(scene_.materialOf(p.surface).brdf), angleText);
      case DirectRefusal::BeyondMost:
        return fmt::format("beyond n_max: {} valid vectors are nearer", dlv.nMax);
      case DirectRefusal::None:
        break;
    }
    return {};
  }

  /// Why vectors that are valid one by one did not answer together; empty where they did.
  std::string verdictText(const DirectExplanation& answer) const {
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    switch (answer.verdict) {
      case DirectVerdict::Accepted:
        return {};
      case DirectVerdict::TooFew:
        return fmt::format("{} valid vectors < n_min {}", answer.valid, dlv.nMin);
      case DirectVerdict::Dispersed:
        return comparison("dispersion", answer.dispersion,
                          dlv.dispersionMeasure == DlvDispersion::VarianceAbove ? "not above" : ">", "",
                          dlv.dispersion, [](double v, int digits) { return numberText(v, digits); });
      case DirectVerdict::NoWeight:
        return "all valid vectors are at the edge of r_max, where weights are 0";
    }
    return {};
  }

  static const char* ruleOf(DirectRefusal refusal) {
    switch (refusal) {
      case DirectRefusal::None:
        return "";
      case DirectRefusal::Distance:
        return "distance";
      case DirectRefusal::Orientation:
        return "orientation";
      case DirectRefusal::Lobe:
        return "lobe";
      case DirectRefusal::BeyondMost:
        return "beyond n_max";
    }
    return "";
  }

  AnswerReport direct(const VisiblePoint& p, const DirectSource& source) const {
    AnswerReport report;
    std::vector<std::string> names;
    for (const std::uint32_t light : source.lights) names.push_back(lightName(scene_, light));
    report.name = names.size() > 4 ? fmt::format("{} lights without vectors", names.size())
                                   : fmt::format("{}", fmt::join(names, ", "));
    report.origin = source.origin;
    // DLVs are of the lights as their file has them.
    const Rgb scale = scale_ * source.factor;
    report.radiance = scale * source.radiance;
    const DirectAnswer& answer = source.answer.answer;
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    float sum = 0.0f;
    for (const DirectCandidate& c : source.answer.candidates) sum += c.weight;
    const std::string together = verdictText(source.answer);
    for (const DirectCandidate& c : source.answer.candidates) {
      const DirectLightVector& record = frame_.snapshot->direct[source.lights.front()][c.number];
      CandidateReport candidate;
      candidate.record = {source.lights.front(), c.number};
      candidate.distance = c.distance;
      candidate.angle = angleBetween(record.point.normal, p.normal);
      candidate.weight = c.weight;
      candidate.own = c.number == source.own;
      if (c.refusal != DirectRefusal::None) {
        candidate.rule = ruleOf(c.refusal);
        candidate.verdict = directRefusalText(record, p, c, candidate.angle);
      } else if (source.origin == AnswerOrigin::Own && candidate.own) {
        candidate.used = true;
        candidate.share = report.radiance;
        candidate.verdict = "used alone: computed at this point";
      } else if (source.origin == AnswerOrigin::Interpolated && c.weight > 0.0f) {
        candidate.used = true;
        const float part = c.weight / sum;
        candidate.share =
            scale * directRadiance(scene_.materialOf(p.surface).brdf, p, dlv.store, part * record.energy,
                                   part * record.lobeRadiance, answer.direction);
        candidate.verdict = fmt::format("used, {} of the weight", percentText(part, 3));
      } else {
        candidate.rule = together.empty() ? "not asked" : "together";
        candidate.verdict = !together.empty() ? "valid, but " + together
                            : source.origin == AnswerOrigin::Interpolated
                                ? "weight 0 at the edge of r_max"
                                : "valid, but the point has its own value";
      }
      report.candidates.push_back(std::move(candidate));
    }
    if (source.origin == AnswerOrigin::Computed && !together.empty()) report.note = together;
    finish(report, source.isExact);
    return report;
  }

  /// Sorts the candidates, leaves out what is too much, and adds up the shares.
  static void finish(AnswerReport& report, bool isExact) {
    std::stable_sort(
        report.candidates.begin(), report.candidates.end(),
        [](const CandidateReport& a, const CandidateReport& b) { return a.distance < b.distance; });
    const bool fromVectors =
        report.origin == AnswerOrigin::Interpolated || report.origin == AnswerOrigin::Own;
    if (fromVectors) {
      for (const CandidateReport& candidate : report.candidates) report.explained += candidate.share;
    } else {
      report.explained = report.radiance;
    }
    std::size_t refused = 0;
    const auto isTooMuch = [&](const CandidateReport& candidate) {
      return !candidate.used && !candidate.own && ++refused > kListed;
    };
    report.omitted = std::erase_if(report.candidates, isTooMuch);
    report.isExact = isExact;
    if (!isExact) report.note = "the vectors that are valid now give a slightly different value";
  }

  const RenderFrame& frame_;
  const Scene& scene_;
  PointExplainer explainer_;
  IlvRules rules_;
  float scale_;
};

}  // namespace

PixelReport pixelReport(const RenderFrame& frame, int x, int y) {
  PixelReport report;
  report.x = x;
  report.y = y;
  if (!frame.film || x < 0 || y < 0 || x >= frame.film->width || y >= frame.film->height) {
    report.note = "outside of the picture";
    return report;
  }
  const float scale = frame.scene->normalisation.radianceScale();
  const std::size_t i = frame.film->depth().index(x, y);
  report.shown = scale * frame.film->beauty(i);
  report.emission = scale * frame.film->emission[i];
  if (!frame.points) {
    report.direct = scale * frame.film->direct[i];
    report.indirect = scale * frame.film->indirect[i];
    report.specular = scale * frame.film->specular[i];
    report.note = frame.parameters.picture.method == Method::Vectors
                      ? "the rules `printed` keep their vectors to themselves"
                      : "this method has no vectors";
    return report;
  }
  const PixelWays ways = tracePixelWays(frame, x, y);
  report.specular = scale * ways.specularEmission;
  const PixelPoints points = pointsOfPixel(*frame.points, static_cast<std::uint32_t>(i));
  Reporter reporter(frame);
  for (std::uint32_t n = 0; n < points.count; ++n) {
    const PointRef ref{points.tile, points.first + n};
    PointReport point = reporter.report(ref);
    // The ways were found in the same order; a ray that grazes an edge may have gone elsewhere now.
    if (n < ways.points.size() &&
        ways.points[n].surface == frame.points->tiles[ref.tile].points[ref.point].surface)
      point.reached = ways.points[n].text;
    else
      point.reached = point.throughSpecular ? "by way of mirrors or glass" : "seen straight";
    if (frame.answers[ref.tile]->looked[ref.point] == 0) report.coarse = true;
    if (point.throughSpecular) {
      report.specular += point.throughput * (point.direct + point.indirectSum);
    } else {
      report.direct += point.throughput * point.direct;
      report.indirect += point.throughput * point.indirectSum;
    }
    report.points.push_back(std::move(point));
  }
  if (points.count == 0)
    report.note = fmt::format("no surface here asks for light: the pixel shows {}", ways.end);
  if (report.coarse)
    report.note = "not looked at yet: the picture shows a pixel nearby until a finer pass comes here";
  return report;
}

}  // namespace lightvane
