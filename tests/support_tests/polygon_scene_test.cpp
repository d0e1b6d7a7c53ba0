#include "tests/support/polygon_scene.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/base/check.h"
#include "tests/support/cornell.h"

namespace lightvane {
namespace {

constexpr double kRounding = 1e-12;

// A rectangle facing down (-z) at height z.
DiffusePolygon facingDown(double x0, double x1, double y0, double y1, double z) {
  return {"down", {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}}, Vec3d(0.0), Vec3d(1.0)};
}

// From an element under a corner of a parallel a x b rectangle at distance 1. Howell, "A Catalog of Radiation
// Heat Transfer Configuration Factors", B-3.
double cornerFormFactor(double a, double b) {
  const double p = std::sqrt(1.0 + a * a), q = std::sqrt(1.0 + b * b);
  return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2.0 * kPiD);
}

// Between equal, opposite a x b rectangles at distance 1. Howell, C-11.
double parallelFormFactor(double x, double y) {
  const double p = 1.0 + x * x, q = 1.0 + y * y;
  return 2.0 / (kPiD * x * y) *
         (0.5 * std::log(p * q / (p + y * y)) + x * std::sqrt(q) * std::atan(x / std::sqrt(q)) +
          y * std::sqrt(p) * std::atan(y / std::sqrt(p)) - x * std::atan(x) - y * std::atan(y));
}

// From a 1 x w rectangle to a 1 x h one at right angles, with the edge of length 1 in common. Howell, C-14.
double perpendicularFormFactor(double w, double h) {
  const double w2 = w * w, h2 = h * h, s = w2 + h2;
  return (w * std::atan(1.0 / w) + h * std::atan(1.0 / h) - std::sqrt(s) * std::atan(1.0 / std::sqrt(s)) +
          0.25 *
              std::log((1.0 + w2) * (1.0 + h2) / (1.0 + s) * std::pow(w2 * (1.0 + s) / ((1.0 + w2) * s), w2) *
                       std::pow(h2 * (1.0 + s) / ((1.0 + h2) * s), h2))) /
         (kPiD * w);
}

// The form factor by counting: the share of cosine-distributed lattice rays that meet the polygon's front
// first.
double countedFormFactor(const PolygonScene& scene, const Vec3d& point, const Vec3d& normal,
                         std::size_t polygon) {
  constexpr int kRays = 1 << 18;
  const Vec3d x =
      glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
  const Vec3d y = glm::cross(normal, x);
  int count = 0;
  for (int i = 0; i < kRays; ++i) {
    const double radiusSquared = (i + 0.5) / kRays, angle = 2.399963229728653 * i;
    const Vec3d direction = std::sqrt(radiusSquared) * (std::cos(angle) * x + std::sin(angle) * y) +
                            std::sqrt(1.0 - radiusSquared) * normal;
    const auto hit = scene.nearestHit(point, direction);
    count += hit && hit->front && hit->polygon == polygon;
  }
  return static_cast<double>(count) / kRays;
}
// Lattice rays miscount along outlines only: about sqrt(rays) of them lie there, with random signs.
constexpr double kCounting = 5e-4;

TEST(FormFactor, OfACornerMatchesTheClosedForm) {
  for (const double a : {0.01, 0.3, 1.0, 7.0, 1000.0}) {
    for (const double b : {0.02, 1.0, 50.0}) {
      const PolygonScene scene({facingDown(0, a, 0, b, 1)});
      const double expected = cornerFormFactor(a, b);
      EXPECT_NEAR(scene.visibleFormFactor(Vec3d(0.0), {0, 0, 1}, 0) / expected, 1.0, 1e-9) << a << " x " << b;
    }
  }
}

