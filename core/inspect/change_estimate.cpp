#include "core/inspect/change_estimate.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/inspect/frame_points.h"
#include "core/render/change.h"
#include "core/render/point_answers.h"
#include "core/render/questions.h"
#include "core/render/vector_renderer.h"

namespace lightvane {
namespace {

// Pixels that are asked in each pass: as many as some milliseconds have room for.
constexpr int kPixelsOfAPass = 384;
// A tooltip shows two or three candidates at a time.
constexpr std::size_t kRememberedAnswers = 16;

/// The pixels that one pass looks at and no pass before it did.
struct Pass {
  int stride = 1;
  int before = 0;  ///< the stride of the pass before; 0 for the first
  bool isLast = false;
};

std::vector<Pass> passesOf(const PictureParameters& picture) {
  std::vector<Pass> passes;
  // As VectorRenderer has them.
  int stride = std::max(picture.firstStride, picture.lastStride);
  passes.push_back({stride, 0, false});
  while (stride / 2 >= picture.lastStride && stride > 1) {
    passes.push_back({stride / 2, stride, false});
    stride /= 2;
  }
  passes.push_back({1, stride, true});
  return passes;
}

/// A visible point that asks for vectors of one kind and key, and what it finds.
struct Asker {
  Vec3 position{0.0f};
  Vec3 normal{0.0f};
  SurfaceKey key = kLambertKey;
  std::uint32_t light = kNone;  ///< whose vectors it asks for; kNone for ILVs
  double pixels = 1.0;          ///< of its pass, that it stands for
  double valid = 0.0;           ///< vectors that would serve it and are there already
  bool isSettled = false;       ///< its own vector is there already
  /// How likely it is that it misses with vectors enough: DLVs that are too unlike.
  double refused = 0.0;
  float radius = 0.0f;         ///< within which vectors are valid about here
  double served = 0.0;         ///< pixels that a vector here would serve
  float servedOctaves = 0.0f;  ///< its binary logarithm
  double missing = 0.0;        ///< the probability that a vector is computed for it
};

/// What one pass asks.
struct AskedPass {
  Pass pass;
  double perPixel = 0.0;  ///< of the picture's pixels, those that the pass is the first to look at
  std::vector<Asker> askers;
  bool hasMisses = false;
};

/// How many vectors a point asks for.
struct Wanted {
  int atLeast = 1;
  int inTheEnd = 1;  ///< in the last pass
  int atMost = 1;    ///< that count
  /// Vectors computed before the first pass, at places chosen by chance, for each pixel of the picture.
  double seedPerPixel = 0.0;
};

/// Plays the passes: where vectors are short they are computed, and serve the passes after.
class Rehearsal {
 public:
  Rehearsal(const Wanted& wanted, double thinPixels) : wanted_(wanted), thinPixels_(thinPixels) {}

  /// How many vectors the passes would compute.
  double run(std::vector<AskedPass>& passes) const {
    double computed = 0.0;
    for (std::size_t p = 0; p < passes.size(); ++p) {
      const std::span<const AskedPass> earlier = std::span(passes).first(p);
      for (Asker& asker : passes[p].askers) {
        asker.missing = missing(asker, earlier, passes[p].pass.isLast);
        passes[p].hasMisses |= asker.missing > 0.0;
      }
      for (const Asker& asker : passes[p].askers) {
        if (asker.missing > 0.0) computed += asker.pixels * asker.missing * thinned(passes[p], asker);
      }
    }
    return computed;
  }

 private:
  double missing(const Asker& asker, std::span<const AskedPass> earlier, bool isLast) const {
    if (asker.isSettled) return 0.0;
    const auto enough = static_cast<double>(isLast ? wanted_.inTheEnd : wanted_.atLeast);
    double found = asker.valid;
    if (found < enough) found += wanted_.seedPerPixel * asker.served;
    for (std::size_t p = 0; p < earlier.size() && found < enough; ++p) found += foundIn(earlier[p], asker);
    const double tooFew = std::clamp(enough - std::min(found, static_cast<double>(wanted_.atMost)), 0.0, 1.0);
    return tooFew + (1.0 - tooFew) * asker.refused;
  }

