#include <array>

#include <gtest/gtest.h>

#include "core/scene/spherical.h"
#include "tests/scene/lights_support.h"

namespace lightvane {
namespace {

using namespace lights_test;

constexpr int kMapSamples = 60000;

struct Corners {
  Vec3d a, b, c;
};

SphericalTriangle triangleMap(const Vec3d& a, const Vec3d& b, const Vec3d& c) { return {a, b - a, c - a}; }

// Triangles of all sizes, shapes and tilts about the origin: (scale of edges, distance) from a fixed list.
Corners randomTriangle(std::uint32_t i, double edge) {
  const RandomKey key = randomKey(3);
  const auto r = [&](std::uint32_t d) { return 2.0 * uniform(key, i, d) - 1.0; };
  const Vec3d centre(r(0), r(1), r(2));
  return {centre + edge * Vec3d(r(3), r(4), r(5)), centre + edge * Vec3d(r(6), r(7), r(8)),
          centre + edge * Vec3d(r(9), r(10), r(11))};
}

TEST(SphericalTriangle, SolidAngleIsVanOosteromAndStrackees) {
  for (const double edge : {10.0, 1.0, 0.1, 1e-2}) {
    for (std::uint32_t i = 0; i < 200; ++i) {
      const Corners t = randomTriangle(i, edge);
      const SphericalTriangle map = triangleMap(t.a, t.b, t.c);
      const long double reference = referenceSolidAngle(t.a, t.b, t.c);
      EXPECT_EQ(map.seenFromFront(), reference < 0.0L) << "triangle " << i << ", edge " << edge;
      // The coordinates are given to 1e-16; an edge-on triangle turns that into 1e-16 of its absolute solid
      // angle.
      EXPECT_NEAR(map.solidAngle(), double(std::abs(reference)), 1e-11 * double(std::abs(reference)) + 1e-15)
          << "triangle " << i << ", edge " << edge;
    }
  }
}

TEST(SphericalTriangle, TinyOnesHaveTheSolidAngleOfAFlatPatch) {
  for (const double edge : {1e-4, 1e-6, 1e-8}) {
    for (std::uint32_t i = 0; i < 100; ++i) {
      const Corners t = randomTriangle(i, edge);
      const Vec3d centroid = (t.a + t.b + t.c) / 3.0;
      const double distance = glm::length(centroid);
      const Vec3d cross = glm::cross(t.b - t.a, t.c - t.a);
      const double flat = 0.5 * std::abs(glm::dot(cross, centroid)) / (distance * distance * distance);
      if (0.01 * glm::length(cross) > std::abs(glm::dot(cross, centroid)) / distance) continue;  // edge-on
      // The next term is of second order in edge / distance; the vertices are centre + edge rounded to 2e-16.
      const double relative = 100.0 * square(edge / distance) + 1e-15 / edge * 100.0;
      EXPECT_NEAR(triangleMap(t.a, t.b, t.c).solidAngle() / flat, 1.0, relative)
          << "triangle " << i << ", edge " << edge;
    }
  }
}

// The chi-square of directions from the maps against the solid angles of a triangle's 64 parts.
template <class Map>
double partsSigmas(const Map& map, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  constexpr int kParts = 8;
  const Vec3d normal = glm::cross(b - a, c - a);
  std::array<std::array<int, 2>, kParts * kParts> counts{};
  int outside = 0;
  forIndependentSamples(kMapSamples, 9, [&](const Vec2& u) {
    const SphericalSample s = map.sample(Vec2d(u));
    // Barycentric coordinates of the hit, from the direction alone, relative to a: no digits lost to the
    // distance.
    const double t = glm::dot(a, normal) / glm::dot(s.direction, normal);
    const Vec3d p = s.direction * t - a;
    const double v = kParts * glm::dot(glm::cross(p, c - a), normal) / glm::dot(normal, normal);
    const double w = kParts * glm::dot(glm::cross(b - a, p), normal) / glm::dot(normal, normal);
    const double slack = 1e-6;
    if (!(v > -slack && w > -slack && v + w < kParts + slack)) ++outside;
    const int i = std::clamp(static_cast<int>(v), 0, kParts - 1);
    const int j = std::clamp(static_cast<int>(w), 0, kParts - 1 - i);
    const bool upper = v - i + w - j > 1.0 && i + j < kParts - 1;
    ++counts[static_cast<std::size_t>(i * kParts + j)][upper ? 1 : 0];
  });
  EXPECT_EQ(outside, 0) << "samples beside the triangle";
  const auto corner = [&](int i, int j) {
    return a + (b - a) * (double(i) / kParts) + (c - a) * (double(j) / kParts);
  };
  ChiSquare chiSquare;
  const double total = triangleMap(a, b, c).solidAngle();
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; i + j < kParts; ++j) {
      const double scale = kMapSamples / total;
      const auto& count = counts[static_cast<std::size_t>(i * kParts + j)];
      chiSquare.add(count[0],
                    scale * triangleMap(corner(i, j), corner(i + 1, j), corner(i, j + 1)).solidAngle());
      if (i + j + 1 < kParts) {
        chiSquare.add(
            count[1],
            scale * triangleMap(corner(i + 1, j + 1), corner(i + 1, j), corner(i, j + 1)).solidAngle());
      }
    }
  }
  return chiSquare.sigmas();
}

