// Textures on walls: where their colours appear, and what vectors know of them.

#include <set>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/pictures/pictures.h"
#include "tests/support/statistics.h"

namespace lightvane::render_test {
namespace {

/// A room, open to the viewer, lit from its ceiling. Its back wall and floor have the material `wall`.
SceneDescription roomWith(const std::string& tables, int size = 48) {
  return sceneFromText(fmt::format(R"(version = 1
[camera]
position = [0, 1, 4.2]
target = [0, 1, 0]
fov_y = 40
resolution = [{0}, {0}]
[material.white]
diffuse = [0.7, 0.7, 0.7]
[material.lamp]
emission = [6, 6, 6]
{1}
[[shape]]
type = "polygon"
name = "back"
material = "wall"
vertices = [[-1, 0, -1], [1, 0, -1], [1, 2, -1], [-1, 2, -1]]
[[shape]]
type = "polygon"
name = "floor"
material = "wall"
vertices = [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]]
[[shape]]
type = "polygon"
name = "ceiling"
material = "white"
vertices = [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1]]
[[shape]]
type = "polygon"
name = "left"
material = "white"
vertices = [[-1, 0, 1], [-1, 0, -1], [-1, 2, -1], [-1, 2, 1]]
[[shape]]
type = "polygon"
name = "right"
material = "white"
vertices = [[1, 0, -1], [1, 0, 1], [1, 2, 1], [1, 2, -1]]
[[shape]]
type = "polygon"
name = "lamp"
material = "lamp"
vertices = [[-0.4, 1.98, -0.4], [0.4, 1.98, -0.4], [0.4, 1.98, 0.4], [-0.4, 1.98, 0.4]]
)",
                                   size, tables));
}

const std::string kChecker = R"(
[texture.tiles]
type = "checker"
even = [0.9, 0.8, 0.7]
odd = [0.05, 0.1, 0.2]
[material.wall]
diffuse = {texture = "tiles", scale = 0.25}
)";
const std::string kWhite = "[material.wall]\ndiffuse = [1, 1, 1]\n";

class Textures : public testing::TestWithParam<const char*> {
 protected:
  static Parameters parameters(const Settings& more = {}) {
    Settings settings = {{"method.name", GetParam()}, {"path.samples", "4"}, {"naive.samples", "16"}};
    settings.insert(settings.end(), more.begin(), more.end());
    return parametersWith(settings);
  }
};

// A texture of one colour is that colour, to the bit.
TEST_P(Textures, OfOneColourAreAColour) {
  const Stage textured(roomWith(R"(
[texture.flat]
type = "marble"
base = [0.6, 0.5, 0.25]
vein = [0.6, 0.5, 0.25]
[material.wall]
diffuse = {texture = "flat", scale = 0.1}
)"));
  const Stage plain(roomWith("[material.wall]\ndiffuse = [0.6, 0.5, 0.25]\n"));
  const Film a = picture(textured, parameters()).film;
  const Film b = picture(plain, parameters()).film;
  EXPECT_EQ(difference(a, b), "");
}

TEST_P(Textures, AreTheSameForAnyNumberOfThreads) {
  const SceneDescription room = roomWith(kChecker, 40);
  const Film one = picture(Stage(room, 1), parameters()).film;
  const Film three = picture(Stage(room, 3), parameters()).film;
  EXPECT_EQ(difference(one, three), "");
}

// The tiles of the back wall, as its corners say: u to the right from x = -1, v up from y = 0.
TEST_P(Textures, LieWhereTheCornersSay) {
  const Stage stage(roomWith(kChecker, 64));
  const Film film = picture(stage, parameters()).film;
  int seen = 0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    if (!(film.depth()[i] < kInfinity) || film.normal()[i].z < 0.9f) continue;
    const Vec3d p = stage.scene->normalisation.scenePoint(film.position()[i]);
    const double u = (p.x + 1.0) / 2.0 / 0.25;
    const double v = p.y / 2.0 / 0.25;
    if (std::abs(u - std::round(u)) < 1e-3 || std::abs(v - std::round(v)) < 1e-3) continue;
    const bool isEven = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
    ASSERT_EQ(film.albedo()[i], isEven ? Rgb(0.9f, 0.8f, 0.7f) : Rgb(0.05f, 0.1f, 0.2f)) << u << ", " << v;
    ++seen;
  }
  EXPECT_GT(seen, 300);
}

INSTANTIATE_TEST_SUITE_P(Methods, Textures, testing::Values("vectors", "path", "naive", "direct"));

