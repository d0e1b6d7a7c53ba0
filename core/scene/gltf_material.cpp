#include "core/scene/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/image/image_format.h"
#include "core/scene/gltf_accessor.h"
#include "core/scene/gltf_metal.h"
#include "core/scene/mesh_file.h"
#include "core/scene/pixels.h"

namespace lightvane {
namespace {

constexpr const char* kTransmissionExtension = "KHR_materials_transmission";
constexpr const char* kSpecularExtension = "KHR_materials_specular";
constexpr const char* kVolumeExtension = "KHR_materials_volume";
constexpr const char* kTextureTransform = "KHR_texture_transform";

/// Of pictures that are made of others, in all; 12 bytes each.
constexpr std::size_t kMostBakedTexels = std::size_t{1} << 26;
/// Metalness that differs by less is the same everywhere but for what JPEG makes of it.
constexpr float kEvenMetal = 0.0125f;

float unitClamped(double number) { return static_cast<float>(std::clamp(number, 0.0, 1.0)); }

Rgb unitColor(const std::vector<double>& numbers) {
  return {unitClamped(numbers[0]), unitClamped(numbers[1]), unitClamped(numbers[2])};
}

bool hasKey(const tinygltf::ExtensionMap& extensions, const char* extension, const char* key) {
  const auto found = extensions.find(extension);
  return found != extensions.end() && found->second.Has(key);
}

/// A texture of an extension; -1 where there is none.
int extensionTexture(const GltfFile& file, const tinygltf::ExtensionMap& extensions, const char* extension,
                     const char* key) {
  if (!hasKey(extensions, extension, key)) return -1;
  const tinygltf::Value& info = extensions.at(extension).Get(key);
  if (!info.Has("index") || !info.Get("index").IsInt()) return -1;
  const int index = info.Get("index").GetNumberAsInt();
  return index >= 0 && static_cast<std::size_t>(index) < file.model.textures.size() ? index : -1;
}

/// Reflectance at normal incidence of what is no metal (KHR_materials_ior, KHR_materials_specular).
Rgb dielectricColor(const tinygltf::Material& source, double ior) {
  const double byIor = square((ior - 1.0) / (ior + 1.0));
  const double strength = gltfNumber(source.extensions, kSpecularExtension, "specularFactor", 1.0);
  std::vector<double> color(3, 1.0);
  gltfNumbers(source.extensions, kSpecularExtension, "specularColorFactor", color);
  for (double& number : color) number = std::min(byIor * number, 1.0) * strength;
  return unitColor(color);
}

/// The index of refraction of glass. 0 stands for a perfect mirror there, which no glass is.
double glassIor(double ior) { return ior > 0.0 ? std::min(ior, 1e3) : 1.5; }

/// KHR_materials_volume: without it a surface is a pane that has no inside.
bool hasVolume(const tinygltf::Material& source) {
  return gltfNumber(source.extensions, kVolumeExtension, "thicknessFactor", 0.0) > 0.0;
}

TextureFilter filterOf(const tinygltf::Sampler& sampler) {
  return sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST ? TextureFilter::Nearest
                                                              : TextureFilter::Linear;
}

TextureWrap wrapOf(const tinygltf::Sampler& sampler, GltfNotes& notes) {
  const bool isEven = sampler.wrapS == sampler.wrapT;
  if (isEven && sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::Clamp;
  if (sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ||
      sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) {
    notes.say("pictures that repeat mirrored are taken to repeat as they are");
  } else if (!isEven) {
    notes.say("pictures that repeat along one side only are taken to repeat along both");
  }
  return TextureWrap::Repeat;
}

/// The texture coordinates that a picture lies on.
GltfUvs uvsOfPicture(const tinygltf::TextureInfo& info) {
  GltfUvs uvs;
  const auto number = [&info](const char* key, double otherwise) {
    return gltfNumber(info.extensions, kTextureTransform, key, otherwise);
  };
  uvs.set = static_cast<int>(std::clamp(number("texCoord", info.texCoord), 0.0, 1e6));
  std::vector<double> offset(2, 0.0);
  std::vector<double> scale(2, 1.0);
  gltfNumbers(info.extensions, kTextureTransform, "offset", offset);
  gltfNumbers(info.extensions, kTextureTransform, "scale", scale);
  // Counter-clockwise where v runs down, as its words and Khronos' viewer have it; the formula in the
  // extension's text turns the other way.
  const double angle = number("rotation", 0.0);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  uvs.transform = glm::dmat3(Vec3d(c * scale[0], -s * scale[0], 0.0), Vec3d(s * scale[1], c * scale[1], 0.0),
                             Vec3d(offset[0], offset[1], 1.0));
  return uvs;
}

/// Those that a material's meshes are read with: one set of them is kept.
GltfUvs meshUvsOf(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  if (pbr.baseColorTexture.index >= 0) return uvsOfPicture(pbr.baseColorTexture);
  if (source.emissiveTexture.index >= 0) return uvsOfPicture(source.emissiveTexture);
  return pbr.metallicRoughnessTexture.index >= 0 ? uvsOfPicture(pbr.metallicRoughnessTexture) : GltfUvs{};
}

}  // namespace

std::uint32_t GltfMaterials::use(int material, const VertexColors& colors) {
  const Rgb& mean = colors.mean;
  const auto [entry, isNew] = used_.try_emplace({material, mean.r, mean.g, mean.b, colors.differ},
                                                static_cast<std::uint32_t>(materials.size()));
  if (!isNew) return entry->second;
  if (material >= 0) {
    materials.push_back(convert(file_.model.materials[static_cast<std::size_t>(material)], material, colors));
  } else {
    materials.push_back(defaultMaterial(file_.path));
    if (!colors.differ) materials.back().diffuse *= mean;
    notes_.say(fmt::format("triangles without a material get a diffuse grey of {:.1f}", kDefaultReflectance));
  }
  return entry->second;
}

GltfUvs GltfMaterials::uvsOf(int material) const {
  return material < 0 ? GltfUvs{} : meshUvsOf(file_.model.materials[static_cast<std::size_t>(material)]);
}

MaterialDescription GltfMaterials::convert(const tinygltf::Material& source, int index,
                                           const VertexColors& colors) {
  MaterialDescription material;
  material.name = fmt::format("{}: {}", file_.path.filename().string(),
                              source.name.empty() ? fmt::format("material {}", index) : source.name);
  const PicturedColor emission = emissionOf(source);
  material.emission = emission.color;
  material.textures.emission = emission.texture;
  material.twoSided = source.doubleSided && material.emits();
  noteUnused(source);
  material.opacity = opacityOf(source);

  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const Rgb baseFactor = unitColor(pbr.baseColorFactor);
  // Vertices have their colours in what is diffuse or glass, and layers their mean.
  const Rgb layerBase = baseFactor * colors.mean;
  const Rgb base = colors.differ ? baseFactor : layerBase;
  const MetalRoughness metalRoughness = metalRoughnessOf(source);
  const auto metal = static_cast<float>(metalRoughness.metallic);
  const double ior = iorOf(source);
  // Metals let nothing through.
  const float transmitted = static_cast<float>(transmissionOf(source)) * (1.0f - metal);
  if (transmitted > 0.0f && transmitted < 1.0f)
    notes_.say("of materials that are glass in part the larger part is taken");
  // Glass stands for itself: what else a material does is the smaller part.
  if (transmitted >= 0.5f && !isBlack(base)) {
    if (metalRoughness.roughness > 0.0) notes_.say("rough glass is taken as smooth");
    material.transmission = transmitted * base;
    material.textures.transmission = useTexture(pbr.baseColorTexture.index);
    material.ior = glassIor(ior);
    material.thin = !hasVolume(source);
    return material;
  }
  if (colors.differ && metal > 0.0f)
    notes_.say("of vertex colours that differ within a metal mesh the mean is taken");
  material.diffuse = base * (1.0f - transmitted);
  Rgb layer = dielectricColor(source, ior);
  std::optional<TextureUse> layerTexture;
  if (const auto baked = bakeMetalOf(source, metalRoughness, layerBase, layer)) {
    material.diffuse *= baked->diffuse.color;
    material.textures.diffuse = baked->diffuse.texture;
    layer = baked->layer.color;
    layerTexture = baked->layer.texture;
  } else {
    material.diffuse *= 1.0f - metal;
    if (!isBlack(material.diffuse)) material.textures.diffuse = useTexture(pbr.baseColorTexture.index);
    if (metal == 1.0f) {
      layer = layerBase;
      layerTexture = useTexture(pbr.baseColorTexture.index);
    } else if (metal > 0.0f) {
      layer = glm::mix(layer, layerBase * meanOf(pbr.baseColorTexture.index), metal);
    }
  }
  if (isBlack(layer)) return material;
  material.layers = {{layer, metalRoughness.roughness, 1.0, LayerModel::Ggx}};
  material.textures.layers[0] = layerTexture;
  return material;
}

GltfMaterials::MetalRoughness GltfMaterials::metalRoughnessOf(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  MetalRoughness found;
  found.factor = std::clamp(pbr.metallicFactor, 0.0, 1.0);
  found.metallic = found.factor;
  found.roughness = std::clamp(pbr.roughnessFactor, 0.0, 1.0);
  const PictureRange& range = rangeOf(pbr.metallicRoughnessTexture.index, false);
  if (found.roughness > 0.0 && range.least.g < range.most.g)
    notes_.say("of pictures of roughness the mean is taken");
  found.metallic *= static_cast<double>(range.mean.b);
  found.roughness *= static_cast<double>(range.mean.g);
  if (!(found.factor > 0.0 && range.most.b - range.least.b > kEvenMetal)) return found;
  found.differs = uvsOfPicture(pbr.metallicRoughnessTexture) == meshUvsOf(source);
  if (!found.differs)
    notes_.say("of pictures of metalness, where they do not lie on the base colour's, the mean is taken");
  return found;
}

std::optional<GltfMaterials::MetalPictures> GltfMaterials::bakeMetalOf(const tinygltf::Material& source,
                                                                       const MetalRoughness& found,
                                                                       const Rgb& layerBase,
                                                                       const Rgb& dielectric) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const auto base = pictureOf(pbr.baseColorTexture.index);
  const auto metal = found.differs ? pictureOf(pbr.metallicRoughnessTexture.index) : std::nullopt;
  const bool isMixed = found.metallic > 0.0 && found.metallic < 1.0;
  if (!metal && !(base && isMixed)) return std::nullopt;
  const MetalMixture mixture{base ? &*base : nullptr, metal ? &*metal : nullptr,
                             static_cast<float>(metal ? found.factor : found.metallic), layerBase,
                             dielectric};
  // Materials often share their pictures, and differ in what is not of these.
  const auto [known, isNew] = metalPictures_.try_emplace(
      {base ? base->pixels.get() : nullptr, metal ? metal->pixels.get() : nullptr, mixture.metallic,
       layerBase.r, layerBase.g, layerBase.b, dielectric.r, dielectric.g, dielectric.b});
  if (!isNew) return known->second;
  const glm::ivec2 size = bakedSize(mixture);
  const std::size_t texels = 2 * static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  if (texels > kMostBakedTexels - bakedTexels_) {
    notes_.say("pictures of metals would have more than 2^26 texels in all: of some the mean is taken");
    return std::nullopt;
  }
  bakedTexels_ += texels;
  const LoadStage stage(file_.watch, fmt::format("mixing the metal of {}", file_.path.filename().string()));
  const BakedMetal baked = bakeMetal(mixture, file_.watch);
  // Pictures of one texel lie anyhow.
  const bool isBaseOne = base && base->pixels->size() == 1;
  const ImageTextureDescription& like = base && !(metal && isBaseOne) ? *base : *metal;
  if (base && metal && !isBaseOne && metal->pixels->size() > 1 &&
      (base->wrap != metal->wrap || base->filter != metal->filter))
    notes_.say("pictures of metalness are clamped and filtered as those of the base colour are");
  const auto use = [&](const BakedColor& color, const char* what) -> PicturedColor {
    if (!color.pixels) return {color.most, {}};
    ImageTextureDescription image = like;
    image.pixels = color.pixels;
    textures.push_back({fmt::format("{}, {}", image.file, what), std::move(image)});
    return {color.most, TextureUse{textures.size() - 1, 1.0}};
  };
  known->second = MetalPictures{use(baked.diffuse, "without its metal"), use(baked.layer, "with its metal")};
  return known->second;
}

double GltfMaterials::iorOf(const tinygltf::Material& source) {
  const double ior = gltfNumber(source.extensions, "KHR_materials_ior", "ior", 1.5);
  if (ior == 0.0 || ior >= 1.0) return ior;
  notes_.say("an ior below 1, other than 0, is taken as 1");
  return 1.0;
}

double GltfMaterials::transmissionOf(const tinygltf::Material& source) {
  const double factor =
      std::clamp(gltfNumber(source.extensions, kTransmissionExtension, "transmissionFactor", 0.0), 0.0, 1.0);
  const int texture =
      extensionTexture(file_, source.extensions, kTransmissionExtension, "transmissionTexture");
  if (texture < 0 || factor == 0.0) return factor;
  notes_.say("of pictures of transmission the mean is taken");
  return factor * static_cast<double>(rangeOf(texture, false).mean.r);
}

GltfMaterials::PicturedColor GltfMaterials::emissionOf(const tinygltf::Material& source) {
  const double strength =
      gltfNumber(source.extensions, "KHR_materials_emissive_strength", "emissiveStrength", 1.0);
  constexpr double kMost = std::numeric_limits<float>::max();
  Rgb emission(0.0f);
  for (int c = 0; c < 3; ++c) {
    const double factor = source.emissiveFactor[static_cast<std::size_t>(c)];
    emission[c] = static_cast<float>(std::clamp(factor * strength, 0.0, kMost));
  }
  const int picture = source.emissiveTexture.index;
  if (isBlack(emission) || picture < 0) return {emission, {}};
  const Rgb mean = meanOf(picture);
  if (isBlack(mean)) return {mean, {}};
  if (uvsOfPicture(source.emissiveTexture) == meshUvsOf(source)) return {emission, useTexture(picture)};
  notes_.say("of pictures of what is emitted, where they do not lie on the base colour's, the mean is taken");
  return {emission * mean, {}};
}

OpacityDescription GltfMaterials::opacityOf(const tinygltf::Material& source) {
  OpacityDescription opacity;
  const bool isMask = source.alphaMode == "MASK";
  if (!isMask && source.alphaMode != "BLEND") return opacity;
  if (!isBlack(emissionOf(source).color)) {
    notes_.unused("alpha of what shines");
    return opacity;
  }
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  if (pbr.baseColorFactor.size() == 4) opacity.value = std::clamp(pbr.baseColorFactor[3], 0.0, 1.0);
  opacity.texture = useTexture(pbr.baseColorTexture.index, TextureChannel::Alpha);
  // A cutoff of 0 cuts nothing.
  if (isMask && source.alphaCutoff <= 0.0) return {};
  if (isMask && source.alphaCutoff > 1.0) return {0.0, {}, 0.0};
  if (isMask) opacity.cutoff = source.alphaCutoff;
  return opacity;
}

void GltfMaterials::noteUnused(const tinygltf::Material& source) {
  if (source.normalTexture.index >= 0) notes_.unused("normal textures");
  if (source.occlusionTexture.index >= 0) notes_.unused("occlusion textures");
  for (const char* key : {"specularTexture", "specularColorTexture"}) {
    if (extensionTexture(file_, source.extensions, kSpecularExtension, key) >= 0)
      notes_.unused("specular textures");
  }
  if (hasVolume(source) && (hasKey(source.extensions, kVolumeExtension, "attenuationDistance") ||
                            hasKey(source.extensions, kVolumeExtension, "attenuationColor")))
    notes_.unused("attenuation within glass");
  if (hasKey(source.extensions, kVolumeExtension, "thicknessTexture")) notes_.unused("pictures of thickness");
}

std::optional<ImageTextureDescription> GltfMaterials::pictureOf(int index, TextureChannel channel) {
  if (index < 0) return std::nullopt;
  ImageTextureDescription description;
  description.pixels = pixelsOf(index, channel);
  if (!description.pixels) return std::nullopt;
  const tinygltf::Texture& texture = file_.model.textures[static_cast<std::size_t>(index)];
  const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(texture.source)];
  description.file = image.uri.empty() ? fmt::format("picture {}", texture.source) : image.uri;
  description.channel = channel;
  if (texture.sampler >= 0) {
    const tinygltf::Sampler& sampler = file_.model.samplers[static_cast<std::size_t>(texture.sampler)];
    description.wrap = wrapOf(sampler, notes_);
    description.filter = filterOf(sampler);
  }
  return description;
}

