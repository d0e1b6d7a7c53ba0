#include "tests/support/element_mesh.h"

#include <algorithm>
#include <numeric>

#include "core/base/check.h"

namespace lightvane {
namespace {

// Polygons closer than this fraction of the scene count as touching. It takes in the Cornell box's light,
// which hangs 0.5 mm under the ceiling and shadows it as if it lay on it.
constexpr double kContact = 1e-3;
// Cuts nearer than this fraction of the scene to a corner of the piece are left out: they would make slivers.
constexpr double kSliver = 1e-5;

std::array<glm::dvec2, ElementMesh::kNodes> nodesOnCircle(double turn) {
  std::array<glm::dvec2, ElementMesh::kNodes> nodes;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const double angle = turn + static_cast<double>(k) * 2.0 * kPiD / static_cast<double>(nodes.size());
    nodes[k] = {std::cos(angle), std::sin(angle)};
  }
  return nodes;
}

}  // namespace

struct ElementMesh::Segment {
  glm::dvec2 from, to;
};

// A convex region, counter-clockwise; crease[i] tells of the edge from vertex i to the next.
struct ElementMesh::Piece {
  std::vector<glm::dvec2> vertices;
  std::vector<bool> crease;

  std::size_t count() const { return vertices.size(); }
  const glm::dvec2& next(std::size_t i) const { return vertices[(i + 1) % count()]; }

  std::pair<double, double> extent(const glm::dvec2& along) const {
    double low = glm::dot(along, vertices[0]), high = low;
    for (const glm::dvec2& v : vertices) {
      low = std::min(low, glm::dot(along, v));
      high = std::max(high, glm::dot(along, v));
    }
    return {low, high};
  }

  // The part with normal · x >= offset; the new edge is a crease if it lies on the segment.
  Piece above(const glm::dvec2& normal, double offset, const Segment* contact) const {
    Piece kept;
    for (std::size_t i = 0; i < count(); ++i) {
      const glm::dvec2 &a = vertices[i], &b = next(i);
      const double heightA = glm::dot(normal, a) - offset, heightB = glm::dot(normal, b) - offset;
      if (heightA >= 0.0) {
        kept.vertices.push_back(a);
        kept.crease.push_back(crease[i]);
      }
      if ((heightA >= 0.0) == (heightB >= 0.0)) continue;
      kept.vertices.push_back(a + (b - a) * (heightA / (heightA - heightB)));
      kept.crease.push_back(heightA >= 0.0 ? false : crease[i]);
    }
    if (contact == nullptr) return kept;
    // The edge on the cut is the one whose ends are both on it.
    for (std::size_t i = 0; i < kept.count(); ++i) {
      const glm::dvec2 middle = 0.5 * (kept.vertices[i] + kept.next(i));
      const double off = std::abs(glm::dot(normal, kept.vertices[i]) - offset) +
                         std::abs(glm::dot(normal, kept.next(i)) - offset);
      const glm::dvec2 along = contact->to - contact->from;
      const double t = glm::dot(middle - contact->from, along) / glm::dot(along, along);
      if (off <= 1e-9 * glm::length(along) && t > 0.0 && t < 1.0) kept.crease[i] = true;
    }
    return kept;
  }
};

ElementMesh::ElementMesh(const PolygonScene& scene, std::size_t polygon, const Sizes& sizes)
    : tolerance_(kSliver * scene.diagonal()) {
  const DiffusePolygon& shape = scene.polygons()[polygon];
  origin_ = shape.vertices[0];
  axisU_ = glm::normalize(shape.vertices[1] - shape.vertices[0]);
  axisV_ = glm::cross(scene.normal(polygon), axisU_);

  const double contact = kContact * scene.diagonal();
  Piece whole;
  for (std::size_t i = 0; i < shape.vertices.size(); ++i) {
    const Vec3d& a = shape.vertices[i];
    const Vec3d& b = shape.vertices[(i + 1) % shape.vertices.size()];
    // A crease is an edge from which another polygon rises. Looked for at three places, off the regular
    // fractions where corners of other polygons tend to lie.
    bool crease = false;
    for (const double t : {0.23, 0.52, 0.81}) {
      for (std::size_t other = 0; other < scene.polygons().size() && !crease; ++other) {
        if (other == polygon || !scene.contains(other, a + (b - a) * t, contact)) continue;
        const std::vector<Vec3d>& rising = scene.polygons()[other].vertices;
        crease = std::any_of(rising.begin(), rising.end(), [&](const Vec3d& v) {
          const double height = scene.height(polygon, v);
          return height > contact || (shape.twoSided && height < -contact);
        });
      }
    }
    whole.vertices.push_back(toPlane(a));
    whole.crease.push_back(crease);
  }
  for (std::size_t other = 0; other < scene.polygons().size(); ++other) {
    const std::vector<Vec3d>& v = scene.polygons()[other].vertices;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3d &a = v[i], &b = v[(i + 1) % v.size()];
      const double highest = std::max(scene.height(polygon, a), scene.height(polygon, b));
      const double lowest = std::min(scene.height(polygon, a), scene.height(polygon, b));
      if (highest > contact || (shape.twoSided && lowest < -contact)) edgesInFront_.emplace_back(a, b);
    }
  }
  root_ = build(whole, contactsWith(scene, polygon), sizes);
}

