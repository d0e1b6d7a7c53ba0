#include "core/measure/masks.h"

#include <gtest/gtest.h>

#include "core/base/check.h"

namespace lightvane {
namespace {

std::string rowOf(const ImageFloat& mask, int y) {
  std::string text;
  for (int x = 0; x < mask.width(); ++x) text += mask.at(x, y) > 0.0f ? '1' : '0';
  return text;
}

ImageFloat depthSteps(float step) {
  ImageFloat depth(12, 5, 2.0f);
  for (int y = 0; y < 5; ++y) {
    for (int x = 6; x < 12; ++x) depth.at(x, y) = 2.0f * step;
  }
  return depth;
}

TEST(EdgeMask, LeavesOutBothSidesOfAStep) {
  EXPECT_EQ(rowOf(edgeMask(depthSteps(1.5f), {}, 1), 2), "111110011111");
  EXPECT_EQ(rowOf(edgeMask(depthSteps(1.5f), {}, 2), 2), "111100001111");
  EXPECT_EQ(rowOf(edgeMask(depthSteps(1.5f), {}), 0), "111100001111");
  EXPECT_EQ(rowOf(edgeMask(depthSteps(1.005f), {}, 1), 2), "111111111111");
}

TEST(EdgeMask, LeavesOutStepsAlongBothAxes) {
  ImageFloat depth(5, 12, 2.0f);
  for (int y = 6; y < 12; ++y) {
    for (int x = 0; x < 5; ++x) depth.at(x, y) = 3.0f;
  }
  const ImageFloat mask = edgeMask(depth, {}, 1);
  for (int y = 0; y < 12; ++y) EXPECT_EQ(rowOf(mask, y), y == 5 || y == 6 ? "00000" : "11111") << y;
}

TEST(EdgeMask, LeavesOutTheOutlineAgainstNothing) {
  ImageFloat depth = depthSteps(1.0f);
  for (int y = 0; y < 5; ++y) {
    for (int x = 6; x < 12; ++x) depth.at(x, y) = std::numeric_limits<float>::infinity();
  }
  EXPECT_EQ(rowOf(edgeMask(depth, {}, 1), 2), "111110011111");
  EXPECT_EQ(rowOf(edgeMask(ImageFloat(12, 5, std::numeric_limits<float>::infinity()), {}), 2),
            "111111111111");
}

// A floor seen at a grazing angle: from a height of 1 and a pixel at slope k / 200 below the horizon, the
// distance along the ray grows twofold from pixel to pixel at the far end.
TEST(EdgeMask, KeepsASlantedPlane) {
  ImageFloat depth(5, 60);
  for (int y = 0; y < 60; ++y) {
    const float slope = static_cast<float>(y + 2) / 200.0f;
    for (int x = 0; x < 5; ++x) depth.at(x, y) = std::sqrt(1.0f + slope * slope) / slope;
  }
  const ImageFloat mask = edgeMask(depth, {}, 1);
  for (int y = 0; y < 60; ++y) EXPECT_EQ(rowOf(mask, y), "11111") << y;
}

TEST(EdgeMask, LeavesOutFolds) {
  ImageRgb normal(10, 3, Rgb(0.0f, 0.0f, 1.0f));
  for (int y = 0; y < 3; ++y) {
    for (int x = 4; x < 10; ++x) normal.at(x, y) = Rgb(1.0f, 0.0f, 0.0f);
  }
  EXPECT_EQ(rowOf(edgeMask({}, normal, 1), 1), "1110011111");
  for (int y = 0; y < 3; ++y) {
    for (int x = 4; x < 10; ++x) normal.at(x, y) = Rgb(0.3f, 0.0f, 2.0f);  // 8.5 degrees, not of unit length
  }
  EXPECT_EQ(rowOf(edgeMask({}, normal, 1), 1), "1111111111");
  for (int y = 0; y < 3; ++y) {
    for (int x = 4; x < 10; ++x) normal.at(x, y) = Rgb(0.0f);  // nothing was met
  }
  EXPECT_EQ(rowOf(edgeMask({}, normal, 1), 1), "1110011111");
}

TEST(EdgeMask, OfTinyPicturesKeepsAll) {
  EXPECT_EQ(rowOf(edgeMask(ImageFloat(1, 1, 2.0f), ImageRgb(1, 1, Rgb(0.0f, 0.0f, 1.0f))), 0), "1");
  EXPECT_THROW(edgeMask({}, {}), InvariantViolation);
  EXPECT_THROW(edgeMask(ImageFloat(2, 1), ImageRgb(1, 2)), InvariantViolation);
}

TEST(LightMask, LeavesOutWhatEmits) {
  ImageRgb emission(4, 1);
  emission.at(1, 0) = Rgb(0.0f, 0.0f, 1e-6f);
  emission.at(2, 0) = Rgb(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
  EXPECT_EQ(rowOf(lightMask(emission), 0), "1001");
}

TEST(BothMasks, CountWhatBothCount) {
  ImageFloat a(4, 1, 1.0f), b(4, 1, 1.0f);
  a.at(0, 0) = 0.0f;
  b.at(2, 0) = 0.0f;
  EXPECT_EQ(rowOf(bothMasks(a, b), 0), "0101");
  EXPECT_EQ(bothMasks({}, b), b);
  EXPECT_EQ(bothMasks(a, {}), a);
  EXPECT_TRUE(bothMasks({}, {}).empty());
}

}  // namespace
}  // namespace lightvane
