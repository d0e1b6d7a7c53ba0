#include "core/scene/emission_pattern.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "tests/scene/lights_support.h"

// Lights whose radiance a texture changes from place to place, against sums over their area that know nothing
// of solid angles: irradiance is the integral of L cos cos / r^2.

namespace lightvane {
namespace {

using namespace lights_test;

/// A picture in colours that differ from pixel to pixel, but for its right part, which is black.
ImageTextureDescription halfBlackPicture(int width, int height, TextureFilter filter, TextureWrap wrap) {
  auto pixels = std::make_shared<ImageRgb>(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const RandomKey key = randomKey(91).with(static_cast<std::uint32_t>(y * width + x));
      const Rgb color(uniform(key, 0, 0), uniform(key, 0, 1), uniform(key, 0, 2));
      pixels->at(x, y) = x < (width + 1) / 2 ? color : Rgb(0.0f);
    }
  }
  ImageTextureDescription image;
  image.pixels = std::move(pixels);
  image.filter = filter;
  image.wrap = wrap;
  return image;
}

struct NamedTexture {
  std::string name;
  TextureDescription texture;
  TextureUse use{0, 1.0};
};
void PrintTo(const NamedTexture& texture, std::ostream* out) { *out << texture.name; }

std::vector<NamedTexture> texturesOfAllKinds() {
  return {{"linear picture", {"", halfBlackPicture(8, 6, TextureFilter::Linear, TextureWrap::Clamp)}},
          {"nearest picture",
           {"", halfBlackPicture(5, 4, TextureFilter::Nearest, TextureWrap::Repeat)},
           {0, 0.5}},
          {"checker", {"", CheckerDescription{Rgb(1.0f, 0.5f, 0.25f), Rgb(0.0f)}}, {0, 0.25}},
          {"marble", {"", MarbleDescription{}}, {0, 0.4}}};
}

using Corners = EmissionPattern::Corners;

void givePattern(AreaLight& light, const NamedTexture& named, std::vector<Corners> corners) {
  const Texture texture(named.texture);
  std::optional<PictureBrightness> brightness;
  if (texture.image() != nullptr) brightness.emplace(*texture.image());
  light.pattern = std::make_shared<EmissionPattern>(texture, named.use, Normalisation{}, std::move(corners),
                                                    light, brightness ? &*brightness : nullptr);
  light.finish();
}

/// What is summed over: a place of the light, its normal, its area, and where it lies on the texture.
struct Element {
  Vec3d place, normal;
  double area;
  Vec2d uv;
};

/// Irradiance (first colour component) of the elements, seen from where their front sides face.
double sumOf(const std::vector<Element>& elements, const NamedTexture& named, const Vec3& point,
             const Vec3& normal, bool twoSided = false) {
  const Texture texture(named.texture);
  double sum = 0.0;
  for (const Element& e : elements) {
    const Vec3d way = e.place - Vec3d(point);
    const double squared = glm::dot(way, way);
    const double here = glm::dot(way, Vec3d(normal));
    const double there = -glm::dot(way, e.normal);
    if (!(here > 0.0) || !(twoSided || there > 0.0)) continue;
    const Rgb color = texture.at(e.place / named.use.scale, Vec2(e.uv / named.use.scale));
    sum += static_cast<double>(color.r) * here * std::abs(there) / (squared * squared) * e.area;
  }
  return sum;
}

/// A parallelogram of `steps`^2 elements; the texture lies on it from 0 to 1.
std::vector<Element> parallelogram(const Vec3d& corner, const Vec3d& u, const Vec3d& v, int steps) {
  std::vector<Element> elements;
  const Vec3d cross = glm::cross(u, v);
  const double area = glm::length(cross);
  for (int i = 0; i < steps * steps; ++i) {
    const Vec2d uv((i % steps + 0.5) / steps, (i / steps + 0.5) / steps);
    elements.push_back({corner + uv.x * u + uv.y * v, cross / area, area / (steps * steps), uv});
  }
  return elements;
}

/// Six standard errors, and what sums over pixels' edges lose.
double patternTolerance(const Estimate& estimate) { return tolerance(estimate) + 2e-3 * estimate.mean; }

const Vec3 kPoints[] = {{0, 0, 0}, {0.3f, 0.6f, -0.2f}, {-1.5f, -0.5f, 0.4f}};
const Vec3 kTilted = glm::normalize(Vec3(0.2f, 1.0f, -0.1f));

class PatternedLight : public testing::TestWithParam<NamedTexture> {};

TEST_P(PatternedLight, ThatIsARectangleGivesItsSum) {
  const Vec3d corner(-0.5, 1.0, -0.25), u(1.0, 0.0, 0.0), v(0.0, 0.1, 0.5);
  const std::vector<Vec3> outline = {Vec3(corner), Vec3(corner + u), Vec3(corner + u + v), Vec3(corner + v)};
  const std::vector<Corners> corners = {{Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)},
                                        {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}};
  for (const bool isPolygon : {true, false}) {
    AreaLight light = polygonLight(outline);
    if (!isPolygon) light.polygon.clear();
    givePattern(light, GetParam(), corners);
    ASSERT_EQ(light.rectangle.has_value(), isPolygon);
    for (const Vec3& point : kPoints) {
      const Estimate estimate = irradiance(light, point, kTilted, 256);
      EXPECT_NEAR(estimate.mean, sumOf(parallelogram(corner, u, v, 600), GetParam(), point, kTilted),
                  patternTolerance(estimate))
          << (isPolygon ? "polygon" : "triangles") << ", height " << point.y;
    }
  }
}

