#include "tests/support/polygon_scene.h"

#include <algorithm>
#include <span>

#include "core/base/check.h"

namespace lightvane {
namespace {

// A convex polygon during clipping. Each cut adds a vertex at most; the emitter has 3 or 4, and the cuts that
// meet at one fragment are far fewer than the capacity (checked in add).
struct Fragment {
  static constexpr std::size_t kCapacity = 40;
  std::array<Vec3d, kCapacity> vertices;
  std::size_t count = 0;

  Fragment() = default;  // leaves the vertices unset: this is the innermost loop of the solver
  explicit Fragment(std::span<const Vec3d> from) {
    for (const Vec3d& v : from) add(v);
  }
  void add(const Vec3d& v) {
    LV_CHECK(count < kCapacity, "a polygon was cut into more than {} corners", kCapacity);
    vertices[count++] = v;
  }
  std::span<const Vec3d> span() const { return {vertices.data(), count}; }
};

// The part of a convex polygon on the positive side of the plane {x : normal · (x - origin) = offset}.
Fragment clip(std::span<const Vec3d> polygon, const Vec3d& origin, const Vec3d& normal, double offset = 0.0) {
  Fragment kept;
  const std::size_t count = polygon.size();
  if (count == 0) return kept;
  double before = glm::dot(normal, polygon[count - 1] - origin) - offset;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3d& a = polygon[(i + count - 1) % count];
    const Vec3d& b = polygon[i];
    const double here = glm::dot(normal, b - origin) - offset;
    if ((before > 0.0) != (here > 0.0)) kept.add(a + (b - a) * (before / (before - here)));
    if (here > 0.0) kept.add(b);
    before = here;
  }
  if (kept.count < 3) kept.count = 0;
  return kept;
}

// Lambert's formula for a convex polygon wholly above the horizon and wholly visible. Its sign is that of the
// polygon's orientation, which clipping keeps.
double lambertFormFactor(const Vec3d& point, const Vec3d& normal, std::span<const Vec3d> polygon) {
  double sum = 0.0;
  Vec3d a = polygon.back() - point;
  for (const Vec3d& vertex : polygon) {
    const Vec3d b = vertex - point;
    const Vec3d across = glm::cross(a, b);
    const double length = glm::length(across);
    // atan2 keeps full precision for small and for flat angles, where acos of the cosine does not.
    if (length > 0.0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(normal, across) / length;
    a = b;
  }
  return std::abs(sum) / (2.0 * kPiD);
}

// What is hidden by one occluder from a point: a cone with that point as its apex, cut out by planes through
// it.
struct ShadowPyramid {
  std::array<Vec3d, Fragment::kCapacity> inward;
  std::size_t count = 0;

  bool misses(const Vec3d& apex, std::span<const Vec3d> polygon) const {
    for (std::size_t i = 0; i < count; ++i) {
      const bool outside = std::all_of(polygon.begin(), polygon.end(),
                                       [&](const Vec3d& v) { return glm::dot(inward[i], v - apex) <= 0.0; });
      if (outside) return true;
    }
    return false;
  }
};

// Form factor of what the pyramids leave of a fragment. Cuts off what is outside each plane of the first
// pyramid in turn; what is inside all of them is hidden.
double visibleRemainder(const Vec3d& point, const Vec3d& normal, const Fragment& fragment,
                        std::span<const ShadowPyramid> pyramids) {
  if (fragment.count == 0) return 0.0;
  while (!pyramids.empty() && pyramids.front().misses(point, fragment.span())) pyramids = pyramids.subspan(1);
  if (pyramids.empty()) return lambertFormFactor(point, normal, fragment.span());
  const ShadowPyramid& pyramid = pyramids.front();
  double sum = 0.0;
  Fragment rest = fragment;
  for (std::size_t i = 0; i < pyramid.count && rest.count > 0; ++i) {
    sum += visibleRemainder(point, normal, clip(rest.span(), point, -pyramid.inward[i]), pyramids.subspan(1));
    rest = clip(rest.span(), point, pyramid.inward[i]);
  }
  return sum;
}

}  // namespace

PolygonScene::PolygonScene(std::vector<DiffusePolygon> polygons) : polygons_(std::move(polygons)) {
  BoundsD bounds;
  for (const DiffusePolygon& polygon : polygons_) {
    for (const Vec3d& v : polygon.vertices) bounds.add(v);
  }
  diagonal_ = bounds.diagonal();
  for (const DiffusePolygon& polygon : polygons_) {
    const std::vector<Vec3d>& v = polygon.vertices;
    LV_CHECK(v.size() >= 3 && v.size() <= 16, "polygon '{}' has {} vertices", polygon.name, v.size());
    for (int c = 0; c < 3; ++c) {
      LV_CHECK(polygon.reflectance[c] >= 0.0 && polygon.reflectance[c] <= 1.0 && polygon.emission[c] >= 0.0 &&
                   std::isfinite(polygon.emission[c]),
               "polygon '{}' reflects {} and emits {}", polygon.name, polygon.reflectance[c],
               polygon.emission[c]);
    }
    Vec3d areaVector(0.0);
    for (std::size_t i = 1; i + 1 < v.size(); ++i)
      areaVector += glm::cross(v[i] - v[0], v[i + 1] - v[0]) * 0.5;
    Shape shape;
    shape.area = glm::length(areaVector);
    LV_CHECK(shape.area > square(epsilon()), "polygon '{}' has area {}", polygon.name, shape.area);
    shape.normal = areaVector / shape.area;
    shape.offset = glm::dot(shape.normal, v[0]);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3d inward = glm::normalize(glm::cross(shape.normal, v[(i + 1) % v.size()] - v[i]));
      shape.inward.push_back(inward);
      shape.inwardOffset.push_back(glm::dot(inward, v[i]));
      LV_CHECK(std::abs(glm::dot(shape.normal, v[i]) - shape.offset) <= epsilon(),
               "polygon '{}' is not planar", polygon.name);
      for (const Vec3d& other : v) {
        LV_CHECK(glm::dot(inward, other - v[i]) >= -epsilon(), "polygon '{}' is not convex", polygon.name);
      }
    }
    shapes_.push_back(shape);
  }
  for (std::size_t emitter = 0; emitter < polygons_.size(); ++emitter) {
    if (polygons_[emitter].emission != Vec3d(0.0)) emitters_.push_back(emitter);
    for (std::size_t occluder = 0; occluder < polygons_.size(); ++occluder) {
      relations_.push_back(relate(emitter, occluder));
    }
  }
}

