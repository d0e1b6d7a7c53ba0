#include "core/scene/lights.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/check.h"
#include "core/base/overloaded.h"
#include "core/scene/emission_pattern.h"

namespace lightvane {
namespace {

constexpr float kMaxFloat = std::numeric_limits<float>::max();
// The smallest solid angle whose reciprocal a float holds; what is smaller cannot be told from nothing.
constexpr double kMinSolidAngle = std::numeric_limits<float>::min();

// Differences of floats are exact in double (or nearly, across scales).
Vec3d relative(const Vec3& position, const Vec3& point) { return Vec3d(position) - Vec3d(point); }

/// Direction, distance and inverse-square weight of light of `intensity` at `position`; false at the position
/// itself.
bool samplePoint(const Vec3& position, const Rgb& intensity, const Vec3& point, LightSample& sample) {
  const Vec3d toLight = relative(position, point);
  const double distanceSquared = glm::dot(toLight, toLight);
  if (!(distanceSquared > 0.0)) return false;
  const double distance = std::sqrt(distanceSquared);
  sample.direction = Vec3(toLight / distance);
  sample.distance = static_cast<float>(distance);
  // Nearer than 1e-19 the weight would overflow.
  sample.weight = Rgb(glm::min(Vec3d(intensity) / distanceSquared, Vec3d(kMaxFloat)));
  sample.pdf = 0.0f;
  return true;
}

float spotFalloff(const SpotLight& spot, const Vec3& toLight) {
  const float cosine = -glm::dot(toLight, spot.direction);
  if (cosine <= spot.cosOuter) return 0.0f;
  if (cosine >= spot.cosInner) return 1.0f;
  const float t = (cosine - spot.cosOuter) / (spot.cosInner - spot.cosOuter);
  return t * t * (3.0f - 2.0f * t);
}

// Radiance within the cone over the irradiance on a facing surface, sr^-1: 1 / (pi sin^2), of which a facing
// surface sees at most its hemisphere.
double radianceOverIrradiance(const DirectionalLight& sun) {
  const double c = sun.cosHalfAngle;
  return 1.0 / (kPiD * (c > 0.0 ? (1.0 - c) * (1.0 + c) : 1.0));
}
double coneSolidAngle(const DirectionalLight& sun) { return 2.0 * kPiD * (1.0 - sun.cosHalfAngle); }

// Not inlined: GCC 12's SLP vectoriser takes a vector rounded to float and converted back for the unrounded
// one, so that a sample's density and pdf()'s would be those of two directions.
[[gnu::noinline]] double discDensity(const SphericalDisc& disc, const Vec3& direction) {
  return disc.pdf(Vec3d(direction));
}

bool insideCone(const DirectionalLight& sun, const Vec3& direction) {
  if (sun.cosHalfAngle >= 1.0) return false;
  // By chords, since cosines near 1 say nothing about small angles. A direction in float is off by up to
  // 2^-23: with twice that, every direction that sampling can give is inside.
  const double chord = std::sqrt(2.0 * (1.0 - sun.cosHalfAngle)) + 0x1p-22;
  const Vec3d difference = relative(direction, sun.toLight);
  return glm::dot(difference, difference) <= chord * chord;
}

/// Multiplies the weight of a sample of `piece` by the light's pattern where it meets it; false where that is
/// black.
bool addPattern(const AreaLight& light, std::size_t piece, const Vec3& point, const Vec3& direction,
                float distance, Rgb& weight) {
  // From what was rounded to float, so that batches and single samples see the same.
  const Vec3d place = Vec3d(point) + static_cast<double>(distance) * Vec3d(direction);
  weight *= light.pattern->colorAt(light, piece, place);
  return !isBlack(weight);
}

}  // namespace

void AreaLight::finish() {
  LV_CHECK(polygon.empty() || (polygon.size() >= 3 && spheres.empty() && discs.empty()),
           "a polygon light with {} corners, {} spheres, {} discs", polygon.size(), spheres.size(),
           discs.size());
  areaCdf.clear();
  totalArea = 0.0;
  double totalWeight = 0.0;
  const auto addArea = [&](double area) {
    totalArea += area;
    totalWeight += pattern ? area * pattern->brightness(areaCdf.size()) : area;
    areaCdf.push_back(totalWeight);
  };
  Bounds bounds;
  for (const EmitterTriangle& t : triangles) {
    addArea(t.area);
    for (const Vec3& v : {t.a, t.b, t.c}) bounds.add(v);
  }
  for (const EmitterSphere& s : spheres) {
    addArea(4.0 * kPiD * square(double(s.radius)));
    bounds.add(s.center - Vec3(s.radius));
    bounds.add(s.center + Vec3(s.radius));
  }
  for (const EmitterDisc& d : discs) {
    addArea(kPiD * square(double(d.radius)));
    const Vec3 extent = d.radius * glm::sqrt(glm::max(Vec3(0.0f), Vec3(1.0f) - d.normal * d.normal));
    bounds.add(d.center - extent);
    bounds.add(d.center + extent);
  }
  for (const Vec3& v : polygon) bounds.add(v);
  if (totalWeight > 0.0) {
    for (double& value : areaCdf) value /= totalWeight;
  } else {
    areaCdf.clear();
  }

  if (bounds.empty()) return;
  boundCenter = bounds.centre();
  double radius = 0.0;
  const auto reach = [&](const Vec3& v, double extent) {
    radius = std::max(radius, glm::length(relative(v, boundCenter)) + extent);
  };
  for (const EmitterTriangle& t : triangles) {
    for (const Vec3& v : {t.a, t.b, t.c}) reach(v, 0.0);
  }
  for (const EmitterSphere& s : spheres) reach(s.center, s.radius);
  for (const EmitterDisc& d : discs) reach(d.center, d.radius);
  for (const Vec3& v : polygon) reach(v, 0.0);
  boundRadius = static_cast<float>(radius) * (1.0f + 0x1p-22f);  // never less for being rounded

  rectangle.reset();
  if (polygon.size() == 4) {
    const Vec3d x = relative(polygon[1], polygon[0]);
    const Vec3d y = relative(polygon[3], polygon[0]);
    const Vec3d gap = relative(polygon[2], polygon[1]) - y;
    // Coordinates in float put a small rectangle far from the origin this much out of shape.
    constexpr double kTolerance = 1e-5;
    const double lengths = glm::length(x) * glm::length(y);
    if (lengths > 0.0 && std::abs(glm::dot(x, y)) <= kTolerance * lengths &&
        glm::length(gap) <= kTolerance * std::min(glm::length(x), glm::length(y)))
      rectangle.emplace(x, y);
  }

  planar = false;
  if (!polygon.empty() && !triangles.empty()) {
    planar = true;
    // The largest triangle's, as those of slivers are rounding errors.
    planeNormal = std::max_element(triangles.begin(), triangles.end(), [](const auto& s, const auto& t) {
                    return s.area < t.area;
                  })->normal;
  } else if (pieceCount() == 1 && spheres.empty()) {
    planar = true;
    planeNormal = triangles.empty() ? discs[0].normal : triangles[0].normal;
  }
}

LightSampler::LightSampler(const Light& light, const Vec3& point, const Vec3& normal)
    : light_(light), area_(std::get_if<AreaLight>(&light)), point_(point), normal_(normal) {
  if (const auto* sun = std::get_if<DirectionalLight>(&light); sun && sun->cosHalfAngle < 1.0) {
    newMap(0) = SphericalCap::atInfinity(glm::normalize(Vec3d(sun->toLight)), 1.0 - sun->cosHalfAngle);
    total_ = coneSolidAngle(*sun);
  }
  if (std::holds_alternative<EnvironmentLight>(light)) total_ = (normal == Vec3(0.0f) ? 4.0 : 2.0) * kPiD;
  if (area_ == nullptr || area_->areaCdf.empty()) return;
  const std::size_t corners = area_->polygon.size();
  if (corners >= 3 && corners <= kMaxPieces + 2) {
    preparePolygon();
  } else if (area_->pieceCount() <= kMaxPieces) {
    for (std::size_t piece = 0; piece < area_->pieceCount(); ++piece)
      add(piece, preparePiece(piece, newMap(piece)));
  } else {
    byArea_ = true;
  }
}

void LightSampler::add(std::size_t slot, double pieceSolidAngle) {
  total_ += pieceSolidAngle;
  cumulative_[slot] = total_;
  slots_ = slot + 1;
}

void LightSampler::preparePolygon() {
  const std::vector<Vec3>& corners = area_->polygon;
  const Vec3d first = relative(corners[0], point_);
  const auto& sides = area_->rectangle;
  if (sides && !SphericalRectangle::isSmall(glm::dot(first, first), *sides)) {
    // In its place at once: it is large.
    const auto& map = std::get<SphericalRectangle>(
        *std::construct_at(maps_.data(), std::in_place_type<SphericalRectangle>, first, *sides));
    const bool emits = map.seenFromFront() || area_->twoSided;
    add(0, emits ? map.solidAngle() : 0.0);
    return;
  }
  // A fan about the first corner: from one triangle to the next u.x sweeps on along the outline.
  Vec3d previous = relative(corners[1], corners[0]);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const Vec3d next = relative(corners[i], corners[0]);
    const SphericalTriangle map(first, previous, next);
    const bool emits = map.seenFromFront() || area_->twoSided;
    Map& place = newMap(i - 2);
    if (emits) place = map;
    add(i - 2, emits ? map.solidAngle() : 0.0);
    previous = next;
  }
}