// One affine map serves a polygon; its first triangle is a sliver.
TEST_P(PatternedLight, ThatIsAPolygonGivesItsSum) {
  const Vec3d corner(-0.5, 1.0, -0.5), u(1.0, 0.0, 0.0), v(0.0, 0.0, 1.0);
  const std::vector<Vec2> places = {{0, 0}, {0.5f, -1e-7f}, {1, 0}, {1, 1}, {0, 1}};
  std::vector<Vec3> outline;
  for (const Vec2& p : places)
    outline.push_back(Vec3(corner + static_cast<double>(p.x) * u + static_cast<double>(p.y) * v));
  std::vector<Corners> corners;
  for (std::size_t i = 2; i < places.size(); ++i) corners.push_back({places[0], places[i - 1], places[i]});
  AreaLight light = polygonLight(outline, true);
  givePattern(light, GetParam(), corners);
  for (const Vec3& point : kPoints) {
    const Estimate estimate = irradiance(light, point, kTilted, 256);
    EXPECT_NEAR(estimate.mean, sumOf(parallelogram(corner, u, v, 600), GetParam(), point, kTilted, true),
                patternTolerance(estimate))
        << "height " << point.y;
  }
}

/// A sheet of 4 x 5 cells that is not flat, cut into 40 triangles. `row` and `column` make one of them.
struct Sheet {
  std::vector<EmitterTriangle> triangles;
  std::vector<Corners> corners;
  std::vector<Element> elements;

  Sheet() {
    const auto place = [](int i, int j) {
      return Vec3(-0.5f + 0.25f * static_cast<float>(i), 1.0f + 0.1f * static_cast<float>((i + j) % 2),
                  -0.5f + 0.2f * static_cast<float>(j));
    };
    const auto uv = [](int i, int j) {
      return Vec2(0.25f * static_cast<float>(i), 0.2f * static_cast<float>(j * j) / 5.0f);
    };
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 5; ++j) {
        add({place(i, j), place(i + 1, j), place(i + 1, j + 1)}, {uv(i, j), uv(i + 1, j), uv(i + 1, j + 1)});
        add({place(i, j), place(i + 1, j + 1), place(i, j + 1)}, {uv(i, j), uv(i + 1, j + 1), uv(i, j + 1)});
      }
    }
  }

  void add(const std::array<Vec3, 3>& p, const Corners& uvs) {
    triangles.push_back(emitterTriangle(p[0], p[1], p[2]));
    corners.push_back(uvs);
    constexpr int kSteps = 120;
    const Vec3d a(p[0]), toB = Vec3d(p[1]) - a, toC = Vec3d(p[2]) - a;
    const Vec3d cross = glm::cross(toB, toC);
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j + i < kSteps; ++j) {
        for (const double inset : {1.0 / 3.0, 2.0 / 3.0}) {  // the two triangles of a cell
          const double b = (i + inset) / kSteps, c = (j + inset) / kSteps;
          if (b + c >= 1.0) continue;
          elements.push_back({a + b * toB + c * toC, cross / glm::length(cross),
                              0.5 * glm::length(cross) / (kSteps * kSteps),
                              (1.0 - b - c) * Vec2d(uvs[0]) + b * Vec2d(uvs[1]) + c * Vec2d(uvs[2])});
        }
      }
    }
  }
};

TEST_P(PatternedLight, ThatIsAMeshOfManyTrianglesGivesItsSum) {
  const Sheet sheet;
  ASSERT_GT(sheet.triangles.size(), LightSampler::kMaxPieces);
  AreaLight light = triangleLight(sheet.triangles, true);
  givePattern(light, GetParam(), sheet.corners);
  for (const Vec3& point : kPoints) {
    const Estimate estimate = irradiance(light, point, kTilted, 256);
    EXPECT_NEAR(estimate.mean, sumOf(sheet.elements, GetParam(), point, kTilted, true),
                patternTolerance(estimate))
        << "height " << point.y;
  }
}

