#include "core/inspect/full_computation.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/inspect/frame_points.h"
#include "core/inspect/specular_ways.h"
#include "core/render/point_answers.h"
#include "core/render/vector_renderer.h"

namespace lightvane {
namespace {

// The samples are taken in so many independent batches, every other one for either half; their spread gives
// the standard error. Stratified samples of one batch are not independent.
constexpr int kBatches = 16;
constexpr std::size_t kHalves = 2;

// Streams of random numbers of their own: "full".
constexpr std::uint32_t kFullStream = 0x66756c6cU;

/// What a gather says about a point, normalised units.
struct GatheredLight {
  Rgb diffuse{0.0f};  ///< indirect radiance of the Lambertian part
  Rgb lobe{0.0f};     ///< of the lobe
};

/// Everything that one batch says about a point, normalised units.
struct Batch {
  std::vector<Rgb> lights;            ///< radiance towards the viewer of each light
  std::vector<Rgb> lightIrradiances;  ///< of each light
  Rgb mirrored{0.0f};
  GatheredLight indirect;   ///< as far as path.max_bounces lets paths go
  GatheredLight unbounded;  ///< with all bounces
  Rgb irradiance{0.0f};     ///< indirect, as `indirect`
};

/// A vector's share in what a point got.
struct Share {
  std::uint32_t number;
  double weight;
  float distance;
  bool isHidden = false;  ///< of an ILV: something stands between
};

template <class Source>
std::vector<Share> sharesOf(const Source& source) {
  std::vector<Share> shares;
  if (source.origin == AnswerOrigin::Own) {
    shares.push_back({source.own, 1.0, 0.0f});
  } else if (source.origin == AnswerOrigin::Interpolated) {
    for (const auto& candidate : source.answer.candidates) {
      if (candidate.weight != 0.0f)
        shares.push_back({candidate.number, static_cast<double>(candidate.weight), candidate.distance});
    }
  }
  return shares;
}

/// The weighted mean of what vectors say. Weights as the paper prints them may be negative: no mean where
/// they come to nothing.
struct VectorMean {
  Vec3d energy{0.0}, lobe{0.0}, irradiance{0.0}, direction{0.0};
  double weight = 0.0;

  void add(double w, const Rgb& e, const Rgb& l, const Vec3d& i, const Vec3& d) {
    energy += w * Vec3d(e);
    lobe += w * Vec3d(l);
    irradiance += w * i;
    direction += w * Vec3d(d);
    weight += w;
  }
  bool isThere() const { return weight != 0.0; }
  VectorMean normalised() const {
    VectorMean mean = *this;
    mean.energy /= weight;
    mean.lobe /= weight;
    mean.irradiance /= weight;
    mean.direction /= weight;
    return mean;
  }
};

/// `irradiance` as a vector's light goes from `own` to `moved`, by colour.
Vec3d movedAlong(const Rgb& irradiance, const Rgb& own, const Rgb& moved) {
  Vec3d result(irradiance);
  for (int c = 0; c < 3; ++c) {
    if (own[c] > 0.0f) result[c] *= static_cast<double>(moved[c]) / static_cast<double>(own[c]);
  }
  return result;
}

PixelPoints pointsAt(const RenderFrame& frame, int x, int y) {
  return pointsOfPixel(*frame.points, static_cast<std::uint32_t>(frame.film->depth().index(x, y)));
}

}  // namespace

class FullComputer::Points {
 public:
  Points(const RenderFrame& frame, int samples, const StopFlag& stop)
      : frame_(frame),
        scene_(*frame.scene),
        stop_(stop),
        batchSamples_(std::max(2, samples / kBatches)),
        explainer_(frame),
        rules_(frame.parameters.vectors.ilv, frame.scene->diagonal),
        sampler_(*frame.shownTracer, frame.parameters.transport),
        mirrored_(*frame.indirectTracer, frame.parameters.transport),
        gatherer_(gathererOf(frame.parameters.transport, frame.parameters.vectors)),
        hemisphere_(
            gathererOf(frame.parameters.transport, cellsFor(batchSamples_, frame.parameters.vectors))) {
    if (frame.parameters.transport.maxBounces == 0) return;
    TransportParameters transport = frame.parameters.transport;
    transport.maxBounces = 0;
    unbounded_.emplace(gathererOf(transport, frame.parameters.vectors));
  }

