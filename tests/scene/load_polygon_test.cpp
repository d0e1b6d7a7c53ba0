#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/scene/polygon.h"

namespace lightvane {
namespace {

using testing::HasSubstr;

std::string faultOf(const std::vector<Vec3d>& vertices) {
  const std::optional<PolygonFault> fault = findPolygonFault(vertices);
  return fault ? fault->what : "none";
}

std::vector<Vec3d> regular(int corners, int step = 1) {
  std::vector<Vec3d> vertices;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * kPiD * step * i / corners;
    vertices.emplace_back(std::cos(angle), 0.3, std::sin(angle));
  }
  return vertices;
}

std::vector<Vec3d> scaled(std::vector<Vec3d> vertices, double factor) {
  for (Vec3d& v : vertices) v *= factor;
  return vertices;
}

const std::vector<Vec3d> kSquare = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
/// An L of area 3.
const std::vector<Vec3d> kConcave = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};

TEST(Polygon, AcceptsConvexOutlinesOfAnySize) {
  for (const double factor : {1e-90, 1e-10, 1.0, 1e10, 1e90}) {
    EXPECT_EQ(faultOf(scaled(kSquare, factor)), "none") << factor;
    EXPECT_EQ(faultOf(scaled(regular(100), factor)), "none") << factor;
  }
}

TEST(Polygon, AcceptsEitherOrientation) { EXPECT_EQ(faultOf({kSquare.rbegin(), kSquare.rend()}), "none"); }

TEST(Polygon, AcceptsSliversAndVerticesOnAStraightEdge) {
  EXPECT_EQ(faultOf({{0, 0, 0}, {1, 0, 0}, {1, 1e-10, 0}, {0, 1e-10, 0}}), "none");
  EXPECT_EQ(faultOf({{0, 0, 0}, {1, 0, 0}, {0.5, 1e-10, 0}}), "none");
  EXPECT_EQ(faultOf({{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}, {1, 1, 0}}), "none");
  // 1e-7 inwards, as a coordinate of seven digits may be.
  EXPECT_EQ(faultOf({{0, 0, 0}, {0.5, 1e-7, 0}, {1, 0, 0}, {1, 1, 0}}), "none");
}

TEST(Polygon, DrawsTheLineAtThePlanarTolerance) {
  // A corner of a square that is lifted by h leaves the best plane by h / 4.
  const auto lifted = [](double h) { return std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, h}, {0, 1, 0}}; };
  EXPECT_EQ(faultOf(lifted(3.9 * kPlanarTolerance)), "none");
  EXPECT_THAT(faultOf(lifted(4.1 * kPlanarTolerance)), HasSubstr("not planar"));
  EXPECT_THAT(faultOf(scaled(lifted(4.1 * kPlanarTolerance), 1e-30)), HasSubstr("not planar"));
}

TEST(Polygon, NamesWhatIsWrong) {
  EXPECT_THAT(faultOf({{0, 0, 0}, {1, 0, 0}}), HasSubstr("at least 3 vertices, found 2"));
  EXPECT_THAT(faultOf({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}), HasSubstr("the same point"));
  EXPECT_THAT(faultOf({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
              HasSubstr("vertices 2 and 3 are the same"));
  EXPECT_THAT(faultOf({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), HasSubstr("no area"));
  EXPECT_THAT(faultOf(kConcave), HasSubstr("not convex at vertex 4"));
  EXPECT_THAT(faultOf(regular(5, 2)), HasSubstr("crosses itself"));
  // A spike: out along an edge and back.
  EXPECT_THAT(faultOf({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
              HasSubstr("not convex at vertex 3"));
}

double areaOf(const std::vector<Vec3d>& vertices, const glm::uvec3& t) {
  return 0.5 * glm::dot(glm::cross(vertices[t.y] - vertices[t.x], vertices[t.z] - vertices[t.x]),
                        polygonNormal(vertices));
}

struct Outline {
  const char* name;
  std::vector<Vec3d> vertices;
  double area;
};
void PrintTo(const Outline& outline, std::ostream* out) { *out << outline.name; }

class Triangulate : public testing::TestWithParam<Outline> {};

TEST_P(Triangulate, CoversThePolygonOnceWithItsOrientation) {
  const std::vector<Vec3d>& vertices = GetParam().vertices;
  const std::vector<glm::uvec3> triangles = triangulate(vertices);
  EXPECT_EQ(triangles.size(), vertices.size() - 2);
  double sum = 0.0;
  for (const glm::uvec3& t : triangles) {
    // Positive areas that add up to the whole leave neither holes nor overlaps.
    EXPECT_GE(areaOf(vertices, t), 0.0) << t.x << " " << t.y << " " << t.z;
    sum += areaOf(vertices, t);
  }
  EXPECT_NEAR(sum, GetParam().area, 1e-12 * GetParam().area) << "tolerance: rounding of double";
}

INSTANTIATE_TEST_SUITE_P(
    Outlines, Triangulate,
    testing::Values(Outline{"Triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0.5},
                    Outline{"Square", kSquare, 1.0},
                    Outline{"SquareFromBelow", {kSquare.rbegin(), kSquare.rend()}, 1.0},
                    Outline{"Ell", kConcave, 3.0}, Outline{"TinyEll", scaled(kConcave, 1e-6), 3e-12},
                    // The shorter diagonal of this quad lies outside of it.
                    Outline{"Arrowhead", {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1.9, 1, 0}}, 0.1},
                    Outline{"Hundred", regular(100), 50.0 * std::sin(2.0 * kPiD / 100.0)}),
    [](const testing::TestParamInfo<Outline>& outline) { return outline.param.name; });

TEST(TriangulateFaulty, EndsForOutlinesThatAreNone) {
  EXPECT_EQ(triangulate({}).size(), 0U);
  EXPECT_EQ(triangulate(regular(5, 2)).size(), 3U);
  EXPECT_EQ(triangulate(std::vector<Vec3d>(6, Vec3d(1.0))).size(), 4U);
  EXPECT_EQ(triangulate(std::vector<Vec3d>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2U);
}

}  // namespace
}  // namespace lightvane