TEST(SphericalTriangle, SamplesAreUniformInSolidAngle) {
  const Corners triangles[] = {
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},                // an octant
      {{-1, -1, 1e-3}, {2, -1, 1e-3}, {-1, 3, 1e-3}},   // just above the inside: nearly a hemisphere
      {{1, -1, 1e-4}, {3, -1, 1e-4}, {1, 2, 1e-4}},     // in grazing view
      {{-1, 1e-5, 1}, {1, 1e-5, 1}, {0, 2, 1}},         // beside an edge's plane
      {{1, 1, 1}, {1 + 1e-6, 1, 1}, {1, 1, 1 + 1e-6}},  // 1e-13 sr
      {{0, 0, 1}, {1e-9, 0, 1}, {0, 1e-9, 1}},          // 5e-19 sr
      {{0.5, 0, 1}, {0.5 + 1e-4, 0, 1}, {0.5, 3, 1}},   // a sliver
  };
  for (const Corners& t : triangles) {
    EXPECT_LT(partsSigmas(triangleMap(t.a, t.b, t.c), t.a, t.b, t.c), kChiSquareSigmas)
        << "solid angle " << triangleMap(t.a, t.b, t.c).solidAngle();
  }
}

struct Rectangle {
  Vec3d corner, x, y;
};
const Rectangle kRectangles[] = {
    {{-0.5, -0.5, 1}, {1, 0, 0}, {0, 1, 0}},         // facing
    {{0.5, 0.25, 1}, {1, 0, 0}, {0, 2, 0}},          // aside
    {{-1, -2, 1e-3}, {3, 0, 0}, {0, 3, 0}},          // nearly a hemisphere
    {{0.5, -0.5, 1e-4}, {1, 0, 0}, {0, 1, 0}},       // grazing, straddling y = 0
    {{0.5, 0.5, 1e-4}, {1, 0, 0}, {0, 1, 0}},        // grazing, in a corner
    {{0.5, 0.5, 1e-8}, {1, 0, 0}, {0, 1, 0}},        // more so
    {{-0.5, 0.5, 1e-4}, {1, 0, 0}, {0, 1, 0}},       // grazing, straddling x = 0
    {{0, 0, 1e-3}, {1, 0, 0}, {0, 1, 0}},            // above its corner
    {{0.7, 0.4, 1}, {1e-6, 0, 0}, {0, 1e-6, 0}},     // 1e-12 sr
    {{0.7, 0.4, 1e-3}, {1e-6, 0, 0}, {0, 1e-6, 0}},  // 1e-15 sr, grazing
    {{-2, 0.3, 1}, {4, 0, 0}, {0, 1e-5, 0}},         // a strip along x
    {{0.3, -2, 1}, {1e-5, 0, 0}, {0, 4, 0}},         // a strip along y
};

