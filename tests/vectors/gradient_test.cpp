#include "core/vectors/validity.h"
#include "tests/trace/statistical.h"
#include "tests/vectors/hemispheres.h"
#include "tests/vectors/sunlit.h"

// Gradients: eq. 6 as printed, Ward and Heckbert's for this hemisphere, and what they are held against:
// closed forms, differences of exact irradiance, and differences with common random numbers.

namespace lightvane {
namespace {

using namespace vectors_test;

// ---- eq. 6 as printed ----

// Pins the print: nobody is to mend it. d theta / d(x, y, z) = (-cos theta cos phi, -cos theta sin phi,
// sin theta) / R, and dE/da = 2 pi / (M N) sum -L sin theta d theta / da.
TEST(PrintedGradient, IsEquation6) {
  const auto cellOf = [](const Vec3& d) {
    return GatherCell{{}, Rgb(1.0f + d.x, 0.5f, d.z * d.z), 1.0f + 0.5f * d.y};
  };
  const int rows = 12, columns = 24;
  const Hemisphere h = centredHemisphere(rows, columns, cellOf);
  glm::dvec3 expected[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};  // [colour]
  for (int j = 0; j < rows; ++j) {
    for (int k = 0; k < columns; ++k) {
      const double theta = std::acos((rows - j - 0.5) / rows);
      const double phi = 2.0 * kPiD * (k + 0.5) / columns;
      const GatherCell& cell = h.cell(j, k);
      const Vec3d change =
          Vec3d(-std::cos(theta) * std::cos(phi), -std::cos(theta) * std::sin(phi), std::sin(theta)) /
          static_cast<double>(cell.distance);
      for (int c = 0; c < 3; ++c) {
        expected[c] +=
            2.0 * kPiD / (rows * columns) * -static_cast<double>(cell.radiance[c]) * std::sin(theta) * change;
      }
    }
  }
  const IrradianceGradient gradient = printedGradient(h);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(glm::length(Vec3d(gradient.translation[c]) - expected[c]), 1e-5) << "colour " << c;
    EXPECT_EQ(gradient.rotation[c], Vec3(0.0f)) << "the paper knows none";
  }
}

TEST(PrintedGradient, OfMissesIsZeroAndOfTheZenithFinite) {
  Hemisphere h = centredHemisphere(4, 8, [](const Vec3&) { return GatherCell{{}, Rgb(1.0f), kInfinity}; });
  EXPECT_EQ(printedGradient(h).translation[0], Vec3(0.0f));
  h.cells[0] = {{0, 0, 1}, Rgb(1.0f), 1.0f};
  EXPECT_EQ(printedGradient(h).translation[0], Vec3(0.0f)) << "no sine, no change";
}

// Its normal component has the wrong sign: towards a bright ceiling it says darker.
TEST(PrintedGradient, SaysDarkerTowardsALight) {
  const Hemisphere h = centredHemisphere(12, 24, [](const Vec3& d) {
    return GatherCell{{}, d.z > 0.7f ? Rgb(1.0f) : Rgb(0.0f), d.z > 0.7f ? 1.0f / d.z : kInfinity};
  });
  EXPECT_LT(printedGradient(h).translation[0].z, -0.1f);
}

// ---- rotation ----

// Half of the hemisphere (x > 0) bright: turning the normal towards +x, a rotation about +y, brings in
// the integral of sin theta cos phi = pi / 2; about x nothing.
TEST(StratifiedGradient, RotationOfAHalfBrightHemisphere) {
  for (const auto& [rows, columns] : {std::pair(8, 16), {64, 128}}) {
    const Hemisphere h = centredHemisphere(rows, columns, [](const Vec3& d) {
      return GatherCell{{}, d.x > 0.0f ? Rgb(1.0f, 2.0f, 0.0f) : Rgb(0.0f), 1.0f};
    });
    const IrradianceGradient g = stratifiedGradient(h);
    // The midpoint rule over columns is off by (pi / N)^2 / 6 (x / sin x), over rows by about 0.2 / M^1.5.
    const float tolerance =
        0.5f * kPi *
        (square(kPi / static_cast<float>(columns)) / 6.0f + 0.3f / std::pow(static_cast<float>(rows), 1.5f));
    EXPECT_NEAR(g.rotation[0].y, 0.5f * kPi, tolerance) << rows << " x " << columns;
    EXPECT_NEAR(g.rotation[0].x, 0.0f, 1e-5f);
    EXPECT_EQ(g.rotation[0].z, 0.0f);
    EXPECT_NEAR(g.rotation[1].y, 2.0f * g.rotation[0].y, 1e-5f);
    EXPECT_EQ(g.rotation[2], Vec3(0.0f));
  }
}

// For light that is wholly above the horizon E = normal . Phi with Arvo's vector Phi, so that the rotation's
// gradient is normal x Phi. An unbiased estimate whatever M and N: 64 blocks of about 4096 cells in gathers
// of each size, 99.9 %, 3 %, sharp against 6 %. (At the columns' middles it was off by 21 and 3.2 %.)
TEST(StratifiedGradient, RotationIsUnbiasedForFewCellsToo) {
  Sunlit scene({0, 1, 0});
  scene.panel({0.2, 1, -0.4}, {0.9, 0, 0}, {0, 0, 0.7});
  scene.finish();
  const Vec3d point(0.1, 0.2, -0.1), normal(0, 1, 0);
  ASSERT_GT(scene.irradiance(point, normal), 0.0);
  const double expected = scene.turnSlope(point, normal, {0, 0, 1});
  for (const auto& [rows, columns] : {std::pair(2, 4), {4, 8}, {12, 24}}) {
    VectorParameters parameters;
    parameters.ilv.rows = rows;
    parameters.ilv.columns = columns;
    Gatherer gatherer(*scene.traced().tracer, Sunlit::transport(), parameters);
    const GatherPoint at{scene.traced().imaginaryPoint(point, normal, scene.grey(), normal), 0.01f};
    RayCounts counts;
    SampleFaults faults;
    std::uint64_t seed = 0;
    const int perBlock = 4096 / (rows * columns);
    const std::vector<double> blocks =
        trace_test::blockMeans(64, static_cast<std::size_t>(perBlock), [&](std::size_t, std::size_t) {
          return static_cast<double>(gatherer.gather(at, kLambertKey, seed++, counts, faults).rotation[0].z);
        });
    trace_test::expectUnbiased(blocks, expected, std::to_string(rows) + " x " + std::to_string(columns),
                               0.03);
  }
}

// ---- translation, against exact irradiance ----

struct Case {
  std::string name;
  Vec3d sun;
  std::vector<std::array<Vec3d, 3>> panels, screens;
  Vec3d point, normal;
  double error24, error96;  ///< relative error allowed with 24 x 48 cells and with 96 x 192
};

std::vector<Case> cases() {
  const Vec3d up(0, 1, 0), x(1, 0, 0), z(0, 0, 1);
  return {
      {"below a parallel rectangle, aside",
       up,
       {{Vec3d(0.2, 1, -0.5), x, z}},
       {},
       {0, 0, 0.2},
       up,
       0.07,
       0.025},
      {"near a parallel rectangle's edge",
       up,
       {{Vec3d(0, 0.4, -2), 2.0 * x, 4.0 * z}},
       {},
       {0.1, 0, 0},
       up,
       0.02,
       0.01},
      // The front is where u x v points: towards -x, to the sun.
      {"before a wall", x, {{Vec3d(0.5, -1, -1), 2.0 * z, 3.0 * up}}, {}, {0, 0.1, 0.1}, up, 0.2, 0.06},
      {"close to a wall", x, {{Vec3d(0.5, -1, -1), 2.0 * z, 3.0 * up}}, {}, {0.3, 0.1, 0.1}, up, 0.5, 0.16},
      // The sun shines obliquely, so that the screen's shadow misses the panel.
      {"below a rectangle that a screen hides in part",
       {-1, 0.3, 0},
       {{Vec3d(-0.5, 1, -0.5), x, z}},
       {{Vec3d(0.05, 0.5, -1), 0.6 * x, 2.0 * z}},
       {0, 0, 0.1},
       up,
       0.07,
       0.04},
      {"the same, tilted",
       {-1, 0.3, 0},
       {{Vec3d(-0.5, 1, -0.5), x, z}},
       {{Vec3d(0.05, 0.5, -1), 0.6 * x, 2.0 * z}},
       {0, 0, 0.1},
       glm::normalize(Vec3d(0.3, 1, 0.2)),
       0.06,
       0.04},
  };
}

Sunlit sunlit(const Case& c) {
  Sunlit scene(c.sun);
  for (const auto& p : c.panels) scene.panel(p[0], p[1], p[2]);
  for (const auto& s : c.screens) scene.screen(s[0], s[1], s[2]);
  scene.finish();
  return scene;
}

double relativeError(const Vec3d& estimate, const Vec3d& exact) {
  return glm::length(estimate - exact) / glm::length(exact);
}

// The estimate takes a sample's distance for that of its cell's whole border, so that it is off by an error
// in proportion to 1 / M. Measured with 12, 24, 48, 96 rows: 11, 5.3, 2.2, 1.0 % below a rectangle, 30, 16,
// 8.8, 4.4 % before a wall, 74, 43, 23, 12 % close to one (always too much: that is why extrapolation is
// clamped), with standard errors of 0.1 to 0.8 %. The bounds below are these and a third more; four standard
// errors are added. Rotation and irradiance are unbiased: 1 %.
TEST(StratifiedGradient, ConvergesToDifferencesOfExactIrradiance) {
  for (const Case& c : cases()) {
    const Sunlit scene = sunlit(c);
    const Frame frame = Frame::aboutNormal(Vec3(c.normal));
    Vec3d translation(0.0), rotation(0.0);
    for (const Vec3d& t : {Vec3d(frame.x), Vec3d(frame.y)}) {
      translation += scene.slope(c.point, c.normal, t) * t;
      rotation += scene.turnSlope(c.point, c.normal, t) * t;
    }
    double errors[2];
    for (const int rows : {24, 96}) {
      IlvParameters ilv;
      ilv.rows = rows;
      ilv.columns = 2 * rows;
      const Sunlit::Mean mean = scene.gathers(c.point, c.normal, ilv, rows == 24 ? 160 : 10);
      const std::string what = c.name + ", " + std::to_string(rows) + " rows";
      const double exact = scene.irradiance(c.point, c.normal);
      EXPECT_NEAR(mean.irradiance, exact, 0.01 * exact) << what;
      EXPECT_LT(glm::length(mean.rotation - rotation),
                0.01 * glm::length(rotation) + 4.0 * glm::length(mean.rotationError))
          << what;
      errors[rows == 24 ? 0 : 1] = relativeError(mean.gradient, translation);
      const double noise = glm::length(mean.gradientError) / glm::length(translation);
      EXPECT_LT(relativeError(mean.gradient, translation), (rows == 24 ? c.error24 : c.error96) + 4.0 * noise)
          << what << ": standard error " << noise;
      EXPECT_NEAR(glm::dot(mean.gradient, c.normal), 0.0, 1e-6 * glm::length(mean.gradient))
          << what << ": tangent plane only";
    }
    if (c.error24 > 0.1) {
      EXPECT_LT(errors[1], 0.5 * errors[0]) << c.name << ": does not converge";
    }
    // As printed it is another thing, and stays so however many cells there are.
    IlvParameters printed;
    printed.rows = 48;
    printed.columns = 96;
    printed.gradient = IlvGradient::Printed;
    EXPECT_GT(relativeError(scene.gathers(c.point, c.normal, printed, 4).gradient, translation), 0.3)
        << c.name;
  }
}

// The gradient of the open sky and of a uniform surrounding at any distance is zero: walls between equal
// cells carry nothing.
TEST(StratifiedGradient, OfUniformLightIsZero) {
  for (const float distance : {0.5f, kInfinity}) {
    const Hemisphere h = centredHemisphere(12, 24, [&](const Vec3& d) {
      return GatherCell{{}, Rgb(3.0f), distance * (1.0f + 0.5f * d.x)};
    });
    const IrradianceGradient g = stratifiedGradient(h);
    EXPECT_EQ(g.translation[0], Vec3(0.0f));
    EXPECT_LT(glm::length(g.rotation[0]), 1e-5f);
  }
}

// ---- translation, against differences with common random numbers, with all reflections ----

// A room in which a block hides part of a lit wall: what arrives was reflected any number of times, off walls
// whose radiance is not constant. 24 blocks of 64 x 128 paths at each of 4 places, 99 %, against 32 gathers
// of 64 x 128: 15 % and three standard errors of both.
TEST(StratifiedGradient, AgreesWithDifferencesOfGathersInARoom) {
  trace_test::SceneBuilder builder;
  const std::size_t wall = builder.diffuse(Rgb(0.6f));
  const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(4.0f));
  builder.closedCube(wall);
  // A lamp beside the far wall, and a block between it and the point.
  builder.rectangle({0.9, 0.3, 0.3}, {0, 0, 0.4}, {0, 0.4, 0}, lamp);
  builder.box({0.45, 0.0, 0.2}, {0.55, 0.35, 0.8}, wall);
  const trace_test::TracedScene traced = builder.compile();
  const LitPoint here = traced.litPoint({0.3, 0.1, 0.55}, {0, -1, 0});
  const TransportParameters transport;
  RadianceEstimator estimator(*traced.tracer, transport, {.origin = PathOrigin::Surface});
  RayCounts counts;
  SampleFaults faults;
  constexpr int kRows = 64, kColumns = 128;
  const auto irradiance = [&](const Vec3& offset, std::size_t block) {
    const RandomKey key = randomKey(101).with(static_cast<std::uint32_t>(block));
    std::vector<PathStart> starts;
    std::vector<float> cosines;
    for (std::uint32_t i = 0; i < kRows * kColumns; ++i) {
      const Vec2 u = uniform2(key, i, 0);
      const float cosine = (static_cast<float>(i / kColumns) + u.x) / kRows;
      const float phi = kTwoPi * (static_cast<float>(i % kColumns) + u.y) / kColumns;
      const float sine = std::sqrt(1.0f - cosine * cosine);
      const Vec3 direction = here.surface.frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine});
      starts.push_back(
          {{here.surface.originTowards(direction) + offset, direction, 0.0f, kInfinity}, key, i});
      cosines.push_back(cosine);
    }
    std::vector<PathRadiance> results(starts.size());
    estimator.estimate(starts, results, Coherence::Coherent, counts.gather, counts, faults);
    double sum = 0.0;
    for (std::size_t i = 0; i < starts.size(); ++i)
      sum += static_cast<double>(results[i].indirect.x * cosines[i]);
    return sum * 2.0 * kPiD / static_cast<double>(starts.size());
  };
  VectorParameters parameters;
  parameters.ilv.rows = 64;
  parameters.ilv.columns = 128;
  Gatherer gatherer(*traced.tracer, transport, parameters);
  Vec3d gradient(0.0);
  constexpr int kGathers = 32;
  for (int i = 0; i < kGathers; ++i) {
    const auto r = gatherer.gather({here, 0.01f}, kLambertKey, static_cast<std::uint64_t>(i), counts, faults);
    gradient += Vec3d(r.gradient[0]) / double(kGathers);
  }
  const Vec3 along(1, 0, 0);
  const DerivativeEstimate difference = centralDifference(
      [&](double x, std::size_t block) { return irradiance(static_cast<float>(x) * along, block); }, 0.0,
      0.01, 24, 0.99);
  EXPECT_GT(std::abs(difference.value.mean), 6.0 * difference.value.standardError)
      << "too noisy to compare with";
  const double tolerance =
      0.15 * std::abs(difference.value.mean) + 3.0 * difference.value.standardError + difference.truncation;
  EXPECT_NEAR(gradient.x, difference.value.mean, tolerance)
      << "noise " << difference.value.standardError << ", truncation " << difference.truncation;
  RecordProperty("gradient", std::to_string(gradient.x));
  RecordProperty("difference", std::to_string(difference.value.mean) + " +- " +
                                   std::to_string(difference.value.standardError) + ", truncation " +
                                   std::to_string(difference.truncation));
}