double LightSampler::preparePiece(std::size_t piece, Map& map) const {
  const bool anySide = area_->twoSided;
  if (piece < area_->triangles.size()) {
    const EmitterTriangle& t = area_->triangles[piece];
    const SphericalTriangle triangle(relative(t.a, point_), relative(t.b, t.a), relative(t.c, t.a));
    if (!anySide && !triangle.seenFromFront()) return 0.0;
    map = triangle;
    return triangle.solidAngle();
  }
  piece -= area_->triangles.size();
  if (piece < area_->spheres.size()) {
    const EmitterSphere& s = area_->spheres[piece];
    const SphericalCap cap(relative(s.center, point_), s.radius);
    if (!anySide && !cap.seenFromFront()) return 0.0;
    map = cap;
    return cap.solidAngle();
  }
  piece -= area_->spheres.size();
  const EmitterDisc& d = area_->discs[piece];
  const SphericalDisc disc(relative(d.center, point_), glm::normalize(Vec3d(d.normal)), d.radius);
  if (!disc.visible() || (!anySide && !disc.seenFromFront())) return 0.0;
  map = disc;
  return disc.solidAngle();
}

bool LightSampler::sample(const Vec2& u, LightSample& sample) const {
  return std::visit(
      Overloaded{
          [&](const PointLight& l) { return samplePoint(l.position, l.intensity, point_, sample); },
          [&](const SpotLight& l) {
            if (!samplePoint(l.position, l.intensity, point_, sample)) return false;
            const float falloff = spotFalloff(l, sample.direction);
            sample.weight *= falloff;
            return falloff > 0.0f;
          },
          [&](const DirectionalLight& l) {
            sample = {l.toLight, kInfinity, l.irradiance, 0.0f};
            if (l.cosHalfAngle >= 1.0) return true;
            sample.direction = Vec3(std::get<SphericalCap>(maps_[0]).sample(Vec2d(u)).direction);
            sample.weight = l.irradiance * static_cast<float>(radianceOverIrradiance(l) * total_);
            sample.pdf = static_cast<float>(1.0 / total_);
            return true;
          },
          [&](const VolumicSphereLight& l) {
            if (l.points.empty()) return false;
            const auto count = static_cast<float>(l.points.size());
            const std::size_t index = std::min(static_cast<std::size_t>(u.x * count), l.points.size() - 1);
            return samplePoint(l.points[index], l.intensity * count, point_, sample);
          },
          [&](const AreaLight&) { return sampleArea(u, sample); },
          [&](const EnvironmentLight& l) {
            sample.direction = l.sample(u, normal_);
            sample.distance = kInfinity;
            // At the rounded direction, so that lightPdfAtInfinity() says the same.
            sample.pdf = l.pdf(sample.direction, normal_);
            if (!(sample.pdf > 0.0f)) return false;
            sample.weight = l.radianceFrom(sample.direction) / sample.pdf;
            return true;
          },
      },
      light_);
}

