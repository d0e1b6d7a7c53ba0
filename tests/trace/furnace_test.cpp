#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// A closed room whose walls all emit e and reflect rho: radiance is e / (1 - rho) everywhere. Whatever loses
// or adds light shows.
//
// Budget of each statistical test here: 64 blocks of 1,024 paths and a tolerance of 2 % (the parts), or as
// stated; 99.9 % confidence; sharp against twice the tolerance, or 1 % (expectUnbiased).

namespace lightvane {
namespace {

using namespace trace_test;

const Rgb kReflectance(0.3f, 0.4f, 0.5f);
const Rgb kEmission(1.0f, 0.5f, 0.25f);

struct Furnace {
  TracedScene traced;
  std::size_t wall = 0;
};

Furnace furnace(const std::string& light, const Rgb& reflectance = kReflectance) {
  SceneBuilder builder;
  const std::size_t wall = builder.diffuse(reflectance, kEmission);
  builder.closedCube(wall, light);
  return {builder.compile(), wall};
}

PathBlocks follow(const TracedScene& traced, const TransportParameters& transport,
                  const EstimatorOptions& options, std::size_t blocks = 64, std::size_t samples = 1024) {
  PathBlocks paths(*traced.tracer, transport, options);
  // From an off-centre place, in all directions: both meet walls near and far.
  const Vec3 origin = traced.point({0.3, 0.6, 0.2});
  paths.run(blocks, samples, 41, [&](RandomKey key, std::uint32_t sample) {
    return Ray{origin, uniformDirection(uniform2(key, sample, 100)), 0.0f, kInfinity};
  });
  EXPECT_EQ(paths.faults.count, 0u);
  return paths;
}

double channel(const Rgb& c, int i) { return static_cast<double>(c[i]); }

// Six lights: one is chosen at each vertex; one light of six faces: its pieces are. And several samples each.
TEST(Furnace, IsSeenByTheEyeInItsLayers) {
  for (const char* light : {"", "walls"}) {
    for (const int bounceSamples : {1, 3}) {
      const Furnace f = furnace(light);
      ASSERT_EQ(f.traced.scene->lights.size(), *light == '\0' ? 6u : 1u);
      TransportParameters transport;
      transport.bounceLightSamples = bounceSamples;
      const PathBlocks paths = follow(f.traced, transport, {.origin = PathOrigin::Eye});
      for (int c = 0; c < 3; ++c) {
        const double e = channel(kEmission, c) / f.traced.unitRadiance();
        const double rho = channel(kReflectance, c);
        const std::string what =
            std::to_string(f.traced.scene->lights.size()) + " lights, channel " + std::to_string(c);
        for (const auto& block : paths.results) {
          for (const PathRadiance& r : block) ASSERT_NEAR(r.emission[c], e, 1e-6 * e) << what;
        }
        expectUnbiased(paths.means([&](const PathRadiance& r) { return r.direct[c]; }), e * rho,
                       what + ", direct", 0.02);
        expectUnbiased(paths.means([&](const PathRadiance& r) { return r.indirect[c]; }),
                       e * rho * rho / (1.0 - rho), what + ", indirect", 0.03);
        expectUnbiased(paths.means([&](const PathRadiance& r) { return r.total()[c]; }), e / (1.0 - rho),
                       what + ", total", 0.009);
        EXPECT_EQ(paths.means([&](const PathRadiance& r) { return r.specular[c]; }).front(), 0.0);
      }
    }
  }
}

// Light met straight is the origin's direct light: left out, or all of it.
TEST(Furnace, SeenFromASurfaceLeavesStraightLightOut) {
  const Furnace f = furnace("walls");
  for (const bool straight : {false, true}) {
    const PathBlocks paths = follow(f.traced, {}, {.origin = PathOrigin::Surface, .straightLight = straight});
    for (int c = 0; c < 3; ++c) {
      const double e = channel(kEmission, c) / f.traced.unitRadiance();
      const double rho = channel(kReflectance, c);
      for (const auto& block : paths.results) {
        for (const PathRadiance& r : block) {
          ASSERT_NEAR(r.direct[c], straight ? e : 0.0, 1e-6 * e);
          ASSERT_EQ(r.emission[c], 0.0f);
          ASSERT_EQ(r.specular[c], 0.0f);
        }
      }
      expectUnbiased(paths.means([&](const PathRadiance& r) { return r.indirect[c]; }), e * rho / (1.0 - rho),
                     "channel " + std::to_string(c), 0.03);
    }
  }
}

// Light reflected 1 to k times is e (rho + ... + rho^k): what is lost is rho^k of the indirect light, and
// nothing of what remains.
TEST(Furnace, LosesExactlyWhatIsReflectedMoreOftenThanTheLimit) {
  const Furnace f = furnace("walls");
  for (const bool roulette : {false, true}) {
    for (int limit = 1; limit <= (roulette ? 2 : 4); ++limit) {
      TransportParameters transport;
      transport.maxBounces = limit;
      transport.roulette = roulette;
      const PathBlocks paths = follow(f.traced, transport, {.origin = PathOrigin::Surface});
      for (int c = 0; c < 3; ++c) {
        const double e = channel(kEmission, c) / f.traced.unitRadiance();
        const double rho = channel(kReflectance, c);
        const double all = e * rho / (1.0 - rho);
        expectUnbiased(paths.means([&](const PathRadiance& r) { return r.indirect[c]; }),
                       all * (1.0 - std::pow(rho, limit)),
                       "limit " + std::to_string(limit) + ", channel " + std::to_string(c) +
                           (roulette ? ", roulette" : ", no roulette"),
                       0.02);
      }
    }
  }
}

TEST(Furnace, LimitCountsReflectionsBeforeTheVisiblePointsOwn) {
  const Furnace f = furnace("walls");
  TransportParameters transport;
  transport.maxBounces = 2;
  const PathBlocks paths = follow(f.traced, transport, {.origin = PathOrigin::Eye});
  for (int c = 0; c < 3; ++c) {
    const double e = channel(kEmission, c) / f.traced.unitRadiance();
    const double rho = channel(kReflectance, c);
    expectUnbiased(paths.means([&](const PathRadiance& r) { return r.total()[c]; }),
                   e * (1.0 + rho + rho * rho + rho * rho * rho), "channel " + std::to_string(c), 0.009);
  }
}

TEST(Furnace, RouletteChangesNoMean) {
  // 12 reflections at 0.5 leave 2e-4: no limit to speak of, and an end without roulette.
  const Furnace f = furnace("walls");
  TransportParameters without;
  without.roulette = false;
  without.maxBounces = 12;
  const PathBlocks ended = follow(f.traced, {}, {.origin = PathOrigin::Surface});
  const PathBlocks all = follow(f.traced, without, {.origin = PathOrigin::Surface}, 64, 256);
  EXPECT_LT(ended.counts.bounce, all.counts.bounce) << "roulette ends nothing";
  for (int c = 0; c < 3; ++c) {
    const auto part = [c](const PathRadiance& r) { return r.indirect[c]; };
    expectSameMean(ended.means(part), all.means(part), "channel " + std::to_string(c), 0.03);
  }
}

// Every path ends, whatever the parameters and however white the walls: with them the light has no limit.
TEST(Furnace, OfPerfectlyWhiteWallsEnds) {
  const Furnace white = furnace("walls", Rgb(1.0f));
  const PathBlocks paths = follow(white.traced, {}, {.origin = PathOrigin::Surface}, 2, 64);
  EXPECT_GT(paths.means([](const PathRadiance& r) { return r.indirect.x; }).front(), 10.0);
  TransportParameters endless;
  endless.roulette = false;
  endless.maxBounces = 0;
  const PathBlocks unlimited = follow(white.traced, endless, {.origin = PathOrigin::Surface}, 2, 8);
  EXPECT_GT(unlimited.means([](const PathRadiance& r) { return r.indirect.x; }).front(), 10.0);
  const Furnace grey = furnace("walls", Rgb(0.5f));
  const PathBlocks faded = follow(grey.traced, endless, {.origin = PathOrigin::Surface}, 16, 64);
  EXPECT_NEAR(meanInterval(faded.means([](const PathRadiance& r) { return r.indirect.x; }), 0.999).mean,
              1.0 / grey.traced.unitRadiance(), 0.05);
}

// Walls that are partly mirrors: one of two ways is followed at each, and lights are seen in all of them.
TEST(Furnace, OfPartlySpecularWalls) {
  MaterialDescription m;
  m.diffuse = Rgb(0.3f);
  m.mirror = Rgb(0.25f);
  m.emission = Rgb(1.0f);
  SceneBuilder builder;
  builder.closedCube(builder.material(m), "walls");
  const TracedScene traced = builder.compile();
  ASSERT_GT(traced.scene->mirroredLights.size(), 0u);
  for (const bool mirrored : {true, false}) {
    const PathBlocks paths = follow(traced, {}, {.origin = PathOrigin::Eye, .mirroredLights = mirrored});
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.total().x; }),
                   1.0 / 0.45 / traced.unitRadiance(), mirrored ? "mirrored lights" : "by chance", 0.03);
  }
}