  const RenderFrame& frame() const { return frame_; }
  int samples() const { return batchSamples_ * kBatches; }
  const RayCounts& rays() const { return rays_; }
  void begin() {
    rays_ = {};
    totals_ = {};
  }

  void findShares(PointRef ref, std::set<RecordRef>& shares) {
    for (const DirectSource& source : explainer_.direct(ref, 0.0f)) {
      for (const Share& share : sharesOf(source)) shares.insert({source.lights.front(), share.number});
    }
    for (const IndirectSource& source : explainer_.indirect(ref, 0.0f)) {
      for (const Share& share : sharesOf(source)) shares.insert({kNone, share.number});
    }
  }

  /// Adds a point to the computation; not to be used when stopped meanwhile.
  void add(PointRef ref, const ExactVectors& exact, std::array<FullValues, kHalves>& halves) {
    const VisiblePoint& p = explainer_.point(ref);
    const LitPoint lit = p.lit(scene_);
    std::vector<Batch> batches;
    for (int b = 0; b < kBatches; ++b) {
      if (stop_) return;
      batches.push_back(batch(p, lit, static_cast<std::uint32_t>(b)));
      Rgb all = batches.back().mirrored + batches.back().unbounded.diffuse + batches.back().unbounded.lobe;
      for (const Rgb& light : batches.back().lights) all += light;
      totals_[static_cast<std::size_t>(b)] += inScene(p, all);
    }
    const std::vector<DirectSource> lights = explainer_.direct(ref, 0.0f);
    const std::vector<IndirectSource> keys = explainer_.indirect(ref, 0.0f);
    std::vector<std::vector<Share>> sharesOfKeys;
    for (const IndirectSource& source : keys) sharesOfKeys.push_back(sharesSeen(p, source));
    for (std::size_t half = 0; half < kHalves; ++half) {
      const PointHalf at{p, half, batches, exact};
      for (const DirectSource& source : lights) halves[half].direct += direct(at, source);
      const Vec3d mirrored = inScene(p, frame_.answers[ref.tile]->mirrored[ref.point]);
      halves[half].mirrored += sampled(mirrored, mean(at, [](const Batch& b) { return b.mirrored; }));
      for (std::size_t k = 0; k < keys.size(); ++k)
        halves[half].indirect += indirect(at, keys[k], sharesOfKeys[k]);
    }
  }

  Vec3d standardError() const {
    Vec3d average(0.0);
    for (const Vec3d& total : totals_) average += total / static_cast<double>(kBatches);
    Vec3d variance(0.0);
    for (const Vec3d& total : totals_) variance += (total - average) * (total - average);
    return glm::sqrt(variance / static_cast<double>(kBatches * (kBatches - 1)));
  }

 private:
  /// Half of what is known of a point.
  struct PointHalf {
    const VisiblePoint& p;
    std::size_t half;
    const std::vector<Batch>& batches;
    const ExactVectors& exact;
  };

  Gatherer gathererOf(const TransportParameters& transport, const VectorParameters& vectors) const {
    Gatherer gatherer(*frame_.indirectTracer, transport, vectors);
    gatherer.stopWith(stop_);
    gatherer.knowSight(frame_.points->sight.get());
    return gatherer;
  }

