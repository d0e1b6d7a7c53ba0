#include <functional>
#include <numeric>

#include <fmt/format.h>

#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// The exact value of a light at a point, against closed forms. "Howell": J. R. Howell, A Catalog of Radiation
// Heat Transfer Configuration Factors; a factor F from an element to a source of radiance L is an irradiance
// of pi L F.
//
// Budget of each statistical test: 64 estimates of 64 shadow rays and a tolerance of 0.5 %, or as stated;
// 99.9 % confidence; sharp against 1 %, or twice the tolerance where that is more (expectUnbiased).

namespace lightvane {
namespace {

using namespace trace_test;

struct Estimates {
  std::vector<DirectLightEstimate> each;

  template <class Part>
  std::vector<double> of(const Part& part) const {
    std::vector<double> values;
    for (const DirectLightEstimate& e : each) values.push_back(static_cast<double>(part(e)));
    return values;
  }
  std::vector<double> irradiance() const {
    return of([](const DirectLightEstimate& e) { return e.irradiance.x; });
  }
};

Estimates estimate(const TracedScene& traced, const LitPoint& lit, std::uint32_t light = 0, int samples = 64,
                   std::uint32_t count = 64, bool byLobe = true) {
  TransportParameters transport;
  transport.lightsByLobe = byLobe;
  DirectLightSampler sampler(*traced.tracer, transport);
  RayCounts counts;
  SampleFaults faults;
  Estimates estimates;
  for (std::uint32_t i = 0; i < count; ++i) {
    estimates.each.push_back(sampler.estimate(lit, light, samples, randomKey(61).with(i), counts, faults));
  }
  EXPECT_EQ(faults.count, 0u);
  return estimates;
}

std::vector<double> redOfLobe(const Estimates& estimates) {
  return estimates.of([](const DirectLightEstimate& e) { return e.lobeRadiance.x; });
}

/// Howell B-3: an element parallel to a rectangle a x b, below one of its corners at distance c.
double cornerFactor(double a, double b, double c) {
  const double x = a / c, y = b / c;
  return 1.0 / (2.0 * kPiD) *
         (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
          y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y)));
}

/// A floor at height 0 and, at height 1, a lamp [0, 1.5] x [0, 0.75] of radiance (2, 1, 0.5) that faces down.
struct Room {
  SceneBuilder builder;
  std::size_t black, floor;

  explicit Room(const MaterialDescription& floorMaterial) {
    floor = builder.material(floorMaterial);
    black = builder.diffuse(Rgb(0.0f));
    const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f, 1.0f, 0.5f));
    builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, floor);
    builder.rectangle({0, 1, 0}, {1.5, 0, 0}, {0, 0, 0.75}, lamp);
  }
};

MaterialDescription grey() {
  MaterialDescription m;
  m.diffuse = Rgb(0.5f);
  return m;
}

TEST(DirectLight, RectangleAboveItsCorner) {
  const Room room(grey());
  const TracedScene traced = room.builder.compile();
  const Estimates estimates = estimate(traced, traced.litPoint({0, 0.5, 0}, {0, -1, 0}));
  const double factor = kPiD * cornerFactor(1.5, 0.75, 1.0) / traced.unitRadiance();
  for (int c = 0; c < 3; ++c) {
    const double radiance = c == 0 ? 2.0 : c == 1 ? 1.0 : 0.5;
    expectUnbiased(estimates.of([c](const DirectLightEstimate& e) { return e.irradiance[c]; }),
                   radiance * factor, "channel " + std::to_string(c));
  }
  for (const DirectLightEstimate& e : estimates.each) {
    ASSERT_EQ(e.rays, 64);
    ASSERT_EQ(e.lobeRadiance, Rgb(0.0f));
  }
}

/// Arvo's irradiance vector of a polygon of radiance 1: half the sum of each side's angle times the normal of
/// its plane through the point (Arvo 1994); towards the polygon, which faces the point.
Vec3d irradianceVector(const std::vector<Vec3d>& corners, const Vec3d& point) {
  Vec3d sum(0.0);
  Vec3d middle(0.0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = corners[i] - point, b = corners[(i + 1) % corners.size()] - point;
    const Vec3d cross = glm::cross(a, b);
    sum += std::atan2(glm::length(cross), glm::dot(a, b)) * glm::normalize(cross);
    middle += a;
  }
  sum *= 0.5;
  return glm::dot(sum, middle) < 0.0 ? -sum : sum;
}

