#include <array>

#include <fmt/format.h>

#include "core/scene/emission_pattern.h"
#include "tests/trace/scene_builder.h"
#include "tests/trace/statistical.h"

// Textures of what emits in compiled scenes: what a ray meets, what light samples carry, and what is no
// light.

namespace lightvane {
namespace {

using namespace trace_test;

/// Smooth but for its black lower part, so that rounding a place changes little.
std::shared_ptr<const ImageRgb> glowingPicture() {
  auto pixels = std::make_shared<ImageRgb>(12, 10, Rgb(0.0f));
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 12; ++x) {
      pixels->at(x, y) =
          Rgb(0.5f + 0.04f * static_cast<float>(x), 1.0f - 0.1f * static_cast<float>(y), 0.25f);
    }
  }
  return pixels;
}

struct EmissionScene {
  SceneBuilder builder;

  EmissionScene() {
    ImageTextureDescription image;
    image.pixels = glowingPicture();
    image.wrap = TextureWrap::Clamp;
    builder.description().textures = {{"picture", image}, {"marble", MarbleDescription{}}};
  }
  std::size_t screen(std::size_t texture = 0, double scale = 1.0, bool twoSided = false) {
    MaterialDescription m;
    m.emission = Rgb(4.0f, 2.0f, 8.0f);
    m.twoSided = twoSided;
    m.textures.emission = TextureUse{texture, scale};
    return builder.material(m);
  }
  /// `cells`^2 pairs of triangles over the rectangle from (x, 1, z) on, not flat; the picture lies on it
  /// once, its bright part at greater z. Front sides down.
  void sheet(unsigned cells, double x, double z, double size, std::size_t material) {
    MeshGeometry mesh;
    for (unsigned i = 0; i <= cells; ++i) {
      for (unsigned j = 0; j <= cells; ++j) {
        const double u = static_cast<double>(i) / cells, v = static_cast<double>(j) / cells;
        mesh.positions.emplace_back(x + size * u, 1.0 + 0.01 * ((i + j) % 2), z + size * v);
        mesh.uvs.emplace_back(u, v);
        if (i == cells || j == cells) continue;
        const unsigned a = i * (cells + 1) + j, b = a + cells + 1;
        mesh.triangles.emplace_back(a, b, b + 1);
        mesh.triangles.emplace_back(a, b + 1, a + 1);
      }
    }
    builder.mesh(std::make_shared<const MeshGeometry>(std::move(mesh)), material);
  }
};

