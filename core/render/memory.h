#pragma once

#include <cstddef>
#include <string>

#include "core/render/film.h"
#include "core/render/parameters.h"
#include "core/vectors/snapshot.h"

namespace lightvane {

// What a rendering holds in memory, counted from what it is made of rather than asked from the system: the
// same request always comes to the same numbers. All in bytes.

/// What a picture takes for each pixel and each visible point, vectors apart.
struct PictureMemory {
  std::size_t perPixel = 0;
  std::size_t perPoint = 0;
};
/// For the method `vectors`: 192 a pixel (64 for what was met, and as much for the film that is shown and for
/// the one in the making) and 268 a point and 42 for each slot of lights (the point itself, and its answers
/// three times: those of the pass, of the frame, and in the making). For `path` 336 a pixel, with its sums.
/// For the others 192 a pixel and 157 a point. Points take 60 more in scenes with textures.
PictureMemory pictureMemory(const Scene& scene, const Parameters& parameters);

/// Of a whole picture before anything of it is known: with one visible point for each sample of a pixel.
/// Glass and half mirrors have more, the sky fewer.
std::size_t estimatedPictureBytes(const Scene& scene, const Parameters& parameters,
                                  const PictureRegion& region);

/// Of vectors: twice, since a new snapshot is made while frames hold the one before.
std::size_t vectorBytes(std::size_t indirect, std::size_t direct);
std::size_t vectorBytes(const Snapshot& snapshot);

}  // namespace lightvane