TEST_P(PatternedLight, ThatIsASphereGivesItsSum) {
  const Vec3d center(0.1, 1.2, 0.0);
  constexpr double kRadius = 0.4;
  constexpr int kSteps = 900;
  std::vector<Element> elements;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double y = -1.0 + 2.0 * (j + 0.5) / kSteps;  // equal areas
      const double longitude = 2.0 * kPiD * ((i + 0.5) / kSteps - 0.5);
      const double r = std::sqrt(1.0 - y * y);
      const Vec3d normal(r * std::sin(longitude), y, r * std::cos(longitude));
      elements.push_back({center + kRadius * normal,
                          normal,
                          4.0 * kPiD * kRadius * kRadius / (double(kSteps) * kSteps),
                          {(i + 0.5) / kSteps, 0.5 + std::asin(y) / kPiD}});
    }
  }
  AreaLight light = sphereLight(Vec3(center), static_cast<float>(kRadius));
  givePattern(light, GetParam(), {});
  for (const Vec3& point : kPoints) {
    const Estimate estimate = irradiance(light, point, kTilted, 256);
    EXPECT_NEAR(estimate.mean, sumOf(elements, GetParam(), point, kTilted), patternTolerance(estimate))
        << "height " << point.y;
  }
}

TEST_P(PatternedLight, ThatIsADiscGivesItsSum) {
  const Vec3d center(0.1, 1.0, 0.2);
  const Vec3 normal = glm::normalize(Vec3(0.3f, -1.0f, 0.1f));
  constexpr double kRadius = 0.6;
  const Frame frame = Frame::aboutNormal(normal);
  // Of the square around it, what is on the disc.
  std::vector<Element> elements;
  for (Element e : parallelogram(center - kRadius * (Vec3d(frame.x) + Vec3d(frame.y)),
                                 2.0 * kRadius * Vec3d(frame.x), 2.0 * kRadius * Vec3d(frame.y), 1200)) {
    if (glm::length(e.place - center) < kRadius) elements.push_back(e);
  }
  AreaLight light = discLight(Vec3(center), normal, static_cast<float>(kRadius));
  givePattern(light, GetParam(), {});
  for (const Vec3& point : kPoints) {
    const Estimate estimate = irradiance(light, point, kTilted, 256);
    EXPECT_NEAR(estimate.mean, sumOf(elements, GetParam(), point, kTilted), patternTolerance(estimate))
        << "height " << point.y;
  }
}

INSTANTIATE_TEST_SUITE_P(Textures, PatternedLight, testing::ValuesIn(texturesOfAllKinds()),
                         [](const auto& texture) {
                           std::string name = texture.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

/// A rectangle, a sheet, a sphere, a disc, and three pieces of all kinds.
std::vector<AreaLight> patternedLights(const NamedTexture& texture) {
  const Sheet sheet;
  std::vector<AreaLight> lights = {ceilingLight(-0.5f, 0.5f, -0.25f, 0.25f, 1),
                                   triangleLight(sheet.triangles, true), sphereLight({0, 1, 0}, 0.25f),
                                   discLight({0, 1, 0}, {0.3f, -1, 0}, 0.5f)};
  AreaLight& mixed = lights.emplace_back(triangleLight({sheet.triangles[0]}, true));
  mixed.spheres.push_back({{0, 1, 0.5f}, 0.2f});
  mixed.discs.push_back({{1, 1, 0}, {0, -1, 0}, 0.3f});
  const Corners half = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1)};
  const std::vector<std::vector<Corners>> corners = {
      {half, {Vec2(0, 0), Vec2(1, 1), Vec2(0, 1)}}, sheet.corners, {}, {}, {half}};
  for (std::size_t i = 0; i < lights.size(); ++i) givePattern(lights[i], texture, corners[i]);
  return lights;
}