PolygonScene::Relation PolygonScene::relate(std::size_t emitter, std::size_t occluder) const {
  Relation relation{kInfinity, -kInfinity, kInfinity, -kInfinity};
  for (const Vec3d& v : polygons_[emitter].vertices) {
    relation.emitterLow = std::min(relation.emitterLow, height(occluder, v));
    relation.emitterHigh = std::max(relation.emitterHigh, height(occluder, v));
  }
  for (const Vec3d& v : polygons_[occluder].vertices) {
    relation.occluderLow = std::min(relation.occluderLow, height(emitter, v));
    relation.occluderHigh = std::max(relation.occluderHigh, height(emitter, v));
  }
  return relation;
}

std::size_t PolygonScene::indexOf(const std::string& name) const {
  const auto found = std::find_if(polygons_.begin(), polygons_.end(),
                                  [&](const DiffusePolygon& polygon) { return polygon.name == name; });
  LV_CHECK(found != polygons_.end(), "no polygon is called '{}'", name);
  return static_cast<std::size_t>(found - polygons_.begin());
}

Vec3d PolygonScene::centroid(std::size_t polygon) const {
  const std::vector<Vec3d>& v = polygons_[polygon].vertices;
  Vec3d sum(0.0);
  for (std::size_t i = 1; i + 1 < v.size(); ++i) {
    const double area = 0.5 * glm::dot(shapes_[polygon].normal, glm::cross(v[i] - v[0], v[i + 1] - v[0]));
    sum += (v[0] + v[i] + v[i + 1]) * (area / 3.0);
  }
  return sum / shapes_[polygon].area;
}

