#include "core/measure/comparison.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/text.h"
#include "core/measure/masks.h"

namespace lightvane {
namespace {

constexpr const char* kBeauty = "beauty";

/// The name of a layer's channels: those of the beauty picture have none.
std::string channelsOf(const std::string& layer) { return layer == kBeauty ? std::string() : layer; }

/// The name of the channels that say how sure a layer is.
std::string standardErrorOf(const std::string& layer) {
  return layer == kBeauty ? std::string("standard_error") : layer + ".standard_error";
}

bool hasLayer(const LayeredImage& image, const std::string& layer) { return image.hasRgb(channelsOf(layer)); }

/// The layers of three colours that a picture has.
std::vector<std::string> layersOf(const LayeredImage& image) {
  std::vector<std::string> layers;
  for (const auto& [name, pixels] : image.channels) {
    if (name == "R") layers.emplace_back(kBeauty);
    if (name.ends_with(".R")) layers.push_back(name.substr(0, name.size() - 2));
  }
  std::erase_if(layers, [&](const std::string& layer) { return !hasLayer(image, layer); });
  return layers;
}

const ImageFloat* channel(const LayeredImage& image, const std::string& name) {
  const auto found = image.channels.find(name);
  return found == image.channels.end() ? nullptr : &found->second;
}

/// Normals by their channels N.X, N.Y, N.Z; empty where there are none.
ImageRgb normalsOf(const LayeredImage& image) {
  const ImageFloat* axes[] = {channel(image, "N.X"), channel(image, "N.Y"), channel(image, "N.Z")};
  if (!axes[0] || !axes[1] || !axes[2]) return {};
  ImageRgb normals(image.width, image.height);
  for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = {(*axes[0])[i], (*axes[1])[i], (*axes[2])[i]};
  return normals;
}

/// The mask that one picture's layers say; nothing where it lacks a layer that the request needs.
std::optional<ImageFloat> maskOf(const LayeredImage& image, const ComparisonRequest& request) {
  ImageFloat mask;
  if (request.withoutEdges) {
    const ImageFloat* depth = channel(image, "Z");
    const ImageRgb normals = normalsOf(image);
    if (depth == nullptr && normals.empty()) return std::nullopt;
    mask = edgeMask(depth != nullptr ? *depth : ImageFloat(), normals);
  }
  if (request.withoutLights) {
    if (!image.hasRgb("emission")) return std::nullopt;
    mask = bothMasks(mask, lightMask(image.rgb("emission")));
  }
  return mask;
}

Expected<std::vector<std::string>> chosenLayers(const LayeredImage& picture, const std::string& pictureName,
                                                const LayeredImage& reference,
                                                const std::string& referenceName,
                                                const std::vector<std::string>& asked) {
  if (asked.empty()) {
    std::vector<std::string> layers = {kBeauty};
    for (const char* layer : {"direct", "indirect"}) {
      if (hasLayer(picture, layer) && hasLayer(reference, layer)) layers.emplace_back(layer);
    }
    return layers;
  }
  for (const std::string& layer : asked) {
    for (const auto& [image, name] : {std::pair(&picture, &pictureName), {&reference, &referenceName}}) {
      if (hasLayer(*image, layer)) continue;
      const std::vector<std::string> known = layersOf(*image);
      return makeError(*name, fmt::format("has no layer {} (it has {})", layer, listWords(known)),
                       suggestion(layer, known));
    }
  }
  return asked;
}

}  // namespace

ImageRgb varianceOf(const LayeredImage& image, const std::string& layer) {
  const std::string name = standardErrorOf(layer);
  if (!image.hasRgb(name)) return {};
  ImageRgb variance = image.rgb(name);
  for (Rgb& pixel : variance) pixel *= pixel;
  return variance;
}

LayeredImage meanOfHalves(const LayeredImage& first, const LayeredImage& second) {
  LV_CHECK(first.width == second.width && first.height == second.height, "{}x{} and {}x{} pixels",
           first.width, first.height, second.width, second.height);
  LayeredImage mean = first;
  for (const char* layer : {kBeauty, "direct", "indirect"}) {
    const std::string name = channelsOf(layer);
    if (!first.hasRgb(name) || !second.hasRgb(name)) continue;
    ImageRgb pixels = first.rgb(name);
    const ImageRgb others = second.rgb(name);
    ImageRgb errors(first.width, first.height);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      errors[i] = glm::abs(pixels[i] - others[i]) * 0.5f;
      pixels[i] = (pixels[i] + others[i]) * 0.5f;
    }
    mean.setRgb(name, pixels);
    mean.setRgb(standardErrorOf(layer), errors);
  }
  return mean;
}

Expected<PictureComparison> compareImages(const LayeredImage& picture, const std::string& pictureName,
                                          const LayeredImage& reference, const std::string& referenceName,
                                          const ComparisonRequest& request) {
  if (picture.width != reference.width || picture.height != reference.height) {
    return makeError(pictureName,
                     fmt::format("has {}x{} pixels, and {} has {}x{}", picture.width, picture.height,
                                 referenceName, reference.width, reference.height),
                     "only pictures of one size can be compared");
  }
  const auto layers = chosenLayers(picture, pictureName, reference, referenceName, request.layers);
  if (!layers) return tl::unexpected(layers.error());
  std::optional<ImageFloat> mask = maskOf(reference, request);
  if (!mask) mask = maskOf(picture, request);
  if (!mask) {
    return makeError(
        "--without",
        "neither picture says where that is: edges take the depth (Z) or normals (N), lights the "
        "layer emission",
        "lightvane render FILE.exr writes them");
  }

  PictureComparison comparison{picture.width, picture.height, {}};
  for (const std::string& layer : *layers) {
    const ImageRgb a = picture.rgb(channelsOf(layer));
    const ImageRgb b = reference.rgb(channelsOf(layer));
    const ImageRgb variance = varianceOf(reference, layer);
    LayerComparison& compared = comparison.layers.emplace_back();
    compared.layer = layer;
    compared.knowsNoise = !variance.empty();
    const MetricInput input{a, b, &variance, &*mask, request.exposureStops};
    for (const MetricInfo* metric : request.metrics) compared.results.push_back(metric->compute(input));
    if (!compared.results.empty() && compared.results.front().counted == 0)
      return makeError(pictureName,
                       fmt::format("no pixel of {} can be compared with {}: all are left out, or "
                                   "not finite in one of them",
                                   layer, referenceName));
  }
  return comparison;
}

}  // namespace lightvane
