#pragma once

#include <array>
#include <vector>

#include "tests/support/polygon_scene.h"

namespace lightvane {

/// One polygon cut into convex elements, each with a linear function of its own.
///
/// The cuts follow the lines where other polygons stand on this one, because irradiance jumps there (the
/// floor under a block is black), and close in on the creases where two surfaces meet, because its derivative
/// is unbounded there. Elements share no values with their neighbours, so that hanging corners do not matter.
class ElementMesh {
 public:
  struct Sizes {
    double element;  ///< longest extent of an element, in metres
    double crease;   ///< width of the strip of elements along a crease, in metres
  };

  static constexpr std::size_t kNodes = 3;  ///< of an element; they determine its linear function

  struct Element {
    glm::dvec2 centroid;
    glm::dmat2 toNodes;  ///< from offsets to the centroid, to where the nodes are on the unit circle
    double area;         ///< in m²
    std::array<glm::dvec2, kNodes> onCircle;  ///< the nodes there, 120 degrees apart
  };

  ElementMesh(const PolygonScene& scene, std::size_t polygon, const Sizes& sizes);

  const std::vector<Element>& elements() const { return elements_; }
  /// A node's place in space. The three together integrate any quadratic function over the element exactly.
  Vec3d node(std::size_t element, std::size_t index) const;
  /// Index of the element at a point of the polygon.
  std::size_t find(const Vec3d& point) const;
  /// What each node's value counts for at a point; they sum to 1, and are 1, 0, 0 at the nodes.
  std::array<double, kNodes> weights(std::size_t element, const Vec3d& point) const;

 private:
  struct Piece;
  struct Segment;
  // A binary tree of cuts. `below` and `above` are children, or -1 - element for a leaf.
  struct Cut {
    glm::dvec2 normal;
    double offset;
    int below, above;
  };

  glm::dvec2 toPlane(const Vec3d& point) const;
  std::vector<Segment> contactsWith(const PolygonScene& scene, std::size_t polygon) const;
  int build(const Piece& piece, const std::vector<Segment>& contacts, const Sizes& sizes);
  int split(const Piece& piece, const glm::dvec2& normal, double offset, const Segment* contact,
            const std::vector<Segment>& contacts, const Sizes& sizes);
  int addElement(const Piece& piece);

  Vec3d origin_, axisU_, axisV_;
  double tolerance_;
  std::vector<std::pair<Vec3d, Vec3d>> edgesInFront_;  // of other polygons, in whole or in part
  int root_;
  std::vector<Cut> cuts_;
  std::vector<Element> elements_;
};

}  // namespace lightvane