TEST(SphericalRectangle, SolidAngleIsThatOfItsTriangles) {
  for (const Rectangle& r : kRectangles) {
    const double solidAngle = SphericalRectangle(r.corner, {r.x, r.y}).solidAngle();
    const double triangles = triangleMap(r.corner, r.corner + r.x, r.corner + r.x + r.y).solidAngle() +
                             triangleMap(r.corner, r.corner + r.x + r.y, r.corner + r.y).solidAngle();
    // Begin and end of a slim rectangle aside are subtracted: 1e-16 over its relative width.
    EXPECT_NEAR(solidAngle / triangles, 1.0, 1e-9) << "solid angle " << triangles;
  }
}

TEST(SphericalRectangle, SamplesAreUniformInSolidAngle) {
  constexpr int kParts = 12;
  for (const Rectangle& r : kRectangles) {
    const SphericalRectangle map(r.corner, {r.x, r.y});
    std::array<int, kParts * kParts> counts{};
    forIndependentSamples(kMapSamples, 5, [&](const Vec2& u) {
      const SphericalSample s = map.sample(Vec2d(u));
      const Vec3d p = s.direction * (r.corner.z / s.direction.z) - r.corner;
      const double px = p.x / r.x.x;
      const double py = p.y / r.y.y;
      EXPECT_TRUE(px > -1e-6 && px < 1 + 1e-6 && py > -1e-6 && py < 1 + 1e-6) << px << " " << py;
      const int i = std::clamp(static_cast<int>(px * kParts), 0, kParts - 1);
      const int j = std::clamp(static_cast<int>(py * kParts), 0, kParts - 1);
      ++counts[static_cast<std::size_t>(i * kParts + j)];
    });
    ChiSquare chiSquare;
    for (int i = 0; i < kParts; ++i) {
      for (int j = 0; j < kParts; ++j) {
        const Vec3d c00 = r.corner + r.x * (double(i) / kParts) + r.y * (double(j) / kParts);
        const Vec3d c10 = c00 + r.x / double(kParts);
        const Vec3d c01 = c00 + r.y / double(kParts);
        const Vec3d c11 = c10 + r.y / double(kParts);
        const double cell = triangleMap(c00, c10, c11).solidAngle() + triangleMap(c00, c11, c01).solidAngle();
        chiSquare.add(counts[static_cast<std::size_t>(i * kParts + j)],
                      kMapSamples * cell / map.solidAngle());
      }
    }
    EXPECT_LT(chiSquare.sigmas(), kChiSquareSigmas)
        << "rectangle of " << map.solidAngle() << " sr, " << chiSquare.cells() << " cells";
  }
}

TEST(SphericalCap, SamplesAreUniformInSolidAngle) {
  for (const double radius : {1e-6, 0.1, 0.999999, 1.5}) {  // the last one has the origin inside
    const Vec3d center = glm::normalize(Vec3d(1, -2, 0.5));
    const SphericalCap map(center, radius);
    const double oneMinusCosMax = map.solidAngle() / (2.0 * kPiD);
    EXPECT_EQ(map.seenFromFront(), radius < 1.0);
    const double expected = radius < 1.0 ? 1.0 - std::sqrt(1.0 - radius * radius) : 2.0;
    EXPECT_NEAR(oneMinusCosMax, expected, 2e-16 + 1e-12 * expected) << "radius " << radius;
    const Vec3d x = glm::normalize(glm::cross(center, Vec3d(0, 0, 1)));
    const Vec3d y = glm::cross(center, x);
    constexpr int kRings = 10, kSectors = 12;
    std::array<int, kRings * kSectors> counts{};
    forIndependentSamples(kMapSamples, 6, [&](const Vec2& u) {
      const SphericalSample s = map.sample(Vec2d(u));
      const Vec3d difference = s.direction - center;
      const double ring = kRings * 0.5 * glm::dot(difference, difference) / oneMinusCosMax;
      const double sector =
          kSectors * (0.5 + std::atan2(glm::dot(s.direction, y), glm::dot(s.direction, x)) / (2.0 * kPiD));
      const int i = std::clamp(static_cast<int>(ring), 0, kRings - 1);
      const int j = std::clamp(static_cast<int>(sector), 0, kSectors - 1);
      ++counts[static_cast<std::size_t>(i * kSectors + j)];
      // The sample is on the sphere; a direction off by 1e-16 misses a small far one's surface by that of its
      // distance.
      EXPECT_NEAR(glm::length(s.direction * s.distance - center), radius, 1e-12 + 1e-7 * radius);
    });
    ChiSquare chiSquare;
    for (const int count : counts) chiSquare.add(count, double(kMapSamples) / (kRings * kSectors));
    EXPECT_LT(chiSquare.sigmas(), kChiSquareSigmas) << "radius " << radius;
  }
}