struct EmissionCase {
  const char* name;
  void (*add)(EmissionScene&);
};
const std::vector<EmissionCase> kEmissionCases = {
    {"rectangle",
     [](EmissionScene& s) {
       s.builder.rectangle({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, s.screen());
     }},
    {"turned pentagon",
     [](EmissionScene& s) {
       s.builder.polygon({{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.7, 1, 0.2}, {0, 1, 0.6}, {-0.7, 1, 0.2}},
                         s.screen(0, 1.0, true));
       TransformDescription& t = s.builder.description().shapes.back().transform;
       t.rotateDegrees = {20, 40, 10};
       t.scale = {1.5, 1.0, 0.7};
     }},
    {"box",
     [](EmissionScene& s) {
       s.builder.box({-0.3, 0.8, -0.3}, {0.3, 1.2, 0.3}, s.screen());
     }},
    {"sphere",
     [](EmissionScene& s) {
       s.builder.sphere({0.1, 1, 0}, 0.4, s.screen(0, 0.5));
     }},
    {"disc",
     [](EmissionScene& s) {
       s.builder.disc({0, 1, 0}, {0.3, -1, 0.2}, 0.5, s.screen());
     }},
    {"mesh of 8", [](EmissionScene& s) { s.sheet(2, -0.5, -0.5, 1.0, s.screen()); }},
    {"mesh of 800", [](EmissionScene& s) { s.sheet(20, -0.5, -0.5, 1.0, s.screen()); }},
    {"mirrored mesh",
     [](EmissionScene& s) {
       s.sheet(3, -0.5, -0.5, 1.0, s.screen());
       s.builder.description().shapes.back().transform.scale = {-1, 1, 1};
     }},
    {"marble rectangle",
     [](EmissionScene& s) {
       s.builder.rectangle({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, s.screen(1, 0.5));
     }},
    {"marble mesh", [](EmissionScene& s) { s.sheet(5, -0.5, -0.5, 1.0, s.screen(1, 0.5)); }},
};

// What a sample of a light carries is what a ray that way meets, and with the same density.
TEST(EmissionTexture, IsTheSameToSamplesAndToRays) {
  for (const EmissionCase& kind : kEmissionCases) {
    EmissionScene scene;
    kind.add(scene);
    scene.builder.rectangle({-7, -5, 7}, {14, 0, 0}, {0, 0, -14}, scene.builder.diffuse(Rgb(0.5f)));
    const TracedScene traced = scene.builder.compile();
    const Light& light = traced.scene->lights.front();
    ASSERT_TRUE(std::get<AreaLight>(light).pattern) << kind.name;
    int lit = 0;
    int off = 0;
    int otherDensity = 0;
    for (const Vec3d& place : {Vec3d(0, 0, 0), Vec3d(0.6, -0.2, 0.5), Vec3d(-3, -1, 1)}) {
      const Vec3 point = traced.point(place);
      const LightSampler sampler(light, point);
      for (std::uint32_t i = 0; i < 500; ++i) {
        LightSample sample;
        if (!sampler.sample(uniform2(randomKey(5), i, 0), sample)) continue;
        const Ray ray{point, sample.direction, 0.0f, kInfinity};
        const Hit hit = traced.tracer->intersect(ray);
        if (!hit.found() || std::abs(hit.t - sample.distance) > 1e-4f * sample.distance) continue;  // hidden
        const SurfacePoint met = traced.tracer->surfaceAt(ray, hit);
        const Rgb emitted = emittedRadiance(*traced.scene, met);
        ++lit;
        // At edges the ray may meet the neighbour, and at the sphere's rim directions say little of places.
        bool isNear = true;
        for (int c = 0; c < 3; ++c) {
          const float carried = sample.weight[c] * sample.pdf;
          isNear = isNear && std::abs(emitted[c] - carried) <= 2e-3f * maxComponent(emitted);
        }
        off += isNear ? 0 : 1;
        const float density = sampler.pdf(sample.direction, met.piece);
        otherDensity += std::abs(density - sample.pdf) > 1e-4f * sample.pdf ? 1 : 0;
      }
    }
    EXPECT_GT(lit, 100) << kind.name;
    EXPECT_LE(off, lit / 100) << kind.name;
    EXPECT_LE(otherDensity, lit / 100) << kind.name;
  }
}

// Most of a mesh of which a part glows is no light; its picture and its light are what they were.
TEST(EmissionTexture, ThatIsBlackOnATriangleMakesItNoPiece) {
  EmissionScene scene;
  scene.sheet(20, -0.5, -0.5, 1.0, scene.screen());
  scene.builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, scene.builder.diffuse(Rgb(0.5f)));
  const TracedScene traced = scene.builder.compile();
  const auto& light = std::get<AreaLight>(traced.scene->lights.front());
  // The upper half of the picture, and half a pixel of ten beyond it: 11 of 20 rows, or 12.
  EXPECT_GE(light.pieceCount(), 440U);
  EXPECT_LE(light.pieceCount(), 480U);

  int others = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Vec2 u = uniform2(randomKey(3), i, 0);
    const Ray ray = traced.ray({-0.5 + u.x, 0.5, -0.5 + u.y}, {0, 1, 0});
    const Hit hit = traced.tracer->intersect(ray);
    if (!hit.found()) continue;
    const SurfacePoint met = traced.tracer->surfaceAt(ray, hit);
    if (met.piece != kNone) continue;
    ++others;
    EXPECT_TRUE(isBlack(emittedRadiance(*traced.scene, met)));
  }
  EXPECT_GT(others, 700);

  // The irradiance of the floor below, by the sheet's area.
  const LitPoint lit = traced.litPoint({0.3, 0.5, -0.4}, {0, -1, 0});
  const Texture texture(scene.builder.description().textures.front());
  double sum = 0.0;
  const MeshGeometry& mesh =
      *std::get<MeshDescription>(scene.builder.description().shapes.front().geometry).geometry;
  for (const glm::uvec3& t : mesh.triangles) {
    const Vec3d a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    const Vec3d cross = glm::cross(b - a, c - a);
    constexpr int kSteps = 16;
    for (int s = 0; s < kSteps * kSteps; ++s) {
      Vec2d w((s % kSteps + 0.5) / kSteps, (s / kSteps + 0.5) / kSteps);
      if (w.x + w.y > 1.0) w = 1.0 - w;
      const Vec3d way = a + w.x * (b - a) + w.y * (c - a) - Vec3d(0.3, 0.0, -0.4);
      const Vec2 uv = (1.0f - static_cast<float>(w.x + w.y)) * mesh.uvs[t.x] +
                      static_cast<float>(w.x) * mesh.uvs[t.y] + static_cast<float>(w.y) * mesh.uvs[t.z];
      const double squared = glm::dot(way, way);
      sum += 4.0 * static_cast<double>(texture.at({}, uv).r) * way.y * -glm::dot(way, 0.5 * cross) /
             (squared * squared * kSteps * kSteps);
    }
  }
  std::vector<double> estimates;
  DirectLightSampler sampler(*traced.tracer, {});
  RayCounts counts;
  SampleFaults faults;
  for (std::uint32_t i = 0; i < 64; ++i) {
    estimates.push_back(
        traced.unitRadiance() *
        static_cast<double>(
            sampler.estimate(lit, 0, 4096, randomKey(9).with(i), counts, faults).irradiance.r));
  }
  ASSERT_GT(sum, 0.1);
  expectUnbiased(estimates, sum, "irradiance");
}