void LightSampler::sample(int count, LightSampleBatch& batch) const {
  SphericalSampleBatch& places = batch.places;
  std::fill(std::fill_n(batch.reached, count, true), std::end(batch.reached), false);
  const bool isOneMap = area_ != nullptr && slots_ == 1 && total_ >= kMinSolidAngle;
  const auto* rectangle = isOneMap ? std::get_if<SphericalRectangle>(maps_.data()) : nullptr;
  if (rectangle != nullptr) {
    rectangle->sample(places);
    const auto pdf = static_cast<float>(1.0 / total_);
    std::fill_n(batch.weight, count, area_->radiance / pdf);
    std::fill_n(batch.pdf, count, pdf);
    if (!area_->pattern) return;
    for (int i = 0; i < count; ++i) {
      const Vec3 direction(places.directionX[i], places.directionY[i], places.directionZ[i]);
      batch.reached[i] = addPattern(*area_, 0, point_, direction, places.distance[i], batch.weight[i]);
    }
    return;
  }
  for (int i = 0; i < count; ++i) {
    LightSample one;
    batch.reached[i] = sample({places.u[i], places.v[i]}, one);
    batch.set(i, one);
  }
}

bool LightSampler::sampleArea(const Vec2& u, LightSample& sample) const {
  Vec2d v(u);
  Map chosenByArea;
  const Map* map = nullptr;
  double density =
      0.0;  // of a map that is uniform in solid angle; of the choice of the piece for one that is not
  double choice = 1.0;
  std::size_t piece = 0;
  if (byArea_) {
    const std::vector<double>& cdf = area_->areaCdf;
    const auto found = std::upper_bound(cdf.begin(), cdf.end(), v.x);
    piece = std::min(static_cast<std::size_t>(found - cdf.begin()), cdf.size() - 1);
    const double below = piece > 0 ? cdf[piece - 1] : 0.0;
    choice = cdf[piece] - below;
    if (!(choice > 0.0)) return false;
    v.x = std::min((v.x - below) / choice, 1.0);
    const double pieceSolidAngle = preparePiece(piece, chosenByArea);
    if (!(pieceSolidAngle >= kMinSolidAngle)) return false;
    map = &chosenByArea;
    density = choice / pieceSolidAngle;
  } else {
    if (!(total_ >= kMinSolidAngle)) return false;
    const double target = v.x * total_;
    std::size_t slot = 0;
    while (slot + 1 < slots_ && !(target < cumulative_[slot])) ++slot;
    const double below = slot > 0 ? cumulative_[slot - 1] : 0.0;
    const double pieceSolidAngle = cumulative_[slot] - below;
    if (!(pieceSolidAngle > 0.0)) return false;
    if (slots_ > 1) v.x = std::min((target - below) / pieceSolidAngle, 1.0);
    choice = pieceSolidAngle / total_;
    piece = slot;
    map = &maps_[slot];
    density = 1.0 / total_;
  }

  SphericalSample found{};
  if (const auto* rectangle = std::get_if<SphericalRectangle>(map)) found = rectangle->sample(v);
  if (const auto* triangle = std::get_if<SphericalTriangle>(map)) found = triangle->sample(v);
  if (const auto* cap = std::get_if<SphericalCap>(map)) found = cap->sample(v);
  if (const auto* disc = std::get_if<SphericalDisc>(map)) found = disc->sample(v);
  sample.direction = Vec3(found.direction);
  sample.distance = static_cast<float>(found.distance);
  if (const auto* disc = std::get_if<SphericalDisc>(map)) {
    // At the rounded direction, so that pdf() says the same.
    density = choice * discDensity(*disc, sample.direction);
  }
  sample.pdf = static_cast<float>(density);
  sample.weight = area_->radiance / sample.pdf;
  return !area_->pattern ||
         addPattern(*area_, piece, point_, sample.direction, sample.distance, sample.weight);
}