TEST(FormFactor, IsZeroFromBehindBelowOrInThePlane) {
  const PolygonScene scene({facingDown(-1, 1, -1, 1, 1)});
  EXPECT_EQ(scene.visibleFormFactor({0, 0, 2}, {0, 0, -1}, 0), 0.0) << "seen from behind";
  EXPECT_EQ(scene.visibleFormFactor({0, 0, 0}, {0, 0, -1}, 0), 0.0) << "below the horizon";
  EXPECT_EQ(scene.visibleFormFactor({3, 0, 1}, {-1, 0, 0}, 0), 0.0) << "in its plane";
}

TEST(FormFactor, IsCutAtTheHorizon) {
  // An upright element in the middle under a wide plate sees half of it, and half of that half's cosine.
  const PolygonScene scene({facingDown(-1e4, 1e4, -1e4, 1e4, 1)});
  EXPECT_NEAR(scene.visibleFormFactor(Vec3d(0.0), {1, 0, 0}, 0), 0.5, 1e-4);
  EXPECT_NEAR(scene.visibleFormFactor(Vec3d(0.0), {0, 0, 1}, 0), 1.0, 1e-7);
}

TEST(FormFactor, BetweenParallelRectanglesMatchesTheClosedForm) {
  const PolygonScene scene({facingDown(0, 1, 0, 2, 1)});
  constexpr int kPoints = 128;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      sum += scene.visibleFormFactor({(i + 0.5) / kPoints, 2.0 * (j + 0.5) / kPoints, 0}, {0, 0, 1}, 0);
    }
  }
  // The midpoint rule: of order h² = 6e-5 of a smooth integrand, measured 3.7e-6 and four times that at 64
  // points.
  EXPECT_NEAR(sum / (kPoints * kPoints), parallelFormFactor(1, 2), 8e-6);
  EXPECT_NEAR(parallelFormFactor(1, 1), 0.19982, 5e-6);
}

TEST(FormFactor, BetweenPerpendicularRectanglesMatchesTheClosedForm) {
  // The upright wall stands on the edge x = 0 of the floor and faces it; the floor is 0.7 wide.
  const double width = 0.7, height = 1.6;
  const PolygonScene scene(
      {{"wall", {{0, 0, 0}, {0, 1, 0}, {0, 1, height}, {0, 0, height}}, Vec3d(0.0), Vec3d(1.0)}});
  constexpr int kPoints = 64;
  double sum = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    // x = width u³, y = 3v² - 2v³: many points along the edges, where the form factor is not smooth.
    const double u = (i + 0.5) / kPoints;
    for (int j = 0; j < kPoints; ++j) {
      const double v = (j + 0.5) / kPoints;
      sum += scene.visibleFormFactor({width * u * u * u, v * v * (3.0 - 2.0 * v), 0}, {0, 0, 1}, 0) * 3.0 *
             u * u * 6.0 * v * (1.0 - v);
    }
  }
  // The midpoint rule on the substituted, smooth integrand: of order h² = 2.4e-4, measured 2.7e-5.
  EXPECT_NEAR(sum / (kPoints * kPoints), perpendicularFormFactor(width, height), 5e-5);
  EXPECT_NEAR(perpendicularFormFactor(1, 1), 0.20004, 5e-6);
}

TEST(Visibility, ABlockerHidesExactlyItsShadow) {
  // At half the height, a square of side 1 hides a square of side 2, off-centre like itself.
  DiffusePolygon blocker = facingDown(-0.2, 0.8, -0.5, 0.5, 0.5);
  blocker.emission = Vec3d(0.0);
  const Vec3d origin(0.0), up(0, 0, 1);
  const double whole = PolygonScene({facingDown(-3, 3, -3, 3, 1)}).visibleFormFactor(origin, up, 0);
  const double shadow = PolygonScene({facingDown(-0.4, 1.6, -1, 1, 1)}).visibleFormFactor(origin, up, 0);
  for (const bool flipped : {false, true}) {
    if (flipped) std::reverse(blocker.vertices.begin(), blocker.vertices.end());
    const PolygonScene scene({facingDown(-3, 3, -3, 3, 1), blocker});
    EXPECT_NEAR(scene.visibleFormFactor(origin, up, 0), whole - shadow, kRounding) << "flipped " << flipped;
  }
}

