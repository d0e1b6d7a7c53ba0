#pragma once

#include <memory>

#include "core/base/load_watch.h"
#include "core/scene/description.h"

namespace lightvane {

/// A glTF material whose metalness, or the colour below it, differs from place to place: diffuse is base x (1
/// - metalness), and the layer above it mixes the colour of what is no metal with the base by the metalness.
struct MetalMixture {
  const ImageTextureDescription* base = nullptr;   ///< null: white
  const ImageTextureDescription* metal = nullptr;  ///< its blue, as stored, times `metallic`; null: 1
  float metallic = 1.0f;
  Rgb layerBase{1.0f};   ///< what the base's picture is multiplied by in the layer
  Rgb dielectric{0.0f};  ///< the layer's colour where there is no metal
};

/// A colour that differs from place to place: a picture with values in [0, 1], and what it is multiplied by,
/// the greatest there is. No pixels where that is black.
struct BakedColor {
  Rgb most{0.0f};
  std::shared_ptr<const ImageRgb> pixels;
};

struct BakedMetal {
  BakedColor diffuse;  ///< without the base's factor
  BakedColor layer;
};

/// The width and height of the pictures that bakeMetal makes: enough for the finer one.
glm::ivec2 bakedSize(const MetalMixture& mixture);

/// Throws LoadStopped as `watch` says.
BakedMetal bakeMetal(const MetalMixture& mixture, LoadWatch& watch);

}  // namespace lightvane