float LightSampler::pdf(const Vec3& direction, std::uint32_t piece) const {
  if (area_ == nullptr || area_->areaCdf.empty() || piece == kNone) return 0.0f;
  Map prepared;
  const Map* map = nullptr;
  double density = 0.0;
  double choice = 1.0;
  if (byArea_) {
    LV_CHECK(piece < area_->areaCdf.size(), "piece {} of {}", piece, area_->areaCdf.size());
    choice = area_->areaCdf[piece] - (piece > 0 ? area_->areaCdf[piece - 1] : 0.0);
    const double pieceSolidAngle = preparePiece(piece, prepared);
    if (!(choice > 0.0) || !(pieceSolidAngle >= kMinSolidAngle)) return 0.0f;
    map = &prepared;
    density = choice / pieceSolidAngle;
  } else {
    if (!(total_ >= kMinSolidAngle)) return 0.0f;
    density = 1.0 / total_;
    // One map for all of a polygon: a hit on any of its triangles has its density.
    if (!area_->polygon.empty()) return static_cast<float>(density);
    LV_CHECK(piece < slots_, "piece {} of {}", piece, slots_);
    const double pieceSolidAngle = cumulative_[piece] - (piece > 0 ? cumulative_[piece - 1] : 0.0);
    if (!(pieceSolidAngle > 0.0)) return 0.0f;
    map = &maps_[piece];
    choice = pieceSolidAngle / total_;
  }
  if (const auto* disc = std::get_if<SphericalDisc>(map)) density = choice * discDensity(*disc, direction);
  return static_cast<float>(density);
}