  /// New vectors of an earlier pass that reach the asker.
  double foundIn(const AskedPass& pass, const Asker& asker) const {
    if (!pass.hasMisses) return 0.0;
    const double share = missingShare(pass, asker);
    return pass.perPixel * share * thinnedShare(pass, share) * asker.served;
  }

  /// Of the pass's points about here, those that miss. Points count by how near and how alike they are: near
  /// an edge other points miss than away from it.
  static double missingShare(const AskedPass& pass, const Asker& asker) {
    float misses = 0.0f;
    float all = 0.0f;
    const float nearness = 1.0f / square(std::max(asker.radius, 1e-12f));
    for (const Asker& other : pass.askers) {
      if (other.key != asker.key || other.light != asker.light) continue;
      const Vec3 away = other.position - asker.position;
      const float far = glm::dot(away, away) * nearness;
      const float octaves = other.servedOctaves - asker.servedOctaves;
      const float turned = 1.0f - glm::dot(other.normal, asker.normal);
      const float likeness =
          1.0f / ((1.0f + far * far) * (1.0f + octaves * octaves) * (1.0f + 50.0f * turned));
      misses += likeness * static_cast<float>(other.missing);
      all += likeness;
    }
    return all > 0.0f ? static_cast<double>(misses / all) : 0.0;
  }

  /// Of points that miss side by side, one stands for its neighbours (passes.thin).
  double thinned(const AskedPass& pass, const Asker& asker) const {
    if (pass.pass.stride >= thinPixels_) return 1.0;
    return thinnedShare(pass, missingShare(pass, asker));
  }
  double thinnedShare(const AskedPass& pass, double share) const {
    if (pass.pass.stride >= thinPixels_ || !(share > 0.0)) return 1.0;
    // Points that are kept no nearer to each other than that lie about so densely.
    const double most = 1.0 / (0.8 * square(thinPixels_));
    return std::min(1.0, most / (share * pass.perPixel));
  }

  Wanted wanted_;
  double thinPixels_;
};

/// The estimate of one candidate.
class Estimation {
 public:
  Estimation(const RenderFrame& frame, const Parameters& candidate, const StillTrue& still)
      : frame_(frame),
        scene_(*frame.scene),
        candidate_(candidate),
        still_(still),
        rules_(candidate.vectors.ilv, scene_.diagonal),
        answerer_(*frame.tracer, candidate.vectors),
        known_(&frame.snapshot->indirect) {
    if (still_.indirectVectors && !still_.radii) {
      rebuilt_ = known_->rebuilt(VectorRadii(candidate.vectors, scene_));
      reaching_ = &rebuilt_;
    } else {
      reaching_ = known_;
    }
    candidates_.reserve(known_->size());
    for (std::size_t i = 0; i < known_->size(); ++i)
      candidates_.push_back(makeCandidate((*known_)[i], rules_));
    choosePixels();
  }

  double newIndirect() {
    const IlvParameters& ilv = candidate_.vectors.ilv;
    const RandomKey questions = questionsOf(frame_.camera, frame_.region, candidate_).indirect;
    if (still_.indirectVectors && known_->settles(questions)) return 0.0;
    std::vector<AskedPass> passes = askedPasses(true);
    for (std::size_t p = 0; p < passes.size(); ++p) {
      forEachPoint(p, [&](const VisiblePoint& point, double pixels) {
        const SurfaceKeys keys = indirectKeys(scene_.materialOf(point.surface), ilv.store);
        for (int k = 0; k < keys.count; ++k)
          passes[p].askers.push_back(indirectAsker(point, keys.keys[k], pixels));
      });
    }
    const double seed = isCold() ? ilv.seed : 0.0;
    const Rehearsal rehearsal({ilv.nMin, ilv.nMinLast, ilv.nMax, seed / pixelCount()}, thinPixels());
    return seed + rehearsal.run(passes);
  }