float ilvExtrapolateAt(const IndirectLightVector& r, const Sunlit& scene, const Vec3d& point,
                       const Vec3& normal) {
  return ilvExtrapolate(r, scene.traced().point(point), normal, IlvParameters{}).x;
}

// What it is for: extrapolation is better than none, near by, in every case above.
TEST(StratifiedGradient, ExtrapolatesTowardsTheTruth) {
  for (const Case& c : cases()) {
    const Sunlit scene = sunlit(c);
    VectorParameters parameters;
    parameters.ilv.rows = 24;
    parameters.ilv.columns = 48;
    Gatherer gatherer(*scene.traced().tracer, Sunlit::transport(), parameters);
    const GatherPoint at{scene.traced().imaginaryPoint(c.point, c.normal, scene.grey(), c.normal), 0.01f};
    RayCounts counts;
    SampleFaults faults;
    const Frame frame = Frame::aboutNormal(Vec3(c.normal));
    double plain = 0.0, moved = 0.0, straightTurn = 0.0, turned = 0.0;
    std::vector<IndirectLightVector> records;
    for (std::uint64_t seed = 0; seed < 64; ++seed) {
      records.push_back(gatherer.gather(at, kLambertKey, seed, counts, faults));
    }
    // Of the mean over the seeds, so that a gather's noise does not count.
    const auto add = [&](double& stay, double& go, const Vec3d& to, const Vec3& normal) {
      const double there = scene.irradiance(to, Vec3d(normal));
      double same = 0.0, extrapolated = 0.0;
      for (const IndirectLightVector& r : records) {
        same += static_cast<double>(r.energy.x) / static_cast<double>(records.size());
        extrapolated +=
            static_cast<double>(ilvExtrapolateAt(r, scene, to, normal)) / static_cast<double>(records.size());
      }
      stay += std::abs(same - there);
      go += std::abs(extrapolated - there);
    };
    for (const Vec3& t : {frame.x, -frame.x, frame.y, -frame.y}) {
      add(plain, moved, c.point + 0.05 * Vec3d(t), Vec3(c.normal));
      add(straightTurn, turned, c.point, glm::normalize(Vec3(c.normal) + 0.1f * t));
    }
    EXPECT_LT(moved, 0.6 * plain) << c.name << ": moved by 0.05";
    EXPECT_LT(turned, 0.6 * straightTurn) << c.name << ": turned by 0.1";
  }
}

// Where an edge is met exactly, rays into the other face end where they begin.
TEST(StratifiedGradient, IsANumberInAnEdge) {
  const Hemisphere h = centredHemisphere(6, 12, [](const Vec3& d) {
    const bool isOtherFace = d.x > 0.3f;
    return GatherCell{{}, Rgb(1.0f + d.y), isOtherFace ? (d.y > 0.0f ? 0.0f : -0.0f) : 1.0f};
  });
  const IrradianceGradient gradient = stratifiedGradient(h);
  for (int c = 0; c < 3; ++c) {
    EXPECT_TRUE(isFinite(gradient.translation[c])) << c;
    EXPECT_TRUE(isFinite(gradient.rotation[c])) << c;
  }
}

}  // namespace
}  // namespace lightvane