  /// A hemisphere of about `samples` cells, twice as many around as down.
  static VectorParameters cellsFor(int samples, VectorParameters vectors) {
    vectors.ilv.rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(samples) / 2.0f)));
    vectors.ilv.columns = std::max(1, samples / vectors.ilv.rows);
    return vectors;
  }

  /// Radiance at a point as the pixel has it, in the scene's units.
  Vec3d inScene(const VisiblePoint& p, const Rgb& radiance) const {
    return Vec3d(p.throughput) * Vec3d(radiance) * std::ldexp(1.0, scene_.normalisation.radianceExponent);
  }

  /// Of every other batch, as they are.
  template <class ValueOf>
  static Vec3d meanOfHalf(const PointHalf& at, const ValueOf& valueOf) {
    Vec3d sum(0.0);
    for (std::size_t b = at.half; b < at.batches.size(); b += kHalves) sum += Vec3d(valueOf(at.batches[b]));
    const std::size_t count = at.batches.size() / kHalves;
    return sum / static_cast<double>(count);
  }

  /// Of radiances, as the pixel has them.
  template <class ValueOf>
  Vec3d mean(const PointHalf& at, const ValueOf& valueOf) const {
    return meanOfHalf(at, [&](const Batch& b) { return inScene(at.p, valueOf(b)); });
  }

  /// Of light that was sampled at the point, in the picture too.
  static FullValue sampled(const Vec3d& shown, const Vec3d& full) {
    FullValue value{shown, full, {}};
    value.parts.noise = shown - full;
    return value;
  }

  GatheredLight gathered(Gatherer& gatherer, const VisiblePoint& p, const LitPoint& lit,
                         const RandomKey& key) {
    const Brdf& brdf = scene_.materialOf(p.surface).brdf;
    GatheredLight light;
    const Rgb outgoing = gatherer.outgoingRadiance(lit, batchSamples_, key, rays_, faults_);
    if (brdf.hasDiffuse())
      light.diffuse = brdf.diffuse(p.tint()) * kInvPi * hemisphereIrradiance(gatherer.hemisphere());
    light.lobe = outgoing - light.diffuse;
    return light;
  }

  Batch batch(const VisiblePoint& p, const LitPoint& lit, std::uint32_t number) {
    const RandomKey key =
        pointKey(frame_.region, p, randomKey(frame_.parameters.picture.seed)).with(kFullStream).with(number);
    const Brdf& brdf = scene_.materialOf(p.surface).brdf;
    Batch batch;
    for (std::uint32_t light = 0; light < scene_.lights.size(); ++light) {
      const DirectLightEstimate e = sampler_.estimate(lit, light, batchSamples_, key, rays_, faults_);
      batch.lights.push_back(reflectedRadiance(brdf, p.tint(), e));
      batch.lightIrradiances.push_back(e.irradiance);
    }
    batch.mirrored = reflectedRadiance(brdf, p.tint(),
                                       mirrored_.estimateMirrored(lit, batchSamples_, key, rays_, faults_));
    batch.indirect = gathered(gatherer_, p, lit, key);
    if (brdf.hasDiffuse()) {
      batch.irradiance = hemisphereIrradiance(gatherer_.hemisphere());
    } else if (frame_.parameters.vectors.ilv.store == VectorStore::Vector) {
      // A vector of the whole BRDF samples the hemisphere though nothing here is Lambertian.
      batch.irradiance =
          hemisphere_.gather({lit, p.vectorFootprint}, kLambertKey, key.asSeed(), rays_, faults_).irradiance;
    }
    // The same numbers: where no path is cut off, nothing is missing.
    batch.unbounded = unbounded_ ? gathered(*unbounded_, p, lit, key) : batch.indirect;
    return batch;
  }

  FullValue direct(const PointHalf& at, const DirectSource& source) const {
    Vec3d full(0.0), irradiance(0.0);
    for (const std::uint32_t light : source.lights) {
      full += mean(at, [&](const Batch& b) { return b.lights[light]; });
      irradiance += meanOfHalf(at, [&](const Batch& b) { return b.lightIrradiances[light]; });
    }
    const Vec3d shown = inScene(at.p, source.factor * source.radiance);
    VectorMean sum;
    for (const Share& share : sharesOf(source)) {
      const RecordRef record{source.lights.front(), share.number};
      const DirectLightVector& vector = at.exact.direct(record, at.half);
      sum.add(share.weight, vector.energy, vector.lobeRadiance, Vec3d(at.exact.irradiance(record, at.half)),
              vector.direction);
    }
    if (!sum.isThere()) return sampled(shown, full);
    VectorMean exact = sum.normalised();
    const DlvParameters& dlv = frame_.parameters.vectors.dlv;
    const double length = glm::length(exact.direction);
    if (dlv.normaliseDirection && length > 0.0) exact.direction /= length;
    const Brdf& brdf = scene_.materialOf(at.p.surface).brdf;
    const Vec3d interpolated =
        inScene(at.p, source.factor * directRadiance(brdf, at.p, dlv.store, Rgb(exact.energy),
                                                     Rgb(exact.lobe), Vec3(exact.direction)));
    FullValue value{
        shown, full,
        interpolationParts({interpolated, Vec3d(source.factor) * exact.irradiance}, {full, irradiance},
                           dlv.store == VectorStore::Vector && brdf.hasLobe())};
    value.parts.noise = shown - interpolated;
    return value;
  }

  LightAtPoint given(const PointHalf& at, SurfaceKey key, const VectorMean& sum) const {
    const VectorMean mean = sum.normalised();
    const double length = glm::length(mean.direction);
    const Vec3 direction = length > 0.0 ? Vec3(mean.direction / length) : at.p.normal;
    const Rgb radiance = indirectRadiance(scene_.materialOf(at.p.surface).brdf, at.p, rules_.p.store, key,
                                          Rgb(mean.energy), direction);
    return {inScene(at.p, radiance), mean.irradiance};
  }

  std::vector<Share> sharesSeen(const VisiblePoint& p, const IndirectSource& source) const {
    std::vector<Share> shares = sharesOf(source);
    for (Share& share : shares) {
      const IlvCandidate candidate = makeCandidate(frame_.snapshot->indirect[share.number], rules_);
      share.isHidden = isHiddenFrom(frame_, p, candidate, share.distance);
    }
    return shares;
  }

  FullValue indirect(const PointHalf& at, const IndirectSource& source,
                     const std::vector<Share>& shares) const {
    const bool isWhole = rules_.p.store == VectorStore::Vector;
    const auto ofKey = [&](const GatheredLight& light) {
      if (isWhole) return light.diffuse + light.lobe;
      return source.key == kLambertKey ? light.diffuse : light.lobe;
    };
    const Vec3d full = mean(at, [&](const Batch& b) { return ofKey(b.unbounded); });
    const LightAtPoint own{mean(at, [&](const Batch& b) { return ofKey(b.indirect); }),
                           meanOfHalf(at, [](const Batch& b) { return b.irradiance; })};
    const Vec3d shown = inScene(at.p, source.radiance);
    VectorMean all, seen;
    for (const Share& share : shares) {
      const IndirectLightVector& vector = at.exact.indirect(share.number, at.half);
      // What a point's own vector gives it alone is not moved.
      const Rgb energy = source.origin == AnswerOrigin::Own
                             ? vector.energy
                             : ilvExtrapolate(vector, at.p.position, at.p.normal, rules_.p,
                                              makeCandidate(vector, rules_).gradientScale);
      const Vec3d irradiance = movedAlong(vector.irradiance, vector.energy, energy);
      all.add(share.weight, energy, Rgb(0.0f), irradiance, vector.direction);
      if (!share.isHidden) seen.add(share.weight, energy, Rgb(0.0f), irradiance, vector.direction);
    }
    const LightAtPoint ofAll = all.isThere() ? given(at, source.key, all) : LightAtPoint{shown, {}};
    // Where nothing is left without leaks, its own vector would be asked for.
    const LightAtPoint ofSeen = !all.isThere() ? ofAll : seen.isThere() ? given(at, source.key, seen) : own;
    const bool hasDirection = isWhole && scene_.materialOf(at.p.surface).brdf.hasLobe();
    FullValue value{shown, full, interpolationParts(ofSeen, own, hasDirection && all.isThere())};
    value.parts.noise = shown - ofAll.radiance;
    value.parts.leaks = ofAll.radiance - ofSeen.radiance;
    value.parts.missingBounces = own.radiance - full;
    return value;
  }

  const RenderFrame& frame_;
  const Scene& scene_;
  const StopFlag& stop_;
  int batchSamples_;
  PointExplainer explainer_;
  IlvRules rules_;
  DirectLightSampler sampler_;   ///< of the lights as they are shown
  DirectLightSampler mirrored_;  ///< of those that are reflected, as ILVs have them
  Gatherer gatherer_;
  Gatherer hemisphere_;                ///< with as many cells as a batch has samples
  std::optional<Gatherer> unbounded_;  ///< with all bounces, where the frame's paths end early
  RayCounts rays_;
  SampleFaults faults_;
  std::array<Vec3d, kBatches> totals_{};  ///< of all points, for each batch
};

