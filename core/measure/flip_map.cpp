#include "core/measure/flip_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "core/base/check.h"
#include "core/base/color.h"
#include "core/base/math.h"
#include "core/measure/separable_filter.h"

// Symbols of the paper: Y, Cx, Cz the linearised opponent space, in which eyes' contrast sensitivity filters;
// L*a*b* the perceptual one, in which colours are compared (its section 4.1); edges and points the features
// (4.2). The filters for 67 pixels per degree reach 10 and 9 pixels.
//
// All filters are separable: the contrast sensitivity of Cz is a sum of two Gaussians, which are filtered
// apart.

namespace lightvane {
namespace {

const double kPixelsPerDegree = 0.7 * (3840.0 / 0.7) * kPiD / 180.0;

constexpr float kColorExponent = 0.7f;          // q_c
constexpr float kColorKnee = 0.4f;              // p_c: this part of the largest difference is shown ...
constexpr float kColorKneeError = 0.95f;        // p_t: ... as this error
constexpr double kFeatureWidthDegrees = 0.082;  // w
constexpr float kInverseSqrt2 = 0.70710678f;

/// Linear Rec. 709 to CIE XYZ, D65 (the authors' source: image-engineering.de, technote 958), divided by what
/// white gives, so that white is (1, 1, 1).
Rgb toNormalizedXyz(const Rgb& c) {
  constexpr glm::vec3 kInverseWhite(1.052156925f, 1.0f, 0.918357670f);
  constexpr float kX = 24577794.0f, kY = 12288897.0f, kZ = 73733382.0f;
  const glm::vec3 xyz(10135552.0f / kX * c.r + 8788810.0f / kX * c.g + 4435075.0f / kX * c.b,
                      2613072.0f / kY * c.r + 8788810.0f / kY * c.g + 887015.0f / kY * c.b,
                      1425312.0f / kZ * c.r + 8788810.0f / kZ * c.g + 70074185.0f / kZ * c.b);
  return xyz * kInverseWhite;
}

Rgb fromNormalizedXyz(const glm::vec3& normalized) {
  constexpr glm::vec3 kWhite(0.950428545f, 1.0f, 1.088900371f);
  const glm::vec3 c = normalized * kWhite;
  return {3.241003275f * c.x - 1.537398934f * c.y - 0.498615861f * c.z,
          -0.969224334f * c.x + 1.875930071f * c.y + 0.041554224f * c.z,
          0.055639423f * c.x - 0.204011202f * c.y + 1.057148933f * c.z};
}

glm::vec3 toYCxCz(const Rgb& linear) {
  const glm::vec3 c = toNormalizedXyz(linear);
  return {116.0f * c.y - 16.0f, 500.0f * (c.x - c.y), 200.0f * (c.y - c.z)};
}

Rgb fromYCxCz(const glm::vec3& opponent) {
  const float y = (opponent.x + 16.0f) / 116.0f;
  return fromNormalizedXyz({y + opponent.y / 500.0f, y, y - opponent.z / 200.0f});
}

/// L*a*b* with its chroma lessened where it is dark (Hunt 1952).
glm::vec3 toHuntLab(const Rgb& linear) {
  constexpr float kDelta = 6.0f / 29.0f;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
  };
  const glm::vec3 c = toNormalizedXyz(linear);
  const float x = f(c.x), y = f(c.y), z = f(c.z);
  const float lightness = 116.0f * y - 16.0f;
  const float hunt = 0.01f * lightness;
  return {lightness, hunt * 500.0f * (x - y), hunt * 200.0f * (y - z)};
}

/// HyAB (Abasi et al. 2020): city blocks in lightness, Euclidean in chroma. To the power q_c.
float colorDistance(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 d = a - b;
  return std::pow(std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z), kColorExponent);
}

/// The distance in [0, 1]: `largest`, that of green and blue, is 1.
float colorError(float distance, float largest) {
  const float knee = kColorKnee * largest;
  return distance < knee ? kColorKneeError / knee * distance
                         : kColorKneeError + (distance - knee) / (largest - knee) * (1.0f - kColorKneeError);
}