  double newDirect() {
    const std::vector<bool> hasVectors = lightsWithVectors(scene_, candidate_);
    std::vector<std::uint32_t> lights;
    for (std::uint32_t light = 0; light < hasVectors.size(); ++light) {
      if (hasVectors[light]) lights.push_back(light);
    }
    if (lights.empty()) return 0.0;
    const RandomKey questions = questionsOf(frame_.camera, frame_.region, candidate_).direct;
    const bool isSettled = std::all_of(lights.begin(), lights.end(), [&](std::uint32_t light) {
      return frame_.snapshot->direct[light].settles(questions);
    });
    if (still_.directVectors && isSettled) return 0.0;
    const DlvParameters& dlv = candidate_.vectors.dlv;
    // The last pass keeps no more of them.
    std::vector<AskedPass> passes = askedPasses(false);
    LightShares shares;
    std::size_t next = 0;
    for (std::size_t p = 0; p < passes.size(); ++p) {
      forEachPoint(p, [&](const VisiblePoint& point, double pixels) {
        // Lights take turns: each point stands for all of them.
        const std::uint32_t light = lights[next++ % lights.size()];
        if (lights.size() > kMostLightsInFull) {
          shares.weigh(scene_, point.position, point.normal, frame_.points->sight.get());
          if (!shares.areWorthVectorsOf(light)) return;
        }
        passes[p].askers.push_back(directAsker(point, light, pixels * static_cast<double>(lights.size())));
      });
    }
    guessRefusals(passes);
    const double seed = isCold() ? dlv.seed : 0.0;
    const Rehearsal rehearsal({dlv.nMin, dlv.nMin, std::max(dlv.nMin, dlv.nMax), seed / pixelCount()},
                              thinPixels());
    return seed * static_cast<double>(lights.size()) + rehearsal.run(passes);
  }

 private:
  struct ChosenPixels {
    Pass pass;
    double perPixel = 0.0;
    double weight = 1.0;  ///< pixels of the pass that each stands for
    std::vector<std::uint32_t> pixels;
  };

  /// Whether nothing stays, so that the rendering begins with its seed.
  bool isCold() const {
    return (!still_.indirectVectors || known_->empty()) &&
           (!still_.directVectors || frame_.snapshot->directCount() == 0);
  }

  double pixelCount() const {
    return static_cast<double>(frame_.region.width) * static_cast<double>(frame_.region.height);
  }
  /// `passes.thin` in pixels of this picture.
  double thinPixels() const { return candidate_.picture.thin * frame_.region.fullHeight / 256.0; }

  void choosePixels() {
    for (const Pass& pass : passesOf(candidate_.picture)) chosen_.push_back(pixelsOf(pass));
  }

  ChosenPixels pixelsOf(const Pass& pass) const {
    const auto gridOf = [&](int stride) {
      return std::pair((frame_.region.width + stride - 1) / stride,
                       (frame_.region.height + stride - 1) / stride);
    };
    const auto sizeOf = [](const std::pair<int, int>& grid) {
      return static_cast<double>(grid.first) * static_cast<double>(grid.second);
    };
    const auto grid = gridOf(pass.stride);
    ChosenPixels chosen{pass, 0.0, 1.0, {}};
    const double all = sizeOf(grid) - (pass.before == 0 ? 0.0 : sizeOf(gridOf(pass.before)));
    chosen.perPixel = all / pixelCount();
    const auto add = [&](int column, int row) {
      const int x = column * pass.stride;
      const int y = row * pass.stride;
      const bool wasLookedAt = pass.before != 0 && x % pass.before == 0 && y % pass.before == 0;
      if (!wasLookedAt) chosen.pixels.push_back(static_cast<std::uint32_t>(y * frame_.region.width + x));
    };
    if (all <= kPixelsOfAPass) {
      for (int row = 0; row < grid.second; ++row) {
        for (int column = 0; column < grid.first; ++column) add(column, row);
      }
      return chosen;
    }
    for (std::uint32_t i = 1; chosen.pixels.size() < kPixelsOfAPass; ++i) {
      const auto cell = [](double place, int size) {
        return std::min(static_cast<int>(place * size), size - 1);
      };
      const Vec2d place = r2Place(i);
      add(cell(place.x, grid.first), cell(place.y, grid.second));
    }
    chosen.weight = all / static_cast<double>(chosen.pixels.size());
    return chosen;
  }

  std::vector<AskedPass> askedPasses(bool withLast) const {
    std::vector<AskedPass> passes;
    for (const ChosenPixels& chosen : chosen_) {
      if (withLast || !chosen.pass.isLast) passes.push_back({chosen.pass, chosen.perPixel, {}});
    }
    return passes;
  }