// D = sum L Omega omega / sum L Omega (section 4.1): L and solid angle, no cosine. Its numerator is Arvo's
// vector, its denominator L times the solid angle.
TEST(DirectLight, DirectionIsArvosIrradianceVector) {
  const Room room(grey());
  const TracedScene traced = room.builder.compile();
  const std::vector<Vec3d> corners{{0, 1, 0}, {1.5, 1, 0}, {1.5, 1, 0.75}, {0, 1, 0.75}};
  const double brightness =
      static_cast<double>(paperBrightness(Rgb(2.0f, 1.0f, 0.5f))) / traced.unitRadiance();
  for (const Vec3d& point : {Vec3d(0, 0, 0), Vec3d(2.5, 0, -1), Vec3d(0.7, 0, 0.3)}) {
    const LitPoint lit = traced.litPoint(point + Vec3d(0, 0.5, 0), {0, -1, 0});
    const Estimates estimates = estimate(traced, lit);
    const Vec3d expected = irradianceVector(corners, point);
    for (int axis = 0; axis < 3; ++axis) {
      const std::vector<double> values =
          estimates.of([axis](const DirectLightEstimate& e) { return e.directionSum[axis]; });
      if (std::abs(expected[axis]) < 0.2 * glm::length(expected)) {
        // A component that all but vanishes: within 0.5 % of the whole.
        EXPECT_NEAR(meanInterval(values, 0.999).mean, brightness * expected[axis],
                    0.005 * brightness * glm::length(expected));
        continue;
      }
      expectUnbiased(values, brightness * expected[axis], "component " + std::to_string(axis), 0.009);
    }
    const auto triangle = [&](int i, int j, int k) {
      const Vec3d a = corners[std::size_t(i)] - point, b = corners[std::size_t(j)] - point,
                  c = corners[std::size_t(k)] - point;
      const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
      return 2.0 * std::abs(std::atan2(
                       glm::dot(a, glm::cross(b, c)),
                       la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb));
    };
    const double solidAngle = triangle(0, 1, 2) + triangle(0, 2, 3);
    expectUnbiased(estimates.of([](const DirectLightEstimate& e) { return e.directionWeight; }),
                   brightness * solidAngle, "weight");
    EXPECT_NEAR(estimates.each.front().solidAngle, solidAngle, 1e-5 * solidAngle);
    // The vector's own component along the normal is the irradiance (Arvo 1994).
    expectUnbiased(estimates.irradiance(), 2.0 / traced.unitRadiance() * expected.y, "irradiance");
  }
}

TEST(DirectLight, PointLightFallsOffWithTheSquareOfDistance) {
  for (const double height : {0.01, 1.0, 30.0}) {
    Room room(grey());
    room.builder.light(PointLightDescription{{0.3, height, -0.4}, Rgb(3.0f, 2.0f, 1.0f)});
    const TracedScene traced = room.builder.compile();
    for (const double aside : {0.0, 0.5, 2.0}) {
      const Estimates estimates =
          estimate(traced, traced.litPoint({0.3 - aside, 0.005, -0.4}, {0, -1, 0}), 1, 16, 1);
      const double d = std::hypot(aside, height);
      const double expected = 3.0 / (d * d) * height / d / traced.unitRadiance();
      const DirectLightEstimate& e = estimates.each.front();
      // No noise: only the position's rounding, 2^-24 of the scene's 16 units, against the height.
      EXPECT_NEAR(e.irradiance.x, expected, (1e-6 + 6e-6 / height) * expected)
          << "height " << height << ", " << aside << " aside";
      EXPECT_EQ(e.rays, 1);
      EXPECT_EQ(e.solidAngle, 0.0f);
      const Vec3d direction = glm::normalize(Vec3d(aside, height, 0.0));
      EXPECT_LT(glm::length(Vec3d(e.directionSum / e.directionWeight) - direction), 1e-5 + 1e-5 / height);
    }
  }
}

TEST(DirectLight, SphereAboveTheHorizon) {
  for (const double radius : {1e-3, 0.4}) {
    SceneBuilder builder;
    const std::size_t floor = builder.diffuse(Rgb(0.5f));
    const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
    builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, floor);
    builder.sphere({0, 1, 0}, radius, lamp);
    const TracedScene traced = builder.compile();
    for (const double aside : {0.0, 0.8}) {
      const double d2 = 1.0 + aside * aside;
      const Estimates estimates = estimate(traced, traced.litPoint({aside, 0.3, 0}, {0, -1, 0}));
      expectUnbiased(estimates.irradiance(),
                     2.0 / traced.unitRadiance() * kPiD * radius * radius / d2 / std::sqrt(d2),
                     "radius " + std::to_string(radius));
      const double sinSquared = radius * radius / d2;
      EXPECT_NEAR(estimates.each.front().solidAngle,
                  2.0 * kPiD * sinSquared / (1.0 + std::sqrt(1.0 - sinSquared)), 1e-4 * sinSquared);
    }
  }
}