struct Disc {
  Vec3d center;
  double radius;
};
// The normal is (0, 0, -1): they face the origin from above.
const Disc kDiscs[] = {
    {{0, 0, 1}, 1.0},         // on the axis
    {{0, 0, 1e-3}, 1.0},      // nearly a hemisphere
    {{0.9, 0, 0.1}, 1.0},     // under the rim, inside
    {{1.0, 0, 1e-2}, 1.0},    // under the rim
    {{-1.5, 0.5, 0.3}, 1.0},  // aside
    {{0, 3, 1e-3}, 1.0},      // grazing
    {{0.5, 0.3, 1}, 1e-6},    // 2e-12 sr
};

// A closed disc's solid angle as a polygon of many sides that has the disc's area.
double discSolidAngle(const Disc& disc) {
  constexpr int kSides = 20000;
  const double step = 2.0 * kPiD / kSides;
  const double radius = disc.radius * std::sqrt(step / std::sin(step));
  double sum = 0.0;
  const auto rim = [&](int i) {
    return disc.center + radius * Vec3d(std::cos(step * i), std::sin(step * i), 0.0);
  };
  for (int i = 0; i < kSides; ++i) sum += triangleMap(disc.center, rim(i), rim(i + 1)).solidAngle();
  return sum;
}

TEST(SphericalDisc, SolidAngleAndDensityAgreeWithAPolygonOfManySides) {
  for (const Disc& disc : kDiscs) {
    const SphericalDisc map(disc.center, Vec3d(0, 0, -1), disc.radius);
    const double reference = discSolidAngle(disc);
    EXPECT_TRUE(map.seenFromFront());
    EXPECT_NEAR(map.solidAngle() / reference, 1.0, 1e-3) << "height " << disc.center.z;
    double least = kInfinity, most = 0.0;
    const Estimate mean = integrate(200, 8, [&](const Vec2& u) {
      const double inverse = 1.0 / map.pdf(map.sample(Vec2d(u)).direction);
      least = std::min(least, inverse);
      most = std::max(most, inverse);
      return inverse;
    });
    EXPECT_NEAR(mean.mean, reference, tolerance(mean)) << "height " << disc.center.z;
    EXPECT_LE(most / least, 2.0 * (1.0 + 1e-9)) << "height " << disc.center.z;
  }
  // On the axis: 2 pi (1 - cos).
  EXPECT_NEAR(SphericalDisc({0, 0, 1}, {0, 0, -1}, 1.0).solidAngle(), 2.0 * kPiD * (1.0 - std::sqrt(0.5)),
              1e-13);
}