glm::dvec2 ElementMesh::toPlane(const Vec3d& point) const {
  return {glm::dot(axisU_, point - origin_), glm::dot(axisV_, point - origin_)};
}

std::vector<ElementMesh::Segment> ElementMesh::contactsWith(const PolygonScene& scene,
                                                            std::size_t polygon) const {
  const double contact = kContact * scene.diagonal();
  std::vector<Segment> contacts;
  for (std::size_t other = 0; other < scene.polygons().size(); ++other) {
    if (other == polygon) continue;
    const std::vector<Vec3d>& v = scene.polygons()[other].vertices;
    std::vector<glm::dvec2> crossings;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec3d &a = v[i], &b = v[(i + 1) % v.size()];
      const double heightA = scene.height(polygon, a), heightB = scene.height(polygon, b);
      if (std::abs(heightA) <= contact && std::abs(heightB) <= contact) {
        contacts.push_back({toPlane(a), toPlane(b)});
      } else if (std::min(heightA, heightB) < -contact && std::max(heightA, heightB) > contact) {
        crossings.push_back(toPlane(a + (b - a) * (heightA / (heightA - heightB))));
      }
    }
    if (crossings.size() == 2) contacts.push_back({crossings[0], crossings[1]});
  }
  return contacts;
}

int ElementMesh::build(const Piece& piece, const std::vector<Segment>& contacts, const Sizes& sizes) {
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    // Cut only what the segment itself crosses, not its whole line: clip it to the piece first.
    const Segment& contact = contacts[k];
    const glm::dvec2 along = contact.to - contact.from;
    double enter = 0.0, leave = 1.0;
    for (std::size_t i = 0; i < piece.count(); ++i) {
      const glm::dvec2 edge = glm::normalize(piece.next(i) - piece.vertices[i]);
      const glm::dvec2 inward(-edge.y, edge.x);
      const double height = glm::dot(inward, contact.from - piece.vertices[i]);
      const double slope = glm::dot(inward, along);
      if (slope > 0.0) enter = std::max(enter, -height / slope);
      if (slope < 0.0) leave = std::min(leave, -height / slope);
      if (slope == 0.0 && height < 0.0) leave = -1.0;
    }
    const double length = glm::length(along);
    if ((leave - enter) * length <= tolerance_) continue;
    const glm::dvec2 normal = glm::dvec2(-along.y, along.x) / length;
    const double offset = glm::dot(normal, contact.from);
    const auto [low, high] = piece.extent(normal);
    if (offset - low <= tolerance_ || high - offset <= tolerance_) continue;
    const std::vector<Segment> rest(contacts.begin() + static_cast<std::ptrdiff_t>(k) + 1, contacts.end());
    return split(piece, normal, offset, &contact, rest, sizes);
  }

  // Strips along creases, each a third of what is left, so that widths grow geometrically with distance.
  std::size_t longest = 0;
  double widest = sizes.crease;
  std::optional<std::size_t> creaseEdge;
  for (std::size_t i = 0; i < piece.count(); ++i) {
    const glm::dvec2 edge = piece.next(i) - piece.vertices[i];
    if (glm::length(edge) > glm::length(piece.next(longest) - piece.vertices[longest])) longest = i;
    if (!piece.crease[i]) continue;
    const glm::dvec2 along = glm::normalize(edge);
    const auto [low, high] = piece.extent({-along.y, along.x});
    if (high - low <= widest * (1.0 + 1e-9)) continue;
    widest = high - low;
    creaseEdge = i;
  }
  if (creaseEdge) {
    const glm::dvec2 along = glm::normalize(piece.next(*creaseEdge) - piece.vertices[*creaseEdge]);
    const glm::dvec2 inward(-along.y, along.x);
    const double strip = std::max(widest / 3.0, std::min(sizes.crease, widest / 2.0));
    return split(piece, inward, glm::dot(inward, piece.vertices[*creaseEdge]) + strip, nullptr, {}, sizes);
  }

  const glm::dvec2 along = glm::normalize(piece.next(longest) - piece.vertices[longest]);
  const glm::dvec2 across(-along.y, along.x);
  const auto [lowAlong, highAlong] = piece.extent(along);
  const auto [lowAcross, highAcross] = piece.extent(across);
  // Near the edges of what stands on this polygon or in front of it, irradiance varies over their distance (a
  // block's corner on the floor parts its lit side from its dark one), so extents shrink with it.
  const glm::dvec2 middle = std::accumulate(piece.vertices.begin(), piece.vertices.end(), glm::dvec2(0.0)) /
                            static_cast<double>(piece.count());
  const Vec3d place = origin_ + middle.x * axisU_ + middle.y * axisV_;
  double allowed = sizes.element;
  for (const auto& [from, to] : edgesInFront_) {
    const Vec3d edge = to - from;
    const double t = std::clamp(glm::dot(place - from, edge) / glm::dot(edge, edge), 0.0, 1.0);
    allowed = std::min(allowed, std::max(sizes.crease, glm::distance(place, from + t * edge)));
  }
  if (std::max(highAlong - lowAlong, highAcross - lowAcross) <= allowed) return addElement(piece);
  if (highAlong - lowAlong >= highAcross - lowAcross) {
    return split(piece, along, 0.5 * (lowAlong + highAlong), nullptr, {}, sizes);
  }
  return split(piece, across, 0.5 * (lowAcross + highAcross), nullptr, {}, sizes);
}