// A lamp cut into many pieces is the same lamp; how large it looks is known from samples.
TEST(DirectLight, OfVeryManyPiecesLooksAsLargeAsOfOne) {
  const auto lamp = [](int columns) {
    SceneBuilder builder;
    builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.diffuse(Rgb(0.5f)));
    std::vector<Vec3d> positions;
    std::vector<glm::uvec3> triangles;
    for (int i = 0; i <= columns; ++i) {
      const double x = -0.5 + static_cast<double>(i) / columns;
      positions.insert(positions.end(), {{x, 1, -0.5}, {x, 1, 0.5}});
      if (i == columns) break;
      const auto n = static_cast<std::uint32_t>(2 * i);
      triangles.insert(triangles.end(), {{n, n + 2, n + 3}, {n, n + 3, n + 1}});
    }
    builder.mesh(std::move(positions), std::move(triangles), builder.diffuse(Rgb(0.0f), Rgb(2.0f)));
    return builder.compile();
  };
  const TracedScene few = lamp(4), many = lamp(64);
  const Estimates one = estimate(few, few.litPoint({0.2, 0.3, 0}, {0, -1, 0}));
  const Estimates other = estimate(many, many.litPoint({0.2, 0.3, 0}, {0, -1, 0}));
  double solidAngle = 0.0, irradiance = 0.0;
  for (const DirectLightEstimate& e : other.each) {
    solidAngle += static_cast<double>(e.solidAngle) / static_cast<double>(other.each.size());
    irradiance += static_cast<double>(e.irradiance.x) / static_cast<double>(other.each.size());
  }
  const auto exact = static_cast<double>(one.each.front().solidAngle);
  EXPECT_NEAR(solidAngle, exact, 0.01 * exact);
  double expected = 0.0;
  for (const DirectLightEstimate& e : one.each)
    expected += static_cast<double>(e.irradiance.x) / static_cast<double>(one.each.size());
  EXPECT_NEAR(irradiance, expected, 0.01 * expected);
}

// The paper's light of 32 points: with as many samples, each is asked once and the sum exact.
TEST(DirectLight, VolumicSphereAsksEachPointOnce) {
  for (const int points : {7, 32}) {
    Room room(grey());
    room.builder.light(VolumicSphereLightDescription{{0.5, 0.8, -0.2}, 0.3, Rgb(2.0f), points});
    const TracedScene traced = room.builder.compile();
    const LitPoint lit = traced.litPoint({0.3, 0.4, -0.4}, {0, -1, 0});
    const auto& light = std::get<VolumicSphereLight>(traced.scene->lights[1]);
    double expected = 0.0;
    for (const Vec3& p : light.points) {
      const Vec3d to = Vec3d(p) - Vec3d(lit.surface.position);
      expected += static_cast<double>(light.intensity.x) * to.y / std::pow(glm::length(to), 3.0);
    }
    const Estimates all = estimate(traced, lit, 1, points, 4);
    for (const DirectLightEstimate& e : all.each) {
      EXPECT_NEAR(e.irradiance.x, expected, 1e-5 * expected) << points << " points";
      EXPECT_EQ(e.rays, points);
    }
    EXPECT_EQ(estimate(traced, lit, 1, 1000, 1).each.front().rays, points) << "no more rays than points";
    // Fewer samples than points: noisy, unbiased.
    expectUnbiased(estimate(traced, lit, 1, 4, 4096).irradiance(), expected, "4 of " + std::to_string(points),
                   0.015);
  }
}

// A screen that hides exactly half of the lamp: Howell's rectangle of half the length is left.
TEST(DirectLight, OccluderTakesItsHalf) {
  Room room(grey());
  // As seen from the origin, x beyond 0.75 of the lamp at height 1 is x beyond 0.375 at height 0.5.
  room.builder.rectangle({0.375, 0.5, -3}, {3, 0, 0}, {0, 0, 6}, room.black);
  const TracedScene traced = room.builder.compile();
  const LitPoint lit = traced.litPoint({0, 0.25, 0}, {0, -1, 0});
  const Estimates half = estimate(traced, lit, 0, 256, 256);
  expectUnbiased(half.irradiance(), kPiD * cornerFactor(0.75, 0.75, 1.0) * 2.0 / traced.unitRadiance(),
                 "half a rectangle", 0.009);
  // The subtended solid angle is the light's own, whatever hides it.
  const Room open(grey());
  const TracedScene free = open.builder.compile();
  const Estimates whole = estimate(free, free.litPoint({0, 0.25, 0}, {0, -1, 0}));
  EXPECT_FLOAT_EQ(half.each.front().solidAngle, whole.each.front().solidAngle);
}

