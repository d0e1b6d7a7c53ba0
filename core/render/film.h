#pragma once

#include <memory>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace lightvane {

/// The part of the full picture that is rendered. Pixel addresses (and with them random numbers) are those of
/// the full picture.
struct PictureRegion {
  int fullWidth = 0;
  int fullHeight = 0;
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  static PictureRegion whole(const Camera& camera) {
    return {camera.width, camera.height, 0, 0, camera.width, camera.height};
  }
  std::uint32_t pixelAddress(int localX, int localY) const {
    return static_cast<std::uint32_t>(y + localY) * static_cast<std::uint32_t>(fullWidth) +
           static_cast<std::uint32_t>(x + localX);
  }
};

/// What the camera's rays met: the same in all pictures of a view.
struct SeenSurfaces {
  SeenSurfaces() = default;
  SeenSurfaces(int width, int height);

  ImageRgb emission;          ///< of what is seen straight
  ImageRgb specularEmission;  ///< of what is seen by way of mirrors and glass
  ImageRgb albedo, normal, position;
  ImageFloat depth;  ///< along the ray; infinity where nothing was met
};

/// A picture in layers, in normalised units, while it is computed. The layers add up to the beauty picture.
struct Film {
  Film() = default;
  /// Nothing was met yet.
  Film(int width, int height);
  /// Dark but for what these surfaces emit.
  explicit Film(std::shared_ptr<const SeenSurfaces> surfaces);

  int width = 0;
  int height = 0;
  std::shared_ptr<const SeenSurfaces> seen = std::make_shared<const SeenSurfaces>();  ///< shared by films
  ImageRgb emission, direct, indirect, specular;
  ImageFloat ilvCount;  ///< vectors that answered the pixel's first visible point
  ImageFloat fullIlv;   ///< ILVs computed in full for the pixel
  ImageFloat fullDlv;   ///< direct lights computed in full for the pixel
  ImageUint recordId;   ///< number + 1 of the nearest vector used; 0 where there is none
  /// Of the means that the pixels of a path traced picture are: of the beauty picture, and of two of its
  /// layers. Empty where it is not known.
  ImageRgb variance, directVariance, indirectVariance;

  const ImageRgb& albedo() const { return seen->albedo; }
  const ImageRgb& normal() const { return seen->normal; }
  const ImageRgb& position() const { return seen->position; }
  const ImageFloat& depth() const { return seen->depth; }
  Rgb beauty(std::size_t i) const { return emission[i] + direct[i] + indirect[i] + specular[i]; }
  /// All of it, in normalised units.
  ImageRgb beauty() const;

  /// The sum of the four layers in the scene's own units: R, G and B of toLayers, to the bit.
  ImageRgb sceneBeauty(const Scene& scene) const;
  /// `variance` in the scene's own units; empty where it is not known.
  ImageRgb sceneVariance(const Scene& scene) const;
  /// In the scene's own units, with the channel names of docs/scene-format.md's companion, docs/lightvane.md.
  LayeredImage toLayers(const Scene& scene) const;
};

}  // namespace lightvane
