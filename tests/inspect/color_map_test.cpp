#include "core/inspect/color_map.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/base/color.h"
#include "core/inspect/view_image.h"

// Colours as numbers: CIE L*a*b* under D65, and the same after a simulation of dichromats by Machado,
// Oliveira & Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency", 2009,
// severity 1.

namespace lightvane {
namespace {

Rgb linearOf(Color8 c) {
  return {decodeSrgb(static_cast<float>(c.r) / 255.0f), decodeSrgb(static_cast<float>(c.g) / 255.0f),
          decodeSrgb(static_cast<float>(c.b) / 255.0f)};
}

Vec3 labOf(const Rgb& linear) {
  const float x = (0.4124564f * linear.r + 0.3575761f * linear.g + 0.1804375f * linear.b) / 0.95047f;
  const float y = 0.2126729f * linear.r + 0.7151522f * linear.g + 0.0721750f * linear.b;
  const float z = (0.0193339f * linear.r + 0.1191920f * linear.g + 0.9503041f * linear.b) / 1.08883f;
  const auto f = [](float t) {
    return t > 216.0f / 24389.0f ? std::cbrt(t) : t * 841.0f / 108.0f + 4.0f / 29.0f;
  };
  return {116.0f * f(y) - 16.0f, 500.0f * (f(x) - f(y)), 200.0f * (f(y) - f(z))};
}

enum class Vision { Normal, Protanope, Deuteranope };
constexpr Vision kVisions[] = {Vision::Normal, Vision::Protanope, Vision::Deuteranope};
const char* nameOf(Vision vision) {
  return vision == Vision::Normal ? "normal" : vision == Vision::Protanope ? "protanope" : "deuteranope";
}

Vec3 labSeenBy(Vision vision, Color8 color) {
  const Rgb c = linearOf(color);
  Rgb seen = c;
  if (vision == Vision::Protanope) {
    seen = {0.152286f * c.r + 1.052583f * c.g - 0.204868f * c.b,
            0.114503f * c.r + 0.786281f * c.g + 0.099216f * c.b,
            -0.003882f * c.r - 0.048116f * c.g + 1.051998f * c.b};
  } else if (vision == Vision::Deuteranope) {
    seen = {0.367322f * c.r + 0.860646f * c.g - 0.227968f * c.b,
            0.280085f * c.r + 0.672501f * c.g + 0.047413f * c.b,
            -0.011820f * c.r + 0.042940f * c.g + 0.968881f * c.b};
  }
  return labOf(glm::clamp(seen, 0.0f, 1.0f));
}

// One step of a byte is up to 0.6 of L*, so that a table of bytes may fall back by less; over eight entries a
// map that rises must have risen.
constexpr float kByteStep = 0.6f;

TEST(ColorMap, LightnessRisesForAllKindsOfVision) {
  for (const ColorMap map : {ColorMap::Grey, ColorMap::Viridis, ColorMap::Cividis}) {
    const auto table = colorTable(map);
    for (const Vision vision : kVisions) {
      for (std::size_t i = 1; i < table.size(); ++i) {
        const float rise = labSeenBy(vision, table[i]).x - labSeenBy(vision, table[i - 1]).x;
        EXPECT_GT(rise, -kByteStep) << "map " << static_cast<int>(map) << ", entry " << i << ", "
                                    << nameOf(vision) << ": L* falls by " << -rise;
        if (i < 8) continue;
        const float over8 = labSeenBy(vision, table[i]).x - labSeenBy(vision, table[i - 8]).x;
        EXPECT_GT(over8, 0.0f) << "map " << static_cast<int>(map) << ", entry " << i << ", "
                               << nameOf(vision);
      }
      const float range = labSeenBy(vision, table[255]).x - labSeenBy(vision, table[0]).x;
      EXPECT_GT(range, 65.0f) << "map " << static_cast<int>(map) << ", " << nameOf(vision);
    }
  }
}

TEST(ColorMap, ViridisIsThePublishedTable) {
  // Nine entries of matplotlib's table, 32 apart.
  constexpr Color8 kPublished[] = {{68, 1, 84},    {71, 44, 122},  {59, 81, 139},
                                   {44, 113, 142}, {33, 144, 141}, {39, 173, 129},
                                   {92, 200, 99},  {170, 220, 50}, {253, 231, 37}};
  for (std::size_t i = 0; i < std::size(kPublished); ++i) {
    const Color8 ours = colorAt(ColorMap::Viridis, static_cast<float>(i) / 8.0f);
    const int worst = std::max({std::abs(ours.r - kPublished[i].r), std::abs(ours.g - kPublished[i].g),
                                std::abs(ours.b - kPublished[i].b)});
    EXPECT_LE(worst, 4) << "entry " << i << ": " << int{ours.r} << " " << int{ours.g} << " " << int{ours.b};
  }
}

TEST(ColorMap, CividisEndsAsPublished) {
  const Color8 low = colorAt(ColorMap::Cividis, 0.0f);
  const Color8 high = colorAt(ColorMap::Cividis, 1.0f);
  // Table entries 0 and 255 are (0, 34, 78) and (254, 232, 56); the polynomial's own error is 13 of 255.
  EXPECT_NEAR(low.b, 78, 13);
  EXPECT_NEAR(low.g, 34, 13);
  EXPECT_NEAR(high.r, 254, 13);
  EXPECT_NEAR(high.g, 232, 13);
  EXPECT_NEAR(high.b, 56, 14);
}

TEST(ColorMap, DivergingIsSymmetricAndItsSidesDiffer) {
  const auto table = colorTable(ColorMap::Diverging);
  for (const Vision vision : kVisions) {
    for (std::size_t i = 0; i < 128; ++i) {
      const Vec3 low = labSeenBy(vision, table[i]);
      const Vec3 high = labSeenBy(vision, table[255 - i]);
      if (vision == Vision::Normal) {
        EXPECT_NEAR(low.x, high.x, kByteStep) << "entry " << i;
      }
      if (i > 0) {
        EXPECT_GT(low.x, labSeenBy(vision, table[i - 1]).x - kByteStep) << "entry " << i;
      }
      // A just noticeable difference is about 2.3 (Mahy et al. 1994): opposite values must never be taken for
      // each other once they are a tenth of the range from the middle.
      if (i < 115) {
        EXPECT_GT(glm::length(low - high), 8.0f) << "entry " << i << ", " << nameOf(vision);
      }
    }
  }
}

TEST(ColorMap, PositionsAreClamped) {
  const auto table = colorTable(ColorMap::Viridis);
  EXPECT_EQ(colorAt(ColorMap::Viridis, -1.0f), table[0]);
  EXPECT_EQ(colorAt(ColorMap::Viridis, NAN), table[0]);
  EXPECT_EQ(colorAt(ColorMap::Viridis, 2.0f), table[255]);
  EXPECT_EQ(colorAt(ColorMap::Viridis, 100.0f / 255.0f), table[100]);
}

TEST(CategoryColors, AnyTwoDifferForAllKindsOfVision) {
  std::vector<Color8> colors;
  for (std::size_t i = 0; i < 5; ++i) colors.push_back(categoryColor(ColorFamily::Warm, i));
  for (std::size_t i = 0; i < 4; ++i) colors.push_back(categoryColor(ColorFamily::Cool, i));
  for (const Vision vision : kVisions) {
    for (std::size_t i = 0; i < colors.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT(glm::length(labSeenBy(vision, colors[i]) - labSeenBy(vision, colors[j])), 15.0f)
            << "colours " << j << " and " << i << ", " << nameOf(vision);
      }
    }
  }
  EXPECT_EQ(categoryColor(ColorFamily::Warm, 5), colors[0]);
  EXPECT_EQ(categoryColor(ColorFamily::Cool, 4), colors[5]);
}

// Any two of them may stand side by side, as single pixels.
TEST(CategoryColors, WhereLightWasComputedIsToldApartByAllKindsOfVision) {
  const std::vector<ViewCategory> categories = whereCategories();
  for (const Vision vision : kVisions) {
    for (std::size_t i = 0; i < categories.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const float apart =
            glm::length(labSeenBy(vision, categories[i].color) - labSeenBy(vision, categories[j].color));
        EXPECT_GT(apart, 20.0f) << categories[i].name << " and " << categories[j].name << ", "
                                << nameOf(vision);
      }
    }
  }
}

}  // namespace
}  // namespace lightvane
