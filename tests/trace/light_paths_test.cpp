#include <fmt/format.h>

#include "core/scene/load_scene.h"
#include "core/trace/mirrored_lights.h"
#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// Light by way of sampled lights, mirrors and glass, against closed forms.
//
// Budget of each statistical test: 64 blocks of 512 paths unless it says otherwise, 99.9 % confidence,
// tolerance 0.5 % unless stated, sharp against 1 % or twice the tolerance (expectUnbiased).

namespace lightvane {
namespace {

using namespace trace_test;

/// Irradiance from a sphere of radiance 1 that is wholly above the horizon: pi (r/d)^2 cos.
double sphereIrradiance(const Vec3d& centre, double radius, const Vec3d& point, const Vec3d& normal) {
  const Vec3d to = centre - point;
  const double d = glm::length(to);
  LV_CHECK(glm::dot(to, normal) >= radius, "the sphere is cut by the horizon");
  return kPiD * square(radius / d) * glm::dot(to / d, normal);
}

PathBlocks lookDown(const TracedScene& traced, const Vec3d& point, const TransportParameters& transport,
                    const EstimatorOptions& options, double height = 1e-3, std::size_t blocks = 64,
                    std::size_t samples = 512) {
  PathBlocks paths(*traced.tracer, transport, options);
  const Ray down = traced.ray(point + Vec3d(0, height, 0), {0, -1, 0});
  paths.run(blocks, samples, 51, [&](RandomKey, std::uint32_t) { return down; });
  EXPECT_EQ(paths.faults.count, 0u);
  return paths;
}

// Light samples and BRDF samples share the work: near the lamp the latter, far from it the former.
TEST(LightSampling, SphereAboveAFloorNearAndFar) {
  const double rho = 0.6;
  for (const double radius : {0.5, 0.1, 1e-2, 1e-3}) {
    for (const double heightInRadii : {1.01, 1.2, 3.0}) {
      // Closer than rays' origins are lifted off the floor nothing can be right.
      if (radius < 1e-2 && heightInRadii < 1.1) continue;
      SceneBuilder builder;
      const std::size_t floor = builder.diffuse(Rgb(static_cast<float>(rho)));
      const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
      builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor);
      const double h = heightInRadii * radius;
      builder.sphere({0.1, h, 0.2}, radius, lamp);
      const TracedScene traced = builder.compile();
      for (const double aside : {0.0, 0.9 * h}) {
        const Vec3d point(0.1 + aside, 0, 0.2);
        if (aside > 0.0 && h <= 1.1 * radius) continue;
        const double expected = 2.0 / traced.unitRadiance() * rho / kPiD *
                                sphereIrradiance({0.1, h, 0.2}, radius, point, {0, 1, 0});
        // Seen from below the lamp's lowest point.
        const double eye = std::min(1e-3, 0.25 * (h - radius) + 1e-7);
        for (const int samples : {1, 4}) {
          TransportParameters transport;
          transport.bounceLightSamples = samples;
          const PathBlocks paths =
              lookDown(traced, point, transport, {.origin = PathOrigin::Eye}, eye, 64, 512);
          expectUnbiased(paths.means([](const PathRadiance& r) { return r.direct.x; }), expected,
                         "radius " + std::to_string(radius) + " at " + std::to_string(heightInRadii) +
                             " radii, " + std::to_string(aside / h) + " heights aside, " +
                             std::to_string(samples) + " samples",
                         0.02);
        }
      }
    }
  }
}

// Beyond four lights one is chosen; that its chance is known to BRDF samples too shows where both matter.
TEST(LightSampling, ManyLightsAddUp) {
  SceneBuilder builder;
  const std::size_t floor = builder.diffuse(Rgb(0.6f));
  builder.rectangle({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, floor);
  const Vec3d point(0.1, 0, 0.2);
  double expected = 0.0;
  for (int i = 0; i < 6; ++i) {
    const double angle = i, radius = 0.1 + 0.1 * i;
    const Vec3d centre(1.5 * std::cos(angle), 0.75 + 0.1 * i, 1.5 * std::sin(angle));
    const double radiance = 0.5 + i;
    builder.sphere(centre, radius, builder.diffuse(Rgb(0.0f), Rgb(static_cast<float>(radiance))));
    expected += radiance * 0.6 / kPiD * sphereIrradiance(centre, radius, point, {0, 1, 0});
  }
  builder.light(PointLightDescription{{-0.4, 0.8, 0.0}, Rgb(0.3f)});
  const Vec3d toPoint = Vec3d(-0.4, 0.8, 0.0) - point;
  expected += 0.6 / kPiD * 0.3 * toPoint.y / std::pow(glm::length(toPoint), 3.0);
  const TracedScene traced = builder.compile();
  ASSERT_GT(traced.scene->lights.size(), 4u);
  const PathBlocks paths = lookDown(traced, point, {}, {.origin = PathOrigin::Eye}, 1e-3, 64, 2048);
  expectUnbiased(paths.means([](const PathRadiance& r) { return r.direct.x; }),
                 expected / traced.unitRadiance(), "seven lights", 0.009);
}

TEST(LightSampling, SunWithAnExtentAndWithout) {
  for (const double degrees : {0.0, 4.0, 40.0}) {
    SceneBuilder builder;
    const std::size_t floor = builder.diffuse(Rgb(0.6f));
    builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor);
    const double tilt = 0.6;
    builder.light(DirectionalLightDescription{{std::sin(tilt), -std::cos(tilt), 0}, Rgb(2.0f), degrees});
    const TracedScene traced = builder.compile();
    // Within the horizon a disc's irradiance goes by its axis' cosine exactly.
    const double expected = 2.0 * std::cos(tilt) * 0.6 / kPiD / traced.unitRadiance();
    const PathBlocks paths = lookDown(traced, {0.1, 0, 0.2}, {}, {.origin = PathOrigin::Eye});
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.direct.x; }), expected,
                   std::to_string(degrees) + " degrees", 0.009);
    // Looked at, the sun is emission; from a surface it is left to the surface.
    for (const PathOrigin origin : {PathOrigin::Eye, PathOrigin::Surface}) {
      RadianceEstimator estimator(*traced.tracer, {}, {.origin = origin});
      const PathStart start{traced.ray({0, 1, 0}, {-std::sin(tilt), std::cos(tilt), 0}), randomKey(1), 0};
      PathRadiance result;
      RayCounts counts;
      SampleFaults faults;
      estimator.estimate({&start, 1}, {&result, 1}, Coherence::Incoherent, counts.camera, counts, faults);
      const double radiance =
          degrees == 0.0 ? 0.0
                         : 2.0 / traced.unitRadiance() / (kPiD * square(std::sin(degrees * kPiD / 360.0)));
      EXPECT_NEAR(result.total().x, origin == PathOrigin::Eye ? radiance : 0.0, 1e-3 * radiance)
          << degrees << " degrees";
    }
  }
}

