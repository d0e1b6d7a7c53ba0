#include "core/measure/masks.h"

#include <algorithm>
#include <cmath>

#include "core/base/check.h"
#include "core/base/color.h"
#include "core/base/math.h"

namespace lightvane {
namespace {

/// About 25 degrees. On a ball of 5 pixels across neighbours differ by as much: such balls are all edge.
constexpr float kCosineOfEdge = 0.9f;
/// Of the distance. The inverse distance of a plane is all but linear along a row of pixels, at any angle (it
/// is exactly so of depth along the camera's axis), so that this need not let pass what is merely slanted.
/// Smaller steps are detail of a surface.
constexpr float kStepOfEdge = 0.01f;

bool isFold(const Rgb& a, const Rgb& b) {
  const float lengths = std::sqrt(glm::dot(a, a) * glm::dot(b, b));
  if (isBlack(a) && isBlack(b)) return false;
  // What is not a number is an edge, too.
  return !(glm::dot(a, b) >= kCosineOfEdge * lengths) || !(lengths > 0.0f);
}

/// Where three pixels in a row have a step, and to which side of the middle: -1, 1, or 0 for none.
int stepSide(float before, float here, float after) {
  const float a = 1.0f / before, b = 1.0f / here, c = 1.0f / after;
  const float bend = std::abs(a - 2.0f * b + c);
  if (bend <= kStepOfEdge * std::max({std::abs(a), std::abs(b), std::abs(c)})) return 0;
  return std::abs(b - a) > std::abs(c - b) ? -1 : 1;
}

template <class Pixel>
void checkSameSize(const ImageFloat& mask, const Image<Pixel>& image, const char* name) {
  LV_CHECK(image.width() == mask.width() && image.height() == mask.height(), "{} of {}x{} pixels for {}x{}",
           name, image.width(), image.height(), mask.width(), mask.height());
}

/// The least of the pixels within `reach` along both axes.
ImageFloat eroded(const ImageFloat& mask, int reach) {
  ImageFloat rows = mask, both = mask;
  for (int y = 0; y < mask.height(); ++y) {
    for (int x = 0; x < mask.width(); ++x) {
      for (int nx = std::max(x - reach, 0); nx <= std::min(x + reach, mask.width() - 1); ++nx)
        rows.at(x, y) = std::min(rows.at(x, y), mask.at(nx, y));
    }
  }
  for (int y = 0; y < mask.height(); ++y) {
    for (int ny = std::max(y - reach, 0); ny <= std::min(y + reach, mask.height() - 1); ++ny) {
      for (int x = 0; x < mask.width(); ++x) both.at(x, y) = std::min(both.at(x, y), rows.at(x, ny));
    }
  }
  return both;
}

}  // namespace

ImageFloat edgeMask(const ImageFloat& depth, const ImageRgb& normal, int reach) {
  const bool byDepth = !depth.empty(), byNormal = !normal.empty();
  LV_CHECK(byDepth || byNormal, "neither depth nor normals");
  LV_CHECK(reach >= 1, "edges that reach {} pixels", reach);
  ImageFloat mask = byDepth ? ImageFloat(depth.width(), depth.height(), 1.0f)
                            : ImageFloat(normal.width(), normal.height(), 1.0f);
  if (byNormal) checkSameSize(mask, normal, "normals");
  const int width = mask.width(), height = mask.height();
  const auto markLink = [&](int x, int y, int dx, int dy) {
    mask.at(x, y) = 0.0f;
    mask.at(x + dx, y + dy) = 0.0f;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (byNormal && x + 1 < width && isFold(normal.at(x, y), normal.at(x + 1, y))) markLink(x, y, 1, 0);
      if (byNormal && y + 1 < height && isFold(normal.at(x, y), normal.at(x, y + 1))) markLink(x, y, 0, 1);
      if (byDepth && x > 0 && x + 1 < width) {
        const int side = stepSide(depth.at(x - 1, y), depth.at(x, y), depth.at(x + 1, y));
        if (side != 0) markLink(x, y, side, 0);
      }
      if (byDepth && y > 0 && y + 1 < height) {
        const int side = stepSide(depth.at(x, y - 1), depth.at(x, y), depth.at(x, y + 1));
        if (side != 0) markLink(x, y, 0, side);
      }
    }
  }
  // Both pixels of an edge are marked already.
  return eroded(mask, reach - 1);
}

ImageFloat lightMask(const ImageRgb& emission) {
  ImageFloat mask(emission.width(), emission.height());
  // What is not a number is no surface to be judged, either.
  for (std::size_t i = 0; i < emission.size(); ++i) mask[i] = isBlack(emission[i]) ? 1.0f : 0.0f;
  return mask;
}

ImageFloat bothMasks(const ImageFloat& a, const ImageFloat& b) {
  if (a.empty() || b.empty()) return a.empty() ? b : a;
  checkSameSize(a, b, "a mask");
  ImageFloat mask(a.width(), a.height());
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = a[i] > 0.0f && b[i] > 0.0f ? 1.0f : 0.0f;
  return mask;
}

}  // namespace lightvane