TEST(DirectLight, WhollyOccludedOrBehindIsZeroWithoutADirection) {
  Room room(grey());
  room.builder.rectangle({-3, 0.5, -3}, {6, 0, 0}, {0, 0, 6}, room.black);
  const TracedScene traced = room.builder.compile();
  const DirectLightEstimate hidden =
      estimate(traced, traced.litPoint({0, 0.25, 0}, {0, -1, 0}), 0, 64, 1).each.front();
  EXPECT_EQ(hidden.irradiance, Rgb(0.0f));
  EXPECT_EQ(hidden.directionWeight, 0.0f);
  EXPECT_EQ(hidden.directionSum, Vec3(0.0f));
  EXPECT_EQ(hidden.rays, 64);
  // The floor from below: the lamp is behind it, and no ray is spent.
  const DirectLightEstimate behind =
      estimate(traced, traced.litPoint({0, -0.25, 0}, {0, 1, 0}), 0, 64, 1).each.front();
  EXPECT_EQ(behind.irradiance, Rgb(0.0f));
  EXPECT_EQ(behind.rays, 0);
}

// Radiance that a lobe sends: midpoints of 512 x 512 pieces of the lamp.
TEST(DirectLight, LobeRadianceIsTheIntegralOverTheLamp) {
  MaterialDescription glossy;
  glossy.diffuse = Rgb(0.2f);
  glossy.layers.push_back({Rgb(0.9f, 0.6f, 0.3f), 0.6, 1.0});
  const Room room(glossy);
  const TracedScene traced = room.builder.compile();
  const Vec3d point(0.4, 0, -0.3);
  const LitPoint lit = traced.litPoint(point + Vec3d(-0.3, 0.5, -0.4), Vec3d(0.3, -0.5, 0.4));
  const Brdf& brdf = traced.scene->materials[lit.surface.material].brdf;
  const Vec3 outgoing = lit.surface.frame.toLocal(lit.outgoing);
  glm::dvec3 expected(0.0);
  constexpr int kSide = 256;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const Vec3d to = Vec3d(1.5 * (i + 0.5) / kSide, 1.0, 0.75 * (j + 0.5) / kSide) - point;
      const double d2 = glm::dot(to, to);
      const Vec3 incoming = lit.surface.frame.toLocal(Vec3(to / std::sqrt(d2)));
      const double solidAngle = 1.5 * 0.75 / (kSide * kSide) / (d2 * std::sqrt(d2));
      expected += glm::dvec3(brdf.lobeRgb(incoming, outgoing)) * static_cast<double>(incoming.z) * solidAngle;
    }
  }
  const Estimates estimates = estimate(traced, lit);
  for (int c = 0; c < 3; ++c) {
    const double radiance = (c == 0 ? 2.0 : c == 1 ? 1.0 : 0.5) / traced.unitRadiance();
    expectUnbiased(estimates.of([c](const DirectLightEstimate& e) { return e.lobeRadiance[c]; }),
                   radiance * expected[c], "channel " + std::to_string(c));
  }
}

// ---- many lights ----

/// A glossy floor below lamps of all kinds, each brighter than the one before: by 1.06 or so, 40 times in
/// all.
struct ManyLights {
  SceneBuilder builder;
  std::vector<std::uint32_t> all;

  explicit ManyLights(std::uint32_t count) {
    MaterialDescription glossy;
    glossy.diffuse = Rgb(0.3f);
    glossy.layers.push_back({Rgb(0.6f), 0.4, 1.0});
    builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(glossy));
    builder.rectangle({0.3, 0.5, -4}, {0.6, 0, 0}, {0, 0, 8}, builder.diffuse(Rgb(0.0f)));
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec3d at =
          Vec3d(6, 1, 6) * (randomPoint(randomKey(5), i, 0) - Vec3d(0.5, 0, 0.5)) + Vec3d(0, 1, 0);
      const auto power = static_cast<float>(std::pow(40.0, i / static_cast<double>(count)));
      if (i % 3 == 0) {
        builder.light(PointLightDescription{at, Rgb(power)});
      } else if (i % 3 == 1) {
        builder.sphere(at, 0.1, builder.diffuse(Rgb(0.0f), Rgb(30.0f * power)));
      } else {
        builder.rectangle(at, {0.2, 0, 0}, {0, 0, 0.2}, builder.diffuse(Rgb(0.0f), Rgb(20.0f * power)));
      }
      all.push_back(i);
    }
  }
};

Estimates estimateTogether(const TracedScene& traced, const LitPoint& lit,
                           std::span<const std::uint32_t> lights, int samples, std::uint32_t count,
                           RayCounts& counts) {
  DirectLightSampler sampler(*traced.tracer, {});
  SampleFaults faults;
  Estimates estimates;
  for (std::uint32_t i = 0; i < count; ++i) {
    estimates.each.push_back(
        sampler.estimateTogether(lit, lights, samples, randomKey(61).with(i), counts, faults));
  }
  EXPECT_EQ(faults.count, 0u);
  return estimates;
}