float LightSampler::solidAngle() const {
  double sum = total_;
  if (byArea_) {
    Map map;
    for (std::size_t piece = 0; piece < area_->pieceCount(); ++piece) sum += preparePiece(piece, map);
  }
  return static_cast<float>(sum);
}

float LightSampler::apparentSize() const {
  if (!byArea_) return static_cast<float>(total_);
  const SphericalCap ball(relative(area_->boundCenter, point_), area_->boundRadius);
  // Within the ball it may be all around.
  return static_cast<float>(ball.seenFromFront() ? ball.solidAngle() : 4.0 * kPiD);
}

bool sampleLight(const Light& light, const Vec3& point, const Vec2& u, LightSample& sample) {
  return LightSampler(light, point).sample(u, sample);
}

void sampleFromEach(const Light& light, int count, const SphericalPointBatch& points,
                    std::span<const Vec3> normals, LightSampleBatch& batch) {
  SphericalSampleBatch& places = batch.places;
  const auto* area = std::get_if<AreaLight>(&light);
  const bool isRectangle = area != nullptr && area->rectangle && !area->areaCdf.empty();
  RectangleAngleBatch angles;
  if (isRectangle) {
    SphericalRectangle::sampleFromEach(points, Vec3d(area->polygon.front()), *area->rectangle, places,
                                       angles);
  }
  std::fill_n(batch.reached, LightSampleBatch::kCount, false);
  for (int i = 0; i < count; ++i) {
    const Vec3 point(points.x[i], points.y[i], points.z[i]);
    if (isRectangle && !SphericalRectangle::isSmall(angles.distanceSquared[i], *area->rectangle)) {
      const bool emits = angles.height[i] < 0.0 || area->twoSided;
      if (!emits || !(angles.solidAngle[i] >= kMinSolidAngle)) continue;
      batch.pdf[i] = static_cast<float>(1.0 / angles.solidAngle[i]);
      batch.weight[i] = area->radiance / batch.pdf[i];
      const Vec3 direction(places.directionX[i], places.directionY[i], places.directionZ[i]);
      batch.reached[i] =
          !area->pattern || addPattern(*area, 0, point, direction, places.distance[i], batch.weight[i]);
      continue;
    }
    LightSample one;
    const LightSampler sampler(light, point, normals[static_cast<std::size_t>(i)]);
    batch.reached[i] = sampler.sample({places.u[i], places.v[i]}, one);
    batch.set(i, one);
  }
}