DifferenceParts& DifferenceParts::operator+=(const DifferenceParts& other) {
  noise += other.noise;
  leaks += other.leaks;
  interpolation += other.interpolation;
  singleDirection += other.singleDirection;
  missingBounces += other.missingBounces;
  return *this;
}

DifferenceParts& DifferenceParts::operator*=(double factor) {
  noise *= factor;
  leaks *= factor;
  interpolation *= factor;
  singleDirection *= factor;
  missingBounces *= factor;
  return *this;
}

FullValue& FullValue::operator+=(const FullValue& other) {
  shown += other.shown;
  full += other.full;
  parts += other.parts;
  return *this;
}

FullValue& FullValue::operator*=(double factor) {
  shown *= factor;
  full *= factor;
  parts *= factor;
  return *this;
}

FullValue FullValues::total() const {
  FullValue total = direct;
  total += mirrored;
  total += indirect;
  return total;
}

FullComputer::FullComputer(const RenderFrame& frame, int samples, const StopFlag& stop)
    : points_(std::make_unique<Points>(frame, samples, stop)) {}
FullComputer::FullComputer(FullComputer&&) noexcept = default;
FullComputer::~FullComputer() = default;

int FullComputer::samples() const { return points_->samples(); }

std::string FullComputer::obstacle(const RenderFrame& frame, int x, int y) {
  if (!frame.film || x < 0 || y < 0 || x >= frame.film->width || y >= frame.film->height)
    return "outside of the picture";
  if (!frame.points) return "only pictures made with vectors have points to compute at";
  const PixelPoints points = pointsAt(frame, x, y);
  if (points.count == 0)
    return fmt::format("no surface here asks for light: the pixel shows {}", tracePixelWays(frame, x, y).end);
  for (std::uint32_t n = 0; n < points.count; ++n) {
    if (frame.answers[points.tile]->looked[points.first + n] == 0)
      return "not looked at yet: there is nothing to compare with";
  }
  return {};
}