std::optional<TextureUse> GltfMaterials::useTexture(int index, TextureChannel channel) {
  auto picture = pictureOf(index, channel);
  if (!picture) return std::nullopt;
  const int source = file_.model.textures[static_cast<std::size_t>(index)].source;
  const auto [entry, isNew] =
      textureOf_.try_emplace({source, picture->wrap, picture->filter, channel}, textures.size());
  if (isNew) {
    const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(source)];
    const std::string name = image.name.empty() ? picture->file : image.name;
    textures.push_back({channel == TextureChannel::Alpha ? name + ", alpha" : name, *std::move(picture)});
  }
  return TextureUse{entry->second, 1.0};
}

GltfMaterials::Pixels GltfMaterials::pixelsOf(int texture, TextureChannel channel) {
  const int image = file_.model.textures[static_cast<std::size_t>(texture)].source;
  if (image < 0) {
    notes_.unused("textures without a PNG or JPEG picture");
    return nullptr;
  }
  const auto [entry, isNew] = pictures_.try_emplace({image, channel});
  if (!isNew) return entry->second;
  const Expected<Pixels> read = readPicture(image, channel);
  if (read) {
    entry->second = *read;
  } else {
    notes_.say(
        fmt::format("{} is not used: {}",
                    gltfName("picture", image, file_.model.images[static_cast<std::size_t>(image)].name),
                    read.error().message()));
  }
  return entry->second;
}