  template <class Visit>
  void forEachPoint(std::size_t pass, const Visit& visit) const {
    for (const std::uint32_t pixel : chosen_[pass].pixels) {
      const PixelPoints points = pointsOfPixel(*frame_.points, pixel);
      for (std::uint32_t n = 0; n < points.count; ++n)
        visit(frame_.points->tiles[points.tile].points[points.first + n], chosen_[pass].weight);
    }
  }

  /// Pixels within `radius` of a point, if the surface goes on as it does here.
  double pixelsWithin(const VisiblePoint& point, float radius) const {
    const double pixel = point.footprint * 256.0 / frame_.region.fullHeight;
    const double cosine = std::abs(glm::dot(point.normal, point.outgoing));
    return std::min(kPi * square(radius / std::max(pixel, 1e-30)) * cosine, pixelCount());
  }

  static void serve(Asker& asker, double pixels) {
    asker.served = pixels;
    asker.servedOctaves = static_cast<float>(std::log2(std::max(pixels, 1.0)));
  }

  static Asker askerAt(const VisiblePoint& point, SurfaceKey key, double pixels) {
    Asker asker;
    asker.position = point.position;
    asker.normal = point.normal;
    asker.key = key;
    asker.pixels = pixels;
    return asker;
  }

  Asker indirectAsker(const VisiblePoint& point, SurfaceKey key, double pixels) {
    Asker asker = askerAt(point, key, pixels);
    const Neighbours found = indirectNeighbours(point, knownKey(point, key));
    // New vectors reach the point as those do that reach it now: by distance, and by all other rules.
    asker.radius = found.within > 0 ? std::sqrt(found.squaredRadii / static_cast<float>(found.within))
                                    : radiusAt(point, key);
    serve(asker, pixelsWithin(point, asker.radius) * (found.valid + 1.0) / (found.within + 1.0));
    if (!still_.indirectVectors) return asker;
    asker.valid = found.valid;
    asker.isSettled = found.hasOwn;
    return asker;
  }

  /// The key under which the frame has vectors that tell of those of `key`: another where the candidate
  /// stores something else.
  SurfaceKey knownKey(const VisiblePoint& point, SurfaceKey key) const {
    const VectorStore before = frame_.parameters.vectors.ilv.store;
    return before == rules_.p.store ? key : indirectKeys(scene_.materialOf(point.surface), before).keys[0];
  }

  /// What of the frame's ILVs is around a point, under the candidate's rules.
  struct Neighbours {
    int within = 0;             ///< vectors whose radius reaches the point
    float squaredRadii = 0.0f;  ///< of those, the sum
    int valid = 0;              ///< those that would serve it
    bool hasOwn = false;        ///< one was computed at the very point
  };

  Neighbours indirectNeighbours(const VisiblePoint& point, SurfaceKey key) {
    const QueryPoint query = queryPoint(point, rules_.p);
    Neighbours neighbours;
    reaching_->query(key, point.position, point.offset, found_);
    doubtful_.clear();
    for (const std::uint32_t number : found_) {
      const IlvCandidate& a = candidates_[number];
      const float distance = glm::length(point.position - a.position);
      if (distance > a.radius) continue;
      ++neighbours.within;
      neighbours.squaredRadii += square(a.radius);
      if (distance == 0.0f && isOwn((*known_)[number].point, point)) neighbours.hasOwn = true;
      Refusal refusal;
      const float weight = ilvWeight(a, point.position, point.normal, point.outgoing, rules_, refusal);
      if (refusal != Refusal::None || weight == 0.0f || distance > query.reach) continue;
      if (distance > a.visibleWithin) {
        doubtful_.emplace_back(number, distance);
      } else {
        ++neighbours.valid;
      }
    }
    // Rays are asked last, and only where it matters what they say.
    const int enough = std::max(rules_.p.nMin, rules_.p.nMinLast);
    for (const auto& [number, distance] : doubtful_) {
      Ray ray;
      const bool isHidden = neighbours.valid < enough &&
                            visibilityRay(candidates_[number], query, distance, ray) &&
                            frame_.tracer->occluded(ray);
      if (!isHidden) ++neighbours.valid;
    }
    return neighbours;
  }