/// Taps of exp(-pi^2 x^2 / b), x in degrees.
std::vector<double> sensitivity(double b, int reach) {
  std::vector<double> taps;
  for (int k = -reach; k <= reach; ++k) taps.push_back(std::exp(-square(kPiD * k / kPixelsPerDegree) / b));
  return taps;
}

double sumOf(const std::vector<double>& taps) {
  double sum = 0.0;
  for (const double tap : taps) sum += tap;
  return sum;
}

std::vector<float> scaled(const std::vector<double>& taps, double scale) {
  std::vector<float> result;
  for (const double tap : taps) result.push_back(static_cast<float>(tap * scale));
  return result;
}

/// Positive taps sum to 1, negative ones to -1.
std::vector<float> balanced(const std::vector<double>& taps) {
  double positive = 0.0, negative = 0.0;
  for (const double tap : taps) (tap > 0.0 ? positive : negative) += std::abs(tap);
  std::vector<float> result;
  for (const double tap : taps) result.push_back(static_cast<float>(tap / (tap > 0.0 ? positive : negative)));
  return result;
}

struct Kernels {
  std::vector<float> y, cx, cz1, cz2;      // contrast sensitivity; Cz's is the sum of both
  std::vector<float> smooth, edge, point;  // a Gaussian and its first two derivatives
};

Kernels makeKernels() {
  // The paper's table 1: a sum of a_i sqrt(pi / b_i) exp(-pi^2 x^2 / b_i).
  constexpr double kBY = 0.0047, kBCx = 0.0053;
  constexpr double kA1 = 34.1, kB1 = 0.04, kA2 = 13.5, kB2 = 0.025;  // of Cz
  const int reach =
      static_cast<int>(std::ceil(3.0 * std::sqrt(kB1 / (2.0 * square(kPiD))) * kPixelsPerDegree));
  Kernels kernels;
  const std::vector<double> y = sensitivity(kBY, reach), cx = sensitivity(kBCx, reach);
  kernels.y = scaled(y, 1.0 / sumOf(y));
  kernels.cx = scaled(cx, 1.0 / sumOf(cx));
  // Each of the two is filtered along both directions, so that its weight's root goes to each; together they
  // sum to 1.
  const std::vector<double> first = sensitivity(kB1, reach), second = sensitivity(kB2, reach);
  const double weight1 = std::sqrt(kA1 * std::sqrt(kPiD / kB1)),
               weight2 = std::sqrt(kA2 * std::sqrt(kPiD / kB2));
  const double norm = 1.0 / std::hypot(weight1 * sumOf(first), weight2 * sumOf(second));
  kernels.cz1 = scaled(first, weight1 * norm);
  kernels.cz2 = scaled(second, weight2 * norm);

  const double deviation = 0.5 * kFeatureWidthDegrees * kPixelsPerDegree;
  const int featureReach = static_cast<int>(std::ceil(3.0 * deviation));
  std::vector<double> smooth, edge, point;
  for (int x = -featureReach; x <= featureReach; ++x) {
    smooth.push_back(std::exp(-0.5 * square(x / deviation)));
    edge.push_back(-x * smooth.back());
    point.push_back((square(x / deviation) - 1.0) * smooth.back());
  }
  kernels.smooth = scaled(smooth, 1.0 / sumOf(smooth));
  kernels.edge = balanced(edge);
  kernels.point = balanced(point);
  return kernels;
}

