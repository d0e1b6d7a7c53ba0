#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "core/scene/description.h"
#include "core/scene/gltf_file.h"
#include "core/scene/gltf_mesh.h"

namespace lightvane {

/// The materials of a glTF file, made as its meshes ask for them. docs/scene-format.md says what becomes of
/// what.
class GltfMaterials {
 public:
  GltfMaterials(const GltfFile& file, GltfNotes& notes) : file_(file), notes_(notes) {}

  /// The colours of a mesh's vertices: their mean, and whether the mesh has each of them for itself.
  struct VertexColors {
    Rgb mean{1.0f};
    bool differ = false;
  };

  /// The place among `materials` of the file's material, -1 where a mesh has none, with its colour multiplied
  /// by those of the vertices; by their mean where the mesh itself cannot say.
  std::uint32_t use(int material, const VertexColors& colors);

  /// The texture coordinates that its picture lies on: that of its base colour, else that of what it emits.
  GltfUvs uvsOf(int material) const;

  std::vector<MaterialDescription> materials;
  std::vector<TextureDescription> textures;

 private:
  using Pixels = std::shared_ptr<const ImageRgb>;
  /// A colour of a material, and the picture that multiplies it.
  struct PicturedColor {
    Rgb color{1.0f};
    std::optional<TextureUse> texture;
  };
  struct MetalRoughness {
    double metallic = 1.0;  ///< its mean
    double factor = 1.0;    ///< what its picture is multiplied by
    bool differs = false;   ///< from place to place, as its picture says
    double roughness = 1.0;
  };
  /// What takes the place of the base colour, without its factor, and of the layer's colour.
  struct MetalPictures {
    PicturedColor diffuse, layer;
  };
  /// The channels of a picture, of linear light or of the values as they are stored; 1 where it cannot be
  /// read.
  struct PictureRange {
    Rgb mean{1.0f}, least{1.0f}, most{1.0f};
  };

  MaterialDescription convert(const tinygltf::Material& source, int index, const VertexColors& colors);
  MetalRoughness metalRoughnessOf(const tinygltf::Material& source);
  /// The pictures of what is neither all metal nor none of it; nothing where colours do for it, or where
  /// there are too many of them.
  std::optional<MetalPictures> bakeMetalOf(const tinygltf::Material& source, const MetalRoughness& found,
                                           const Rgb& layerBase, const Rgb& dielectric);
  /// As KHR_materials_ior has it: 0, which stands for a perfect mirror, or 1 and above.
  double iorOf(const tinygltf::Material& source);
  double transmissionOf(const tinygltf::Material& source);
  /// What a material emits, and the picture that multiplies it, where that lies on the coordinates that the
  /// material's meshes are read with.
  PicturedColor emissionOf(const tinygltf::Material& source);
  OpacityDescription opacityOf(const tinygltf::Material& source);
  void noteUnused(const tinygltf::Material& source);

  /// A texture's picture and how it lies; nothing where it has none that can be read.
  std::optional<ImageTextureDescription> pictureOf(int index, TextureChannel channel = TextureChannel::Color);
  /// Its place among `textures`.
  std::optional<TextureUse> useTexture(int index, TextureChannel channel = TextureChannel::Color);
  Pixels pixelsOf(int texture, TextureChannel channel = TextureChannel::Color);
  Expected<Pixels> readPicture(int index, TextureChannel channel) const;
  const PictureRange& rangeOf(int texture, bool isLinearLight);
  Rgb meanOf(int texture) { return rangeOf(texture, true).mean; }

  const GltfFile& file_;
  GltfNotes& notes_;
  std::map<std::tuple<int, float, float, float, bool>, std::uint32_t> used_;
  std::map<std::tuple<int, TextureChannel>, Pixels> pictures_;  ///< null where they cannot be read
  std::map<std::tuple<const ImageRgb*, bool>, PictureRange> ranges_;
  std::size_t bakedTexels_ = 0;
  /// By pictures, factor and colours; nothing where there were too many.
  std::map<std::tuple<const ImageRgb*, const ImageRgb*, float, float, float, float, float, float, float>,
           std::optional<MetalPictures>>
      metalPictures_;
  std::map<std::tuple<int, TextureWrap, TextureFilter, TextureChannel>, std::size_t> textureOf_;
};

}  // namespace lightvane
