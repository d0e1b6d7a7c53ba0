#include "core/render/memory.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/render/light_slots.h"
#include "core/render/path_renderer.h"
#include "core/render/renderer.h"
#include "core/render/visible_points.h"

namespace lightvane {
namespace {

constexpr std::size_t kFilms = 2;  // the one that is shown, the one in the making
constexpr std::size_t kAnswers = 3;
// Film: four layers of colour, three of numbers and one of record numbers.
constexpr std::size_t kFilmPixel = 4 * sizeof(Rgb) + 3 * sizeof(float) + sizeof(std::uint32_t);
// SeenSurfaces: five of colour and the depth.
constexpr std::size_t kSeenPixel = 5 * sizeof(Rgb) + sizeof(float);
// TileAnswers: six flags and counts, and of each key indirect light and a flag; of each slot light,
// state and reason.
constexpr std::size_t kAnswerPoint = 5 + sizeof(Rgb) + 2 * (sizeof(Rgb) + 1) + 2 + 4;
constexpr std::size_t kAnswerSlot = sizeof(Rgb) + 2;
// PointCluster: a number for each point, in vectors that grow by doubling, and a cluster for some 50.
constexpr std::size_t kClusterPoint = 2 * sizeof(std::uint32_t) + 1;
// Sums of the methods without vectors.
constexpr std::size_t kPathPixel = sizeof(PathSums) + kFilms * 3 * sizeof(Rgb);  // with the variances' layers
constexpr std::size_t kPlainPoint = 3 * sizeof(Rgb);

/// Of many lights with vectors, those that are worth them somewhere in a tile: some 50 among a thousand lamps
/// about a box that shine everywhere.
constexpr std::size_t kWorthInATile = 64;

/// The slots of light that a tile has: see LightSlots.
std::size_t slotCount(const Scene& scene, const Parameters& parameters) {
  const LightSlots slots(scene, parameters, {});
  return slots.sharedCount() + (slots.isByTile() ? std::min(slots.vectorLights().size(), kWorthInATile) : 0);
}

}  // namespace

PictureMemory pictureMemory(const Scene& scene, const Parameters& parameters) {
  PictureMemory memory{kSeenPixel + kFilms * kFilmPixel, 0};
  switch (parameters.picture.method) {
    case Method::Path:
      memory.perPixel += kPathPixel;
      break;
    case Method::Naive:
    case Method::Direct:
      memory.perPoint = sizeof(VisiblePoint) + kClusterPoint + kPlainPoint;
      break;
    case Method::Vectors:
      memory.perPoint = sizeof(VisiblePoint) + kClusterPoint +
                        kAnswers * (kAnswerPoint + kAnswerSlot * slotCount(scene, parameters));
      break;
  }
  if (scene.needs.textures && memory.perPoint > 0) memory.perPoint += sizeof(Tint);
  return memory;
}

std::size_t estimatedPictureBytes(const Scene& scene, const Parameters& parameters,
                                  const PictureRegion& region) {
  const PictureMemory memory = pictureMemory(scene, parameters);
  const auto samples = static_cast<std::size_t>(std::max(parameters.picture.filmSamples, 1));
  return static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height) *
         (memory.perPixel + samples * memory.perPoint);
}

std::size_t vectorBytes(std::size_t indirect, std::size_t direct) {
  const std::size_t tree = 2 * sizeof(TreeEntry);
  return 2 * (indirect * (sizeof(IndirectLightVector) + tree) + direct * (sizeof(DirectLightVector) + tree));
}
std::size_t vectorBytes(const Snapshot& snapshot) {
  return vectorBytes(snapshot.indirect.size(), snapshot.directCount());
}

}  // namespace lightvane