  /// Whether the vector was computed for the very point, so that none is computed there again.
  static bool isOwn(const VectorPoint& vector, const VisiblePoint& point) {
    return vector.position == point.position && vector.normal == point.normal &&
           (vector.key == kLambertKey || vector.outgoing == point.outgoing);
  }

  /// The radius that a vector would have at a point that none reaches any more: by the distances that the
  /// nearest one met.
  float radiusAt(const VisiblePoint& point, SurfaceKey key) {
    known_->query(knownKey(point, key), point.position, point.offset, found_);
    const IndirectLightVector* nearest = nearestOf(found_, point.position);
    IndirectLightVector like;
    if (nearest != nullptr) {
      like.arithmeticMean = nearest->arithmeticMean;
      like.harmonicMean = nearest->harmonicMean;
      like.leastDistance = nearest->leastDistance;
    } else {
      // Nothing is known but what stands over it.
      like.arithmeticMean = like.harmonicMean = like.leastDistance =
          std::min(point.clearance, 0.5f * scene_.diagonal);
    }
    const bool isLobe = rules_.p.store == VectorStore::Split && key != kLambertKey;
    like.lobeWidth = isLobe ? scene_.materialOf(point.surface).brdf.lobeHalfWidth() : 0.0f;
    like.point.footprint = point.vectorFootprint;
    return ilvRadius(like, rules_);
  }

  const IndirectLightVector* nearestOf(const std::vector<std::uint32_t>& numbers,
                                       const Vec3& position) const {
    std::uint32_t nearest = kNone;
    float least = kInfinity;
    for (const std::uint32_t number : numbers) {
      const float distance = glm::length(candidates_[number].position - position);
      if (distance >= least) continue;
      least = distance;
      nearest = number;
    }
    return nearest == kNone ? nullptr : &(*known_)[nearest];
  }

  Asker directAsker(const VisiblePoint& point, std::uint32_t light, double pixels) {
    const DlvParameters& dlv = candidate_.vectors.dlv;
    const Material& material = scene_.materialOf(point.surface);
    const SurfaceKey key = directSurfaceKey(material, dlv.store);
    Asker asker = askerAt(point, key, pixels);
    asker.light = light;
    const RecordSet<DirectLightVector>& records = frame_.snapshot->direct[light];
    const QueryPoint query = queryPoint(point, rules_.p);
    // Its trees have the radius of before.
    const float further =
        std::max(0.0f, answerer_.dlvRadius() - dlvRadius(frame_.parameters.vectors.dlv, scene_));
    const DirectExplanation told = answerer_.explainDirect(
        records, directSurfaceKey(material, frame_.parameters.vectors.dlv.store), query, point.position,
        further + point.offset, directLobeWidth(material.brdf), records.size());
    int within = 0;
    // None is computed so near to a valid one.
    const float dense = static_cast<float>(candidate_.picture.thin) * point.footprint;
    for (const DirectCandidate& candidate : told.candidates) {
      const bool isValid =
          candidate.refusal == DirectRefusal::None || candidate.refusal == DirectRefusal::BeyondMost;
      if (still_.directVectors && isValid && candidate.distance < dense) asker.isSettled = true;
      if (candidate.refusal != DirectRefusal::Distance) ++within;
      if (still_.directVectors && candidate.distance == 0.0f && isOwn(records[candidate.number].point, point))
        asker.isSettled = true;
    }
    asker.radius = answerer_.dlvRadius();
    serve(asker, pixelsWithin(point, asker.radius) * std::min(1.0, (told.valid + 1.0) / (within + 1.0)));
    asker.valid = still_.directVectors ? told.valid : 0;
    asker.refused = told.verdict == DirectVerdict::Accepted ? 0.0
                    : told.verdict == DirectVerdict::TooFew ? kUnknownRefusal
                                                            : 1.0;
    return asker;
  }