// What a pixel shows of a textured wall is what the wall receives, times the texture: vectors hold irradiance
// alone, so that tiles of both colours share them.
TEST(TexturedVectors, AreFreeOfTheTexture) {
  for (const char* store : {"split", "vector"}) {
    const Parameters parameters =
        parametersWith({{"ilv.store", store}, {"dlv.store", store}, {"dlv.mode", "always"}});
    const Stage tiled(roomWith(kChecker));
    const Picture a = picture(tiled, parameters);
    std::set<SurfaceKey> keys;
    for (std::size_t i = 0; i < a.snapshot->indirect.size(); ++i)
      keys.insert(a.snapshot->indirect[i].point.key);
    EXPECT_LE(keys.size(), 3U) << store;
    // Neighbours on tiles of other colours answer alike: indirect over albedo has no step where the tiles
    // meet.
    double across = 0.0;
    double within = 0.0;
    int acrossCount = 0;
    int withinCount = 0;
    for (int y = 0; y < a.film.height; ++y) {
      for (int x = 1; x < a.film.width; ++x) {
        const auto isBack = [&](int px) {
          return a.film.normal().at(px, y).z > 0.9f && a.film.depth().at(px, y) < kInfinity;
        };
        if (!isBack(x) || !isBack(x - 1)) continue;
        const auto irradiance = [&](int px) {
          return a.film.indirect.at(px, y).r / a.film.albedo().at(px, y).r;
        };
        const double step = std::abs(irradiance(x) / irradiance(x - 1) - 1.0f);
        const bool isAcross = a.film.albedo().at(x, y) != a.film.albedo().at(x - 1, y);
        (isAcross ? across : within) += step;
        ++(isAcross ? acrossCount : withinCount);
      }
    }
    ASSERT_GT(acrossCount, 50);
    ASSERT_GT(withinCount, 50);
    EXPECT_LT(across / acrossCount, 3.0 * within / withinCount + 1e-3) << store;
  }
}

const std::string kVarnished = R"(
[texture.planks]
type = "wood"
[material.wall]
layers = [{color = [0.04, 0.04, 0.04], roughness = 0.2}, {color = {texture = "planks", scale = 3}, roughness = 0.7}]
)";

const std::string kPlainVarnish = R"(
[material.wall]
layers = [{color = [0.04, 0.04, 0.04], roughness = 0.2}, {color = [0.45, 0.27, 0.13], roughness = 0.7}]
)";

class TexturedWalls : public testing::TestWithParam<Way> {};

// Light that textured walls send on: vectors and paths agree on the whole picture.
TEST_P(TexturedWalls, AreTheSameForVectorsAndPaths) {
  if (!isFast()) GTEST_SKIP() << "the samples that the tolerance needs take too long in this build";
  const Stage stage(roomWith(GetParam().scene, 32));
  const auto blocks = [&](const Settings& settings, int count) {
    std::vector<double> means;
    for (int seed = 1; seed <= count; ++seed) {
      Parameters parameters = parametersWith(settings);
      parameters.picture.seed = static_cast<std::uint64_t>(seed);
      means.push_back(mean(picture(stage, parameters).film.indirect));
    }
    return means;
  };
  const MeanInterval reference =
      meanInterval(blocks({{"method.name", "path"}, {"path.samples", "1024"}}, 8), 0.95);
  const BiasTest test{.tolerance = 0.01, .confidence = 0.95};
  const BiasTest::Result result =
      test.againstValue(blocks({{"preset", "fine"}}, 8), reference.mean, reference.standardError);
  EXPECT_TRUE(result.passes()) << result.explanation;
}

INSTANTIATE_TEST_SUITE_P(Scenes, TexturedWalls,
                         testing::Values(Way{"tiles", kChecker.c_str(), {}},
                                         Way{"plain", kPlainVarnish.c_str(), {}},
                                         Way{"varnished", kVarnished.c_str(), {}}),
                         [](const auto& way) { return std::string(way.param.name); });

/// A screen in place of the room's lamp: a checker, or a picture of a few bright windows.
SceneDescription roomWithScreen(bool isPicture) {
  SceneDescription scene = roomWith(
      "[texture.squares]\ntype = \"checker\"\neven = [1, 0.5, 0.25]\n"
      "odd = [0, 0.1, 0]\n" +
          kWhite,
      32);
  if (isPicture) {
    auto pixels = std::make_shared<ImageRgb>(16, 16, Rgb(0.0f));
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        if (x % 5 < 2 && y % 6 < 3) pixels->at(x, y) = Rgb(1.0f, 0.1f * static_cast<float>(y % 4), 0.3f);
      }
    }
    ImageTextureDescription image;
    image.pixels = std::move(pixels);
    scene.textures.front().pattern = std::move(image);
  }
  for (MaterialDescription& material : scene.materials) {
    if (material.emits()) {
      material.emission = Rgb(20.0f);
      material.textures.emission = TextureUse{0, isPicture ? 1.0 : 0.25};
    }
    material.diffuse = glm::min(material.diffuse, Rgb(0.7f));
  }
  return scene;
}

class Screens : public testing::TestWithParam<bool> {};