TEST(ManyLights, HaveTheMeanOfEachInFull) {
  const ManyLights lamps(120);
  const TracedScene traced = lamps.builder.compile();
  ASSERT_EQ(traced.scene->lights.size(), lamps.all.size());
  const LitPoint lit = traced.litPoint({-0.2, 0.2, 0.1}, {1, -1, 0});
  glm::dvec2 expected(0.0);
  for (const std::uint32_t light : lamps.all) {
    const Estimates full = estimate(traced, lit, light, 4096, 16);
    expected +=
        glm::dvec2(meanInterval(full.irradiance(), 0.999).mean, meanInterval(redOfLobe(full), 0.999).mean);
  }
  RayCounts counts;
  const Estimates together = estimateTogether(traced, lit, lamps.all, 4, 16384, counts);
  expectUnbiased(together.irradiance(), expected.x, "irradiance", 0.01);
  expectUnbiased(redOfLobe(together), expected.y, "lobe", 0.02);
  // 4 x 8 rays, and one more at most for each light that has rays of its own.
  EXPECT_LT(counts.shadow, 2 * 32 * 16384u);
  EXPECT_GT(counts.shadow, 16 * 16384u);
}

/// Some can be seen and some cannot: the truth is another.
LightSight wrongSight(const TracedScene& traced) {
  std::vector<LightSight::Trial> trials;
  for (std::uint32_t light = 0; light < traced.scene->lights.size(); ++light) {
    const auto group = static_cast<std::uint32_t>(traced.scene->lightTree.groupOf(light));
    trials.insert(trials.end(), 20, {Vec3(0.0f), group, light % 3 == 0});
  }
  return {traced.scene->lightTree, trials};
}

TEST(ManyLights, HaveTheirMeanWhateverIsThoughtToBeSeenOfThem) {
  const ManyLights lamps(120);
  const TracedScene traced = lamps.builder.compile();
  const LightSight sight = wrongSight(traced);
  const LitPoint lit = traced.litPoint({-0.2, 0.2, 0.1}, {1, -1, 0});
  DirectLightSampler blind(*traced.tracer, {}), misled(*traced.tracer, {});
  misled.knowSight(&sight);
  RayCounts counts;
  SampleFaults faults;
  const auto means = [&](DirectLightSampler& sampler) {
    return blockMeans(64, 2048, [&](std::size_t block, std::size_t i) {
      const RandomKey key =
          randomKey(63).with(static_cast<std::uint32_t>(block)).with(static_cast<std::uint32_t>(i));
      return static_cast<double>(
          sampler.estimateTogether(lit, lamps.all, 4, key, counts, faults).irradiance.x);
    });
  };
  expectSameMean(means(misled), means(blind), "irradiance", 0.04);
  LightShares open, seen;
  open.weigh(*traced.scene, lit.surface.position, lit.surface.frame.z, nullptr);
  seen.weigh(*traced.scene, lit.surface.position, lit.surface.frame.z, &sight);
  EXPECT_NE(open.parts().size(), seen.parts().size()) << "it is heeded";
}

TEST(ManyLights, HaveTheirMeanOnPathsWhateverIsThoughtToBeSeenOfThem) {
  const ManyLights lamps(120);
  const TracedScene traced = lamps.builder.compile();
  const LightSight sight = wrongSight(traced);
  const auto means = [&](const LightSight* known) {
    PathBlocks paths(*traced.tracer, {}, {.origin = PathOrigin::Eye});
    paths.knowSight(known);
    paths.run(64, 16384, 64, [&](RandomKey, std::uint32_t) {
      return traced.ray({-0.2, 0.2, 0.1}, {1, -1, 0});
    });
    return paths.means([](const PathRadiance& r) { return r.direct.x; });
  };
  expectSameMean(means(&sight), means(nullptr), "radiance", 0.06);
}

TEST(ManyLights, AreDrawnByLotWhereTheyAreFaint) {
  const ManyLights lamps(120);
  const TracedScene traced = lamps.builder.compile();
  const LitPoint lit = traced.litPoint({-0.2, 0.2, 0.1}, {1, -1, 0});
  LightShares shares;
  shares.weigh(*traced.scene, lit.surface.position, lit.surface.frame.z, nullptr);
  double faint = 0.0;
  int isFaint = 0;
  for (const std::uint32_t light : lamps.all) {
    if (shares.areWorthVectorsOf(light)) continue;
    ++isFaint;
    faint += meanInterval(estimate(traced, lit, light, 4096, 16).irradiance(), 0.999).mean;
  }
  EXPECT_GT(isFaint, 60);
  EXPECT_LT(isFaint, 118) << "some are not";
  DirectLightSampler sampler(*traced.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  std::vector<double> sums;
  constexpr std::uint32_t kDraws = 16384;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    sums.push_back(static_cast<double>(
        sampler.estimateFaint(lit, lamps.all, shares, 4, randomKey(62).with(i), counts, faults)
            .irradiance.r));
  }
  expectUnbiased(sums, faint, "irradiance", 0.02);
  EXPECT_LT(counts.shadow, 32 * kDraws) << "the rays of their share, no more";
}