  /// Where too few vectors are known to say whether they are alike, they are as often as elsewhere.
  static void guessRefusals(std::vector<AskedPass>& passes) {
    double refused = 0.0;
    double told = 0.0;
    for (const AskedPass& pass : passes) {
      for (const Asker& asker : pass.askers) {
        if (asker.refused == kUnknownRefusal) continue;
        refused += asker.pixels * asker.refused;
        told += asker.pixels;
      }
    }
    for (AskedPass& pass : passes) {
      for (Asker& asker : pass.askers) {
        if (asker.refused == kUnknownRefusal) asker.refused = told > 0.0 ? refused / told : 0.0;
      }
    }
  }

  static constexpr double kUnknownRefusal = -1.0;

  const RenderFrame& frame_;
  const Scene& scene_;
  const Parameters& candidate_;
  const StillTrue& still_;
  IlvRules rules_;
  Answerer answerer_;
  const RecordSet<IndirectLightVector>* known_;     ///< of the frame
  const RecordSet<IndirectLightVector>* reaching_;  ///< the same, as far as the candidate lets them reach
  RecordSet<IndirectLightVector> rebuilt_;
  std::vector<IlvCandidate> candidates_;  ///< the frame's ILVs as the candidate's rules see them
  std::vector<ChosenPixels> chosen_;
  std::vector<std::uint32_t> found_;
  std::vector<std::pair<std::uint32_t, float>> doubtful_;  ///< vectors that a ray must tell of, and how far
};

bool usesVectors(const Parameters& parameters) { return parameters.picture.method == Method::Vectors; }
bool isPrinted(const Parameters& parameters) {
  return usesVectors(parameters) && parameters.vectors.rules == Rules::Printed;
}

std::size_t rounded(double count) { return static_cast<std::size_t>(std::llround(count)); }

/// Where all of a kind is computed anew and the frame began from nothing, it is known how many the frame's
/// own parameters take: what the estimate says too much or too little of these, it says of the candidate's,
/// too.
void scaleToWhatIsKnown(const RenderFrame& frame, ChangeEstimate& estimate) {
  const bool anyAnew = estimate.staleIndirect > 0 || estimate.staleDirect > 0;
  if (!anyAnew || !frame.complete || frame.warm || frame.locked) return;
  StillTrue nothing;
  nothing.indirectVectors = estimate.staleIndirect == 0;
  nothing.directVectors = estimate.staleDirect == 0;
  Estimation own(frame, frame.parameters, nothing);
  const auto scale = [](std::size_t& count, std::size_t known, double estimated) {
    if (known > 0 && estimated >= 1.0)
      count = rounded(static_cast<double>(count) * static_cast<double>(known) / estimated);
  };
  scale(estimate.newIndirect, estimate.staleIndirect, own.newIndirect());
  scale(estimate.newDirect, estimate.staleDirect, own.newDirect());
}

}  // namespace

std::optional<ChangeEstimate> estimateChange(const RenderFrame& frame, const Parameters& candidate,
                                             const LightMix& lights) {
  if (!frame.points || !frame.snapshot || frame.reduction != 1 || isPrinted(candidate)) return std::nullopt;
  ChangeEstimate estimate;
  const StillTrue still = stillTrue(*frame.scene, frame.parameters, frame.lights, candidate, lights);
  if (!still.indirectVectors) estimate.staleIndirect = frame.snapshot->indirect.size();
  if (!still.directVectors) estimate.staleDirect = frame.snapshot->directCount();
  const bool isSame = candidate == frame.parameters && lights == frame.lights;
  if (!usesVectors(candidate) || (isSame && frame.complete)) return estimate;
  const FlushDenormals flush;
  Estimation estimation(frame, candidate, still);
  estimate.newIndirect = rounded(estimation.newIndirect());
  estimate.newDirect = rounded(estimation.newDirect());
  scaleToWhatIsKnown(frame, estimate);
  return estimate;
}

std::optional<ChangeEstimate> ChangeEstimator::estimate(const Parameters& candidate, const LightMix& lights) {
  for (const Answer& answer : answers_) {
    if (answer.candidate == candidate && answer.lights == lights) return answer.estimate;
  }
  if (answers_.size() == kRememberedAnswers) answers_.erase(answers_.begin());
  answers_.push_back({candidate, lights, estimateChange(*frame_, candidate, lights)});
  return answers_.back().estimate;
}

}  // namespace lightvane