// Light of a screen, straight and by way of walls: the same to all methods.
TEST_P(Screens, GiveTheSameLightByAllMethods) {
  if (!isFast()) GTEST_SKIP() << "the samples that the tolerance needs take too long in this build";
  const Stage stage(roomWithScreen(GetParam()));
  ASSERT_TRUE(std::get<AreaLight>(stage.scene->lights.front()).pattern);
  struct Blocks {
    std::vector<double> direct, indirect;
  };
  const auto blocks = [&](const Settings& settings, int count) {
    Blocks means;
    for (int seed = 1; seed <= count; ++seed) {
      Parameters parameters = parametersWith(settings);
      parameters.picture.seed = static_cast<std::uint64_t>(seed);
      const Film film = picture(stage, parameters).film;
      means.direct.push_back(mean(film.direct));
      means.indirect.push_back(mean(film.indirect));
    }
    return means;
  };
  const Blocks paths = blocks({{"method.name", "path"}, {"path.samples", "1024"}}, 8);
  const MeanInterval direct = meanInterval(paths.direct, 0.95);
  const MeanInterval indirect = meanInterval(paths.indirect, 0.95);
  const BiasTest test{.tolerance = 0.015, .confidence = 0.95};
  for (const Settings& settings :
       {Settings{{"preset", "fine"}, {"light.samples", "64"}, {"dlv.mode", "always"}},
        Settings{{"method.name", "naive"}, {"naive.samples", "256"}, {"light.samples", "64"}}}) {
    const Blocks found = blocks(settings, 8);
    const BiasTest::Result ofDirect = test.againstValue(found.direct, direct.mean, direct.standardError);
    EXPECT_TRUE(ofDirect.passes()) << settings.front().second << ", direct: " << ofDirect.explanation;
    const BiasTest::Result ofIndirect =
        test.againstValue(found.indirect, indirect.mean, indirect.standardError);
    EXPECT_TRUE(ofIndirect.passes()) << settings.front().second << ", indirect: " << ofIndirect.explanation;
  }
}

// What is seen of the screen itself is its picture.
TEST_P(Screens, AreSeenAsTheyAre) {
  SceneDescription room = roomWithScreen(GetParam());
  room.cameras.front().position = {0, 0.2, 0};
  room.cameras.front().target = {0, 2, 0};
  room.cameras.front().up = {0, 0, -1};
  const Stage stage(room);
  const Texture texture(room.textures.front());
  const Film film = picture(stage, parametersWith({{"method.name", "direct"}})).film;
  const float scale = stage.scene->normalisation.radianceScale();
  int lit = 0;
  int off = 0;
  for (std::size_t i = 0; i < film.depth().size(); ++i) {
    const Vec3d p = stage.scene->normalisation.scenePoint(film.position()[i]);
    if (std::abs(p.y - 1.98) > 1e-4) continue;
    const Vec2 uv((p.x + 0.4) / 0.8, (p.z + 0.4) / 0.8);
    const Rgb expected = 20.0f * texture.at({}, uv / (GetParam() ? 1.0f : 0.25f));
    ++lit;
    for (int c = 0; c < 3; ++c) off += std::abs(scale * film.emission[i][c] - expected[c]) > 0.02f ? 1 : 0;
  }
  EXPECT_GT(lit, 300);
  EXPECT_LT(off, lit / 50) << "but for pixels whose middle is where colours change";
}

INSTANTIATE_TEST_SUITE_P(Kinds, Screens, testing::Bool(), [](const auto& isPicture) {
  return std::string(isPicture.param ? "picture" : "checker");
});

// What a mirror with a texture shows is what it would show without, times the texture.
TEST(TexturedMirror, ReflectsAsMuchAsItsTexture) {
  const std::string tables = R"(
[texture.tiles]
type = "checker"
even = [1, 0.5, 0.25]
odd = [0, 0, 0]
[material.wall]
mirror = {texture = "tiles", scale = 0.5, color = [0.8, 0.8, 0.8]}
)";
  const Parameters parameters = parametersWith({{"method.name", "direct"}, {"direct.ambient", "0"}});
  const Stage textured(roomWith(tables, 40));
  const Stage plain(roomWith("[material.wall]\nmirror = [0.8, 0.8, 0.8]\n", 40));
  EXPECT_TRUE(textured.scene->planarMirrors.empty());
  EXPECT_EQ(plain.scene->planarMirrors.size(), 2U);
  const Film a = picture(textured, parameters).film;
  const Film b = picture(plain, parameters).film;
  int reflecting = 0;
  int dark = 0;
  for (std::size_t i = 0; i < a.depth().size(); ++i) {
    if (!(a.depth()[i] < kInfinity) || a.normal()[i].z < 0.9f || isBlack(b.specular[i])) continue;
    // Of the places that the back wall shows some are seen by way of the floor, too.
    const Rgb share = a.albedo()[i] / Rgb(0.8f);
    if (isBlack(share)) {
      EXPECT_TRUE(isBlack(a.specular[i]));
      ++dark;
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      ASSERT_LE(a.specular[i][c], share[c] * b.specular[i][c] * 1.0001f);
      if (a.specular[i][c] > 0.9999f * share[c] * b.specular[i][c]) ++reflecting;
    }
  }
  EXPECT_GT(dark, 50);
  EXPECT_GT(reflecting, 100);
}

}  // namespace
}  // namespace lightvane::render_test