TEST(ManyLights, AreEachSampledWhereTheyAreFew) {
  const ManyLights lamps(kMostLightsInFull);
  const TracedScene traced = lamps.builder.compile();
  const LitPoint lit = traced.litPoint({-0.2, 0.2, 0.1}, {1, -1, 0});
  RayCounts counts;
  const DirectLightEstimate together = estimateTogether(traced, lit, lamps.all, 16, 1, counts).each.front();
  Rgb sum(0.0f);
  for (const std::uint32_t light : lamps.all)
    sum += estimate(traced, lit, light, 16, 1).each.front().irradiance;
  EXPECT_EQ(together.irradiance, sum);
}

// ---- the lobe's own samples ----

MaterialDescription metal(double roughness, LayerModel model = LayerModel::Ggx) {
  MaterialDescription m;
  m.layers.push_back({Rgb(0.9f, 0.6f, 0.3f), roughness, 1.0, model});
  return m;
}

/// A floor in y = 0 with a screen above it and a pane, below the lights of one kind.
struct GlossyFloor {
  SceneBuilder builder;
  std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));

  explicit GlossyFloor(const MaterialDescription& material) {
    builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, builder.material(material));
  }
  /// A black screen before a part of what the floor's middle mirrors, and a pane of glass before all of it.
  void addObstacles() {
    builder.rectangle({0.55, 0.5, -3}, {3, 0, 0}, {0, 0, 6}, builder.diffuse(Rgb(0.0f)));
    MaterialDescription pane;
    pane.transmission = Rgb(0.7f);
    pane.ior = 1.5;
    pane.thin = true;
    builder.rectangle({-3, 0.25, -3}, {6, 0, 0}, {0, 0, 6}, builder.material(pane));
  }
  /// The floor's middle, seen so that it mirrors (0.5, 0.5, 0).
  LitPoint middle(const TracedScene& traced) const { return traced.litPoint({-0.2, 0.2, 0}, {1, -1, 0}); }
};

struct LightKind {
  const char* name;
  std::function<void(GlossyFloor&)> add;
};

std::vector<LightKind> lightsWithAnExtent() {
  const auto sky = [](std::shared_ptr<const ImageRgb> pixels) {
    EnvironmentLightDescription light;
    light.radiance = Rgb(2.0f);
    light.pixels = std::move(pixels);
    return light;
  };
  return {{"rectangle",
           [](GlossyFloor& f) {
             f.builder.rectangle({0.6, 1, -0.5}, {0.9, 0, 0}, {0, 0, 1}, f.lamp);
           }},
          {"disc",
           [](GlossyFloor& f) {
             f.builder.disc({1, 1, 0}, {-1, -1, 0}, 0.5, f.lamp);
           }},
          {"sphere",
           [](GlossyFloor& f) {
             f.builder.sphere({1, 1, 0}, 0.4, f.lamp);
           }},
          {"mesh of many triangles",
           [](GlossyFloor& f) {
             std::vector<Vec3d> positions;
             std::vector<glm::uvec3> triangles;
             for (unsigned i = 0; i < 5; ++i) {
               for (unsigned j = 0; j < 5; ++j) {
                 positions.emplace_back(0.6 + 0.2 * i, 1.0 + 0.05 * ((i + j) % 2), -0.4 + 0.2 * j);
                 if (i == 4 || j == 4) continue;
                 const unsigned a = 5 * i + j;
                 triangles.emplace_back(a, a + 5, a + 6);
                 triangles.emplace_back(a, a + 6, a + 1);
               }
             }
             f.builder.mesh(std::move(positions), std::move(triangles), f.lamp);
           }},
          {"sun",
           [](GlossyFloor& f) {
             f.builder.light(DirectionalLightDescription{{-1, -1, 0}, Rgb(3.0f), 30.0});
           }},
          {"sky", [&](GlossyFloor& f) { f.builder.light(sky(nullptr)); }},
          {"pictured sky", [&](GlossyFloor& f) {
             auto pixels = std::make_shared<ImageRgb>(16, 8);
             for (int y = 0; y < 8; ++y) {
               for (int x = 0; x < 16; ++x)
                 pixels->at(x, y) = Rgb(0.2f + 0.3f * static_cast<float>((3 * x + 5 * y) % 7));
             }
             f.builder.light(sky(std::move(pixels)));
           }}};
}