// L = 2 + d.x under a hill-less horizon: a floor's irradiance is 2 pi, whatever the tilt of the sky.
std::shared_ptr<const ImageRgb> slantedSky() {
  auto picture = std::make_shared<ImageRgb>(128, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 128; ++x) {
      const double theta = kPiD * (y + 0.5) / 64;
      const double longitude = 2.0 * kPiD * ((x + 0.5) / 128 - 0.5);
      picture->at(x, y) = Rgb(static_cast<float>(2.0 + std::sin(theta) * std::sin(longitude)));
    }
  }
  return picture;
}

TEST(LightSampling, SkyOverAFloor) {
  for (const bool hasPicture : {false, true}) {
    SceneBuilder builder;
    const std::size_t floor = builder.diffuse(Rgb(0.6f));
    builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor);
    EnvironmentLightDescription sky;
    sky.radiance = Rgb(hasPicture ? 1.0f : 2.0f);
    if (hasPicture) sky.pixels = slantedSky();
    builder.light(sky);
    const TracedScene traced = builder.compile();
    const PathBlocks paths = lookDown(traced, {0.1, 0, 0.2}, {}, {.origin = PathOrigin::Eye}, 1e-3, 64, 4096);
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.direct.x; }),
                   2.0 * 0.6 / traced.unitRadiance(), hasPicture ? "a picture" : "one colour", 0.009);
    // Looked at, the sky is emission; from a surface it is left to the surface.
    for (const PathOrigin origin : {PathOrigin::Eye, PathOrigin::Surface}) {
      RadianceEstimator estimator(*traced.tracer, {}, {.origin = origin});
      const PathStart start{traced.ray({0, 1, 0}, {1, 0.5, 0}), randomKey(1), 0};
      PathRadiance result;
      RayCounts counts;
      SampleFaults faults;
      estimator.estimate({&start, 1}, {&result, 1}, Coherence::Incoherent, counts.camera, counts, faults);
      const double radiance = (2.0 + (hasPicture ? 1.0 / std::sqrt(1.25) : 0.0)) / traced.unitRadiance();
      EXPECT_NEAR(result.total().x, origin == PathOrigin::Eye ? radiance : 0.0, 2e-3 * radiance);
    }
  }
}