// The density is that of the same light without a pattern, but for how often one of many pieces is chosen.
TEST(PatternedLightPdf, IsThatOfTheSample) {
  const NamedTexture texture = texturesOfAllKinds().front();
  for (const AreaLight& area : patternedLights(texture)) {
    const Light light = area;
    AreaLight evenArea = area;
    evenArea.pattern = nullptr;
    evenArea.finish();
    const Light even = evenArea;
    const bool byArea = area.pieceCount() > LightSampler::kMaxPieces;
    for (const Vec3& point : kPoints) {
      const LightSampler sampler(light, point);
      const LightSampler evenSampler(even, point);
      int reached = 0;
      int black = 0;
      double sum = 0.0;  // of 1 / density: the solid angle of what is sampled
      integrate(48, 4, [&](const Vec2& u) {
        LightSample sample, evenSample;
        const bool isLit = sampler.sample(u, sample);
        if (!byArea && evenSampler.sample(u, evenSample)) {
          EXPECT_EQ(sample.pdf, evenSample.pdf);
          EXPECT_EQ(sample.direction, evenSample.direction);
          for (int c = 0; c < 3; ++c) EXPECT_LE(sample.weight[c], evenSample.weight[c]);
          black += isLit ? 0 : 1;
        }
        if (!isLit) return 0.0;
        ++reached;
        sum += 1.0 / static_cast<double>(sample.pdf);
        if (area.pieceCount() <= 2) {
          EXPECT_EQ(sampler.pdf(sample.direction, 0), sample.pdf);
        } else if (byArea) {
          bool isOne = false;
          for (std::uint32_t piece = 0; piece < area.pieceCount(); ++piece)
            isOne = isOne || sampler.pdf(sample.direction, piece) == sample.pdf;
          EXPECT_TRUE(isOne);
        }
        return 0.0;
      });
      EXPECT_GT(reached, 100) << area.pieceCount() << " pieces";
      if (area.pieceCount() == 2) {
        EXPECT_GT(black, 100) << "the picture's right half";
      }
      EXPECT_EQ(sampler.pdf({0, 1, 0}, kNone), 0.0f) << "what is no piece is never sampled";
    }
  }
}

// Pieces on which the picture is black are not chosen, and bright ones more often.
TEST(PatternedLightPdf, PrefersBrightPiecesOfMany) {
  const AreaLight light = patternedLights(texturesOfAllKinds().front())[1];
  double below = 0.0;
  int dark = 0;
  for (std::size_t piece = 0; piece < light.areaCdf.size(); ++piece) {
    const double choice = light.areaCdf[piece] - below;
    below = light.areaCdf[piece];
    // The left half of the picture is bright, and its linear filter reaches half a pixel beyond.
    if (piece >= 30) {
      EXPECT_EQ(choice, 0.0) << piece;
    } else if (piece < 20) {
      EXPECT_GT(choice, 0.01) << piece;
    }
    dark += choice == 0.0 ? 1 : 0;
  }
  EXPECT_EQ(below, 1.0);
  EXPECT_EQ(dark, 10);
  // The whole sheet: its area is that without a pattern.
  EXPECT_NEAR(light.totalArea, triangleLight(Sheet().triangles).totalArea, 1e-9);
}

TEST(PatternedLightBatch, GivesTheBytesOfOneByOne) {
  for (const NamedTexture& texture : texturesOfAllKinds()) {
    for (const AreaLight& area : patternedLights(texture)) {
      const Light light = area;
      const LightSampler sampler(light, {0.1f, 0.2f, -0.1f});
      LightSampleBatch batch;
      for (std::uint32_t i = 0; i < LightSampleBatch::kCount; ++i) {
        batch.places.u[i] = uniform(randomKey(8), i, 0);
        batch.places.v[i] = uniform(randomKey(8), i, 1);
      }
      sampler.sample(11, batch);
      for (int i = 0; i < LightSampleBatch::kCount; ++i) {
        LightSample one;
        const bool reached = i < 11 && sampler.sample({batch.places.u[i], batch.places.v[i]}, one);
        ASSERT_EQ(batch.reached[i], reached) << texture.name << ", sample " << i;
        if (!reached) continue;
        ASSERT_EQ(batch.weight[i], one.weight) << texture.name << ", sample " << i;
      }
    }
  }
}

TEST(PatternedLightPower, IsThatOfTheMean) {
  for (const NamedTexture& named : texturesOfAllKinds()) {
    const AreaLight rectangle = patternedLights(named)[0];
    Vec3d sum(0.0);
    const std::vector<Element> elements =
        parallelogram({-0.5, 1.0, -0.25}, {1.0, 0.0, 0.0}, {0.0, 0.0, 0.5}, 500);
    for (const Element& e : elements)
      sum += Vec3d(Texture(named.texture).at(e.place / named.use.scale, Vec2(e.uv / named.use.scale)));
    const Rgb mean(sum / static_cast<double>(elements.size()));
    const Rgb found = rectangle.pattern->meanColor(rectangle);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], mean[c], 0.01f) << named.name;
    EXPECT_NEAR(lightPower(rectangle, 1.0f), kPi * 0.5f * luminance(mean), 0.02f) << named.name;
  }
}