/// A mesh of 128 triangles, of which those of the picture's bright half are pieces of a light.
LightKind glowingPart() {
  return {"mesh of which a part glows", [](GlossyFloor& f) {
            auto pixels = std::make_shared<ImageRgb>(8, 8, Rgb(0.0f));
            for (int y = 0; y < 8; ++y) {
              for (int x = 0; x < 5; ++x) pixels->at(x, y) = Rgb(0.25f + 0.1f * static_cast<float>(x));
            }
            SceneDescription& description = f.builder.description();
            ImageTextureDescription image;
            image.pixels = std::move(pixels);
            image.wrap = TextureWrap::Clamp;
            description.textures = {{"picture", std::move(image)}};
            description.materials[f.lamp].textures.emission = TextureUse{};
            MeshGeometry mesh;
            for (unsigned i = 0; i < 9; ++i) {
              for (unsigned j = 0; j < 9; ++j) {
                mesh.positions.emplace_back(0.6 + 0.1 * i, 1.0 + 0.02 * ((i + j) % 2), -0.4 + 0.1 * j);
                mesh.uvs.emplace_back(0.125f * static_cast<float>(i), 0.125f * static_cast<float>(j));
                if (i == 8 || j == 8) continue;
                const unsigned a = 9 * i + j;
                mesh.triangles.emplace_back(a, a + 9, a + 10);
                mesh.triangles.emplace_back(a, a + 10, a + 1);
              }
            }
            const MeshDescription placed{"", std::make_shared<const MeshGeometry>(std::move(mesh)), {}};
            description.shapes.push_back({"lamp", f.lamp, "", {}, placed});
          }};
}

// Both kinds of samples together have the mean of the light's alone, whatever stands between.
TEST(LobeSamples, ChangeNoMean) {
  std::vector<LightKind> kinds = lightsWithAnExtent();
  kinds.push_back(glowingPart());
  for (const LightKind& kind : kinds) {
    SCOPED_TRACE(kind.name);
    GlossyFloor floor(metal(0.3));
    floor.addObstacles();
    kind.add(floor);
    const TracedScene traced = floor.builder.compile();
    const LitPoint lit = floor.middle(traced);
    // Of a whole sky, few samples meet the lobe.
    const bool isSky = std::string(kind.name).find("sky") != std::string::npos;
    const Estimates alone = estimate(traced, lit, 0, isSky ? 8192 : 2048, 64, false);
    const Estimates both = estimate(traced, lit, 0, 512, 64);
    ASSERT_GT(meanInterval(redOfLobe(alone), 0.999).mean, 0.0);
    ASSERT_GT(both.each.front().rays, estimate(traced, lit, 0, 512, 1, false).each.front().rays + 50)
        << "the lobe is sampled";
    expectSameMean(redOfLobe(both), redOfLobe(alone), kind.name, 0.02);
    EXPECT_EQ(both.irradiance().front(), estimate(traced, lit, 0, 512, 1, false).irradiance().front())
        << "the irradiance is of the light's samples alone";
  }
}

// A lobe of a few degrees under a sky that is the same everywhere reflects its albedo's part of it.
TEST(LobeSamples, FindASkyInANarrowLobe) {
  for (const double roughness : {0.06, 0.2}) {
    GlossyFloor floor(metal(roughness));
    EnvironmentLightDescription sky;
    sky.radiance = Rgb(2.0f);
    floor.builder.light(sky);
    const TracedScene traced = floor.builder.compile();
    const LitPoint lit = floor.middle(traced);
    const Brdf& brdf = traced.scene->materials[lit.surface.material].brdf;
    const Vec3 outgoing = lit.surface.frame.toLocal(lit.outgoing);
    const double expected =
        static_cast<double>(brdf.directionalAlbedo(outgoing).x) * 2.0 / traced.unitRadiance();
    expectUnbiased(redOfLobe(estimate(traced, lit, 0, 64, 256)), expected,
                   fmt::format("roughness {}", roughness));
  }
}

