#include "tests/support/element_mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/cornell.h"

namespace lightvane {
namespace {

class ElementMeshOfCornell : public testing::Test {
 protected:
  ElementMesh mesh(const std::string& polygon) const {
    return {scene_, scene_.indexOf(polygon), {0.12 * scene_.diagonal(), 0.015 * scene_.diagonal()}};
  }

  PolygonScene scene_{cornellBox()};
};

TEST_F(ElementMeshOfCornell, CoversEachPolygonOnce) {
  for (const DiffusePolygon& polygon : scene_.polygons()) {
    double area = 0.0;
    const ElementMesh elements = mesh(polygon.name);
    for (const ElementMesh::Element& element : elements.elements()) area += element.area;
    EXPECT_NEAR(area / scene_.area(scene_.indexOf(polygon.name)), 1.0, 1e-12) << polygon.name;
  }
}

TEST_F(ElementMeshOfCornell, NodesLieInTheirElementAndDetermineIt) {
  for (const DiffusePolygon& polygon : scene_.polygons()) {
    const ElementMesh elements = mesh(polygon.name);
    for (std::size_t e = 0; e < elements.elements().size(); ++e) {
      for (std::size_t k = 0; k < ElementMesh::kNodes; ++k) {
        const Vec3d node = elements.node(e, k);
        ASSERT_EQ(elements.find(node), e) << polygon.name;
        const auto weights = elements.weights(e, node);
        for (std::size_t j = 0; j < ElementMesh::kNodes; ++j)
          ASSERT_NEAR(weights[j], j == k ? 1.0 : 0.0, 1e-12);
      }
    }
  }
}

TEST_F(ElementMeshOfCornell, NodesIntegrateQuadraticsExactly) {
  // The right wall is [0, 0.5488] x [0, 0.5592] in y and z.
  const ElementMesh elements = mesh("right");
  double squares = 0.0, products = 0.0;
  for (std::size_t e = 0; e < elements.elements().size(); ++e) {
    for (std::size_t k = 0; k < ElementMesh::kNodes; ++k) {
      const Vec3d node = elements.node(e, k);
      squares += node.y * node.y * elements.elements()[e].area / 3.0;
      products += node.y * node.z * elements.elements()[e].area / 3.0;
    }
  }
  EXPECT_NEAR(squares, std::pow(0.5488, 3) / 3.0 * 0.5592, 1e-14);
  EXPECT_NEAR(products, square(0.5488) / 2.0 * square(0.5592) / 2.0, 1e-14);
}

TEST_F(ElementMeshOfCornell, NoElementReachesUnderABlock) {
  const ElementMesh elements = mesh("floor");
  const auto underABlock = [&](const Vec3d& point) {
    const Vec3d raised = point + Vec3d(0, 1e-6, 0);
    for (const char* block : {"short", "tall"}) {
      bool inside = true;
      for (int side = 1; side <= 4; ++side) {
        inside = inside && scene_.height(scene_.indexOf(fmt::format("{}_{}", block, side)), raised) < 0.0;
      }
      if (inside) return true;
    }
    return false;
  };
  int hidden = 0;
  for (std::size_t e = 0; e < elements.elements().size(); ++e) {
    int under = 0;
    for (std::size_t k = 0; k < ElementMesh::kNodes; ++k) under += underABlock(elements.node(e, k));
    EXPECT_TRUE(under == 0 || under == 3)
        << "element " << e << " has " << under << " of 3 nodes under a block";
    hidden += under == 3;
  }
  EXPECT_GT(hidden, 0);
}

}  // namespace
}  // namespace lightvane