Expected<GltfMaterials::Pixels> GltfMaterials::readPicture(int index, TextureChannel channel) const {
  const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(index)];
  const LoadStage stage(file_.watch, fmt::format("reading {} of {}", gltfName("picture", index, image.name),
                                                 file_.path.filename().string()));
  if (image.bufferView >= 0) {
    const auto bytes = gltfViewBytes(file_, image.bufferView, "it");
    if (!bytes) return makeError("", bytes.error().what);
    return readTexels(*bytes, "", channel, file_.watch);
  }
  if (!image.image.empty()) {
    const std::string_view bytes(reinterpret_cast<const char*>(image.image.data()), image.image.size());
    return readTexels(bytes, "", channel, file_.watch);
  }
  if (image.uri.starts_with("data:"))
    return makeError("", "its data: URI is no PNG or JPEG picture in base64");
  const Expected<std::filesystem::path> path = resolveGltfUri(file_.path, image.uri);
  if (!path) return tl::unexpected(path.error());
  return loadTexels(*path, channel, file_.watch);
}

const GltfMaterials::PictureRange& GltfMaterials::rangeOf(int texture, bool isLinearLight) {
  const Pixels pixels = texture < 0 ? nullptr : pixelsOf(texture);
  const auto [entry, isNew] = ranges_.try_emplace({pixels.get(), isLinearLight});
  PictureRange& range = entry->second;
  if (!isNew || !pixels) return range;
  range = {Rgb(0.0f), Rgb(1.0f), Rgb(0.0f)};
  Vec3d sum(0.0);
  std::size_t looked = 0;
  for (const Rgb& pixel : *pixels) {
    file_.watch.piece(looked++);
    // What is no colour was decoded as if it were one.
    const Rgb value =
        isLinearLight ? pixel : Rgb(encodeSrgb(pixel.r), encodeSrgb(pixel.g), encodeSrgb(pixel.b));
    sum += Vec3d(value);
    range.least = glm::min(range.least, value);
    range.most = glm::max(range.most, value);
  }
  range.mean = Rgb(sum / static_cast<double>(pixels->size()));
  return range;
}

}  // namespace lightvane