// Every material under a sky of one colour shows its albedo: light samples and BRDF samples make one whole.
TEST(LightSampling, SkyOverAGlossyFloor) {
  for (const double roughness : {0.02, 0.1, 0.5}) {
    SceneBuilder builder;
    const std::size_t floor = builder.glossy(Rgb(0.7f), roughness);
    builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floor);
    EnvironmentLightDescription sky;
    sky.pixels = std::make_shared<ImageRgb>(8, 4, Rgb(1.0f));  // by the map, too
    builder.light(sky);
    const TracedScene traced = builder.compile();
    const Vec3d outgoing = glm::normalize(Vec3d(0.5, 1.0, 0.2));
    PathBlocks paths(*traced.tracer, {}, {.origin = PathOrigin::Eye});
    const Ray ray = traced.ray(outgoing, -outgoing);
    paths.run(64, 8192, 52, [&](RandomKey, std::uint32_t) { return ray; });
    const Brdf& brdf = traced.scene->materials[floor].brdf;
    // What the lobe and its Dirac part reflect of a sky that is 1 everywhere.
    const double albedo = static_cast<double>(
        brdf.directionalAlbedo(Vec3(Vec3d(0, std::sqrt(1 - square(outgoing.y)), outgoing.y))).x);
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.total().x; }),
                   albedo / traced.unitRadiance(), fmt::format("roughness {}", roughness), 0.009);
  }
}

/// A floor under a lamp beside a mirror at x = 0, which doubles the lamp.
struct MirrorRoom {
  static constexpr double kMirror = 0.8;
  static constexpr double kFloor = 0.5;
  Vec3d lamp{1.0, 1.0, 0.0};
  double radius = 0.4;
  Vec3d point{0.5, 0.0, 0.1};
  TracedScene traced = [this] {
    SceneBuilder builder;
    const std::size_t floor = builder.diffuse(Rgb(static_cast<float>(kFloor)));
    const std::size_t emitter = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
    const std::size_t mirror = builder.mirror(Rgb(static_cast<float>(kMirror)));
    builder.rectangle({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, floor);
    builder.sphere(lamp, radius, emitter);
    builder.rectangle({0, 0, -3}, {0, 3, 0}, {0, 0, 6}, mirror);
    return builder.compile();
  }();

  double straight() const {
    return 2.0 / traced.unitRadiance() * sphereIrradiance(lamp, radius, point, {0, 1, 0});
  }
  double byMirror() const {
    const Vec3d image(-lamp.x, lamp.y, lamp.z);
    return 2.0 / traced.unitRadiance() * kMirror * sphereIrradiance(image, radius, point, {0, 1, 0});
  }
};

TEST(Mirrors, DoubleALight) {
  const MirrorRoom room;
  ASSERT_EQ(room.traced.scene->mirroredLights.size(), 1u);
  for (const bool sampled : {true, false}) {
    TransportParameters transport;
    transport.mirroredLights = sampled;
    const PathBlocks paths =
        lookDown(room.traced, room.point, transport, {.origin = PathOrigin::Eye, .mirroredLights = sampled},
                 1e-3, 64, sampled ? 1024 : 8192);
    const std::string what = sampled ? "sampled in the mirror" : "found by chance";
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.direct.x; }),
                   room.straight() * MirrorRoom::kFloor / kPiD, what + ", straight", 0.009);
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.indirect.x; }),
                   room.byMirror() * MirrorRoom::kFloor / kPiD, what + ", by the mirror",
                   sampled ? 0.005 : 0.06);
    EXPECT_EQ(paths.means([](const PathRadiance& r) { return r.specular.x; }).front(), 0.0);
  }
}

