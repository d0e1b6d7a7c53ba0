#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/scene/lights.h"
#include "core/scene/texture.h"

namespace lightvane {

/// How bright a picture is over rectangles of its pixels: a summed-area table (F. Crow, Summed-Area Tables
/// for Texture Mapping, SIGGRAPH 1984) of each pixel's strongest component, in whole numbers that are rounded
/// up. Sums are exact, so that what is black is told from what is nearly so. Immutable; 8 bytes a pixel.
class PictureBrightness {
 public:
  explicit PictureBrightness(const ImageTextureDescription& image);

  /// The mean over the pixels that may be shown between texture coordinates (over the use's scale) of these
  /// corners, in [0, 1]: their bounding rectangle, and what the picture's filter and the rounding of
  /// interpolated coordinates reach beyond. 0 only where nothing but black can be shown.
  double meanWithin(std::span<const Vec2> corners) const;

 private:
  /// Pixels from `begin` up to before `end` of a row or a column, in order; two such parts where they go
  /// around the picture's edge, else the second is empty.
  struct Part {
    int begin = 0, end = 0;
  };
  using Parts = std::array<Part, 2>;
  Parts partsOf(double least, double greatest, int count) const;
  std::uint64_t sumOf(const Part& columns, const Part& rows) const;
  std::size_t index(int column, int row) const;

  int width_, height_;
  TextureWrap wrap_;
  TextureFilter filter_;
  std::vector<std::uint64_t> sums_;  ///< of what is left of and above each pixel's corner, row by row
};

/// What a texture leaves of the radiance of an area light, from place to place. Immutable; any thread.
class EmissionPattern {
 public:
  /// Texture coordinates of a triangle's corners.
  using Corners = std::array<Vec2, 3>;

  /// `corners` has an entry for each of the light's triangles. The light must have its pieces, and its
  /// polygon if it is one; it needs to be finished no more than that. `brightness`, of an image texture's
  /// picture, may be null where the light has no more than LightSampler::kMaxPieces pieces.
  EmissionPattern(Texture texture, const TextureUse& use, const Normalisation& normalisation,
                  std::vector<Corners> corners, const AreaLight& light, const PictureBrightness* brightness);

  /// The texture's colour where `position` (normalised units) is on a piece of the light, which is numbered
  /// as the LightSampler has it. What lies beyond a piece for rounding has the colour of the place beside it.
  /// All triangles of a light that is one polygon share one map, so that any of their numbers will do.
  Rgb colorAt(const AreaLight& light, std::size_t piece, const Vec3d& position) const;

  /// By how much its texture is to change how often a piece is chosen: above 0 unless all of it is black. The
  /// picture's brightness around the piece, where PictureBrightness was given; else 1.
  double brightness(std::size_t piece) const { return brightness_.empty() ? 1.0 : brightness_[piece]; }

  /// The mean over the area of all pieces, of 4096 places or one on each piece, if they are more.
  Rgb meanColor(const AreaLight& light) const;

  /// Whether what is within these texture coordinates of a triangle is black wherever it is asked.
  static bool isBlackWithin(const Corners& corners, const TextureUse& use,
                            const PictureBrightness& brightness);

 private:
  Vec2 uvAt(const AreaLight& light, std::size_t piece, const Vec3d& position) const;
  Vec2 uvOfTriangle(const AreaLight& light, std::size_t triangle, const Vec3d& position) const;

  Texture texture_;
  TextureUse use_;
  Normalisation normalisation_;
  std::vector<Corners> corners_;
  std::vector<double> brightness_;
  std::size_t widest_ = 0;             ///< of the triangles
  Vec2 least_{0.0f}, greatest_{0.0f};  ///< of a polygon's texture coordinates
};

}  // namespace lightvane