TEST(SphericalDisc, SamplesFollowTheDensity) {
  constexpr int kRings = 8, kSectors = 16, kFine = 24;
  for (const Disc& disc : kDiscs) {
    const SphericalDisc map(disc.center, Vec3d(0, 0, -1), disc.radius);
    std::array<int, kRings * kSectors> counts{};
    forIndependentSamples(kMapSamples, 4, [&](const Vec2& u) {
      const SphericalSample s = map.sample(Vec2d(u));
      const Vec3d p = (s.direction * (disc.center.z / s.direction.z) - disc.center) / disc.radius;
      const double r = std::hypot(p.x, p.y);
      EXPECT_LT(r, 1.0 + 1e-6);
      const int i = std::clamp(static_cast<int>(kRings * r), 0, kRings - 1);
      const int j = std::clamp(static_cast<int>(kSectors * (0.5 + std::atan2(p.y, p.x) / (2.0 * kPiD))), 0,
                               kSectors - 1);
      ++counts[static_cast<std::size_t>(i * kSectors + j)];
      EXPECT_NEAR(s.distance * s.direction.z, disc.center.z, 1e-12);
    });
    // The density over each cell, with the projection to solid angle, by the midpoint rule.
    std::array<double, kRings * kSectors> expected{};
    double total = 0.0;
    for (int i = 0; i < kRings; ++i) {
      for (int j = 0; j < kSectors; ++j) {
        double sum = 0.0;
        for (int k = 0; k < kFine * kFine; ++k) {
          const double r = (i + (k % kFine + 0.5) / kFine) / kRings * disc.radius;
          const double angle = ((j + (k / kFine + 0.5) / kFine) / kSectors - 0.5) * 2.0 * kPiD;
          const Vec3d p = disc.center + r * Vec3d(std::cos(angle), std::sin(angle), 0.0);
          const double distance = glm::length(p);
          sum += map.pdf(p / distance) * disc.center.z / (distance * distance * distance) * r;
        }
        expected[static_cast<std::size_t>(i * kSectors + j)] = sum;
        total += sum;
      }
    }
    // The rule resolves the projection where the point is not much nearer than a fine cell is wide.
    const bool resolved = disc.center.z > 0.02 || glm::length(disc.center) > 1.4 * disc.radius;
    if (!resolved) continue;
    const double cellFactor = disc.radius / kRings / kFine * 2.0 * kPiD / kSectors / kFine;
    EXPECT_NEAR(total * cellFactor, 1.0, 2e-3) << "the density over the disc, height " << disc.center.z;
    ChiSquare chiSquare;
    for (std::size_t k = 0; k < counts.size(); ++k)
      chiSquare.add(counts[k], kMapSamples * expected[k] / total);
    EXPECT_LT(chiSquare.sigmas(), kChiSquareSigmas)
        << "height " << disc.center.z << ", " << chiSquare.cells() << " cells";
  }
}

TEST(SphericalShapes, EdgeOnAndWithoutExtentHaveNoSolidAngle) {
  EXPECT_EQ(triangleMap({1, 0, 0}, {2, 0, 0}, {1, 1, 0}).solidAngle(), 0.0);
  EXPECT_EQ(triangleMap({-1, -1, 0}, {2, -1, 0}, {-1, 2, 0}).solidAngle(), 0.0) << "on the triangle";
  EXPECT_EQ(triangleMap({0, 0, 1}, {1, 0, 1}, {2, 0, 1}).solidAngle(), 0.0) << "without area";
  EXPECT_EQ(triangleMap({0, 0, 1}, {0, 0, 1}, {0, 0, 1}).solidAngle(), 0.0) << "a single point";
  EXPECT_EQ(triangleMap({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).solidAngle(), 0.0) << "at a corner";
  EXPECT_EQ(SphericalRectangle({-1, -1, 0}, {{2, 0, 0}, {0, 2, 0}}).solidAngle(), 0.0);
  EXPECT_EQ(SphericalRectangle({-1, -1, 1}, {{2, 0, 0}, {0, 0, 0}}).solidAngle(), 0.0);
  EXPECT_EQ(SphericalDisc({0, 0, 0}, {0, 0, 1}, 1.0).solidAngle(), 0.0);
  EXPECT_EQ(SphericalDisc({0, 0, 1}, {0, 0, 1}, 0.0).solidAngle(), 0.0);
  EXPECT_EQ(SphericalCap({0, 0, 1}, 0.0).solidAngle(), 0.0);
}

}  // namespace
}  // namespace lightvane