// Narrow lobes have a tenth of the noise, or less; wide ones are left to the light's samples, which are
// strata.
TEST(LobeSamples, TakeTheNoiseOfLargeLights) {
  const auto deviation = [](const Estimates& estimates) {
    const std::vector<double> values = redOfLobe(estimates);
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) sum += square(value - mean);
    return std::sqrt(sum / static_cast<double>(values.size() - 1)) / mean;
  };
  for (const LightKind& kind : lightsWithAnExtent()) {
    for (const double roughness : {0.05, 0.1, 0.2, 0.3, 1.0}) {
      SCOPED_TRACE(fmt::format("{}, roughness {}", kind.name, roughness));
      GlossyFloor floor(metal(roughness));
      kind.add(floor);
      const TracedScene traced = floor.builder.compile();
      const LitPoint lit = floor.middle(traced);
      const double alone = deviation(estimate(traced, lit, 0, 16, 1024, false));
      const double both = deviation(estimate(traced, lit, 0, 16, 1024));
      if (roughness == 1.0) {
        EXPECT_EQ(both, alone);
      } else {
        // In as many rays in all: twice those of the light alone would take a factor of sqrt(2).
        EXPECT_LT(both * std::sqrt(2.0), alone);
        EXPECT_LT(both, 0.1);
        if (roughness <= 0.1) {
          EXPECT_LT(both, 0.1 * alone);
        }
      }
    }
  }
}

TEST(LobeSamples, WhatNoLobeCanMeetCostsNoRay) {
  GlossyFloor floor(metal(0.1));
  floor.builder.sphere({-1, 1, 0}, 0.1, floor.lamp);  // where the floor's middle is seen from
  const TracedScene traced = floor.builder.compile();
  const DirectLightEstimate e = estimate(traced, floor.middle(traced), 0, 16, 1).each.front();
  EXPECT_EQ(e.rays, 16);
}

TEST(DirectLight, MirroredLightIsTheImageTimesTheMirror) {
  SceneBuilder builder;
  const std::size_t floor = builder.diffuse(Rgb(0.5f));
  const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
  const std::size_t mirror = builder.mirror(Rgb(0.8f, 0.4f, 0.2f));
  builder.rectangle({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, floor);
  builder.sphere({1, 1, 0}, 0.4, lamp);
  builder.rectangle({0, 0, -3}, {0, 3, 0}, {0, 0, 6}, mirror);
  const TracedScene traced = builder.compile();
  const LitPoint lit = traced.litPoint({0.5, 0.1, 0.1}, {0, -1, 0});
  RayCounts counts;
  SampleFaults faults;
  TransportParameters off;
  off.mirroredLights = false;
  DirectLightSampler without(*traced.tracer, off);
  EXPECT_EQ(without.estimateMirrored(lit, 64, randomKey(1), counts, faults).irradiance, Rgb(0.0f));
  DirectLightSampler with(*traced.tracer, {});
  const double d2 = 1.5 * 1.5 + 1.0 + 0.01;
  for (int c = 0; c < 3; ++c) {
    const std::vector<double> blocks = blockMeans(64, 1, [&](std::size_t b, std::size_t) {
      const RandomKey key = randomKey(62).with(static_cast<std::uint32_t>(b));
      return static_cast<double>(with.estimateMirrored(lit, 64, key, counts, faults).irradiance[c]);
    });
    expectUnbiased(blocks,
                   (c == 0   ? 0.8
                    : c == 1 ? 0.4
                             : 0.2) *
                       2.0 / traced.unitRadiance() * kPiD * 0.16 / d2 / std::sqrt(d2),
                   "channel " + std::to_string(c));
  }
}

TEST(DirectLight, IsPure) {
  const Room room(grey());
  const TracedScene traced = room.builder.compile();
  const LitPoint a = traced.litPoint({0, 0.5, 0}, {0, -1, 0});
  const LitPoint b = traced.litPoint({1, 0.5, 1}, {0, -1, 0});
  DirectLightSampler sampler(*traced.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  const Rgb first = sampler.estimate(a, 0, 16, randomKey(1), counts, faults).irradiance;
  sampler.estimate(b, 0, 64, randomKey(2), counts, faults);
  EXPECT_EQ(sampler.estimate(a, 0, 16, randomKey(1), counts, faults).irradiance, first);
  EXPECT_NE(sampler.estimate(a, 0, 16, randomKey(3), counts, faults).irradiance, first);
}

// Half a degree is 1 - cos = 1e-5: a cosine in float would be off by 0.2 %.
TEST(Sun, OfHalfADegreeHasItsSolidAngle) {
  constexpr double kDegrees = 0.53;
  SceneBuilder builder;
  builder.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, builder.diffuse(Rgb(0.5f)));
  builder.light(DirectionalLightDescription{{0, -1, 0}, Rgb(3.0f), kDegrees});
  const TracedScene traced = builder.compile();
  const double sine = std::sin(0.25 * kDegrees * kPiD / 180.0);
  const double expected = 4.0 * kPiD * sine * sine;  // 2 pi (1 - cos(angle / 2))
  const DirectLightEstimate e =
      estimate(traced, traced.litPoint({0, 1, 0}, {0, -1, 0}), 0, 1, 1).each.front();
  EXPECT_NEAR(static_cast<double>(e.solidAngle), expected, 1e-6 * expected) << "a float's rounding is 6e-8";
}

}  // namespace
}  // namespace lightvane