TEST(Mirrors, LightByWayOfThemIsIndirectForASurfaceUnlessLeftToIt) {
  const MirrorRoom room;
  const Vec3d image(-room.lamp.x, room.lamp.y, room.lamp.z);
  for (const bool sampled : {true, false}) {
    RadianceEstimator estimator(*room.traced.tracer, {},
                                {.origin = PathOrigin::Surface, .mirroredLights = sampled});
    const Vec3d origin = room.point + Vec3d(0, 0.05, 0);
    const PathStart starts[] = {{room.traced.ray(origin, room.lamp - origin), randomKey(1), 0},
                                {room.traced.ray(origin, image - origin), randomKey(1), 1}};
    PathRadiance results[2];
    RayCounts counts;
    SampleFaults faults;
    estimator.estimate(starts, results, Coherence::Incoherent, counts.gather, counts, faults);
    EXPECT_EQ(results[0].total().x, 0.0f) << "straight light is the surface's direct light";
    EXPECT_EQ(results[1].direct.x, 0.0f);
    EXPECT_NEAR(results[1].indirect.x, sampled ? 0.0 : MirrorRoom::kMirror * 2.0 / room.traced.unitRadiance(),
                1e-6);
  }
}

TEST(Mirrors, SeenByTheEyeShowTheirLightsWhateverIsSampled) {
  const MirrorRoom room;
  const Vec3d image(-room.lamp.x, room.lamp.y, room.lamp.z);
  for (const bool sampled : {true, false}) {
    RadianceEstimator estimator(*room.traced.tracer, {},
                                {.origin = PathOrigin::Eye, .mirroredLights = sampled});
    const PathStart start{room.traced.ray({1.5, 0.5, 0.5}, image - Vec3d(1.5, 0.5, 0.5)), randomKey(1), 0};
    PathRadiance result;
    RayCounts counts;
    SampleFaults faults;
    estimator.estimate({&start, 1}, {&result, 1}, Coherence::Incoherent, counts.camera, counts, faults);
    EXPECT_NEAR(result.specular.x, MirrorRoom::kMirror * 2.0 / room.traced.unitRadiance(), 1e-6);
    EXPECT_EQ(result.emission.x + result.direct.x + result.indirect.x, 0.0f);
  }
}

// A mirror so small that the outline cuts the image, and a lamp shade between mirror and lamp: what is found
// by chance says what is right.
/// One of side * side strata of the unit square, jittered.
Vec2 stratified(RandomKey key, std::uint32_t sample, std::uint32_t side) {
  return (Vec2(sample % side, sample / side) + uniform2(key, sample, 100)) / static_cast<float>(side);
}

