#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "core/base/tasks.h"
#include "core/render/film.h"
#include "core/render/parameters.h"
#include "core/trace/light_sight.h"
#include "core/vectors/answer.h"

namespace lightvane {

/// A point at which a pixel needs direct and indirect light, and the throughput that led there.
struct VisiblePoint {
  Vec3 position;
  Vec3 geometricNormal;
  Vec3 normal;     ///< shading normal
  Vec3 tangent;    ///< x axis of the shading frame
  Vec3 outgoing;   ///< towards the viewer
  Rgb throughput;  ///< pixel filter included
  float offset;
  float clearance;  ///< distance to what stands over it, along the normal; infinity where that is nothing or
                    ///< not asked
  float footprint;  ///< width of a pixel of a picture 256 pixels high, here
  /// Of ILVs that are computed here: a curved mirror makes small what it shows, and pixels that see the place
  /// straight ask its vectors, too.
  float vectorFootprint;
  std::uint32_t surface;
  std::uint32_t pixel;   ///< index into the region's picture
  std::uint16_t sample;  ///< of the pixel
  bool frontSide;
  bool throughSpecular;    ///< reached by way of mirrors or glass
  const Tint* ofTextures;  ///< of the tile; null where the material has none

  /// What textures leave of the material's colours.
  const Tint& tint() const {
    static constexpr Tint kUntextured;
    return ofTextures != nullptr ? *ofTextures : kUntextured;
  }
  Frame frame() const { return {tangent, glm::cross(normal, tangent), normal}; }
  /// The point as the samplers of light want it.
  LitPoint lit(const Scene& scene) const;
};

/// Points of a tile that are answered together: one BRDF, alike in normal, near in space.
struct PointCluster {
  std::vector<std::uint32_t> points;  ///< indices into VisibleTile::points, ascending
  Ball ball;                          ///< holds all of them
};

/// The visible points of one tile of the picture.
struct VisibleTile {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< in the region's picture
  std::vector<VisiblePoint> points;    ///< by pixel, row by row
  /// Of the points with textures, which point here: shared by the tile's copies. Null where there are none.
  std::shared_ptr<std::deque<Tint>> tints;
  std::vector<PointCluster> clusters;
};

/// Holds these points of the tile, rounding included.
Ball ballAround(const VisibleTile& tile, std::span<const std::uint32_t> points);

/// What the camera sees: a deep G-buffer, by tiles. Everything that answers, tunes or explains starts from
/// it.
struct VisiblePoints {
  static constexpr int kTileSize = 32;

  PictureRegion region;
  std::vector<VisibleTile> tiles;
  /// Which of many lights can be seen from here and thereabouts: the renderer's to learn. Null: not known.
  std::shared_ptr<const LightSight> sight;
  int samples = 1;                ///< of every pixel, or of those that are refined
  Image<std::uint8_t> refined{};  ///< not 0 where a pixel has `samples`, the others one; empty: all have them

  int samplesOf(std::size_t pixel) const { return refined.empty() || refined[pixel] != 0 ? samples : 1; }
  std::size_t pointCount() const;
  std::size_t memoryBytes() const;
};

/// The number of the tile that a pixel of the region belongs to; of one beyond its end, beyond all tiles.
std::uint32_t tileOfPixel(const PictureRegion& region, std::uint32_t pixel);

/// Where the visible points of a pixel are: VisiblePoints::tiles[tile].points[first, first + count).
struct PixelPoints {
  std::uint32_t tile = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// `pixel` is an index into the region's picture. Cost: logarithmic in the points of a tile.
PixelPoints pointsOfPixel(const VisiblePoints& points, std::uint32_t pixel);

/// A camera ray through sample `s` of `samples` of a pixel; x, y count in the full picture. The sample also
/// chooses the place on a lens, spread evenly over the samples of a pixel and otherwise in each pixel. It
/// depends on the view alone, not on the seed: another seed has the same visible points.
Ray cameraRay(const Camera& camera, int x, int y, int s, int samples);

/// Traces the camera's rays through mirrors and glass; where the parameters make the samples adaptive, the
/// first of every pixel. `seen` begins as one where nothing was met. False when stopped: points and surfaces
/// are then of no use.
///
/// Of a lens, positions, normals and depths in `seen` are those by way of its centre, where Camera::project
/// has them: one ray more for each pixel.
bool traceVisiblePoints(const Tracer& tracer, const Camera& camera, const PictureRegion& region,
                        const Parameters& parameters, TaskPool& pool, const StopFlag& stop,
                        VisiblePoints& points, SeenSurfaces& seen, RayCounts& counts);

/// Traces again the tiles with pixels that are to be `refined`, those with all their samples. Points and
/// surfaces are what traceVisiblePoints made of the same. False when stopped, likewise.
bool refineVisiblePoints(const Tracer& tracer, const Camera& camera, const Image<std::uint8_t>& refined,
                         const Parameters& parameters, TaskPool& pool, const StopFlag& stop,
                         VisiblePoints& points, SeenSurfaces& seen, RayCounts& counts);

}  // namespace lightvane