TEST(Visibility, OnlyWhatIsBetweenHides) {
  const PolygonScene scene({facingDown(-1, 1, -1, 1, 1), facingDown(-5, 5, -5, 5, 1.5),
                            facingDown(-5, 5, -5, 5, -0.5), facingDown(2, 5, -5, 5, 0.5)});
  EXPECT_NEAR(scene.visibleFormFactor(Vec3d(0.0), {0, 0, 1}, 0), 4.0 * cornerFormFactor(1, 1), kRounding);
}

TEST(Visibility, ABlockerThatCoversAllHidesAll) {
  const PolygonScene scene({facingDown(-1, 1, -1, 1, 1), facingDown(-0.6, 0.6, -0.6, 0.6, 0.5)});
  EXPECT_EQ(scene.visibleFormFactor(Vec3d(0.0), {0, 0, 1}, 0), 0.0);
}

TEST(Visibility, OverlappingAndCrossingBlockersAgreeWithRays) {
  const auto blocker = [](std::vector<Vec3d> vertices) {
    return DiffusePolygon{"blocker", std::move(vertices)};
  };
  const PolygonScene scene(
      {facingDown(-1, 1, -1, 1, 1), blocker({{-0.5, -0.2, 0.5}, {0.1, -0.3, 0.5}, {0.0, 0.4, 0.7}}),
       blocker({{-0.3, 0.0, 0.2}, {0.3, 0.0, 0.2}, {0.3, 0.1, 0.6}, {-0.3, 0.1, 0.6}}),
       // Stands through the emitter: only its lower part hides.
       blocker({{0.4, -0.8, 0.6}, {0.4, 0.8, 0.6}, {0.6, 0.8, 1.4}, {0.6, -0.8, 1.4}}),
       // Crosses the element's horizon.
       blocker({{-0.9, -0.9, -0.4}, {-0.2, -0.9, -0.4}, {-0.2, -0.9, 0.4}, {-0.9, -0.9, 0.4}})});
  for (const Vec3d& point :
       {Vec3d(0, 0, 0), Vec3d(-0.4, 0.3, 0.1), Vec3d(0.7, -0.6, 0.0), Vec3d(-1.2, -1.7, -0.1)}) {
    for (const Vec3d& normal : {Vec3d(0, 0, 1), glm::normalize(Vec3d(0.5, 0.6, 0.4))}) {
      EXPECT_NEAR(scene.visibleFormFactor(point, normal, 0), countedFormFactor(scene, point, normal, 0),
                  kCounting)
          << "from " << point.x << ", " << point.y << ", " << point.z;
    }
  }
}

TEST(Visibility, OfTheLightInTheCornellBoxAgreesWithRays) {
  const PolygonScene scene(cornellBox());
  const std::size_t light = scene.indexOf("light");
  int shadowed = 0;
  for (const Vec3d& point : {Vec3d(0.3, 0, 0.03), Vec3d(0.31, 0, 0.23), Vec3d(0.07, 0, 0.3),
                             Vec3d(0.49, 0, 0.33), Vec3d(0.2, 0, 0.4), Vec3d(0.1, 0, 0.02)}) {
    const double exact = scene.visibleFormFactor(point, {0, 1, 0}, light);
    EXPECT_NEAR(exact, countedFormFactor(scene, point, {0, 1, 0}, light), kCounting)
        << "from " << point.x << ", " << point.y << ", " << point.z;
    shadowed += exact < 0.9 * PolygonScene({scene.polygons()[light]}).visibleFormFactor(point, {0, 1, 0}, 0);
  }
  EXPECT_GE(shadowed, 2) << "the points are meant to include shadows";
}