// What is called black is so wherever it is asked, and what is black by far is called so.
TEST(PictureBrightness, TellsBlackExactly) {
  int black = 0;
  int lit = 0;
  int missed = 0;
  for (const TextureWrap wrap : {TextureWrap::Repeat, TextureWrap::Clamp}) {
    for (const TextureFilter filter : {TextureFilter::Linear, TextureFilter::Nearest}) {
      auto pixels = std::make_shared<ImageRgb>(16, 9, Rgb(0.0f));
      pixels->at(3, 2) = Rgb(0.0f, 1e-30f, 0.0f);  // brightness rounds up
      pixels->at(0, 7) = pixels->at(15, 0) = Rgb(0.5f);
      ImageTextureDescription image;
      image.pixels = pixels;
      image.wrap = wrap;
      image.filter = filter;
      const PictureBrightness brightness(image);
      const Texture texture({"", image});
      for (std::uint32_t i = 0; i < 4000; ++i) {
        const RandomKey key = randomKey(17).with(i);
        Corners corners;
        for (std::uint32_t c = 0; c < 3; ++c) {
          corners[c] = Vec2(-2.0f) + 4.0f * Vec2(uniform(key, 0, 0), uniform(key, 0, 1)) +
                       0.3f * Vec2(uniform(key, c, 2), uniform(key, c, 3));
        }
        bool isLit = false;
        for (std::uint32_t s = 0; s < 300 && !isLit; ++s) {
          const Vec2 u(uniform(key.with(7U), s, 0), uniform(key.with(7U), s, 1));
          const Vec2 b = u.x + u.y > 1.0f ? Vec2(1.0f) - u : u;
          const Vec2 uv = (1.0f - b.x - b.y) * corners[0] + b.x * corners[1] + b.y * corners[2];
          isLit = !isBlack(texture.at({}, uv));
        }
        // Of the rectangle around it, a pixel wider on each side.
        bool isNearLit = false;
        const Vec2 least = glm::min(glm::min(corners[0], corners[1]), corners[2]) - Vec2(1.1f / 16, 1.1f / 9);
        const Vec2 most = glm::max(glm::max(corners[0], corners[1]), corners[2]) + Vec2(1.1f / 16, 1.1f / 9);
        for (int s = 0; s < 900 && !isNearLit; ++s) {
          const Vec2 place((static_cast<float>(s % 30) + 0.5f) / 30,
                           (static_cast<float>(s / 30) + 0.5f) / 30);
          isNearLit = !isBlack(texture.at({}, glm::mix(least, most, place)));
        }
        const bool saysBlack = EmissionPattern::isBlackWithin(corners, {0, 1.0}, brightness);
        ASSERT_FALSE(isLit && saysBlack) << i;
        missed += !isNearLit && !saysBlack ? 1 : 0;
        (saysBlack ? black : lit) += 1;
      }
    }
  }
  EXPECT_GT(black, 1000);
  EXPECT_GT(lit, 1000);
  EXPECT_EQ(missed, 0) << "called lit, and black all around";
}

TEST(PictureBrightness, IsTheMeanOfTheRectangle) {
  auto pixels = std::make_shared<ImageRgb>(8, 8, Rgb(0.0f));
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 4; ++x) pixels->at(x, y) = Rgb(0.25f, 0.5f, 0.0f);
  }
  ImageTextureDescription image;
  image.pixels = pixels;
  image.filter = TextureFilter::Nearest;
  const PictureBrightness brightness(image);
  const auto meanOf = [&](float u0, float u1) {
    return brightness.meanWithin(std::array{Vec2(u0, 0.2f), Vec2(u1, 0.8f)});
  };
  EXPECT_NEAR(meanOf(0.01f, 0.45f), 0.5, 2e-5);
  EXPECT_NEAR(meanOf(0.01f, 0.99f), 0.25, 2e-5);
  EXPECT_NEAR(meanOf(0.01f, 0.74f), 1.0 / 3.0, 2e-5) << "four bright of six columns";
  EXPECT_EQ(meanOf(0.55f, 0.99f), 0.0);
  EXPECT_NEAR(meanOf(0.80f, 1.2f), 0.25, 2e-5) << "around the edge: two dark columns, two bright ones";
  EXPECT_NEAR(meanOf(-5.0f, 5.0f), 0.25, 2e-5);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NEAR(brightness.meanWithin(std::array{Vec2(nan, 0.2f), Vec2(nan, 0.8f)}), 0.25, 2e-5);
}

}  // namespace
}  // namespace lightvane