void expectSampledMirrorLikeChance(bool front) {
  SceneBuilder builder;
  const std::size_t floor = builder.diffuse(Rgb(0.5f));
  const std::size_t emitter = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
  const std::size_t black = builder.diffuse(Rgb(0.0f));
  const std::size_t mirror = builder.mirror(Rgb(0.8f, 0.6f, 0.4f));
  builder.rectangle({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, floor);
  builder.rectangle({0.6, 1.2, -0.8}, {0.8, 0, 0}, {0, 0, 1.6}, emitter);
  // Turned out of the axes, its outline through the middle of the image.
  std::vector<Vec3d> outline{{0.0, 0.4, -0.5}, {0.0, 0.8, -0.5}, {0.1, 0.75, 0.4}, {0.1, 0.35, 0.4}};
  if (!front) std::reverse(outline.begin(), outline.end());
  builder.polygon(std::move(outline), mirror);
  builder.rectangle({0.3, 0.85, -0.1}, {0.2, 0, 0}, {0, 0, 0.2}, black);
  const TracedScene traced = builder.compile();
  ASSERT_EQ(traced.scene->mirroredLights.size(), 1u);
  ASSERT_EQ(traced.scene->mirroredLights.front().frontSide, front);
  const LitPoint lit = traced.litPoint({0.45, 0.1, 0.0}, {0, -1, 0});
  // Irradiance by chance, the first reflection only: cosine-weighted paths times pi.
  TransportParameters chance;
  chance.mirroredLights = false;
  chance.maxBounces = 1;
  PathBlocks paths(*traced.tracer, chance, {.origin = PathOrigin::Surface, .mirroredLights = false});
  paths.run(64, 4096, 52, [&](RandomKey key, std::uint32_t sample) {
    const Vec3 direction = lit.surface.frame.toWorld(cosineDirection(stratified(key, sample, 64)));
    return Ray{lit.surface.originTowards(direction), direction, 0.0f, kInfinity};
  });
  DirectLightSampler sampler(*traced.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  for (int c = 0; c < 3; c += 2) {
    const std::vector<double> sampled = blockMeans(64, 1, [&](std::size_t b, std::size_t) {
      const auto key = randomKey(53).with(static_cast<std::uint32_t>(b));
      return static_cast<double>(sampler.estimateMirrored(lit, 64, key, counts, faults).irradiance[c]);
    });
    const std::vector<double> found = paths.means([&](const PathRadiance& r) { return kPi * r.indirect[c]; });
    EXPECT_GT(meanInterval(found, 0.999).mean, 0.0);
    // 262,144 paths by chance, in strata.
    const BiasTest::Result result = BiasTest{.tolerance = 0.05}.againstValue(
        sampled, meanInterval(found, 0.999).mean, meanInterval(found, 0.999).standardError);
    EXPECT_TRUE(result.passes()) << "channel " << c << ": " << result.explanation;
    // And what paths make of it: the floor's rho / pi of that.
    const PathBlocks seen =
        lookDown(traced, {0.45, 0.0, 0.0}, {}, {.origin = PathOrigin::Eye}, 1e-3, 64, 1024);
    expectSameMean(seen.means([c](const PathRadiance& r) { return 2.0f * kPi * r.indirect[c]; }), sampled,
                   "channel " + std::to_string(c) + ", paths", 0.05);
  }
}

TEST(Mirrors, OutlinesAndOccludersCountOnBothWays) {
  expectSampledMirrorLikeChance(true);
  expectSampledMirrorLikeChance(false);
}

// Mirrored lights are left out for a whole cluster of points, and at a point, only where no sample of them
// arrives.
TEST(Mirrors, LeftOutWhereNothingOfThemArrives) {
  const auto loaded =
      loadScene(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "assets/scenes/cornell-mirror.toml");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message();
  const auto compiled = Scene::compile(*loaded);
  ASSERT_TRUE(compiled.has_value());
  const Scene& scene = **compiled;
  const RandomKey key = randomKey(57);
  std::size_t leftOut = 0;
  std::size_t arriving = 0;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const auto inBox = [&](std::uint32_t dimension) {
      const Vec3 u(uniform(key, i, dimension), uniform(key, i, dimension + 1),
                   uniform(key, i, dimension + 2));
      return scene.bounds.lower + u * (scene.bounds.upper - scene.bounds.lower);
    };
    LitPoint lit;
    lit.surface.position = inBox(0);
    lit.surface.geometricNormal = glm::normalize(inBox(3) - scene.bounds.centre());
    const float radius = 0.05f * scene.diagonal * uniform(key, i, 6);
    // The point is anywhere in the ball that the cluster is bounded by.
    const Vec3 centre = lit.surface.position + radius * glm::normalize(inBox(7) - scene.bounds.centre());
    std::vector<std::uint32_t> near;
    mirroredLightsNear(scene, centre, radius * 1.0001f, near);
    for (std::uint32_t m = 0; m < scene.mirroredLights.size(); ++m) {
      const MirroredLight& mirrored = scene.mirroredLights[m];
      const LightSampler sampler(mirrored.image, lit.surface.position);
      bool arrives = false;
      for (std::uint32_t s = 0; s < 64; ++s) {
        LightSample sample;
        MirrorPath way;
        arrives |= sampler.sample(uniform2(key.with(m), i * 64 + s, 0), sample) &&
                   maySeeMirroredLight(scene, mirrored, lit.surface.position) &&
                   mirrorPath(scene, mirrored, lit.surface, sample.direction, sample.distance, way);
      }
      const bool isNear = std::find(near.begin(), near.end(), m) != near.end();
      const bool meets = imageMayMeetMirror(scene, mirrored, lit.surface.position);
      arriving += arrives ? 1 : 0;
      leftOut += isNear && meets ? 0 : 1;
      EXPECT_TRUE(!arrives || isNear) << "point " << i << ", light " << m;
      EXPECT_TRUE(!arrives || meets) << "point " << i << ", light " << m;
    }
  }
  EXPECT_GT(arriving, 500u);
  EXPECT_GT(leftOut, 10'000u);
}

// specular.depth = 0 follows no reflection, and a light in a mirror is one.
TEST(Mirrors, ShowNoLightWhereNoReflectionIsFollowed) {
  SceneBuilder builder;
  builder.rectangle({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, builder.diffuse(Rgb(0.5f)));
  builder.rectangle({1, 1.5, -1}, {0.5, 0, 0}, {0, 0, 2}, builder.diffuse(Rgb(0.0f), Rgb(2.0f)));
  builder.rectangle({-1, 0, 1}, {0, 0, -2}, {0, 2, 0}, builder.mirror(Rgb(0.8f)));
  const TracedScene traced = builder.compile();
  const LitPoint lit = traced.litPoint({0.0, 0.5, 0.0}, {0, -1, 0});
  for (const int depth : {0, 1}) {
    TransportParameters transport;
    transport.specularDepth = depth;
    RayCounts counts;
    SampleFaults faults;
    DirectLightSampler sampler(*traced.tracer, transport);
    const float sampled = sampler.estimateMirrored(lit, 16, randomKey(1), counts, faults).irradiance.r;
    RadianceEstimator paths(*traced.tracer, transport, {.origin = PathOrigin::Eye, .mirroredLights = true});
    const PathStart start{traced.ray({0.0, 0.5, 0.0}, {0, -1, 0}), randomKey(1), 0};
    PathRadiance result;
    paths.estimate({&start, 1}, {&result, 1}, Coherence::Incoherent, counts.camera, counts, faults);
    EXPECT_EQ(sampled > 0.0f, depth == 1) << "depth " << depth;
    EXPECT_EQ(result.indirect.r > 0.0f, depth == 1) << "depth " << depth;
  }
}

// The paper's Fig. 3: mirrored lights sampled or found by chance, all the rest of the room's light included.
// 48 blocks of 1,024 paths against 48 of 8,192, tolerance 4 % (chance is noisy), 99.9 %.
TEST(Mirrors, OfTheCornellBoxGiveTheSameLightSampledOrNot) {
  const auto loaded =
      loadScene(std::filesystem::path(LIGHTVANE_SOURCE_DIR) / "assets/scenes/cornell-mirror.toml");
  ASSERT_TRUE(loaded.has_value()) << loaded.error().message();
  const auto compiled = Scene::compile(*loaded);
  ASSERT_TRUE(compiled.has_value());
  const TracedScene traced(*compiled);
  ASSERT_GT(traced.scene->mirroredLights.size(), 0u);
  // On the ceiling beside the lamp, which the block's top lights.
  const LitPoint lit = traced.litPoint({0.42, 0.5, 0.35}, {0, 1, 0});
  const auto irradiance = [&](bool sampled, std::size_t samples) {
    TransportParameters transport;
    transport.mirroredLights = sampled;
    PathBlocks paths(*traced.tracer, transport, {.origin = PathOrigin::Surface, .mirroredLights = sampled});
    paths.run(48, samples, sampled ? 54 : 55, [&](RandomKey key, std::uint32_t sample) {
      const Vec3 direction = lit.surface.frame.toWorld(cosineDirection(uniform2(key, sample, 100)));
      return Ray{lit.surface.originTowards(direction), direction, 0.0f, kInfinity};
    });
    std::vector<double> blocks =
        paths.means([](const PathRadiance& r) { return kPi * luminance(r.indirect); });
    DirectLightSampler sampler(*traced.tracer, transport);
    RayCounts counts;
    SampleFaults faults;
    double fromMirrors = 0.0;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const RandomKey key = randomKey(56).with(static_cast<std::uint32_t>(b));
      const double mirrored =
          static_cast<double>(luminance(sampler.estimateMirrored(lit, 64, key, counts, faults).irradiance));
      fromMirrors += mirrored / static_cast<double>(blocks.size());
      blocks[b] += mirrored;
    }
    return std::pair(blocks, fromMirrors);
  };
  const auto [sampled, fromMirrors] = irradiance(true, 1024);
  const auto [chance, none] = irradiance(false, 8192);
  EXPECT_EQ(none, 0.0);
  const MeanInterval a = meanInterval(sampled, 0.999), b = meanInterval(chance, 0.999);
  EXPECT_GT(fromMirrors, 0.1 * a.mean) << "the mirrors matter too little here for the test to mean something";
  const BiasTest::Result result = BiasTest{.tolerance = 0.04}.againstValue(sampled, b.mean, b.standardError);
  EXPECT_TRUE(result.passes()) << result.explanation;
}

/// Transmittance of a slab, all reflections between its faces included: (1 - R) / (1 + R) for each
/// polarisation apart; here rays carry the mean reflectance of both.
double slabTransmittance(double cosine, double ior) {
  const double sine = std::sqrt(1.0 - cosine * cosine) / ior;
  const double inside = std::sqrt(1.0 - sine * sine);
  const double s = square((cosine - ior * inside) / (cosine + ior * inside));
  const double p = square((inside - ior * cosine) / (inside + ior * cosine));
  const double f = 0.5 * (s + p);
  return (1.0 - f) / (1.0 + f);
}

TEST(Glass, SlabPassesWhatItsFacesDoNotReflect) {
  SceneBuilder builder;
  const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
  const std::size_t glass = builder.glass(1.5);
  builder.box({-20, 0.0, -20}, {20, 0.1, 20}, glass);
  builder.rectangle({-20, 1, -20}, {40, 0, 0}, {0, 0, 40}, lamp);
  const TracedScene traced = builder.compile();
  for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
    const double angle = degrees * kPiD / 180.0;
    PathBlocks paths(*traced.tracer, {}, {.origin = PathOrigin::Eye});
    const Ray ray = traced.ray({0.1, -1, 0.2}, {std::sin(angle), std::cos(angle), 0});
    paths.run(64, 512, 57, [&](RandomKey, std::uint32_t) { return ray; });
    expectUnbiased(paths.means([](const PathRadiance& r) { return r.specular.x; }),
                   2.0 / traced.unitRadiance() * slabTransmittance(std::cos(angle), 1.5),
                   std::to_string(degrees) + " degrees", degrees < 70.0 ? 0.015 : 0.03);
  }
}

// Beneath glass a floor's light comes from refracted rays only, and is indirect. The ceiling fills the whole
// hemisphere, so that irradiance is pi times the cosine-weighted mean of the slab's transmittance.
TEST(Glass, SlabLightsTheFloorBelow) {
  SceneBuilder builder;
  const std::size_t lamp = builder.diffuse(Rgb(0.0f), Rgb(2.0f));
  const std::size_t black = builder.diffuse(Rgb(0.0f));
  const std::size_t glass = builder.glass(1.5);
  builder.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, black);
  builder.box({-900, 0.01, -900}, {900, 0.02, 900}, glass);
  builder.rectangle({-900, 0.03, -900}, {1800, 0, 0}, {0, 0, 1800}, lamp);
  const TracedScene traced = builder.compile();
  const LitPoint lit = traced.litPoint({0.1, 0.005, 0.2}, {0, -1, 0});
  PathBlocks paths(*traced.tracer, {}, {.origin = PathOrigin::Surface});
  paths.run(64, 2048, 58, [&](RandomKey key, std::uint32_t sample) {
    const Vec3 direction = lit.surface.frame.toWorld(cosineDirection(uniform2(key, sample, 100)));
    return Ray{lit.surface.originTowards(direction), direction, 0.0f, kInfinity};
  });
  double expected = 0.0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    expected += 2.0 / traced.unitRadiance() * slabTransmittance(std::sqrt((i + 0.5) / kSteps), 1.5) / kSteps;
  }
  expectUnbiased(paths.means([](const PathRadiance& r) { return r.indirect.x; }), expected, "below a slab",
                 0.009);
  EXPECT_EQ(paths.means([](const PathRadiance& r) { return r.direct.x; }).front(), 0.0);
  DirectLightSampler sampler(*traced.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  EXPECT_EQ(sampler.estimate(lit, 0, 64, randomKey(1), counts, faults).irradiance.x, 0.0f)
      << "glass lets no shadow ray pass";
}

}  // namespace
}  // namespace lightvane