TEST(NearestHit, FindsTheNearestSideAndNoGapsBetweenNeighbours) {
  const PolygonScene scene(furnaceCube(Vec3d(0.5), Vec3d(1.0)));
  const auto hit = scene.nearestHit({0.5, 0.5, 0.25}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(scene.polygons()[hit->polygon].name, "-z");
  EXPECT_TRUE(hit->front);
  EXPECT_NEAR(hit->point.z, 0.0, kRounding);
  for (const Vec3d& corner : {Vec3d(1, 1, 1), Vec3d(-1, 1, 0), Vec3d(1, 0, -1)}) {
    EXPECT_TRUE(scene.nearestHit({0.5, 0.5, 0.5}, glm::normalize(corner))) << "towards an edge or a corner";
  }
  const auto outside = scene.nearestHit({0.5, 0.5, -1}, {0, 0, 1});
  ASSERT_TRUE(outside);
  EXPECT_FALSE(outside->front);
  EXPECT_FALSE(scene.nearestHit({0.5, 0.5, -1}, {0, 0, -1}));
}

TEST(PolygonScene, KnowsItsCornellBox) {
  const PolygonScene scene(cornellBox());
  EXPECT_EQ(scene.polygons().size(), 17u);
  EXPECT_NEAR(scene.area(scene.indexOf("light")), 0.130 * 0.105, kRounding);
  EXPECT_NEAR(scene.normal(scene.indexOf("light")).y, -1.0, kRounding);
  EXPECT_NEAR(glm::length(scene.centroid(scene.indexOf("light")) - Vec3d(0.278, 0.5483, 0.2795)), 0.0,
              kRounding);
  // Everything visible faces the middle of the box, or away from the middle of its own block.
  for (const char* name : {"floor", "ceiling", "back", "right", "left_a", "left_b"}) {
    EXPECT_GT(scene.height(scene.indexOf(name), {0.278, 0.27, 0.28}), 0.0) << name;
  }
  for (const char* name : {"short_0", "short_1", "short_2", "short_3", "short_4"}) {
    EXPECT_LT(scene.height(scene.indexOf(name), {0.185, 0.08, 0.17}), 0.0) << name;
  }
  for (const char* name : {"tall_0", "tall_1", "tall_2", "tall_3", "tall_4"}) {
    EXPECT_LT(scene.height(scene.indexOf(name), {0.37, 0.16, 0.35}), 0.0) << name;
  }
  // With its front closed no light gets out.
  std::vector<DiffusePolygon> closed = cornellBox();
  closed.push_back(cornellFront());
  const PolygonScene box(closed);
  double sum = 0.0;
  for (std::size_t i = 0; i < closed.size(); ++i) sum += box.visibleFormFactor({0.2, 0.4, 0.1}, {0, 1, 0}, i);
  // The ceiling's fraction above the light's rim is seen through the gap of 0.5 mm, from inside the box as
  // well.
  EXPECT_NEAR(sum, 1.0, kRounding);
}

TEST(PolygonScene, RefusesWhatItCannotTreat) {
  const auto scene = [](std::vector<Vec3d> vertices) {
    return PolygonScene({DiffusePolygon{"p", std::move(vertices)}});
  };
  EXPECT_THROW(scene({{0, 0, 0}, {1, 0, 0}}), InvariantViolation);
  EXPECT_THROW(scene({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}), InvariantViolation);
  EXPECT_THROW(scene({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1}, {0, 1, 0}}), InvariantViolation);
  EXPECT_THROW(scene({{0, 0, 0}, {1, 0, 0}, {0.2, 0.2, 0}, {0, 1, 0}}), InvariantViolation);
  EXPECT_THROW(PolygonScene({DiffusePolygon{"p", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, Vec3d(1.1)}}),
               InvariantViolation);
  EXPECT_THROW(scene({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).indexOf("q"), InvariantViolation);
}

}  // namespace
}  // namespace lightvane