void FullComputer::findShares(int x, int y, std::set<RecordRef>& shares) {
  const PixelPoints points = pointsAt(points_->frame(), x, y);
  for (std::uint32_t n = 0; n < points.count; ++n)
    points_->findShares({points.tile, points.first + n}, shares);
}

FullComputation FullComputer::compute(int x, int y, const ExactVectors& exact) {
  const FlushDenormals flush;
  FullComputation result;
  points_->begin();
  const PixelPoints points = pointsAt(points_->frame(), x, y);
  for (std::uint32_t n = 0; n < points.count; ++n)
    points_->add({points.tile, points.first + n}, exact, result.halves);
  result.rays = points_->rays();
  result.samples = points_->samples();
  for (const FullValues& half : result.halves) {
    result.values.direct += half.direct;
    result.values.mirrored += half.mirrored;
    result.values.indirect += half.indirect;
  }
  for (FullValue* value : {&result.values.direct, &result.values.mirrored, &result.values.indirect})
    *value *= 1.0 / static_cast<double>(kHalves);
  result.total = result.values.total();
  result.standardError = points_->standardError();
  result.finished = true;
  return result;
}

FullComputation computeHere(const RenderFrame& frame, int x, int y, int samples, const StopFlag& stop) {
  FullComputation result;
  result.note = FullComputer::obstacle(frame, x, y);
  if (!result.note.empty()) return result;
  FullComputer computer(frame, samples, stop);
  std::set<RecordRef> shares;
  computer.findShares(x, y, shares);
  ExactVectors exact(frame);
  TaskPool pool(1);
  exact.compute(std::vector(shares.begin(), shares.end()), pool, stop);
  if (!stop) result = computer.compute(x, y, exact);
  result.rays += exact.rays();
  if (!stop) return result;
  FullComputation stopped;
  stopped.note = "stopped";
  stopped.rays = result.rays;
  return stopped;
}

DifferenceParts interpolationParts(const LightAtPoint& interpolated, const LightAtPoint& own,
                                   bool hasDirection) {
  DifferenceParts parts;
  parts.interpolation = interpolated.radiance - own.radiance;
  if (!hasDirection) return parts;
  for (int c = 0; c < 3; ++c) {
    // Without irradiance there is no ratio, and no direction to blame.
    if (!(own.irradiance[c] > 0.0)) continue;
    // What would be reflected of the interpolated irradiance as it is of the point's own.
    const double ofIrradiance = own.radiance[c] * (interpolated.irradiance[c] / own.irradiance[c] - 1.0);
    parts.singleDirection[c] = parts.interpolation[c] - ofIrradiance;
    parts.interpolation[c] = ofIrradiance;
  }
  return parts;
}

}  // namespace lightvane