int ElementMesh::split(const Piece& piece, const glm::dvec2& normal, double offset, const Segment* contact,
                       const std::vector<Segment>& contacts, const Sizes& sizes) {
  const int below = build(piece.above(-normal, -offset, contact), contacts, sizes);
  const int above = build(piece.above(normal, offset, contact), contacts, sizes);
  cuts_.push_back({normal, offset, below, above});
  return static_cast<int>(cuts_.size()) - 1;
}

int ElementMesh::addElement(const Piece& piece) {
  // Area, centroid and covariance of the region, from the triangles of a fan (each: mean of the products of
  // its corners and of their sum, over 12).
  const glm::dvec2 base = piece.vertices[0];
  double area = 0.0;
  glm::dvec2 first(0.0);
  glm::dmat2 second(0.0);
  for (std::size_t i = 1; i + 1 < piece.count(); ++i) {
    const glm::dvec2 a = piece.vertices[i] - base, b = piece.vertices[i + 1] - base;
    const double triangle = 0.5 * (a.x * b.y - a.y * b.x);
    area += triangle;
    first += (a + b) * (triangle / 3.0);
    second += (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(a + b, a + b)) *
              (triangle / 12.0);
  }
  LV_CHECK(area > 0.0, "an element with {} corners has area {}", piece.count(), area);
  const glm::dvec2 mean = first / area;
  const glm::dmat2 covariance = second * (1.0 / area) - glm::outerProduct(mean, mean);

  // Nodes on the ellipse of inertia times sqrt(2): three at 120 degrees have the region's mean and
  // covariance, hence their quadrature. That ellipse never leaves a convex region (Kannan, Lovász &
  // Simonovits, "Isoperimetric Problems for Convex Bodies and a Localization Lemma", 1995, theorem 4.1); it
  // touches the sides of a triangle.
  const double l00 = std::sqrt(covariance[0][0]);
  const double l10 = covariance[0][1] / l00;
  const double l11 = std::sqrt(covariance[1][1] - l10 * l10);
  const glm::dmat2 fromNodes = glm::dmat2(l00, l10, 0.0, l11) * std::sqrt(2.0);

  // Of the ways to turn them, the one that keeps farthest from the rim, where form factors are ill-defined.
  double bestTurn = 0.0, bestClearance = -1.0;
  for (int step = 0; step < 24; ++step) {
    const double turn = step * (2.0 * kPiD / 3.0 / 24.0);
    double clearance = std::numeric_limits<double>::infinity();
    for (const glm::dvec2& onCircle : nodesOnCircle(turn)) {
      const glm::dvec2 node = base + mean + fromNodes * onCircle;
      for (std::size_t i = 0; i < piece.count(); ++i) {
        const glm::dvec2 edge = glm::normalize(piece.next(i) - piece.vertices[i]);
        clearance = std::min(clearance, glm::dot({-edge.y, edge.x}, node - piece.vertices[i]));
      }
    }
    if (clearance <= bestClearance) continue;
    bestClearance = clearance;
    bestTurn = turn;
  }
  LV_CHECK(bestClearance > 0.0, "an element of area {} has its nodes {} outside", area, -bestClearance);
  elements_.push_back({base + mean, glm::inverse(fromNodes), area, nodesOnCircle(bestTurn)});
  return -static_cast<int>(elements_.size());
}

Vec3d ElementMesh::node(std::size_t element, std::size_t index) const {
  const Element& e = elements_[element];
  const glm::dvec2 p = e.centroid + glm::inverse(e.toNodes) * e.onCircle[index];
  return origin_ + p.x * axisU_ + p.y * axisV_;
}

std::size_t ElementMesh::find(const Vec3d& point) const {
  const glm::dvec2 p = toPlane(point);
  int at = root_;
  while (at >= 0) {
    const Cut& cut = cuts_[static_cast<std::size_t>(at)];
    at = glm::dot(cut.normal, p) >= cut.offset ? cut.above : cut.below;
  }
  return static_cast<std::size_t>(-1 - at);
}

std::array<double, ElementMesh::kNodes> ElementMesh::weights(std::size_t element, const Vec3d& point) const {
  const Element& e = elements_[element];
  const glm::dvec2 q = e.toNodes * (toPlane(point) - e.centroid);
  std::array<double, kNodes> weights;
  for (std::size_t k = 0; k < kNodes; ++k) weights[k] = (1.0 + 2.0 * glm::dot(q, e.onCircle[k])) / 3.0;
  return weights;
}

}  // namespace lightvane