float lightPdf(const Light& light, const Vec3& point, const Vec3& direction, std::uint32_t piece, float,
               float) {
  return LightSampler(light, point).pdf(direction, piece);
}

float lightPdfAtInfinity(const Light& light, const Vec3& direction, const Vec3& normal) {
  if (const auto* sky = std::get_if<EnvironmentLight>(&light)) return sky->pdf(direction, normal);
  const auto* sun = std::get_if<DirectionalLight>(&light);
  return sun && insideCone(*sun, direction) ? static_cast<float>(1.0 / coneSolidAngle(*sun)) : 0.0f;
}

Rgb radianceFromInfinity(const Light& light, const Vec3& direction) {
  if (const auto* sky = std::get_if<EnvironmentLight>(&light)) return sky->radianceFrom(direction);
  const auto* sun = std::get_if<DirectionalLight>(&light);
  return sun && insideCone(*sun, direction)
             ? sun->irradiance * static_cast<float>(radianceOverIrradiance(*sun))
             : Rgb(0.0f);
}

bool isDirac(const Light& light) {
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) return sun->cosHalfAngle >= 1.0;
  return !std::holds_alternative<AreaLight>(light) && !std::holds_alternative<EnvironmentLight>(light);
}

namespace {

double areaIrradianceBound(const AreaLight& light, const Vec3& point) {
  if (light.areaCdf.empty()) return 0.0;
  const Vec3d toCenter = relative(light.boundCenter, point);
  const double distance = glm::length(toCenter);
  const double radius = light.boundRadius;
  const double radiance = maxComponent(light.radiance);
  // No set of directions within a cone gives more than the whole cone seen face to face, and no set of
  // directions at all more than a hemisphere.
  double bound = distance > radius ? kPiD * square(radius / distance) : kPiD;

  // A thin light fills little of its bounding sphere: its solid angle is at most area * cos / nearest
  // distance^2.
  const double nearest = distance - radius;
  double cosine = 1.0;
  if (light.planar) {
    // Corners in float leave the plane a little, and slivers lean away from it: a thousandth covers both.
    const double slack = 1e-3 * (distance + radius);
    const double height = -glm::dot(toCenter, Vec3d(light.planeNormal));
    if (!light.twoSided && height < -slack) return 0.0;
    if (nearest > 0.0) cosine = std::min(1.0, (std::abs(height) + slack) / nearest);
  }
  if (nearest > 0.0) bound = std::min(bound, light.totalArea * cosine / (nearest * nearest));
  return radiance * bound;
}

}  // namespace

