#include "core/scene/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/image/image_format.h"
#include "core/scene/gltf_accessor.h"
#include "core/scene/mesh_file.h"
#include "core/scene/pixels.h"

namespace lightvane {
namespace {

constexpr const char* kTransmissionExtension = "KHR_materials_transmission";
constexpr const char* kSpecularExtension = "KHR_materials_specular";
constexpr const char* kTextureTransform = "KHR_texture_transform";

float unitClamped(double number) { return static_cast<float>(std::clamp(number, 0.0, 1.0)); }

Rgb unitColor(const std::vector<double>& numbers) {
  return {unitClamped(numbers[0]), unitClamped(numbers[1]), unitClamped(numbers[2])};
}

/// A texture of an extension; -1 where there is none.
int extensionTexture(const GltfFile& file, const tinygltf::ExtensionMap& extensions, const char* extension,
                     const char* key) {
  const auto found = extensions.find(extension);
  if (found == extensions.end() || !found->second.Has(key)) return -1;
  const tinygltf::Value& info = found->second.Get(key);
  if (!info.Has("index") || !info.Get("index").IsInt()) return -1;
  const int index = info.Get("index").GetNumberAsInt();
  return index >= 0 && static_cast<std::size_t>(index) < file.model.textures.size() ? index : -1;
}

/// Reflectance at normal incidence of what is no metal (KHR_materials_ior, KHR_materials_specular).
Rgb dielectricColor(const tinygltf::Material& source) {
  const double ior = gltfNumber(source.extensions, "KHR_materials_ior", "ior", 1.5);
  const double byIor = square((ior - 1.0) / (ior + 1.0));
  const double strength = gltfNumber(source.extensions, kSpecularExtension, "specularFactor", 1.0);
  std::vector<double> color(3, 1.0);
  gltfNumbers(source.extensions, kSpecularExtension, "specularColorFactor", color);
  for (double& number : color) number = std::min(byIor * number, 1.0) * strength;
  return unitColor(color);
}

/// The index of refraction of glass. 0 stands for a perfect mirror there, which no glass is.
double glassIor(const tinygltf::Material& source) {
  const double ior = gltfNumber(source.extensions, "KHR_materials_ior", "ior", 1.5);
  return ior > 0.0 ? std::clamp(ior, 1e-3, 1e3) : 1.5;
}

/// KHR_materials_volume: without it a surface is a pane that has no inside.
bool hasVolume(const tinygltf::Material& source) {
  return gltfNumber(source.extensions, "KHR_materials_volume", "thicknessFactor", 0.0) > 0.0;
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
  const tinygltf::TextureInfo& base = source.pbrMetallicRoughness.baseColorTexture;
  if (base.index >= 0) return uvsOfPicture(base);
  return source.emissiveTexture.index >= 0 ? uvsOfPicture(source.emissiveTexture) : GltfUvs{};
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

  PicturedColor base = baseOf(source);
  // Layers have one colour wherever they are seen.
  const Rgb layerBase = base.color * colors.mean;
  if (!colors.differ) base.color = layerBase;
  const auto [metallic, roughness] = metalRoughnessOf(source);
  const auto metal = static_cast<float>(metallic);
  // Metals let nothing through.
  const float transmitted = static_cast<float>(transmissionOf(source)) * (1.0f - metal);
  if (transmitted > 0.0f && transmitted < 1.0f)
    notes_.say("of materials that are glass in part the larger part is taken");
  // Glass stands for itself: what else a material does is the smaller part.
  if (transmitted >= 0.5f && !isBlack(base.color)) {
    if (roughness > 0.0) notes_.say("rough glass is taken as smooth");
    material.transmission = transmitted * base.color;
    material.textures.transmission = base.texture;
    material.ior = glassIor(source);
    material.thin = !hasVolume(source);
    return material;
  }
  material.diffuse = base.color * (1.0f - metal) * (1.0f - transmitted);
  if (!isBlack(material.diffuse)) material.textures.diffuse = base.texture;
  // A picture multiplies a layer's whole colour: that of a metal, or none of it.
  const bool isMetal = metal >= 0.5f;
  if (colors.differ && metal > 0.0f)
    notes_.say("of vertex colours that differ within a metal mesh the mean is taken");
  Rgb metalColor = layerBase;
  if (!isMetal && metal > 0.0f && base.texture)
    metalColor *= meanOf(source.pbrMetallicRoughness.baseColorTexture.index, true);
  const Rgb color = glm::mix(dielectricColor(source), metalColor, metal);
  if (isBlack(color)) return material;
  material.layers = {{color, roughness, 1.0, LayerModel::Ggx}};
  if (isMetal) material.textures.layers[0] = base.texture;
  return material;
}

GltfMaterials::PicturedColor GltfMaterials::baseOf(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  PicturedColor base;
  base.color = unitColor(pbr.baseColorFactor);
  base.texture = useTexture(pbr.baseColorTexture.index);
  return base;
}

GltfMaterials::MetalRoughness GltfMaterials::metalRoughnessOf(const tinygltf::Material& source) {
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  MetalRoughness found{std::clamp(pbr.metallicFactor, 0.0, 1.0), std::clamp(pbr.roughnessFactor, 0.0, 1.0)};
  const int texture = pbr.metallicRoughnessTexture.index;
  if (texture < 0) return found;
  notes_.say("of pictures of metalness and roughness the mean is taken");
  const Rgb mean = meanOf(texture, false);
  found.metallic *= static_cast<double>(mean.b);
  found.roughness *= static_cast<double>(mean.g);
  return found;
}

double GltfMaterials::transmissionOf(const tinygltf::Material& source) {
  const double factor =
      std::clamp(gltfNumber(source.extensions, kTransmissionExtension, "transmissionFactor", 0.0), 0.0, 1.0);
  const int texture =
      extensionTexture(file_, source.extensions, kTransmissionExtension, "transmissionTexture");
  if (texture < 0 || factor == 0.0) return factor;
  notes_.say("of pictures of transmission the mean is taken");
  return factor * static_cast<double>(meanOf(texture, false).r);
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
  const Rgb mean = meanOf(picture, true);
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
}

std::optional<TextureUse> GltfMaterials::useTexture(int index, TextureChannel channel) {
  if (index < 0) return std::nullopt;
  const Pixels pixels = pixelsOf(index, channel);
  if (!pixels) return std::nullopt;
  const tinygltf::Texture& texture = file_.model.textures[static_cast<std::size_t>(index)];
  ImageTextureDescription description;
  description.channel = channel;
  if (texture.sampler >= 0) {
    const tinygltf::Sampler& sampler = file_.model.samplers[static_cast<std::size_t>(texture.sampler)];
    description.wrap = wrapOf(sampler, notes_);
    description.filter = filterOf(sampler);
  }
  const auto [entry, isNew] = textureOf_.try_emplace(
      {texture.source, description.wrap, description.filter, channel}, textures.size());
  if (isNew) {
    const tinygltf::Image& image = file_.model.images[static_cast<std::size_t>(texture.source)];
    description.file = image.uri.empty() ? fmt::format("picture {}", texture.source) : image.uri;
    description.pixels = pixels;
    const std::string name = image.name.empty() ? description.file : image.name;
    textures.push_back({channel == TextureChannel::Alpha ? name + ", alpha" : name, std::move(description)});
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

Rgb GltfMaterials::meanOf(int texture, bool isLinearLight) {
  const Pixels pixels = pixelsOf(texture);
  if (!pixels) return Rgb(1.0f);
  Vec3d sum(0.0);
  std::size_t looked = 0;
  for (const Rgb& pixel : *pixels) {
    file_.watch.piece(looked++);
    // What is no colour was decoded as if it were one.
    sum +=
        isLinearLight ? Vec3d(pixel) : Vec3d(encodeSrgb(pixel.r), encodeSrgb(pixel.g), encodeSrgb(pixel.b));
  }
  return {sum / static_cast<double>(pixels->size())};
}

}  // namespace lightvane
