#include "tests/support/radiosity.h"

#include <algorithm>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/cornell.h"
#include "tests/support/statistics.h"

namespace lightvane {
namespace {

constexpr double kSolverRounding = 1e-11;

// Coarse enough to be instant, for scenes whose answer does not depend on it.
constexpr RadiositySettings kInstant{
    .elementSize = 0.3, .creaseSize = 0.1, .solveRays = 256, .gatherRays = 4096};

// Twice as coarse as the default.
constexpr RadiositySettings kCoarse{
    .elementSize = 0.24, .creaseSize = 0.03, .solveRays = 512, .gatherRays = 1 << 14};

struct Query {
  const char* polygon;
  Vec3d point, normal;
};

// Places in the Cornell box from easy to hard: open, in penumbra, in corners, between the blocks, beside the
// light, and 8 mm from where a block's edge meets the floor.
std::vector<Query> cornellQueries(const PolygonScene& scene) {
  const auto at = [&](const char* name, const Vec3d& toward, double fraction) {
    const std::size_t polygon = scene.indexOf(name);
    const Vec3d centre = scene.centroid(polygon);
    return Query{name, centre + (toward - centre) * fraction, scene.normal(polygon)};
  };
  const auto corner = [&](const char* name, std::size_t index) {
    return scene.polygons()[scene.indexOf(name)].vertices[index];
  };
  return {
      at("floor", corner("floor", 0), 0.0),     at("floor", corner("floor", 0), 0.9),
      at("back", corner("back", 1), 0.9),       at("ceiling", corner("ceiling", 2), 0.97),
      at("right", corner("right", 0), 0.5),     at("left_b", corner("left_b", 0), 0.0),
      at("short_0", corner("short_0", 1), 0.9), at("short_1", corner("short_1", 0), 0.9),
      at("short_3", corner("short_3", 0), 0.9), at("short_4", corner("short_4", 2), 0.5),
      at("tall_3", corner("tall_3", 0), 0.9),   at("tall_4", corner("tall_4", 0), 0.0),
  };
}

double largest(const Vec3d& v) { return std::max({v.x, v.y, v.z}); }

TEST(Radiosity, OfAFurnaceIsExact) {
  const Vec3d reflectance(0.2, 0.5, 0.9), emission(1.0, 3.0, 0.1);
  const RadiositySolution solution{PolygonScene(furnaceCube(reflectance, emission)), kInstant};
  const Vec3d direct = kPiD * emission;
  const Vec3d indirect = direct * reflectance / (1.0 - reflectance);
  const std::vector<std::pair<Vec3d, Vec3d>> queries = {
      {{0.5, 0.5, 0.0}, {0, 0, 1}},
      {{1.0, 0.01, 0.999}, {-1, 0, 0}},
      {{0.3, 0.4, 0.6}, glm::normalize(Vec3d(1, 2, -3))},
      {{1e-6, 1e-6, 1e-6}, glm::normalize(Vec3d(1, 1, 1))},
  };
  for (const auto& [point, normal] : queries) {
    const IrradianceParts parts = solution.irradianceAt(point, normal);
    EXPECT_LT(largest(glm::abs(parts.direct / direct - 1.0)), kSolverRounding) << "at " << point.x;
    EXPECT_LT(largest(glm::abs(parts.indirect / indirect - 1.0)), kSolverRounding) << "at " << point.x;
  }
  EXPECT_LT(largest(glm::abs(solution.meanIndirect() / indirect - 1.0)), kSolverRounding);
}

TEST(Radiosity, OfAFurnaceWithUnlikeWallsIsUniform) {
  // Walls that emit what they fail to reflect, e = L (1 - rho), make a uniform field of radiance L.
  std::vector<DiffusePolygon> walls = furnaceCube(Vec3d(0.0), Vec3d(0.0));
  const double radiance = 2.0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    walls[i].reflectance = Vec3d(0.15, 0.1, 0.05) * static_cast<double>(i);
    walls[i].emission = radiance * (1.0 - walls[i].reflectance);
  }
  const RadiositySolution solution{PolygonScene(walls), kCoarse};
  for (const auto& [point, normal] : {std::pair(Vec3d(0.1, 0.9, 0.0), Vec3d(0, 0, 1)),
                                      std::pair(Vec3d(0.7, 0.2, 0.5), glm::normalize(Vec3d(1, 1, -3)))}) {
    const Vec3d total = solution.irradianceAt(point, normal).total();
    // Only the total is uniform: direct and indirect light vary over the walls, and linear elements follow
    // the indirect part to some 1e-4 at this coarse setting.
    EXPECT_LT(largest(glm::abs(total / (kPiD * radiance) - 1.0)), 5e-4)
        << total.x << " " << total.y << " " << total.z;
  }
}

TEST(Radiosity, BetweenClosePlatesIsTheGeometricSeries) {
  // Two plates of 1 x 1 at a distance of 1e-3: in their middle all but (2e-3)² of the hemisphere is the other
  // plate.
  const Vec3d lowerReflectance(0.8), upperReflectance(0.5), lowerEmission(1.0), upperEmission(3.0);
  const double gap = 1e-3;
  const PolygonScene scene({
      {"lower", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, lowerReflectance, lowerEmission},
      {"upper", {{0, 0, gap}, {0, 1, gap}, {1, 1, gap}, {1, 0, gap}}, upperReflectance, upperEmission},
  });
  const RadiositySolution solution(scene, kInstant);
  // B_lower = pi e_lower + rho_lower B_upper, and the other way round; irradiance is the other plate's B.
  const Vec3d upperRadiosity =
      kPiD * (upperEmission + upperReflectance * lowerEmission) / (1.0 - lowerReflectance * upperReflectance);
  const IrradianceParts parts = solution.irradianceAt({0.5, 0.5, 0}, {0, 0, 1});
  EXPECT_NEAR(parts.direct.x / (kPiD * upperEmission.x), 1.0, 2.0 * square(2.0 * gap));
  EXPECT_NEAR(parts.total().x / upperRadiosity.x, 1.0, 10.0 * square(2.0 * gap));
}

TEST(Radiosity, OfOneBounceMatchesIntegration) {
  // A lamp shines down on a grey table. From above the lamp's plane, to its side, no light is seen straight.
  const DiffusePolygon lamp{"lamp", {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, Vec3d(0.0), Vec3d(2.0)};
  const DiffusePolygon table{"table", {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, Vec3d(0.6)};
  const RadiositySolution solution(PolygonScene({lamp, table}), RadiositySettings{});
  const Vec3d point(1.4, 0.6, 1.2), down(0, 0, -1);
  const PolygonScene lampAlone({lamp});
  constexpr int kPoints = 200;
  double expected = 0.0;
  for (int i = 0; i < 2 * kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Vec3d y((i + 0.5) / kPoints, (j + 0.5) / kPoints, 0.0);
      // The lamp's plate hides part of the table from this point above it.
      const double crossing = (1.2 - 1.0) / 1.2;
      const Vec3d onLamp = point + (y - point) * crossing;
      if (onLamp.x > 0 && onLamp.x < 1 && onLamp.y > 0 && onLamp.y < 1) continue;
      const Vec3d away = point - y;
      const double cosine = away.z / glm::length(away);
      expected += 0.6 * lampAlone.directIrradiance(y, {0, 0, 1}).x * square(cosine) /
                  (kPiD * glm::dot(away, away)) / square(static_cast<double>(kPoints));
    }
  }
  const IrradianceParts parts = solution.irradianceAt(point, down);
  EXPECT_EQ(parts.direct.x, 0.0);
  // The sum over 80000 cells and the rays' 65536 resolve the lamp's outline alike, to some 1e-5.
  EXPECT_NEAR(parts.indirect.x / expected, 1.0, 1e-4);
}

TEST(Radiosity, TwoSidedPolygonsReflectOnBothSides) {
  // A white plate, two-sided, leaves the uniform field of a furnace as it is; a one-sided one swallows light.
  std::vector<DiffusePolygon> polygons = furnaceCube(Vec3d(0.5), Vec3d(1.0));
  polygons.push_back(
      {"plate", {{0.3, 0.3, 0.5}, {0.7, 0.3, 0.5}, {0.7, 0.7, 0.5}, {0.3, 0.7, 0.5}}, Vec3d(1.0)});
  constexpr RadiositySettings settings{
      .elementSize = 0.24, .creaseSize = 0.1, .solveRays = 256, .gatherRays = 8192};
  polygons.back().twoSided = true;
  const RadiositySolution twoSided(PolygonScene(polygons), settings);
  polygons.back().twoSided = false;
  const RadiositySolution oneSided(PolygonScene(polygons), settings);
  const double field = kPiD / (1.0 - 0.5);
  for (const auto& [point, normal] : {std::pair(Vec3d(0.5, 0.5, 0), Vec3d(0, 0, 1)),
                                      {Vec3d(0.5, 0.5, 1), Vec3d(0, 0, -1)},
                                      {Vec3d(0.4, 0.5, 0.5), Vec3d(0, 0, 1)},
                                      {Vec3d(0.4, 0.5, 0.5), Vec3d(0, 0, -1)}}) {
    // The lattice's 8192 rays resolve the plate's outline to some 1e-4, and the elements the rest to as much.
    EXPECT_NEAR(twoSided.irradianceAt(point, normal).total().x / field, 1.0, 1e-3)
        << point.z << " " << normal.z;
  }
  // Below the plate, whose back is black, at least what the back would have sent is missing.
  const double formFactor = twoSided.scene().visibleFormFactor({0.5, 0.5, 1}, {0, 0, -1}, 6);
  const double below = oneSided.irradianceAt({0.5, 0.5, 0}, {0, 0, 1}).total().x;
  EXPECT_LT(below / field, 1.0 - 0.9 * formFactor);
}

TEST(Radiosity, IsDeterministic) {
  const auto solve = [] {
    return RadiositySolution(PolygonScene(furnaceCube(Vec3d(0.3, 0.6, 0.9), Vec3d(1.0))), kInstant)
        .irradianceAt({0.2, 0.3, 0.4}, {0, 1, 0});
  };
  const IrradianceParts first = solve(), second = solve();
  EXPECT_EQ(first.indirect, second.indirect);
  EXPECT_EQ(first.direct, second.direct);
}

TEST(RadiosityOfCornell, BalancesEnergy) {
  // With the front closed by a black polygon, all light ends: what is reflected first equals what is absorbed
  // later,
  //   sum of A rho E_direct = sum of A (1 - rho) E_indirect.
  // The left side follows from the light alone, by exact form factors from points on it.
  std::vector<DiffusePolygon> polygons = cornellBox();
  polygons.push_back(cornellFront());
  const RadiositySolution solution{PolygonScene(polygons), kCoarse};
  const PolygonScene& scene = solution.scene();
  const std::size_t light = scene.indexOf("light");
  Vec3d reflected(0.0), absorbed(0.0);
  constexpr int kPoints = 8;
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    double formFactor = 0.0;
    for (int j = 0; j < kPoints * kPoints; ++j) {
      const std::vector<Vec3d>& v = polygons[light].vertices;
      const Vec3d point = v[0] + (v[1] - v[0]) * ((j % kPoints + 0.5) / kPoints) +
                          (v[3] - v[0]) * ((j / kPoints + 0.5) / kPoints);
      formFactor +=
          scene.visibleFormFactor(point, scene.normal(light), i) / square(static_cast<double>(kPoints));
    }
    reflected += polygons[i].reflectance * polygons[light].emission * (kPiD * scene.area(light) * formFactor);
    absorbed += (1.0 - polygons[i].reflectance) * solution.meanIndirect(i) * scene.area(i);
  }
  const Vec3d imbalance = absorbed / reflected - 1.0;
  // Measured 8e-4, and 2.3e-4 at the default settings.
  EXPECT_LT(largest(glm::abs(imbalance)), 2e-3)
      << fmt::format("{} {} {}", imbalance.x, imbalance.y, imbalance.z);
}

TEST(RadiosityOfCornell, ConvergesToThreePerMille) {
  const RadiositySolution solution{PolygonScene(cornellBox())};
  const RadiositySolution coarse{PolygonScene(cornellBox()), kCoarse};
  const Vec3d mean = solution.meanIndirect();
  double squares = 0.0;
  const std::vector<Query> queries = cornellQueries(solution.scene());
  for (const Query& query : queries) {
    const Vec3d fine = solution.irradianceAt(query.point, query.normal).indirect;
    const Vec3d change = (coarse.irradianceAt(query.point, query.normal).indirect - fine) / mean;
    squares += square(largest(glm::abs(change)));
    // Linear elements are of second order: halving their size leaves a quarter of the error, so that a change
    // of 3 t means an error of t. t is 0.3 % of the mean at every point, and 0.1 % in the root mean square.
    EXPECT_LT(largest(glm::abs(change)), 3 * 0.003) << query.polygon;
  }
  EXPECT_LT(std::sqrt(squares / static_cast<double>(queries.size())), 3 * 0.001);
}

// One sample of the indirect irradiance: a random walk with direct light collected wherever it reflects.
double randomWalk(const PolygonScene& scene, const Query& query, RandomKey key, std::uint32_t sample) {
  Vec3d point = query.point, normal = query.normal;
  double throughput = 1.0, sum = 0.0;
  for (std::uint32_t bounce = 0;; ++bounce) {
    const double radiusSquared = uniform(key, sample, 3 * bounce);
    const double angle = 2.0 * kPiD * uniform(key, sample, 3 * bounce + 1);
    const Vec3d x =
        glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
    const Vec3d y = glm::cross(normal, x);
    const Vec3d direction = std::sqrt(radiusSquared) * (std::cos(angle) * x + std::sin(angle) * y) +
                            std::sqrt(1.0 - radiusSquared) * normal;
    const auto hit = scene.nearestHit(point, direction);
    if (!hit || !hit->front) return sum;
    // Russian roulette with the reflectance, but for the first bounces, whose light counts most.
    const double reflectance = scene.polygons()[hit->polygon].reflectance.x;
    if (bounce < 2) {
      throughput *= reflectance;
    } else if (uniform(key, sample, 3 * bounce + 2) >= reflectance) {
      return sum;
    }
    if (throughput == 0.0) return sum;
    point = hit->point;
    normal = scene.normal(hit->polygon);
    sum += throughput * scene.directIrradiance(point, normal).x;
  }
}

TEST(RadiosityOfCornell, AgreesWithRandomWalks) {
  const RadiositySolution solution{PolygonScene(cornellBox()), kCoarse};
  const std::vector<Query> queries = cornellQueries(solution.scene());
  constexpr std::size_t kBlocks = 40;
  constexpr std::uint32_t kWalks = 1000;  // a block and place
  const double places = static_cast<double>(queries.size());
  double expected = 0.0;
  std::vector<double> blocks(kBlocks, 0.0);
  for (const Query& query : queries) {
    expected += solution.irradianceAt(query.point, query.normal).indirect.x / places;
    for (std::size_t block = 0; block < kBlocks; ++block) {
      const RandomKey key = randomKey(17).with(static_cast<std::uint32_t>(block)).with(Vec3(query.point));
      for (std::uint32_t walk = 0; walk < kWalks; ++walk) {
        blocks[block] += randomWalk(solution.scene(), query, key, walk) / (kWalks * places);
      }
    }
  }
  // 480000 walks, each with a standard deviation of about its mean, know the mean to 0.15 %.
  const BiasTest::Result result = BiasTest{0.01}.againstValue(blocks, expected);
  EXPECT_TRUE(result.passes()) << result.explanation;
}

}  // namespace
}  // namespace lightvane