float irradianceBound(const Light& light, const Vec3& point) {
  const double bound = std::visit(
      Overloaded{
          [&](const PointLight& l) {
            LightSample sample;
            return samplePoint(l.position, l.intensity, point, sample) ? double(maxComponent(sample.weight))
                                                                       : 0.0;
          },
          [&](const SpotLight& l) {
            LightSample sample;
            if (!samplePoint(l.position, l.intensity, point, sample)) return 0.0;
            return double(maxComponent(sample.weight)) * spotFalloff(l, sample.direction);
          },
          [&](const DirectionalLight& l) { return double(maxComponent(l.irradiance)); },
          [&](const VolumicSphereLight& l) {
            double sum = 0.0;
            LightSample sample;
            for (const Vec3& position : l.points) {
              if (samplePoint(position, l.intensity, point, sample)) sum += maxComponent(sample.weight);
            }
            return sum;
          },
          [&](const AreaLight& l) { return areaIrradianceBound(l, point); },
          [](const EnvironmentLight& l) { return double(maxComponent(l.irradianceBound())); },
      },
      light);
  // What is compared with the bound is summed in float.
  return static_cast<float>(std::min(bound * (1.0 + 1e-5), double(kMaxFloat)));
}

namespace {

float greatestCosine(const Light& light, const Vec3& point, const Vec3& normal) {
  const auto ofPlace = [&](const Vec3& place) {
    const Vec3 to = place - point;
    const float distance = glm::length(to);
    return distance > 0.0f ? glm::dot(to, normal) / distance : 1.0f;
  };
  return std::visit(Overloaded{
                        [&](const PointLight& l) { return ofPlace(l.position); },
                        [&](const SpotLight& l) { return ofPlace(l.position); },
                        [&](const DirectionalLight& l) {
                          const auto cosine = static_cast<float>(l.cosHalfAngle);
                          return greatestCosineInCone(glm::dot(l.toLight, normal),
                                                      std::sqrt(std::max(0.0f, 1.0f - square(cosine))),
                                                      cosine);
                        },
                        [&](const VolumicSphereLight& l) {
                          float greatest = -1.0f;
                          for (const Vec3& place : l.points) greatest = std::max(greatest, ofPlace(place));
                          return greatest;
                        },
                        [&](const AreaLight& l) {
                          const float distance = glm::length(l.boundCenter - point);
                          if (!(distance > l.boundRadius)) return 1.0f;
                          const float sine = l.boundRadius / distance;
                          return greatestCosineInCone(ofPlace(l.boundCenter), sine,
                                                      std::sqrt(std::max(0.0f, 1.0f - square(sine))));
                        },
                        [](const EnvironmentLight&) { return 1.0f; },
                    },
                    light);
}

}  // namespace

float lightImportance(const Light& light, const Vec3& point, const Vec3& normal) {
  // What is just below the horizon may be above it but for rounding.
  constexpr float kRounding = 1e-3f;
  const float cosine = greatestCosine(light, point, normal);
  return cosine < -kRounding ? 0.0f : std::max(cosine, kRounding) * irradianceBound(light, point);
}

float lightPower(const Light& light, float sceneRadius) {
  return std::visit(
      Overloaded{
          [](const PointLight& l) { return 4.0f * kPi * luminance(l.intensity); },
          [](const SpotLight& l) {
            // Between the two cosines the smoothstep is one half on average.
            return kTwoPi * (1.0f - 0.5f * (l.cosInner + l.cosOuter)) * luminance(l.intensity);
          },
          [&](const DirectionalLight& l) { return luminance(l.irradiance) * kPi * square(sceneRadius); },
          [](const VolumicSphereLight& l) {
            return 4.0f * kPi * static_cast<float>(l.points.size()) * luminance(l.intensity);
          },
          [](const AreaLight& l) {
            const Rgb radiance = l.pattern ? l.radiance * l.pattern->meanColor(l) : l.radiance;
            return (l.twoSided ? kTwoPi : kPi) * static_cast<float>(l.totalArea) * luminance(radiance);
          },
          [&](const EnvironmentLight& l) { return luminance(l.total()) * kPi * square(sceneRadius); },
      },
      light);
}

int distinctSamples(const Light& light) {
  if (const auto* volume = std::get_if<VolumicSphereLight>(&light))
    return static_cast<int>(volume->points.size());
  return isDirac(light) ? 1 : 0;
}

}  // namespace lightvane