// Glass neither takes nor adds: in uniform light it cannot be seen.
TEST(Furnace, ShowsNoGlass) {
  SceneBuilder builder;
  const std::size_t wall = builder.diffuse(Rgb(0.5f), Rgb(1.0f));
  const std::size_t glass = builder.glass(1.5);
  builder.closedCube(wall, "walls");
  builder.sphere({0.5, 0.5, 0.5}, 0.2, glass);
  const TracedScene traced = builder.compile();
  TransportParameters transport;
  transport.specularDepth = 64;
  PathBlocks paths(*traced.tracer, transport, {.origin = PathOrigin::Eye});
  const Vec3d origin(0.5, 0.5, 0.1);
  // Over the whole face of the ball, its rim included.
  paths.run(64, 512, 42, [&](RandomKey key, std::uint32_t sample) {
    const Vec2 u = uniform2(key, sample, 100);
    const double r = 0.199 * std::sqrt(u.x);
    const Vec3d target(0.5 + r * std::cos(kTwoPi * u.y), 0.5 + r * std::sin(kTwoPi * u.y), 0.45);
    return traced.ray(origin, target - origin);
  });
  expectUnbiased(paths.means([](const PathRadiance& r) { return r.total().x; }), 2.0 / traced.unitRadiance(),
                 "a ball of glass", 0.015);
}

}  // namespace
}  // namespace lightvane