// Paths meet lights by their own directions and by light samples: both share, and the mean is that of one.
TEST(EmissionTexture, IsCountedOnceByPaths) {
  for (const EmissionCase& kind : kEmissionCases) {
    EmissionScene scene;
    kind.add(scene);
    MaterialDescription glossy;
    glossy.layers.push_back({Rgb(0.8f), 0.4, 1.0, LayerModel::Ggx});
    scene.builder.rectangle({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, scene.builder.material(glossy));
    const TracedScene traced = scene.builder.compile();
    const LitPoint lit = traced.litPoint({0.4, 0.5, 0.3}, {-0.3, -1, 0.1});
    // Light of the floor alone: one reflection. With many paths, and with the direct estimate of this point.
    TransportParameters transport;
    transport.maxBounces = 1;
    transport.roulette = false;
    PathBlocks paths(*traced.tracer, transport, {PathOrigin::Eye});
    const Ray ray = traced.ray({0.4, 0.5, 0.3}, {-0.3, -1, 0.1});
    paths.run(32, 4096, 11, [&](RandomKey, std::uint32_t) { return ray; });
    const std::vector<double> shared = paths.means([](const PathRadiance& r) { return r.total().r; });
    std::vector<double> sampled;
    DirectLightSampler sampler(*traced.tracer, transport);
    RayCounts counts;
    SampleFaults faults;
    for (std::uint32_t i = 0; i < 32; ++i) {
      sampled.push_back(static_cast<double>(
          sampler.estimate(lit, 0, 2048, randomKey(9).with(i), counts, faults).lobeRadiance.r));
    }
    ASSERT_GT(meanInterval(sampled, 0.999).mean, 0.0) << kind.name;
    expectSameMean(shared, sampled, kind.name, 0.02);
  }
}

// A mirror shows another part of a patterned light from every place: what it sends on is left to chance.
TEST(EmissionTexture, HasNoMirroredImage) {
  for (const bool hasTexture : {false, true}) {
    EmissionScene scene;
    const std::size_t lamp = hasTexture ? scene.screen() : scene.builder.diffuse(Rgb(0.0f), Rgb(4.0f));
    scene.builder.rectangle({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, lamp);
    scene.builder.rectangle({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, scene.builder.mirror(Rgb(1.0f)));
    EXPECT_EQ(scene.builder.compile().scene->mirroredLights.empty(), hasTexture);
  }
}

TEST(EmissionTexture, IsDimmedWithItsLight) {
  EmissionScene scene;
  scene.builder.rectangle({-0.5, 1, -0.5}, {1, 0, 0}, {0, 0, 1}, scene.screen());
  const TracedScene traced = scene.builder.compile();
  const std::array factors = {Rgb(0.5f, 0.25f, 0.0f)};
  const std::shared_ptr<const Scene> relit = traced.scene->relit(factors);
  const Tracer tracer(relit, *traced.tracer);
  const Ray ray = traced.ray({0.1, 0, 0.3}, {0, 1, 0});
  const SurfacePoint met = traced.tracer->surfaceAt(ray, traced.tracer->intersect(ray));
  const Rgb before = emittedRadiance(*traced.scene, met);
  ASSERT_GT(before.b, 0.0f);
  EXPECT_EQ(emittedRadiance(*relit, met), before * factors[0]);
  LightSample sample, dimmed;
  const Vec3 point = traced.point({0, 0, 0});
  for (std::uint32_t i = 0; i < 50; ++i) {
    const Vec2 u = uniform2(randomKey(2), i, 0);
    if (!sampleLight(traced.scene->lights[0], point, u, sample)) continue;
    ASSERT_TRUE(sampleLight(relit->lights[0], point, u, dimmed));
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(dimmed.weight[c], sample.weight[c] * factors[0][c], 1e-5f * sample.weight[c]);
  }
}

TEST(EmissionTexture, IsTheSameForAllShapesOfALight) {
  EmissionScene scene;
  const std::size_t one = scene.screen();
  scene.builder.polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, one, "lamp");
  scene.builder.polygon({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, one, "lamp");
  EXPECT_EQ(scene.builder.compile().scene->lights.size(), 1U);
  scene.builder.polygon({{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, scene.screen(0, 0.5), "lamp");
  const Expected<std::shared_ptr<const Scene>> refused = Scene::compile(scene.builder.description());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message().find("emits otherwise"), std::string::npos);
}

}  // namespace
}  // namespace lightvane