/// One picture's channels, and a row of each once it was filtered.
class FilteredPicture {
 public:
  FilteredPicture(const ImageRgb& linear, const Kernels& kernels) : kernels_(kernels) {
    for (ImageFloat* channel : {&y_, &cx_, &cz_, &gray_})
      *channel = ImageFloat(linear.width(), linear.height());
    for (std::size_t i = 0; i < linear.size(); ++i) {
      const glm::vec3 opponent = toYCxCz(linear[i]);
      y_[i] = opponent.x;
      cx_[i] = opponent.y;
      cz_[i] = opponent.z;
      gray_[i] = opponent.x / 116.0f + 16.0f / 116.0f;
    }
    for (Row* row : {&column_, &yRow_, &cxRow_, &czRow1_, &czRow2_, &edgeX_, &edgeY_, &pointX_, &pointY_})
      row->resize(static_cast<std::size_t>(linear.width()));
  }

  void filter(int y) {
    filterAlongY(y_, y, kernels_.y);
    filterAlongX(kernels_.y, yRow_);
    filterAlongY(cx_, y, kernels_.cx);
    filterAlongX(kernels_.cx, cxRow_);
    filterAlongY(cz_, y, kernels_.cz1);
    filterAlongX(kernels_.cz1, czRow1_);
    filterAlongY(cz_, y, kernels_.cz2);
    filterAlongX(kernels_.cz2, czRow2_);
    filterAlongY(gray_, y, kernels_.smooth);
    filterAlongX(kernels_.edge, edgeX_);
    filterAlongX(kernels_.point, pointX_);
    filterAlongY(gray_, y, kernels_.edge);
    filterAlongX(kernels_.smooth, edgeY_);
    filterAlongY(gray_, y, kernels_.point);
    filterAlongX(kernels_.smooth, pointY_);
  }

  // Of pixel x of the row that was filtered last.
  glm::vec3 color(std::size_t x) const {
    const Rgb linear = fromYCxCz({yRow_[x], cxRow_[x], czRow1_[x] + czRow2_[x]});
    return toHuntLab(glm::clamp(linear, 0.0f, 1.0f));
  }
  float edge(std::size_t x) const { return std::sqrt(edgeX_[x] * edgeX_[x] + edgeY_[x] * edgeY_[x]); }
  float point(std::size_t x) const { return std::sqrt(pointX_[x] * pointX_[x] + pointY_[x] * pointY_[x]); }

 private:
  using Row = std::vector<float>;

  void filterAlongY(const ImageFloat& channel, int y, const std::vector<float>& kernel) {
    filterColumns(channel, y, kernel, column_);
  }
  /// What was filtered along y.
  void filterAlongX(const std::vector<float>& kernel, Row& out) {
    filterRow<float>(column_, kernel, FilterBorder::Nearest, out, padded_);
  }

  const Kernels& kernels_;
  ImageFloat y_, cx_, cz_, gray_;
  Row column_, padded_;
  Row yRow_, cxRow_, czRow1_, czRow2_, edgeX_, edgeY_, pointX_, pointY_;
};

}  // namespace

ImageFloat flipMap(const ImageRgb& picture, const ImageRgb& reference) {
  LV_CHECK(picture.width() == reference.width() && picture.height() == reference.height(),
           "{}x{} pixels against {}x{}", picture.width(), picture.height(), reference.width(),
           reference.height());
  const Kernels kernels = makeKernels();
  const float largest = colorDistance(toHuntLab(Rgb(0.0f, 1.0f, 0.0f)), toHuntLab(Rgb(0.0f, 0.0f, 1.0f)));
  FilteredPicture a(picture, kernels), b(reference, kernels);
  ImageFloat map(reference.width(), reference.height());
  for (int y = 0; y < reference.height(); ++y) {
    a.filter(y);
    b.filter(y);
    for (std::size_t x = 0; x < static_cast<std::size_t>(reference.width()); ++x) {
      const float color = colorError(colorDistance(a.color(x), b.color(x)), largest);
      const float feature = std::max(std::abs(a.edge(x) - b.edge(x)), std::abs(a.point(x) - b.point(x)));
      // Its exponent q_f is 0.5.
      map[reference.index(0, y) + x] = std::pow(color, 1.0f - std::sqrt(kInverseSqrt2 * feature));
    }
  }
  return map;
}

}  // namespace lightvane