double PolygonScene::height(std::size_t polygon, const Vec3d& point) const {
  return glm::dot(shapes_[polygon].normal, point) - shapes_[polygon].offset;
}

bool PolygonScene::contains(std::size_t polygon, const Vec3d& point, double tolerance) const {
  const Shape& shape = shapes_[polygon];
  if (std::abs(height(polygon, point)) > tolerance) return false;
  for (std::size_t i = 0; i < shape.inward.size(); ++i) {
    if (glm::dot(shape.inward[i], point) < shape.inwardOffset[i] - tolerance) return false;
  }
  return true;
}

std::optional<PolygonScene::Hit> PolygonScene::nearestHit(const Vec3d& origin, const Vec3d& direction) const {
  const double tolerance = epsilon();
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<Hit> hit;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const Shape& shape = shapes_[i];
    const double cosine = glm::dot(shape.normal, direction);
    const double distance = (shape.offset - glm::dot(shape.normal, origin)) / cosine;
    if (!(distance > tolerance && distance < nearest)) continue;
    // The rim belongs to the polygon, and a hair beyond it: no ray slips between polygons that share an edge.
    const Vec3d point = origin + distance * direction;
    bool inside = true;
    for (std::size_t k = 0; k < shape.inward.size() && inside; ++k) {
      inside = glm::dot(shape.inward[k], point) >= shape.inwardOffset[k] - tolerance;
    }
    if (!inside) continue;
    nearest = distance;
    hit = Hit{i, cosine < 0.0, point};
  }
  return hit;
}

double PolygonScene::visibleFormFactor(const Vec3d& point, const Vec3d& normal, std::size_t polygon) const {
  const double tolerance = epsilon();
  if (height(polygon, point) <= tolerance) return 0.0;
  const Fragment whole = clip(polygons_[polygon].vertices, point, normal);
  if (whole.count == 0) return 0.0;
  std::vector<ShadowPyramid> pyramids;
  for (std::size_t occluder = 0; occluder < polygons_.size(); ++occluder) {
    if (occluder == polygon) continue;
    const Relation& relation = relations_[polygon * polygons_.size() + occluder];
    const double side = height(occluder, point);
    // Seen edge-on, or the point's own polygon; point and emitter on the same side; or behind the emitter.
    if (std::abs(side) <= tolerance) continue;
    if (side > 0.0 ? relation.emitterLow >= -tolerance : relation.emitterHigh <= tolerance) continue;
    if (relation.occluderHigh <= tolerance) continue;
    Fragment rim(polygons_[occluder].vertices);
    if (relation.occluderLow < tolerance) {
      rim = clip(rim.span(), polygons_[polygon].vertices[0], shapes_[polygon].normal, tolerance);
    }
    ShadowPyramid pyramid;
    for (std::size_t i = 0; i < rim.count; ++i) {
      const Vec3d plane = glm::cross(rim.vertices[i] - point, rim.vertices[(i + 1) % rim.count] - point);
      pyramid.inward[pyramid.count++] = side > 0.0 ? -plane : plane;
    }
    if (pyramid.count > 0 && !pyramid.misses(point, whole.span())) pyramids.push_back(pyramid);
  }
  return visibleRemainder(point, normal, whole, pyramids);
}

Vec3d PolygonScene::directIrradiance(const Vec3d& point, const Vec3d& normal) const {
  Vec3d sum(0.0);
  for (const std::size_t emitter : emitters_) {
    sum += polygons_[emitter].emission * (kPiD * visibleFormFactor(point, normal, emitter));
  }
  return sum;
}

}  // namespace lightvane
